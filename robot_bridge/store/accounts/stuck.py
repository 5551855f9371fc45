"""Ends robots' transactions that take too long: what they lock, the gateway may be waiting for.

A robot may set its own time limits, so that they bind only the well-meaning; this binds all of them.
"""

from __future__ import annotations

import contextlib

from sqlalchemy import Connection, text
from sqlalchemy.exc import DBAPIError

PATIENCE_S = 15
"""How long any robot's transaction may take."""
BLOCKING_S = 1
"""How long one may take that keeps the gateway waiting."""


def end_stuck(connection: Connection, seconds: int = PATIENCE_S) -> None:
    """End the connections of robots whose transaction is older than ``seconds``.

    Does nothing on a database in which robots have no accounts.
    """
    if connection.dialect.name == "postgresql":
        found = "select to_regprocedure('for_robots.end_stuck(integer)') is not null"
        if connection.execute(text(found)).scalar_one():
            connection.execute(text("select for_robots.end_stuck(:seconds)"), {"seconds": seconds})
    elif connection.dialect.name in ("mariadb", "mysql"):
        found = (
            "select count(*) from information_schema.routines "
            "where routine_schema = database() and routine_name = 'end_stuck_robots'"
        )
        if connection.execute(text(found)).scalar_one():
            connection.execute(text("call end_stuck_robots(:seconds)"), {"seconds": seconds})
            _roll_back_forsaken(connection, seconds)


def _roll_back_forsaken(connection: Connection, seconds: int) -> None:
    """Roll back what somebody prepared by XA and left: its locks outlive even a restart of the server.

    MariaDB cannot forbid XA to an account, nor tell whose such a transaction is; the bridge makes none.
    """
    if not connection.execute(text("select forsaken(:seconds)"), {"seconds": seconds}).scalar_one():
        return
    found = connection.execute(text("xa recover format = 'sql'")).all()
    # XA ROLLBACK is refused inside a transaction, and without autocommit there is always one.
    statements = ["set autocommit = 1", *(f"xa rollback {row[3]}" for row in found), "set autocommit = 0"]
    for statement in statements:
        with contextlib.suppress(DBAPIError):
            connection.exec_driver_sql(statement, execution_options={"no_parameters": True})
