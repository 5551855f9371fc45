"""Layouts come to the site at a pose or along a line, and nothing but their place changes."""

from __future__ import annotations

import math

import numpy as np
import pytest

from robot_bridge.core.errors import LayoutLineError
from robot_bridge.core.layouts.catalogue import LAYOUTS
from robot_bridge.core.layouts.layout import Cone, cones_along_line, cones_at_pose


def cone(x: float, y: float, theta: float = 0.0) -> Cone:
    return Cone("a", 1, x, y, theta, "orange", "")


def test_a_pose_turns_and_moves() -> None:
    (made,) = cones_at_pose([cone(2, 1)], 100, 50, math.pi / 2)
    assert (made.x, made.y, made.theta) == pytest.approx((99, 52, math.pi / 2))


def test_thetas_stay_within_half_a_turn() -> None:
    (made,) = cones_at_pose([cone(0, 0, 3.0)], 0, 0, 3.0)
    assert made.theta == pytest.approx(6 - 2 * math.pi)


def test_along_a_straight_line_is_the_same_as_at_a_pose() -> None:
    cones = LAYOUTS["iso3888_1"].of({}).cones()
    theta, start = 0.7, 5.0
    end = np.array([math.cos(theta), math.sin(theta)]) * 140
    bent = cones_along_line(cones, np.array([[0, 0], end / 3, end]), start)
    straight = cones_at_pose(cones, start * math.cos(theta), start * math.sin(theta), theta)
    assert [(c.x, c.y, c.theta) for c in bent] == [
        pytest.approx((c.x, c.y, c.theta), abs=1e-9) for c in straight
    ]


def test_along_a_circle_cones_keep_their_distance_from_the_line() -> None:
    angles = np.linspace(0, math.pi, 721)
    line = 50 * np.stack([np.sin(angles), 1 - np.cos(angles)], axis=1)
    cones = LAYOUTS["corridor"].of({"length": 100, "width": 4, "cone_base": 0}).cones()
    for made in cones_along_line(cones, line):
        away = math.hypot(made.x, made.y - 50)
        assert away == pytest.approx(48 if made.role == "left" else 52, abs=0.01)


def test_a_cone_at_a_corner_stands_on_the_bisector() -> None:
    (made,) = cones_along_line([cone(10, 1)], np.array([[0, 0], [10, 0], [10, 10]]))
    assert (made.x, made.y) == pytest.approx((10 - math.sqrt(0.5), math.sqrt(0.5)))
    assert made.theta == pytest.approx(math.pi / 4)


@pytest.mark.parametrize(
    ("line", "start", "reason"),
    [
        ([[0, 0], [5, 0]], 0, "The line is 5.00 m long and the layout reaches to 10.00 m"),
        ([[0, 0], [50, 0]], -12, "The layout begins 2.00 m before the line"),
        ([[0, 0], [0, 0]], 0, "The line has no length"),
        ([[0, 0, 0], [9, 0, 0]], 0, "The line is none"),
        ([[0, 0], [math.nan, 0]], 0, "The line is none"),
    ],
)
def test_a_line_that_does_not_serve_is_refused(line: list[list[float]], start: float, reason: str) -> None:
    with pytest.raises(LayoutLineError, match=reason):
        cones_along_line([cone(10, 0)], np.array(line, float), start)
