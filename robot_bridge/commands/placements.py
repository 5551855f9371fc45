"""``robot-bridge placements``: where cones were put down, out of the database."""

from __future__ import annotations

import asyncio
import dataclasses
from pathlib import Path
from typing import Annotated

import typer

from ..counting import counted
from ..errors import BridgeError
from ..known_names import told
from ..messages import GetPlacements, PlacementReport
from ..messages.placements import MOST_PLACEMENTS
from ..sites.settings import SETTINGS_FILE, read_settings
from ..store import placements as stored
from ..store.database import Database
from .database_option import DEFAULT, DatabaseOption, PasswordFileOption, database_address
from .times import span_of

app = typer.Typer(help="Where cones were put down.", no_args_is_help=True)


@app.callback()
def placements() -> None:
    """Where cones were put down."""


@app.command()
def export(
    file: Annotated[Path, typer.Argument(help="The file to be written: .csv, or .gpkg for GIS.")],
    site: Annotated[Path, typer.Option(help="Folder of the published site, for its CRS and frame.")],
    database: DatabaseOption = DEFAULT,
    database_password_file: PasswordFileOption = None,
    layout: Annotated[str | None, typer.Option(help="Only the cones of this layout.")] = None,
    plan: Annotated[str | None, typer.Option(help="Only the cones of this plan.")] = None,
    robot: Annotated[str | None, typer.Option(help="Only what this robot put down.")] = None,
    since: Annotated[
        str | None, typer.Option(help="Not before: 2026-11-21T08:00 (UTC), or with an offset such as +01:00.")
    ] = None,
    until: Annotated[str | None, typer.Option(help="Not after.")] = None,
    collected: Annotated[
        bool | None,
        typer.Option("--collected/--standing", help="Only those that were collected, or still stand."),
    ] = None,
    replace: Annotated[bool, typer.Option("--replace", help="Replace FILE if it is there.")] = False,
) -> None:
    """Write planned and as-placed positions, deviation, robot and time of each cone."""
    from ..placements.table import rows
    from ..placements.writing import write

    if file.suffix.lower() not in (".csv", ".gpkg"):
        raise BridgeError(
            f"{file} is neither a table nor a GeoPackage; write a name that ends in .csv or .gpkg"
        )
    if file.exists() and not replace:
        raise BridgeError(f"{file} is there already; choose another name, or give --replace")
    first, last = span_of(since, until)
    wanted = GetPlacements(
        layout=layout,
        plan=plan,
        robot=robot,
        since=first,
        until=last,
        collected=collected,
        limit=MOST_PLACEMENTS,
    )
    frame = read_settings(site / SETTINGS_FILE).frame
    address = database_address(database, database_password_file)

    async def work() -> list[PlacementReport]:
        opened = Database(address, patience=None)
        try:
            await _check_named(opened, wanted)
            return await _all(opened, wanted)
        finally:
            await opened.close()

    found = asyncio.run(work())
    write(rows(found, frame), frame, file)
    worst = max((one.deviation for one in found), default=0.0)
    typer.echo(f"{file}: {counted(len(found), 'cone')}, {worst:.3f} m off their places at most")


async def _check_named(database: Database, wanted: GetPlacements) -> None:
    """Raise BridgeError for a layout, plan or robot of which no cone is stored, as for a misspelt one."""
    for kind in ("layout", "plan", "robot"):
        name = getattr(wanted, kind)
        if name is None or await database.run(stored.has_any, kind, name):
            continue
        known = await database.run(stored.names, kind)
        raise BridgeError(
            f"no cone of {kind} {name!r} is stored in this database; "
            f"{kind}s with cones in it: {told(known)}. Nothing was written"
        )


async def _all(database: Database, wanted: GetPlacements) -> list[PlacementReport]:
    """Return every page, in the order in which the cones were put down."""
    found: list[PlacementReport] = []
    while page := await database.run(stored.newest, wanted):
        found += page
        wanted = dataclasses.replace(wanted, before=page[-1].placement)
    return found[::-1]
