"""``robot-bridge audit``: prints the audit log; and adds the entries of other commands."""

from __future__ import annotations

import asyncio
import contextlib
import os
import pwd
import time
from collections.abc import Callable, Iterator
from datetime import datetime
from typing import Annotated, TypeVar

import typer
from sqlalchemy import URL, Connection

from ..core.errors import BridgeError, StoreError, listed_names
from ..core.messages.base import MessageError
from ..gateway.auth import audit as audit_log
from ..gateway.auth.accounts import grants
from ..gateway.auth.audit import AuditEntry
from ..gateway.storage import revisions
from ..gateway.storage.database import Database, run_once
from .options import DEFAULT, DatabaseOption, PasswordFileOption, database_address

# --- Audit log entries for changes of accounts and of the database by the command line ---

T = TypeVar("T")


def read_database(address: URL, work: Callable[[Connection], T]) -> T:
    """Return the result of ``work`` on the database at ``address``."""
    return asyncio.run(_run(address, work))


def act_audited(
    address: URL, action: str, subject: str, detail: str | None, work: Callable[[Connection], T]
) -> T:
    """Do ``work`` and record ``action`` on ``subject`` in one transaction.

    Refusals are recorded too, and raised again.
    """

    def recorded(connection: Connection) -> T:
        result = work(connection)
        _record(connection, action, subject, True, detail)
        return result

    try:
        return read_database(address, recorded)
    except (BridgeError, MessageError) as error:
        reason = str(error)
        read_database(address, lambda connection: _record(connection, action, subject, False, reason))
        raise


@contextlib.contextmanager
def audited(address: URL, action: str, subject: str, detail: str | None = None) -> Iterator[None]:
    """Record ``action`` on ``subject`` once the work inside is done, or was refused.

    For work that is no transaction. The work stays done if the log cannot be written; that is reported on
    standard error.
    """
    try:
        yield
    except BridgeError as error:
        reason = str(error)
        with contextlib.suppress(BridgeError):  # the reason is reported already
            run_once(address, _record_if_there, action, subject, False, reason)
        raise
    try:
        run_once(address, _record_if_there, action, subject, True, detail)
    except BridgeError as error:
        typer.echo(f"robot-bridge: this is done, and not in the audit log: {error}", err=True)


def local_time(seconds: float | None) -> str:
    """Return a time in this computer's time zone as text, ``-`` for none."""
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


def _record(connection: Connection, action: str, subject: str, done: bool, detail: str | None) -> None:
    entry = AuditEntry(
        time.time(), system_account(), action, done, address="command line", subject=subject, detail=detail
    )
    audit_log.add_entries(connection, [entry])


def _record_if_there(
    connection: Connection, action: str, subject: str, done: bool, detail: str | None
) -> None:
    found = revisions.current(connection)
    if found != revisions.NEEDED:
        raise StoreError(f"its tables are at revision {found or 'none'}, which this version does not write")
    _record(connection, action, subject, done, detail)


def system_account() -> str:
    """Return the account of this computer that runs the command, and the one behind sudo."""
    uid = os.getuid()
    try:
        name = pwd.getpwuid(uid).pw_name
    except KeyError:
        name = f"account {uid}"
    # Only root is trusted: everybody else can set the environment freely.
    behind = os.environ.get("SUDO_USER") if uid == 0 else None
    return f"{name} (sudo by {behind})" if behind and behind != name else name


# --- The command ---


def audit(
    since: Annotated[
        str | None, typer.Option(help="Not before: 2026-11-21T08:00, in this computer's time zone.")
    ] = None,
    who: Annotated[str | None, typer.Option(help="Only what this account did.")] = None,
    limit: Annotated[int, typer.Option(help="How many at most, the newest.", min=1)] = 1000,
    database: DatabaseOption = DEFAULT,
    database_password_file: PasswordFileOption = None,
) -> None:
    """Print who did what, oldest first: when, who, role, from where, what, to what, done or refused."""
    at = _seconds(since)
    address = database_address(database, database_password_file)
    found = read_database(address, lambda c: audit_log.newest_entries(c, limit, since=at, who=who))
    if not found and who is not None:
        known = read_database(address, _known)
        if who not in known:
            raise BridgeError(f"nobody called {who!r} is known here; known are: {listed_names(known)}")
    for entry in reversed(found):
        row = (
            local_time(entry.at),
            entry.who,
            entry.role or "-",
            entry.address or "-",
            entry.action,
            entry.subject or "-",
            "done" if entry.done else "refused",
            entry.detail or "",
        )
        # A line break in a received text must not look like an entry of its own.
        typer.echo("\t".join("".join(c if c.isprintable() else "?" for c in text) for text in row))


def _known(connection: Connection) -> list[str]:
    """Return the names of accounts, and of log entries without an account, sorted."""
    owners = [grant.owner for grant in grants(connection)]
    return sorted({*owners, *audit_log.accounts_in_log(connection)})


def _seconds(text: str | None) -> float | None:
    if text is None:
        return None
    try:
        return datetime.fromisoformat(text).timestamp()
    except ValueError:
        raise BridgeError(f"--since {text!r} is no time; write it like 2026-11-21T08:00") from None
