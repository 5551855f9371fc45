"""What was sent over WebSocket is delivered, wherever the gateway is killed: the robot may be doing it."""

from __future__ import annotations

import asyncio
import json

import pytest

from robot_bridge.core.clock import steady_time
from robot_bridge.core.errors import StoreError, UncertainError
from robot_bridge.core.messages.commands import AbortTask
from robot_bridge.core.messages.safety import EmergencyStop
from robot_bridge.gateway.api import delivery
from robot_bridge.gateway.api.delivery import Delivery
from robot_bridge.gateway.api.robot_session import RobotChannel
from robot_bridge.gateway.commands import service
from robot_bridge.gateway.commands.persistence import write_steps
from robot_bridge.gateway.storage.repositories.robots import CHECK_VALID_S
from tests.support.bridge.queue_line import PLACES, placed, task

CONE = PLACES["a"]


class Wire:
    """A connection of which the gateway is killed with the first message in it that makes a robot drive.

    ``sent`` are the methods of the messages, each with the states of all commands as they were stored then.
    """

    def __init__(self, yard):
        self.sent = []
        self.is_cut = asyncio.Event()
        self._yard = yard

    def write_at_once(self, _frame):
        return False

    is_busy = False

    async def cut_if_busy(self):
        """No message is long here."""

    async def send(self, frame):
        method = json.loads(frame)["method"]
        self.sent.append(
            (method, [state for (state,) in self._yard.sql("select state from commands order by sa_id")])
        )
        if method == "SetPosEnd":
            self.is_cut.set()
            await asyncio.Event().wait()


@pytest.fixture
async def wire(line):
    """Robot r1's wire, on which its outbox goes out once its ``delivery`` begins."""
    wire = Wire(line.yard)
    wire.delivery = Delivery(line.yard.fleet, RobotChannel(wire), "r1")
    yield wire
    wire.delivery.end()


async def kill_while_sending(line, wire):
    """Let the gateway send r1 what waits, and be killed with that on its way; start another one."""
    wire.delivery.begin()
    async with asyncio.timeout(60):
        await wire.is_cut.wait()
    wire.delivery.end()
    await line.yard.restart()


async def abort(yard):
    await yard.fleet.orders.abort(AbortTask("command-abort", robot="r1"), "Ada")


async def stop(yard):
    await yard.fleet.emergency.stop(EmergencyStop("stop-0001"), "Ada")


async def expire(yard):
    yard.now += 1000.0
    await yard.fleet.save()


@pytest.mark.parametrize("order", [abort, stop, expire])
async def test_a_target_that_the_robot_may_have_stays_open_until_it_answers(line, wire, order):
    await line.yard.send("target")
    await kill_while_sending(line, wire)
    await order(line.yard)
    assert (await line.yard.states())["target"] == "delivered"


async def test_a_cone_that_was_put_down_while_no_gateway_ran_is_put_down_once(line, wire):
    yard = line.yard
    await line.set(task("a", "place"))
    await kill_while_sending(line, wire)
    await line.advance()
    # The operator is quicker than the robot's way back.
    await abort(yard)
    await yard.ready()
    for row in await yard.deliver():
        if row.op == "Abort":
            await yard.at(*CONE)
        await yard.ack(row.id)
    await line.advance()
    assert len(await placed(line)) == 1
    assert await line.states() == {"a": "done"}


async def test_what_is_taken_back_while_its_delivery_is_to_be_noted_is_not_sent(line):
    await line.yard.send("target")
    (row,) = await line.yard.fleet.outboxes.outbox("r1", 0)
    aborting = asyncio.ensure_future(abort(line.yard))
    for _ in range(5):  # until it holds the robot
        await asyncio.sleep(0)
    may_be_sent = await line.yard.fleet.outboxes.mark_sending("r1", row.id)
    await aborting
    assert (await line.yard.states())["target"] == "aborted"
    assert not may_be_sent


async def test_what_is_no_commands_message_is_sent_as_it_is(line):
    await line.yard.ready()
    (row,) = await line.yard.fleet.outboxes.outbox("r1", 0)
    assert row.op == "SetMap"
    assert await line.yard.fleet.outboxes.mark_sending("r1", row.id)


@pytest.mark.parametrize(
    ("done", "error"), [(False, StoreError), (False, UncertainError), (True, UncertainError)]
)
async def test_a_target_is_sent_when_its_delivery_is_noted_however_often_that_fails(
    line, wire, lose, monkeypatch, done, error
):
    monkeypatch.setattr(delivery, "RETRY_AFTER", 0.0)
    await line.yard.send("target")
    lose(line.yard, write_steps, done=done, error=error)
    wire.delivery.begin()
    async with asyncio.timeout(60):
        await wire.is_cut.wait()
    assert wire.sent == [("SetPosEnd", ["delivered"])]
    assert await line.yard.steps("target") == ["queued", "delivered"]


@pytest.mark.parametrize("error", [None, StoreError])
async def test_an_abort_waits_neither_until_it_is_noted_nor_for_what_is_before_it(
    line, wire, lose, monkeypatch, error
):
    monkeypatch.setattr(delivery, "RETRY_AFTER", 0.0)
    await line.yard.send("place", "SetPosIni", x=20.0, y=40.0)
    await abort(line.yard)
    if error is not None:
        lose(line.yard, write_steps, done=False, error=error)
    wire.delivery.begin()
    async with asyncio.timeout(60):
        while len(wire.sent) < 2:
            await asyncio.sleep(0.01)
    assert [method for method, _ in wire.sent] == ["Abort", "SetPosIni"]
    assert wire.sent[0][1] == ["queued", "queued"]


async def test_an_emergency_stop_that_comes_while_a_delivery_is_noted_keeps_it_from_being_sent(
    line, wire, monkeypatch
):
    fleet, outboxes = line.yard.fleet, line.yard.fleet.outboxes
    hand_over = outboxes.mark_sending
    fleet.emergency.reach(wire.delivery.stop_now)

    async def stopped_meanwhile(robot, id):
        is_due = await hand_over(robot, id)
        await stop(line.yard)
        return is_due

    monkeypatch.setattr(outboxes, "mark_sending", stopped_meanwhile)
    await line.yard.send("target")
    wire.delivery.begin()
    async with asyncio.timeout(60):
        while list((await line.yard.states()).values()).count("delivered") < 2:
            await asyncio.sleep(0.01)
    assert [method for method, _ in wire.sent] == ["Abort", "Abort"]


async def test_a_target_is_checked_again_when_the_gateway_stood_still_before_it_was_sent(
    line, wire, monkeypatch
):
    hand_over, checked = line.yard.fleet.outboxes.mark_sending, []

    async def standing_still(robot, id):
        is_due = await hand_over(robot, id)
        checked.append((is_due, len(wire.sent)))
        stood_for = 2 * CHECK_VALID_S if len(checked) == 1 else 0.0
        monkeypatch.setattr(service, "steady_time", lambda: steady_time() + stood_for)
        return is_due

    await line.yard.send("target")
    monkeypatch.setattr(line.yard.fleet.outboxes, "mark_sending", standing_still)
    wire.delivery.begin()
    async with asyncio.timeout(60):
        await wire.is_cut.wait()
    assert checked == [(True, 0), (True, 0)] and len(wire.sent) == 1
