"""How far a plan is, from what the gateway tells: done, failed, lost, and what is left then."""

from __future__ import annotations

import itertools
from dataclasses import replace

import pytest
from fleet_supervisor.plugin.planning.plan_texts import ReportedProgress, problem_in_words, stop_rows
from fleet_supervisor.robot_bridge.core.assignment.job import (
    AssignmentJob,
    ConeTarget,
    PlanRobot,
    Store,
    StraightTravel,
)
from fleet_supervisor.robot_bridge.core.assignment.plan_changes import plan_with_trips, replan
from fleet_supervisor.robot_bridge.core.assignment.progress import (
    ConeFacts,
    PlanProblem,
    PlanProgress,
    current_stops,
    problem_of,
    sent_stops,
    situation_of,
    standing_cones,
    tasks_of,
)
from fleet_supervisor.robot_bridge.core.assignment.solver import Objective, assign
from fleet_supervisor.robot_bridge.core.messages.plans import (
    PlanProblemKind,
    PlanProblemReport,
    PlanReport,
    PlanState,
    PlanStopReport,
)
from fleet_supervisor.robot_bridge.core.messages.queues import (
    QueueReport,
    QueueState,
    TaskKind,
    TaskReport,
    TaskState,
)
from fleet_supervisor.robot_bridge.core.messages.records import PlacementReport
from fleet_supervisor.robot_bridge.core.messages.safety import RobotState

BEGAN = 1_700_000_000.0


class Driven:
    """Two robots with three cones each, sent; the test says what becomes of their tasks."""

    def __init__(self, stores=(), aboard=4):
        cones = [ConeTarget(f"c{n}", 10.0 * n, 0.0, service_s=2.0) for n in range(1, 4)]
        cones += [ConeTarget(f"d{n}", 100.0 + 10.0 * n, 50.0, service_s=2.0) for n in range(1, 4)]
        robots = (PlanRobot("r1", 0, 0, 4, aboard=aboard), PlanRobot("r2", 100, 50, 4, aboard=aboard))
        job = AssignmentJob(tuple(cones), robots, stores, "stay")
        first = assign(job, StraightTravel(job), Objective("distance", "preview"))
        names = [["c1", "c2", "c3"], ["d1", "d2", "d3"]]
        trips = [[row] if aboard else [[], row] for row in names]
        self.plan = plan_with_trips(first, StraightTravel, trips)
        self.facts = {cone.id: ConeFacts(cone.id, "row") for cone in cones}
        numbers = itertools.count(1)
        self.tasks = tasks_of(self.plan, "plan-1", self.facts, lambda: f"task-{next(numbers):04d}")
        self.progress = PlanProgress("plan-1", self.facts, BEGAN)
        for one in self.plan.robots:
            self.progress.sent(sent_stops(one, self.tasks[one.robot.id]))

    def task(self, robot, number, state, **more):
        one = self.tasks[robot][number]
        known = {"cone": one.cone, "plan": one.plan, "label": one.label, **more}
        return TaskReport(one.task, robot, one.kind, state, one.x, one.y, "anna", BEGAN, **known)

    def tell(self, robot, states, robot_state=RobotState.FRESH, ended_known=10):
        """Tell of a queue whose first tasks are in ``states``, the others waiting."""
        states = [*states, *[TaskState.WAITING] * (len(self.tasks[robot]) - len(states))]
        all_of_them = [self.task(robot, number, state) for number, state in enumerate(states)]
        open_ones = [
            t for t in all_of_them if t.state in (TaskState.WAITING, TaskState.CURRENT, TaskState.FAILED)
        ]
        ended = [t for t in reversed(all_of_them) if t not in open_ones][:ended_known]
        report = QueueReport(robot, 1, QueueState.RUNNING, robot_state, open_ones, ended)
        self.progress.apply_queue(report)
        return report

    def placed(self, robot, number, cone):
        report = PlacementReport(
            number, "t", robot, 1.0, 0.0, 1.1, 0.0, 0.0, 0.1, BEGAN + number, "c", cone=cone, plan="plan-1"
        )
        self.progress.apply_placement(report)


@pytest.fixture
def driven():
    return Driven()


DONE, CURRENT, WAITING, FAILED = TaskState.DONE, TaskState.CURRENT, TaskState.WAITING, TaskState.FAILED


def test_tasks_hold_paths_kinds_and_names_in_the_order_of_the_plan(driven):
    tasks = driven.tasks["r1"]
    assert [task.cone for task in tasks] == ["c1", "c2", "c3"]
    assert all(task.kind is TaskKind.PLACE and task.plan == "plan-1" for task in tasks)
    assert all(task.layout == "row" and task.path[-1] == (task.x, task.y) for task in tasks)
    assert tasks[1].path[0] == pytest.approx((10, 0)) and tasks[1].x == 20


def test_a_visit_to_a_store_is_a_task_that_only_drives():
    driven = Driven((Store("depot", 0.0, 5.0),), aboard=0)
    first = driven.tasks["r1"][0]
    assert first.kind is TaskKind.DRIVE and first.label == "store depot" and first.cone is None


def test_what_ended_and_what_was_placed_is_done_also_when_nobody_listened(driven):
    driven.tell("r1", [DONE, CURRENT])
    assert driven.progress.done == {"c1"} and driven.progress.state_of("c2") is CURRENT
    driven.placed("r1", 2, "c2")
    driven.placed("r1", 3, "c3")
    assert driven.progress.done == {"c1", "c2", "c3"} and driven.progress.placed["c3"].deviation == 0.1
    assert not driven.progress.is_finished(driven.plan)
    driven.tell("r2", [DONE, DONE, DONE])
    assert driven.progress.is_finished(driven.plan)


def test_a_cone_of_another_plan_is_none_of_this_one(driven):
    report = PlacementReport(9, "t", "r1", 1, 0, 1, 0, 0.0, 0.0, BEGAN, "c", cone="c1", plan="another")
    driven.progress.apply_placement(report)
    assert driven.progress.done == set()


def test_what_is_collected_is_done_when_it_was_collected_not_when_it_was_placed():
    facts = {"c1 #5": ConeFacts("c1", "row", placement=5)}
    progress = PlanProgress("plan-2", facts, BEGAN)
    values = (5, "t", "r1", 1.0, 0.0, 1.0, 0.0, 0.0, 0.0, BEGAN, "c")
    progress.apply_placement(PlacementReport(*values, cone="c1", plan="plan-1"))
    assert progress.done == set()
    progress.apply_placement(PlacementReport(*values, cone="c1", plan="plan-1", collected_at=BEGAN + 9))
    assert progress.done == {"c1 #5"}


def test_a_lost_robot_with_cones_to_come_is_trouble_and_one_that_has_finished_is_not(driven):
    queues = {
        "r1": driven.tell("r1", [DONE, CURRENT], RobotState.LOST),
        "r2": driven.tell("r2", [DONE, DONE, DONE], RobotState.OFFLINE),
    }
    trouble = problem_of(driven.plan, driven.progress, queues)
    assert trouble == PlanProblem(("r1",))


def test_what_a_lost_robot_was_doing_and_what_waited_is_shared_out_and_the_rest_stays(driven):
    driven.tell("r1", [DONE, CURRENT], RobotState.LOST)
    driven.tell("r2", [DONE, CURRENT])
    places = {"r1": (15.0, 0.0), "r2": (115.0, 50.0)}
    now = situation_of(
        driven.plan, driven.progress, places, PlanProblem(("r1",)), BEGAN + 30, try_again=False
    )
    assert now.done == {"c1", "d1", "d2"} and now.lost == {"r1"}
    r2 = now.robots["r2"]
    # It finishes the cone that it is on: it is there then, with one of its four cones less for each.
    assert (r2.x, r2.y, r2.aboard) == (120.0, 50.0, 2)
    with_store = Driven((Store("depot", 100.0, 60.0),))
    with_store.tell("r1", [DONE, CURRENT], RobotState.LOST)
    with_store.tell("r2", [DONE, CURRENT])
    now = situation_of(
        with_store.plan, with_store.progress, places, PlanProblem(("r1",)), BEGAN + 30, try_again=False
    )
    new = replan(with_store.plan, StraightTravel, now, Objective("distance", "preview"))
    cones = {one.robot.id: [s.id for s in one.stops if s.is_target] for one in new.robots}
    assert cones["r1"] == [] and sorted(cones["r2"]) == ["c2", "c3", "d3"] and new.robot("r1").lost


@pytest.mark.parametrize("now_s", [3, 300], ids=["ahead of the plan", "behind it"])
def test_a_robot_is_free_when_it_has_driven_what_is_left_of_its_way_not_when_the_plan_said(driven, now_s):
    driven.tell("r2", [DONE, CURRENT])
    stop = driven.plan.robot("r2").stops[1]
    speed, works = driven.plan.robot("r2").robot.speed, stop.end_s - stop.begin_s
    assert works > 0 and stop.path[:: len(stop.path) - 1] == ((110.0, 50.0), (120.0, 50.0))

    def free_at(place):
        now = situation_of(driven.plan, driven.progress, place, PlanProblem(), BEGAN + now_s, try_again=False)
        return now.robots["r2"].ready_s - now_s

    assert free_at({"r2": (114.0, 50.0)}) == pytest.approx(6 / speed + works)
    assert free_at({"r2": (114.0, 53.0)}) == pytest.approx(9 / speed + works)
    assert free_at({"r2": (120.0, 50.0)}) == pytest.approx(works)
    assert free_at({}) == pytest.approx(max(stop.end_s - now_s, 0)), "where it is nobody knows"


def test_a_cone_that_is_being_placed_is_in_the_way_of_what_is_left(driven):
    driven.tell("r1", [DONE, CURRENT])
    driven.tell("r2", [CURRENT])
    driven.placed("r1", 1, "c1")
    assert sorted(standing_cones(driven.progress)) == [(1.1, 0.0), (20.0, 0.0), (110.0, 50.0)]
    driven.progress.placed["c1"] = replace(driven.progress.placed["c1"], collected_at=BEGAN + 9)
    assert sorted(standing_cones(driven.progress)) == [(20.0, 0.0), (110.0, 50.0)]


def test_a_failed_cone_is_given_up_or_tried_again_as_the_operator_wants(driven):
    queues = {"r1": driven.tell("r1", [DONE]), "r2": driven.tell("r2", [])}
    task = driven.task("r1", 1, FAILED, reason="a wall")
    queues["r1"] = QueueReport("r1", 2, QueueState.PAUSED, RobotState.FRESH, [task])
    driven.progress.apply_queue(queues["r1"])
    trouble = problem_of(driven.plan, driven.progress, queues)
    assert trouble.failed == (("c2", "a wall"),)
    for again, expected in ((False, {"c2": "a wall"}), (True, {})):
        now = situation_of(driven.plan, driven.progress, {}, trouble, BEGAN + 9, try_again=again)
        assert now.failed == expected and "c2" not in now.done


def test_a_task_that_ended_while_the_desk_was_away_is_not_open_any_more(driven):
    driven.tell("r1", [CURRENT])
    driven.tell("r1", [DONE, DONE, CURRENT], ended_known=0)
    assert driven.progress.state_of("c1") is DONE and driven.progress.state_of("c3") is CURRENT


# --- stages ------------------------------------------------------------------------------------------------


class Staged(Driven):
    """The same robots; cones c3 and d3 come after all others."""

    def __init__(self):
        super().__init__()
        late = {"c3", "d3"}
        targets = tuple(replace(one, stage=int(one.id in late)) for one in self.plan.targets)
        self.plan = replace(self.plan, targets=targets)
        numbers = itertools.count(1)
        self.tasks = tasks_of(self.plan, "plan-1", self.facts, lambda: f"late-{next(numbers):04d}")


def test_a_cone_comes_after_those_of_lower_stages_that_other_robots_see_to():
    tasks = Staged().tasks
    ids = {task.cone: task.task for theirs in tasks.values() for task in theirs}
    after = {task.cone: task.after for theirs in tasks.values() for task in theirs}
    assert after["c3"] == [ids["d1"], ids["d2"]]
    assert after["d3"] == [ids["c1"], ids["c2"]]
    assert {after[cone] for cone in ("c1", "c2", "d1", "d2")} == {None}


def test_a_new_plan_waits_for_what_a_robot_is_at_already():
    staged = Staged()
    for one in staged.plan.robots:
        staged.progress.sent(sent_stops(one, staged.tasks[one.robot.id]))
    report = staged.tell("r2", [CURRENT])
    now = current_stops(staged.progress)
    assert now["r2"].task == report.tasks[0].task
    robots = [
        replace(one, trips=tuple(replace(trip, stops=trip.stops[1:]) for trip in one.trips))
        if one.robot.id == "r2"
        else one
        for one in staged.plan.robots
    ]
    rest = replace(staged.plan, robots=tuple(robots))
    tasks = tasks_of(rest, "plan-1", staged.facts, under_way=now)
    (last,) = [task for task in tasks["r1"] if task.cone == "c3"]
    (second,) = [task for task in tasks["r2"] if task.cone == "d2"]
    assert last.after == [second.task, report.tasks[0].task]


def reported(plan, states, placements=()):
    """What a desk knows of a plan of which the gateway reported stops in ``states``, by their ids."""
    stops = [
        PlanStopReport(f"task-{stop.id}", one.robot.id, stop.kind, stop.id, stop.x, stop.y, *states[stop.id])
        for one, stop in plan.all_stops()
        if stop.id in states
    ]
    report = PlanReport("p", 1, PlanState.DRIVEN, "anna", BEGAN, False, 6, 0, ["r1", "r2"], stops)
    return ReportedProgress(report, placements)


def test_the_table_says_what_a_cone_waits_for_and_how_far_off_one_stands():
    plan = Staged().plan
    off = PlacementReport(1, "task-c1", "r1", 1, 0, 1, 0, 0.0, 0.07, BEGAN, "c", cone="c1", plan="p")
    states = {
        "c1": (DONE,), "c2": (CURRENT, "not shown"), "c3": (WAITING, "waits for cone d1 of r2"),
        "d1": (DONE, None, 5), "d2": (FAILED, "a wall"),
    }  # fmt: skip
    collected = PlacementReport(5, "another", "r9", 1, 0, 1, 0, 0.0, 0.09, BEGAN, "c", plan="before")
    rows = stop_rows(plan, reported(plan, states, [off, collected]))
    shown = {row.stop.id: (row.in_words(), row.deviation) for one in rows.values() for row in one}
    assert shown["c1"] == ("done", 0.07) and shown["c2"] == ("under way", None)
    assert shown["c3"] == ("in the queue: waits for cone d1 of r2", None)
    assert shown["d1"] == ("done", 0.09), "of a cone that was collected, what is written of its placing"
    assert shown["d2"] == ("FAILED: a wall", None) and shown["d3"] == ("", None)


def test_of_a_cone_that_was_sent_again_the_newest_task_counts(driven):
    driven.tell("r1", [FAILED])
    assert driven.progress.state_of("c1") is FAILED
    (one,) = [one for one in driven.plan.robots if one.robot.id == "r1"]
    first = driven.tasks["r1"]
    driven.tasks["r1"] = [replace(task, task=f"{task.task}-again") for task in first]
    driven.progress.sent(sent_stops(one, driven.tasks["r1"]))
    assert driven.progress.state_of("c1") is FAILED, "nothing is known of the new task yet"
    driven.tell("r1", [CURRENT])
    assert driven.progress.state_of("c1") is CURRENT
    for tasks in (driven.tasks["r1"], first):
        driven.progress.forget([task.task for task in tasks])
        assert driven.progress.state_of("c1") is not CURRENT, "what was forgotten counts no more"
    assert driven.progress.state_of("c1") is None


def test_trouble_with_many_ways_cones_and_robots_names_the_first_and_counts_the_others():
    away, failed, closed = PlanProblemKind.AWAY, PlanProblemKind.FAILED, PlanProblemKind.CLOSED
    problems = [PlanProblemReport(away, f"r{k}") for k in range(10)]
    problems += [PlanProblemReport(failed, None, f"c{k}", "stuck") for k in range(4)]
    problems += [PlanProblemReport(closed, "r1", f"c{k}") for k in range(58)]
    assert problem_in_words(problems).split("; ") == [
        "r0 is lost or offline",
        "r1 is lost or offline",
        "r2 is lost or offline",
        "and 7 more",
        "cone c0 failed: stuck",
        "cone c1 failed: stuck",
        "cone c2 failed: stuck",
        "and 1 more",
        "the way of r1 to c0 leads along a closed road",
        "the way of r1 to c1 leads along a closed road",
        "the way of r1 to c2 leads along a closed road",
        "and 55 more",
    ]
