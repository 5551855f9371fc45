"""The expression function ``road_surface``, as QGIS evaluates it."""

from __future__ import annotations

import numpy as np
import pytest
from fleet_supervisor.plugin.expressions import ExpressionFunctions, SnapshotHolder
from fleet_supervisor.plugin.layers.road_surfaces import SurfaceStore
from fleet_supervisor.plugin.layers.roles import ROAD_SURFACE, set_role
from qgis.core import (
    NULL,
    QgsCoordinateReferenceSystem,
    QgsCoordinateTransform,
    QgsExpression,
    QgsExpressionContext,
    QgsExpressionContextUtils,
    QgsFeature,
    QgsGeometry,
    QgsPointXY,
    QgsProject,
)

AREA = "&field=surface:string&field=name:string&field=origin:string"
BOX = "POLYGON(({0} {1}, {2} {1}, {2} {3}, {0} {3}, {0} {1}))"
X, Y = 488000, 5190000


@pytest.fixture
def store(qgis_app):
    QgsProject.instance().clear()
    QgsProject.instance().setCrs(QgsCoordinateReferenceSystem("EPSG:32633"))
    store = SurfaceStore(QgsProject.instance())
    functions = ExpressionFunctions(store, SnapshotHolder())
    yield store
    functions.remove()
    store.remove()
    QgsProject.instance().clear()


@pytest.fixture
def ground(store, make_layer):
    features = [
        (BOX.format(X, Y, X + 100, Y + 100), "asphalt", "Yard", "generated"),
        (BOX.format(X + 10, Y + 10, X + 20, Y + 20), "slippery", None, None),
    ]
    layer = make_layer("Ground", "Polygon", AREA, features)
    set_role(layer, ROAD_SURFACE)
    QgsProject.instance().addMapLayer(layer)
    return layer


def value(text, layer=None, feature=None):
    """Return what QGIS makes of an expression; raises ValueError with what it says is wrong."""
    expression = QgsExpression(text)
    context = QgsExpressionContext(QgsExpressionContextUtils.globalProjectLayerScopes(layer))
    if feature is not None:
        context.setFeature(feature)
    expression.prepare(context)
    found = expression.evaluate(context)
    if expression.hasParserError() or expression.hasEvalError():
        raise ValueError(expression.parserErrorString() or expression.evalErrorString())
    return None if found == NULL else found


def test_places_in_the_crs_of_the_project(ground):
    assert value(f"road_surface({X + 50}, {Y + 50})") == "asphalt"
    assert value(f"road_surface({X + 15}, {Y + 15})") == "slippery"
    assert value(f"road_surface({X + 150}, {Y + 15})") is None
    assert value(f"road_surface({X + 150}, {Y + 15}) is null") == 1


def test_places_of_features_are_in_the_crs_of_their_layer(ground, make_layer):
    degrees = QgsCoordinateReferenceSystem("EPSG:4326")
    way = QgsCoordinateTransform(ground.crs(), degrees, QgsProject.instance())
    place = QgsGeometry.fromPointXY(way.transform(QgsPointXY(X + 15, Y + 15)))
    points = make_layer("points", "Point", "", [(place,)], crs="EPSG:4326")
    assert value("road_surface($x, $y)", points, next(points.getFeatures())) == "slippery"
    lon, lat = place.asPoint().x(), place.asPoint().y()
    assert value(f"road_surface({lon!r}, {lat!r}, crs:='EPSG:4326')") == "slippery"
    assert value(f"road_surface({lon!r}, {lat!r})") is None


def test_a_layer_can_be_named(ground, make_layer):
    other = make_layer("Other", "Polygon", AREA, [(BOX.format(X, Y, X + 9, Y + 9), "sand", None, None)])
    QgsProject.instance().addMapLayer(other)
    place = f"{X + 5}, {Y + 5}"
    assert value(f"road_surface({place})") == "asphalt"
    for named in ("'Other'", f"'{other.id()}'", "layer:='Other'"):
        assert value(f"road_surface({place}, {named})") == "sand"
    assert value(f"road_surface({place}, 'Other', 'EPSG:4326')") is None


def test_null_in_null_out(ground):
    assert value(f"road_surface(NULL, {Y})") is None
    assert value("road_surface($x, $y)", ground, QgsFeature(ground.fields())) is None


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("road_surface(1)", "wrong number of arguments"),
        ("road_surface('here', 2)", "x is 'here' and y is 2; give two numbers"),
        ("road_surface(1, 2, 'Ocean')", "no vector layer of the project has the name or id 'Ocean'"),
        ("road_surface(1, 2, crs:='EPSG:99999')", "crs 'EPSG:99999' is no CRS that QGIS knows"),
    ],
)
def test_what_is_wrong_is_said(ground, text, said):
    with pytest.raises(ValueError, match=said):
        value(text)


def test_without_surfaces_it_says_what_to_do(store):
    with pytest.raises(ValueError, match="no layer of the project has the role road_surface; set it in"):
        value("road_surface(1, 2)")


def test_changes_of_the_layer_count_at_once(ground):
    place = f"road_surface({X + 15}, {Y + 15})"
    assert value(place) == "slippery"
    ground.startEditing()
    ground.deleteFeature(2)
    assert value(place) == "asphalt"
    ground.rollBack()
    assert value(place) == "slippery"
    set_role(ground, "")
    with pytest.raises(ValueError, match="no layer of the project has the role"):
        value(place)


def test_a_layer_is_read_once_for_all_features(ground, store, make_layer, monkeypatch):
    from fleet_supervisor.plugin.layers import road_surfaces as surface_store

    reads = []
    real = surface_store.read_surface_map
    monkeypatch.setattr(surface_store, "read_surface_map", lambda *a: reads.append(1) or real(*a))
    places = np.random.default_rng(1).uniform(0, 100, (500, 2)) + np.array((X, Y))
    points = make_layer("points", "Point", "", [(f"POINT({x} {y})",) for x, y in places.tolist()])
    context = QgsExpressionContext(QgsExpressionContextUtils.globalProjectLayerScopes(points))
    expression = QgsExpression("road_surface($x, $y)")
    expression.prepare(context)
    found = []
    for feature in points.getFeatures():
        context.setFeature(feature)
        found.append(expression.evaluate(context))
    slippery = ((places >= (X + 10, Y + 10)) & (places <= (X + 20, Y + 20))).all(axis=1)
    assert found == np.where(slippery, "slippery", "asphalt").tolist()
    assert value(f"road_surface({X}, {Y})") == "asphalt"
    assert reads == [1]


def test_the_help_is_in_its_place_and_the_function_goes_with_the_plugin(qgis_app):
    store = SurfaceStore(QgsProject.instance())
    functions = ExpressionFunctions(store, SnapshotHolder())
    known = QgsExpression.Functions()[QgsExpression.functionIndex("road_surface")]
    assert "class of the road surface at a place" in known.helpText()
    assert known.group() == "Fleet"
    functions.remove()
    assert QgsExpression.functionIndex("road_surface") == -1
