"""What the command line does to accounts and to the database is written into the audit log."""

from __future__ import annotations

import asyncio
import contextlib
import os
import pwd
import time
from collections.abc import Callable, Iterator
from datetime import datetime
from typing import TypeVar

import typer
from sqlalchemy import URL, Connection

from ..core.errors import BridgeError, StoreError
from ..core.messages import MessageError
from ..gateway.auth import audit
from ..gateway.auth.audit import AuditEntry
from ..gateway.storage import revisions
from ..gateway.storage.database import Database, run_once

T = TypeVar("T")


def read_database(address: URL, work: Callable[[Connection], T]) -> T:
    """Return what ``work`` finds in the database at ``address``."""
    return asyncio.run(_run(address, work))


def act_audited(
    address: URL, action: str, subject: str, detail: str | None, work: Callable[[Connection], T]
) -> T:
    """Do ``work`` and note ``action`` on ``subject`` in one transaction.

    What is refused is noted too, and raised again.
    """

    def noted(connection: Connection) -> T:
        result = work(connection)
        _note(connection, action, subject, True, detail)
        return result

    try:
        return read_database(address, noted)
    except (BridgeError, MessageError) as error:
        reason = str(error)
        read_database(address, lambda connection: _note(connection, action, subject, False, reason))
        raise


@contextlib.contextmanager
def audited(address: URL, action: str, subject: str, detail: str | None = None) -> Iterator[None]:
    """Note ``action`` on ``subject`` once the work inside is done, or was refused.

    For work that is no transaction. What is done stays done where the log cannot be written; that is said on
    standard error.
    """
    try:
        yield
    except BridgeError as error:
        reason = str(error)
        with contextlib.suppress(BridgeError):  # what keeps the log from being written is said already
            run_once(address, _note_if_there, action, subject, False, reason)
        raise
    try:
        run_once(address, _note_if_there, action, subject, True, detail)
    except BridgeError as error:
        typer.echo(f"robot-bridge: this is done, and not in the audit log: {error}", err=True)


def local_time(seconds: float | None) -> str:
    """Return a time as people of this computer read it, ``-`` for none."""
    if seconds is None:
        return "-"
    return datetime.fromtimestamp(seconds).astimezone().isoformat(" ", "seconds")


def after_days(days: float | None) -> float | None:
    """Return the time that is ``days`` from now; None for never."""
    return None if days is None else time.time() + days * 86400


async def _run(address: URL, work: Callable[[Connection], T]) -> T:
    database = Database(address)
    try:
        await database.open()
        return await database.run(work)
    finally:
        await database.close()


def _note(connection: Connection, action: str, subject: str, done: bool, detail: str | None) -> None:
    entry = AuditEntry(
        time.time(), system_account(), action, done, address="command line", subject=subject, detail=detail
    )
    audit.add_entries(connection, [entry])


def _note_if_there(connection: Connection, action: str, subject: str, done: bool, detail: str | None) -> None:
    found = revisions.current(connection)
    if found != revisions.NEEDED:
        raise StoreError(f"its tables are at revision {found or 'none'}, which this version does not write")
    _note(connection, action, subject, done, detail)


def system_account() -> str:
    """Return the account of this computer that runs the command, and behind sudo whose it is."""
    uid = os.getuid()
    try:
        name = pwd.getpwuid(uid).pw_name
    except KeyError:
        name = f"account {uid}"
    # Only root is believed: everybody else can write into the environment what they like.
    behind = os.environ.get("SUDO_USER") if uid == 0 else None
    return f"{name} (sudo by {behind})" if behind and behind != name else name
