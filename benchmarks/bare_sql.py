"""What little can answer robots on SQL: a loop on one connection, with the gateway's drivers.

``python -m benchmarks.bare_sql URL GATHER`` pauses for GATHER seconds, reads requests, writes an OpAck for
each (and an empty map for Ready) and deletes them, in one transaction that waits for the disk no more than
the gateway's does. It checks nothing and keeps nothing.
"""

from __future__ import annotations

import sqlite3
import sys
import time
from abc import ABC, abstractmethod
from collections.abc import Sequence
from typing import Any
from urllib.parse import urlsplit

from benchmarks.sql_robots import Ear, where
from robot_bridge.gateway.storage.dialects import NOTIFICATIONS_LOCK
from robot_bridge.gateway.storage.wakeups import LONGEST_S, SHORTEST_S

READ = "select id, robot, op, params from rr order by id limit 500"
ADD = "insert into sa (robot, op, params, urgent) values (%s, %s, %s, 0)"


class Server(ABC):
    """One connection."""

    def __init__(self, url: str, gather: float) -> None:
        self.connection = self.connect(url)
        self.gather = gather
        self.pause = SHORTEST_S

    def serve(self) -> None:
        """Answer until killed."""
        while True:
            found = self.look() or self.look_before_sleep()
            self.wait(found)
            if self.gather:
                time.sleep(self.gather)

    def look(self) -> bool:
        """Answer what is there; return false if nothing is."""
        rows = self.read()
        if rows:
            ids = [row[0] for row in rows]
            self.answer([answer for row in rows for answer in _answers(*row)], ids)
        return bool(rows)

    def look_before_sleep(self) -> bool:
        """Look once more where something can be missed while nobody looks."""
        return False

    def wait(self, found: bool) -> None:
        """Look again at once where there was something, else less and less often."""
        self.pause = SHORTEST_S if found else min(2 * self.pause, LONGEST_S)
        time.sleep(self.pause)

    @abstractmethod
    def connect(self, url: str) -> Any:
        """Return a connection."""

    @abstractmethod
    def read(self) -> Sequence[tuple[Any, ...]]:
        """Return the oldest requests."""

    @abstractmethod
    def answer(self, rows: list[tuple[str, str, str]], ids: list[int]) -> None:
        """Write answers and delete requests in one transaction."""


class SQLite(Server):
    """Asks for rows only where another connection wrote."""

    def connect(self, url: str) -> Any:
        connection = sqlite3.connect(url.removeprefix("sqlite:///"), timeout=10, isolation_level=None)
        connection.execute("pragma synchronous = normal")
        self.seen = -1
        return connection

    def read(self) -> Sequence[tuple[Any, ...]]:
        version = self.connection.execute("pragma data_version").fetchone()[0]
        if version == self.seen:
            return []
        self.seen = version
        return list(self.connection.execute(READ))

    def answer(self, rows: list[tuple[str, str, str]], ids: list[int]) -> None:
        self.connection.execute("begin immediate")
        self.connection.executemany(ADD.replace("%s", "?"), rows)
        self.connection.executemany("delete from rr where id = ?", [(id,) for id in ids])
        self.connection.execute("commit")


class MariaDB(Server):
    """READ COMMITTED, as the gateway."""

    def connect(self, url: str) -> Any:
        import pymysql

        return pymysql.connect(
            **where(url),
            database=urlsplit(url).path[1:],
            autocommit=True,
            init_command="set session transaction isolation level read committed",
        )

    def read(self) -> Sequence[tuple[Any, ...]]:
        with self.connection.cursor() as cursor:
            cursor.execute(READ)
            return list(cursor.fetchall())

    def answer(self, rows: list[tuple[str, str, str]], ids: list[int]) -> None:
        with self.connection.cursor() as cursor:
            self.connection.begin()
            cursor.executemany(ADD, rows)
            cursor.execute("delete from rr where id in %s", (ids,))
            self.connection.commit()


class PostgreSQL(Server):
    """Is told by a notification."""

    def connect(self, url: str) -> Any:
        import psycopg

        options = "-c synchronous_commit=off"
        connection = psycopg.connect(
            **where(url), dbname=urlsplit(url).path[1:], autocommit=True, options=options
        )
        self.dozes = False
        self.ear = Ear(connection, "rr")
        return connection

    def read(self) -> Sequence[tuple[Any, ...]]:
        return list(self.connection.execute(READ).fetchall())

    def answer(self, rows: list[tuple[str, str, str]], ids: list[int]) -> None:
        with self.connection.pipeline():
            self.connection.cursor().executemany(ADD, rows)
            self.connection.execute("delete from rr where id = any(%s)", (ids,))

    def look_before_sleep(self) -> bool:
        """Have robots notify, which they do only while somebody dozes: their commits then wait in line."""
        lock = f"select pg_try_advisory_lock({NOTIFICATIONS_LOCK})"
        self.dozes = bool(self.connection.execute(lock).fetchone()[0])
        return self.dozes and self.look()

    def wait(self, found: bool) -> None:
        if not self.dozes:
            super().wait(found)
            return
        if not found:
            self.ear.wait()
        self.connection.execute(f"select pg_advisory_unlock({NOTIFICATIONS_LOCK})")
        self.dozes = False


KINDS: dict[str, type[Server]] = {"sqlite": SQLite, "postgresql": PostgreSQL, "mariadb": MariaDB}


def _answers(id: int, robot: str, op: str, _params: str | None) -> list[tuple[str, str, str]]:
    ack = (robot, "OpAck", f'{{"id": {id}, "ok": true}}')
    return [ack, (robot, "SetMap", "{}")] if op == "Ready" else [ack]


if __name__ == "__main__":
    server = KINDS[sys.argv[1].split(":")[0]](sys.argv[1], float(sys.argv[2]))
    print("answering", flush=True)
    server.serve()
