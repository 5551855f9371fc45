"""Normals of ramps, and estimated heights."""

from __future__ import annotations

import pytest

from robot_bridge.core.errors import ShapingError
from robot_bridge.core.robotmap.builder import build_map
from robot_bridge.core.robotmap.model import ShapeType
from robot_bridge.core.robotmap.parametric_shapes import ramp_normal
from tests.robot_bridge.core.robotmap.rows import outlines, row


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
