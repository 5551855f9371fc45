"""What can be asked of outlines: each thing does what it says, and nothing where nothing is asked."""

from __future__ import annotations

import sys

import numpy as np
import pytest
import shapely
from hypothesis import assume, example, given
from hypothesis import strategies as st

from robot_bridge.core.errors import MissingGeometryError, ShapingError
from robot_bridge.core.robotmap.builder import build_map
from robot_bridge.core.robotmap.model import ShapeType, Window
from robot_bridge.core.robotmap.shaping import Shaping, shaped
from robot_bridge.core.robotmap.text_format import write_text
from tests.robot_bridge.core.robotmap.rows import box, is_chain, outlines, ring, row

EVERYTHING = Shaping((0.1, 2.0), 0.5, dissolve=True, chain=True, tolerance=0.05, shortest=0.1)


def after(shaping, *rows):
    return shaped(outlines(*rows), shaping).rows()


def lines(rows):
    return shapely.union_all([shapely.LineString(r.points) for r in rows])


def test_nothing_asked_changes_nothing():
    some = outlines(box(0, 0, 4, 4), box(1, 1, 2, 2, courtyard=True), row([(0, 0), (0.01, 0), (9, 9)]))
    window = Window(2, 2, 30, 30)
    assert write_text(build_map(shaped(some, Shaping()), window)) == write_text(build_map(some, window))


def test_what_is_broken_stays_for_the_builder_to_name():
    broken = [
        row([(0, 0), (float("nan"), 1)], source="l:1"),
        row([(0, 0)], source="l:2"),
        ring([(0, 0), (2, 2), (2, 0), (0, 2)], source="l:3"),
        row([], source="l:4"),
        row([(0, 0), (1, 0), (2, 0)], ShapeType.STAIRS, source="l:5"),
        row([(0, 0), (0, 5)], height=float("inf"), source="l:6"),
    ]
    assert {r.source for r in after(EVERYTHING, *broken)} == {f"l:{k}" for k in range(1, 7)}


@pytest.mark.parametrize(
    "wrong", [{"tolerance": -1}, {"shortest": float("nan")}, {"height_step": float("inf")}, {"plane": (2, 1)}]
)
def test_what_cannot_be_asked_is_refused_by_name(wrong):
    with pytest.raises(ShapingError, match=next(iter(wrong))):
        Shaping(**wrong)


@pytest.mark.parametrize("asked", [{"dissolve": True}, {"tolerance": 0.1}, {"shortest": 0.1}])
def test_without_shapely_it_says_what_to_install(monkeypatch, asked):
    monkeypatch.setitem(sys.modules, "shapely", None)
    with pytest.raises(MissingGeometryError, match="pip install shapely"):
        after(Shaping(**asked), ring([(0, 0), (1, 0), (1, 1), (0.5, 1.1), (0, 1)]))


def test_the_robots_plane_leaves_out_what_is_below_and_above_it():
    def at(base, height, **more):
        return row([(0, 0), (9, 0)], base=base, height=height, source=f"{base:g}+{height:g}", **more)

    rows = [at(0, 0.3), at(0, 0.31), at(1.99, 1), at(2, 1), at(-5, 5), at(-5, 9), at(0, float("nan"))]
    ramp, stairs = at(3, 0, shape_type=ShapeType.RAMP), at(4, 0.17, shape_type=ShapeType.STAIRS)
    kept = after(Shaping(plane=(0.3, 2.0)), *rows, ramp, stairs)
    assert [r.source for r in kept] == ["0+0.31", "1.99+1", "-5+9", "0+nan", "3+0", "4+0.17"]


def test_heights_are_rounded_up_to_a_step():
    kept = after(Shaping(height_step=0.1), *(row([(0, 0), (9, 0)], height=h) for h in (0, 0.3, 0.31, 2.999)))
    assert [r.height for r in kept] == [0, 0.3, 0.4, 3.0]


def test_faces_that_meet_end_to_end_are_one_wall_in_the_direction_of_the_first():
    faces = [
        row([(5, 0), (9, 0)], source="walls:1"),
        row([(9, 0), (9, 4)], source="walls:2"),
        row([(0, 0), (5, 0.004)], source="walls:3"),
        row([(0, 8), (0, 0)], source="walls:4"),
        row([(0, 8), (-3, 8)], source="walls:5"),
    ]
    (wall,) = after(Shaping(chain=True), *faces)
    assert wall.points.tolist() == [[-3, 8], [0, 8], [0, 0], [5, 0.004], [9, 0], [9, 4]]
    assert wall.source == "walls:1+4"


@pytest.mark.parametrize(
    "difference",
    [{"height": 2.5}, {"semantics": "fence"}, {"outdoor": False}, {"base": 1.0}, {"ext": {"h": "est"}}],
)
def test_faces_that_differ_are_not_joined(difference):
    assert len(after(Shaping(chain=True), row([(0, 0), (5, 0)]), row([(5, 0), (9, 0)], **difference))) == 2


def test_where_three_faces_meet_none_is_joined():
    faces = [row([(0, 0), (5, 0)]), row([(5, 0), (9, 0)]), row([(5, 0), (5, 4)])]
    assert len(after(Shaping(chain=True), *faces)) == 3


def test_faces_that_go_round_are_one_wall_that_ends_where_it_begins():
    corners = [(0, 0), (5, 0), (5, 5), (0, 5)]
    faces = [row([corners[k], corners[(k + 1) % 4]][:: (-1) ** k]) for k in range(4)]
    (wall,) = after(Shaping(chain=True), *faces)
    assert wall.points.tolist() == [[0, 0], [5, 0], [5, 5], [0, 5], [0, 0]]
    assert wall.shape_type is ShapeType.OPEN_POLYGON


@given(st.lists(st.tuples(*[st.integers(0, 4)] * 4), max_size=25))
def test_chaining_keeps_every_face(ends):
    faces = [
        row([(a, b), (c, d)], source=f"w:{k}") for k, (a, b, c, d) in enumerate(ends) if (a, b) != (c, d)
    ]
    joined = after(Shaping(chain=True), *faces)

    def pairs(rows):
        both = [
            sorted([tuple(p), tuple(q)]) for r in rows for p, q in zip(r.points, r.points[1:], strict=False)
        ]
        return sorted(both)

    assert pairs(joined) == pairs(faces)
    assert sum(1 + int(r.source.partition("+")[2] or 0) for r in joined) == len(faces)


def test_a_wall_between_two_buildings_goes_and_each_keeps_its_height_outside():
    low, high = box(0, 0, 10, 10, height=3, source="b:1"), box(10, 2, 20, 8, height=9, source="b:2")
    kept = after(Shaping(dissolve=True), low, high)
    assert {r.source: r.height for r in kept} == {"b:1": 3, "b:2": 9}
    assert {r.shape_type for r in kept} == {ShapeType.OPEN_POLYGON}
    outside = shapely.union(shapely.box(0, 0, 10, 10), shapely.box(10, 2, 20, 8)).boundary
    assert shapely.equals(lines(kept), outside)


def test_free_space_is_to_the_right_of_what_is_left_of_an_outline():
    kept = shaped(outlines(box(0, 0, 10, 10), box(10, 2, 20, 8), box(0, 10, 5, 15)), Shaping(dissolve=True))
    solid = shapely.union_all(
        [shapely.box(0, 0, 10, 10), shapely.box(10, 2, 20, 8), shapely.box(0, 10, 5, 15)]
    )
    for obstacle in build_map(kept).obstacles:
        assert is_chain(obstacle)
        step = obstacle.b - obstacle.a
        right = (obstacle.a + obstacle.b) / 2 + np.column_stack([step[:, 1], -step[:, 0]]) * 0.001
        assert not shapely.contains_xy(solid, right).any()


def test_buildings_around_a_court_leave_its_outline_clockwise():
    around = [box(0, 0, 9, 3), box(0, 6, 9, 9), box(0, 3, 3, 6), box(6, 3, 9, 6)]
    kept = after(Shaping(dissolve=True), *around)
    inner = [r for r in kept if (np.abs(r.points - 4.5) <= 1.51).all()]
    assert lines(inner).length == pytest.approx(12)
    for r in inner:
        (x1, y1), (x2, y2) = r.points[0] - 4.5, r.points[1] - 4.5
        assert x1 * y2 - x2 * y1 < 0


def test_a_building_that_touches_none_stays_as_it_is_and_a_courtyard_with_it():
    alone = [box(0, 0, 9, 9), box(2, 2, 4, 4, courtyard=True)]
    kept = after(
        Shaping(dissolve=True), *alone, box(20, 0, 30, 9, source="b:2"), box(30, 0, 35, 9, source="b:3")
    )
    assert (kept[0].points == alone[0].points).all() and (kept[1].points == alone[1].points).all()
    assert kept[1].courtyard


def test_the_same_building_twice_is_there_once():
    kept = after(Shaping(dissolve=True), box(0, 0, 9, 9, source="b:1"), box(0, 0, 9, 9, source="b:2"))
    assert [(r.source, r.shape_type) for r in kept] == [("b:1", ShapeType.CLOSED_POLYGON)]


def test_lines_inside_and_along_a_building_go_and_the_rest_stays():
    kept = after(
        Shaping(dissolve=True),
        box(0, 0, 10, 10),
        row([(2, 2), (8, 8)], source="inside"),
        row([(0, -0.03), (10, -0.03)], source="along"),
        row([(5, 5), (5, 20)], source="out"),
        row([(30, 0), (30, 5)], source="away"),
    )
    assert [r.source for r in kept] == ["buildings:1", "out", "away"]
    assert sorted(kept[1].points[:, 1].tolist()) == pytest.approx([10.05, 20])


@pytest.mark.parametrize("low", [{"height": 0.12}, {"height": 1.0, "base": 4.0}], ids=["kerb", "roof"])
def test_what_robots_come_onto_or_under_hides_nothing(low):
    rows = [
        box(0, 0, 40, 40, source="low:1", **low),
        box(10, 10, 20, 20, source="house:1", height=6.0),
        box(20, 10, 30, 20, source="house:2", height=6.0),
        row([(30, 30), (35, 35)], source="wall:1"),
    ]
    kept = after(Shaping(dissolve=True), *rows)
    assert {r.source for r in kept} == {"low:1", "house:1", "house:2", "wall:1"}
    houses = [r for r in kept if r.source.startswith("house")]
    assert shapely.equals(lines(houses), shapely.box(10, 10, 30, 20).boundary)


boxes = st.tuples(*[st.integers(0, 12)] * 2, *[st.integers(1, 6)] * 2)


@given(st.lists(boxes, min_size=1, max_size=7))
def test_dissolved_outlines_are_the_boundary_of_all_together(some):
    corners = [(x, y, x + w, y + h) for x, y, w, h in some]
    kept = after(Shaping(dissolve=True), *(box(*c, source=f"b:{k}") for k, c in enumerate(corners)))
    boundary = shapely.union_all([shapely.box(*c) for c in corners]).boundary
    assert shapely.hausdorff_distance(lines(kept), boundary) < 0.001
    assert sum(shapely.LineString(r.points).length for r in kept) == pytest.approx(boundary.length)


coordinate = st.integers(0, 300).map(lambda n: n / 100)
corners = st.lists(st.tuples(coordinate, coordinate), min_size=3, max_size=14, unique=True)


# A line back to its beginning: what comes off its end is farther from it than from the corner before.
@example([(0.0, 0.0), (0.03, 0.0), (0.04, 0.0), (0.01, 0.01)], False, 0.03)
# A ring whose first corner GEOS moves farther than it was told to.
@example([(0.01, 0.02), (0.0, 0.03), (0.0, 0.0), (0.03, 0.0), (0.01, 0.01)], True, 0.02)
@given(corners, st.booleans(), st.integers(1, 60).map(lambda n: n / 100))
def test_a_simplified_outline_is_within_its_tolerance_and_never_crosses_itself(points, closed, tolerance):
    drawn = ring(points) if closed else row(points)
    before = shapely.Polygon(points) if closed else shapely.LineString(points)
    assume(before.is_valid and before.is_simple)
    (kept,) = after(Shaping(tolerance=tolerance), drawn)
    line = shapely.LineString(kept.points)
    assert line.is_simple and line.is_closed == closed
    assert shapely.hausdorff_distance(line, shapely.LineString(drawn.points)) <= tolerance + 1e-9
    (fewer,) = after(Shaping(shortest=tolerance), drawn)
    line = shapely.LineString(fewer.points)
    assert line.is_simple and line.is_closed == closed
    assert shapely.hausdorff_distance(line, shapely.LineString(drawn.points)) <= tolerance + 1e-9


def test_simplifying_leaves_out_corners_that_say_little():
    (kept,) = after(Shaping(tolerance=0.1), row([(0, 0), (2, 0.09), (4, 0), (4, 4)]))
    assert kept.points.tolist() == [[0, 0], [4, 0], [4, 4]]


def test_short_segments_go_and_a_small_thing_stays():
    saw = row([(0, 0), (0.05, 0), (0.1, 0), (3, 0), (3.05, 0)], source="saw")
    bin_ = box(5, 5, 5.2, 5.2, source="bin")
    saw, bin_ = after(Shaping(shortest=0.3), saw, bin_)
    assert saw.points.tolist() == [[0, 0], [3.05, 0]]
    assert len(bin_.points) >= 4


def test_the_campus_shrinks_below_the_papers_three_bytes_and_loses_no_building(data):
    import pyogrio

    file = data / "upc_campus_nord" / "upc_campus_nord_local.gpkg"
    rows = []
    for layer in ("buildings", "walls"):
        _, ids, wkb, (height,) = pyogrio.raw.read(file, layer, columns=["height"], return_fids=True)
        for fid, shape, h in zip(ids, shapely.from_wkb(wkb), height, strict=True):
            points = shapely.get_coordinates(shape)
            kind = {"shape_type": ShapeType.CLOSED_POLYGON} if layer == "buildings" else {}
            rows.append(row(points, height=h, semantics=layer, source=f"{layer}:{fid}", **kind))
    window = Window(48, 48, 104, 104)
    before = build_map(outlines(*rows), window)
    made = build_map(shaped(outlines(*rows), Shaping(dissolve=True, chain=True)), window)
    assert len(made.obstacles) < len(before.obstacles) / 2
    kept = {o.ext["src"] for o in made.obstacles if o.semantics == "buildings"}
    assert kept == {o.ext["src"] for o in before.obstacles if o.semantics == "buildings"}
