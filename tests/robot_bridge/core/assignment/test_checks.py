"""The checker finds whatever is wrong with a plan."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import pytest

from robot_bridge.core.assignment.job import COLLECT, PLACE, StraightTravel
from robot_bridge.core.assignment.plan import STORE, ConePlan, LeftOut, PlanStop, check_plan
from robot_bridge.core.assignment.solver import PREVIEW, Objective, assign
from tests.robot_bridge.core.assignment.jobs import scattered


def good() -> ConePlan:
    job = scattered(7, robots=2, capacity=3)
    targets = tuple(
        replace(target, stage=int(k > 4), kind=COLLECT if k == 2 else PLACE)
        for k, target in enumerate(job.targets)
    )
    job = replace(job, targets=targets)
    return assign(job, StraightTravel(job), Objective(method=PREVIEW))


def changed(
    plan: ConePlan, of: Callable[[PlanStop], bool], change: Callable[[PlanStop], PlanStop | None]
) -> ConePlan:
    """Return ``plan`` with the first stop that is ``of`` a kind changed, or left out for None."""
    for r, one in enumerate(plan.robots):
        for t, trip in enumerate(one.trips):
            for s, stop in enumerate(trip.stops):
                if of(stop):
                    new = change(stop)
                    stops = (*trip.stops[:s], *([] if new is None else [new]), *trip.stops[s + 1 :])
                    trips = (*one.trips[:t], replace(trip, stops=stops), *one.trips[t + 1 :])
                    robots = (*plan.robots[:r], replace(one, trips=trips), *plan.robots[r + 1 :])
                    return replace(plan, robots=robots)
    raise AssertionError("no such stop")


def is_kind(kind: str) -> Callable[[PlanStop], bool]:
    return lambda stop: stop.kind == kind


def test_nothing_is_wrong_with_a_good_plan() -> None:
    assert check_plan(good()) == []


@pytest.mark.parametrize(
    ("kind", "change", "told"),
    [
        (PLACE, lambda stop: None, "is served 0 times"),
        (PLACE, lambda stop: replace(stop, id="other"), "is served and not asked for"),
        (COLLECT, lambda stop: replace(stop, kind=PLACE), "is to be collected"),
        (STORE, lambda stop: replace(stop, loaded=stop.loaded + 1), "should be"),
        (PLACE, lambda stop: replace(stop, aboard=stop.aboard + 1), "are told"),
        (PLACE, lambda stop: replace(stop, loaded=1), "where there is no store"),
        (PLACE, lambda stop: replace(stop, arrival_s=stop.arrival_s - 5), "speed does not allow"),
        (PLACE, lambda stop: replace(stop, begin_s=stop.arrival_s - 1), "begins before it is there"),
        (PLACE, lambda stop: replace(stop, end_s=stop.begin_s + 1), "ends before it can"),
        (PLACE, lambda stop: replace(stop, path=stop.path[1:]), "does not begin where the robot is"),
        (PLACE, lambda stop: replace(stop, path=stop.path[:-1]), "does not end there"),
        (PLACE, lambda stop: replace(stop, path=()), "there is no path"),
        (PLACE, lambda stop: replace(stop, metres=stop.metres / 2), "are counted"),
    ],
)
def test_a_stop_that_is_wrong_is_found(
    kind: str, change: Callable[[PlanStop], PlanStop | None], told: str
) -> None:
    faults = check_plan(changed(good(), is_kind(kind), change))
    assert any(told in fault for fault in faults), faults


def test_a_cone_served_twice_is_found() -> None:
    plan = good()
    stop = next(stop for _, stop in plan.all_stops() if stop.is_target)
    other = next(one for _, one in plan.all_stops() if one.is_target and one.id != stop.id)
    twice = changed(plan, lambda one: one == other, lambda one: replace(one, id=stop.id))
    assert f"Cone {stop.id} is served 2 times." in check_plan(twice)


def test_a_cone_left_out_and_served_is_found() -> None:
    plan = good()
    faults = check_plan(replace(plan, left_out=(LeftOut(plan.targets[0], "why not"),)))
    assert faults == ["Cone cone-1 is left out and served nevertheless."]


@pytest.mark.parametrize(
    ("change", "told"),
    [
        ({"capacity": 1}, "there is room for 1"),
        ({"range_m": 10.0}, "has battery for 10.0 m"),
        ({"collected": 1}, "should be"),
        ({"speed": 2.0}, "speed does not allow"),
        ({"x": 1.0}, "does not begin"),
    ],
)
def test_a_robot_that_cannot_is_found(change: dict, told: str) -> None:
    plan = good()
    robots = tuple(replace(one, robot=replace(one.robot, **change)) for one in plan.robots)
    assert any(told in fault for fault in check_plan(replace(plan, robots=robots)))


def test_a_stage_begun_too_early_is_found() -> None:
    plan = good()
    targets = tuple(replace(target, stage=5 - target.stage) for target in plan.targets)
    assert any("is begun before" in fault for fault in check_plan(replace(plan, targets=targets)))


def test_collected_cones_that_stay_aboard_are_found() -> None:
    job = scattered(3, robots=1, capacity=3)
    job = replace(job, targets=tuple(replace(target, kind=COLLECT) for target in job.targets))
    plan = assign(job, StraightTravel(job), Objective(method=PREVIEW))
    faults = check_plan(changed(plan, is_kind(STORE), lambda stop: None))
    assert faults == ["Robot R1 ends with 3 collected cones not unloaded."]
