"""``robot-bridge database``: make the tables, bring them up to date, say how they are."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from pathlib import Path
from typing import Annotated, TypeVar

import typer
from sqlalchemy import URL, Connection

from ..errors import StoreError
from ..store import revisions
from ..store.accounts.choice import has_accounts, keeper_on
from ..store.address import shown
from ..store.backups.backing_up import revision_in
from ..store.database import run_once
from ..store.engines.sqlite import SQLite
from ..store.sole_gateway import no_gateway
from . import backup, gateway_account
from .database_option import DEFAULT, DatabaseOption, PasswordFileOption, database_address
from .noted import noting

T = TypeVar("T")

app = typer.Typer(help="Make, upgrade and check the database.", no_args_is_help=True)
app.command()(gateway_account.account)
backup.add_to(app)


@app.command()
def create(
    database: DatabaseOption = DEFAULT,
    database_password_file: PasswordFileOption = None,
    for_backup: Annotated[
        Path | None,
        typer.Option(
            help="Make them as they are in this backup, so that it can be restored and then upgraded."
        ),
    ] = None,
) -> None:
    """Make the tables in an empty database; a server's database itself must be there."""
    address = database_address(database, database_password_file)
    revision = revisions.NEEDED if for_backup is None else revision_in(address, for_backup)
    with noting(address, "database create", shown(address)):
        _run(address, lambda connection: revisions.create(connection, revision))
    print(f"{shown(address)}: made the tables, revision {revision}")


@app.command()
def upgrade(database: DatabaseOption = DEFAULT, database_password_file: PasswordFileOption = None) -> None:
    """Bring the tables of an older version up to date, with all that is in them; no gateway may run on it."""
    address = _there(database_address(database, database_password_file))
    with noting(address, "database upgrade", shown(address), f"to revision {revisions.NEEDED}"):
        found = asyncio.run(_upgrade(address))
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


async def _upgrade(address: URL) -> str:
    """Upgrade while no gateway runs; return the revision that was there."""
    async with no_gateway(address, "robot-bridge database upgrade"):
        found = await asyncio.to_thread(_run, address, revisions.upgrade)
        if has_accounts(address.drivername):
            await asyncio.to_thread(_run, address, lambda connection: keeper_on(connection).renew_rights())
    return found


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
