"""Operators change queues: nobody overwrites anybody, and nothing is done twice for that."""

from __future__ import annotations

import pytest

from robot_bridge.core.errors import OutdatedError, RefusedError
from robot_bridge.core.messages.queues import AddTasks, MakeCurrent, MoveTask, QueueTask, RemoveTask
from robot_bridge.gateway.storage.repositories import queues
from tests.support.bridge.queue_line import LANE, PLACES, task


async def test_two_operators_do_not_overwrite_each_other(line):
    seen = await line.set(task("a"), task("b"))
    await line.queues.move(MoveTask("r1", seen.revision, "task-000b"), "Ada")
    with pytest.raises(OutdatedError, match="is at revision 2, not 1") as refusal:
        await line.queues.remove(RemoveTask("r1", seen.revision, "task-000b"), "Eve")
    assert refusal.value.newer["revision"] == 2
    assert [one["task"] for one in refusal.value.newer["tasks"]] == ["task-000a", "task-000b"]


async def test_progress_is_no_reason_to_refuse_an_edit(line):
    seen = await line.set(task("a"), task("b"), task("c"))
    await line.reach(*PLACES["a"])
    await line.queues.remove(RemoveTask("r1", seen.revision, "task-000c"), "Ada")
    assert await line.states() == {"a": "done", "b": "current", "c": "removed"}


async def test_tasks_are_added_moved_and_removed(line):
    await line.set(task("a"), task("b"))
    report = await line.report()
    report = await line.queues.add(AddTasks("r1", report.revision, [task("c")], "task-000b"), "Ada")
    assert [one.task[-1] for one in report.tasks] == ["a", "c", "b"]
    report = await line.queues.move(MoveTask("r1", report.revision, "task-000b", "task-000c"), "Ada")
    report = await line.queues.add(AddTasks("r1", report.revision, [task("d")]), "Ada")
    assert [one.task[-1] for one in report.tasks] == ["a", "b", "c", "d"]
    await line.yard.restart()
    assert [one.task[-1] for one in (await line.report()).tasks] == ["a", "b", "c", "d"]
    for refused in (
        lambda r: line.queues.move(MoveTask("r1", r, "task-000a"), "Ada"),
        lambda r: line.queues.remove(RemoveTask("r1", r, "task-000a"), "Ada"),
        lambda r: line.queues.remove(RemoveTask("r1", r, "task-zzzz"), "Ada"),
        lambda r: line.queues.add(AddTasks("r1", r, [task("c")]), "Ada"),
        lambda r: line.queues.add(AddTasks("r1", r, [QueueTask("task-0far", 1e6, 0.0)]), "Ada"),
    ):
        with pytest.raises(RefusedError):
            await refused(report.revision)
    assert (await line.report()).revision == report.revision


async def test_a_list_that_names_what_is_done_does_not_have_it_done_again(line):
    await line.set(task("a"), task("b"))
    await line.reach(*PLACES["a"])
    await line.set(task("a"), task("b"), task("c"))
    assert await line.states() == {"a": "done", "b": "current", "c": "waiting"}
    await line.set(task("d"))
    assert await line.states() == {"a": "done", "b": "current", "c": "removed", "d": "waiting"}
    with pytest.raises(RefusedError, match="needs an id of its own"):
        await line.set(task("c"))
    with pytest.raises(RefusedError, match="was given to robot 'r1' before"):
        await line.set(task("a"), robot="r2")


async def test_another_task_is_made_current_and_the_present_one_comes_next(line):
    await line.set(task("a"), task("b"), task("c"))
    await line.yard.acknowledge_all()
    report = await line.report()
    await line.queues.make_current(MakeCurrent("r1", report.revision, "task-000c"), "Ada")
    await line.advance()
    assert [one.task[-1] for one in (await line.report()).tasks] == ["c", "a", "b"]
    assert (await line.report()).state.value == "running"
    for id in "cab":
        await line.reach(*PLACES[id])
    assert await line.sent() == [PLACES[id] for id in "acab"]
    assert await line.states() == {"a": "done", "b": "done", "c": "done"}


async def test_an_edit_made_while_somebody_orders_the_robot_about_does_not_undo_the_pause(line, monkeypatch):
    await line.set(task("a"), task("b"))
    await line.yard.acknowledge_all()
    run = line.yard.database.run

    async def ordered_first(asked, *arguments):
        if asked is queues.save:
            monkeypatch.setattr(line.yard.database, "run", run)
            await line.yard.send("x", x=25.0, y=40.0)
        return await run(asked, *arguments)

    monkeypatch.setattr(line.yard.database, "run", ordered_first)
    with pytest.raises(OutdatedError) as refused:
        await line.queues.add(AddTasks("r1", 1, [task("c")]), "Eve")
    added = refused.value
    await line.advance()
    assert added.newer["state"] == "paused"
    report = await line.report()
    assert (report.revision, report.reason) == (2, "Ada ordered SetPosEnd beside the queue")
    assert await line.states() == {"a": "waiting", "b": "waiting"}


async def test_a_task_that_failed_may_be_given_another_path(line):
    await line.yard.at(20.0, 60.0)
    await line.set(task("a", "place", path=LANE))
    assert (await line.report()).state.value == "paused"
    await line.set(task("a", "place", path=[(20.0, 60.0), (50.0, 40.0)]))
    await line.resume()
    assert await line.sent() == ["SetPath"]
    assert (await line.report()).tasks[0].reason is None
