"""The database: one connection in one thread of its own, so that the event loop never waits for a disk."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from typing import Any, TypeVar

import sqlalchemy
from sqlalchemy import Connection, Engine, event
from sqlalchemy.exc import ArgumentError, SQLAlchemyError

from ..errors import StoreError
from .schema import metadata

T = TypeVar("T")


class Database:
    """Runs pieces of work, each in a transaction: ``await database.run(work, *arguments)``.

    ``work`` is called as ``work(connection, *arguments)`` in the database's thread. Its transaction is
    committed when ``run`` returns and rolled back when it raises.
    """

    def __init__(self, url: str) -> None:
        self.url = url
        self._engine = open_engine(url)
        self._executor = ThreadPoolExecutor(max_workers=1, thread_name_prefix="database")

    async def open(self) -> None:
        """Create the tables that are missing; raises StoreError when the database cannot be used."""
        await self._call(self._create)

    async def run(self, work: Callable[..., T], *arguments: Any) -> T:
        """Run ``work`` in a transaction of its own; raises StoreError when the database refuses."""
        return await self._call(self._transaction, work, *arguments)

    async def changed_elsewhere(self) -> int:
        """Return a number that differs from the last one when another connection wrote (SQLite only)."""
        return await self._call(self._data_version)

    async def close(self) -> None:
        """Close the connection and end the thread."""
        await self._call(self._engine.dispose)
        self._executor.shutdown(wait=True)

    async def _call(self, work: Callable[..., T], *arguments: Any) -> T:
        try:
            return await asyncio.get_running_loop().run_in_executor(self._executor, work, *arguments)
        except SQLAlchemyError as error:
            cause = getattr(error, "orig", None) or error
            raise StoreError(
                f"database {self._engine.url.render_as_string()}: {cause}; check that it exists, that it may "
                "be written and that its disk has room"
            ) from error

    def _create(self) -> None:
        metadata.create_all(self._engine)

    def _transaction(self, work: Callable[..., T], *arguments: Any) -> T:
        with self._engine.begin() as connection:
            return work(connection, *arguments)

    def _data_version(self) -> int:
        with self._engine.connect() as connection:
            return int(connection.exec_driver_sql("PRAGMA data_version").scalar_one())


def open_engine(url: str) -> Engine:
    """Return an engine on ``url`` with what the bridge needs of SQLite; raises StoreError for another URL."""
    try:
        parsed = sqlalchemy.make_url(url)
    except ArgumentError:
        raise StoreError(
            f"database URL {url!r} cannot be read; write it like sqlite:////path/fleet.db"
        ) from None
    if parsed.get_backend_name() != "sqlite":
        raise StoreError(
            f"database {parsed.render_as_string()}: only SQLite is supported; write sqlite:////path/fleet.db"
        )
    engine = sqlalchemy.create_engine(parsed, connect_args={"timeout": 10, "check_same_thread": False})
    event.listen(engine, "connect", _prepare_sqlite)
    event.listen(engine, "begin", _begin_immediate)
    return engine


def _prepare_sqlite(connection: Any, _record: Any) -> None:
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
