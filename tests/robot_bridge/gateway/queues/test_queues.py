"""Queues on a real database: the next task is sent when the current one is reached, and never by surprise."""

from __future__ import annotations

import asyncio

import pytest

from robot_bridge.core.messages.commands import AbortAll, AbortTask
from robot_bridge.core.messages.queues import MakeCurrent, PauseQueue
from robot_bridge.core.messages.safety import ClearEmergencyStop, EmergencyStop
from tests.support.bridge.queue_line import PLACES, task


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
    await line.advance()
    await line.yard.acknowledge_all()
    await line.yard.restart()
    await line.yard.at(*PLACES["a"])  # reached, and the gateway ends before it looks at the queue
    await line.yard.restart()
    await line.advance()
    await line.yard.restart()
    await line.advance()
    assert await line.states() == {"a": "done", "b": "current"}
    assert await line.sent() == [PLACES["a"], PLACES["b"]]


async def test_a_task_that_a_robot_refuses_pauses_its_queue_with_the_reason(line):
    await line.set(task("a"), task("b"))
    (row,) = await line.yard.deliver()
    await line.yard.ack(row.id, ok=False, reason="too steep")
    await line.advance()
    report = await line.report()
    assert (report.state.value, report.tasks[0].state.value) == ("paused", "failed")
    assert "too steep" in report.reason and "too steep" in report.tasks[0].reason
    await line.resume()
    await line.reach(*PLACES["a"])
    assert await line.states() == {"a": "done", "b": "current"}


async def test_an_abort_pauses_and_a_resumed_task_is_begun_anew(line):
    await line.set(task("a"), task("b"))
    await line.yard.acknowledge_all()
    await line.yard.fleet.orders.abort(AbortTask("abort-0001", robot="r1", reason="dog"), "Ada")
    await line.advance()
    # Operators are told before the robot has answered.
    assert [push["state"] for push in line.pushed][-1] == "paused"
    assert await line.reach(30.0, 40.0) == ["Abort"]
    report = await line.report()
    assert (report.state.value, report.reason, report.by) == ("paused", "aborted by Ada: dog", "Ada")
    assert [one.state.value for one in report.tasks] == ["waiting", "waiting"]
    await line.resume()
    await line.reach(*PLACES["a"])
    assert await line.states() == {"a": "done", "b": "current"}
    assert (await line.report()).ended[0].attempts == 2


async def test_a_direct_order_pauses_and_is_not_overtaken(line):
    await line.set(task("a"), task("b"))
    await line.yard.acknowledge_all()
    await line.yard.send("x", x=25.0, y=40.0)
    await line.reach(25.0, 40.0)
    assert await line.sent() == [PLACES["a"], (25.0, 40.0)]
    assert (await line.report()).reason == "Ada ordered SetPosEnd beside the queue"


async def test_a_direct_order_between_two_tasks_holds_through_a_restart(line):
    await line.set(task("a"), task("b"))
    await line.yard.acknowledge_all()
    await line.yard.at(*PLACES["a"])
    await line.yard.send("x", x=25.0, y=40.0)
    await line.yard.restart()
    await line.advance()
    assert await line.sent() == [PLACES["a"], (25.0, 40.0)]
    assert await line.states() == {"a": "done", "b": "waiting"}


async def test_an_emergency_stop_pauses_every_queue_until_each_is_resumed_on_purpose(line):
    await line.set(task("a"), task("b"))
    await line.set(task("c"), robot="r2")
    await line.yard.fleet.emergency.stop(EmergencyStop("stop-0001"), "Ada")
    await line.advance()
    await line.set(task("d"), robot="r2", revision=(await line.report("r2")).revision)
    await line.yard.fleet.emergency.clear(ClearEmergencyStop(), "Eve")
    for robot in ("r1", "r2"):
        await line.yard.acknowledge_all(robot)
        await line.yard.at(20.0, 40.0, robot=robot)
    await line.advance()
    assert [(await line.report(r)).state.value for r in ("r1", "r2")] == ["paused", "paused"]
    assert await line.sent("r2") == [PLACES["c"], "Abort"]
    await line.resume("r2")
    assert await line.sent("r2") == [PLACES["c"], "Abort", PLACES["d"]]


async def test_a_queue_made_during_an_emergency_stop_waits_to_be_resumed(line):
    await line.yard.fleet.emergency.stop(EmergencyStop("stop-0001"), "Ada")
    await line.set(task("a"))
    await line.yard.fleet.emergency.clear(ClearEmergencyStop(), "Eve")
    await line.advance()
    report = await line.report()
    assert report.state.value == "paused" and "emergency stop is in force" in report.reason
    assert PLACES["a"] not in await line.sent()


async def test_abort_all_pauses_every_queue(line):
    await line.set(task("a"))
    await line.set(task("b"), robot="r2")
    await line.yard.fleet.orders.abort_all(AbortAll(), "Ada")
    await line.advance()
    assert [(await line.report(r)).state.value for r in ("r1", "r2")] == ["paused", "paused"]


async def test_a_robot_with_nothing_to_do_may_be_ordered_about_without_pausing_its_queue(line):
    await line.set(task("a"))
    await line.reach(*PLACES["a"])
    await line.yard.send("x", x=25.0, y=40.0)
    await line.reach(25.0, 40.0)
    await line.set(task("b"))
    assert (await line.sent())[-1] == PLACES["b"]


async def test_a_paused_queue_finishes_what_is_driven_and_sends_no_more(line):
    await line.set(task("a"), task("b"))
    await line.queues.pause(PauseQueue("r1", "lunch"), "Ada")
    await line.reach(*PLACES["a"])
    assert await line.sent() == [PLACES["a"]]
    assert (await line.report()).reason == "paused by Ada: lunch"
    report = await line.report()
    await line.queues.make_current(MakeCurrent("r1", report.revision, "task-000b"), "Ada")
    await line.advance()
    assert await line.sent() == [PLACES["a"]]


async def test_a_lost_robot_is_sent_nothing_and_goes_on_when_it_is_back_in_time(line):
    await line.set(task("a"), task("b"))
    await line.yard.acknowledge_all()
    await line.yard.at(*PLACES["a"])
    line.yard.now += 20
    line.yard.fleet.age()
    await line.advance()
    assert ((await line.report()).robot_state.value, await line.sent()) == ("lost", [PLACES["a"]])
    await line.yard.at(*PLACES["a"])
    await line.advance()
    assert await line.sent() == [PLACES["a"], PLACES["b"]]


async def test_a_path_waits_until_its_robot_has_said_where_it_is(line):
    """What is stored of a robot is older than what brought it to where the path begins."""
    path = [PLACES["a"], PLACES["b"]]
    await line.yard.fleet.save()
    await line.set(task("a"), task("b", path=path))
    await line.yard.acknowledge_all()
    await line.yard.at(*PLACES["a"])  # reached, and the gateway ends before it looks at the queue
    await line.yard.restart()
    for again in range(2):
        await line.advance()
        report = await line.report()
        assert (report.state.value, report.tasks[0].reason) == (
            "running",
            "waits for the robot to say where it is",
        )
        if not again:
            await line.yard.ready()
    assert await line.sent() == [PLACES["a"]]
    await line.yard.at(*PLACES["a"])
    await line.advance()
    assert (await line.sent())[1:] == ["SetPath"]
    assert (await line.report()).tasks[0].reason is None


UNHEARD = "not heard for longer than 300 s, or no gateway was there to hear it"


async def is_held(line):
    report = await line.report()
    return report.state.value == "paused" and UNHEARD in report.reason


async def test_a_robot_that_was_away_for_long_is_not_sent_off_by_surprise(line):
    await line.set(task("a"), task("b"))
    await line.reach(*PLACES["a"])
    await line.set(task("b", after=["task-000x"]))
    line.yard.now += 400
    line.yard.fleet.age()
    await line.advance()
    assert await is_held(line)


@pytest.mark.parametrize("gateway_too", [False, True])
async def test_nor_is_one_that_comes_to_the_end_of_its_task_while_it_is_away(line, gateway_too):
    await line.set(task("a"), task("b"))
    await line.yard.acknowledge_all()
    await line.yard.at(30.0, 40.0, v=1.0)
    await line.yard.fleet.save()
    line.yard.now += 400
    if gateway_too:
        await line.yard.restart()
    line.yard.fleet.age()
    await line.yard.ready()
    await line.yard.at(*PLACES["a"])
    await line.advance()
    assert await line.states() == {"a": "done", "b": "waiting"}
    assert await line.sent() == [PLACES["a"]]
    assert await is_held(line)
    await line.resume()
    assert await line.sent() == [PLACES["a"], PLACES["b"]]


@pytest.mark.parametrize("away", [290.0, 310.0])
async def test_a_queue_goes_on_by_itself_when_the_gateway_was_away_for_less_than_that(line, away):
    await line.set(task("a"), task("b"))
    await line.yard.acknowledge_all()
    await line.yard.at(*PLACES["a"])
    await line.yard.fleet.save()
    line.yard.now += away
    await line.yard.restart()
    assert await is_held(line) is False
    await line.advance()
    assert await is_held(line) is (away > 300)


@pytest.mark.parametrize("behind", [4.0, 60.0, 50 * 365 * 86400.0])
async def test_nor_when_the_clock_stood_still_meanwhile_and_nobody_knows_for_how_long(line, behind):
    await line.set(task("a"), task("b"))
    await line.yard.acknowledge_all()
    await line.yard.at(*PLACES["a"])
    await line.yard.fleet.save()
    line.yard.clock.wall -= behind
    await line.yard.restart()
    line.yard.fleet.age()
    assert all(0 <= robot.age <= robot.pose_age for robot in line.yard.fleet.reports())
    await line.yard.ready()
    await line.advance()
    assert await is_held(line) is (behind > 5)


async def test_a_robot_that_had_nothing_to_do_while_it_was_away_may_be_given_a_queue(line):
    line.yard.now += 400
    line.yard.fleet.age()
    await line.advance()
    await line.yard.at(20.0, 40.0)
    await line.set(task("a"))
    assert await line.sent() == [PLACES["a"]]


async def test_a_queue_is_held_back_for_that_also_when_this_cannot_be_stored_at_first(line):
    await line.set(task("a"), task("b"))
    await line.yard.acknowledge_all()
    line.yard.now += 400
    line.yard.fleet.age()
    line.yard.client.break_table("queues")
    await line.yard.at(*PLACES["a"])
    await line.advance()
    line.yard.client.mend_table("queues")
    await line.advance()
    assert await is_held(line)
    assert await line.sent() == [PLACES["a"]]


async def test_a_task_that_nobody_fetched_in_time_waits_in_a_paused_queue(line):
    await line.set(task("a"))
    line.yard.now += 400
    await line.yard.fleet.save()
    await line.advance()
    report = await line.report()
    assert (report.state.value, report.tasks[0].state.value) == ("paused", "waiting")
    assert "expired: the robot did not fetch it in time" in report.reason


async def test_a_pause_is_never_refused(line):
    await line.set(task("a"), task("b"))
    await line.yard.acknowledge_all()
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
    report = await line.report()
    assert (report.state.value, await line.sent()) == ("paused", [(25.0, 40.0)])
    assert "the robot is busy with command command-x, which is not of its queue" in report.reason
    await line.reach(25.0, 40.0)
    await line.resume()
    assert (await line.sent())[-1] == PLACES["a"]
