"""How commands end other than well, and what a gateway that starts anew knows of those under way."""

from __future__ import annotations

import asyncio
import time

import pytest

from robot_bridge.core.errors import RefusedError, UncertainError
from robot_bridge.core.messages.base import MessageError
from robot_bridge.core.messages.commands import AbortAll, AbortTask, GetCommands, Send
from robot_bridge.core.messages.robots import Ready, SendPos

LOOP = [(10.0, 10.0), (20.0, 10.0), (20.0, 20.0), (10.0, 20.0), (10.0, 10.0)]


@pytest.fixture
async def ready(yard):
    """A yard with robot r1, which has taken its map."""
    await yard.ready()
    await yard.acknowledge_all()
    return yard


async def abort(yard, id="x", by="Bob", **what):
    return await yard.fleet.orders.abort(AbortTask(f"command-{id}", **what), by)


# --- abort one --------------------------------------------------------------------------------------------


async def test_the_task_of_a_robot_is_aborted_with_who_and_why_at_each_step(ready):
    await ready.send("a")
    await ready.acknowledge_all()
    report = await abort(ready, robot="r1", reason="flat tyre")
    assert (report.op, report.steps[0].by, report.steps[0].reason) == ("Abort", "Bob", "flat tyre")
    await ready.acknowledge_all()
    assert await ready.states() == {"a": "aborted", "x": "acknowledged"}
    assert await ready.reason("a") == "the robot acknowledged the Abort: flat tyre"


async def test_one_command_is_aborted_by_its_id(ready):
    await ready.send("a")
    assert (await abort(ready, aborts="command-a", reason="wrong cone")).robot == "r1"
    assert await ready.states() == {"a": "aborted", "x": "queued"}
    assert await ready.reason("a") == "before the robot acknowledged it: wrong cone"


async def test_what_came_after_the_command_that_was_to_be_aborted_lives_on(ready):
    await ready.send("a")
    await ready.send("b")
    for aborts in ("command-a", "command-z"):
        with pytest.raises(RefusedError, match=f"command {aborts} has ended or was never issued"):
            await abort(ready, aborts=aborts)
    assert await ready.states() == {"a": "superseded", "b": "queued"}


async def test_a_command_that_is_superseded_in_the_same_moment_takes_its_successor_with_it_never(ready):
    await ready.send("a")
    results = await asyncio.gather(ready.send("b"), abort(ready, aborts="command-a"), return_exceptions=True)
    assert isinstance(results[1], RefusedError)
    assert "is no longer what robot 'r1' is doing" in str(results[1])
    assert await ready.states() == {"a": "superseded", "b": "queued"}


async def test_an_abort_asked_for_twice_is_done_once(ready):
    await ready.send("a")
    first = await abort(ready, aborts="command-a")
    assert await abort(ready, aborts="command-a") == first
    assert ready.waiting() == ["Abort"]
    assert (await abort(ready, "y", robot="r1")).command == "command-y"
    assert (await abort(ready, "y", robot="r1")).state.value == "queued"


@pytest.mark.parametrize("by_send", [True, False])
@pytest.mark.parametrize("robot", ["r1", "r2"])
async def test_an_abort_under_the_id_of_another_command_is_done_under_another_id(ready, robot, by_send):
    await ready.ready("r2")
    await ready.send("a")
    await send(ready, "b", "r2")
    if by_send:
        report = await ready.fleet.orders.send(Send("command-a", robot, "Abort"), "Ada")
    else:
        report = await abort(ready, "a", robot=robot)
    assert (report.op, report.robot, report.state.value) == ("Abort", robot, "queued")
    assert report.command != "command-a"
    states = await ready.states()
    assert states["a" if robot == "r1" else "b"] == "aborted"


@pytest.mark.parametrize("other", [("r2", "SetPosEnd"), ("r1", "SetPosIni")])
async def test_a_motion_under_the_id_of_another_command_is_refused(ready, other):
    await ready.ready("r2")
    await ready.send("a")
    robot, op = other
    with pytest.raises(RefusedError, match=r"'command-a' is a SetPosEnd of robot 'r1' .*; give each command"):
        await ready.fleet.orders.send(Send("command-a", robot, op, {"x": 50, "y": 40}), "Ada")


@pytest.mark.parametrize("all_robots", [True, False])
async def test_an_abort_is_sent_once_although_the_clock_was_set_back_since_the_motion(ready, all_robots):
    await ready.send("a")
    await ready.acknowledge_all()
    ready.now -= 100.0
    if all_robots:
        await ready.fleet.orders.abort_all(AbortAll("abort-all-1"), "Ada")
    else:
        await abort(ready, "x", robot="r1")
    assert ready.waiting() == ["Abort"]


@pytest.mark.parametrize(("later", "sent"), [(0.0, []), (59.0, []), (61.0, ["Abort"]), (-61.0, ["Abort"])])
async def test_an_abort_under_the_id_of_one_that_was_done_long_ago_is_another_one(ready, later, sent):
    """Nothing moves the robot at the moment, and its queue may in the next."""
    await ready.send("a")
    first = await abort(ready, "x", robot="r1")
    await ready.acknowledge_all()
    await ready.at(20.0, 40.0)
    ready.now += later
    again = await abort(ready, "x", robot="r1")
    assert ready.waiting() == sent and (again.command == first.command) is (not sent)


@pytest.mark.parametrize("step", [1.0, -1.0])
async def test_an_abort_under_the_id_of_an_earlier_one_stops_what_was_asked_since(ready, step):
    def abort_all():
        return ready.fleet.orders.abort_all(AbortAll("abort-all-1"), "Ada")

    for again in (lambda: abort(ready, "x", robot="r1"), abort_all):
        for id in ("a", "b"):
            ready.now += step
            await ready.send(f"{id}{again is abort_all}")
            ready.now += step
            await again()
            assert (await ready.states())[f"{id}{again is abort_all}"] == "aborted"
            assert ready.waiting() == ["Abort"]
            await again()
            assert ready.waiting() == ["Abort"]


@pytest.mark.parametrize("what", [{}, {"robot": "r1", "aborts": "command-a"}, {"robot": "a b"}])
def test_an_abort_names_one_thing(what):
    with pytest.raises(MessageError):
        AbortTask("command-x", **what)


async def test_why_all_were_aborted_is_kept(ready):
    await ready.send("a")
    await ready.fleet.orders.abort_all(AbortAll(reason="lunch"), "Ada")
    assert await ready.reason("a") == "before the robot acknowledged it: lunch"


# --- expiry -----------------------------------------------------------------------------------------------


async def send(yard, id, robot="r1", **how):
    return await yard.fleet.orders.send(
        Send(f"command-{id}", robot, "SetPosEnd", {"x": 50, "y": 40}, **how), "Ada"
    )


async def test_a_command_expires_when_it_says_also_after_a_restart(ready):
    for robot in ("r2", "r3"):
        await ready.ready(robot)
    await send(ready, "soon", expires_in=5.0, reason="while the road is free")
    await send(ready, "late", "r2", expires_in=4000.0)
    await send(ready, "usual", "r3")
    ready.now += 6.0
    await ready.restart()
    await ready.fleet.save()
    assert await ready.states() == {"soon": "expired", "late": "queued", "usual": "queued"}
    assert await ready.reason("soon") == "the robot did not fetch it in time"
    ready.now += 300.0
    await ready.fleet.save()
    assert await ready.states() == {"soon": "expired", "late": "queued", "usual": "expired"}
    (report,) = (await ready.fleet.orders.newest(GetCommands("r1", 1))).commands
    assert report.steps[0].reason == "while the road is free"


@pytest.mark.parametrize("seconds", [0.0, -1.0, float("nan"), float("inf"), 1e9])
def test_an_expiry_that_is_no_time_is_refused(seconds):
    with pytest.raises(MessageError, match=r"expires_in is .*; give seconds, above 0 and up to"):
        Send("command-a", "r1", "Abort", expires_in=seconds)


async def test_a_robot_that_started_anew_is_not_sent_an_old_order_that_it_never_took_on(ready):
    await send(ready, "old", expires_in=60.0)
    await ready.deliver()
    ready.now += 61.0
    await ready.ready(magic=2)
    assert await ready.acknowledge_all() == ["SetMap"]
    assert await ready.states() == {"old": "expired"}


# --- how far a robot has come -----------------------------------------------------------------------------


async def drive(yard, points):
    for x, y in points:
        await yard.at(x, y, v=1.0)


async def test_a_robot_blocked_at_the_start_of_a_loop_has_not_driven_it_when_the_gateway_starts_anew(ready):
    await ready.send("a", "SetPath", points=LOOP)
    await ready.acknowledge_all()
    await ready.at(10.0, 10.0)
    await ready.fleet.save()
    await ready.restart()
    for k in range(5):
        await ready.at(10.0 + 0.02 * k, 10.0)
    assert await ready.states() == {"a": "acknowledged"}
    await drive(ready, [(10.0 + k, 10.0) for k in range(11)])
    await drive(ready, [(20.0, 10.0 + k) for k in range(11)])
    await ready.fleet.save()
    await ready.restart()
    await drive(ready, [(20.0 - k, 20.0) for k in range(11)])
    await drive(ready, [(10.0, 20.0 - k) for k in range(11)])
    await ready.at(10.0, 10.0)
    assert await ready.states() == {"a": "reached"}


async def test_the_metres_driven_are_stored_once_a_save_and_only_when_they_grow(ready):
    await ready.send("a", "SetPath", points=LOOP)
    await ready.acknowledge_all()
    await drive(ready, [(10.0 + 0.5 * k, 10.0) for k in range(13)])
    assert ready.sql("select driven from commands") == [(0.0,)]
    await ready.fleet.save()
    assert ready.sql("select driven from commands")[0][0] == pytest.approx(6.0)
    ready.sql("update commands set driven = 0")
    await ready.at(16.1, 10.0)
    await ready.fleet.save()
    assert ready.sql("select driven from commands") == [(0.0,)]


async def test_a_robot_that_started_anew_drives_its_path_from_the_start(ready):
    await ready.send("a", "SetPath", points=LOOP)
    await ready.acknowledge_all()
    await drive(ready, [(10.0 + k, 10.0) for k in range(11)])
    await ready.fleet.save()
    await ready.ready(magic=2)
    assert ready.sql("select driven from commands") == [(None,)]
    await ready.acknowledge_all()
    assert ready.sql("select driven from commands") == [(0.0,)]


# --- latency and liveness ---------------------------------------------------------------------------------


async def latency(yard):
    return {report.robot: report.latency for report in yard.fleet.reports()}


async def test_the_latency_of_a_link_over_sql_is_from_the_writing_of_a_command_to_its_opack(yard):
    await yard.ready(link="sql")
    await yard.deliver()
    await yard.send("a")
    yard.now += 0.25
    rows = await yard.deliver()
    await yard.fleet.receive("r1", "sql", _opack(rows[-1].id), None)
    assert await latency(yard) == {"r1": 0.25}
    await yard.send("b")
    yard.now += 3600.0
    rows = await yard.deliver()
    await yard.fleet.receive("r1", "sql", _opack(rows[-1].id), None)
    assert await latency(yard) == {"r1": 0.25}  # it was away; that is not its link


def _opack(id):
    from robot_bridge.core.messages.robots import OpAck

    return OpAck(id=id)


async def test_late_poses_move_nothing_back_over_a_restart_and_another_link(ready):
    await ready.fleet.receive("r1", "websocket", SendPos(30.0, 40.0, 0.0, 1.0, t=500.0), None)
    await ready.fleet.save()
    await ready.restart()
    await ready.fleet.receive("r1", "sql", SendPos(20.0, 40.0, 0.0, 1.0, t=499.0), None)
    (report,) = ready.fleet.reports()
    assert (report.x, report.device_time) == (30.0, 500.0)
    await ready.fleet.receive("r1", "sql", SendPos(31.0, 40.0, 0.0, 1.0, t=501.0, fix_t=499.5), None)
    (report,) = ready.fleet.reports()
    assert (report.x, report.device_time, report.fix_time, report.pose_age) == (31.0, 501.0, 499.5, 0.0)


async def test_a_lost_robot_stays_known_with_its_last_place_and_time(ready):
    await ready.fleet.receive("r1", "websocket", SendPos(30.0, 40.0, 0.0, 1.0, t=500.0), None)
    await ready.fleet.save()
    ready.now += 86_400.0
    await ready.restart()
    (report,) = ready.fleet.reports()
    assert (report.state.value, report.x, report.y, report.device_time) == ("lost", 30.0, 40.0, 500.0)
    assert report.age == report.pose_age == 86_400.0


# --- transactions of which nobody knows -------------------------------------------------------------------


@pytest.mark.parametrize("done", [False, True])
async def test_a_commit_of_which_nobody_knows_is_looked_up_before_anything_else(ready, done, monkeypatch):
    await ready.send("a")
    (row,) = await ready.deliver()
    run = ready.database.run

    async def lost(work, *arguments):
        monkeypatch.setattr(ready.database, "run", run)
        if done:
            await run(work, *arguments)
        raise UncertainError("the connection was lost during the commit")

    monkeypatch.setattr(ready.database, "run", lost)
    with pytest.raises(UncertainError):
        await ready.ack(row.id)
    await ready.ack(row.id)
    await ready.at(50.0, 40.0)
    assert await ready.steps("a") == ["queued", "delivered", "acknowledged", "reached"]


async def test_a_caller_that_goes_away_leaves_no_step_unknown(ready):
    await ready.send("a")
    (row,) = await ready.fleet.outboxes.outbox("r1", 0)
    slow = asyncio.ensure_future(ready.database.run(lambda connection: time.sleep(0.3)))
    await asyncio.sleep(0.05)
    delivering = asyncio.ensure_future(ready.fleet.outboxes.delivered([row.id]))
    await asyncio.sleep(0.05)
    delivering.cancel()
    await slow
    assert await ready.states() == {"a": "delivered"}
    await ready.ack(row.id)
    assert await ready.steps("a") == ["queued", "delivered", "acknowledged"]


async def test_a_second_ready_of_the_same_run_gives_nobody_a_task_twice(ready):
    await ready.send("a")
    await ready.acknowledge_all()
    await ready.fleet.receive("r1", "websocket", Ready(1), 7)
    assert await ready.steps("a") == ["queued", "delivered", "acknowledged"]
