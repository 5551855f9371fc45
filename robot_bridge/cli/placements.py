"""``robot-bridge placements``: placed cones to files, CSV, GeoJSON or GeoPackage."""

from __future__ import annotations

import asyncio
import csv
import dataclasses
import struct
from collections.abc import Callable, Sequence
from datetime import UTC, datetime
from pathlib import Path
from typing import Annotated, Any

import numpy as np
import typer

from ..core.errors import BridgeError, counted, listed_names
from ..core.files import replacement, write_geopackage_layer
from ..core.messages.records import MOST_PLACEMENTS, GetPlacements, PlacementReport
from ..core.sites.frame import SiteFrame, projections
from ..gateway.storage.database import Database
from ..gateway.storage.repositories import records as stored
from . import options

# --- Placed cones as columns: in the site frame, in the site's CRS, and their deviation along both axes

Row = dict[str, Any]

TIMES = ("placed_at", "collected_at")
TEXTS = ("layout", "cone", "label", "plan", "task", "robot", "collected_by")
NUMBERS = (
    "planned_x",
    "planned_y",
    "x",
    "y",
    "dx",
    "dy",
    "deviation",
    "easting",
    "northing",
    "planned_easting",
    "planned_northing",
)
NAMES = ("placement", *TEXTS[:6], TIMES[0], *NUMBERS, TIMES[1], TEXTS[6])
"""The columns, in order."""


def cone_rows(placed: Sequence[PlacementReport], frame: SiteFrame) -> list[Row]:
    """Return a row for each cone: metres in the site frame, easting and northing in its CRS, times in UTC.

    ``dx`` and ``dy`` are the cone's deviation from its plan along the axes of the site frame.
    """
    points = frame.to_crs([(one.x, one.y) for one in placed])
    planned = frame.to_crs([(one.planned_x, one.planned_y) for one in placed])
    return [_row(*both) for both in zip(placed, points, planned, strict=True)]


def _row(one: PlacementReport, point: Any, planned: Any) -> Row:
    return {
        "placement": one.placement,
        "layout": one.layout,
        "cone": one.cone,
        "label": one.label,
        "plan": one.plan,
        "task": one.task,
        "robot": one.robot,
        "placed_at": _time(one.placed_at),
        "planned_x": one.planned_x,
        "planned_y": one.planned_y,
        "x": one.x,
        "y": one.y,
        "dx": one.x - one.planned_x,
        "dy": one.y - one.planned_y,
        "deviation": one.deviation,
        "easting": float(point[0]),
        "northing": float(point[1]),
        "planned_easting": float(planned[0]),
        "planned_northing": float(planned[1]),
        "collected_at": _time(one.collected_at),
        "collected_by": one.collected_by,
    }


def _time(seconds: float | None) -> datetime | None:
    return None if seconds is None else datetime.fromtimestamp(seconds, UTC)


# --- Export of placed cones: CSV, or a GeoPackage for GIS ---
# Layers of the GeoPackage, in the site's CRS: ``placed`` and ``planned`` (points), ``deviations`` (lines
# from the plan to the cone).

_LAYERS: dict[str, tuple[str, Callable[[Row], bytes]]] = {
    "placed": ("Point", lambda row: _point(row["easting"], row["northing"])),
    "planned": ("Point", lambda row: _point(row["planned_easting"], row["planned_northing"])),
    "deviations": ("LineString", lambda row: _line(row)),
}


def write_placed_cones(found: Sequence[Row], frame: SiteFrame, file: Path) -> None:
    """Write ``file`` atomically; its suffix, ``.csv`` or ``.gpkg``, selects the format.

    :raises BridgeError: when it cannot be written.
    """
    as_file = {".csv": _write_csv, ".gpkg": _write_geopackage}[file.suffix.lower()]
    try:
        with replacement(file) as partial:
            as_file(found, frame, partial)
    except OSError as error:
        raise BridgeError(f"{file} cannot be written: {error.strerror or error}; check its folder") from error


def _write_csv(found: Sequence[Row], _frame: SiteFrame, file: Path) -> None:
    with file.open("w", newline="", encoding="utf-8") as text:
        writer = csv.DictWriter(text, NAMES)
        writer.writeheader()
        writer.writerows({name: _text(row[name]) for name in NAMES} for row in found)


def _text(value: Any) -> Any:
    if value is None:
        return ""
    if isinstance(value, float):
        return f"{value:.3f}"
    return value if isinstance(value, (int, str)) else value.isoformat(timespec="milliseconds")


def _write_geopackage(found: Sequence[Row], frame: SiteFrame, file: Path) -> None:
    projections()  # before pyogrio imports pyproj aloud
    columns = {name: _column(found, name) for name in NAMES}
    for layer, (kind, blob) in _LAYERS.items():
        geometry = np.empty(len(found), dtype=object)
        geometry[:] = [blob(row) for row in found]
        try:
            write_geopackage_layer(file, layer, kind, geometry, columns, frame.crs)
        except OSError as error:
            raise BridgeError(
                f"{file} cannot be written: {error}; check the folder and free space"
            ) from error


def _column(found: Sequence[Row], name: str) -> Any:
    values = [row[name] for row in found]
    if name in TIMES:
        at = [
            np.datetime64("NaT") if v is None else np.datetime64(v.replace(tzinfo=None), "ms") for v in values
        ]
        return np.array(at, dtype="datetime64[ms]")
    if name in TEXTS:
        return np.array(values, dtype=object)
    return np.array(values, dtype=np.int64 if name == "placement" else np.float64)


def _point(x: float, y: float) -> bytes:
    return struct.pack("<BI2d", 1, 1, x, y)


def _line(row: Row) -> bytes:
    ends = (row["planned_easting"], row["planned_northing"], row["easting"], row["northing"])
    return struct.pack("<BII4d", 1, 2, 2, *ends)


# --- ``robot-bridge placements``: placed cones from the database ---

app = typer.Typer(help="Where cones were put down.", no_args_is_help=True)


@app.callback()
def placements() -> None:
    """Where cones were put down."""


@app.command()
def export(
    file: Annotated[Path, typer.Argument(help="The file to be written: .csv, or .gpkg for GIS.")],
    site: options.SiteOption,
    database: options.DatabaseOption = options.DEFAULT,
    database_password_file: options.PasswordFileOption = None,
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
    rows = cone_rows
    write = write_placed_cones

    if file.suffix.lower() not in (".csv", ".gpkg"):
        raise BridgeError(
            f"{file} is neither a table nor a GeoPackage; write a name that ends in .csv or .gpkg"
        )
    if file.exists() and not replace:
        raise BridgeError(f"{file} is there already; choose another name, or give --replace")
    first, last = options.time_span(since, until)
    query = GetPlacements(
        layout=layout,
        plan=plan,
        robot=robot,
        since=first,
        until=last,
        collected=collected,
        limit=MOST_PLACEMENTS,
    )
    frame = options.site_settings(site).frame
    address = options.database_address(database, database_password_file)

    async def work() -> list[PlacementReport]:
        opened = Database(address, patience=None)
        try:
            await _check_named(opened, query)
            return await _all(opened, query)
        finally:
            await opened.close()

    found = asyncio.run(work())
    write(rows(found, frame), frame, file)
    worst = max((one.deviation for one in found), default=0.0)
    typer.echo(f"{file}: {counted(len(found), 'cone')}, {worst:.3f} m off their places at most")


async def _check_named(database: Database, query: GetPlacements) -> None:
    """Raise BridgeError for a layout, plan or robot without stored cones, such as a misspelt one."""
    for kind in ("layout", "plan", "robot"):
        name = getattr(query, kind)
        if name is None or await database.run(stored.has_any, kind, name):
            continue
        known = await database.run(stored.names, kind)
        raise BridgeError(
            f"no cone of {kind} {name!r} is stored in this database; "
            f"{kind}s with cones in it: {listed_names(known)}. Nothing was written"
        )


async def _all(database: Database, query: GetPlacements) -> list[PlacementReport]:
    """Return all pages, in the order of placing."""
    found: list[PlacementReport] = []
    while page := await database.run(stored.newest_placed_cones, query):
        found += page
        query = dataclasses.replace(query, before=page[-1].placement)
    return found[::-1]
