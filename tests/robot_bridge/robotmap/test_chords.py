"""Chords of curves, small things by their radius, and the normals of ramps."""

from __future__ import annotations

import math

import numpy as np
import pytest
import shapely
from hypothesis import given
from hypothesis import strategies as st

from robot_bridge.robotmap.builder import build_map
from robot_bridge.robotmap.chords import SAGITTA, arc, around, ramp_normal, template_at
from robot_bridge.robotmap.errors import ShapingError
from robot_bridge.robotmap.model import ShapeType

from .rows import outlines, row, signed_area


@given(
    st.floats(0.05, 500),
    st.floats(0, math.tau),
    st.floats(-6.2, 6.2).filter(lambda t: abs(t) > 0.05),
    st.floats(0.1, 0.9),
)
def test_no_chord_is_farther_than_the_sagitta_from_its_arc(radius, first, turn, share):
    def at(angle):
        return np.array([100 + radius * math.cos(angle), 50 + radius * math.sin(angle)])

    points = arc(at(first), at(first + share * turn), at(first + turn))
    assert (points[0] == at(first)).all() and (points[-1] == at(first + turn)).all()
    off = np.hypot(*(points - (100, 50)).T)
    middles = np.hypot(*((points[:-1] + points[1:]) / 2 - (100, 50)).T)
    assert np.abs(off - radius).max() < 1e-4 * max(radius, 1)
    assert (radius - middles).max() <= SAGITTA + 1e-4 * max(radius, 1)
    length = np.hypot(*np.diff(points, axis=0).T).sum()
    assert length == pytest.approx(radius * abs(turn), rel=0.2)


def test_an_arc_goes_by_way_of_its_middle_point():
    over = arc((-1, 0), (0, 1), (1, 0))
    under = arc((-1, 0), (0, -1), (1, 0))
    assert over[:, 1].max() > 0.97 and over[:, 1].min() > -1e-9
    assert under[:, 1].min() < -0.97 and under[:, 1].max() < 1e-9


def test_three_points_on_a_line_are_that_line_and_a_circle_closes():
    assert arc((0, 0), (1, 1), (2, 2)).tolist() == [[0, 0], [2, 2]]
    circle = arc((1, 0), (-1, 0), (1, 0))
    assert (circle[0] == circle[-1]).all()
    assert shapely.Polygon(circle).area == pytest.approx(math.pi, rel=0.05)


@given(st.floats(0.01, 50), st.floats(-1e6, 1e6))
def test_a_round_thing_lies_inside_its_ring_and_the_ring_is_near_it(radius, x):
    ring = around(x, -x, radius)
    assert (ring[0] == ring[-1]).all()
    reach = np.hypot(*(ring - (x, -x)).T)
    middles = np.hypot(*((ring[:-1] + ring[1:]) / 2 - (x, -x)).T)
    assert reach.max() <= radius + SAGITTA + 1e-6
    assert middles.min() >= radius - 1e-6


def test_a_lamp_post_is_a_closed_curve_in_the_map():
    post = row(
        around(3, 4, 0.15), ShapeType.CLOSED_CURVE, semantics="lamp_post", source="furniture:5", height=4
    )
    (obstacle,) = build_map(outlines(post)).obstacles
    assert obstacle.shape_type is ShapeType.CLOSED_CURVE and signed_area(obstacle) > math.pi * 0.15**2


def test_a_bench_is_its_template_turned_to_where_it_stands():
    template = np.array([(-1, -0.25), (1, -0.25), (1, 0.25), (-1, 0.25), (-1, -0.25)])
    placed = template_at(10, 20, template, math.pi / 2)
    assert placed[0] == pytest.approx([10.25, 19]) and placed[1] == pytest.approx([10.25, 21])


def test_a_ramp_carries_the_upward_normal_of_its_surface():
    slope = [(0, 0, 0), (2, 0, 0), (2, 5, 0.5), (0, 5, 0.5)]
    assert ramp_normal(slope) == ramp_normal(slope[::-1]) == "0,-0.0995,0.995"
    flat = row(
        [(0, 0), (2, 0), (2, 5), (0, 5), (0, 0)], ShapeType.RAMP, height=0, ext={"n": ramp_normal(slope)}
    )
    (obstacle,) = build_map(outlines(flat)).obstacles
    assert obstacle.ext == {"src": "walls:1", "n": "0,-0.0995,0.995"}


def test_an_estimated_height_is_marked():
    (obstacle,) = build_map(outlines(row([(0, 0), (5, 0)], ext={"h": "est"}))).obstacles
    assert obstacle.ext["h"] == "est"


@pytest.mark.parametrize(
    "points", [[(0, 0, 0), (1, 0, 0), (2, 0, 0)], [(0, 0, 0), (1, 0, 0), (1, 0, 1), (0, 0, 1)]]
)
def test_what_is_no_ramp_has_no_normal(points):
    with pytest.raises(ShapingError, match="ramp"):
        ramp_normal(points)


@pytest.mark.parametrize("radius", [0, -1, math.nan, math.inf])
def test_a_radius_must_be_above_0(radius):
    with pytest.raises(ShapingError):
        around(0, 0, radius)
