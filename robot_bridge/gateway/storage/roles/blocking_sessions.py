"""Robots' sessions that block others: detected, ended, and their accounts suspended."""

from __future__ import annotations

import contextlib
import json
from collections.abc import Iterable, Sequence
from queue import Empty, SimpleQueue
from typing import TypeVar

from sqlalchemy import Connection, delete, insert, select, text
from sqlalchemy.exc import DBAPIError

from ....core.json_decoder import decode_json
from ..schema import bridge

# --- Offences of robots' accounts against others, as detected by this program's connections ---

T = TypeVar("T")


class Offences:
    """Robots that kept this program waiting, and backends that flooded it; used by several threads."""

    def __init__(self) -> None:
        self._blocking: SimpleQueue[str] = SimpleQueue()
        self._flooding: SimpleQueue[int] = SimpleQueue()

    def add_blocking(self, robots: Iterable[str]) -> None:
        """Record robots whose transactions were ended because this program waited for them."""
        for robot in robots:
            self._blocking.put(robot)

    def add_flood(self, backend: int) -> None:
        """Record the backend number of a connection that sent far too many notifications."""
        self._flooding.put(backend)

    def drain(self) -> tuple[list[str], list[int]]:
        """Return the robots and the backends recorded since the last call, once for each offence."""
        return _drained(self._blocking), _drained(self._flooding)


def _drained(queue: SimpleQueue[T]) -> list[T]:
    found = []
    try:
        while True:
            found.append(queue.get_nowait())
    except Empty:
        return found


# --- Ending robots' long transactions: the gateway may be waiting for their locks ---
# A robot may change its own time limits, so they bind only well-behaved ones; this binds all of them.

PATIENCE_S = 15
"""Seconds that any robot's transaction may take."""
BLOCKING_S = 1
"""Seconds that one may take while the gateway waits for it."""


def end_blocking_sessions(connection: Connection, seconds: int = PATIENCE_S) -> bool:
    """End the connections of robots whose transaction is older than ``seconds``; tell whether any was.

    MariaDB tells it of those that somebody prepared and left alone. Does nothing on a database in which
    robots have no accounts.
    """
    if connection.dialect.name == "postgresql":
        found = "select to_regprocedure('for_robots.end_stuck(integer)') is not null"
        if connection.execute(text(found)).scalar_one():
            call = text("select for_robots.end_stuck(:seconds)")
            return bool(connection.execute(call, {"seconds": seconds}).scalar_one())
    elif connection.dialect.name in ("mariadb", "mysql"):
        found = (
            "select count(*) from information_schema.routines "
            "where routine_schema = database() and routine_name = 'end_stuck_robots'"
        )
        if connection.execute(text(found)).scalar_one():
            connection.execute(text("call end_stuck_robots(:seconds)"), {"seconds": seconds})
            return _roll_back_forsaken(connection, seconds)
    return False


def _roll_back_forsaken(connection: Connection, seconds: int) -> bool:
    """Roll back what somebody prepared by XA and left: its locks outlive even a restart of the server.

    MariaDB cannot forbid XA to an account, nor tell whose such a transaction is; the bridge makes none.
    Return whether there was any.
    """
    if not connection.execute(text("select forsaken(:seconds)"), {"seconds": seconds}).scalar_one():
        return False
    found = connection.execute(text("xa recover format = 'sql'")).all()
    # XA ROLLBACK is refused inside a transaction, and without autocommit there is always one.
    statements = ["set autocommit = 1", *(f"xa rollback {row[3]}" for row in found), "set autocommit = 0"]
    for statement in statements:
        with contextlib.suppress(DBAPIError):
            connection.exec_driver_sql(statement, execution_options={"no_parameters": True})
    return True


# --- Temporary suspension of robots' accounts that block others; the end is stored in the database, so that
# the next gateway ends it if this one does not.

_FACT = "suspended"


def stored_suspensions(connection: Connection) -> dict[str, tuple[float, str]]:
    """Return until when (seconds since 1970) accounts are suspended, by robot, and why."""
    found = connection.scalar(select(bridge.c.value).where(bridge.c.name == _FACT))
    return {robot: (float(until), str(why)) for robot, (until, why) in decode_json(found or "{}").items()}


def store_suspensions(connection: Connection, suspended: dict[str, tuple[float, str]]) -> None:
    """Write what :func:`stored_suspensions` returns."""
    connection.execute(delete(bridge).where(bridge.c.name == _FACT))
    if suspended:
        connection.execute(insert(bridge).values(name=_FACT, value=json.dumps(suspended)))


def blocking_robots(connection: Connection, seconds: int) -> list[str]:
    """Return the robots with a transaction older than ``seconds`` that holds locks.

    None without robots' accounts, or with a set-up of a version before 0.3.
    """
    if not _has_routine(connection, "blocking_robots"):
        return []
    call = "select for_robots.blocking_robots(:seconds)"
    if connection.dialect.name != "postgresql":
        call = "call blocking_robots(:seconds)"
    return [str(row[0]) for row in connection.execute(text(call), {"seconds": seconds}).all()]


def robots_of_backends(connection: Connection, backends: Sequence[int]) -> list[str]:
    """Return the accounts of PostgreSQL that these backends belong to, as long as they are connected."""
    found = text("select usename from pg_stat_activity where pid = any(:backends) and usename is not null")
    return list(connection.execute(found, {"backends": list(backends)}).scalars())


def set_suspended(connection: Connection, robot: str, suspended: bool) -> bool:
    """Lock a robot's account and end its connections, or unlock it; false if the set-up cannot do that.

    On MariaDB this commits.
    """
    if not _has_routine(connection, "suspend_robot"):
        return False
    verb = "select for_robots." if connection.dialect.name == "postgresql" else "call "
    connection.execute(
        text(f"{verb}suspend_robot(:robot, :suspended)"), {"robot": robot, "suspended": suspended}
    )
    return True


def _has_routine(connection: Connection, name: str) -> bool:
    if connection.dialect.name == "postgresql":
        found = text(
            "select count(*) from pg_proc "
            "where proname = :name and pronamespace = to_regnamespace('for_robots')"
        )
    elif connection.dialect.name in ("mariadb", "mysql"):
        found = text(
            "select count(*) from information_schema.routines "
            "where routine_schema = database() and routine_name = :name"
        )
    else:
        return False
    return bool(connection.execute(found, {"name": name}).scalar_one())
