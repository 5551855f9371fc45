"""What one robot has left is given to others: each task is done once, by one of them."""

from __future__ import annotations

import pytest

from robot_bridge.core.errors import RefusedError
from robot_bridge.core.messages.queues import Share, SharedTask, TakeOver
from tests.support.bridge.queue_line import PLACES, task


def share(robot, revision, *ids, **paths):
    return Share(robot, revision, [SharedTask(f"task-{id:0>4}", paths.get(id)) for id in ids])


async def test_what_a_lost_robot_has_left_is_done_by_another_once(line):
    await line.set(task("a"), task("b"), task("c"))
    await line.set(task("d"), robot="r2")
    await line.yard.acknowledge_all()
    line.yard.now += 20
    await line.yard.at(20.0, 40.0, robot="r2")
    line.yard.fleet.age()
    await line.advance()
    revisions = [(await line.report(robot)).revision for robot in ("r1", "r2")]
    request = TakeOver("r1", revisions[0], [share("r2", revisions[1], "b", "a", "c")], "battery")
    reports = (await line.queues.take_over(request, "Ada")).queues
    await line.advance()
    assert [[one.task[-1] for one in report.tasks] for report in reports] == [[], ["d", "b", "a", "c"]]
    assert (await line.report()).reason == "its tasks were taken over: battery"
    # When it is back it is told to stop, and what it does then is not its task any more.
    assert await line.reach(30.0, 40.0) == ["Abort"]
    await line.yard.restart()
    for id in "dbac":
        await line.reach(*PLACES[id], robot="r2")
    assert await line.states("r2") == dict.fromkeys("abcd", "done")
    assert await line.sent("r2") == [PLACES[id] for id in "dbac"]
    assert await line.sent() == [PLACES["a"], "Abort"]


async def test_what_a_robot_is_doing_may_stay_with_it(line):
    await line.set(task("a"), task("b"))
    await line.yard.acknowledge_all()
    await line.queues.take_over(TakeOver("r1", 1, [share("r2", 0, "b")]), "Ada")
    await line.advance()
    assert await line.states() == {"a": "current"}
    assert await line.sent("r2") == [PLACES["b"]]
    await line.reach(*PLACES["a"])
    assert await line.states() == {"a": "done"}


@pytest.mark.parametrize(
    ("ids", "said"),
    [
        (["b"], "1 task in no share, to be lost"),
        (["b", "c", "b"], "to be done twice"),
        (["b", "c", "d"], "1 task not waiting in any of these queues"),
    ],
)
async def test_a_split_that_loses_or_doubles_a_task_changes_nothing(line, ids, said):
    await line.set(task("a"), task("b"), task("c"))
    with pytest.raises(RefusedError, match=said):
        await line.queues.take_over(TakeOver("r1", 1, [share("r2", 0, *ids)]), "Ada")
    assert await line.states() == {"a": "current", "b": "waiting", "c": "waiting"}
    assert (await line.report("r2")).tasks == []


async def test_a_path_begins_where_its_robot_is_and_is_given_anew(line):
    await line.set(task("a"), task("b", "place", path=[(50.0, 40.0), (60.0, 40.0)]))
    new = [(20.0, 40.0), (60.0, 40.0)]
    await line.queues.take_over(TakeOver("r1", 1, [share("r2", 0, "b", b=new)]), "Ada")
    await line.advance()
    assert [one.path for one in (await line.report("r2", paths=True)).tasks] == [new]
    assert await line.sent("r2") == ["SetPath"]
