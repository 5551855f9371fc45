"""A command that ended while its message was on its way: the log says that the robot had read it."""

from __future__ import annotations

import asyncio

import pytest

from robot_bridge.core.errors import StoreError
from robot_bridge.core.messages.commands import AbortTask

READ = "the robot had read it by then, and acknowledged it"


@pytest.fixture
async def overtaken(yard):
    """A yard whose robot has read a target that was aborted before the gateway knew; the target's message."""
    await yard.ready()
    await yard.acknowledge_all()
    await yard.send("a")
    (row,) = await yard.fleet.outboxes.outbox("r1", 0)
    await yard.fleet.orders.abort(AbortTask("command-x", robot="r1"), "Bob")
    assert await yard.reason("a") == "before the robot acknowledged it"
    yard.reported.clear()
    return row.id


async def test_the_log_of_an_aborted_command_says_that_the_robot_had_read_it(yard, overtaken):
    await yard.ack(overtaken)
    assert await yard.steps("a") == ["queued", "aborted", "aborted"]
    assert await yard.reason("a") == READ
    assert yard.reported == [("command-a", "aborted")]
    assert yard.waiting() == ["Abort"]


async def test_it_says_so_once_and_after_a_restart_too(yard, overtaken):
    await yard.restart()
    for _ in range(2):
        await yard.ack(overtaken)
    assert await yard.steps("a") == ["queued", "aborted", "aborted"]


async def test_it_says_so_only_when_the_robot_took_it_on_and_is_the_one(yard, overtaken):
    await yard.ready("r2")
    await yard.ack(overtaken, "r2")
    await yard.ack(overtaken, ok=False, reason="battery empty")
    assert await yard.steps("a") == ["queued", "aborted"]


async def test_a_command_that_was_acknowledged_in_time_gets_no_such_line(yard):
    await yard.ready()
    await yard.acknowledge_all()
    await yard.send("a")
    (row,) = await yard.deliver()
    await yard.ack(row.id)
    await yard.at(50.0, 40.0)
    await yard.ack(row.id)
    assert await yard.steps("a") == ["queued", "delivered", "acknowledged", "reached"]


async def test_a_delivery_is_nothing_new_when_the_command_has_gone_further_meanwhile(yard):
    await yard.ready()
    await yard.acknowledge_all()
    await yard.send("a")
    (row,) = await yard.fleet.outboxes.outbox("r1", 0)
    noting = asyncio.create_task(yard.fleet.outboxes.delivered([row.id]))
    await asyncio.sleep(0)
    # What was under way for the same robot ends in this very moment.
    yard.fleet._commands._open.remove("command-a")
    await noting
    assert await yard.steps("a") == ["queued"]


async def test_it_says_so_when_the_database_is_back(yard, overtaken):
    yard.client.break_table("command_steps")
    with pytest.raises(StoreError):
        await yard.ack(overtaken)
    yard.client.mend_table("command_steps")
    await yard.fleet.save()
    assert await yard.steps("a") == ["queued", "aborted", "aborted"]
    await yard.fleet.save()
    assert yard.reported == [("command-a", "aborted")]
