"""SQLite: one file on this computer, with a write-ahead log; no server."""

from __future__ import annotations

import contextlib
import logging
import os
import sqlite3
import stat
import time
from pathlib import Path
from typing import Any, NamedTuple

import sqlalchemy
from sqlalchemy import URL, Connection, Engine, Transaction, event
from sqlalchemy.exc import OperationalError
from sqlalchemy.pool import NullPool

from .dialect import PATIENCE_S, Dialect, Mode

log = logging.getLogger(__name__)

LOCK_PAUSE_S = 0.0005
_GONE = "was taken away or replaced while it was in use: put it back, or end whatever uses it"


class SQLite(Dialect):
    """Waits for a lock as long as its patience lasts."""

    name = "sqlite"
    advice = "check that it exists, that it may be written and that its disk has room"
    made_by_serve = True
    has_version = True

    def engine(self, url: URL, patience: float | None) -> Engine:
        self._timeout = PATIENCE_S if patience is None else patience
        engine = sqlalchemy.create_engine(
            url,
            connect_args={"timeout": self._timeout, "check_same_thread": False},
            poolclass=NullPool,
            hide_parameters=True,
        )
        event.listen(engine, "do_connect", self._make_file)
        event.listen(engine, "connect", _prepare)
        event.listen(engine, "connect", self._close_to_others)
        event.listen(engine, "begin", self._begin)
        return engine

    def begin(self, connection: Connection, mode: Mode) -> Transaction:
        connection.info["mode"] = mode
        return connection.begin()

    def version(self, connection: Connection) -> int | None:
        # Through the driver: SQLAlchemy would begin a transaction, and take the lock of all writers for it.
        driver = connection.connection.driver_connection
        assert driver is not None
        return int(driver.execute("PRAGMA data_version").fetchone()[0])

    def _begin(self, connection: Connection) -> None:
        opened: _Opened | None = connection.info.get("opened")
        if opened is not None and not opened.is_there():
            raise OperationalError("BEGIN", None, sqlite3.OperationalError(f"{opened.path} {_GONE}"))
        mode = connection.info.get("mode", Mode.WRITE)
        # Through the driver, here and below: through SQLAlchemy each takes several times as long.
        driver = connection.connection.driver_connection
        assert driver is not None
        if mode is Mode.READ:
            # Readers hold up nobody, and nobody holds them up.
            try:
                driver.execute("BEGIN")
            except sqlite3.OperationalError as error:
                raise OperationalError("BEGIN", None, error) from error
            return
        # A command that an operator was told is queued must outlive a power cut, not only a crash.
        synchronous = "FULL" if mode is Mode.WRITE else "NORMAL"
        if connection.info.get("synchronous") != synchronous:
            connection.exec_driver_sql(f"PRAGMA synchronous = {synchronous}")
            connection.info["synchronous"] = synchronous
        self._lock(connection)

    @staticmethod
    def _make_file(_dialect: Any, _record: Any, arguments: list[Any], _options: Any) -> None:
        path = str(arguments[0])
        if path != ":memory:" and not path.startswith("file:"):
            make_file(Path(path))

    @staticmethod
    def _close_to_others(_connection: Any, record: Any) -> None:
        """Take the file, and what SQLite keeps beside it, from every account that is not of its group."""
        opened: _Opened | None = record.info.get("opened")
        if opened is None:
            return
        for path in [Path(f"{opened.path}{end}") for end in ("", "-wal", "-shm", "-journal")]:
            try:
                rights = stat.S_IMODE(path.stat().st_mode)
            except OSError:
                continue
            if not rights & stat.S_IRWXO:
                continue
            try:
                path.chmod(rights & ~stat.S_IRWXO)
            except OSError as error:
                text = "every account of this computer may open %s (%s); run: chmod o-rwx on it"
                log.warning(text, path, error.strerror)
                continue
            log.warning("every account of this computer could open %s; now its owner and group may", path)

    def _lock(self, connection: Connection) -> None:
        """Take the lock of all writers as soon as it is free; SQLite itself would sleep up to 0.1 s."""
        until = time.monotonic() + self._timeout
        driver = connection.connection.driver_connection
        assert driver is not None
        driver.execute("PRAGMA busy_timeout = 0")
        try:
            while True:
                try:
                    driver.execute("BEGIN IMMEDIATE")
                    return
                except sqlite3.OperationalError as error:
                    if "locked" not in str(error) or time.monotonic() > until:
                        raise OperationalError("BEGIN IMMEDIATE", None, error) from error
                time.sleep(LOCK_PAUSE_S)
        finally:
            driver.execute(f"PRAGMA busy_timeout = {round(self._timeout * 1000)}")


class _Opened(NamedTuple):
    """The file that a connection has open, as it was found at its path."""

    path: Path
    device: int
    inode: int

    @classmethod
    def by(cls, connection: sqlite3.Connection) -> _Opened | None:
        """Return the file of a connection, None for a database in memory."""
        rows = connection.execute("PRAGMA database_list").fetchall()
        file = next((file for _number, name, file in rows if name == "main"), "")
        if not file:
            return None
        path = Path(file)
        status = path.stat()
        return cls(path, status.st_dev, status.st_ino)

    def is_there(self) -> bool:
        """Tell whether it is still at its path: what is written into a file that was taken away is lost."""
        try:
            status = self.path.stat()
        except OSError:
            return False
        return (status.st_dev, status.st_ino) == (self.device, self.inode)


def _prepare(connection: Any, record: Any) -> None:
    # The driver would begin transactions late, when a reader can no longer become a writer.
    connection.isolation_level = None
    # Anyone may write anything into RR: text that is no UTF-8 is to be refused row by row, not by the driver.
    connection.text_factory = _decode_leniently
    cursor = connection.cursor()
    cursor.execute("PRAGMA journal_mode = WAL")
    # Some distributions have SQLite write zeros over what is deleted: the map of a city, page by page, for
    # which everybody else would wait.
    cursor.execute("PRAGMA secure_delete = FAST")
    cursor.close()
    record.info["opened"] = _Opened.by(connection)


def make_file(path: Path) -> None:
    """Make a new database's file for its owner alone, whatever the umask: who may write it, commands."""
    with contextlib.suppress(OSError):
        os.close(os.open(path, os.O_RDWR | os.O_CREAT | os.O_EXCL | os.O_CLOEXEC, 0o600))


def _decode_leniently(text: bytes) -> str:
    return text.decode(errors="replace")


def file_of(url: URL) -> Path | None:
    """Return the file of a SQLite database, None for one in memory; raises SQLAlchemyError."""
    engine = SQLite().engine(url, None)
    with engine.connect() as connection:
        driver = connection.connection.driver_connection
        assert driver is not None
        found = driver.execute("PRAGMA database_list").fetchall()
    engine.dispose()
    file = next((row[2] for row in found if row[1] == "main"), "")
    return Path(file).resolve() if file else None
