"""Plans made anew while they are driven: what is done stays, the rest is shared out again."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from itertools import pairwise

from .editing import TravelOf, job_of
from .job import Robot
from .plan import LeftOut, Plan, RobotPlan, Stop
from .solving import Progress, Wanted, assign


@dataclass(frozen=True)
class Situation:
    """How things are ``now_s`` seconds after the plan's begin.

    ``done`` are the ids of the cones that are placed or collected, ``lost`` the robots that are no more,
    ``failed`` why cones are given up, by their ids; a cone that is to be tried again is in neither.
    ``robots`` holds where robots are, what they carry and what battery they have, by their ids; of others it
    is what the plan says.
    """

    now_s: float
    done: frozenset[str] = frozenset()
    lost: frozenset[str] = frozenset()
    failed: Mapping[str, str] = field(default_factory=dict)
    robots: Mapping[str, Robot] = field(default_factory=dict)


def replan(
    plan: Plan,
    travel_of: TravelOf,
    situation: Situation,
    wanted: Wanted | None = None,
    progress: Progress | None = None,
) -> Plan:
    """Return the plan from now on: stops that are done are kept, the rest is shared out among who is left.

    :raises JobError: when no robot is left; UnservedError, MissingSolverError and CancelledError as
        :func:`~.solving.assign` does. ``plan`` is as it was.
    """
    robots = tuple(_from_now_on(one, situation) for one in plan.robots)
    known = {one.target.id for one in plan.left_out}
    failed = tuple(
        LeftOut(target, situation.failed[target.id])
        for target in plan.targets
        if target.id in situation.failed and target.id not in situation.done | known
    )
    so_far = replace(plan, robots=robots, left_out=(*plan.left_out, *failed))
    job = job_of(so_far)
    made = assign(job, travel_of(job), wanted or Wanted(plan.objective), progress)
    anew = {one.robot.id: one.trips for one in made.robots}
    return replace(
        so_far,
        robots=tuple(replace(one, trips=anew.get(one.robot.id, ())) for one in robots),
        objective=made.objective,
        method=made.method,
        travel=made.travel,
    )


def expected(plan: Plan, now_s: float) -> Situation:
    """Return how things are at ``now_s`` if everything has gone by the plan."""
    done = {stop.id for _, stop in plan.all_stops() if stop.is_target and stop.end_s <= now_s}
    robots = {one.robot.id: _by_plan(one, now_s) for one in plan.robots if not one.lost}
    return Situation(now_s, frozenset(done | plan.done), robots=robots)


def _from_now_on(one: RobotPlan, situation: Situation) -> RobotPlan:
    lost = one.lost or one.robot.id in situation.lost
    passed = _passed(one, situation)
    robot = situation.robots.get(one.robot.id) or _by_plan(one, situation.now_s)
    if not lost:
        robot = replace(robot, ready_s=max(robot.ready_s, situation.now_s))
    return RobotPlan(robot, (), (*one.done, *passed), lost)


def _passed(one: RobotPlan, situation: Situation) -> tuple[Stop, ...]:
    """Return the stops behind the robot: cones that are done, and stores that it was at by its plan."""
    stops, done = one.stops, situation.done
    last = max((k for k, stop in enumerate(stops) if stop.is_target and stop.id in done), default=-1)
    return tuple(
        stop
        for k, stop in enumerate(stops)
        if (stop.id in done if stop.is_target else k < last or stop.arrival_s <= situation.now_s)
    )


def _by_plan(one: RobotPlan, now_s: float) -> Robot:
    """Return the robot as it is at ``now_s`` by its plan: on its way, or where it stops."""
    robot = one.robot
    x, y, metres, aboard, collected, ready = robot.x, robot.y, 0.0, robot.aboard, robot.collected, now_s
    clock = robot.ready_s
    for stop in one.stops:
        if stop.arrival_s > now_s:
            driven = max(now_s - clock, 0.0) * robot.speed
            x, y = _along(stop, driven)
            metres += min(driven, stop.metres)
            break
        x, y, clock = stop.x, stop.y, stop.end_s
        metres += stop.metres
        if stop.end_s > now_s and stop.is_target:
            # What has begun counts as done only when it is: the cone is still aboard.
            break
        aboard, collected = stop.aboard, stop.collected
        ready = max(now_s, stop.end_s)
    left = robot.range_m - metres if math.isfinite(robot.range_m) else robot.range_m
    return replace(
        robot, x=x, y=y, range_m=max(left, 0.0), aboard=aboard, collected=collected,
        ready_s=max(ready, robot.ready_s),
    )  # fmt: skip


def _along(stop: Stop, metres: float) -> tuple[float, float]:
    left = metres
    for a, b in pairwise(stop.path):
        step = math.dist(a, b)
        if step >= left:
            share = left / step if step > 0 else 0.0
            return a[0] + share * (b[0] - a[0]), a[1] + share * (b[1] - a[1])
        left -= step
    return stop.path[-1]
