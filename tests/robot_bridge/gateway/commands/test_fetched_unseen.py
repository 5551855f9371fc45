"""What a robot on SQL has fetched without the gateway having seen that is not taken back: it may be done."""

from __future__ import annotations

import pytest

from robot_bridge.core.messages.commands import AbortAll, AbortTask
from robot_bridge.core.messages.robots import OpAck, Ready, SendPos
from robot_bridge.core.messages.safety import EmergencyStop
from tests.support.bridge.queue_line import PLACES, placed, task

CONE = PLACES["a"]


async def abort(yard):
    await yard.fleet.orders.abort(AbortTask("command-abort", robot="r1"), "Ada")


async def abort_all(yard):
    await yard.fleet.orders.abort_all(AbortAll("command-all"), "Ada")


async def stop(yard):
    await yard.fleet.emergency.stop(EmergencyStop("stop-0001"), "Ada")


async def expire(yard):
    yard.now += 1000.0
    await yard.fleet.save()


@pytest.fixture
async def plugged(line):
    """The line's robot r1, on SQL, with nothing left to read."""
    line.yard.ask("r1", Ready(1))
    line.yard.ask("r1", SendPos(20.0, 40.0, 0.0, 0.0))
    await line.yard.link.poll()
    line.yard.sql("delete from sa")
    return line


def fetch(yard):
    """Let the robot read and delete its target; return the id of the message."""
    ((id,),) = yard.sql("select id from sa where robot = 'r1' and op = 'SetPosEnd'")
    yard.sql("delete from sa where id = ?", id)
    return id


@pytest.mark.parametrize("order", [abort, abort_all, stop, expire])
async def test_a_target_that_was_fetched_unseen_stays_open_until_the_robot_answers(plugged, order):
    yard = plugged.yard
    await yard.send("target")
    fetch(yard)
    await order(yard)
    assert (await yard.states())["target"] == "delivered"
    assert await yard.steps("target") == ["queued", "delivered"]
    assert ("command-target", "delivered") in yard.reported


@pytest.mark.parametrize("order", [abort, abort_all, stop, expire])
async def test_so_does_one_that_the_robot_has_acknowledged_and_not_deleted_yet(plugged, order):
    yard = plugged.yard
    await yard.send("target")
    ((id,),) = yard.sql("select id from sa where op = 'SetPosEnd'")
    yard.ask("r1", OpAck(id=id))
    await order(yard)
    assert (await yard.states())["target"] == "delivered"
    await yard.link.poll()
    assert (await yard.states())["target"] == "acknowledged"
    assert "SetPosEnd" not in yard.waiting()


async def test_what_another_robot_says_that_it_has_read_is_taken_back(plugged):
    yard = plugged.yard
    await yard.send("target")
    ((id,),) = yard.sql("select id from sa where op = 'SetPosEnd'")
    yard.ask("r2", OpAck(id=id))
    await expire(yard)
    assert (await yard.states())["target"] == "expired"


@pytest.mark.parametrize(
    ("order", "state"), [(abort, "aborted"), (abort_all, "aborted"), (stop, "aborted"), (expire, "expired")]
)
async def test_one_that_lies_there_yet_is_taken_back_at_once(plugged, order, state):
    yard = plugged.yard
    await yard.send("target")
    await order(yard)
    assert (await yard.states())["target"] == state
    assert "SetPosEnd" not in yard.waiting()


@pytest.mark.parametrize("order", [abort, stop])
async def test_a_cone_that_was_put_down_while_no_gateway_looked_is_put_down_once(plugged, order):
    yard = plugged.yard
    await plugged.set(task("a", "place"))
    fetched = fetch(yard)
    await yard.restart()
    await plugged.advance()
    # The operator is quicker than the gateway's first look at the tables.
    await order(yard)
    yard.ask("r1", OpAck(id=fetched))
    yard.ask("r1", SendPos(*CONE, 0.0, 0.0))
    await yard.link.poll()
    yard.ask("r1", SendPos(*CONE, 0.0, 0.0))
    await yard.link.poll()
    for (id,) in yard.sql("select id from sa where robot = 'r1' and op = 'Abort'"):
        yard.sql("delete from sa where id = ?", id)
        yard.ask("r1", OpAck(id=id))
    await yard.link.poll()
    await plugged.advance()
    assert len(await placed(plugged)) == 1
    assert await plugged.states() == {"a": "done"}
