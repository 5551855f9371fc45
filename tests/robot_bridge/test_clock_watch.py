"""A clock that is set is noticed, and the times since robots were heard stay what they were."""

from __future__ import annotations

import pytest

from robot_bridge.core.messages import RobotState, SendPos
from robot_bridge.gateway.model.clocks import ClockStep, ClockWatch
from robot_bridge.gateway.model.robots import Robots

DAY = 86400.0


class Clock:
    """A computer's two clocks: ``now`` can be set."""

    def __init__(self):
        self.now, self.steady = 1_790_000_000.0, 300.0

    def watch(self):
        return ClockWatch(lambda: self.now, lambda: self.steady)

    def pass_by(self, seconds):
        self.now += seconds
        self.steady += seconds


@pytest.fixture
def clock() -> Clock:
    return Clock()


@pytest.mark.parametrize("by", [DAY, -3600.0, 1.5, -1.5])
def test_a_clock_that_was_set_is_noticed_once(clock, by):
    watch = clock.watch()
    clock.pass_by(0.25)
    assert watch.measure_step() is None
    clock.pass_by(0.1)
    clock.now += by
    clock.pass_by(0.15)
    step = watch.measure_step()
    assert step.by == pytest.approx(by)
    assert (step.since, step.now) == pytest.approx((clock.now - 0.25, clock.now))
    clock.pass_by(0.25)
    assert watch.measure_step() is None


def test_a_clock_that_is_corrected_little_by_little_was_not_set(clock):
    watch = clock.watch()
    for _ in range(100):
        clock.pass_by(60)
        clock.now += 0.03
        assert watch.measure_step() is None


def test_a_time_noted_after_the_clock_was_set_stays():
    step = ClockStep(-3600.0, 1000.0, 1000.25)
    assert [step.moved(at) for at in (1000.0, 1000.2, 4599.0)] == [1000.0, 1000.2, 999.0]


@pytest.mark.parametrize("by", [DAY, -3600.0])
def test_the_times_since_robots_were_heard_stay(clock, by):
    robots, watch = Robots(stale_after=3.0, lost_after=10.0), clock.watch()
    for name in ("silent", "heard"):
        robots.ready(name, 7, "websocket", clock.now)
        robots.observe(name, SendPos(1.0, 2.0, 0.0, 0.0), "websocket", clock.now)
    clock.pass_by(5.0)
    robots.observe("heard", SendPos(1.0, 2.0, 0.0, 0.0), "websocket", clock.now)
    robots.age(clock.now)
    assert watch.measure_step() is None
    clock.now += by
    clock.pass_by(0.1)
    robots.observe("heard", SendPos(2.0, 2.0, 0.0, 0.0), "websocket", clock.now)
    clock.pass_by(0.1)
    robots.clock_was_set(watch.measure_step())
    robots.age(clock.now)
    told = {report.robot: report for report in robots.reports(clock.now)}
    assert (told["silent"].state, told["heard"].state) == (RobotState.STALE, RobotState.FRESH)
    assert told["silent"].age == told["silent"].pose_age == pytest.approx(5.2)
    assert told["heard"].age == told["heard"].pose_age == pytest.approx(0.1)
