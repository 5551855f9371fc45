"""Clipping, checked against shapely, which knows nothing of it."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
import shapely
from hypothesis import assume, given
from hypothesis import strategies as st

from robot_bridge.core.robotmap.builder import build_map
from robot_bridge.core.robotmap.model import ShapeType, Window
from tests.robot_bridge.core.robotmap.rows import is_chain, outlines, ring, row

WINDOW = Window(0, 0, 20, 12)
RECTANGLE = shapely.box(*WINDOW.border)
CENTIMETRE = 0.01

near = st.integers(-1500, 1500).map(lambda cm: cm / 100)
# Beside any place also places on the border and a centimetre off it.
xs = st.one_of(near, st.sampled_from([-10.0, 10.0, -10.01, 9.99, 10.01]))
ys = st.one_of(near, st.sampled_from([-6.0, 6.0, -6.01, 5.99, 6.01]))
points = st.tuples(xs, ys)
lines = st.lists(points, min_size=2, max_size=7).filter(lambda line: len(set(line)) > 1)
rings = (
    st.lists(points, min_size=3, max_size=8, unique=True)
    .map(lambda corners: shapely.MultiPoint(corners).convex_hull)
    .filter(lambda hull: hull.geom_type == "Polygon" and hull.area > 0.01)
)


def segments(robot_map):
    a = np.concatenate([np.empty((0, 2)), *(o.a for o in robot_map.obstacles)])
    b = np.concatenate([np.empty((0, 2)), *(o.b for o in robot_map.obstacles)])
    return a, b


def length(a, b):
    return float(np.hypot(*(b - a).T).sum())


def pieces(line):
    """The parts of each segment of ``line`` inside the window, without parts that are only a point."""
    clipped = [shapely.LineString(pair).intersection(RECTANGLE) for pair in pairwise(line)]
    return [part for part in clipped if part.length > 0]


@given(lines)
def test_segments_lie_inside_the_window(line):
    a, b = segments(build_map(outlines(row(line)), WINDOW))
    for ends in (a, b):
        assert ((np.abs(ends) <= (10, 6)).all(axis=1)).all()


@given(lines)
def test_the_length_inside_is_the_one_shapely_finds(line):
    found = pieces(line)
    # Both ends of a part are rounded to centimetres, a part in a corner towards the inside.
    tolerance = 4 * CENTIMETRE * len(found) + 1e-9
    made = length(*segments(build_map(outlines(row(line)), WINDOW)))
    assert abs(made - sum(part.length for part in found)) <= tolerance


@given(lines)
def test_every_segment_lies_on_the_line_it_comes_from(line):
    a, b = segments(build_map(outlines(row(line)), WINDOW))
    drawn = shapely.LineString(line).buffer(2 * CENTIMETRE)
    assert all(drawn.covers(shapely.LineString(pair)) for pair in zip(a, b, strict=True))


@given(lines)
def test_every_end_that_is_no_corner_of_the_line_lies_on_the_border(line):
    ends = np.concatenate(segments(build_map(outlines(row(line)), WINDOW)))
    corner = (ends[:, None] == np.array(line)).all(axis=2).any(axis=1)
    on_border = (np.abs(ends) == (10, 6)).any(axis=1)
    assert (corner | on_border).all()


@pytest.mark.parametrize("first", [0.0, -0.0, 0.0004, -0.0004])
@pytest.mark.parametrize("last", [0.0, -0.0, 0.0004, -0.0004])
def test_a_wall_along_an_axis_is_kept_whatever_the_sign_of_its_zeros(first, last):
    for line in ([(first, -3), (last, 3)], [(-3, first), (3, last)]):
        assert length(*segments(build_map(outlines(row(line)), WINDOW))) == 6


@pytest.mark.parametrize("sign", [(1, 1), (1, -1), (-1, 1), (-1, -1)])
def test_the_stub_of_a_segment_in_a_corner_is_no_wall_along_the_border(sign):
    across = np.array([(-10.03, -5.94), (-9.98, -6.03)]) * sign
    a, b = segments(build_map(outlines(row(across)), WINDOW))
    assert (a * sign).tolist() == [[-10, -5.99]] and (b * sign).tolist() == [[-9.99, -6]]


@given(st.one_of(lines, rings.map(lambda hull: list(hull.exterior.coords))))
def test_no_segment_lies_on_the_border_unless_one_of_the_input_does(line):
    a, b = segments(build_map(outlines(row(line)), WINDOW))
    start, end = np.array(line[:-1]), np.array(line[1:])
    for axis, sides in ((0, (-10, 10)), (1, (-6, 6))):
        for side in sides:
            if ((a[:, axis] == side) & (b[:, axis] == side)).any():
                assert ((start[:, axis] == side) & (end[:, axis] == side)).any()


@given(rings, st.booleans())
def test_the_free_space_stays_on_the_right_of_what_is_left_of_a_ring(hull, clockwise):
    # On a sliver a step to the left lands beyond the other side.
    assume(shapely.minimum_clearance(hull) > 10 * CENTIMETRE)
    corners = list(hull.exterior.coords)[:-1]
    robot_map = build_map(outlines(ring(corners[::-1] if clockwise else corners)), WINDOW)
    for obstacle in robot_map.obstacles:
        assert is_chain(obstacle)
        middle, along = (obstacle.a + obstacle.b) / 2, obstacle.b - obstacle.a
        long = np.hypot(*along.T) > 20 * CENTIMETRE
        left = middle + np.c_[-along[:, 1], along[:, 0]] / np.hypot(*along.T)[:, None] * 3 * CENTIMETRE
        inside = shapely.covers(hull.buffer(3 * CENTIMETRE), shapely.points(left))
        assert inside[long].all()


@given(rings)
def test_a_ring_is_closed_if_and_only_if_the_window_holds_all_of_it(hull):
    robot_map = build_map(outlines(ring(list(hull.exterior.coords)[:-1])), WINDOW)
    closed = any(o.shape_type == ShapeType.CLOSED_POLYGON for o in robot_map.obstacles)
    assert closed == RECTANGLE.covers(hull)


@given(rings)
def test_a_cut_ring_has_no_more_chains_than_its_boundary_has_parts_inside(hull):
    robot_map = build_map(outlines(ring(list(hull.exterior.coords)[:-1])), WINDOW)
    inside = shapely.line_merge(hull.exterior.intersection(RECTANGLE))
    parts = [part for part in shapely.get_parts(inside) if part.length > 0]
    assert len(robot_map.obstacles) <= len(parts)
    assert len(robot_map.obstacles) >= sum(part.length > 5 * CENTIMETRE for part in parts)
