"""``robot-bridge database``: create, upgrade and back up the tables, report their state."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from pathlib import Path
from typing import Annotated, TypeVar

import typer
from sqlalchemy import URL, Connection

from ..core.errors import StoreError
from ..core.files import replacement
from ..core.messages.base import check_robot_name
from ..core.sites.site_database import is_database_address, read_site_address
from ..gateway.storage import revisions
from ..gateway.storage.backup import back_up, revision_in
from ..gateway.storage.backup import restore as put_back
from ..gateway.storage.database import run_once, shown
from ..gateway.storage.dialects import SQLite
from ..gateway.storage.map_views import map_views_on, views_made_again, virtual_layers
from ..gateway.storage.roles.choice import has_accounts, map_readers_on, role_manager_on
from ..gateway.storage.singleton_lock import no_gateway
from .accounts import NewPasswordOption, new_password
from .audit import act_audited, audited
from .options import DEFAULT, DatabaseOption, PasswordFileOption, SiteOption, database_address, site_settings

# --- ``robot-bridge database backup`` and ``restore`` ---


def backup(
    file: Annotated[Path, typer.Argument(help="The file to be written.")],
    database: DatabaseOption = DEFAULT,
    database_password_file: PasswordFileOption = None,
    replace: Annotated[bool, typer.Option("--replace", help="Replace FILE if it is there.")] = False,
) -> None:
    """Write all that the database holds into one file; the gateway may run meanwhile."""
    address = database_address(database, database_password_file)
    with audited(address, "database backup", shown(address), str(file.absolute())):
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
    with audited(address, "database restore", shown(address), str(file.absolute())):
        revision = asyncio.run(put_back(address, file, replace=replace))
    typer.echo(f"{file} is restored into {shown(address)}")
    if revision != revisions.NEEDED:
        typer.echo(f"its tables are of revision {revision}; run now: robot-bridge database upgrade")


def add_backup_commands(app: typer.Typer) -> None:
    """Add both commands to a group."""
    app.command()(backup)
    app.command()(restore)


# --- ``robot-bridge database account``: the account that the gateway runs under ---


def account(
    name: Annotated[str, typer.Argument(help="The account's name.")],
    password_file: NewPasswordOption = None,
    database: DatabaseOption = DEFAULT,
    database_password_file: PasswordFileOption = None,
) -> None:
    """Make the account that the gateway runs under: it reads and writes rows and changes no table.

    For PostgreSQL and MariaDB, as an administrator of the server. The password is printed once, alone on
    standard output.
    """
    check_robot_name(name)
    address = database_address(database, database_password_file)
    password = new_password(password_file)
    act_audited(
        address,
        "database account",
        name,
        None,
        lambda connection: role_manager_on(connection).add_gateway(name, password),
    )
    if password_file is None:
        print(password)
    gateway = address._replace(username=name, password=None)
    typer.echo(f"account {name} is there: robot-bridge serve --database {shown(gateway)}", err=True)


# --- ``robot-bridge database views`` and ``reader``: the fleet for GIS programs ---


def views(
    context: typer.Context,
    site: SiteOption = "",
    remove: Annotated[bool, typer.Option("--remove", help="Remove the views.")] = False,
    vrt: Annotated[
        Path | None, typer.Option(help="SQLite: write the file by which GDAL and QGIS open the views.")
    ] = None,
    database: DatabaseOption = DEFAULT,
    database_password_file: PasswordFileOption = None,
) -> None:
    """Make views of robots, trajectories, commands, cones and observations for QGIS and other GIS programs.

    PostgreSQL needs PostGIS; on SQLite, --vrt writes the file that is opened.
    """
    address = _there(database_address(database, database_password_file))
    source = context.get_parameter_source("site")
    if remove and source is not None and source.name == "ENVIRONMENT":
        site = ""
    if remove == bool(site):
        raise StoreError("give --site FOLDER to make the views, or --remove to remove them")
    if vrt is not None and address.drivername != SQLite.name:
        raise StoreError("--vrt is for SQLite; GIS programs open the views of PostgreSQL by themselves")
    if not site:
        act_audited(address, "database views", shown(address), "removed", _without_views)
        print(f"{shown(address)}: the views are removed")
        return
    frame = site_settings(site).frame
    named = read_site_address(site).shown if is_database_address(site) else site
    names = act_audited(
        address, "database views", shown(address), named, lambda db: map_views_on(db).make(frame)
    )
    print(f"{shown(address)}: made {', '.join(names)}")
    if vrt is not None:
        layers = virtual_layers(str(Path(address.database or "").absolute()), frame)
        try:
            with replacement(vrt) as partial:
                partial.write_text(layers, "utf-8")
        except OSError as error:
            raise StoreError(
                f"{vrt} cannot be written: {error.strerror or error}; check its folder"
            ) from error
        print(f"{vrt}: open it in QGIS, or with ogrinfo")


def reader(
    name: Annotated[str, typer.Argument(help="The account's name.")],
    password_file: NewPasswordOption = None,
    database: DatabaseOption = DEFAULT,
    database_password_file: PasswordFileOption = None,
) -> None:
    """Make an account that reads the views and nothing else, for PostgreSQL, as the server's administrator.

    The password is printed once, alone on standard output.
    """
    check_robot_name(name)
    address = database_address(database, database_password_file)
    password = new_password(password_file)
    act_audited(
        address, "database reader", name, None, lambda db: map_readers_on(db).add_map_reader(name, password)
    )
    if password_file is None:
        print(password)
    typer.echo(f"account {name} is there: {shown(address._replace(username=name, password=None))}", err=True)


def _without_views(connection: Connection) -> None:
    map_views_on(connection).remove()


# --- ``robot-bridge database``: create and upgrade the tables, report their state ---

T = TypeVar("T")

app = typer.Typer(help="Make, upgrade and check the database.", no_args_is_help=True)
app.command()(account)
app.command()(views)
app.command()(reader)
add_backup_commands(app)


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
    with audited(address, "database create", shown(address)):
        _run(address, lambda connection: revisions.create(connection, revision))
    print(f"{shown(address)}: made the tables, revision {revision}")


@app.command()
def upgrade(database: DatabaseOption = DEFAULT, database_password_file: PasswordFileOption = None) -> None:
    """Bring the tables of an older version up to date, with all that is in them; no gateway may run on it."""
    address = _there(database_address(database, database_password_file))
    with audited(address, "database upgrade", shown(address), f"to revision {revisions.NEEDED}"):
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
    """Upgrade while no gateway runs; return the previous revision."""
    async with no_gateway(address, "robot-bridge database upgrade"):
        found = await asyncio.to_thread(_run, address, _upgrade_tables)
        if has_accounts(address.drivername):
            await asyncio.to_thread(
                _run, address, lambda connection: role_manager_on(connection).renew_rights()
            )
    return found


def _upgrade_tables(connection: Connection) -> str:
    """Upgrade the tables; views, which block changes of columns, are recreated afterwards."""
    with views_made_again(connection):
        return revisions.upgrade(connection)


def _there(address: URL) -> URL:
    """Return ``address`` if it exists, as SQLite would create a missing file. Raises StoreError."""
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
