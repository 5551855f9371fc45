"""Points and extents come into the CRS that is asked for, or are refused: never taken as they are."""

from __future__ import annotations

import pytest
from fleet_supervisor.plugin.processing.algorithms.cone_layouts import ConeLayout
from fleet_supervisor.plugin.processing.algorithms.export_robot_map import ExportRobotMap
from fleet_supervisor.plugin.processing.common.algorithm import ParameterError
from fleet_supervisor.plugin.processing.common.parameters import extent_in, point_in
from qgis.core import (
    QgsCoordinateReferenceSystem,
    QgsPointXY,
    QgsProcessingContext,
    QgsProcessingException,
    QgsProject,
    QgsReferencedPointXY,
)

UTM = QgsCoordinateReferenceSystem("EPSG:32633")
DEGREES = QgsCoordinateReferenceSystem("EPSG:4326")
YARD = QgsCoordinateReferenceSystem(
    'ENGCRS["yard",EDATUM["yard"],CS[Cartesian,2],AXIS["x",east],AXIS["y",north],LENGTHUNIT["metre",1]]'
)
"""A CRS of its own, of which nobody knows where on the Earth it is."""
NO_PLACE = r"has no place in the CRS EPSG:32633 .*: give finite numbers, x or longitude first"


@pytest.fixture
def context(qgis_app):
    """What an algorithm runs in, of a project in degrees."""
    project = QgsProject()
    project.setCrs(DEGREES)
    made = QgsProcessingContext()
    made.setProject(project)
    yield made
    made.setProject(None)


def point(given, context):
    return point_in(ConeLayout().create(), {"POINT": given}, "POINT", context, UTM)


def extent(given, context):
    return extent_in(ExportRobotMap().create(), {"EXTENT": given}, "EXTENT", context, UTM)


def test_a_point_that_names_no_crs_is_where_it_says_whatever_the_project_is_in(context):
    assert point("500010,5000000", context) == (500010.0, 5000000.0)
    assert point(QgsPointXY(500010, 5000000), context) == (500010.0, 5000000.0)


@pytest.mark.parametrize("given", ["15,45 [EPSG:4326]", QgsReferencedPointXY(QgsPointXY(15, 45), DEGREES)])
def test_a_point_in_another_crs_is_transformed(context, given):
    x, y = point(given, context)
    assert (x, y) == (pytest.approx(500000.0, abs=0.01), pytest.approx(4982950.4, abs=0.1))


@pytest.mark.parametrize(
    "given", ["15,95 [EPSG:4326]", QgsReferencedPointXY(QgsPointXY(15, 95), DEGREES), "nan,5"]
)
def test_a_point_without_a_place_is_refused(context, given):
    with pytest.raises(ParameterError, match=f"POINT .* {NO_PLACE}"):
        point(given, context)


def test_an_extent_comes_with_its_corners_or_is_refused(context):
    corners = extent("0,10,20,30", context)
    assert (corners.min(axis=0).tolist(), corners.max(axis=0).tolist()) == ([0, 20], [10, 30])
    with pytest.raises(ParameterError, match=f"EXTENT .* {NO_PLACE}"):
        extent("15,15.1,95,95.1 [EPSG:4326]", context)


def test_degrees_are_not_taken_for_the_metres_of_a_local_crs(context):
    no_way = r"2.11,41.38.* \[EPSG:4326\] is in the CRS EPSG:4326 .* no known relation to the CRS yard"
    with pytest.raises(ParameterError, match=f"POINT {no_way}"):
        point_in(ConeLayout().create(), {"POINT": "2.11,41.38 [EPSG:4326]"}, "POINT", context, YARD)
    with pytest.raises(ParameterError, match=f"EXTENT {no_way}"):
        given = {"EXTENT": "2.11,41.38,2.12,41.39 [EPSG:4326]"}
        extent_in(ExportRobotMap().create(), given, "EXTENT", context, YARD)


@pytest.mark.parametrize(
    ("algorithm", "parameters"),
    [
        ("conelayout", {"LAYOUT": "slalom", "POINT": "15,95 [EPSG:4326]"}),
        ("importconelayout", {"ORIGIN": "15,95 [EPSG:4326]"}),
    ],
)
def test_no_cone_is_placed_where_degrees_are_taken_for_metres(run_for_cones, tmp_path, algorithm, parameters):
    table = tmp_path / "one.csv"
    table.write_text("x_m,y_m\n0,0\n", encoding="utf-8")
    given = {"FILE": str(table)} if algorithm == "importconelayout" else {}
    with pytest.raises(QgsProcessingException, match=r"15,95 \[EPSG:4326\] has no place in the CRS"):
        run_for_cones(f"fleet:{algorithm}", **given, **parameters)
