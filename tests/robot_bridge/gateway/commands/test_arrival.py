"""Reached means seen to have arrived: standing at the target, or at the end of a path that was driven."""

from __future__ import annotations

import itertools
import math

import pytest

from robot_bridge.core.messages.robots import Abort, SendPos, SetPath, SetPosEnd, SetPosIni
from robot_bridge.gateway.model.arrival import (
    HEADING_TOLERANCE,
    AbortArrival,
    PathArrival,
    arrival_judge,
)
from robot_bridge.gateway.model.position_checks import STANDING_SPEED

TOLERANCE = 0.2


def pose(x, y, theta=0.0, v=0.0):
    return SendPos(x, y, theta, v)


def walk(arrival, points, v=1.0, step=0.2):
    """Drive from point to point; return what was told on the way, and standing at the end."""
    told = None
    for (x0, y0), (x1, y1) in itertools.pairwise(points):
        count = max(1, math.ceil(math.hypot(x1 - x0, y1 - y0) / step))
        for k in range(count):
            told = (
                arrival.deviation(pose(x0 + (x1 - x0) * k / count, y0 + (y1 - y0) * k / count, v=v)) or told
            )
    return told, arrival.deviation(pose(*points[-1]))


@pytest.mark.parametrize(
    ("x", "y", "v", "arrived"),
    [
        (10.0, 5.0, 0.0, True),
        (10.19, 5.0, 0.0, True),
        (10.0, 4.79, 0.0, False),
        (10.15, 5.15, 0.0, False),
        (10.0, 5.0, STANDING_SPEED, True),
        (10.0, 5.0, 0.06, False),
        (10.0, 5.0, -0.06, False),
    ],
)
def test_a_target_is_reached_standing_within_the_tolerance(x, y, v, arrived):
    deviation = arrival_judge(SetPosEnd(10.0, 5.0), TOLERANCE).deviation(pose(x, y, v=v))
    assert (deviation is not None) is arrived
    if arrived:
        assert deviation == pytest.approx(math.hypot(x - 10, y - 5))


@pytest.mark.parametrize("turns", [0, 1, -3])
def test_a_target_with_a_heading_is_reached_in_that_heading(turns):
    arrival = arrival_judge(SetPosEnd(0.0, 0.0, theta=math.pi), TOLERANCE)
    heading = -math.pi + math.tau * turns
    assert arrival.deviation(pose(0, 0, heading)) == 0.0
    assert arrival.deviation(pose(0, 0, heading + 0.9 * HEADING_TOLERANCE)) == 0.0
    assert arrival.deviation(pose(0, 0, heading - 1.1 * HEADING_TOLERANCE)) is None
    assert arrival.deviation(pose(0, 0, 0.0)) is None


LOOP = [(0.0, 0.0), (10.0, 0.0), (10.0, 10.0), (0.0, 10.0), (0.0, 0.0)]


def test_a_path_that_ends_where_it_began_is_not_reached_at_its_start():
    arrival = PathArrival(SetPath(LOOP), TOLERANCE)
    assert arrival.deviation(pose(0.0, 0.0)) is None
    assert arrival.deviation(pose(0.05, -0.05)) is None
    assert arrival.driven < 1.0


def test_a_path_that_was_driven_before_its_acknowledgement_came_is_reached():
    path = SetPath([(0.0, 0.0), (10.0, 0.0), (10.0, 10.0)])
    arrival = arrival_judge(path, TOLERANCE, handed=pose(0.0, 0.5))
    assert arrival.deviation(pose(10.0, 10.1)) == pytest.approx(0.1)


def test_a_path_is_not_reached_by_a_robot_that_stands_where_it_was_handed_it():
    arrival = arrival_judge(
        SetPath([(0.0, 0.0), (10.0, 0.0), (10.0, 10.0)]), TOLERANCE, handed=pose(10.0, 10.0)
    )
    assert arrival.deviation(pose(10.0, 10.1)) is None


def test_a_loop_is_not_reached_by_a_robot_that_came_to_its_beginning_before_it_acknowledged():
    arrival = arrival_judge(SetPath(LOOP), TOLERANCE, handed=pose(-8.0, 0.0))
    assert arrival.deviation(pose(0.0, 0.05)) is None
    assert arrival.deviation(pose(0.05, 0.0)) is None


def test_a_path_that_ends_beside_its_beginning_is_not_reached_by_a_robot_that_came_there_beforehand():
    arrival = arrival_judge(SetPath([*LOOP[:-1], (0.0, 1.0)]), TOLERANCE, handed=pose(-8.0, 0.0))
    assert arrival.deviation(pose(0.0, 1.0)) is None


def test_a_path_is_reached_by_a_robot_that_was_not_heard_round_its_last_corner():
    arrival = arrival_judge(SetPath([(0.0, 0.0), (19.0, 0.0), (19.0, 10.0)]), TOLERANCE)
    walk(arrival, [(0.0, 0.0), (12.0, 0.0)], v=4.0)
    assert arrival.deviation(pose(12.0, 0.0, v=4.0)) is None
    assert arrival.deviation(pose(19.0, 10.0)) == 0.0


def test_a_path_that_ends_where_it_began_is_reached_once_driven():
    told, at_the_end = walk(PathArrival(SetPath(LOOP), TOLERANCE), LOOP)
    assert told is None
    assert at_the_end == pytest.approx(0.0, abs=1e-9)


def test_a_robot_that_cuts_the_corners_has_driven_the_path():
    cut = [(0.0, 0.0), (9.0, 0.0), (10.0, 1.0), (10.0, 9.0), (9.0, 10.0), (1.0, 10.0), (0.0, 9.0), (0.0, 0.0)]
    assert walk(PathArrival(SetPath(LOOP), TOLERANCE), cut)[1] is not None


def test_a_robot_that_leaves_out_a_side_has_not():
    short = [(0.0, 0.0), (10.0, 0.0), (0.0, 0.0)]
    assert walk(PathArrival(SetPath(LOOP), TOLERANCE), short) == (None, None)


def test_a_robot_far_from_its_path_does_not_advance():
    arrival = PathArrival(SetPath([(0.0, 0.0), (10.0, 0.0)]), TOLERANCE)
    walk(arrival, [(0.0, 3.0), (10.0, 3.0)])
    assert arrival.driven == 0.0


def test_a_fast_robot_far_ahead_at_its_next_pose_is_still_followed():
    path = [(0.0, 0.0), (200.0, 0.0)]
    arrival = PathArrival(SetPath(path), TOLERANCE)
    for x in range(0, 200, 20):
        assert arrival.deviation(pose(float(x), 0.0, v=20.0)) is None
    assert arrival.deviation(pose(200.0, 0.1)) == pytest.approx(0.1)


def test_a_robot_found_half_way_after_a_restart_is_followed_from_there():
    half = [(10.0, 10.0), (0.0, 10.0), (0.0, 0.0)]
    assert walk(PathArrival(SetPath(LOOP), TOLERANCE, under_way=True), half)[1] is not None
    assert walk(PathArrival(SetPath(LOOP), TOLERANCE), half)[1] is None


def test_a_path_with_a_point_named_twice_is_followed():
    path = [(0.0, 0.0), (0.0, 0.0), (4.0, 0.0), (4.0, 0.0)]
    assert walk(PathArrival(SetPath(path), TOLERANCE), [(0.0, 0.0), (4.0, 0.0)])[1] is not None


LAP = SetPath([*LOOP[:-1], (0.0, 1.0)])
"""It ends beside its beginning."""


@pytest.mark.parametrize("end", [(0.0, 1.0), (0.05, 0.95)])
@pytest.mark.parametrize("handed", [(0.0, 1.0), (-8.0, 0.0)])
def test_a_lap_that_was_driven_unseen_is_reached_when_the_robot_says_that_it_has_nothing_to_do(end, handed):
    for rests_first in (True, False):
        arrival = arrival_judge(LAP, TOLERANCE, under_way=True, handed=pose(*handed))
        told = [arrival.idle_deviation(None)] if rests_first else [arrival.deviation(pose(*end))]
        told += [arrival.deviation(pose(*end))] if rests_first else [arrival.idle_deviation(pose(*end))]
        assert told == [None, pytest.approx(math.dist(end, (0.0, 1.0)))]


def test_where_a_robot_was_before_it_took_its_lap_on_shows_nothing():
    assert (
        arrival_judge(LAP, TOLERANCE, under_way=True, handed=pose(0.0, 1.0)).idle_deviation(pose(0.0, 1.0))
        is None
    )


def test_so_is_a_loop_of_which_only_the_beginning_was_seen():
    arrival = PathArrival(SetPath(LOOP), TOLERANCE)
    walk(arrival, [(0.0, 0.0), (3.0, 0.0)])
    arrival.lose_sight()
    assert arrival.deviation(pose(0.0, 0.0)) is None
    assert arrival.idle_deviation(pose(0.0, 0.0)) == 0.0


def test_a_robot_that_was_seen_all_along_has_driven_no_lap_because_it_says_that_it_has_nothing_to_do():
    arrival = arrival_judge(LAP, TOLERANCE, handed=pose(0.0, 1.0))
    assert arrival.deviation(pose(0.0, 1.0)) is None
    assert arrival.idle_deviation(pose(0.0, 1.0)) is None
    arrival = arrival_judge(LAP, TOLERANCE, under_way=True, handed=pose(0.0, 1.0))
    assert walk(arrival, [(0.0, 0.0), (10.0, 0.0), (0.0, 0.0), (0.0, 1.0)]) == (None, None)
    assert arrival.idle_deviation(pose(0.0, 1.0)) is None


def test_what_a_robot_said_before_it_set_off_counts_no_more_when_it_has():
    arrival = arrival_judge(LAP, TOLERANCE, under_way=True, handed=pose(0.0, 1.0))
    arrival.idle_deviation(None)
    arrival.deviation(pose(1.0, 0.0, v=1.0))
    assert arrival.deviation(pose(0.0, 1.0)) is None


def test_a_robot_that_says_nothing_to_do_elsewhere_has_not_reached_the_end():
    arrival = arrival_judge(LAP, TOLERANCE, under_way=True, handed=pose(0.0, 1.0))
    arrival.deviation(pose(0.0, 1.5))
    assert arrival.idle_deviation(pose(0.0, 1.5)) is None


def test_a_robot_that_stood_at_the_end_before_it_set_off_has_not_reached_it_by_a_restart():
    for begin in ((0.0, 0.0), (-9.0, 0.0)):
        path = SetPath([begin, (10.0, 0.0), (0.0, 1.0)])
        arrival = PathArrival(path, TOLERANCE, under_way=True, handed=pose(0.0, 1.0))
        assert arrival.deviation(pose(0.02, 1.0)) is None


def test_a_robot_that_came_unseen_to_its_lap_has_not_driven_it():
    arrival = arrival_judge(LAP, TOLERANCE, handed=pose(-8.0, 0.0))
    arrival.deviation(pose(-8.0, 0.0, v=1.0))
    assert arrival.deviation(pose(0.0, 1.0)) is None


ROUND = [(0.0, 0.0), (100.0, 0.0)]


@pytest.mark.parametrize("v", [0.3, 1.0, 4.0])
def test_a_robot_that_leaves_its_path_for_long_is_found_on_it_again(v):
    arrival = PathArrival(SetPath(ROUND), TOLERANCE)
    walk(arrival, [(0.0, 0.0), (20.0, 0.0), (23.0, 4.0), (57.0, 4.0)], v=v)
    assert arrival.driven == pytest.approx(21.5, abs=0.5)
    walk(arrival, [(57.0, 4.0), (60.0, 0.0), (61.0, 0.0)], v=v)
    assert arrival.driven == pytest.approx(61.0)
    assert walk(arrival, [(61.0, 0.0), (100.0, 0.0)], v=v)[1] == 0.0


def test_a_robot_that_comes_back_where_its_path_passes_twice_is_found_at_the_sooner_place():
    there_and_back = SetPath([(0.0, 0.0), (50.0, 0.0), (0.0, 0.01)])
    arrival = PathArrival(there_and_back, TOLERANCE)
    walk(arrival, [(0.0, 0.0), (20.0, 0.0), (23.0, 4.0), (41.0, 4.0), (44.0, 0.01)])
    assert arrival.driven == pytest.approx(44.0, abs=0.3)


def test_a_robot_that_crosses_its_path_far_ahead_has_not_driven_what_lies_between():
    lanes = SetPath([(0.0, 0.0), (50.0, 0.0), (50.0, 4.0), (0.0, 4.0)])
    arrival = PathArrival(lanes, TOLERANCE)
    walk(arrival, [(0.0, 0.0), (10.0, 0.0), (10.0, 4.0), (14.0, 4.0)])
    assert arrival.driven == pytest.approx(10.0, abs=0.1)


def test_an_abort_is_reached_when_the_robot_stands():
    arrival = arrival_judge(Abort(), TOLERANCE)
    assert isinstance(arrival, AbortArrival)
    assert arrival.deviation(pose(1, 2, v=1.0)) is None
    assert arrival.deviation(pose(1, 2, v=0.01)) == 0.0


def test_a_robot_whose_poses_were_missed_is_found_again_further_along():
    arrival = PathArrival(SetPath([(0.0, 0.0), (100.0, 0.0)]), TOLERANCE)
    walk(arrival, [(0.0, 0.0), (10.0, 0.0)])
    assert walk(arrival, [(70.0, 0.0), (100.0, 0.0)])[1] is not None


NOISE = pytest.mark.parametrize("noise", [(0.05, 0.0), (0.0, 0.05), (-0.05, 0.0), (0.0, -0.05), (0.0, 0.0)])


@NOISE
def test_a_robot_that_came_to_the_end_of_a_loop_unseen_has_reached_it(noise):
    for driven in (12.0, 25.0, 39.0, None):
        arrival = PathArrival(SetPath(LOOP), TOLERANCE, driven=driven, under_way=True)
        assert arrival.deviation(pose(*noise)) is not None, driven


@NOISE
@pytest.mark.parametrize("driven", [0.0, 0.05])
def test_a_robot_blocked_at_the_start_of_a_loop_has_not_reached_it_when_the_gateway_starts(noise, driven):
    arrival = PathArrival(SetPath(LOOP), TOLERANCE, driven=driven, under_way=True)
    for _ in range(3):
        assert arrival.deviation(pose(*noise)) is None
    assert walk(arrival, LOOP)[1] is not None


def test_a_robot_that_sets_off_on_a_loop_as_the_gateway_starts_has_not_reached_its_end():
    for driven in (0.0, None):
        arrival = PathArrival(SetPath(LOOP), TOLERANCE, driven=driven, under_way=True)
        told, at_the_end = walk(arrival, LOOP)
        assert told is None
        assert at_the_end is not None


def test_a_robot_is_never_taken_back_along_its_path_by_a_restart():
    there_and_back = [(0.0, 0.0), (20.0, 0.0), (0.0, 0.0)]
    arrival = PathArrival(SetPath(there_and_back), TOLERANCE, driven=26.0, under_way=True)
    assert arrival.deviation(pose(12.0, 0.0, v=1.0)) is None
    assert arrival.driven == pytest.approx(28.0)
    assert walk(arrival, [(12.0, 0.0), (0.0, 0.0)])[1] is not None


def test_a_robot_that_creeps_to_the_end_of_its_path_has_reached_it():
    arrival = PathArrival(SetPath([(0.0, 0.0), (1.1, 0.0)]), 0.05)
    told, at_the_end = walk(arrival, [(0.0, 0.0), (1.1, 0.0)], v=0.1, step=0.01)
    assert (told, at_the_end) == (None, 0.0)


def test_a_robot_that_stands_on_its_path_costs_no_search_of_it(monkeypatch):
    arrival = PathArrival(SetPath(LOOP), TOLERANCE)
    arrival.deviation(pose(5.0, 0.0))
    monkeypatch.setattr(arrival.line, "feet", None)
    for k in range(100):
        assert arrival.deviation(pose(5.0 + 0.001 * k, 0.01)) is None


@pytest.mark.parametrize(
    ("x", "theta", "v", "arrived"),
    [
        (10.0, 1.0, 0.0, True),
        (10.19, 1.1, 1.4, True),
        (10.21, 1.0, 0.0, False),
        (10.0, 1.2, 0.0, False),
    ],
)
def test_a_beginning_is_reached_when_the_robot_says_it_is_there_standing_or_not(x, theta, v, arrived):
    deviation = arrival_judge(SetPosIni(10.0, 5.0, 1.0), TOLERANCE).deviation(pose(x, 5.0, theta, v))
    assert deviation == (pytest.approx(x - 10.0) if arrived else None)


def test_a_beginning_without_a_heading_is_reached_in_any():
    assert arrival_judge(SetPosIni(10.0, 5.0), TOLERANCE).deviation(pose(10.0, 5.0, 3.0)) == 0.0


def test_a_path_that_ends_in_a_heading_is_reached_in_that_heading():
    arrival = arrival_judge(SetPath([(0.0, 0.0), (4.0, 0.0)], theta=math.pi / 2), TOLERANCE)
    walk(arrival, [(0.0, 0.0), (4.0, 0.0)])
    assert arrival.deviation(pose(4.0, 0.0, 0.0)) is None
    assert arrival.deviation(pose(4.0, 0.0, math.pi / 2)) == 0.0
