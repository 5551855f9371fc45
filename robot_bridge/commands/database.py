"""``robot-bridge database``: make the tables, bring them up to date, say how they are."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TypeVar

import typer
from sqlalchemy import URL, Connection

from ..errors import StoreError
from ..store import revisions
from ..store.accounts.choice import has_accounts, keeper_on
from ..store.address import shown
from ..store.database import run_once
from ..store.engines.sqlite import SQLite
from . import backup, gateway_account
from .database_option import DEFAULT, DatabaseOption, PasswordFileOption, database_address

T = TypeVar("T")

app = typer.Typer(help="Make, upgrade and check the database.", no_args_is_help=True)
app.command()(gateway_account.account)
backup.add_to(app)


@app.command()
def create(database: DatabaseOption = DEFAULT, database_password_file: PasswordFileOption = None) -> None:
    """Make the tables in an empty database; a server's database itself must be there."""
    address = database_address(database, database_password_file)
    _run(address, revisions.create)
    print(f"{shown(address)}: made the tables, revision {revisions.NEEDED}")


@app.command()
def upgrade(database: DatabaseOption = DEFAULT, database_password_file: PasswordFileOption = None) -> None:
    """Bring the tables of an older version up to date, with all that is in them; end the gateway first."""
    address = database_address(database, database_password_file)
    found = _run(_there(address), revisions.upgrade)
    if has_accounts(address.drivername):
        _run(address, lambda connection: keeper_on(connection).renew_rights())
    if found == revisions.NEEDED:
        print(f"{shown(address)}: revision {found}, nothing is to be done")
    else:
        print(f"{shown(address)}: upgraded from revision {found} to {revisions.NEEDED}")


@app.command()
def check(database: DatabaseOption = DEFAULT, database_password_file: PasswordFileOption = None) -> None:
    """Say which revision the tables have, which is needed, and what differs; status 1 when something does."""
    address = database_address(database, database_password_file)
    report = _run(_there(address), revisions.report)
    print(f"{shown(address)}: revision {report.found or 'none, no tables of the bridge'}")
    print(f"needed: revision {revisions.NEEDED}")
    for difference in report.differences:
        print(f"differs: {difference}")
    if not report.good:
        raise StoreError(f"database {shown(address)} cannot be used as it is; {report.advice}")
    print("the tables are those that this version works with")


def _there(address: URL) -> URL:
    """Return ``address``; SQLite would make a file that is missing. Raises StoreError."""
    file = address.database if address.drivername == SQLite.name else None
    if file and not file.startswith("file:") and not Path(file).is_file():
        raise StoreError(
            f"database {shown(address)}: there is no such file; correct the path, or make it with: "
            "robot-bridge database create"
        )
    return address


def _run(address: URL, work: Callable[[Connection], T]) -> T:
    try:
        return run_once(address, work)
    except revisions.RevisionError as error:
        raise StoreError(f"database {shown(address)}: {error}") from None
