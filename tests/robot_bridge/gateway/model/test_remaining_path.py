"""What is left of a task: a straight line to a target, or the rest of a drawn path, nothing of it twice."""

from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from robot_bridge.core.errors import RefusedError
from robot_bridge.core.geometry import Polyline
from robot_bridge.core.messages.robots import SetPath, SetPosEnd
from robot_bridge.gateway.model.arrival import PlannedPath, StraightPlanner, remaining_path

STRAIGHT = StraightPlanner()
metres = st.floats(-500, 500)
points = st.tuples(metres, metres)


def test_to_a_target_it_is_a_straight_line_that_ends_in_its_heading():
    way = remaining_path(SetPosEnd(3.0, 4.0, 1.5), (0.0, 0.0), 0.0, STRAIGHT)
    assert way == (SetPath([(0.0, 0.0), (3.0, 4.0)], 1.5), "")


def test_a_planner_is_asked_for_the_way_to_a_target():
    class Roads:
        def path(self, start, goal):
            return PlannedPath([start, (9.0, 0.0), goal], "not what you expect")

    way = remaining_path(SetPosEnd(9.0, 9.0), (0.0, 0.0), 0.0, Roads())
    assert way.message.points == [(0.0, 0.0), (9.0, 0.0), (9.0, 9.0)]
    assert way.note == "not what you expect"


def test_a_planner_that_finds_no_way_says_so():
    class NoWay:
        def path(self, start, goal):
            raise RefusedError("no road leads there")

    with pytest.raises(RefusedError, match="no road leads there"):
        remaining_path(SetPosEnd(9.0, 9.0), (0.0, 0.0), 0.0, NoWay())


SQUARE = SetPath([(0.0, 0.0), (10.0, 0.0), (10.0, 10.0), (0.0, 10.0), (0.0, 0.0)])


def test_of_a_drawn_path_it_is_what_lies_ahead():
    way = remaining_path(SQUARE, (10.5, 3.0), 12.0, STRAIGHT)
    assert way.message.points == [(10.5, 3.0), (10.0, 3.0), (10.0, 10.0), (0.0, 10.0), (0.0, 0.0)]


@pytest.mark.parametrize("start", [(0.0, 0.0), (0.0, 0.3)])
def test_a_loop_is_not_cut_short_where_it_ends_beside_its_beginning(start):
    way = remaining_path(SQUARE, start, 0.0, STRAIGHT)
    assert way.message.points[-4:] == SQUARE.points[1:]


def test_a_robot_that_stands_on_a_corner_is_not_told_it_twice():
    assert remaining_path(SQUARE, (10.0, 10.0), 20.0, STRAIGHT).message.points == [
        (10.0, 10.0),
        (0.0, 10.0),
        (0.0, 0.0),
    ]


def test_at_the_end_the_path_still_has_two_points():
    assert remaining_path(SQUARE, (0.0, 0.0), 40.0, STRAIGHT).message.points == [(0.0, 0.0), (0.0, 0.0)]


@given(st.lists(points, min_size=2, max_size=8), points, st.floats(0, 1))
def test_it_begins_at_the_robot_ends_where_the_path_ends_and_is_no_longer_than_the_path_left(
    corners, start, part
):
    line = Polyline(corners)
    driven = part * line.length
    way = remaining_path(SetPath(corners), start, driven, STRAIGHT)
    assert way.message.points[0] == start
    assert way.message.points[-1] == pytest.approx(corners[-1], abs=1e-5)
    joint = line.at(driven)
    detour = math.hypot(joint[0] - start[0], joint[1] - start[1])
    assert Polyline(way.message.points).length <= line.length - driven + detour + 1e-3
