"""One geometry becomes rings, lines and risers; what is broken is repaired or named."""

from __future__ import annotations

import math

import numpy as np
import pytest
import shapely
from fleet_supervisor.plugin.layers.geometry import NO_PLACE, SAGITTA_M, polygons_of, shapes_of
from fleet_supervisor.plugin.layers.roles import RAMP, STAIRS
from fleet_supervisor.robot_bridge.core.robotmap.model import ShapeType
from qgis.core import QgsGeometry, QgsPointXY

SQUARE = "(0 0, 10 0, 10 10, 0 10, 0 0)"


def shapes(wkt, role=""):
    return shapes_of(QgsGeometry.fromWkt(wkt), role)


def area(found):
    sign = [-1 if shape.courtyard else 1 for shape in found]
    return sum(s * shapely.Polygon(shape.points).area for s, shape in zip(sign, found, strict=True))


@pytest.mark.parametrize("z", ["", "Z", "M", "ZM"])
def test_a_polygon_is_its_shell_and_its_courtyards_whatever_else_its_points_carry(qgis_app, z):
    extra = " 7" * len(z)
    rings = [SQUARE, "(2 2, 2 4, 4 4, 2 2)"]
    with_extra = [ring.replace(",", f"{extra},").replace(")", f"{extra})") for ring in rings]
    found, notes = shapes(f"MultiPolygon{z}(({', '.join(with_extra)}))")
    assert notes == []
    assert [(s.shape_type, s.courtyard) for s in found] == [
        (ShapeType.CLOSED_POLYGON, False),
        (ShapeType.CLOSED_POLYGON, True),
    ]
    assert found[0].points.tolist() == [[0, 0], [10, 0], [10, 10], [0, 10], [0, 0]]
    assert found[1].points.tolist() == [[2, 2], [2, 4], [4, 4], [2, 2]]


def test_a_ring_that_crosses_itself_is_repaired_and_the_place_is_named(qgis_app):
    found, notes = shapes("Polygon((0 0, 10 10, 10 0, 0 10, 0 0))")
    assert area(found) == pytest.approx(50)
    assert notes == ["the polygon is broken at (5.00 5.00): Self-intersection; it was repaired"]
    assert all(shapely.Polygon(shape.points).is_valid for shape in found)


@pytest.mark.parametrize(
    ("other", "whole"),
    [("(5 5, 15 5, 15 15, 5 15, 5 5)", 175), ("(2 2, 4 2, 4 4, 2 4, 2 2)", 100), (SQUARE, 100)],
    ids=["overlapping", "nested", "twice"],
)
def test_what_two_parts_have_in_common_is_of_both_and_no_hole(qgis_app, other, whole):
    found, notes = shapes(f"MultiPolygon(({SQUARE}), ({other}))")
    polygons = [shapely.Polygon(outer, holes) for outer, *holes in polygons_of(found)]
    assert shapely.union_all(polygons).area == pytest.approx(whole)
    assert len(notes) == 1 and notes[0].endswith("; it was repaired")


def test_a_flat_courtyard_is_left_out_and_the_polygon_stays(qgis_app):
    found, notes = shapes(f"Polygon({SQUARE}, (2 2, 3 3, 2 2))")
    assert [shape.courtyard for shape in found] == [False]
    assert notes == [
        "courtyard 1 of part 1 at (2.00 2.00) has 2 different points and encloses nothing; "
        "the courtyard is left out"
    ]


@pytest.mark.parametrize("ring", ["(7 8, 7 8)", "(7 8, 9 9, 7 8)", "(7 8, 8 8, 9 8, 7 8)"])
def test_a_flat_part_is_left_out_and_the_other_parts_stay(qgis_app, ring):
    found, notes = shapes(f"MultiPolygon(({SQUARE}), ({ring}))")
    assert area(found) == 100
    (note,) = notes
    assert note.startswith("the outer ring of part 2 at (7.00 8.00) has")
    assert note.endswith("encloses nothing; the part is left out")


def test_an_open_ring_is_closed(qgis_app):
    found, _ = shapes("Polygon((0 0, 10 0, 10 10, 0 10))")
    assert (found[0].points[0] == found[0].points[-1]).all()
    assert area(found) == 100


def test_a_circle_becomes_chords_no_farther_than_two_centimetres_from_it(qgis_app):
    (ring,), notes = shapes("CurvePolygon(CircularString(-10 0, 0 10, 10 0, 0 -10, -10 0))")
    assert (ring.shape_type, notes) == (ShapeType.CLOSED_CURVE, [])
    assert np.hypot(*ring.points.T) == pytest.approx(10, abs=1e-9)
    chords = np.hypot(*np.diff(ring.points, axis=0).T)
    sagitta = 10 - np.sqrt(100 - (chords / 2) ** 2)
    assert 0.005 < sagitta.max() <= SAGITTA_M
    assert len(ring.points) < 2 * math.pi / (2 * math.acos(1 - SAGITTA_M / 10)) * 1.5


def test_a_curved_line_is_an_open_curve_and_a_closed_line_stays_a_line(qgis_app):
    assert shapes("CircularString(0 0, 5 5, 10 0)").shapes[0].shape_type is ShapeType.OPEN_CURVE
    assert shapes("LineString(0 0, 5 5, 10 0, 0 0)").shapes[0].shape_type is ShapeType.OPEN_POLYGON


def test_points_in_a_collection_are_named_and_the_rest_is_read(qgis_app):
    found, notes = shapes(f"GeometryCollection(Point(1 1), LineString(0 0, 1 0), Polygon({SQUARE}))")
    assert len(found) == 2
    assert notes == ["has a point, which is no area or line; it is left out"]


def test_a_line_of_one_point_is_left_out_and_repeated_points_are_one(qgis_app):
    found, notes = shapes("MultiLineString((1 1, 1 1), (0 0, 0 0, 2 0))")
    assert [shape.points.tolist() for shape in found] == [[[0, 0], [2, 0]]]
    assert notes == ["line 1 has fewer than two different points; it is left out"]


@pytest.mark.parametrize("bad", [math.nan, math.inf, 1e12])
def test_coordinates_that_are_no_numbers_leave_the_feature_out(qgis_app, bad):
    line = QgsGeometry.fromPolylineXY([QgsPointXY(0, 0), QgsPointXY(bad, 1), QgsPointXY(2, 2)])
    assert shapes_of(line) == ([], [NO_PLACE])


def test_the_lines_of_a_stairs_feature_are_one_flight_bottom_first(qgis_app):
    (flight,), notes = shapes("MultiLineString((0 0, 4 0), (0 1, 2 1, 4 1), (0 2, 4 2))", STAIRS)
    assert (flight.shape_type, notes) == (ShapeType.STAIRS, [])
    assert flight.points.tolist() == [[0, 0], [4, 0], [0, 1], [4, 1], [0, 2], [4, 2]]


@pytest.mark.parametrize(
    "drawn", ["(0 0, 4 0), (4 1, 0 1), (0 2, 4 2)", "(4 0, 0 0), (4 1, 0 1), (4 2, 0 2)"]
)
def test_risers_run_from_left_to_right_seen_from_the_bottom(qgis_app, drawn):
    (flight,), _ = shapes(f"MultiLineString({drawn})", STAIRS)
    assert flight.points.tolist() == [[0, 0], [4, 0], [0, 1], [4, 1], [0, 2], [4, 2]]
    (down,), _ = shapes("MultiLineString((0 2, 4 2), (0 1, 4 1), (0 0, 4 0))", STAIRS)
    assert down.points.tolist() == [[4, 2], [0, 2], [4, 1], [0, 1], [4, 0], [0, 0]]


def test_a_bent_riser_is_named(qgis_app):
    _, notes = shapes("MultiLineString((0 0, 4 0), (0 1, 2 1.5, 4 1))", STAIRS)
    assert notes == ["riser 2 is bent; the straight line between its ends is used"]


def test_a_single_riser_stays_a_low_wall_and_a_ramp_is_a_ramp(qgis_app):
    assert shapes("LineString(0 0, 4 0)", STAIRS).shapes[0].shape_type is ShapeType.OPEN_POLYGON
    assert shapes(f"Polygon({SQUARE})", RAMP).shapes[0].shape_type is ShapeType.RAMP
