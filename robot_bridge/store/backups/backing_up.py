"""Backing a database up into one file, and restoring it."""

from __future__ import annotations

import asyncio
import os
import tempfile
from collections.abc import Callable
from pathlib import Path
from typing import Protocol

from sqlalchemy import URL, Connection, func, inspect, select

from ...counting import counted
from ...errors import BridgeError, StoreError
from .. import revisions
from ..address import shown
from ..database import run_once
from ..schema import metadata
from ..sole_gateway import no_gateway
from .server_dump import MariaDbBackups, PostgreSqlBackups
from .sqlite_file import SqliteBackups


class Backups(Protocol):
    """How one kind of database is backed up; every method raises StoreError for what goes wrong."""

    kind: str

    def recognises(self, head: bytes) -> bool:
        """Tell whether a file that begins so may be a backup of this kind."""

    def write(self, partial: Path, revision: str) -> None:
        """Write a backup into ``partial``."""

    def check(self, file: Path) -> str:
        """Return the revision of the tables in ``file``; raises StoreError unless it is a whole backup."""

    def load(self, file: Path) -> None:
        """Put what ``file`` holds in the place of what is there, under a new id, in one transaction."""


KINDS: dict[str, Callable[[URL], Backups]] = {
    "sqlite": SqliteBackups,
    "postgresql": PostgreSqlBackups,
    "mariadb": MariaDbBackups,
}


def back_up(url: URL, file: Path, *, replace: bool = False) -> int:
    """Write a backup of the database into ``file``, whole or not at all; return its size in bytes.

    The gateway may run. Raises BridgeError and StoreError.
    """
    _refuse_itself(url, file)
    if file.exists() and not replace:
        raise BridgeError(f"{file} is there already; choose another name, or give --replace")
    revision = run_once(url, _revision, shown(url))
    try:
        with tempfile.TemporaryDirectory(prefix=".backing-up-", dir=file.parent) as folder:
            partial = Path(folder) / "backup"
            # It holds what the database does, and nobody else's eyes are meant for it.
            os.close(os.open(partial, os.O_CREAT | os.O_WRONLY, 0o600))
            kind = KINDS[url.get_backend_name()](url)
            kind.write(partial, revision)
            kind.check(partial)
            _to_disk(partial)
            partial.replace(file)
    except OSError as error:
        raise BridgeError(f"{file} cannot be written: {error.strerror or error}; check its folder") from error
    return file.stat().st_size


def revision_in(url: URL, file: Path) -> str:
    """Return which tables a backup for the database at ``url`` holds; raises BridgeError and StoreError."""
    _refuse_itself(url, file)
    _check_kind(url, file)
    revision = KINDS[url.get_backend_name()](url).check(file)
    if revision > revisions.NEEDED:
        raise StoreError(
            f"backup {file} holds tables of revision {revision}, and this version of robot-bridge knows "
            f"those up to {revisions.NEEDED}; install the robot-bridge that wrote it"
        )
    return revision


async def restore(url: URL, file: Path, *, replace: bool = False) -> str:
    """Put the backup in ``file`` in the place of the database; return the revision of its tables.

    The database gets a new id, so that robots forget the numbers of messages that may come again. Refused
    while a gateway runs on it, and where it holds anything unless ``replace``. Raises BridgeError and
    StoreError.
    """
    revision = revision_in(url, file)
    async with no_gateway(url, "robot-bridge database restore"):
        await asyncio.to_thread(_restore, url, file, revision, replace)
    return revision


def _restore(url: URL, file: Path, revision: str, replace: bool) -> None:
    if url.get_backend_name() != "sqlite":
        _check_fits(url, file, revision, run_once(url, _revision, shown(url)))
    held = run_once(url, _held)
    if held is not None and not replace:
        raise BridgeError(
            f"database {shown(url)} is not empty: it has {held}; back it up, then give --replace to have it "
            "replaced"
        )
    KINDS[url.get_backend_name()](url).load(file)


def _check_fits(url: URL, file: Path, revision: str, found: str) -> None:
    """Raise StoreError unless the tables that were found are those whose rows are in the backup."""
    if found == revision:
        return
    advice = (
        "run first: robot-bridge database upgrade"
        if found < revision
        else "restore it into another, empty database, whose tables are made by 'robot-bridge database "
        f"create --for-backup {file}'; after that run 'robot-bridge database upgrade' there"
    )
    raise StoreError(
        f"backup {file} holds tables of revision {revision}, and those of database {shown(url)} are {found}; "
        f"{advice}"
    )


def _revision(connection: Connection, where: str) -> str:
    found = revisions.current(connection)
    if found is None:
        raise StoreError(
            f"database {where} has no tables of the bridge; make them with: robot-bridge database create"
        )
    return found


def _held(connection: Connection) -> str | None:
    """Return how much of what the database holds, None for nothing; that it was made is in its audit log."""
    present = set(inspect(connection).get_table_names())
    for name in ("commands", "trajectories", "robots", "operators", "observations"):
        if name not in present:
            continue
        table = metadata.tables[name]
        count = connection.scalar(select(func.count()).select_from(table)) or 0
        if count:
            return f"{counted(count, 'row')} in {name}"
    return None


def _refuse_itself(url: URL, file: Path) -> None:
    """Raise BridgeError for the database's own file: a copy in its place would take it from a gateway."""
    database = Path(url.database or "") if url.get_backend_name() == "sqlite" else None
    if database is not None and database.is_file() and file.exists() and file.samefile(database):
        raise BridgeError(f"{file} is the database itself; name another file for the backup")


def _check_kind(url: URL, file: Path) -> None:
    try:
        with file.open("rb") as source:
            head = source.read(64)
    except OSError as error:
        raise BridgeError(f"backup {file} cannot be read: {error.strerror}") from error
    wanted = url.get_backend_name()
    if KINDS[wanted](url).recognises(head):
        return
    of = next((name for name in KINDS if KINDS[name](url).recognises(head)), None)
    what = f"is of {of}" if of == "sqlite" else "is of a database server" if of else "is no backup"
    raise StoreError(f"file {file} {what}, and database {shown(url)} is {wanted}; give a backup of {wanted}")


def _to_disk(file: Path) -> None:
    descriptor = os.open(file, os.O_RDONLY)
    try:
        os.fsync(descriptor)
    finally:
        os.close(descriptor)
