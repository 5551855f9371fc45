"""Exactly on a bound is within it: how near, how slow, how far along and how far off a robot may be."""

from __future__ import annotations

import math

import pytest

from robot_bridge.core.messages.robots import SendPos, SetPath, SetPosEnd, SetPosIni
from robot_bridge.gateway.model.arrival import (
    CORRIDOR,
    HEADING_TOLERANCE,
    LOOK_AHEAD,
    LOOK_AHEAD_TIME,
    STRIDE,
    BeginArrival,
    PathArrival,
    TargetArrival,
    standing,
)
from robot_bridge.gateway.model.position_checks import STANDING_SPEED

TOLERANCE = 0.25
STRAIGHT = SetPath([(0.0, 0.0), (100.0, 0.0)])


def pose(x=0.0, y=0.0, theta=0.0, v=0.0) -> SendPos:
    return SendPos(x, y, theta, v)


def on_path(path=STRAIGHT, tolerance=TOLERANCE, **how):
    return PathArrival(path, tolerance, **how)


@pytest.mark.parametrize(
    ("v", "stands"), [(STANDING_SPEED, True), (-STANDING_SPEED, True), (0.0501, False), (-0.0501, False)]
)
def test_a_robot_stands_up_to_a_speed_forwards_and_backwards(v, stands):
    assert standing(pose(v=v)) is stands


@pytest.mark.parametrize("judge", [TargetArrival, BeginArrival])
@pytest.mark.parametrize("offset", [(TOLERANCE, 0.0), (-TOLERANCE, 0.0), (0.0, TOLERANCE), (0.15, -0.2)])
def test_a_place_is_reached_on_the_bound_of_its_tolerance_on_every_side(judge, offset):
    kind = SetPosEnd if judge is TargetArrival else SetPosIni
    arrival = judge(kind(0.0, 0.0), TOLERANCE)
    assert arrival.deviation(pose(*offset)) == pytest.approx(TOLERANCE)
    assert arrival.deviation(pose(1.01 * offset[0], 1.01 * offset[1])) is None


@pytest.mark.parametrize("turned", [HEADING_TOLERANCE, -HEADING_TOLERANCE])
def test_a_heading_is_reached_on_the_bound_of_its_tolerance_to_both_sides(turned):
    arrivals = [
        TargetArrival(SetPosEnd(0.0, 0.0, 0.0), TOLERANCE),
        BeginArrival(SetPosIni(0.0, 0.0, 0.0), TOLERANCE),
        on_path(SetPath([(4.0, 0.0), (0.0, 0.0)], theta=0.0), driven=4.0),
    ]
    for arrival in arrivals:
        assert arrival.deviation(pose(theta=turned)) == 0.0
        assert arrival.deviation(pose(theta=math.tau + 0.99 * turned)) == pytest.approx(0.0)
        assert arrival.deviation(pose(theta=1.01 * turned)) is None


def test_a_path_is_reached_on_the_bound_of_its_tolerance():
    arrival = on_path(driven=98.0)
    assert arrival.deviation(pose(100.0 - TOLERANCE)) == TOLERANCE
    assert arrival.driven == 100.0 - TOLERANCE
    assert on_path(driven=98.0).deviation(pose(99.74)) is None


def test_a_robot_that_was_not_seen_to_come_to_the_end_of_a_loop_has_not_driven_it():
    loop = SetPath([(0.0, 0.0), (50.0, 0.0), (50.0, 50.0), (0.0, 0.0)])
    arrival = on_path(loop)
    assert arrival.deviation(pose()) is None
    assert arrival.driven == 0.0


def test_a_robot_is_looked_for_again_after_a_stride():
    arrival = on_path()
    arrival.deviation(pose(v=1.0))
    arrival.deviation(pose(0.9 * STRIDE, v=1.0))
    assert arrival.driven == 0.0
    arrival.deviation(pose(STRIDE, v=1.0))
    assert arrival.driven == STRIDE


def test_a_robot_is_on_its_path_as_far_as_the_corridor_goes():
    arrival = on_path()
    arrival.deviation(pose(1.0, CORRIDOR, v=1.0))
    assert arrival.driven == 1.0
    arrival.deviation(pose(2.0, 1.01 * CORRIDOR, v=1.0))
    assert arrival.driven == 1.0


@pytest.mark.parametrize(("speeds", "reach"), [((0.0, 0.0), 0.0), ((1.0, 0.0), 1.0), ((0.0, -1.0), 1.0)])
def test_a_robot_that_comes_to_its_path_is_found_as_far_ahead_as_it_may_have_driven(speeds, reach):
    bound = LOOK_AHEAD + LOOK_AHEAD_TIME * reach
    for x, is_found in ((bound, True), (bound + 0.01, False)):
        arrival = on_path(SetPath([(0.0, 0.0), (128.0, 0.0)]))  # shares of it are exact
        arrival.deviation(pose(3.0, 3.0, v=speeds[0]))
        arrival.deviation(pose(x, v=speeds[1]))
        assert (arrival.driven == x) is is_found


@pytest.mark.parametrize(("lane", "driven"), [(4.0, 11.0), (5.0, 0.0)])
def test_a_robot_is_found_round_a_corner_twice_as_far_ahead_as_it_has_come(lane, driven):
    lanes = SetPath([(0.0, 0.0), (lane, 0.0), (lane, 3.0), (0.0, 3.0)])
    arrival = on_path(lanes)
    arrival.deviation(pose())
    arrival.deviation(pose(0.0, 3.0))
    assert arrival.driven == driven


def test_a_robot_out_of_sight_that_had_not_set_off_is_not_looked_for_along_all_of_its_path():
    arrival = on_path(driven=LOOK_AHEAD, under_way=True, handed=pose())
    arrival.deviation(pose(60.0, v=0.0))
    assert arrival.driven == 60.0  # it has moved far
    arrival = on_path(driven=LOOK_AHEAD, under_way=True, handed=pose(59.0))
    arrival.deviation(pose(60.0))
    assert arrival.driven == LOOK_AHEAD
    arrival = on_path(driven=1.01 * LOOK_AHEAD, under_way=True, handed=pose(59.0))
    arrival.deviation(pose(60.0))
    assert arrival.driven == 60.0


@pytest.mark.parametrize("v", [0.0, 2.0])
def test_a_robot_that_is_further_on_than_it_can_have_driven_was_missed(v):
    bound = LOOK_AHEAD + LOOK_AHEAD_TIME * v
    for away, is_missed in ((bound, False), (1.01 * bound, True)):
        arrival = on_path()
        arrival.deviation(pose(0.0, 0.0, v=v))
        assert arrival._was_missed(pose(away, v=v)) is is_missed
        assert arrival._was_missed(pose(away)) is is_missed


@pytest.mark.parametrize(("is_lost", "driven"), [(True, 93.0), (False, 10.0)])
def test_a_robot_that_was_out_of_sight_may_be_on_its_way_back_beside_where_it_was(is_lost, driven):
    arrival = on_path(SetPath([(0.0, 0.0), (50.0, 0.0), (50.0, 3.0), (0.0, 3.0)]))
    for x in (0.0, 5.0, 10.0):
        arrival.deviation(pose(x, v=1.0))
    if is_lost:
        arrival.lose_sight()
    arrival.deviation(pose(10.0, 3.0))
    assert arrival.driven == pytest.approx(driven)


def test_a_robot_out_of_sight_is_where_it_was_expected_rather_than_nearer_to_a_later_lane():
    arrival = on_path(SetPath([(0.0, 0.0), (128.0, 0.0), (128.0, 1.0), (0.0, 1.0)]), driven=16.0)
    arrival.lose_sight()
    arrival.deviation(pose(16.0 + LOOK_AHEAD, 1.0))
    assert arrival.driven == 16.0 + LOOK_AHEAD


def test_where_a_path_passes_twice_within_the_tolerance_the_sooner_place_counts_for_who_left_it():
    there_and_back = SetPath([(0.0, 0.0), (4.0, 0.0), (0.0, 0.1)])
    for _ in range(2):
        arrival = on_path(there_and_back)
        arrival.deviation(pose(0.0, 0.0, v=1.0))
        arrival.deviation(pose(0.0, 3.0, v=1.0))  # off the corridor
        arrival.deviation(pose(2.0, 0.05, v=1.0))
        assert arrival.driven == pytest.approx(2.0, abs=0.1)


def test_a_robot_that_is_followed_is_where_its_path_is_nearest():
    there_and_back = SetPath([(0.0, 0.0), (4.0, 0.0), (4.0, 0.2), (0.0, 0.2)])
    arrival = on_path(there_and_back)
    arrival.deviation(pose(3.0, 0.0, v=1.0))
    assert arrival.driven == 3.0
    # Followed from one pose to the next: it has turned, and is nearest to the way back.
    arrival.deviation(pose(3.4, 0.2, v=1.0))
    assert arrival.driven == pytest.approx(4.8)


def test_a_rest_is_no_arrival_before_the_robot_was_seen_on_its_path():
    arrival = on_path(driven=100.0)
    assert arrival.idle_deviation(pose(100.0)) is None
    arrival = on_path(under_way=True, handed=pose(60.0))
    arrival.deviation(pose(100.0, 3.0))  # beside the end, off the corridor
    assert arrival.idle_deviation(pose(100.0)) is None


def test_a_robot_followed_for_long_after_it_was_out_of_sight_is_where_it_was_seen():
    loop = SetPath([(0.0, 0.0), (20.0, 0.0), (20.0, 20.0), (0.0, 0.0)])
    for beyond, is_unsure in ((0.0, True), (0.3, False)):
        arrival = on_path(loop)
        arrival.deviation(pose())
        arrival.lose_sight()
        arrival.deviation(pose(2.0, v=1.0))
        arrival.deviation(pose(LOOK_AHEAD + beyond, v=1.0))
        assert arrival._is_unsure is is_unsure
    assert on_path(loop)._is_unsure is False
