"""Plans changed by hand can be driven too, or the change is refused by name."""

from __future__ import annotations

from dataclasses import replace

import pytest

from robot_bridge.core.assignment.job import AssignmentJob, ConeTarget, PlanRobot, Store, StraightTravel
from robot_bridge.core.assignment.plan import ConePlan, check_plan
from robot_bridge.core.assignment.plan_changes import move_target, remove_target, reorder_trip, trips_of
from robot_bridge.core.assignment.solver import PREVIEW, Objective, assign
from robot_bridge.core.errors import PlanEditError
from tests.robot_bridge.core.assignment.jobs import scattered


@pytest.fixture
def plan() -> ConePlan:
    job = scattered(8, robots=2, capacity=3)
    return assign(job, StraightTravel(job), Objective("balanced", PREVIEW))


def first_of(plan: ConePlan, robot: str) -> str:
    return next(stop.id for stop in plan.robot(robot).stops if stop.is_target)


def test_trips_of_a_plan_are_its_own(plan: ConePlan) -> None:
    trips = trips_of(plan)
    assert [[tuple(row) for row in day[1:]] for day in trips] == [
        [trip.targets for trip in one.trips] for one in plan.robots
    ]
    assert [day[0] for day in trips] == [[], []]


def test_a_cone_goes_to_another_robot(plan: ConePlan) -> None:
    cone = first_of(plan, "R1")
    new = len(trips_of(plan)[1])
    changed = move_target(plan, StraightTravel, cone, "R2", new, 0)
    assert check_plan(changed) == []
    assert changed.robot("R2").trips[-1].targets == (cone,)
    assert changed.robot("R2").end_s > plan.robot("R2").end_s
    assert changed.robot("R1").end_s < plan.robot("R1").end_s
    assert cone in trips_of(plan)[0][1]


def test_an_order_is_turned(plan: ConePlan) -> None:
    before = trips_of(plan)[0][1]
    changed = reorder_trip(plan, StraightTravel, "R1", 1, before[::-1])
    assert trips_of(changed)[0][1] == before[::-1]
    assert check_plan(changed) == []


def test_a_cone_is_taken_out(plan: ConePlan) -> None:
    changed = remove_target(plan, StraightTravel, "cone-2", "not needed")
    assert check_plan(changed) == []
    assert [(one.target.id, one.reason) for one in changed.left_out] == [("cone-2", "not needed")]
    with pytest.raises(PlanEditError, match="No robot serves cone cone-2"):
        remove_target(changed, StraightTravel, "cone-2")


def test_what_cannot_be_driven_is_refused(plan: ConePlan) -> None:
    full = next(k for k, row in enumerate(trips_of(plan)[1]) if len(row) == 3)
    cone = first_of(plan, "R1")
    with pytest.raises(
        PlanEditError, match=rf"Robot R2 cannot serve .*{cone}.* on trip {full}: it has room for 3"
    ):
        move_target(plan, StraightTravel, cone, "R2", full, 0)
    with pytest.raises(PlanEditError, match="0 cones aboard"):
        move_target(plan, StraightTravel, cone, "R2", 0, 0)
    for robot, trip, place, told in (
        ("R9", 1, 0, "no robot R9"),
        ("R2", 9, 0, "no trip 9"),
        ("R2", 1, 9, "place 9"),
    ):
        with pytest.raises(PlanEditError, match=told):
            move_target(plan, StraightTravel, cone, robot, trip, place)
    with pytest.raises(PlanEditError, match="order these"):
        reorder_trip(plan, StraightTravel, "R1", 1, ["cone-1"])


def test_a_battery_is_minded(plan: ConePlan) -> None:
    robots = tuple(replace(one, robot=replace(one.robot, range_m=one.metres + 1)) for one in plan.robots)
    plan = replace(plan, robots=robots)
    with pytest.raises(PlanEditError, match="has battery for"):
        move_target(plan, StraightTravel, first_of(plan, "R1"), "R2", len(trips_of(plan)[1]), 0)


def test_stages_stay_in_their_order_and_wait() -> None:
    job = scattered(6, robots=2, capacity=3)
    job = replace(job, targets=tuple(replace(one, stage=k // 3) for k, one in enumerate(job.targets)))
    plan = assign(job, StraightTravel(job), Objective("balanced", PREVIEW))
    late = next(one.id for one in job.targets if one.stage == 1)
    day = trips_of(plan)[0]
    other = late if any(late in row for row in day) else first_of_stage(plan, "R1")
    changed = move_target(plan, StraightTravel, other, "R2", len(trips_of(plan)[1]), 0)
    assert check_plan(changed) == []
    first = next(k for k, row in enumerate(trips_of(changed)[1]) if row)
    with pytest.raises(PlanEditError, match="later stage before"):
        row = trips_of(changed)[1][first]
        move_target(changed, StraightTravel, other, "R2", first, 0) if len(row) < 3 else reorder_trip(
            changed, StraightTravel, "R2", first, row[::-1]
        )


def first_of_stage(plan: ConePlan, robot: str) -> str:
    stage = {target.id: target.stage for target in plan.targets}
    return next(stop.id for stop in plan.robot(robot).stops if stop.is_target and stage[stop.id] == 1)


def test_a_cone_of_a_later_stage_waits_for_the_robot_that_is_late() -> None:
    job = AssignmentJob(
        (ConeTarget("far", 100.0, 0.0), ConeTarget("near", 5.0, 0.0, stage=1)),
        (PlanRobot("R1", 0.0, 0.0, 2), PlanRobot("R2", 0.0, 0.0, 2, speed=0.1)),
        (Store("s", 0.0, 0.0),),
    )
    plan = assign(job, StraightTravel(job), Objective("balanced", PREVIEW))
    plan = move_target(plan, StraightTravel, "near", "R1", 1, 1)
    assert trips_of(plan) == [[[], ["far", "near"]], [[]]]
    changed = move_target(plan, StraightTravel, "near", "R2", 1, 0)
    assert check_plan(changed) == []
    stops = {stop.id: stop for _, stop in changed.all_stops()}
    assert stops["near"].begin_s == stops["far"].end_s > stops["near"].arrival_s
