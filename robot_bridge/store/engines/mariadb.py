"""MariaDB 10.11 or newer, through PyMySQL."""

from __future__ import annotations

import contextlib
import socket
from typing import Any

import sqlalchemy
from sqlalchemy import URL, Engine, event
from sqlalchemy.exc import DBAPIError, SQLAlchemyError
from sqlalchemy.pool import NullPool

from .dialect import CONNECT_TIMEOUT_S, LOCK_TIMEOUT_S, Dialect

_DEADLOCK = 1213
_LOCK_TIMEOUT = 1205
_RECORD_CHANGED = 1020
_REFUSALS = (1153, 1366, 4025)
"""Packet too large, text that is no text, a constraint: the driver takes these for other errors."""
_LARGEST_PACKET = 64 << 20


class MariaDB(Dialect):
    """READ COMMITTED: the default level locks gaps, in which inserts and deletes of others meet."""

    name = "mariadb"

    def engine(self, url: URL, patience: float | None) -> Engine:
        engine = sqlalchemy.create_engine(
            url.set(drivername="mariadb+pymysql"),
            connect_args={
                "connect_timeout": CONNECT_TIMEOUT_S,
                # The server's own limit comes first; this one is for a server that does not answer at all.
                "read_timeout": None if patience is None else round(patience) + 1,
                "write_timeout": None if patience is None else round(patience) + 1,
                "charset": "utf8mb4",
                "max_allowed_packet": _LARGEST_PACKET,
            },
            isolation_level="READ COMMITTED",
            poolclass=NullPool,
            hide_parameters=True,
        )
        if patience is not None:
            event.listen(engine, "connect", _limits(patience))
        return engine

    def interrupt(self, driver_connection: Any) -> None:
        with contextlib.suppress(OSError, AttributeError):
            driver_connection._sock.shutdown(socket.SHUT_RDWR)

    def deadlocked(self, error: DBAPIError) -> bool:
        return _code(error) in (_DEADLOCK, _RECORD_CHANGED)

    def kept_waiting(self, error: DBAPIError) -> bool:
        return _code(error) == _LOCK_TIMEOUT

    def refuses_data(self, error: SQLAlchemyError) -> bool:
        return super().refuses_data(error) or _code(error) in _REFUSALS

    def cause(self, error: SQLAlchemyError) -> str:
        arguments: tuple[Any, ...] = getattr(getattr(error, "orig", None), "args", ())
        return " ".join(str(arguments[1]).split()) if len(arguments) > 1 else super().cause(error)


def _code(error: SQLAlchemyError) -> int | None:
    arguments: tuple[Any, ...] = getattr(getattr(error, "orig", None), "args", ())
    return arguments[0] if arguments and isinstance(arguments[0], int) else None


def _limits(patience: float) -> Any:
    def limit(connection: Any, _record: Any) -> None:
        with connection.cursor() as cursor:
            cursor.execute(f"set session max_statement_time = {patience}")
            cursor.execute(f"set session innodb_lock_wait_timeout = {LOCK_TIMEOUT_S}")
            cursor.execute(f"set session lock_wait_timeout = {LOCK_TIMEOUT_S}")

    return limit
