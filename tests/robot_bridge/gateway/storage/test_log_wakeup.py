"""A gateway on SQLite asks its database for new rows when its log was written to, and does not otherwise."""

from __future__ import annotations

import asyncio
import math
import os
import sqlite3
import time
from itertools import pairwise

import pytest
from sqlalchemy import func, insert, select

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
def reports_alone(monkeypatch):
    """Nobody has asked for a while: the system's reports alone end the waiting once the log is silent."""
    monkeypatch.setattr(wakeups, "QUIET_AFTER_S", 0.0)
    monkeypatch.setattr(wakeups, "VISIBLE_AFTER_S", 3600.0)
    monkeypatch.setattr(wakeups, "FALLBACK_S", 3600.0)


async def until_silent(wakeup):
    """Let ``wakeup`` have the log watched, and the last write to it be long ago."""
    await asyncio.wait_for(wakeup.wait(found=False), 5 * BUSY)
    wakeup._reported_at = -math.inf


@pytest.fixture
async def silent(gateway, reports_alone):
    wakeup = gateway.wakeup("rr")
    await until_silent(wakeup)
    yield wakeup
    await wakeup.close()


@pytest.fixture
async def silent_log(tmp_path, reports_alone):
    """A log that no SQLite writes to, and what waits for writes to it."""
    log = tmp_path / "fleet.db-wal"
    log.write_bytes(b"one")
    wakeup = wakeups.LogWakeup(log)
    await until_silent(wakeup)
    yield log, wakeup
    await wakeup.close()


async def test_the_system_tells_of_a_write_where_nobody_has_asked_for_a_while(
    silent, sqlite_url, monkeypatch
):
    monkeypatch.setattr(wakeups.LogWakeup, "_state", lambda _: pytest.fail("the log was polled"))
    waiting = asyncio.ensure_future(silent.wait(found=False))
    assert await is_waiting(waiting)
    robot = Database(sqlite_url)
    await robot.run(ask)
    await asyncio.wait_for(waiting, 5 * BUSY)
    await robot.close()


async def test_what_is_written_while_it_looks_ends_the_next_wait(silent, sqlite_url):
    robot = Database(sqlite_url)
    await robot.run(ask)
    await asyncio.wait_for(silent.wait(found=False), 5 * BUSY)
    await robot.close()


async def test_a_commit_is_seen_that_is_visible_long_after_its_write(silent_log):
    """SQLite syncs the log in between, which takes long on some disks; of the commit there is no report."""
    log, wakeup = silent_log
    waiting = asyncio.ensure_future(wakeup.wait(found=False))
    assert await is_waiting(waiting)
    log.write_bytes(b"one, two")
    await asyncio.wait_for(waiting, 5 * BUSY)
    for _ in range(20):  # looks at the tables, without a row
        await asyncio.wait_for(wakeup.wait(found=False), 5 * BUSY)


class OneReport(wakeups.FileEvents):
    """Reports one write, to who waits for it."""

    def is_of(self, path):
        return True

    async def wait(self, seconds):
        return True

    def read(self):
        return False


async def test_the_looks_after_a_report_come_at_once_and_then_less_and_less_often(silent_log, monkeypatch):
    _, wakeup = silent_log
    wakeup._events.close()
    wakeup._events = OneReport(os.open(os.devnull, os.O_RDONLY), (0, 0))
    began = now = time.monotonic()

    async def sleep(seconds):
        nonlocal now
        now += seconds

    monkeypatch.setattr(wakeups.time, "monotonic", lambda: now)
    monkeypatch.setattr(wakeups.asyncio, "sleep", sleep)
    looks = []
    for _ in range(20):
        await wakeup.wait(found=False)
        looks.append(now - began)
    monkeypatch.undo()
    assert looks[0] == 0.0 and looks[1] < 0.002 and looks[-1] > 1.0
    for earlier, later in pairwise(looks):
        most = wakeups.SELDOM_S if earlier < 0.35 else wakeups.UNSEEN_S + wakeups.SELDOM_S
        assert later - earlier <= min(2 * earlier, most) + 0.001


async def test_a_long_silence_after_the_last_report_ends_the_polling(silent_log, monkeypatch):
    log, wakeup = silent_log
    log.write_bytes(b"one, two")
    await asyncio.wait_for(wakeup.wait(found=False), 5 * BUSY)
    monkeypatch.setattr(wakeups, "VISIBLE_AFTER_S", 0.0)
    waiting = asyncio.ensure_future(wakeup.wait(found=False))
    assert await is_waiting(waiting, 0.5)
    waiting.cancel()


async def test_a_commit_is_reported_whose_rows_were_written_to_the_log_long_before(silent, gateway):
    robot = sqlite3.connect(gateway.url.database, isolation_level=None)
    robot.executescript("pragma synchronous = full; pragma cache_size = 1; begin immediate")
    robot.executemany("insert into rr (robot, op, params) values ('r1', 'Alive', ?)", 100 * [("x" * 4000,)])
    await asyncio.wait_for(silent.wait(found=False), 5 * BUSY)
    await until_silent(silent)
    waiting = asyncio.ensure_future(silent.wait(found=False))
    assert await is_waiting(waiting)
    robot.execute("commit")
    await asyncio.wait_for(waiting, 5 * BUSY)
    assert (
        await gateway.read(lambda connection: connection.scalar(select(func.count()).select_from(rr))) == 100
    )
    robot.close()


async def test_a_write_is_reported_after_a_checkpoint_that_truncates_the_log(silent, gateway):
    robot = sqlite3.connect(gateway.url.database, isolation_level=None)
    robot.execute("insert into rr (robot, op, params) values ('r1', 'Alive', '{}')")
    assert robot.execute("pragma wal_checkpoint(truncate)").fetchone()[0] == 0
    await until_silent(silent)
    waiting = asyncio.ensure_future(silent.wait(found=False))
    assert await is_waiting(waiting)
    robot.execute("insert into rr (robot, op, params) values ('r1', 'Alive', '{}')")
    await asyncio.wait_for(waiting, 5 * BUSY)
    robot.close()


async def test_another_log_in_place_of_the_first_is_looked_at_and_watched(silent_log, tmp_path):
    log, wakeup = silent_log
    waiting = asyncio.ensure_future(wakeup.wait(found=False))
    assert await is_waiting(waiting)
    (tmp_path / "new").write_bytes(b"two")
    (tmp_path / "new").rename(log)
    await asyncio.wait_for(waiting, 5 * BUSY)
    await until_silent(wakeup)
    waiting = asyncio.ensure_future(wakeup.wait(found=False))
    assert await is_waiting(waiting)
    log.write_bytes(b"three")
    await asyncio.wait_for(waiting, 5 * BUSY)


@pytest.mark.parametrize("moved", [False, True])
async def test_a_log_that_is_removed_is_polled_for(silent_log, tmp_path, moved):
    log, wakeup = silent_log
    waiting = asyncio.ensure_future(wakeup.wait(found=False))
    assert await is_waiting(waiting)
    with log.open("rb"):
        if moved:
            log.rename(tmp_path / "elsewhere")
        else:
            log.unlink()
        await asyncio.wait_for(waiting, 5 * BUSY)
    for _ in range(3):
        await asyncio.wait_for(wakeup.wait(found=False), 5 * BUSY)


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
