"""What expressions tell of robots: by name, from any CRS, in any thread, and nothing that is not known."""

from __future__ import annotations

import time

import numpy as np
import pytest
from fleet_supervisor.plugin.expressions import ExpressionFunctions, RobotSnapshot, SnapshotHolder
from fleet_supervisor.plugin.layers.road_surfaces import SurfaceStore
from fleet_supervisor.robot_bridge.core.clock import steady_time
from qgis.core import (
    NULL,
    QgsCoordinateReferenceSystem,
    QgsExpression,
    QgsExpressionContext,
    QgsExpressionContextUtils,
    QgsProject,
)
from qgis.gui import QgsExpressionTreeView

NAMES = ("robot_state", "robot_battery", "robot_age", "distance_to_robot")
EAST, NORTH = 488000.0, 5190000.0
YARD = 'ENGCRS["yard",EDATUM["yard"],CS[Cartesian,2],AXIS["x",east],AXIS["y",north],LENGTHUNIT["metre",1]]'
"""A CRS of its own, of which nobody knows where on the Earth it is."""


@pytest.fixture
def fleet(qgis_app):
    QgsProject.instance().clear()
    fleet = SnapshotHolder()
    store = SurfaceStore(QgsProject.instance())
    functions = ExpressionFunctions(store, fleet)
    yield fleet
    functions.remove()
    store.remove()


def robots(**places):
    """Robots at these places of the site, None for one that never said where it is."""
    xy = [(np.nan, np.nan) if at is None else (EAST + at[0], NORTH + at[1]) for at in places.values()]
    return RobotSnapshot(
        crs=QgsCoordinateReferenceSystem("EPSG:32633"),
        rows={name: row for row, name in enumerate(places)},
        states=["fresh", "lost", "stale"][: len(places)],
        xy=np.array(xy),
        age=np.array([0.5, 12.0, 4.0])[: len(places)],
        battery=np.array([0.82, np.nan, 0.1])[: len(places)],
        taken=steady_time(),
    )


def value(text, layer=None, feature=None):
    expression = QgsExpression(text)
    assert not expression.hasParserError(), expression.parserErrorString()
    context = QgsExpressionContext(QgsExpressionContextUtils.globalProjectLayerScopes(layer))
    if feature is not None:
        context.setFeature(feature)
    found = expression.evaluate(context)
    assert not expression.hasEvalError(), expression.evalErrorString()
    return None if found == NULL else found


def test_state_and_battery_by_name(fleet):
    fleet.robots = robots(r1=(0, 0), r2=(10, 0))
    assert value("robot_state('r1')") == "fresh"
    assert value("robot_state('r2')") == "lost"
    assert value("robot_battery('r1')") == 0.82


def test_age_goes_on_by_itself(fleet):
    fleet.robots = robots(r1=(0, 0), r2=(10, 0))
    first = value("robot_age('r2')")
    assert first == pytest.approx(12.0, abs=0.5)
    time.sleep(0.02)
    assert value("robot_age('r2')") > first


@pytest.mark.parametrize("text", ["robot_state('r9')", "robot_state(NULL)", "robot_battery('r2')"])
def test_what_is_not_known_is_null(fleet, text):
    fleet.robots = robots(r1=(0, 0), r2=(10, 0))
    assert value(text) is None


@pytest.mark.parametrize("name", NAMES)
def test_without_a_gateway_everything_is_null(fleet, name):
    assert value(f"{name}('r1')") is None


def test_a_column_names_the_robot(fleet, make_layer):
    fleet.robots = robots(r1=(0, 0), r2=(10, 0))
    layer = make_layer("tasks", "Point", "&field=who:string", [("Point (1 2)", "r2")])
    assert value('robot_state("who")', layer, next(layer.getFeatures())) == "lost"


def test_an_expression_that_was_prepared_sees_what_is_new(fleet):
    fleet.robots = robots(r1=(0, 0))
    expression = QgsExpression("robot_state('r1')")
    context = QgsExpressionContext()
    assert expression.prepare(context)
    assert expression.evaluate(context) == "fresh"
    fleet.robots = None
    assert expression.evaluate(context) in (None, NULL)


def test_distance_is_that_of_the_feature_in_metres_of_the_site(fleet, make_layer):
    fleet.robots = robots(r1=(30, 40))
    layer = make_layer("places", "Point", "", [(f"Point ({EAST} {NORTH})",)])
    assert value("distance_to_robot('r1')", layer, next(layer.getFeatures())) == pytest.approx(50.0)


def test_distance_from_a_layer_in_degrees(fleet, make_layer):
    fleet.robots = robots(r1=(30, 40))
    # The same place by PROJ: lon, lat of EPSG:32633 488000, 5190000.
    layer = make_layer("places", "Point", "", [("Point (14.8425591 46.8634319)",)], crs="EPSG:4326")
    assert value("distance_to_robot('r1')", layer, next(layer.getFeatures())) == pytest.approx(50.0, abs=0.05)


def test_distance_to_a_polygon_that_the_robot_is_in_is_nothing(fleet):
    fleet.robots = robots(r1=(5, 5))
    square = f"make_rectangle_3points(make_point({EAST},{NORTH}), make_point({EAST},{NORTH}+10), "
    square += f"make_point({EAST}+10,{NORTH}+10))"
    assert value(f"distance_to_robot('r1', {square}, 'EPSG:32633')") == 0.0


def test_of_a_robot_that_never_said_where_it_is_there_is_no_distance(fleet):
    fleet.robots = robots(r1=None)
    assert value("distance_to_robot('r1', make_point(0, 0), 'EPSG:32633')") is None


@pytest.mark.parametrize(
    ("arguments", "says"),
    [
        ("'r1', make_point(0, 0), 'EPSG:0'", "'EPSG:0' is no CRS that QGIS knows"),
        ("'r1', 'here'", "'here' is no geometry"),
        ("'r1', make_point(500, 500), 'EPSG:4326'", "no place in EPSG:32633"),
        (f"'r1', make_point(5, 5), '{YARD}'", "no place in EPSG:32633"),
    ],
)
def test_what_cannot_be_measured_says_why(fleet, arguments, says):
    fleet.robots = robots(r1=(0, 0))
    expression = QgsExpression(f"distance_to_robot({arguments})")
    expression.evaluate(QgsExpressionContext())
    assert says in expression.evalErrorString()


@pytest.mark.parametrize("name", NAMES)
def test_each_has_help_and_stands_in_the_group_fleet(fleet, name):
    function = QgsExpression.Functions()[QgsExpression.functionIndex(name)]
    assert f"{name}(" in function.helpText()
    assert "NULL" in function.helpText()
    assert function.groups() == ["Fleet"]


@pytest.mark.parametrize("name", [*NAMES, "road_surface"])
def test_each_is_listed_where_expressions_are_written(fleet, name):
    tree = QgsExpressionTreeView()
    assert [item.text() for item in tree.findExpressions(name)] == [name]


def test_they_go_with_the_plugin(qgis_app):
    store = SurfaceStore(QgsProject.instance())
    functions = ExpressionFunctions(store, SnapshotHolder())
    assert all(QgsExpression.isFunctionName(name) for name in NAMES)
    functions.remove()
    store.remove()
    assert not any(QgsExpression.isFunctionName(name) for name in NAMES)
