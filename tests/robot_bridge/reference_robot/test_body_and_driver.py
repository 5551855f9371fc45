"""The simulated body keeps its limits, and the driver brings it where it was told."""

from __future__ import annotations

import itertools
import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from robot_bridge.core.geometry import Polyline
from robot_bridge.reference_robot.body import Body, BodyLimits, Driver

DT = 0.05
angles = st.floats(-math.pi, math.pi)
places = st.floats(-15, 15)


def drive(pose, points, theta=None, limits=None, seconds=120.0):
    """Drive until the driver says it is done; return the body and every pose on the way."""
    limits = limits or BodyLimits()
    body, driver, trace = Body(pose, limits), Driver(points, theta, limits), [pose]
    for _ in range(round(seconds / DT)):
        motion = driver.steer(body.pose)
        body.drive(*(motion or (0.0, 0.0)))
        body.step(DT)
        trace.append(body.pose)
        if motion is None and abs(body.v) < 0.01:
            return body, trace
    raise AssertionError(f"not done after {seconds:g} s, at {body.pose}")


@settings(deadline=None, max_examples=50)
@given(
    st.lists(st.tuples(st.floats(-100, 100), st.floats(-100, 100)), min_size=1, max_size=30),
    st.floats(0.05, 20),
    st.floats(0.05, 10),
)
def test_the_body_keeps_its_limits_whatever_it_is_asked(wishes, speed, turn_rate):
    limits = BodyLimits(speed=speed, turn_rate=turn_rate)
    body = Body((0.0, 0.0, 0.0), limits)
    for wish in wishes:
        v, turn = body.v, body.turn_rate
        x, y, theta = body.pose
        body.drive(*wish)
        body.step(DT)
        assert abs(body.v) <= speed
        assert abs(body.turn_rate) <= turn_rate
        assert abs(body.v - v) <= limits.acceleration * DT + 1e-9
        assert abs(body.turn_rate - turn) <= limits.turn_acceleration * DT + 1e-9
        assert math.hypot(body.pose[0] - x, body.pose[1] - y) == pytest.approx(abs(body.v) * DT)
        assert abs(math.remainder(body.pose[2] - theta, math.tau)) <= turn_rate * DT + 1e-9


@settings(deadline=None, max_examples=40)
@given(places, places, angles, st.sampled_from([0.5, 1.5, 5.0]))
def test_the_robot_arrives_within_5_cm_from_anywhere(x, y, theta, speed):
    body, _ = drive((x, y, theta), [(2.0, 3.0)], limits=BodyLimits(speed=speed))
    assert math.hypot(body.pose[0] - 2.0, body.pose[1] - 3.0) <= 0.05 + 0.01


@settings(deadline=None, max_examples=20)
@given(places, places, angles, angles)
def test_the_robot_ends_in_the_heading_it_was_told(x, y, theta, wanted):
    body, _ = drive((x, y, theta), [(2.0, 3.0)], wanted)
    assert abs(math.remainder(body.pose[2] - wanted, math.tau)) < 0.1


def test_the_robot_follows_a_loop_all_round_and_ends_where_it_began():
    angle = np.linspace(0, math.tau, 60)
    loop = [(10 * math.cos(a), 10 * math.sin(a)) for a in angle]
    body, trace = drive((10.0, 0.0, math.pi / 2), loop)
    radii = np.hypot(*np.array(trace)[:, :2].T)
    assert abs(radii - 10).max() < 0.3
    driven = np.hypot(*np.diff(np.array(trace)[:, :2], axis=0).T).sum()
    assert driven == pytest.approx(math.tau * 10, rel=0.05)
    assert math.hypot(body.pose[0] - 10, body.pose[1]) < 0.1


def test_the_robot_turns_on_the_spot_before_it_drives_back():
    _, trace = drive((0.0, 0.0, 0.0), [(-5.0, 0.0)])
    assert max(x for x, _, _ in trace) < 0.05
    assert min(x for x, _, theta in trace if abs(theta) < 2.0) > -0.05


CORNERS = {
    "right angle": [(0, 0), (20, 0), (20, 20)],
    "hairpin": [(0, 0), (20, 0), (6, 14)],
    "there and back": [(0, 0), (20, 0), (0, 0.5)],
    "half a circle": [
        *((x, 0) for x in np.arange(0, 20, 0.5)),
        *((20 + 2 * math.sin(a), 2 - 2 * math.cos(a)) for a in np.arange(0, math.pi, 0.2)),
        *((20 - x, 4) for x in np.arange(0.5, 20, 0.5)),
    ],
    "waves": [(x, math.sin(x / 1.5)) for x in np.arange(0, 30, 0.25)],
}


@pytest.mark.parametrize("speed", [1.5, 2.5, 5.0])
@pytest.mark.parametrize("name", CORNERS)
def test_a_fast_robot_brakes_before_a_corner_and_keeps_to_its_path(name, speed):
    _, trace = drive((0.0, 0.0, 0.0), CORNERS[name], limits=BodyLimits(speed=speed))
    line = Polyline(CORNERS[name])
    assert max(line.feet(x, y)[1].min() for x, y, _ in trace) < 0.4


def test_a_fast_robot_is_fast_where_its_path_is_straight():
    _, trace = drive((0.0, 0.0, 0.0), CORNERS["right angle"], limits=BodyLimits(speed=5.0))
    steps = np.hypot(*np.diff(np.array(trace)[:, :2], axis=0).T)
    assert steps.max() / DT > 3.5


@pytest.mark.parametrize("acceleration", [1.5, 8.0])
def test_a_robot_keeps_its_speed_where_a_straight_path_has_many_points(acceleration):
    limits = BodyLimits.of(2.0, 6.0, acceleration)
    _, trace = drive((0.0, 0.0, 0.0), [(x, 0.0) for x in np.arange(0, 20, 0.5)], limits=limits)
    speeds = [(b[0] - a[0]) / DT for a, b in itertools.pairwise(trace) if 3 < b[0] < 16]
    assert min(speeds) > 1.9
