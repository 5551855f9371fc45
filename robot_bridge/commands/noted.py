"""What the command line does to accounts is done and written into the audit log in one transaction."""

from __future__ import annotations

import asyncio
import getpass
import time
from collections.abc import Callable
from datetime import datetime
from typing import TypeVar

from sqlalchemy import URL, Connection

from ..access import audit
from ..access.audit import Entry
from ..errors import BridgeError
from ..messages import MessageError
from ..store.database import Database

T = TypeVar("T")


def read(address: URL, work: Callable[[Connection], T]) -> T:
    """Return what ``work`` finds in the database at ``address``."""
    return asyncio.run(_run(address, work))


def act(address: URL, action: str, subject: str, detail: str | None, work: Callable[[Connection], T]) -> T:
    """Do ``work``, and note ``action`` on ``subject``; what is refused is noted too, and raised again."""

    def note(connection: Connection, done: bool, detail: str | None) -> None:
        entry = Entry(
            time.time(), _who(), action, done, address="command line", subject=subject, detail=detail
        )
        audit.add(connection, [entry])

    def noted(connection: Connection) -> T:
        result = work(connection)
        note(connection, True, detail)
        return result

    try:
        return read(address, noted)
    except (BridgeError, MessageError) as error:
        reason = str(error)
        read(address, lambda connection: note(connection, False, reason))
        raise


def moment(seconds: float | None) -> str:
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


def _who() -> str:
    try:
        return getpass.getuser()
    except (OSError, KeyError):
        return "unknown account"
