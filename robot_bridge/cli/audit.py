"""``robot-bridge audit``: who did what."""

from __future__ import annotations

from datetime import datetime
from typing import Annotated

import typer
from sqlalchemy import Connection

from ..core.errors import BridgeError, listed_names
from ..gateway.auth import audit as audit_log
from ..gateway.auth.accounts import grants
from .audited import local_time, read_database
from .options import DEFAULT, DatabaseOption, PasswordFileOption, database_address


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
        # A line break in what somebody sent must not look like an entry of its own.
        typer.echo("\t".join("".join(c if c.isprintable() else "?" for c in text) for text in row))


def _known(connection: Connection) -> list[str]:
    """Return who has an account, and who stands in the log without one, sorted."""
    owners = [grant.owner for grant in grants(connection)]
    return sorted({*owners, *audit_log.accounts_in_log(connection)})


def _seconds(text: str | None) -> float | None:
    if text is None:
        return None
    try:
        return datetime.fromisoformat(text).timestamp()
    except ValueError:
        raise BridgeError(f"--since {text!r} is no time; write it like 2026-11-21T08:00") from None
