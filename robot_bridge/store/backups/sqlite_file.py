"""Backups of SQLite: a database file, copied while it is in use."""

from __future__ import annotations

import contextlib
import sqlite3
import tempfile
from collections.abc import Iterator
from pathlib import Path

from sqlalchemy import URL, Connection, create_engine, delete, inspect
from sqlalchemy.pool import NullPool

from ...errors import StoreError
from .. import facts, revisions
from ..database import run_once
from ..engines.sqlite import make_file
from ..schema import bridge, rr

_MAGIC = b"SQLite format 3\x00"


class SqliteBackups:
    """Copies by SQLite's own means, which see what still waits in the write-ahead log."""

    kind = "sqlite"

    def __init__(self, url: URL) -> None:
        self._url = url

    def recognises(self, head: bytes) -> bool:
        """Tell whether a file that begins so is a backup of this kind."""
        return head.startswith(_MAGIC)

    def write(self, partial: Path, revision: str) -> None:
        """Copy the database into ``partial``."""
        with _connected(self._file()) as source, _connected(partial) as target:
            # All in one step: one in several begins anew whenever somebody has written in between, and a
            # gateway always does. With its log SQLite lets others write meanwhile.
            source.backup(target)
            # A file of its own: what would wait in a log beside it could be left behind.
            target.execute("PRAGMA journal_mode = DELETE")

    def check(self, file: Path) -> str:
        """Return the revision of the tables in ``file``; raises StoreError unless it is a whole backup."""
        with _connected(file) as source:
            found = source.execute("PRAGMA quick_check(1)").fetchone()[0]
        if found != "ok":
            raise StoreError(f"backup {file} is damaged: {found}")
        # Not as the bridge opens a database: that would turn the backup into one with a log beside it.
        engine = create_engine(URL.create("sqlite", database=str(file)), poolclass=NullPool)
        with engine.connect() as connection:
            revision = revisions.current(connection)
        if revision is None:
            raise StoreError(f"file {file} is no backup: it has no tables of the bridge")
        return revision

    def load(self, file: Path) -> None:
        """Put what ``file`` holds in the place of the database, under a new id, in one transaction."""
        database = self._file()
        with tempfile.TemporaryDirectory(prefix=".restoring-", dir=database.parent) as folder:
            # Renewed before it takes the place: between the two robots would know the old id.
            renewed = Path(folder) / "backup"
            for made in (renewed, database):
                make_file(made)
            with _connected(file) as source, _connected(renewed) as target:
                source.backup(target)
            run_once(URL.create("sqlite", database=str(renewed)), _renew)
            with _connected(renewed) as source, _connected(database) as target:
                source.backup(target)
                target.execute("PRAGMA journal_mode = WAL")

    def _file(self) -> Path:
        database = self._url.database
        if not database or database == ":memory:" or database.startswith("file:"):
            raise StoreError(
                f"database {self._url}: only a file named by its path can be backed up or restored"
            )
        return Path(database)


def _renew(connection: Connection) -> None:
    if bridge.name not in inspect(connection).get_table_names():
        return  # a database of version 0.1.0, which gets its id when it is upgraded
    connection.execute(delete(rr))
    connection.execute(delete(bridge).where(bridge.c.name == facts.ID))
    facts.database_id(connection)


@contextlib.contextmanager
def _connected(file: Path) -> Iterator[sqlite3.Connection]:
    try:
        with contextlib.closing(sqlite3.connect(file, timeout=30, isolation_level=None)) as connection:
            yield connection
    except sqlite3.Error as error:
        raise StoreError(
            f"{file}: {error}; check that it is whole, and its folder's rights and room"
        ) from error
