"""Robots that would come too near to one another by a plan."""

from __future__ import annotations

import numpy as np
import pytest
from fleet_supervisor.plugin.planning.proposal import meeting_in_words
from fleet_supervisor.robot_bridge.core.assignment.clearance import meetings, robot_positions
from fleet_supervisor.robot_bridge.core.assignment.job import PlanRobot
from fleet_supervisor.robot_bridge.core.assignment.plan import ConePlan, PlannedTrip, PlanStop, RobotPlan


def driving(name, start, *stops, ready=0.0, wait=0.0):
    """A robot at 1 m/s along straight lines, that waits at each stop."""
    made, at, clock = [], np.array(start, dtype=float), ready
    for number, stop in enumerate(stops):
        there = np.array(stop, dtype=float)
        metres = float(np.hypot(*(there - at)))
        arrival = clock + metres
        path = (tuple(at.tolist()), tuple(there.tolist()))
        made.append(
            PlanStop(
                "place",
                f"{name}{number}",
                *stop,
                0.0,
                metres,
                arrival,
                arrival,
                arrival + wait,
                0,
                0,
                0,
                0,
                path,
            )
        )
        at, clock = there, arrival + wait
    robot = PlanRobot(name, *start, 8, 1.0, aboard=8, ready_s=ready)
    return RobotPlan(robot, (PlannedTrip(1, tuple(made)),))


def plan(*robots):
    return ConePlan(robots, (), (), "stay", "balanced", "by hand", "straight lines")


def test_two_that_meet_head_on_are_named_with_the_time_and_place():
    (found,) = meetings(plan(driving("a", (0, 0), (20, 0)), driving("b", (20, 0), (0, 0))), 2.0)
    assert (found.robot, found.other) == ("a", "b")
    assert found.at_s == pytest.approx(10, abs=0.6) and (found.x, found.y) == pytest.approx((10, 0), abs=0.6)
    assert (
        found.metres < 0.6
        and "a and b come within" in meeting_in_words(found)
        and "after 0:10" in meeting_in_words(found)
    )


def test_the_same_ways_at_other_times_are_no_meeting():
    first = driving("a", (0, 0), (20, 0))
    assert meetings(plan(first, driving("b", (10, -30), (10, 30), ready=30.0)), 2.0) == []


def test_a_robot_that_stands_after_its_last_stop_is_met_there():
    (found,) = meetings(plan(driving("a", (0, 0), (5, 0)), driving("b", (30, 0), (5.5, 0))), 2.0)
    assert found.at_s > 20 and found.metres < 1.0


def test_a_lost_robot_meets_nobody_and_one_alone_neither():
    lost = driving("b", (0, 0), (5, 0))
    lost = RobotPlan(lost.robot, (), lost=True)
    assert meetings(plan(driving("a", (0, 0), (5, 0)), lost), 2.0) == []


def test_a_robot_that_stands_at_anothers_cone_is_met_and_one_that_is_passed_far_enough_is_not():
    one = plan(driving("a", (0, 0), (10, 0), (10, 10), wait=5.0))
    (found,) = meetings(one, 2.0, {"dead": (10.3, 0.4), "off": (5.0, 1.0)}, 1.0)
    assert (found.robot, found.other, found.metres) == ("a", "dead", pytest.approx(0.4, abs=0.1))
    assert found.at_s == pytest.approx(15, abs=1)
    assert meetings(one, 2.0, {"dead": (10.3, 0.4)}, 0.3) == []


def test_positions_follow_the_stops_and_what_is_done_there():
    one = driving("a", (0, 0), (10, 0), (10, 10), wait=5.0)
    times = np.array([0.0, 5.0, 10.0, 14.0, 20.0, 25.0, 99.0])
    expected = [(0, 0), (5, 0), (10, 0), (10, 0), (10, 5), (10, 10), (10, 10)]
    assert robot_positions(one, times) == pytest.approx(np.array(expected, dtype=float))


def test_of_many_that_stand_those_are_met_that_a_long_way_comes_near():
    long = plan(driving("a", (0, 0), (200, 0), (200, 200), (0, 200)))
    standing = {f"far {k}": (20.0 + k, 100.0) for k in range(150)}
    found = meetings(long, 2.0, {**standing, "end": (0.5, 200.0), "begin": (-0.3, 0.0)}, 1.0)
    assert [one.other for one in found] == ["begin", "end"]
