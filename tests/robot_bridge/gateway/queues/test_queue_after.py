"""Tasks that wait for others: by another robot, or later in the same queue."""

from __future__ import annotations

import pytest

from robot_bridge.core.messages.base import MessageError
from robot_bridge.core.messages.queues import MoveTask, RemoveTask
from tests.support.bridge.queue_line import PLACES, task


async def test_a_task_waits_until_what_it_comes_after_is_done_by_another_robot(line):
    await line.set(task("a", "place", cone="A", after=["task-000b", "task-000c"]))
    assert line.pushed[-1]["tasks"][0]["reason"] == (
        "waits for task task-000b, which no robot has been given, "
        "task task-000c, which no robot has been given"
    )
    assert await line.sent() == []
    await line.set(task("b", "place", cone="B"), task("c", "place", cone="C"), robot="r2")
    line.yard.fleet.driving.schedule_all()
    await line.advance()
    assert (await line.report()).tasks[0].reason == "waits for cone B of r2, cone C of r2"
    await line.reach(*PLACES["b"], robot="r2")
    await line.yard.restart()
    line.yard.fleet.driving.schedule_all()
    await line.advance()
    report = await line.report()
    assert (report.state.value, report.tasks[0].reason) == ("running", "waits for cone C of r2")
    assert await line.sent() == []
    await line.reach(*PLACES["c"], robot="r2")
    line.yard.fleet.driving.schedule_all()
    await line.advance()
    assert await line.sent() == [PLACES["a"]]
    report = await line.report()
    assert (report.tasks[0].state.value, report.tasks[0].reason) == ("current", None)


async def test_what_was_not_put_down_is_waited_for_and_said(line):
    await line.set(task("b", cone="B"), robot="r2")
    await line.set(task("a", after=["task-000b"]))
    (row,) = await line.yard.deliver("r2")
    await line.yard.ack(row.id, "r2", ok=False, reason="too steep")
    line.yard.fleet.driving.schedule_all()
    await line.advance()
    line.yard.fleet.driving.schedule_all()
    await line.advance()
    assert (await line.report()).tasks[0].reason == "waits for cone B of r2, which failed"
    await line.queues.remove(RemoveTask("r2", (await line.report("r2")).revision, "task-000b"), "Ada")
    line.yard.fleet.driving.schedule_all()
    await line.advance()
    assert (await line.report()).tasks[0].reason == (
        "waits for task task-000b, which was removed at r2: give this task anew without it"
    )
    assert await line.sent() == []


async def test_a_task_that_waits_for_a_later_one_of_its_own_queue_says_what_to_do(line):
    await line.set(task("a", after=["task-000b"]), task("b", cone="B"))
    report = await line.report()
    assert report.tasks[0].reason == (
        "waits for cone B, which comes later in this queue: move it to the front"
    )
    await line.queues.move(MoveTask("r1", report.revision, "task-000b", "task-000a"), "Ada")
    await line.advance()
    await line.reach(*PLACES["b"])
    assert await line.sent() == [PLACES["b"], PLACES["a"]]


@pytest.mark.parametrize(
    ("after", "wrong"),
    [
        (["task-000a"], "names the task itself"),
        (["x"], "give an id of 8 to 64"),
        (["task-000b"] * 1001, "1000"),
    ],
)
def test_what_no_task_can_come_after_is_refused(after, wrong):
    with pytest.raises(MessageError, match=wrong):
        task("a", after=after)
