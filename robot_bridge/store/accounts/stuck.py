"""Ends robots' transactions that take too long: what they lock, the gateway may be waiting for.

A robot may set its own time limits, so that they bind only the well-meaning; this binds all of them.
"""

from __future__ import annotations

from sqlalchemy import Connection, text

PATIENCE_S = 15
"""How long any robot's transaction may take."""
BLOCKING_S = 1
"""How long one may take that keeps the gateway waiting."""


def end_stuck(connection: Connection, seconds: int = PATIENCE_S) -> None:
    """End the connections of robots whose transaction is older than ``seconds``.

    Does nothing on a database in which robots have no accounts.
    """
    name = connection.dialect.name
    if name == "postgresql":
        found = "select to_regprocedure('for_robots.end_stuck(integer)') is not null"
        call = "select for_robots.end_stuck(:seconds)"
    elif name in ("mariadb", "mysql"):
        found = (
            "select count(*) from information_schema.routines "
            "where routine_schema = database() and routine_name = 'end_stuck_robots'"
        )
        call = "call end_stuck_robots(:seconds)"
    else:
        return
    if connection.execute(text(found)).scalar_one():
        connection.execute(text(call), {"seconds": seconds})
