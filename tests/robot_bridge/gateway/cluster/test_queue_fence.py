"""Queues whose robots other gateways have: changed as they were read, or not at all, without waiting."""

from __future__ import annotations

import dataclasses

import pytest
from sqlalchemy import text

from robot_bridge.core.messages.plans import PlanState
from robot_bridge.core.messages.queues import QueueTask, TaskState
from robot_bridge.gateway.model.task_queue import Queue, QueuedTask
from robot_bridge.gateway.plans.following import PlanMovedError, add_plan, save_plan
from robot_bridge.gateway.storage.database import open_engine, read_address
from robot_bridge.gateway.storage.repositories import queues
from robot_bridge.gateway.storage.repositories.queues import ChangedError

LONG = [(20.0, 8.0), (22.5, 8.125), (24.1, 8.2)]
FIRST = QueuedTask(QueueTask("task-0001", 24.1, 8.2, path=LONG, cone="c1"), "Ada", 1790000000.25)
FULL = Queue("r1").with_tasks([FIRST], edited=True)


@pytest.fixture(scope="module")
def engine(fleet_url):
    engine, _ = open_engine(read_address(fleet_url))
    yield engine
    engine.dispose()


@pytest.fixture
def two(engine):
    """Connections of two gateways; the queue of r1 holds a task."""
    with engine.connect() as here, engine.connect() as there:
        with here.begin():
            for table in ("queue_tasks", "queues", "plan_stops", "plans"):
                here.execute(text(f"delete from {table}"))
            queues.save(here, Queue("r1"), FULL)
        yield here, there


def begun(task):
    return dataclasses.replace(task, state=TaskState.CURRENT, attempts=1, command="c-1")


def test_a_task_that_was_begun_meanwhile_is_seen_though_the_revision_is_the_same(two):
    here, there = two
    with there.begin():
        (read,) = queues.load(there, ["r1"]).values()
        queues.check_unchanged(there, [read, Queue("nobody")])
    moved = read.with_head(begun(read.tasks[0]))
    with here.begin():
        queues.save(here, read, moved)
    assert moved.revision == read.revision
    with pytest.raises(ChangedError, match="'r1' was changed meanwhile"), there.begin():
        queues.check_unchanged(there, [read])


def test_a_queue_that_is_being_changed_is_not_waited_for(two):
    here, there = two
    with here.begin():
        queues.save(here, FULL, FULL.with_head(begun(FIRST)))
        with pytest.raises(ChangedError), there.begin():
            queues.check_unchanged(there, [FULL])


def test_two_gateways_begin_one_queue(two):
    here, there = two
    with here.begin():
        queues.save(here, Queue("r2"), Queue("r2").with_tasks([], edited=True))
    with pytest.raises(ChangedError), there.begin():
        queues.save(there, Queue("r2"), dataclasses.replace(FULL, robot="r2"))


def test_a_gateway_that_stands_still_over_the_queue_of_another_one_is_cut_off(two):
    """Longer than that nothing waits for it, an Abort of that robot least of all."""
    here, there = two
    there.begin()
    queues.check_unchanged(there, [FULL])
    with here.begin():
        here.execute(text("set local lock_timeout = '60s'"))
        queues.save(here, FULL, FULL.paused("an Abort", "Ada", 1790000001.0))
    with pytest.raises(Exception, match="idle-in-transaction"):
        there.execute(text("select 1"))


def test_a_plan_is_written_over_the_revision_that_it_was_read_at(two, driven_plan):
    here, there = two
    plan = driven_plan
    with here.begin():
        add_plan(here, plan, [], [])
    paused = plan.changed(PlanState.PAUSED, "Ada", 2.0, None)
    with here.begin():
        save_plan(here, paused)
    with pytest.raises(PlanMovedError, match="was changed meanwhile"), there.begin():
        save_plan(there, plan.changed(PlanState.CLEARED, "Ben", 3.0, None))
    with pytest.raises(PlanMovedError), there.begin():
        save_plan(there, plan)
    # A second one is entered only by who knows of the first.
    other = dataclasses.replace(plan, name="plan-2")
    with pytest.raises(PlanMovedError, match="another plan was submitted"), there.begin():
        add_plan(there, other, [], [])
    with there.begin():
        add_plan(there, other, [], [plan.name])


@pytest.fixture
def driven_plan():
    from robot_bridge.core.assignment.job import STAY, AssignmentJob, ConeTarget, PlanRobot, StraightTravel
    from robot_bridge.core.assignment.solver import Objective, assign
    from robot_bridge.gateway.plans.model import DrivenPlan, PlanTerms

    job = AssignmentJob((ConeTarget("c1", 24.0, 8.0),), (PlanRobot("r1", 20.0, 8.0, 1, aboard=1),), (), STAY)
    document = assign(job, StraightTravel(job), Objective(time_limit_s=0.1))
    return DrivenPlan("plan-1", document, PlanTerms({}), "Ada", 1.0)
