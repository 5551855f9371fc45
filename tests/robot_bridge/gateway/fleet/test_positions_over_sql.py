"""A position that a robot wrote into RR is stored when its row goes, however long the row had waited."""

from __future__ import annotations

import asyncio
import json
import threading

import pytest

from robot_bridge.core.errors import StoreError
from robot_bridge.core.messages.robots import Ready, SendPos


@pytest.fixture
async def plugged(yard):
    """A yard with robot r1 on SQL."""
    yard.ask("r1", Ready(1))
    await yard.link.poll()
    return yard


def places(yard):
    return [x for (x,) in yard.sql("select x from trajectories order by id")]


async def test_positions_are_stored_with_their_requests_gone_and_not_later(plugged):
    for x in (1.0, 2.0):
        plugged.ask("r1", SendPos(x, 0.0, 0.0, 1.0))
        plugged.now += 1
        await plugged.link.poll()
    assert plugged.sql("select id from rr") == []
    assert places(plugged) == [1.0, 2.0]


async def test_positions_that_cannot_be_stored_stay_in_rr_and_are_stored_once_when_they_can(plugged):
    plugged.ask("r1", SendPos(1.0, 0.0, 0.0, 1.0))
    plugged.client.break_table("trajectories")
    with pytest.raises(StoreError):
        await plugged.link.poll()
    assert plugged.sql("select op from rr") == [("SendPos",)]
    plugged.client.mend_table("trajectories")
    plugged.now += 1
    await plugged.link.poll()
    await plugged.fleet.save()
    assert plugged.sql("select id from rr") == []
    assert set(places(plugged)) == {1.0}


async def test_positions_that_are_dealt_with_again_after_a_kill_are_stored_though_a_newer_one_was_known(
    plugged,
):
    for t in (1.0, 2.0):
        plugged.ask("r1", SendPos(t, 0.0, 0.0, 1.0, t=t))
    rows = await plugged.fleet.outboxes.read_requests("sql")
    await plugged.link._deal_with_robot(rows)
    # Killed before its rows were gone, and after what robots said was stored.
    await plugged.fleet.save()
    await plugged.restart()
    await plugged.link.poll()
    assert plugged.sql("select id from rr") == []
    assert set(places(plugged)) == {1.0, 2.0}


async def test_a_pose_is_stored_as_it_was_when_its_track_was(plugged):
    plugged.ask("r1", SendPos(1.0, 0.0, 0.0, 1.0, t=1.0))
    await plugged.link.poll()
    began, go = threading.Event(), threading.Event()

    def hold(_connection):
        began.set()
        go.wait(20)

    busy = asyncio.create_task(plugged.fleet.database.run(hold))
    # What comes before the database has begun is done with it as one piece of work.
    assert await asyncio.to_thread(began.wait, 20)
    saving = asyncio.create_task(plugged.fleet.save())
    async with asyncio.timeout(20):
        while not plugged.fleet.database.waiting:
            await asyncio.sleep(0.001)
    await plugged.fleet.receive("r1", "sql", SendPos(2.0, 0.0, 0.0, 1.0, t=2.0), None)
    go.set()
    await asyncio.gather(busy, saving)
    assert max(places(plugged)) == 1.0
    ((pose,),) = plugged.sql("select pose from robots where name = 'r1'")
    assert json.loads(pose)["x"] == 1.0
