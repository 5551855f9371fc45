"""A robot has its map before anything sets it in motion, whatever was open when it said Ready."""

from __future__ import annotations

import pytest

from robot_bridge.core.errors import StoreError
from robot_bridge.core.messages.commands import SendMap
from robot_bridge.core.messages.robots import GetPath, OpAck, Ready, SendPos


async def say(yard, *requests, robot="r1"):
    for request in requests:
        yard.ask(robot, request)
    await yard.link.poll()


async def read_all(yard):
    """Let the robot read and acknowledge all that waits for it over SQL; return the operation codes."""
    rows = yard.sql("select id, op from sa where robot = 'r1' order by urgent desc, id")
    yard.sql("delete from sa where robot = 'r1'")
    await say(yard, *(OpAck(id=id) for id, op in rows if op != "OpAck"))
    return [op for _, op in rows]


@pytest.fixture
async def working(yard):
    """Robot r1 on SQL, under way to its target."""
    await say(yard, Ready(1), SendPos(20.0, 8.0, 0.0, 0.0))
    await read_all(yard)
    await yard.send("a")
    await read_all(yard)
    assert (await yard.states())["a"] == "acknowledged"
    yard.now += 5
    return yard


async def test_over_sql_the_map_comes_before_the_task_that_is_sent_again(working):
    await say(working, Ready(2))
    assert await read_all(working) == ["OpAck", "SetMap", "SetPosEnd"]
    assert (await working.states())["a"] == "acknowledged"


async def test_over_websocket_it_does_too(yard):
    await yard.ready(magic=1)
    await yard.acknowledge_all()
    await yard.send("a")
    await yard.acknowledge_all()
    await yard.ready(magic=2)
    assert await yard.acknowledge_all() == ["SetMap", "SetPosEnd"]
    assert (await yard.states())["a"] == "acknowledged"


async def test_a_task_that_was_never_fetched_waits_behind_the_map(working):
    await read_all(working)
    await working.send("b", x=60.0)
    await say(working, Ready(2))
    assert await read_all(working) == ["OpAck", "SetMap", "SetPosEnd"]
    assert await working.steps("b") == ["queued", "queued", "delivered", "acknowledged"]


async def test_an_abort_behind_a_task_stays_behind_it(working):
    await working.send("b", "SetPosIni", x=20.0, y=8.0)
    await working.send("c", "Abort")
    await say(working, Ready(2))
    assert await read_all(working) == ["OpAck", "SetMap", "SetPosIni", "Abort"]


async def test_a_path_that_its_former_run_asked_for_is_gone(working):
    await say(working, SendPos(20.0, 8.0, 0.0, 0.0), GetPath())
    assert working.waiting() == ["OpAck", "SetPath"]
    working.now += 5
    await say(working, Ready(2))
    assert await read_all(working) == ["OpAck", "SetMap", "SetPosEnd"]


async def test_a_robot_that_did_not_read_its_map_still_gets_it_first(working):
    await say(working, Ready(2))
    await say(working, Ready(2))
    await working.fleet.maps.send_requested(SendMap("r1"))
    ops = await read_all(working)
    assert ops.index("SetMap") < ops.index("SetPosEnd")
    assert ops.count("SetMap") == 2
    assert (await working.states())["a"] == "acknowledged"


async def test_nor_does_a_gateway_that_dies_while_it_lets_the_robot_in_change_that(working, monkeypatch):
    async def die(*_arguments, **_options):
        raise StoreError("the gateway is gone")

    monkeypatch.setattr(working.fleet.outboxes, "finish", die)
    with pytest.raises(StoreError):
        await say(working, Ready(2))
    monkeypatch.undo()
    await working.restart()
    await working.link.poll()
    ops = await read_all(working)
    assert ops.index("SetMap") < ops.index("SetPosEnd")
    assert ops.count("SetPosEnd") == 1
