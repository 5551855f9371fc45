"""What stood in RR before a gateway was there to read it tells what was, not what is."""

from __future__ import annotations

import pytest

from robot_bridge.core.errors import StoreError
from robot_bridge.core.messages.commands import AbortTask
from robot_bridge.core.messages.robots import Abort, Alive, OpAck, Ready, SendPos, Stopped
from robot_bridge.core.messages.safety import RobotState
from robot_bridge.gateway.fleet.robot_outboxes import finish_requests
from tests.support.bridge.queue_line import Line, task

BEGIN = (20.0, 40.0)
PATH = [BEGIN, (40.0, 40.0), (50.0, 40.0)]


@pytest.fixture
async def plugged(yard):
    """A yard with robot r1 on SQL, at the beginning of PATH, with nothing left to read."""
    yard.ask("r1", Ready(1))
    await yard.link.poll()
    yard.ask("r1", SendPos(*BEGIN, 0.0, 0.0))
    read(yard)
    await yard.link.poll()
    return yard


def read(yard):
    """Let the robot read, delete and acknowledge what waits for it; return the operation codes."""
    rows = yard.sql("select id, op from sa where robot = 'r1' order by id")
    for id, op in rows:
        yard.sql("delete from sa where id = ?", id)
        if op != "OpAck":
            yard.ask("r1", OpAck(id=id))
    return [op for _, op in rows]


async def restart_later(yard):
    await yard.fleet.save()
    await yard.restart()
    yard.now += 60
    yard.fleet.age()


def robot(yard):
    return yard.fleet.robots.get("r1")


@pytest.mark.parametrize("request_", [SendPos(30.0, 40.0, 0.0, 1.0), Alive(), Stopped(), OpAck(id=99)])
async def test_a_message_from_before_the_restart_does_not_show_that_the_robot_is_there(plugged, request_):
    plugged.ask("r1", request_)
    await restart_later(plugged)
    await plugged.link.poll()
    assert robot(plugged).state is not RobotState.FRESH
    assert not plugged.fleet.robots.is_placed("r1")
    plugged.ask("r1", SendPos(31.0, 40.0, 0.0, 1.0))
    await plugged.link.poll()
    assert robot(plugged).state is RobotState.FRESH
    assert plugged.fleet.robots.is_placed("r1")


async def test_a_position_from_before_the_restart_moves_the_robot_and_is_stored(plugged):
    plugged.ask("r1", SendPos(30.0, 40.0, 0.0, 1.0))
    await restart_later(plugged)
    await plugged.link.poll()
    assert robot(plugged).pose.x == 30.0
    assert (30.0,) in plugged.sql("select x from trajectories")
    (report,) = plugged.fleet.reports()
    assert report.pose_age == report.age == 60.0


async def test_a_path_is_not_sent_by_a_position_from_before_the_restart(plugged):
    line = Line(plugged)
    plugged.ask("r1", SendPos(*BEGIN, 0.0, 0.0))
    await plugged.fleet.save()
    await plugged.restart()
    line = Line(plugged)
    await plugged.link.poll()
    await line.set(task("a", path=PATH))
    assert "SetPath" not in plugged.waiting()
    plugged.ask("r1", SendPos(*BEGIN, 0.0, 0.0))
    await plugged.link.poll()
    await line.advance()
    assert "SetPath" in plugged.waiting()


async def test_what_was_reached_while_no_gateway_was_there_is_reached(plugged):
    await plugged.send("a", x=50.0, y=40.0)
    assert read(plugged) == ["SetPosEnd"]
    for x, v in ((40.0, 1.0), (50.0, 0.0), (60.0, 1.0)):
        plugged.ask("r1", SendPos(x, 40.0, 0.0, v))
    await restart_later(plugged)
    await plugged.link.poll()
    assert await plugged.states() == {"a": "reached"}


async def fail_to_finish(yard, monkeypatch):
    """Let the gateway deal with what waits, and fail before it is gone from RR."""
    write_relaxed = yard.database.write_relaxed

    async def fail(work, *arguments):
        if work is finish_requests:
            raise StoreError("the server is away")
        return await write_relaxed(work, *arguments)

    monkeypatch.setattr(yard.database, "write_relaxed", fail)
    with pytest.raises(StoreError):
        await yard.link.poll()
    monkeypatch.undo()


@pytest.mark.parametrize("restarts", [True, False])
async def test_a_robot_that_stood_before_it_was_told_to_abort_does_not_stand_for_that(
    plugged, monkeypatch, restarts
):
    await plugged.send("a", x=50.0, y=40.0)
    read(plugged)
    await plugged.link.poll()
    await plugged.fleet.orders.abort(AbortTask("command-x", robot="r1"), "Ada")
    # It stood, drove on, and was told to abort: so stands it in RR.
    plugged.ask("r1", SendPos(30.0, 40.0, 0.0, 0.0))
    plugged.ask("r1", SendPos(31.0, 40.0, 0.0, 1.0))
    assert read(plugged) == [Abort.__name__]
    plugged.ask("r1", SendPos(32.0, 40.0, 0.0, 0.9))
    await fail_to_finish(plugged, monkeypatch)
    assert (await plugged.states())["x"] == "acknowledged"
    if restarts:
        await plugged.restart()
    await plugged.link.poll()
    assert plugged.sql("select id from rr") == []
    assert (await plugged.states())["x"] == "acknowledged"
    plugged.ask("r1", SendPos(32.5, 40.0, 0.0, 0.0))
    await plugged.link.poll()
    assert (await plugged.states())["x"] == "reached"


async def test_what_cannot_be_understood_of_the_backlog_holds_up_nothing(plugged):
    await plugged.restart()
    for params in ("", "[]", "{", '{"id": "x"}', '{"id": null}', None):
        plugged.sql("insert into rr (robot, op, params) values ('r1', 'OpAck', ?)", params)
    await plugged.link.poll()
    assert plugged.sql("select id from rr") == []
