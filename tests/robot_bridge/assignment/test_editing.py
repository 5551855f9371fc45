"""Plans changed by hand can be driven too, or the change is refused by name."""

from __future__ import annotations

from dataclasses import replace

import pytest

from robot_bridge.assignment.checks import check_plan
from robot_bridge.assignment.editing import moved, removed, reordered, trips_of
from robot_bridge.assignment.errors import EditError
from robot_bridge.assignment.job import Job, Robot, Store, Target
from robot_bridge.assignment.plan import Plan
from robot_bridge.assignment.solving import PREVIEW, Wanted, assign
from robot_bridge.assignment.travel import StraightTravel

from .jobs import scattered


@pytest.fixture
def plan() -> Plan:
    job = scattered(8, robots=2, capacity=3)
    return assign(job, StraightTravel(job), Wanted("balanced", PREVIEW))


def first_of(plan: Plan, robot: str) -> str:
    return next(stop.id for stop in plan.robot(robot).stops if stop.is_target)


def test_trips_of_a_plan_are_its_own(plan: Plan) -> None:
    trips = trips_of(plan)
    assert [[tuple(row) for row in day[1:]] for day in trips] == [
        [trip.targets for trip in one.trips] for one in plan.robots
    ]
    assert [day[0] for day in trips] == [[], []]


def test_a_cone_goes_to_another_robot(plan: Plan) -> None:
    cone = first_of(plan, "R1")
    new = len(trips_of(plan)[1])
    changed = moved(plan, StraightTravel, cone, "R2", new, 0)
    assert check_plan(changed) == []
    assert changed.robot("R2").trips[-1].targets == (cone,)
    assert changed.robot("R2").end_s > plan.robot("R2").end_s
    assert changed.robot("R1").end_s < plan.robot("R1").end_s
    assert cone in trips_of(plan)[0][1]


def test_an_order_is_turned(plan: Plan) -> None:
    before = trips_of(plan)[0][1]
    changed = reordered(plan, StraightTravel, "R1", 1, before[::-1])
    assert trips_of(changed)[0][1] == before[::-1]
    assert check_plan(changed) == []


def test_a_cone_is_taken_out(plan: Plan) -> None:
    changed = removed(plan, StraightTravel, "cone-2", "not needed")
    assert check_plan(changed) == []
    assert [(one.target.id, one.reason) for one in changed.left_out] == [("cone-2", "not needed")]
    with pytest.raises(EditError, match="No robot serves cone cone-2"):
        removed(changed, StraightTravel, "cone-2")


def test_what_cannot_be_driven_is_refused(plan: Plan) -> None:
    full = next(k for k, row in enumerate(trips_of(plan)[1]) if len(row) == 3)
    cone = first_of(plan, "R1")
    with pytest.raises(
        EditError, match=rf"Robot R2 cannot serve .*{cone}.* on trip {full}: it has room for 3"
    ):
        moved(plan, StraightTravel, cone, "R2", full, 0)
    with pytest.raises(EditError, match="0 cones aboard"):
        moved(plan, StraightTravel, cone, "R2", 0, 0)
    for robot, trip, place, told in (
        ("R9", 1, 0, "no robot R9"),
        ("R2", 9, 0, "no trip 9"),
        ("R2", 1, 9, "place 9"),
    ):
        with pytest.raises(EditError, match=told):
            moved(plan, StraightTravel, cone, robot, trip, place)
    with pytest.raises(EditError, match="order these"):
        reordered(plan, StraightTravel, "R1", 1, ["cone-1"])


def test_a_battery_is_minded(plan: Plan) -> None:
    robots = tuple(replace(one, robot=replace(one.robot, range_m=one.metres + 1)) for one in plan.robots)
    plan = replace(plan, robots=robots)
    with pytest.raises(EditError, match="has battery for"):
        moved(plan, StraightTravel, first_of(plan, "R1"), "R2", len(trips_of(plan)[1]), 0)


def test_stages_stay_in_their_order_and_wait() -> None:
    job = scattered(6, robots=2, capacity=3)
    job = replace(job, targets=tuple(replace(one, stage=k // 3) for k, one in enumerate(job.targets)))
    plan = assign(job, StraightTravel(job), Wanted("balanced", PREVIEW))
    late = next(one.id for one in job.targets if one.stage == 1)
    day = trips_of(plan)[0]
    other = late if any(late in row for row in day) else first_of_stage(plan, "R1")
    changed = moved(plan, StraightTravel, other, "R2", len(trips_of(plan)[1]), 0)
    assert check_plan(changed) == []
    first = next(k for k, row in enumerate(trips_of(changed)[1]) if row)
    with pytest.raises(EditError, match="later stage before"):
        row = trips_of(changed)[1][first]
        moved(changed, StraightTravel, other, "R2", first, 0) if len(row) < 3 else reordered(
            changed, StraightTravel, "R2", first, row[::-1]
        )


def first_of_stage(plan: Plan, robot: str) -> str:
    stage = {target.id: target.stage for target in plan.targets}
    return next(stop.id for stop in plan.robot(robot).stops if stop.is_target and stage[stop.id] == 1)


def test_a_cone_of_a_later_stage_waits_for_the_robot_that_is_late() -> None:
    job = Job(
        (Target("far", 100.0, 0.0), Target("near", 5.0, 0.0, stage=1)),
        (Robot("R1", 0.0, 0.0, 2), Robot("R2", 0.0, 0.0, 2, speed=0.1)),
        (Store("s", 0.0, 0.0),),
    )
    plan = assign(job, StraightTravel(job), Wanted("balanced", PREVIEW))
    plan = moved(plan, StraightTravel, "near", "R1", 1, 1)
    assert trips_of(plan) == [[[], ["far", "near"]], [[]]]
    changed = moved(plan, StraightTravel, "near", "R2", 1, 0)
    assert check_plan(changed) == []
    stops = {stop.id: stop for _, stop in changed.all_stops()}
    assert stops["near"].begin_s == stops["far"].end_s > stops["near"].arrival_s
