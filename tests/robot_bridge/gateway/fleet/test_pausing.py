"""A robot that is paused stands, and goes on from there with what it was doing: once, and on purpose."""

from __future__ import annotations

import asyncio
import json
import math
import re
from unittest.mock import AsyncMock

import pytest

from robot_bridge.core.errors import DataRefusedError, OutdatedError, RefusedError, StoreError, UncertainError
from robot_bridge.core.messages.commands import AbortTask
from robot_bridge.core.messages.queues import (
    GetQueue,
    MakeCurrent,
    PauseQueue,
    PauseRobot,
    QueueTask,
    SetQueue,
)
from robot_bridge.core.messages.roads import ResolveConflict
from robot_bridge.core.messages.robots import Abort, GetPath
from robot_bridge.core.messages.safety import ClearEmergencyStop, EmergencyStop
from robot_bridge.gateway.commands.active_command import CommandOrder, KeptAbort
from robot_bridge.gateway.commands.persistence import insert_commands
from robot_bridge.gateway.queues.task_life import STOPS_FIRST
from tests.support.bridge.queue_line import LANE, PLACES, placed, task
from tests.support.patience import until

LAP = [(20.0, 40.0), (50.0, 40.0), (50.0, 60.0), (20.0, 60.0), (20.0, 40.0)]


async def pause(line, reason=None, robot="r1"):
    report = await line.yard.fleet.pauses.pause(PauseRobot(robot, reason), "Eve")
    await line.advance()
    return report


async def pause_on_the_way(line, x=35.0, y=40.0, **how):
    """Let r1 be seen driving, and stand paused a bit further."""
    await line.yard.acknowledge_all()
    await line.yard.at(x, y, v=1.0)
    await pause(line, **how)
    assert await line.reach(x + 0.5, y) == ["Abort"]


async def path_sent(line):
    """Return the points of the path that waits for r1."""
    (row,) = [row for row in await line.yard.deliver() if row.op == "SetPath"]
    return [tuple(point) for point in json.loads(row.params)["points"]]


async def test_a_target_sent_directly_is_kept_and_gone_on_with(line):
    await line.yard.send("x", x=60.0, y=40.0, theta=0.0)
    await pause_on_the_way(line, reason="dog")
    report = await line.report()
    assert (report.state.value, report.reason, report.by) == ("paused", "paused by Eve: dog", "Eve")
    (kept,) = report.tasks
    assert (kept.state.value, kept.x, kept.y, kept.theta, kept.added_by) == (
        "waiting",
        60.0,
        40.0,
        0.0,
        "Ada",
    )
    assert await line.yard.reason("x") == "the robot acknowledged the Abort: paused: dog"
    await line.advance()
    assert len(await line.sent()) == 2
    await line.resume()
    assert await line.reach(60.0, 40.0) == ["SetPosEnd"]
    report = await line.report()
    assert (report.tasks, report.state.value, report.ended[0].state.value) == ([], "running", "done")
    assert await line.sent() == [(60.0, 40.0), "Abort", (60.0, 40.0)]


async def test_of_a_path_sent_directly_what_is_left_is_driven(line):
    await line.yard.send("x", "SetPath", points=LANE, theta=0.5)
    await pause_on_the_way(line, 44.0, 40.5)
    await line.resume()
    assert await path_sent(line) == [(44.5, 40.5), LANE[-1]]


async def test_of_a_closed_lap_what_is_left_is_driven_also_after_a_restart(line):
    await line.yard.send("x", "SetPath", points=LAP)
    await line.yard.acknowledge_all()
    for x, y in [(30.0, 40.0), (40.0, 40.0), (50.0, 40.0), (50.0, 50.0), (50.0, 60.0), (35.0, 60.0)]:
        await line.yard.at(x, y, v=1.0)
    await line.yard.at(20.0, 60.0, v=1.0)
    await line.yard.at(20.0, 41.0, v=1.0)
    await pause(line)
    assert await line.reach(20.0, 41.0) == ["Abort"]
    await line.yard.restart()
    await line.yard.ready()
    await line.yard.at(20.0, 41.0)
    await line.advance()
    assert (await line.report()).state.value == "paused"
    await line.resume()
    assert await path_sent(line) == [(20.0, 41.0), LAP[-1]]


async def test_a_path_that_a_robot_is_on_its_way_to_is_kept_with_the_way_there(line):
    await line.yard.send("x", "SetPath", points=[(50.0, 40.0), (60.0, 40.0)])
    await pause_on_the_way(line, 30.0, 40.0)
    await line.resume()
    assert await path_sent(line) == [(30.0, 40.0), (50.0, 40.0), (60.0, 40.0)]


async def test_a_cone_sent_directly_is_placed_once(line):
    await line.yard.send("x", x=60.0, y=40.0, cone=True)
    await pause_on_the_way(line)
    assert (await line.report()).tasks[0].kind.value == "place"
    await line.resume()
    assert await line.reach(60.0, 40.1) == ["SetPosEnd"]
    (cone,) = await placed(line)
    assert (cone.x, cone.y) == (60.0, 40.1)


async def unheard(line, how):
    """Let r1 be under way and paused, and not have heard of it; return where it is to go."""
    if how == "its own task":
        await line.set(task("a"))
    else:
        await line.yard.send("x", x=50.0, y=40.0)
    await line.yard.acknowledge_all()
    await line.yard.at(35.0, 40.0, v=1.0)
    await pause(line)
    return 50.0, 40.0


@pytest.mark.parametrize("how", ["sent directly", "its own task"])
@pytest.mark.parametrize("restarted", [False, True])
async def test_continue_before_the_robot_has_stopped_holds_and_sends_it_on_once_it_has(line, how, restarted):
    place = await unheard(line, how)
    await line.resume()
    line.yard.now += 1
    if restarted:
        await line.yard.restart()
        await line.advance()
    report = await line.report()
    assert report.state.value == "running"
    assert [one.reason for one in report.tasks] == [STOPS_FIRST]
    assert await line.sent() == [place, "Abort"], "it was sent before it has stopped"
    assert await line.reach(35.5, 40.0) == ["Abort"]
    assert (await line.report()).state.value == "running"
    assert await line.sent() == [place, "Abort", place]
    assert await line.reach(*place) == ["SetPosEnd"]
    report = await line.report()
    assert (report.tasks, report.ended[0].attempts) == ([], 2)


async def test_so_it_does_after_an_abort_of_a_task_of_its_queue(line):
    await line.set(task("a"))
    await line.yard.acknowledge_all()
    await line.yard.at(35.0, 40.0, v=1.0)
    await line.yard.fleet.orders.abort(AbortTask("abort-0001", robot="r1"), "Ada")
    await line.advance()
    await line.resume()
    line.yard.now += 1
    assert await line.sent() == [PLACES["a"], "Abort"]
    assert await line.reach(35.5, 40.0) == ["Abort"]
    assert await line.sent() == [PLACES["a"], "Abort", PLACES["a"]]


async def test_a_queue_that_was_resumed_while_its_robot_drives_on_leaves_its_task_as_it_is(line):
    await line.set(task("a"))
    await line.yard.acknowledge_all()
    await line.queues.pause(PauseQueue("r1"), "Eve")
    await line.resume()
    (only,) = (await line.report()).tasks
    assert (only.state.value, only.reason) == ("current", None)


async def test_paused_again_after_a_continue_that_came_early_it_stands(line):
    place = await unheard(line, "sent directly")
    await line.resume()
    await pause(line)
    assert await line.reach(35.5, 40.0) == ["Abort"]
    await line.advance()
    assert (await line.report()).state.value == "paused"
    assert await line.sent() == [place, "Abort"]
    await line.resume()
    assert await line.sent() == [place, "Abort", place]


async def test_an_emergency_stop_after_a_continue_that_came_early_holds_it(line):
    place = await unheard(line, "its own task")
    await line.resume()
    await line.yard.fleet.emergency.stop(EmergencyStop("stop-0001"), "Ada")
    await line.yard.fleet.emergency.clear(ClearEmergencyStop("clear", "stop-0001"), "Eve")
    await line.reach(35.5, 40.0)
    await line.reach(35.5, 40.0)
    assert (await line.report()).state.value == "paused"
    assert (await line.sent()).count(place) == 1


async def test_a_continue_before_the_robot_has_heard_of_an_emergency_stop_does_not_hold(line):
    await line.set(task("a"))
    await line.yard.acknowledge_all()
    await line.yard.at(35.0, 40.0, v=1.0)
    await line.yard.fleet.emergency.stop(EmergencyStop("stop-0001"), "Ada")
    await line.advance()
    await line.resume()
    line.yard.now += 1
    await line.yard.fleet.emergency.clear(ClearEmergencyStop("clear", "stop-0001"), "Eve")
    await line.reach(35.5, 40.0)
    await line.reach(35.5, 40.0)
    assert (await line.report()).state.value == "paused"
    assert (await line.sent()).count(PLACES["a"]) == 1


@pytest.mark.parametrize("resumed", ["after it is heard", "before it is heard"])
async def test_a_robot_that_was_there_before_it_heard_of_the_pause_places_no_second_cone(line, resumed):
    await line.yard.send("x", x=60.0, y=40.0, cone=True)
    await line.yard.acknowledge_all()
    line.yard.now += 5  # nobody hears it for a while
    await pause(line)
    if resumed == "before it is heard":
        await line.resume()
    assert await line.yard.acknowledge_all() == ["Abort"]
    await line.yard.at(60.0, 40.0)
    await line.advance()
    if resumed == "after it is heard":
        await line.resume()
    assert await line.sent() == [(60.0, 40.0), "Abort"]
    assert len(await placed(line)) == 1
    assert (await line.report()).tasks == []


async def test_a_command_that_was_not_fetched_is_kept_too(line):
    await line.yard.send("x", x=60.0, y=40.0)
    await pause(line)
    assert (await line.yard.states())["x"] == "aborted"
    await line.resume()
    assert (await line.report()).tasks[0].reason == STOPS_FIRST
    assert await line.reach(20.0, 40.0) == ["Abort"]
    assert await line.reach(60.0, 40.0) == ["SetPosEnd"]
    assert (await line.report()).ended[0].state.value == "done"


async def test_a_task_of_the_queue_waits_at_its_head_and_nothing_is_kept_beside_it(line):
    await line.set(task("a"), task("b"))
    await pause_on_the_way(line)
    assert await line.states() == {"a": "waiting", "b": "waiting"}
    assert (await line.report()).reason == "paused by Eve"
    await line.resume()
    assert await line.reach(*PLACES["a"]) == ["SetPosEnd"]
    assert await line.states() == {"a": "done", "b": "current"}


async def test_what_was_ordered_beside_a_queue_comes_before_it(line):
    await line.set(task("a"), task("b"))
    await line.yard.acknowledge_all()
    await line.yard.send("x", x=70.0, y=40.0)
    await pause_on_the_way(line)
    report = await line.report()
    assert [one.x for one in report.tasks] == [70.0, PLACES["a"][0], PLACES["b"][0]]
    assert report.reason == "paused by Eve"
    await line.resume()
    await line.reach(70.0, 40.0)
    assert (await line.sent())[-1] == PLACES["a"]


async def test_asked_again_it_changes_nothing(line):
    await line.yard.send("x", x=60.0, y=40.0)
    await line.yard.acknowledge_all()
    first = await pause(line)
    assert await pause(line) == first
    await line.reach(35.0, 40.0)
    third = await pause(line)
    assert (third.revision, len(third.tasks)) == (first.revision, 1)
    assert await line.sent() == [(60.0, 40.0), "Abort"]


async def test_paused_twice_on_its_way_it_goes_on_twice(line):
    await line.yard.send("x", x=60.0, y=40.0)
    for x in (30.0, 40.0):
        await pause_on_the_way(line, x)
        assert len((await line.report()).tasks) == 1
        await line.resume()
    await line.reach(60.0, 40.0)
    assert (await line.report()).ended[0].attempts == 3


async def test_a_robot_that_does_nothing_is_only_paused(line):
    report = await pause(line, "gate")
    assert (report.state.value, report.reason, report.tasks) == ("paused", "paused by Eve: gate", [])
    assert await line.sent() == []
    await line.set(task("a"))
    assert await line.sent() == []
    await line.resume()
    assert await line.sent() == [PLACES["a"]]


async def test_what_somebody_has_aborted_is_not_kept(line):
    await line.yard.send("x", x=60.0, y=40.0)
    await line.yard.acknowledge_all()
    await line.yard.fleet.orders.abort(AbortTask("abort-0001", robot="r1"), "Ada")
    assert (await pause(line)).tasks == []
    await line.reach(35.0, 40.0)
    assert await line.sent() == [(60.0, 40.0), "Abort"]


async def test_after_an_emergency_stop_it_goes_on_only_on_purpose(line):
    await line.yard.send("x", x=60.0, y=40.0)
    await pause_on_the_way(line)
    await line.yard.fleet.emergency.stop(EmergencyStop("stop-0001"), "Ada")
    await line.resume()
    report = await line.report()
    assert report.state.value == "paused" and "emergency stop is in force" in report.reason
    assert (60.0, 40.0) not in (await line.sent())[1:]


@pytest.mark.parametrize("busy", [True, False], ids=["busy", "idle"])
async def test_a_command_that_is_being_stored_when_its_robot_is_paused_is_stopped_and_kept(
    line, monkeypatch, busy
):
    if busy:
        await line.yard.send("x", x=60.0, y=40.0)
        await line.yard.acknowledge_all()
    run, begun, released = line.yard.database.run, asyncio.Event(), asyncio.Event()

    async def run_late(work, *arguments):
        if work is insert_commands and not begun.is_set():
            begun.set()
            await released.wait()
        return await run(work, *arguments)

    monkeypatch.setattr(line.yard.database, "run", run_late)
    sending = asyncio.create_task(line.yard.send("y", x=70.0, y=40.0))
    await begun.wait()
    pausing = asyncio.create_task(pause(line))
    await until(lambda: line.yard.fleet._commands.drafting.stops._newest)
    released.set()
    await asyncio.gather(sending, pausing)
    await line.reach(35.0, 40.0)
    assert [one.x for one in (await line.report()).tasks] == [70.0]
    assert (await line.sent()).count("Abort") == 1


@pytest.mark.parametrize("done", [True, False], ids=["done", "not done"])
async def test_a_pause_of_which_nobody_knows_whether_it_was_stored_is_asked_for_again(line, done, lose):
    await line.yard.send("x", x=60.0, y=40.0)
    await line.yard.acknowledge_all()
    lose(line.yard, insert_commands, done)
    with pytest.raises(UncertainError):
        await pause(line)
    report = await pause(line)
    assert (report.state.value, [one.x for one in report.tasks]) == ("paused", [60.0])
    assert await line.reach(35.0, 40.0) == ["Abort"]
    await line.resume()
    assert await line.reach(60.0, 40.0) == ["SetPosEnd"]
    assert (await line.report()).tasks == []


NOT_STORED = (
    "the connection was lost during the commit. The pause is not stored; an Abort was sent to no robot; "
    "it is stored and sent as soon as the database takes it"
)


async def test_a_pause_that_is_lost_becomes_an_abort_that_holds_the_queue(line, lose):
    await line.set(task("a"), task("b"))
    await line.yard.acknowledge_all()
    lose(line.yard, insert_commands, False, StoreError)
    with pytest.raises(StoreError, match=re.escape(NOT_STORED)):
        await pause(line)
    await line.yard.fleet.save()
    assert await line.reach(35.0, 40.0) == ["Abort"]
    report = await line.report()
    assert (report.state.value, [one.task for one in report.tasks]) == ("paused", ["task-000a", "task-000b"])
    assert await line.sent() == [PLACES["a"], "Abort"]


@pytest.mark.parametrize("refusal", [RefusedError, DataRefusedError])
async def test_a_second_pause_that_is_refused_leaves_the_abort_of_the_first_one(
    line, lose, monkeypatch, refusal
):
    await line.yard.send("x", x=60.0, y=40.0)
    await line.yard.acknowledge_all()
    lose(line.yard, insert_commands, False, StoreError)
    with pytest.raises(StoreError):
        await pause(line)
    with monkeypatch.context() as patch:
        patch.setattr(line.yard.fleet.pauses, "_pause_held", AsyncMock(side_effect=refusal("no")))
        with pytest.raises((RefusedError, StoreError), match="no"):
            await pause(line)
    await line.yard.fleet.save()
    assert (await line.sent())[1:] == ["Abort"]


async def test_what_the_first_one_has_left_is_not_stored_while_the_second_one_waits_for_its_turn(
    line, lose, monkeypatch
):
    """It would end what the second one keeps."""
    await line.yard.send("x", x=60.0, y=40.0)
    await line.yard.acknowledge_all()
    lose(line.yard, insert_commands, False, StoreError)
    with pytest.raises(StoreError):
        await pause(line)
    pauses = line.yard.fleet.pauses
    pause_held = pauses._pause_held

    async def after_a_save(*asked):
        await line.yard.fleet.save()
        assert "Abort" not in await line.sent()
        return await pause_held(*asked)

    monkeypatch.setattr(pauses, "_pause_held", after_a_save)
    report = await pause(line)
    await line.yard.fleet.save()
    assert [one.x for one in report.tasks] == [60.0]
    assert (await line.sent()).count("Abort") == 1


def left_elsewhere(line, **how):
    """Have the Abort of r1 kept that another gateway could not store."""
    order = CommandOrder("abort-0001", "r1", Abort(), "Ada", "paused", **how)
    line.yard.fleet._commands.keep_left([KeptAbort(order, line.yard.clock.time(), is_left=True)])


@pytest.mark.parametrize(("of_pause", "kept"), [(True, [60.0]), (False, [])])
async def test_what_a_pause_at_another_gateway_has_left_is_not_stored_behind_one_that_succeeds(
    line, of_pause, kept
):
    """An operator's Abort is stored before: the task that it ends is not kept."""
    await line.yard.send("x", x=60.0, y=40.0)
    await line.yard.acknowledge_all()
    left_elsewhere(line, of_pause=of_pause)
    report = await pause(line)
    await line.yard.fleet.save()
    assert [one.x for one in report.tasks] == kept
    assert (await line.sent()).count("Abort") == 1


@pytest.mark.parametrize("abort_first", [True, False])
async def test_a_failed_pause_takes_the_place_of_no_abort_that_could_not_be_stored(line, lose, abort_first):
    await line.yard.send("x", x=60.0, y=40.0)
    await line.yard.acknowledge_all()
    abort = line.yard.fleet.orders.abort
    for is_abort in (abort_first, not abort_first):
        lose(line.yard, insert_commands, False, StoreError)
        with pytest.raises(StoreError):
            await (abort(AbortTask("abort-0001", "r1"), "Ada") if is_abort else pause(line))
    assert (await pause(line)).tasks == []
    await line.yard.fleet.save()
    assert "Abort" in await line.sent()
    await line.yard.acknowledge_all()
    assert (await line.yard.states())["x"] == "aborted"


async def test_what_a_pause_has_left_does_not_hold_a_queue_that_is_resumed_after_it(line):
    await line.set(task("a"))
    await line.yard.acknowledge_all()
    await line.queues.pause(PauseQueue("r1"), "Ada")
    left_elsewhere(line, of_pause=True)
    await line.resume()
    await line.yard.fleet.save()
    await line.advance()
    report = await line.report()
    assert (report.state.value, report.tasks[0].reason) == ("running", STOPS_FIRST)
    assert await line.reach(35.0, 40.0) == ["Abort"]
    assert await line.sent() == [PLACES["a"], "Abort", PLACES["a"]]


async def test_a_queue_that_what_a_pause_has_left_holds_is_not_resumed_unseen(line):
    await line.set(task("a"))
    await line.yard.acknowledge_all()
    left_elsewhere(line, of_pause=True)
    with pytest.raises(OutdatedError):
        await line.resume()
    assert (await line.report()).reason == "aborted by Ada: paused"


async def test_a_pause_that_is_lost_of_a_robot_that_does_nothing_becomes_an_abort_too(line, lose):
    lose(line.yard, None, False, StoreError)
    with pytest.raises(StoreError, match=re.escape(NOT_STORED)):
        await pause(line)
    assert await line.sent() == []
    await line.yard.fleet.save()
    assert await line.sent() == ["Abort"]


@pytest.mark.parametrize("again", [True, False], ids=["asked for again", "left"])
@pytest.mark.parametrize("done", [True, False], ids=["done", "not done"])
async def test_a_pause_whose_queue_is_stored_in_doubt_holds_the_queue(line, lose, done, again):
    """Its robot does nothing yet. An Abort makes sure, unless the pause is asked for once more."""
    await line.queues.set(SetQueue("r1", 0, [task("a")]), "Ada")
    lose(line.yard, None, done)
    with pytest.raises(UncertainError, match=re.escape(NOT_STORED)):
        await line.yard.fleet.pauses.pause(PauseRobot("r1"), "Eve")
    if again:
        await pause(line)
    await line.yard.fleet.save()
    await line.advance()
    assert (await line.report()).state.value == "paused"
    assert await line.sent() == ([] if again else ["Abort"])


async def test_a_pause_of_a_task_that_ends_before_its_abort_is_stored_holds_the_queue(line, lose):
    await line.set(task("a"), task("b"))
    await line.yard.acknowledge_all()
    lose(line.yard, insert_commands, False, StoreError)
    with pytest.raises(StoreError):
        await pause(line)
    await line.reach(*PLACES["a"])
    await line.yard.fleet.save()
    assert (await line.report()).state.value == "paused"
    assert PLACES["b"] not in await line.sent()


async def test_a_robot_that_never_was_here_cannot_be_paused(line):
    with pytest.raises(RefusedError, match="robot 'r9' is not known to this gateway; known are: r1, r2"):
        await pause(line, robot="r9")


async def test_a_cone_that_was_there_all_the_same_is_not_placed_again_when_another_task_came_first(line):
    await line.yard.send("x", x=60.0, y=40.0, cone=True)
    await line.yard.acknowledge_all()
    line.yard.now += 5  # nobody hears it for a while
    await line.set(task("a"))
    await pause(line)
    await line.queues.make_current(MakeCurrent("r1", (await line.report()).revision, "task-000a"), "Ada")
    await line.reach(60.0, 40.0)
    await line.resume()
    await line.reach(*PLACES["a"])
    assert await line.sent() == [(60.0, 40.0), "Abort", PLACES["a"]]
    assert len(await placed(line)) == 1
    assert (await line.report()).tasks == []


async def test_where_a_robot_waits_for_another_it_goes_on_after_the_pause(roads):
    await roads.wait_at_the_crossing()
    report = await roads.fleet.pauses.pause(PauseRobot("r1"), "Eve")
    assert (report.state.value, [one.path_points > 0 for one in report.tasks]) == ("paused", [True])
    assert (report.tasks[0].x, report.tasks[0].y) == (90.0, 22.0)
    assert (await roads.fleet.roads.traffic.conflicts()).waiting == []


async def test_on_its_way_to_where_it_waits_both_parts_of_its_way_are_kept(roads):
    await roads.drive("one", [(16.0, 8.0), (44.0, 22.0), (90.0, 22.0)])
    await roads.drive("two", [(13.0, 22.0), (56.0, 22.0), (56.0, 40.0)], robot="r2")
    await roads.fleet.roads.traffic.resolve(ResolveConflict("r1", "r2", "waiting"), "Ada")
    (hold,) = (await roads.fleet.roads.traffic.conflicts()).waiting
    await roads.acknowledge_all()
    report = await roads.fleet.pauses.pause(PauseRobot("r1"), "Eve")
    assert [(one.x, one.y) for one in report.tasks] == [(hold.x, hold.y), (90.0, 22.0)]


async def test_a_target_that_it_waits_on_its_way_to_is_kept_as_one_task(roads):
    await roads.ready()
    await roads.at(16.0, 8.0, v=1.0)
    await roads.send("cone", x=92.0, y=22.0, cone=True)
    await roads.acknowledge_all()
    outcome = await roads.fleet.receive("r1", "websocket", GetPath(), 7)
    await roads.fleet.outboxes.finish([outcome], [], acks=False)
    await roads.acknowledge_all()
    metres = math.dist((16, 8), (44, 22)) + 1
    await roads.drive("two", [(44.0 - metres, 22.0), (56.0, 22.0), (56.0, 40.0)], robot="r2")
    await roads.fleet.roads.traffic.resolve(ResolveConflict("r1", "r2", "waiting"), "Ada")
    report = await roads.fleet.pauses.pause(PauseRobot("r1"), "Eve")
    assert [(one.kind.value, one.x, one.y) for one in report.tasks] == [("place", 92.0, 22.0)]


async def test_a_task_of_its_queue_that_waits_for_another_robot_is_not_there_twice(roads):
    ways = [(16.0, 8.0), (44.0, 22.0), (90.0, 22.0)], [(13.0, 22.0), (56.0, 22.0), (56.0, 40.0)]
    await roads.ready()
    await roads.at(*ways[0][0], v=1.0)
    await roads.fleet.queues.set(SetQueue("r1", 0, [QueueTask("task-0001", 90.0, 22.0, path=ways[0])]), "Ada")
    await roads.fleet.driving.advance()
    await roads.acknowledge_all()
    await roads.drive("two", ways[1], robot="r2")
    await roads.fleet.roads.traffic.resolve(ResolveConflict("r1", "r2", "waiting"), "Ada")
    (hold,) = (await roads.fleet.roads.traffic.conflicts()).waiting
    await roads.acknowledge_all()
    for share in (0.25, 0.5, 0.75, 1.0):
        await roads.at(16.0 + share * (hold.x - 16.0), 8.0 + share * (hold.y - 8.0), v=1.0 - share)
    await roads.fleet.driving.advance()
    (before,) = (await roads.fleet.queues.read(GetQueue("r1"))).queues
    assert [one.task for one in before.tasks] == ["task-0001"]
    report = await roads.fleet.pauses.pause(PauseRobot("r1"), "Eve")
    assert [one.task for one in report.tasks] == ["task-0001"]
