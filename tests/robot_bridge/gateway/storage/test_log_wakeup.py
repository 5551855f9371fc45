"""A gateway on SQLite asks its database for new rows when its log was written to, and does not otherwise."""

from __future__ import annotations

import asyncio
import time

import pytest
from sqlalchemy import insert

from robot_bridge.gateway.storage import wakeups
from robot_bridge.gateway.storage.database import Database
from robot_bridge.gateway.storage.schema import rr
from tests.support.patience import BUSY


@pytest.fixture
async def gateway(sqlite_url):
    database = Database(sqlite_url)
    await database.open()
    yield database
    await database.close()


@pytest.fixture
async def wakeup(gateway, monkeypatch):
    """One that saw the log as it is, and of which nothing but a write ends the waiting."""
    monkeypatch.setattr(wakeups, "UNSEEN_S", 3600.0)
    wakeup = gateway.wakeup("rr")
    await wakeup.wait(found=False)
    return wakeup


def ask(connection):
    connection.execute(insert(rr).values(robot="r1", op="Alive"))


async def is_waiting(waiting, seconds=0.2):
    """Tell whether ``waiting`` goes on for some more looks at the log."""
    await asyncio.wait([waiting], timeout=seconds)
    return not waiting.done()


async def test_it_waits_until_another_program_writes(wakeup, sqlite_url):
    waiting = asyncio.ensure_future(wakeup.wait(found=False))
    assert await is_waiting(waiting)
    robot = Database(sqlite_url)
    await robot.run(ask)
    await asyncio.wait_for(waiting, 5 * BUSY)
    await robot.close()


async def test_it_does_not_wait_where_somebody_wrote_since_it_began_to_look(wakeup, sqlite_url):
    robot = Database(sqlite_url)
    await robot.run(ask)
    await asyncio.wait_for(wakeup.wait(found=False), 5 * BUSY)
    await robot.close()


async def test_it_looks_again_at_once_where_there_was_something(wakeup):
    await asyncio.wait_for(wakeup.wait(found=True), 5 * BUSY)


async def test_it_looks_at_the_tables_after_a_while_whatever_the_log_shows(wakeup, monkeypatch):
    monkeypatch.setattr(wakeups, "UNSEEN_S", 0.25)
    began = time.monotonic()
    await asyncio.wait_for(wakeup.wait(found=False), 5 * BUSY)
    assert time.monotonic() - began >= 0.25


@pytest.fixture
async def quiet(gateway, monkeypatch):
    """One that the system tells of writes, since nobody has asked for a while; nothing else wakes it."""
    monkeypatch.setattr(wakeups, "QUIET_AFTER_S", 0.0)
    monkeypatch.setattr(wakeups, "FALLBACK_S", 3600.0)
    monkeypatch.setattr(wakeups.LogWakeup, "_state", lambda _: pytest.fail("the log was polled"))
    wakeup = gateway.wakeup("rr")
    # What was written before the system watched is found by the first look.
    await asyncio.wait_for(wakeup.wait(found=False), 5 * BUSY)
    yield wakeup
    await wakeup.close()


async def test_the_system_tells_of_a_write_where_nobody_has_asked_for_a_while(quiet, sqlite_url):
    waiting = asyncio.ensure_future(quiet.wait(found=False))
    assert await is_waiting(waiting)
    robot = Database(sqlite_url)
    await robot.run(ask)
    await asyncio.wait_for(waiting, 5 * BUSY)
    await robot.close()


async def test_what_is_written_while_it_looks_ends_the_next_wait(quiet, sqlite_url):
    robot = Database(sqlite_url)
    await robot.run(ask)
    await asyncio.wait_for(quiet.wait(found=False), 5 * BUSY)
    await robot.close()


async def test_another_log_in_place_of_the_first_is_looked_at_and_watched(tmp_path, monkeypatch):
    monkeypatch.setattr(wakeups, "QUIET_AFTER_S", 0.0)
    monkeypatch.setattr(wakeups, "FALLBACK_S", 3600.0)
    log = tmp_path / "fleet.db-wal"
    log.write_bytes(b"one")
    wakeup = wakeups.LogWakeup(log)
    await wakeup.wait(found=False)
    (tmp_path / "new").write_bytes(b"two")
    (tmp_path / "new").rename(log)
    await asyncio.wait_for(wakeup.wait(found=False), 5 * BUSY)
    waiting = asyncio.ensure_future(wakeup.wait(found=False))
    assert await is_waiting(waiting)
    log.write_bytes(b"three")
    await asyncio.wait_for(waiting, 5 * BUSY)
    await wakeup.close()


async def test_without_a_log_it_looks_at_the_tables_again_and_again(tmp_path):
    wakeup = wakeups.LogWakeup(tmp_path / "none-wal")
    for _ in range(20):
        await asyncio.wait_for(wakeup.wait(found=False), 5 * BUSY)


async def test_it_looks_less_often_where_nobody_has_asked_for_a_while(monkeypatch):
    """A gateway whose robots are all on WebSocket has nothing to find."""
    pauses = []

    async def sleep(seconds):
        pauses.append(seconds)

    monkeypatch.setattr(wakeups.asyncio, "sleep", sleep)
    wakeup = wakeups.PollingWakeup()
    for _ in range(20):
        await wakeup.wait(found=False)
    assert pauses[-1] == wakeups.LONGEST_S
    monkeypatch.setattr(wakeups, "QUIET_AFTER_S", 0.0)
    for _ in range(5):
        await wakeup.wait(found=False)
    assert pauses[-1] == wakeups.SELDOM_S
    monkeypatch.undo()
    monkeypatch.setattr(wakeups.asyncio, "sleep", sleep)
    await wakeup.wait(found=True)
    await wakeup.wait(found=False)
    assert pauses[-2] == wakeups.SHORTEST_S and pauses[-1] == 2 * wakeups.SHORTEST_S
