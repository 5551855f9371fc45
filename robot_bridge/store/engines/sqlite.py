"""SQLite: one file on this computer, with a write-ahead log; no server."""

from __future__ import annotations

from typing import Any

import sqlalchemy
from sqlalchemy import URL, Connection, Engine, event
from sqlalchemy.pool import NullPool

from .dialect import PATIENCE_S, Dialect


class SQLite(Dialect):
    """Waits for a lock as long as its patience lasts."""

    name = "sqlite"
    advice = "check that it exists, that it may be written and that its disk has room"
    made_by_serve = True

    def engine(self, url: URL, patience: float | None) -> Engine:
        timeout = PATIENCE_S if patience is None else patience
        engine = sqlalchemy.create_engine(
            url,
            connect_args={"timeout": timeout, "check_same_thread": False},
            poolclass=NullPool,
            hide_parameters=True,
        )
        event.listen(engine, "connect", _prepare)
        event.listen(engine, "begin", _begin_immediate)
        return engine

    def version(self, connection: Connection) -> int | None:
        # Through the driver: SQLAlchemy would begin a transaction, and take the lock of all writers for it.
        driver = connection.connection.driver_connection
        assert driver is not None
        return int(driver.execute("PRAGMA data_version").fetchone()[0])


def _prepare(connection: Any, _record: Any) -> None:
    # The driver would begin transactions late, when a reader can no longer become a writer.
    connection.isolation_level = None
    # Anyone may write anything into RR: text that is no UTF-8 is to be refused row by row, not by the driver.
    connection.text_factory = _decode_leniently
    cursor = connection.cursor()
    cursor.execute("PRAGMA journal_mode = WAL")
    # A command that an operator was told is queued must outlive a power cut, not only a crash.
    cursor.execute("PRAGMA synchronous = FULL")
    cursor.close()


def _decode_leniently(text: bytes) -> str:
    return text.decode(errors="replace")


def _begin_immediate(connection: Connection) -> None:
    connection.exec_driver_sql("BEGIN IMMEDIATE")
