"""A clock that is set is noticed, and the times since robots were heard stay what they were."""

from __future__ import annotations

import pytest

from robot_bridge.core.clock import ClockStep, ClockWatch, ManualClock
from robot_bridge.core.messages.positions import RobotReport
from robot_bridge.core.messages.robots import SendPos
from robot_bridge.core.messages.safety import RobotState
from robot_bridge.gateway.fleet.operator_updates import reports_of
from robot_bridge.gateway.model.robots import Robots

DAY = 86400.0


@pytest.fixture
def clock() -> ManualClock:
    return ManualClock(wall=1_790_000_000.0, uptime=300.0)


@pytest.mark.parametrize("by", [DAY, -3600.0, 1.5, -1.5])
def test_a_clock_that_was_set_is_noticed_once(clock, by):
    watch = ClockWatch(clock)
    clock.advance(0.25)
    assert watch.measure_step() is None
    clock.advance(0.1)
    clock.wall += by
    clock.advance(0.15)
    step = watch.measure_step()
    assert step.by == pytest.approx(by)
    assert (step.since, step.now) == pytest.approx((clock.wall - 0.25, clock.wall))
    clock.advance(0.25)
    assert watch.measure_step() is None


def test_a_clock_that_is_corrected_little_by_little_was_not_set(clock):
    watch = ClockWatch(clock)
    for _ in range(100):
        clock.advance(60)
        clock.wall += 0.03
        assert watch.measure_step() is None


def test_a_time_noted_after_the_clock_was_set_stays():
    step = ClockStep(-3600.0, 1000.0, 1000.25)
    assert [step.moved(at) for at in (1000.0, 1000.2, 4599.0)] == [1000.0, 1000.2, 999.0]


@pytest.mark.parametrize("by", [DAY, -3600.0])
def test_the_times_since_robots_were_heard_stay(clock, by):
    robots, watch = Robots(stale_after=3.0, lost_after=10.0), ClockWatch(clock)
    for name in ("silent", "heard"):
        robots.ready(name, 7, "websocket", clock.wall)
        robots.observe(name, SendPos(1.0, 2.0, 0.0, 0.0), "websocket", clock.wall)
    clock.advance(5.0)
    robots.observe("heard", SendPos(1.0, 2.0, 0.0, 0.0), "websocket", clock.wall)
    robots.age(clock.wall)
    assert watch.measure_step() is None
    clock.wall += by
    clock.advance(0.1)
    robots.observe("heard", SendPos(2.0, 2.0, 0.0, 0.0), "websocket", clock.wall)
    clock.advance(0.1)
    robots.clock_was_set(watch.measure_step())
    robots.age(clock.wall)
    told = {report.robot: report for report in reports_of(robots.changed(-1), clock.wall, RobotReport)}
    assert (told["silent"].state, told["heard"].state) == (RobotState.STALE, RobotState.FRESH)
    assert told["silent"].age == told["silent"].pose_age == pytest.approx(5.2)
    assert told["heard"].age == told["heard"].pose_age == pytest.approx(0.1)
