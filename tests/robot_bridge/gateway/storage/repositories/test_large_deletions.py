"""What is deleted from SQLite is given up, and not written over byte by byte while others wait."""

from __future__ import annotations

import contextlib
import os
import sqlite3

from robot_bridge.core.messages.robots import SetMap
from robot_bridge.gateway.storage.database import Database
from robot_bridge.gateway.storage.repositories import requests

MAP = os.urandom(3_000_000)


def empty_log(file):
    """Put all that waits in the log into the database."""
    with contextlib.closing(sqlite3.connect(file)) as connection:
        assert connection.execute("PRAGMA wal_checkpoint(TRUNCATE)").fetchone()[0] == 0


async def test_a_map_that_a_robot_has_acknowledged_costs_little_to_delete(tmp_path):
    database = Database(f"sqlite:///{tmp_path}/fleet.db")
    await database.open()
    try:
        id = await database.run(requests.add, "r1", SetMap(MAP))
        empty_log(tmp_path / "fleet.db")
        await database.run(requests.remove_own, [("r1", id)])
        assert await database.read(requests.read_answers, "r1") == []
        assert (tmp_path / "fleet.db-wal").stat().st_size < len(MAP) / 4
    finally:
        await database.close()
