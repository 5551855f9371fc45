"""``robot-bridge database backup`` and ``restore``."""

from __future__ import annotations

import asyncio
from pathlib import Path
from typing import Annotated

import typer

from ..store import revisions
from ..store.address import shown
from ..store.backups.backing_up import back_up
from ..store.backups.backing_up import restore as put_back
from .database_option import DEFAULT, DatabaseOption, PasswordFileOption, database_address
from .noted import noting


def backup(
    file: Annotated[Path, typer.Argument(help="The file to be written.")],
    database: DatabaseOption = DEFAULT,
    database_password_file: PasswordFileOption = None,
    replace: Annotated[bool, typer.Option("--replace", help="Replace FILE if it is there.")] = False,
) -> None:
    """Write all that the database holds into one file; the gateway may run meanwhile."""
    address = database_address(database, database_password_file)
    with noting(address, "database backup", shown(address), str(file.absolute())):
        size = back_up(address, file, replace=replace)
    typer.echo(f"{file}: {size} bytes")


def restore(
    file: Annotated[Path, typer.Argument(help="A backup of the same kind of database.")],
    database: DatabaseOption = DEFAULT,
    database_password_file: PasswordFileOption = None,
    replace: Annotated[bool, typer.Option("--replace", help="Replace what the database holds.")] = False,
) -> None:
    """Put a backup in the place of what the database holds; no gateway may run on it."""
    address = database_address(database, database_password_file)
    with noting(address, "database restore", shown(address), str(file.absolute())):
        revision = asyncio.run(put_back(address, file, replace=replace))
    typer.echo(f"{file} is restored into {shown(address)}")
    if revision != revisions.NEEDED:
        typer.echo(f"its tables are of revision {revision}; run now: robot-bridge database upgrade")


def add_to(app: typer.Typer) -> None:
    """Add both commands to a group."""
    app.command()(backup)
    app.command()(restore)
