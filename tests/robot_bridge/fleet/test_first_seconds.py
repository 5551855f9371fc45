"""What a gateway goes by in its first seconds: robots have driven on since what is stored of them."""

from __future__ import annotations

import pytest

from robot_bridge.commanding.writing import write_again
from robot_bridge.errors import StoreError

PATH = [(20.0, 40.0), (40.0, 40.0), (40.0, 60.0)]


async def test_a_path_that_was_driven_before_its_acknowledgement_came_is_reached(roads):
    await roads.ready()
    await roads.take()
    await roads.at(*PATH[0])
    await roads.fleet.save()
    await roads.send("a", "SetPath", points=PATH)
    (row,) = await roads.deliver()
    await roads.restart()
    await roads.ready()
    await roads.at(*PATH[-1])
    await roads.ack(row.id)
    assert (await roads.states())["a"] == "acknowledged"
    await roads.at(*PATH[-1])
    assert (await roads.states())["a"] == "reached"


async def test_a_path_that_was_driven_while_the_link_was_broken_is_reached(roads):
    await roads.ready()
    await roads.take()
    await roads.at(*PATH[0])
    await roads.send("a", "SetPath", points=PATH)
    (row,) = await roads.deliver()
    await roads.ready()
    await roads.at(*PATH[-1])
    await roads.ack(row.id)
    await roads.at(*PATH[-1])
    assert (await roads.states())["a"] == "reached"


async def test_a_path_that_was_driven_although_its_delivery_was_not_noted_is_reached(roads):
    await roads.ready()
    await roads.take()
    await roads.at(*PATH[0])
    await roads.fleet.save()
    await roads.send("a", "SetPath", points=PATH)
    assert [row.op for row in await roads.fleet.outbox("r1", 0)] == ["SetPath"]
    await roads.restart()
    await roads.ready()
    await roads.at(*PATH[1])
    assert await roads.take() == ["SetPath", "SetMap"]
    await roads.at(*PATH[-1])
    assert (await roads.states())["a"] == "reached"


@pytest.mark.parametrize("restarts", [True, False], ids=["the gateway restarts", "the database is back"])
async def test_a_robot_that_starts_anew_while_the_database_fails_is_sent_its_task_again(
    roads, monkeypatch, restarts
):
    await roads.ready(magic=1)
    await roads.take()
    await roads.send("a")
    await roads.take()
    run = roads.database.run

    async def fail(work, *arguments):
        if work is write_again:
            raise StoreError("the disk is full")
        return await run(work, *arguments)

    monkeypatch.setattr(roads.database, "run", fail)
    with pytest.raises(StoreError):
        await roads.ready(magic=2)
    await roads.fleet.save()
    monkeypatch.undo()
    if restarts:
        await roads.restart()
    await roads.ready(magic=2)
    assert "SetPosEnd" in await roads.take()
    assert await roads.steps("a") == ["queued", "delivered", "acknowledged", "acknowledged", "acknowledged"]
