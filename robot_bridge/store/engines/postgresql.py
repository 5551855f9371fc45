"""PostgreSQL 15 or newer, through psycopg 3."""

from __future__ import annotations

import contextlib
import os
import socket
from typing import Any

import sqlalchemy
from sqlalchemy import URL, Connection, Engine, Transaction, event
from sqlalchemy.exc import DBAPIError
from sqlalchemy.pool import NullPool

from .dialect import CONNECT_TIMEOUT_S, LOCK_TIMEOUT_S, Dialect, Mode

CONNECT_ARGUMENTS: dict[str, Any] = {
    "connect_timeout": CONNECT_TIMEOUT_S,
    "application_name": "robot-bridge",
    "client_encoding": "utf8",
    # A cable that was pulled is noticed within seconds, not within the system's two hours.
    "keepalives_idle": 5,
    "keepalives_interval": 2,
    "keepalives_count": 3,
}
GATEWAY_DOZES = 0x666C656574
"""The number of the lock that a gateway holds while it wants to be told of new rows ('fleet')."""
_REPEATABLE = ("40001", "40P01")
_LOCK_TIMEOUT = "55P03"


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
        # Many rows in one statement instead of one statement each.
        engine.dialect.use_insertmanyvalues_wo_returning = True
        if patience is not None:
            event.listen(engine, "connect", _limits(patience))
        return engine

    def begin(self, connection: Connection, mode: Mode) -> Transaction:
        driver = connection.connection.driver_connection
        assert driver is not None
        # A connection that was lost is told of by the first statement.
        with contextlib.suppress(driver_error()):
            # Saves a reader two of three round trips to the server.
            driver.autocommit = mode is Mode.READ
        transaction = connection.begin()
        if mode is Mode.JOT:
            connection.exec_driver_sql("set local synchronous_commit = off")
        return transaction

    def backend(self, connection: Connection) -> int | None:
        driver = connection.connection.driver_connection
        assert driver is not None
        return int(driver.info.backend_pid)

    def doze(self, connection: Connection) -> bool:
        # Taken twice the lock would have to be given back twice.
        if not connection.info.get("dozes"):
            text = f"select pg_try_advisory_lock({GATEWAY_DOZES})"
            connection.info["dozes"] = connection.exec_driver_sql(text).scalar_one()
        return bool(connection.info["dozes"])

    def rouse(self, connection: Connection) -> None:
        if connection.info.pop("dozes", False):
            connection.exec_driver_sql(f"select pg_advisory_unlock({GATEWAY_DOZES})")

    def interrupt(self, driver_connection: Any) -> None:
        # A second number for the same socket: this one may be closed while the other thread uses its own.
        with contextlib.suppress(OSError), socket.socket(fileno=os.dup(driver_connection.fileno())) as twin:
            twin.shutdown(socket.SHUT_RDWR)

    def deadlocked(self, error: DBAPIError) -> bool:
        return getattr(error.orig, "sqlstate", None) in _REPEATABLE

    def kept_waiting(self, error: DBAPIError) -> bool:
        return getattr(error.orig, "sqlstate", None) == _LOCK_TIMEOUT


def driver_error() -> type[Exception]:
    """Return the driver's errors; the driver is imported where it is used, for it may be missing."""
    import psycopg

    return psycopg.Error


def _limits(patience: float) -> Any:
    def limit(connection: Any, _record: Any) -> None:
        with connection.cursor() as cursor:
            cursor.execute(f"set statement_timeout = {round(patience * 1000)}")
            cursor.execute(f"set lock_timeout = {LOCK_TIMEOUT_S * 1000}")
            cursor.execute(f"set idle_in_transaction_session_timeout = {round(patience * 1000)}")
        connection.commit()

    return limit
