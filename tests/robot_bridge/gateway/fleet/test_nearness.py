"""Who is near a robot and who will be: by distance, by where both go, without flapping at the limit."""

from __future__ import annotations

import math

import pytest

from robot_bridge.gateway.fleet.nearness import MARGIN_M, Mover, NearnessLimits, find_meetings
from robot_bridge.gateway.traffic.conflicts import driving_movement

NOW = 1000.0
LIMITS = NearnessLimits(5.0, 10.0)


def at(name, x, y, vx=0.0, vy=0.0):
    return Mover(name, (x, y), (vx, vy)).straight_on(NOW, LIMITS.within_s)


def found(people, robots, near=()):
    return [
        (one.seen, one.robot, round(one.metres, 2), round(one.seconds, 2))
        for one in find_meetings(people, robots, LIMITS, NOW, near)
    ]


def test_who_is_near_is_told_at_once_though_both_stand():
    people = [at("anna", 0.0, 0.0), at("bert", 100.0, 0.0)]
    assert found(people, [at("r1", 3.0, 4.0), at("r2", 50.0, 0.0)]) == [("anna", "r1", 5.0, 0.0)]


@pytest.mark.parametrize(
    ("person", "robot", "seconds"),
    [
        (at("anna", 0.0, 0.0, 1.0), at("r1", 10.0, 0.0), 5.0),
        (at("anna", 0.0, 0.0), at("r1", 10.0, 0.0, -2.0), 2.5),
        (at("anna", 0.0, 0.0, 1.0), at("r1", 10.0, 0.0, -1.0), 2.5),
        (at("anna", 0.0, 0.0, 0.0, 2.0), at("r1", 3.0, 20.0), 8.0),
    ],
)
def test_who_will_be_near_is_told_with_the_seconds_until_then(person, robot, seconds):
    assert found([person], [robot]) == [("anna", "r1", 5.0, pytest.approx(seconds, abs=0.01))]


@pytest.mark.parametrize(
    ("person", "robot"),
    [
        (at("anna", 0.0, 0.0, -1.0), at("r1", 6.0, 0.0)),
        (at("anna", 0.0, 0.0, 1.0), at("r1", 16.0, 0.0)),
        (at("anna", 0.0, 0.0, 1.0), at("r1", 6.0, 0.0, 1.0)),
        (at("anna", 0.0, 0.0, 0.0, 3.0), at("r1", 5.2, 30.0)),
    ],
)
def test_who_goes_away_comes_later_keeps_apart_or_passes_beside_is_not(person, robot):
    assert found([person], [robot]) == []


def test_a_robot_is_followed_along_its_way_and_not_straight_on():
    corner = driving_movement("r1", [(0.0, 0.0), (4.0, 0.0), (4.0, 40.0)], 2.0, NOW, 0.0)
    assert found([at("straight-on", 12.0, 0.0)], [corner]) == []
    ((seen, _, _, seconds),) = found([at("round-the-corner", 4.0, 15.0)], [corner])
    assert (seen, seconds) == ("round-the-corner", pytest.approx(7.0, abs=0.01))


def test_who_was_near_is_so_up_to_the_margin_beyond():
    beyond = at("anna", 5.0 + MARGIN_M / 2, 0.0)
    assert found([beyond], [at("r1", 0.0, 0.0)]) == []
    assert found([beyond], [at("r1", 0.0, 0.0)], {("anna", "r1")}) == [("anna", "r1", 5.5, 0.0)]
    gone = at("anna", 5.1 + MARGIN_M, 0.0)
    assert found([gone], [at("r1", 0.0, 0.0)], {("anna", "r1")}) == []


def test_the_nearest_in_time_comes_first_and_the_place_is_the_persons():
    robots = [at("r1", 14.0, 0.0), at("r2", 0.0, 4.0)]
    first, second = find_meetings([at("anna", 0.0, 0.0, 1.0)], robots, LIMITS, NOW)
    assert (first.robot, second.robot) == ("r2", "r1")
    assert math.dist(second.place, (9.0, 0.0)) < 0.01


def test_nobody_is_near_nobody():
    assert found([], [at("r1", 0.0, 0.0)]) == found([at("anna", 0.0, 0.0)], []) == []
