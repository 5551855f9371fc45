"""A GPS fix becomes a pose, and says openly where its heading comes from."""

from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from robot_bridge.core.messages.robots import SendGPS, SendPos
from robot_bridge.gateway.model.position_checks import GroundTracks


class Walk:
    """One robot's fixes, one after the other."""

    def __init__(self):
        self.tracks, self.last = GroundTracks(), None

    def fix(self, x, y, at, *, theta=None, **fields):
        fix = SendGPS(50.0, 15.0, fix_t=at, **fields)
        self.last = self.tracks.pose("r1", fix, (x, y), theta, self.last, 0.0)
        return self.last


@pytest.fixture
def walk() -> Walk:
    return Walk()


def test_a_heading_that_came_with_the_fix_counts(walk):
    pose = walk.fix(1.0, 2.0, 0.0, theta=0.7, v=1.5, accuracy=0.02, altitude=300.0, battery=0.5, status="ok")
    assert pose == SendPos(
        1.0, 2.0, 0.7, 1.5, battery=0.5, status="ok", fix_t=0.0, accuracy=0.02, altitude=300.0
    )


def test_before_it_moved_the_heading_is_unknown_and_it_stands(walk):
    assert walk.fix(0.0, 0.0, 0.0).theta_from == "unknown"
    pose = walk.fix(0.1, 0.0, 1.0)
    assert (pose.theta, pose.theta_from, pose.v) == (0.0, "unknown", 0.0)


def test_the_course_and_the_speed_over_ground_are_seen_in_many_small_steps(walk):
    for step in range(40):
        pose = walk.fix(0.0, 0.1 * step, 0.1 * step)
    assert pose.theta_from == "course"
    assert pose.theta == pytest.approx(math.pi / 2, abs=1e-4)
    assert pose.v == pytest.approx(1.0)


def test_a_robot_that_stops_keeps_its_last_course(walk):
    for step in range(5):
        walk.fix(float(step), 0.0, float(step))
    for second in range(5, 10):
        pose = walk.fix(4.1, 0.1, float(second))
    assert (pose.theta, pose.theta_from, pose.v) == (0.0, "last", 0.0)


def test_noise_within_the_accuracy_is_no_movement(walk):
    places = [(0.0, 0.0), (1.5, 0.0), (0.0, 1.5), (-1.0, -1.0)]
    assert {walk.fix(x, y, float(n), accuracy=2.0).v for n, (x, y) in enumerate(places)} == {0.0}


def test_what_the_robot_measured_before_is_kept(walk):
    walk.last = SendPos(0.0, 0.0, 2.0, 0.0)
    pose = walk.fix(0.0, 0.0, 0.0)
    assert (pose.theta, pose.theta_from) == (2.0, "last")


def test_a_robot_that_drove_when_it_was_seen_last_is_not_seen_to_stand_by_its_first_fix(walk):
    walk.last = SendPos(0.0, 0.0, 2.0, 1.5)
    pose = walk.fix(8.0, 0.0, 0.0)
    assert (pose.v, pose.theta, pose.theta_from) == (1.5, 2.0, "last")
    assert walk.fix(8.1, 0.0, 1.0).v == 1.5
    assert walk.fix(8.1, 0.0, 2.5).v == 0.0


def test_a_clock_that_was_set_back_tells_no_speed(walk):
    walk.fix(0.0, 0.0, 1000.0)
    assert walk.fix(50.0, 0.0, 10.0).v == 0.0
    assert walk.fix(51.0, 0.0, 11.0).v == pytest.approx(1.0)


def test_each_robot_has_a_track_of_its_own():
    tracks = GroundTracks()
    for n, robot in enumerate(["r1", "r2"]):
        pose = tracks.pose(robot, SendGPS(50.0, 15.0), (100.0 * n, 0.0), None, None, float(n))
        assert pose.theta_from == "unknown"


@given(st.lists(st.tuples(st.floats(-1e4, 1e4), st.floats(-1e4, 1e4), st.floats(-1e6, 1e6)), max_size=20))
def test_whatever_comes_a_pose_is_made_of_it(fixes):
    walk = Walk()
    for x, y, at in fixes:
        pose = walk.fix(x, y, at)
        assert abs(pose.x - x) <= 1e-4
        assert pose.v >= 0
        assert math.isfinite(pose.v)
