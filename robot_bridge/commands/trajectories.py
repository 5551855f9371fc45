"""``robot-bridge trajectories``: where robots have been, out of the database."""

from __future__ import annotations

import asyncio
from pathlib import Path
from typing import Annotated

import typer

from ..counting import counted
from ..errors import BridgeError
from ..messages import check_robot_name
from ..sites.settings import SETTINGS_FILE, read_settings
from ..store.database import Database
from ..store.trajectories import Wanted
from ..trajectories.exporting import export as write
from ..trajectories.geopackage import TrajectoryFile
from .database_option import DEFAULT, DatabaseOption, PasswordFileOption, database_address
from .times import span_of
from .trajectory_import import import_recording

app = typer.Typer(help="Where robots have been.", no_args_is_help=True)


app.command("import")(import_recording)


@app.callback()
def trajectories() -> None:
    """Where robots have been."""


@app.command()
def export(
    file: Annotated[Path, typer.Argument(help="The GeoPackage to be written.")],
    site: Annotated[Path, typer.Option(help="Folder of the published site, for its CRS and frame.")],
    database: DatabaseOption = DEFAULT,
    database_password_file: PasswordFileOption = None,
    robot: Annotated[list[str] | None, typer.Option(help="Only this robot; may be given repeatedly.")] = None,
    since: Annotated[
        str | None, typer.Option(help="Not before: 2026-11-21T08:00 (UTC), or with an offset such as +01:00.")
    ] = None,
    until: Annotated[str | None, typer.Option(help="Not after.")] = None,
    bounds: Annotated[
        str | None, typer.Option(help="Only inside X_MIN,Y_MIN,X_MAX,Y_MAX, metres in the site frame.")
    ] = None,
    gap: Annotated[float, typer.Option(help="Seconds of silence that end a track.", min=1)] = 60.0,
    replace: Annotated[bool, typer.Option("--replace", help="Replace FILE if it is there.")] = False,
) -> None:
    """Write positions (points) and tracks (lines with M and times) into a GeoPackage, in the site's CRS."""
    if file.suffix.lower() != ".gpkg":
        raise BridgeError(f"{file} is no name for a GeoPackage; write one that ends in .gpkg")
    if file.exists() and not replace:
        raise BridgeError(f"{file} is there already; choose another name, or give --replace")
    first, last = span_of(since, until)
    wanted = Wanted(
        robots=tuple(check_robot_name(name) for name in robot or ()),
        since=first,
        until=last,
        bounds=_bounds(bounds),
    )
    frame = read_settings(site / SETTINGS_FILE).frame
    address = database_address(database, database_password_file)

    async def work() -> TrajectoryFile:
        opened = Database(address, patience=None)
        try:
            return await write(opened, wanted, frame, file, gap)
        finally:
            await opened.close()

    written = asyncio.run(work())
    positions, tracks = counted(written.positions, "position"), counted(written.tracks, "track")
    typer.echo(f"{file}: {positions}, {tracks}")


def _bounds(text: str | None) -> tuple[float, float, float, float] | None:
    if text is None:
        return None
    try:
        x_min, y_min, x_max, y_max = (float(part) for part in text.split(","))
    except ValueError:
        raise BridgeError(f"--bounds {text!r} cannot be read; write X_MIN,Y_MIN,X_MAX,Y_MAX") from None
    if not (x_min <= x_max and y_min <= y_max):
        raise BridgeError(f"--bounds {text!r} holds nothing; write X_MIN,Y_MIN,X_MAX,Y_MAX")
    return x_min, y_min, x_max, y_max
