"""Chords of curves, and the normals of ramps."""

from __future__ import annotations

import math

import numpy as np
import pytest
import shapely
from hypothesis import given
from hypothesis import strategies as st

from robot_bridge.core.errors import ShapingError
from robot_bridge.core.robotmap.builder import build_map
from robot_bridge.core.robotmap.model import ShapeType
from robot_bridge.core.robotmap.parametric_shapes import SAGITTA, arc_points, ramp_normal
from tests.robot_bridge.core.robotmap.rows import outlines, row


@given(
    st.floats(0.05, 500),
    st.floats(0, math.tau),
    st.floats(-6.2, 6.2).filter(lambda t: abs(t) > 0.05),
    st.floats(0.1, 0.9),
)
def test_no_chord_is_farther_than_the_sagitta_from_its_arc(radius, first, turn, share):
    def at(angle):
        return np.array([100 + radius * math.cos(angle), 50 + radius * math.sin(angle)])

    points = arc_points(at(first), at(first + share * turn), at(first + turn))
    assert (points[0] == at(first)).all() and (points[-1] == at(first + turn)).all()
    off = np.hypot(*(points - (100, 50)).T)
    middles = np.hypot(*((points[:-1] + points[1:]) / 2 - (100, 50)).T)
    assert np.abs(off - radius).max() < 1e-4 * max(radius, 1)
    assert (radius - middles).max() <= SAGITTA + 1e-4 * max(radius, 1)
    length = np.hypot(*np.diff(points, axis=0).T).sum()
    assert length == pytest.approx(radius * abs(turn), rel=0.2)


def test_an_arc_goes_by_way_of_its_middle_point():
    over = arc_points((-1, 0), (0, 1), (1, 0))
    under = arc_points((-1, 0), (0, -1), (1, 0))
    assert over[:, 1].max() > 0.97 and over[:, 1].min() > -1e-9
    assert under[:, 1].min() < -0.97 and under[:, 1].max() < 1e-9


def test_three_points_on_a_line_are_that_line_and_a_circle_closes():
    assert arc_points((0, 0), (1, 1), (2, 2)).tolist() == [[0, 0], [2, 2]]
    circle = arc_points((1, 0), (-1, 0), (1, 0))
    assert (circle[0] == circle[-1]).all()
    assert shapely.Polygon(circle).area == pytest.approx(math.pi, rel=0.05)


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
