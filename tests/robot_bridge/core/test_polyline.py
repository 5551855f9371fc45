"""A line measured along itself: how much it turns, and where."""

from __future__ import annotations

import math

import numpy as np
import pytest

from robot_bridge.core.geometry import Polyline


def test_a_corner_turns_at_its_point_alone():
    turns = Polyline([(0, 0), (5, 0), (10, 0), (10, 10)]).turns(1.0)
    assert turns == pytest.approx([0, 0, math.pi / 2, 0])


def test_a_line_that_comes_back_turns_by_half_a_circle_to_either_side():
    assert Polyline([(0, 0), (5, 0), (0, 0)]).turns(1.0)[1] == pytest.approx(math.pi)
    left, right = (Polyline([(0, 0), (-5, 0), (-9, y)]).turns(1.0)[1] for y in (4, -4))
    assert left == pytest.approx(right) == pytest.approx(math.pi / 4)


def test_an_arc_turns_as_far_as_its_reach_over_its_radius():
    angle = np.linspace(0, math.pi, 200)
    turns = Polyline([(4 * math.cos(a), 4 * math.sin(a)) for a in angle]).turns(0.5)
    assert turns[50:-50] == pytest.approx(0.5 / 4, rel=0.01)


def test_one_point_and_equal_points_turn_nowhere():
    assert Polyline([(1, 1)]).turns(1.0).tolist() == [0.0]
    assert Polyline([(1, 1), (1, 1)]).turns(1.0).tolist() == [0.0, 0.0]
