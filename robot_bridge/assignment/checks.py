"""A plan checked from its stops alone, by none of the code that makes plans."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterator
from itertools import pairwise

from ..counting import counted
from .job import COLLECT, PLACE, Target
from .plan import HOME, STORE, Plan, RobotPlan, Stop

_DONE = {PLACE: "placed", COLLECT: "collected"}
_NEAR = 0.01
"""Metres and seconds of rounding."""


def check_plan(plan: Plan) -> list[str]:
    """Return what is wrong with ``plan``, nothing where it can be driven as it is.

    Checked are: every target once, room, what is aboard, unloading, times, speeds, paths that hang together,
    batteries, and that no target is begun before all of lower stages are done.
    """
    faults = list(_served_once(plan))
    for one in plan.robots:
        faults += _load_faults(one, {target.id: target for target in plan.targets})
        faults += _time_faults(one, {target.id: target for target in plan.targets})
        faults += _path_faults(one)
    return faults + list(_stage_faults(plan))


def _served_once(plan: Plan) -> Iterator[str]:
    served = Counter(stop.id for _, stop in plan.all_stops() if stop.is_target)
    served.update(stop.id for one in plan.robots for stop in one.done if stop.is_target)
    left_out = {one.target.id for one in plan.left_out}
    for target in plan.targets:
        count = served.pop(target.id, 0)
        if target.id in left_out and count:
            yield f"Cone {target.id} is left out and served nevertheless."
        elif target.id not in left_out and count != 1:
            yield f"Cone {target.id} is served {counted(count, 'time')}."
    for name in served:
        yield f"Cone {name} is served and not asked for."


def _load_faults(one: RobotPlan, targets: dict[str, Target]) -> Iterator[str]:
    robot = one.robot
    aboard, collected = robot.aboard, robot.collected
    for stop in one.stops:
        where = f"Robot {robot.id} at {stop.kind} {stop.id}"
        demand = targets[stop.id].demand if stop.is_target and stop.id in targets else 0
        if stop.is_target and stop.id in targets and stop.kind != targets[stop.id].kind:
            yield f"{where}: the cone is to be {_DONE[targets[stop.id].kind]}."
        if stop.kind != STORE and (stop.loaded or stop.unloaded):
            yield f"{where}: loads or unloads where there is no store."
        if stop.kind == STORE:
            total = aboard + collected + stop.loaded - stop.unloaded
            aboard, collected = stop.aboard, stop.collected
            if total != aboard + collected:
                yield f"{where}: {aboard + collected} are on it, and {total} should be."
        aboard -= demand if stop.kind == PLACE else 0
        collected += demand if stop.kind == COLLECT else 0
        if (aboard, collected) != (stop.aboard, stop.collected):
            yield f"{where}: {stop.aboard} and {stop.collected} are told, {aboard} and {collected} are on it."
        if aboard < 0:
            yield f"{where}: has no cone to place."
        if aboard + collected > robot.capacity:
            yield f"{where}: {aboard + collected} are on it, and there is room for {robot.capacity}."
    if collected and one.stops:
        yield f"Robot {robot.id} ends with {counted(collected, 'collected cone')} not unloaded."


def _time_faults(one: RobotPlan, targets: dict[str, Target]) -> Iterator[str]:
    robot = one.robot
    clock, metres = robot.ready_s, 0.0
    for stop in one.stops:
        where = f"Robot {robot.id} at {stop.kind} {stop.id}"
        metres += stop.metres
        if abs(stop.arrival_s - clock - stop.metres / robot.speed) > _NEAR:
            yield f"{where}: arrives at {stop.arrival_s:.2f} s, which its speed does not allow."
        if stop.begin_s < stop.arrival_s - _NEAR:
            yield f"{where}: begins before it is there."
        service = targets[stop.id].service_s if stop.is_target and stop.id in targets else 0.0
        if stop.end_s < stop.begin_s + service - _NEAR:
            yield f"{where}: ends before it can have been done."
        clock = stop.end_s
    if metres > robot.range_m + _NEAR:
        yield f"Robot {robot.id} drives {metres:.1f} m and has battery for {robot.range_m:.1f} m."


def _path_faults(one: RobotPlan) -> Iterator[str]:
    at = one.robot.x, one.robot.y
    for stop in one.stops:
        where = f"Robot {one.robot.id} at {stop.kind} {stop.id}"
        if len(stop.path) < 2:
            yield f"{where}: there is no path."
            continue
        if math.dist(stop.path[0], at) > _NEAR:
            yield f"{where}: the path does not begin where the robot is."
        at = stop.x, stop.y
        if math.dist(stop.path[-1], at) > _NEAR:
            yield f"{where}: the path does not end there."
        length = sum(math.dist(a, b) for a, b in pairwise(stop.path))
        if not math.isfinite(stop.metres) or length > stop.metres * 1.001 + _NEAR * len(stop.path):
            yield f"{where}: the path is {length:.2f} m long, and {stop.metres:.2f} m are counted."
        if stop.kind == HOME and math.dist(at, (one.robot.x, one.robot.y)) > _NEAR:
            yield f"{where}: is not where the robot began."


def _stage_faults(plan: Plan) -> Iterator[str]:
    stage_of = {target.id: target.stage for target in plan.targets}
    stops: dict[int, list[Stop]] = {}
    for _, stop in plan.all_stops():
        if stop.is_target and stop.id in stage_of:
            stops.setdefault(stage_of[stop.id], []).append(stop)
    done_s, last = -math.inf, ""
    for stage in sorted(stops):
        for stop in stops[stage]:
            if stop.begin_s < done_s - _NEAR:
                yield f"Cone {stop.id} of stage {stage} is begun before {last} is done."
        latest = max(stops[stage], key=lambda one: one.end_s)
        if latest.end_s > done_s:
            done_s, last = latest.end_s, latest.id
