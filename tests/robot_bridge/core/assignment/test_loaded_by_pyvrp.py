"""Robots that have all cones aboard share them out as well as can be, and better than a preview."""

from __future__ import annotations

import functools
import math
from collections.abc import Iterator
from dataclasses import replace
from itertools import pairwise, permutations

import numpy as np
import pytest

pytest.importorskip("pyvrp")

from robot_bridge.core.assignment.job import (
    STAY,
    TO_START,
    TO_STORE,
    AssignmentJob,
    ConeTarget,
    PlanRobot,
    Store,
    StraightTravel,
)
from robot_bridge.core.assignment.plan import check_plan
from robot_bridge.core.assignment.pyvrp_search import SearchClock, SearchProgress, loaded_days_by_pyvrp
from robot_bridge.core.assignment.schedules import (
    BALANCED,
    LEAST_DISTANCE,
    Schedule,
    ScheduleEvaluator,
    StageObjective,
)
from robot_bridge.core.assignment.solver import PREVIEW, PYVRP, Objective, assign

ROUNDING = 0.05 * 10
"""Metres or seconds by which a plan may be longer than the best: half a decimetre on each of its ways."""
NO_HURRY = 600.0
"""Seconds; the search ends of itself long before."""


def loaded(seed: int, finish: str, cones: int, room: int, robots: int = 2, stores: int = 0) -> AssignmentJob:
    """Return a job of robots here and there, of two speeds, that have ``room`` cones aboard."""
    random = np.random.default_rng(seed)
    places, starts = random.uniform(0, 100, (cones, 2)).tolist(), random.uniform(0, 100, (robots, 2)).tolist()
    return AssignmentJob(
        tuple(ConeTarget(f"c{k}", *place, service_s=10.0 + k) for k, place in enumerate(places)),
        tuple(
            PlanRobot(f"R{k}", *at, room, 1.0 + k % 2, aboard=room, ready_s=20.0 * k)
            for k, at in enumerate(starts)
        ),
        tuple(Store(f"s{k}", 100.0 * k, 50.0) for k in range(stores)),
        finish,
    )


def every_plan(job: AssignmentJob, before: list[Schedule]) -> Iterator[list[Schedule]]:
    """Yield all plans of two robots in which what is not in ``before`` follows it."""
    there = {place for day in before for place in day[0]}
    targets = [place for place in range(job.first_target, len(job.places)) if place not in there]
    for order in permutations(targets):
        for split in range(len(order) + 1):
            yield [[before[0][0] + list(order[:split])], [before[1][0] + list(order[split:])]]


def by_hand(job: AssignmentJob, plan: list[Schedule], gate_s: float) -> tuple[float, float]:
    """Return when the last robot ends and the metres of all; infinite where room or battery is not enough.

    Cones of stage 1 may not be begun before ``gate_s``.
    """
    metres = _metres(job)
    ends, total = [], 0.0
    for number, (robot, (row,)) in enumerate(zip(job.robots, plan, strict=True)):
        tour = [number, *row]
        if row and job.finish == TO_START:
            tour.append(number)
        if row and job.finish == TO_STORE:
            tour.append(min(range(job.first_store, job.first_target), key=lambda one: metres[row[-1], one]))
        clock, way = robot.ready_s, 0.0
        for a, b in pairwise(tour):
            way += metres[a, b]
            clock += metres[a, b] / robot.speed
            if b >= job.first_target:
                target = job.target(b)
                clock = max(clock, gate_s if target.stage else 0.0) + target.service_s
            elif b >= job.first_store:
                clock += job.stores[b - job.first_store].service_s
        if way > robot.range_m or len(row) > robot.aboard:
            return math.inf, math.inf
        ends.append(clock)
        total += way
    return max(ends), total


@functools.lru_cache(maxsize=8)
def _metres(job: AssignmentJob) -> np.ndarray:
    return StraightTravel(job).metres


def found(job: AssignmentJob, objective: str, before: list[Schedule], gate_s: float = 0.0) -> list[Schedule]:
    """Return what is found from the plan in which the first robot places all, as far as it can."""
    days = ScheduleEvaluator(job, StraightTravel(job).metres)
    days.gates[1] = gate_s
    start = next(
        plan for plan in reversed(list(every_plan(job, before))) if by_hand(job, plan, gate_s)[0] < math.inf
    )
    clock = SearchClock(NO_HURRY, SearchProgress(lambda share: True))
    return loaded_days_by_pyvrp(days, before, start, StageObjective(objective), clock)


def assert_is_best(job: AssignmentJob, objective: str, before: list[Schedule], gate_s: float = 0.0) -> None:
    plan = found(job, objective, before, gate_s)
    which = 0 if objective == BALANCED else 1
    least = min(by_hand(job, one, gate_s)[which] for one in every_plan(job, before))
    assert least - 1e-6 <= by_hand(job, plan, gate_s)[which] <= least + ROUNDING


NOTHING: list[Schedule] = [[[]], [[]]]
OBJECTIVES = pytest.mark.parametrize("objective", [BALANCED, LEAST_DISTANCE])


@OBJECTIVES
@pytest.mark.parametrize("finish", [STAY, TO_START, TO_STORE])
@pytest.mark.parametrize("seed", [0, pytest.param(1, marks=pytest.mark.again("seed 0"))])
def test_no_other_plan_is_better(finish: str, objective: str, seed: int) -> None:
    assert_is_best(loaded(seed, finish, 5, 4, stores=2 * (finish == TO_STORE)), objective, NOTHING)


@OBJECTIVES
def test_room_is_what_is_aboard(objective: str) -> None:
    job = loaded(3, STAY, 5, 3)
    robots = (replace(job.robots[0], capacity=8), replace(job.robots[1], aboard=2))
    assert_is_best(replace(job, robots=robots), objective, NOTHING)


@OBJECTIVES
def test_a_battery_is_not_driven_empty(objective: str) -> None:
    job = loaded(0, TO_START, 5, 5)
    whole = found(job, objective, NOTHING)
    drives = [
        by_hand(job, [day if k == one else [[]] for k, day in enumerate(whole)], 0.0)[1] for one in (0, 1)
    ]
    short = drives.index(max(drives))
    robots = tuple(
        replace(one, range_m=max(drives) - 5.0) if k == short else one for k, one in enumerate(job.robots)
    )
    assert_is_best(replace(job, robots=robots), objective, NOTHING)


def second_stage(seed: int) -> tuple[AssignmentJob, list[Schedule], float]:
    """Return a job of which the second robot has placed one cone, far off, for which the others waited."""
    job = loaded(seed, STAY, 5, 4)
    targets = (replace(job.targets[0], x=180.0, y=150.0), *(replace(one, stage=1) for one in job.targets[1:]))
    job = replace(job, targets=targets)
    before: list[Schedule] = [[[]], [[job.first_target]]]
    return job, before, by_hand(job, before, 0.0)[0]


@OBJECTIVES
@pytest.mark.parametrize("seed", [0, *(pytest.param(k, marks=pytest.mark.again("seed 0")) for k in (1, 2))])
def test_a_later_stage_goes_on_when_and_where_the_robots_are(objective: str, seed: int) -> None:
    assert_is_best(second_stage(seed)[0], objective, *second_stage(seed)[1:])


@OBJECTIVES
def test_what_was_driven_in_earlier_stages_is_gone_from_the_battery(objective: str) -> None:
    job, before, gate_s = second_stage(0)
    job = replace(job, robots=(replace(job.robots[0], aboard=2), job.robots[1]))
    whole = found(job, objective, before, gate_s)
    drives = by_hand(job, [[[]], whole[1]], gate_s)[1]
    robots = (replace(job.robots[0], aboard=4), replace(job.robots[1], range_m=drives - 1.0))
    assert_is_best(replace(job, robots=robots), objective, before, gate_s)


@pytest.mark.parametrize(
    ("objective", "cones", "room"),
    [
        pytest.param(BALANCED, 32, 12, marks=pytest.mark.again("test_no_other_plan_is_better")),
        (LEAST_DISTANCE, 14, 6),
    ],
)
def test_it_is_better_than_a_preview_and_says_who_found_it(objective: str, cones: int, room: int) -> None:
    job = loaded(1, TO_START, cones, room, robots=4)
    preview, plan = (
        assign(job, StraightTravel(job), Objective(objective, method, NO_HURRY))
        for method in (PREVIEW, PYVRP)
    )
    assert check_plan(plan) == []
    assert plan.method == PYVRP
    gain = plan.end_s / preview.end_s if objective == BALANCED else plan.metres / preview.metres
    assert gain < 0.98, gain


def test_what_cannot_be_better_is_told_to_be_the_preview() -> None:
    job = loaded(0, STAY, 1, 4)
    plan = assign(job, StraightTravel(job), Objective(method=PYVRP))
    assert plan.method == "pyvrp, which found nothing better than the preview"
