"""Queues on a real database: the next task is sent when the current one is reached, and never by surprise."""

from __future__ import annotations

import asyncio
import math

import pytest

from robot_bridge.commanding.writing import write_drafts
from robot_bridge.errors import OutdatedError, RefusedError, UncertainError
from robot_bridge.messages import (
    AbortTask,
    AddTasks,
    ClearEmergencyStop,
    CollectLayout,
    EmergencyStop,
    GetPlacements,
    GetQueue,
    MakeCurrent,
    MessageError,
    MoveTask,
    PauseQueue,
    QueueTask,
    RemoveTask,
    ResumeQueue,
    SendPos,
    SetPath,
    SetQueue,
    Share,
    SharedTask,
    TakeOver,
    TaskKind,
)
from robot_bridge.queueing.settling import write_outcome
from robot_bridge.store import placements, queues

PLACES = {"a": (50.0, 40.0), "b": (60.0, 40.0), "c": (60.0, 50.0), "d": (70.0, 50.0)}


def task(id, kind="drive", **more):
    x, y = PLACES[id[0]]
    return QueueTask(f"task-{id:0>4}", x, y, kind=TaskKind(kind), **more)


class Line:
    """The queues of a yard, as an operator and a robot meet them."""

    def __init__(self, yard):
        self.yard = yard
        self.pushed = []
        yard.fleet.listen(self)

    def notify(self, method, key, params):
        if method == "queue":
            self.pushed.append(params)

    @property
    def queues(self):
        return self.yard.fleet.queues

    async def go(self):
        """Let the gateway do what is due."""
        self.yard.fleet.driving.look_at_all()
        for _ in range(4):
            await self.yard.fleet.driving.advance()

    async def set(self, *tasks, robot="r1", revision=None):
        revision = (await self.seen(robot)).revision if revision is None else revision
        report = await self.queues.set(SetQueue(robot, revision, list(tasks)), "Ada")
        await self.go()
        return report

    async def seen(self, robot="r1", **how):
        (report,) = await self.queues.read(GetQueue(robot, **how))
        return report

    async def states(self, robot="r1"):
        report = await self.seen(robot)
        return {one.task[-1]: one.state.value for one in [*report.tasks, *report.ended]}

    async def resume(self, robot="r1"):
        await self.queues.resume(ResumeQueue(robot, (await self.seen(robot)).revision), "Ada")
        await self.go()

    async def reach(self, x, y, robot="r1"):
        """Let the robot take on what waits for it, and stand at (x, y)."""
        ops = await self.yard.take(robot)
        await self.yard.at(x, y, robot=robot)
        await self.go()
        return ops

    async def sent(self, robot="r1"):
        """Return where robot's commands were to go, oldest first."""
        found = [c for c in await self.yard._stored() if c.robot == robot]
        return [(c.params["x"], c.params["y"]) if "x" in c.params else c.op for c in found]


@pytest.fixture
async def line(yard):
    """A yard whose robot r1 stands at (20, 40)."""
    for robot in ("r1", "r2"):
        await yard.ready(robot)
        await yard.take(robot)
        await yard.at(20.0, 40.0, robot=robot)
    return Line(yard)


async def test_the_next_task_is_sent_when_the_current_one_is_reached(line):
    await line.set(task("a"), task("b"), task("c"))
    assert await line.sent() == [PLACES["a"]]
    assert await line.reach(*PLACES["a"]) == ["SetPosEnd"]
    assert await line.states() == {"a": "done", "b": "current", "c": "waiting"}
    await line.reach(*PLACES["b"])
    await line.reach(*PLACES["c"])
    assert await line.states() == {"a": "done", "b": "done", "c": "done"}
    assert await line.sent() == [PLACES[id] for id in "abc"]


async def test_a_gateway_that_ends_at_any_point_drives_no_task_twice_and_loses_none(line):
    await line.set(task("a"), task("b"))
    await line.yard.restart()
    await line.go()
    await line.yard.take()
    await line.yard.restart()
    await line.yard.at(*PLACES["a"])  # reached, and the gateway ends before it looks at the queue
    await line.yard.restart()
    await line.go()
    await line.yard.restart()
    await line.go()
    assert await line.states() == {"a": "done", "b": "current"}
    assert await line.sent() == [PLACES["a"], PLACES["b"]]


async def test_a_task_that_a_robot_refuses_pauses_its_queue_with_the_reason(line):
    await line.set(task("a"), task("b"))
    (row,) = await line.yard.deliver()
    await line.yard.ack(row.id, ok=False, reason="too steep")
    await line.go()
    report = await line.seen()
    assert (report.state.value, report.tasks[0].state.value) == ("paused", "failed")
    assert "too steep" in report.reason and "too steep" in report.tasks[0].reason
    await line.resume()
    await line.reach(*PLACES["a"])
    assert await line.states() == {"a": "done", "b": "current"}


async def test_an_abort_pauses_and_a_resumed_task_is_begun_anew(line):
    await line.set(task("a"), task("b"))
    await line.yard.take()
    await line.yard.fleet.orders.abort(AbortTask("abort-0001", robot="r1", reason="dog"), "Ada")
    await line.go()
    # Operators are told before the robot has answered.
    assert [push["state"] for push in line.pushed][-1] == "paused"
    assert await line.reach(30.0, 40.0) == ["Abort"]
    report = await line.seen()
    assert (report.state.value, report.reason, report.by) == ("paused", "aborted by Ada: dog", "Ada")
    assert [one.state.value for one in report.tasks] == ["waiting", "waiting"]
    await line.resume()
    await line.reach(*PLACES["a"])
    assert await line.states() == {"a": "done", "b": "current"}
    assert (await line.seen()).ended[0].attempts == 2


async def test_a_direct_order_pauses_and_is_not_overtaken(line):
    await line.set(task("a"), task("b"))
    await line.yard.take()
    await line.yard.send("x", x=25.0, y=40.0)
    await line.reach(25.0, 40.0)
    assert await line.sent() == [PLACES["a"], (25.0, 40.0)]
    assert (await line.seen()).reason == "Ada ordered SetPosEnd beside the queue"


async def test_a_direct_order_between_two_tasks_holds_through_a_restart(line):
    await line.set(task("a"), task("b"))
    await line.yard.take()
    await line.yard.at(*PLACES["a"])
    await line.yard.send("x", x=25.0, y=40.0)
    await line.yard.restart()
    await line.go()
    assert await line.sent() == [PLACES["a"], (25.0, 40.0)]
    assert await line.states() == {"a": "done", "b": "waiting"}


async def test_an_emergency_stop_pauses_every_queue_until_each_is_resumed_on_purpose(line):
    await line.set(task("a"), task("b"))
    await line.set(task("c"), robot="r2")
    await line.yard.fleet.emergency.stop(EmergencyStop("stop-0001"), "Ada")
    await line.go()
    await line.set(task("d"), robot="r2", revision=(await line.seen("r2")).revision)
    await line.yard.fleet.emergency.clear(ClearEmergencyStop(), "Eve")
    for robot in ("r1", "r2"):
        await line.yard.take(robot)
        await line.yard.at(20.0, 40.0, robot=robot)
    await line.go()
    assert [(await line.seen(r)).state.value for r in ("r1", "r2")] == ["paused", "paused"]
    assert await line.sent("r2") == [PLACES["c"], "Abort"]
    await line.resume("r2")
    assert await line.sent("r2") == [PLACES["c"], "Abort", PLACES["d"]]


async def test_a_queue_made_during_an_emergency_stop_waits_to_be_resumed(line):
    await line.yard.fleet.emergency.stop(EmergencyStop("stop-0001"), "Ada")
    await line.set(task("a"))
    await line.yard.fleet.emergency.clear(ClearEmergencyStop(), "Eve")
    await line.go()
    report = await line.seen()
    assert report.state.value == "paused" and "emergency stop is in force" in report.reason
    assert PLACES["a"] not in await line.sent()


async def test_abort_all_pauses_every_queue(line):
    await line.set(task("a"))
    await line.set(task("b"), robot="r2")
    await line.yard.fleet.orders.abort_all("Ada")
    await line.go()
    assert [(await line.seen(r)).state.value for r in ("r1", "r2")] == ["paused", "paused"]


async def test_a_robot_with_nothing_to_do_may_be_ordered_about_without_pausing_its_queue(line):
    await line.set(task("a"))
    await line.reach(*PLACES["a"])
    await line.yard.send("x", x=25.0, y=40.0)
    await line.reach(25.0, 40.0)
    await line.set(task("b"))
    assert (await line.sent())[-1] == PLACES["b"]


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
    report = await line.seen()
    report = await line.queues.add(AddTasks("r1", report.revision, [task("c")], "task-000b"), "Ada")
    assert [one.task[-1] for one in report.tasks] == ["a", "c", "b"]
    report = await line.queues.move(MoveTask("r1", report.revision, "task-000b", "task-000c"), "Ada")
    report = await line.queues.add(AddTasks("r1", report.revision, [task("d")]), "Ada")
    assert [one.task[-1] for one in report.tasks] == ["a", "b", "c", "d"]
    await line.yard.restart()
    assert [one.task[-1] for one in (await line.seen()).tasks] == ["a", "b", "c", "d"]
    for refused in (
        lambda r: line.queues.move(MoveTask("r1", r, "task-000a"), "Ada"),
        lambda r: line.queues.remove(RemoveTask("r1", r, "task-000a"), "Ada"),
        lambda r: line.queues.remove(RemoveTask("r1", r, "task-zzzz"), "Ada"),
        lambda r: line.queues.add(AddTasks("r1", r, [task("c")]), "Ada"),
        lambda r: line.queues.add(AddTasks("r1", r, [QueueTask("task-0far", 1e6, 0.0)]), "Ada"),
    ):
        with pytest.raises(RefusedError):
            await refused(report.revision)
    assert (await line.seen()).revision == report.revision


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
    await line.yard.take()
    report = await line.seen()
    await line.queues.make_current(MakeCurrent("r1", report.revision, "task-000c"), "Ada")
    await line.go()
    assert [one.task[-1] for one in (await line.seen()).tasks] == ["c", "a", "b"]
    assert (await line.seen()).state.value == "running"
    for id in "cab":
        await line.reach(*PLACES[id])
    assert await line.sent() == [PLACES[id] for id in "acab"]
    assert await line.states() == {"a": "done", "b": "done", "c": "done"}


async def test_a_paused_queue_finishes_what_is_driven_and_sends_no_more(line):
    await line.set(task("a"), task("b"))
    await line.queues.pause(PauseQueue("r1", "lunch"), "Ada")
    await line.reach(*PLACES["a"])
    assert await line.sent() == [PLACES["a"]]
    assert (await line.seen()).reason == "paused by Ada: lunch"
    report = await line.seen()
    await line.queues.make_current(MakeCurrent("r1", report.revision, "task-000b"), "Ada")
    await line.go()
    assert await line.sent() == [PLACES["a"]]


async def test_a_lost_robot_is_sent_nothing_and_goes_on_when_it_is_back_in_time(line):
    await line.set(task("a"), task("b"))
    await line.yard.take()
    await line.yard.at(*PLACES["a"])
    line.yard.now += 20
    line.yard.fleet.age()
    await line.go()
    assert ((await line.seen()).robot_state.value, await line.sent()) == ("lost", [PLACES["a"]])
    await line.yard.at(*PLACES["a"])
    await line.go()
    assert await line.sent() == [PLACES["a"], PLACES["b"]]


async def test_a_robot_that_was_away_for_long_is_not_sent_off_by_surprise(line):
    await line.set(task("a"), task("b"))
    await line.yard.take()
    await line.yard.at(*PLACES["a"])
    line.yard.now += 400
    line.yard.fleet.age()
    await line.go()
    await line.yard.at(*PLACES["a"])
    await line.go()
    assert await line.sent() == [PLACES["a"]]
    assert "away for longer than 300 s" in (await line.seen()).reason


async def test_a_task_that_nobody_fetched_in_time_waits_in_a_paused_queue(line):
    await line.set(task("a"))
    line.yard.now += 400
    await line.yard.fleet.save()
    await line.go()
    report = await line.seen()
    assert (report.state.value, report.tasks[0].state.value) == ("paused", "waiting")
    assert "expired: the robot did not fetch it in time" in report.reason


async def test_an_edit_made_while_somebody_orders_the_robot_about_does_not_undo_the_pause(line):
    await line.set(task("a"), task("b"))
    await line.yard.take()
    added, _ = await asyncio.gather(
        line.queues.add(AddTasks("r1", 1, [task("c")]), "Eve"),
        line.yard.send("x", x=25.0, y=40.0),
        return_exceptions=True,
    )
    await line.go()
    assert isinstance(added, OutdatedError) and added.newer["state"] == "paused"
    report = await line.seen()
    assert (report.revision, report.reason) == (2, "Ada ordered SetPosEnd beside the queue")
    assert await line.states() == {"a": "waiting", "b": "waiting"}


async def test_a_pause_is_never_refused(line):
    await line.set(task("a"), task("b"))
    await line.yard.take()
    for id in "xyz":
        paused, _ = await asyncio.gather(
            line.queues.pause(PauseQueue("r1"), "Eve"), line.yard.send(id, x=25.0, y=40.0)
        )
        assert paused.state.value == "paused"
        await line.reach(25.0, 40.0)
        await line.resume()


async def test_tasks_for_a_robot_that_is_on_its_way_for_somebody_wait(line):
    await line.yard.send("x", x=25.0, y=40.0)
    await line.set(task("a"))
    report = await line.seen()
    assert (report.state.value, await line.sent()) == ("paused", [(25.0, 40.0)])
    assert "the robot is busy with command command-x, which is not of its queue" in report.reason
    await line.reach(25.0, 40.0)
    await line.resume()
    assert (await line.sent())[-1] == PLACES["a"]


async def test_a_task_that_failed_may_be_given_another_path(line):
    await line.yard.at(20.0, 60.0)
    await line.set(task("a", "place", path=LANE))
    assert (await line.seen()).state.value == "paused"
    await line.set(task("a", "place", path=[(20.0, 60.0), (50.0, 40.0)]))
    await line.resume()
    assert await line.sent() == ["SetPath"]
    assert (await line.seen()).tasks[0].reason is None


@pytest.mark.parametrize("done", [True, False], ids=["done", "not done"])
async def test_after_a_commit_of_which_nobody_knows_the_queue_is_what_the_database_holds(
    line, done, monkeypatch
):
    await line.set(task("a"), task("b"))
    run = line.yard.database.run

    async def lost(*work):
        monkeypatch.setattr(line.yard.database, "run", run)
        if done:
            await run(*work)
        raise UncertainError("the connection was lost during the commit")

    monkeypatch.setattr(line.yard.database, "run", lost)
    with pytest.raises(UncertainError):
        await line.queues.pause(PauseQueue("r1"), "Ada")
    await line.reach(*PLACES["a"])
    assert (await line.seen()).state.value == ("paused" if done else "running")
    assert await line.states() == {"a": "done", "b": "waiting" if done else "current"}


@pytest.mark.parametrize("done", [True, False], ids=["done", "not done"])
async def test_a_task_of_which_nobody_knows_whether_it_was_sent_is_sent_once(line, done, monkeypatch):
    run = line.yard.database.run

    async def lost(work, *arguments):
        if work is not write_drafts:
            return await run(work, *arguments)
        monkeypatch.setattr(line.yard.database, "run", run)
        if done:
            await run(work, *arguments)
        raise UncertainError("the connection was lost during the commit")

    monkeypatch.setattr(line.yard.database, "run", lost)
    await line.set(task("a"), task("b"))
    await line.go()
    await line.reach(*PLACES["a"])
    assert await line.states() == {"a": "done", "b": "current"}
    assert await line.sent() == [PLACES["a"], PLACES["b"]]


async def test_a_cone_of_which_nobody_knows_whether_it_was_written_down_is_so_once(line, monkeypatch):
    await line.set(task("a", "place"), task("b"))
    await line.yard.take()
    await line.yard.at(*PLACES["a"])
    run = line.yard.database.run

    async def lost(work, *arguments):
        done = await run(work, *arguments)
        if work is write_outcome:
            monkeypatch.setattr(line.yard.database, "run", run)
            raise UncertainError("the connection was lost during the commit")
        return done

    monkeypatch.setattr(line.yard.database, "run", lost)
    await line.go()
    await line.go()
    assert len(await placed(line)) == 1
    assert await line.states() == {"a": "done", "b": "current"}


# --- cones ------------------------------------------------------------------------------------------------


LANE = [(20.0, 40.0), (40.0, 41.0), (50.0, 40.0)]


async def drive(line, path, end, robot="r1"):
    """Let the robot take its path on, drive along it and stand at its end."""
    ops = await line.yard.take(robot)
    for x, y in path:
        await line.yard.at(x, y, v=1.0, robot=robot)
    await line.yard.at(*end, robot=robot)
    await line.go()
    return ops


async def place(line, robot="r1", id="a", at=(50.0, 40.1), **more):
    await line.set(task(id, "place", **more), robot=robot)
    await line.reach(*at, robot=robot)


async def placed(line, **which):
    return await line.yard.database.run(placements.newest, GetPlacements(**which))


async def test_a_cone_is_driven_to_along_its_path_and_put_down_where_the_robot_stood(line):
    await line.set(task("a", "place", path=LANE, cone="c7", layout="slalom", label="7"), task("b"))
    assert await drive(line, LANE, (50.0, 40.1)) == ["SetPath"]
    assert await line.states() == {"a": "current", "b": "waiting"}
    await line.yard.restart()
    await line.go()
    assert await line.reach(50.0, 40.1) == ["SetPosEnd"]
    (cone,) = await placed(line, layout="slalom")
    assert (cone.cone, cone.label, cone.robot, cone.collected_at) == ("c7", "7", "r1", None)
    assert (cone.planned_x, cone.planned_y, cone.x, cone.y) == (50.0, 40.0, 50.0, 40.1)
    assert cone.deviation == pytest.approx(0.1)
    assert await line.states() == {"a": "done", "b": "current"}
    assert (await line.seen()).ended[0].deviation == pytest.approx(0.1)


async def test_the_robot_is_told_to_put_the_cone_down_only_at_the_end(line):
    await line.set(task("a", "place", path=LANE))
    await drive(line, LANE, LANE[-1])
    await line.yard.take()
    commands = await line.yard._stored()
    assert [(c.op, c.params.get("cone")) for c in commands] == [("SetPath", None), ("SetPosEnd", True)]


async def test_a_path_that_was_broken_off_goes_on_from_where_the_robot_stands(line):
    await line.set(task("a", path=LANE, theta=0.0))
    await line.yard.take()
    for x in (25.0, 30.0, 35.0):
        await line.yard.at(x, 40.0 + (x - 20) / 20, v=1.0)
    await line.yard.fleet.save()
    await line.yard.fleet.orders.abort(AbortTask("abort-0001", robot="r1"), "Ada")
    await line.reach(35.0, 40.9)
    await line.resume()
    (again,) = [c for c in await line.yard._stored() if c.op == "SetPath"][1:]
    assert again.params["points"] == [[35.0, 40.9], [40.0, 41.0], [50.0, 40.0]]
    assert again.params["theta"] == 0.0


async def test_a_robot_far_off_its_path_is_not_sent_across_the_country(line):
    await line.yard.at(20.0, 60.0)
    await line.set(task("a", "place", path=LANE), task("b"))
    report = await line.seen()
    assert await line.sent() == []
    assert report.state.value == "paused"
    assert report.reason.startswith("the robot stands 20.0 m off what is left of the path; drive it there")


async def test_a_robot_drives_a_path_from_its_beginning_or_not_at_all(line):
    await line.yard.at(40.0, 41.0)
    await line.set(task("a", path=LANE))
    assert "stands 20.0 m from where the path begins" in (await line.seen()).reason


async def test_what_is_collected_is_marked_and_not_collected_twice(line):
    await place(line, cone="c1", layout="slalom")
    await place(line, id="b", at=(60.05, 40.0), cone="c2", layout="slalom")
    await place(line, id="c", at=(60.0, 50.0), cone="c1", layout="circle")
    found = await line.queues.collecting(CollectLayout("slalom"))
    assert [(one.cone, one.x, one.y, one.kind.value) for one in found.tasks] == [
        ("c1", 50.0, 40.1, "collect"),
        ("c2", 60.05, 40.0, "collect"),
    ]
    await line.set(found.tasks[0])
    assert (await line.queues.collecting(CollectLayout("slalom"))).in_queues == 1
    again = QueueTask("task-again", 50.0, 40.1, kind=TaskKind.COLLECT, placement=found.tasks[0].placement)
    with pytest.raises(RefusedError, match="already; leave it out"):
        await line.set(again, robot="r2")
    (row,) = await line.yard.deliver()
    assert '"collect": true' in row.params
    await line.reach(50.0, 40.1)
    first, second = sorted(await placed(line, layout="slalom"), key=lambda one: one.placement)
    assert (first.collected_by, second.collected_by) == ("r1", None)
    with pytest.raises(RefusedError, match="does not stand"):
        await line.set(again, robot="r2")
    assert [one.cone for one in (await line.queues.collecting(CollectLayout())).tasks] == ["c2", "c1"]


async def test_a_cone_that_stands_ahead_of_its_robot_is_measured_there(line, monkeypatch):
    monkeypatch.setattr(type(line.yard.site.settings.cones), "offset", (0.5, 0.0))
    with pytest.raises(RefusedError, match="has no theta"):
        await line.set(task("a", "place"))
    await line.set(task("a", "place", theta=0.0, path=LANE))
    await drive(line, LANE[:2], (49.5, 40.05))
    (command,) = [c for c in await line.yard._stored() if c.op == "SetPosEnd"]
    assert (command.params["x"], command.params["y"]) == (49.5, 40.0)
    await line.yard.take()
    await line.yard.fleet.receive("r1", "websocket", SendPos(49.5, 40.1, 0.1, 0.0), None)
    await line.go()
    (cone,) = await placed(line)
    assert (cone.x, cone.y) == pytest.approx((49.5 + 0.5 * math.cos(0.1), 40.1 + 0.5 * math.sin(0.1)))
    assert cone.deviation == pytest.approx(math.dist((cone.x, cone.y), PLACES["a"]))
    assert (await line.seen()).ended[0].deviation == cone.deviation


async def test_what_has_ended_is_forgotten_in_time_and_what_stands_or_waits_is_not(line):
    await place(line, cone="c1")
    await place(line, id="b", at=(60.0, 40.0), cone="c2")
    (first, _) = (await line.queues.collecting(CollectLayout())).tasks
    await line.set(first)
    await line.reach(50.0, 40.1)
    await line.set(task("c"), task("d"))
    forget = line.yard.database.run
    assert [await forget(kind.forget, line.yard.now, 100) for kind in (queues, placements)] == [0, 0]
    assert [await forget(kind.forget, line.yard.now + 1, 2) for kind in (queues, placements)] == [2, 1]
    assert await forget(queues.forget, line.yard.now + 1, 2) == 1
    await line.yard.restart()
    assert await line.states() == {"c": "current", "d": "waiting"}
    assert [one.cone for one in await placed(line)] == ["c2"]


# --- taking over ------------------------------------------------------------------------------------------


def share(robot, revision, *ids, **paths):
    return Share(robot, revision, [SharedTask(f"task-{id:0>4}", paths.get(id)) for id in ids])


async def test_what_a_lost_robot_has_left_is_done_by_another_once(line):
    await line.set(task("a"), task("b"), task("c"))
    await line.set(task("d"), robot="r2")
    await line.yard.take()
    line.yard.now += 20
    await line.yard.at(20.0, 40.0, robot="r2")
    line.yard.fleet.age()
    await line.go()
    revisions = [(await line.seen(robot)).revision for robot in ("r1", "r2")]
    request = TakeOver("r1", revisions[0], [share("r2", revisions[1], "b", "a", "c")], "battery")
    reports = await line.queues.take_over(request, "Ada")
    await line.go()
    assert [[one.task[-1] for one in report.tasks] for report in reports] == [[], ["d", "b", "a", "c"]]
    assert (await line.seen()).reason == "its tasks were taken over: battery"
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
    await line.yard.take()
    await line.queues.take_over(TakeOver("r1", 1, [share("r2", 0, "b")]), "Ada")
    await line.go()
    assert await line.states() == {"a": "current"}
    assert await line.sent("r2") == [PLACES["b"]]
    await line.reach(*PLACES["a"])
    assert await line.states() == {"a": "done"}


@pytest.mark.parametrize(
    ("ids", "said"),
    [
        (["b"], "1 tasks are in no share and would be lost"),
        (["b", "c", "b"], "would be done twice"),
        (["b", "c", "d"], "1 tasks do not wait in any of these queues"),
    ],
)
async def test_a_split_that_loses_or_doubles_a_task_changes_nothing(line, ids, said):
    await line.set(task("a"), task("b"), task("c"))
    with pytest.raises(RefusedError, match=said):
        await line.queues.take_over(TakeOver("r1", 1, [share("r2", 0, *ids)]), "Ada")
    assert await line.states() == {"a": "current", "b": "waiting", "c": "waiting"}
    assert (await line.seen("r2")).tasks == []


async def test_a_path_begins_where_its_robot_is_and_is_given_anew(line):
    await line.set(task("a"), task("b", "place", path=[(50.0, 40.0), (60.0, 40.0)]))
    new = [(20.0, 40.0), (60.0, 40.0)]
    await line.queues.take_over(TakeOver("r1", 1, [share("r2", 0, "b", b=new)]), "Ada")
    await line.go()
    assert [one.path for one in (await line.seen("r2", paths=True)).tasks] == [new]
    assert await line.sent("r2") == ["SetPath"]


# --- another path ------------------------------------------------------------------------------------------


async def test_a_robot_is_sent_round_a_closed_road_without_its_queue_pausing(line):
    await line.set(task("a", "place", path=LANE), task("b"))
    await line.yard.take()
    way = [(20.0, 40.0), (35.0, 45.0), (50.0, 40.0)]
    report = await line.yard.fleet.driving.redirect("r1", SetPath(way), "gateway", "road closed")
    await line.go()
    assert report.params["points"] == [list(point) for point in way] or report.params["points"] == way
    assert await drive(line, way, (50.0, 40.0)) == ["SetPath"]
    await line.reach(50.0, 40.0)
    assert await line.states() == {"a": "done", "b": "current"}
    assert await line.yard.fleet.driving.redirect("r2", SetPath(way), "gateway") is None


# --- what has to be done before ------------------------------------------------------------------------


async def test_a_task_waits_until_what_it_comes_after_is_done_by_another_robot(line):
    await line.set(task("a", "place", cone="A", after=["task-000b", "task-000c"]))
    assert line.pushed[-1]["tasks"][0]["reason"] == (
        "waits for task task-000b, which no robot has been given, "
        "task task-000c, which no robot has been given"
    )
    assert await line.sent() == []
    await line.set(task("b", "place", cone="B"), task("c", "place", cone="C"), robot="r2")
    line.yard.fleet.driving.look_at_all()
    await line.go()
    assert (await line.seen()).tasks[0].reason == "waits for cone B of r2, cone C of r2"
    await line.reach(*PLACES["b"], robot="r2")
    await line.yard.restart()
    line.yard.fleet.driving.look_at_all()
    await line.go()
    report = await line.seen()
    assert (report.state.value, report.tasks[0].reason) == ("running", "waits for cone C of r2")
    assert await line.sent() == []
    await line.reach(*PLACES["c"], robot="r2")
    line.yard.fleet.driving.look_at_all()
    await line.go()
    assert await line.sent() == [PLACES["a"]]
    report = await line.seen()
    assert (report.tasks[0].state.value, report.tasks[0].reason) == ("current", None)


async def test_what_was_not_put_down_is_waited_for_and_said(line):
    await line.set(task("b", cone="B"), robot="r2")
    await line.set(task("a", after=["task-000b"]))
    (row,) = await line.yard.deliver("r2")
    await line.yard.ack(row.id, "r2", ok=False, reason="too steep")
    line.yard.fleet.driving.look_at_all()
    await line.go()
    line.yard.fleet.driving.look_at_all()
    await line.go()
    assert (await line.seen()).tasks[0].reason == "waits for cone B of r2, which failed"
    await line.queues.remove(RemoveTask("r2", (await line.seen("r2")).revision, "task-000b"), "Ada")
    line.yard.fleet.driving.look_at_all()
    await line.go()
    assert (await line.seen()).tasks[0].reason == (
        "waits for task task-000b, which was removed at r2: give this task anew without it"
    )
    assert await line.sent() == []


async def test_a_task_that_waits_for_a_later_one_of_its_own_queue_says_what_to_do(line):
    await line.set(task("a", after=["task-000b"]), task("b", cone="B"))
    report = await line.seen()
    assert report.tasks[0].reason == (
        "waits for cone B, which comes later in this queue: move it to the front"
    )
    await line.queues.move(MoveTask("r1", report.revision, "task-000b", "task-000a"), "Ada")
    await line.go()
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
