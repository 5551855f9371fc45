"""Robots' accounts that lose their connections for a while: who blocks the others, locked out, let in again.

Until when stands in the database, so that the next gateway lets them in again if this one does not.
"""

from __future__ import annotations

import json
from collections.abc import Sequence

from sqlalchemy import Connection, delete, insert, select, text

from ...core.decoding import decode_json
from ..schema import bridge

_FACT = "suspended"


def stored(connection: Connection) -> dict[str, tuple[float, str]]:
    """Return until when (seconds since 1970) accounts are suspended, by robot, and why."""
    found = connection.scalar(select(bridge.c.value).where(bridge.c.name == _FACT))
    return {robot: (float(until), str(why)) for robot, (until, why) in decode_json(found or "{}").items()}


def store(connection: Connection, suspended: dict[str, tuple[float, str]]) -> None:
    """Write what :func:`stored` returns."""
    connection.execute(delete(bridge).where(bridge.c.name == _FACT))
    if suspended:
        connection.execute(insert(bridge).values(name=_FACT, value=json.dumps(suspended)))


def blocking_robots(connection: Connection, seconds: int) -> list[str]:
    """Return the robots with a transaction older than ``seconds`` that holds locks.

    Nothing where robots have no accounts, or the set-up is of a version before 0.3.
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
    """Lock a robot's account and end its connections, or unlock it; false where the set-up cannot do that.

    Must run outside of others' transactions: MariaDB commits with it.
    """
    with connection.begin():
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
