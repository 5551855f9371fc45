"""PostgreSQL 15 or newer, through psycopg 3."""

from __future__ import annotations

import contextlib
import os
import socket
from typing import Any

import sqlalchemy
from sqlalchemy import URL, Connection, Engine, event
from sqlalchemy.exc import DBAPIError
from sqlalchemy.pool import NullPool

from .dialect import CONNECT_TIMEOUT_S, LOCK_TIMEOUT_S, Dialect

CONNECT_ARGUMENTS: dict[str, Any] = {
    "connect_timeout": CONNECT_TIMEOUT_S,
    "application_name": "robot-bridge",
    "client_encoding": "utf8",
    # A cable that was pulled is noticed within seconds, not within the system's two hours.
    "keepalives_idle": 5,
    "keepalives_interval": 2,
    "keepalives_count": 3,
}
_REPEATABLE = ("40001", "40P01")


class PostgreSQL(Dialect):
    """The server ends statements that take too long; a server that is frozen has its connection cut."""

    name = "postgresql"
    listens = True

    def engine(self, url: URL, patience: float | None) -> Engine:
        engine = sqlalchemy.create_engine(
            url.set(drivername="postgresql+psycopg"),
            connect_args=CONNECT_ARGUMENTS,
            isolation_level="READ COMMITTED",
            poolclass=NullPool,
            hide_parameters=True,
        )
        if patience is not None:
            event.listen(engine, "connect", _limits(patience))
        return engine

    def backend(self, connection: Connection) -> int | None:
        driver = connection.connection.driver_connection
        assert driver is not None
        return int(driver.info.backend_pid)

    def interrupt(self, driver_connection: Any) -> None:
        # A second number for the same socket: this one may be closed while the other thread uses its own.
        with contextlib.suppress(OSError), socket.socket(fileno=os.dup(driver_connection.fileno())) as twin:
            twin.shutdown(socket.SHUT_RDWR)

    def deadlocked(self, error: DBAPIError) -> bool:
        return getattr(error.orig, "sqlstate", None) in _REPEATABLE


def _limits(patience: float) -> Any:
    def limit(connection: Any, _record: Any) -> None:
        with connection.cursor() as cursor:
            cursor.execute(f"set statement_timeout = {round(patience * 1000)}")
            cursor.execute(f"set lock_timeout = {LOCK_TIMEOUT_S * 1000}")
            cursor.execute(f"set idle_in_transaction_session_timeout = {round(patience * 1000)}")
        connection.commit()

    return limit
