"""What is done stays done; the rest is shared out among the robots that are left."""

from __future__ import annotations

import math
from dataclasses import replace

import pytest

from robot_bridge.core.assignment.job import StraightTravel
from robot_bridge.core.assignment.plan import (
    STORE,
    ConePlan,
    PlanSituation,
    check_plan,
    plan_from_json,
    plan_to_json,
)
from robot_bridge.core.assignment.plan_changes import expected_situation, replan
from robot_bridge.core.assignment.solver import PREVIEW, Objective, assign
from robot_bridge.core.errors import JobError
from tests.robot_bridge.core.assignment.jobs import scattered

WANTED = Objective("balanced", PREVIEW, 1.0)


@pytest.fixture(scope="module")
def plan() -> ConePlan:
    job = scattered(20, robots=3, capacity=4)
    return assign(job, StraightTravel(job), WANTED)


def halfway(plan: ConePlan) -> float:
    return plan.end_s / 2


def test_expected_is_what_the_plan_says(plan: ConePlan) -> None:
    now = halfway(plan)
    situation = expected_situation(plan, now)
    assert 0 < len(situation.done) < 20
    for one in plan.robots:
        robot = situation.robots[one.robot.id]
        passed = [stop for stop in one.stops if stop.end_s <= now]
        following = one.stops[len(passed)]
        before = (passed[-1].x, passed[-1].y) if passed else (one.robot.x, one.robot.y)
        on_the_way = math.dist(before, (robot.x, robot.y)) + math.dist((robot.x, robot.y), following.path[-1])
        assert on_the_way == pytest.approx(math.dist(before, following.path[-1]), abs=0.01)
        driven = now - (passed[-1].end_s if passed else 0.0)
        assert math.dist(before, (robot.x, robot.y)) == pytest.approx(min(driven, following.metres), abs=0.01)
        loading = following.kind == STORE and following.arrival_s <= now
        last = following if loading else passed[-1]
        assert (robot.aboard, robot.ready_s) == (last.aboard, max(now, last.end_s))


def test_a_lost_robots_cones_are_taken_over(plan: ConePlan) -> None:
    now = halfway(plan)
    situation = replace(expected_situation(plan, now), lost=frozenset({"R2"}))
    new = replan(plan, StraightTravel, situation, WANTED)
    assert check_plan(new) == []
    assert new.robot("R2").lost
    assert new.robot("R2").trips == ()
    assert new.done == situation.done
    todo = {stop.id for _, stop in new.all_stops() if stop.is_target}
    assert todo == {target.id for target in plan.targets} - situation.done
    assert all(stop.arrival_s >= now for _, stop in new.all_stops())
    assert new.end_s > plan.end_s
    kept = [
        stop
        for stop in plan.robot("R1").stops
        if stop.end_s <= now or (stop.kind == STORE and stop.arrival_s <= now)
    ]
    assert list(new.robot("R1").done) == kept


def test_nothing_changes_much_when_nothing_happened(plan: ConePlan) -> None:
    new = replan(plan, StraightTravel, expected_situation(plan, halfway(plan)), WANTED)
    assert check_plan(new) == []
    assert new.end_s < 1.1 * plan.end_s


def test_failed_cones_are_left_out_with_their_reason(plan: ConePlan) -> None:
    now = halfway(plan)
    situation = expected_situation(plan, now)
    failed = next(stop.id for _, stop in plan.all_stops() if stop.is_target and stop.id not in situation.done)
    new = replan(plan, StraightTravel, replace(situation, failed={failed: "gripper empty"}), WANTED)
    assert check_plan(new) == []
    assert [(one.target.id, one.reason) for one in new.left_out] == [(failed, "gripper empty")]


def test_where_robots_really_are_counts(plan: ConePlan) -> None:
    situation = expected_situation(plan, halfway(plan))
    there = replace(situation.robots["R1"], x=7.0, y=8.0, aboard=0, collected=0, range_m=900.0)
    new = replan(plan, StraightTravel, replace(situation, robots={"R1": there}), WANTED)
    assert check_plan(new) == []
    assert new.robot("R1").stops[0].path[0] == (7.0, 8.0)
    assert new.robot("R1").robot.range_m == 900.0


def test_robots_begin_no_earlier_than_now(plan: ConePlan) -> None:
    now = halfway(plan)
    situation = expected_situation(plan, now)
    early = {name: replace(robot, ready_s=0.0) for name, robot in situation.robots.items()}
    new = replan(plan, StraightTravel, replace(situation, robots=early), WANTED)
    assert all(stop.arrival_s >= now for _, stop in new.all_stops())


def test_the_battery_is_what_is_left(plan: ConePlan) -> None:
    robots = tuple(replace(one, robot=replace(one.robot, range_m=900.0)) for one in plan.robots)
    now = halfway(plan)
    left = expected_situation(replace(plan, robots=robots), now).robots["R1"].range_m
    driven = sum(stop.metres for stop in plan.robot("R1").stops if stop.arrival_s <= now)
    assert 900.0 - driven >= left > 900.0 - driven - 100.0
    full = expected_situation(replace(plan, robots=robots), 0.0).robots["R1"].range_m
    assert full == 900.0


def test_a_plan_can_be_made_anew_twice_and_read_from_its_file(plan: ConePlan) -> None:
    first = replan(
        plan, StraightTravel, replace(expected_situation(plan, 100.0), lost=frozenset({"R3"})), WANTED
    )
    first = plan_from_json(plan_to_json(first))
    situation = expected_situation(first, 250.0)
    assert situation.done > first.done
    second = replan(first, StraightTravel, situation, WANTED)
    assert check_plan(second) == []
    assert second.done == situation.done
    assert second.robot("R3").lost


def test_without_robots_there_is_no_plan(plan: ConePlan) -> None:
    everyone = frozenset({"R1", "R2", "R3"})
    with pytest.raises(JobError, match="no robot"):
        replan(plan, StraightTravel, PlanSituation(10.0, lost=everyone), WANTED)
