"""``robot-bridge trajectories``: export and import of positions of robots."""

from __future__ import annotations

import asyncio
import time
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Annotated

import typer

from ..core.errors import BridgeError, counted
from ..core.messages.base import check_robot_name
from ..core.messages.robots import SendPos
from ..gateway.storage.database import Database
from ..gateway.storage.repositories.trajectories import Fix, TrajectoryQuery
from ..gateway.trajectories.exchange import RecordedDrive, TrajectoryFile, import_drives
from ..gateway.trajectories.exchange import export_trajectories as write
from ..links.base.frames import FrameSettings, LinkFrame
from ..recordings.csv_table import TableForm
from ..recordings.readers import ReadingOptions, read_recording
from ..recordings.tracks import Recording, Track
from . import options

# --- ``robot-bridge trajectories import``: a recorded drive into the database ---

_LEAST_DATE = 1e8
"""seconds since 1970: a time below counts from the recording's begin."""


def import_recording(
    file: Annotated[Path, typer.Argument(help="The recording: .csv, .csv.gz, .gpx, .gpkg, or a ROS bag.")],
    site: options.SiteOption,
    database: options.DatabaseOption = options.DEFAULT,
    database_password_file: options.PasswordFileOption = None,
    robot: Annotated[
        list[str] | None,
        typer.Option(help="NAME of the one robot recorded; or RECORDED=NAME, repeatedly: no others."),
    ] = None,
    begin: Annotated[
        str | None, typer.Option(help="When it began: 2026-11-21T08:00 (UTC); without it as recorded.")
    ] = None,
    crs: Annotated[str, typer.Option(help="What x and y are: site, utm, wgs84 or EPSG:32633.")] = "site",
    origin: Annotated[str, typer.Option(help="Where the recording's (0, 0) is in it.")] = "0,0",
    rotation: Annotated[float, typer.Option(help="Degrees from its x axis to the recording's.")] = 0.0,
    column: Annotated[
        list[str] | None, typer.Option(help="Column of CSV: time=t_s; time robot x y lat lon theta v.")
    ] = None,
    delimiter: Annotated[str, typer.Option(help="Delimiter of CSV.")] = ",",
    time_unit: Annotated[str, typer.Option(help="Unit of times in CSV: s, ms, us or ns.")] = "s",
    theta_unit: Annotated[str, typer.Option(help="Unit of theta in CSV: rad, deg or compass.")] = "rad",
    topic: Annotated[list[str] | None, typer.Option(help="Topics of a bag, as /*/odom; repeatedly.")] = None,
) -> None:
    """Put a recorded drive into the database, where nothing is stored of its robots in that time."""
    columns = dict(_pair("--column", text) for text in column or ())
    form = TableForm(columns, delimiter, time_unit, theta_unit)
    form.check()
    settings = options.site_settings(site)
    recording = read_recording(file, ReadingOptions(form, tuple(topic or ())))
    _print_remarks(recording)
    own = FrameSettings(crs=recording.crs or crs, origin=_origin(origin), rotation_deg=rotation)
    if recording.crs is not None and (crs, origin, rotation) != ("site", "0,0", 0.0):
        raise BridgeError(
            f"{file} says itself what its coordinates are; leave out --crs, --origin, --rotation"
        )
    frame = LinkFrame(own, settings.frame, str(file))
    shift = _shift(recording, begin)
    drives = [
        RecordedDrive(
            name, float(track.t[0]) + shift, float(track.t[-1]) + shift, _fixes(track, name, frame, shift)
        )
        for track, name in _named(recording.tracks, robot or (), file)
    ]
    address = options.database_address(database, database_password_file)

    async def work() -> int:
        opened = Database(address, patience=None)
        try:
            return await import_drives(opened, drives, settings.trajectories, time.time())
        finally:
            await opened.close()

    stored = asyncio.run(work())
    for drive in drives:
        typer.echo(f"{drive.robot}: {drive.span}")
    typer.echo(f"{file}: {counted(stored, 'position')} stored of {recording.count}")


def _fixes(track: Track, name: str, frame: LinkFrame, shift: float) -> Iterator[Fix]:
    rows = zip(
        *(column.tolist() for column in (track.t, track.x, track.y, track.theta, track.v)), strict=True
    )
    for at, x, y, theta, v in rows:
        try:
            place = frame.pose_to_site(x, y, theta)
        except ValueError as error:
            raise BridgeError(f"robot {name}: {error}; nothing was written") from None
        yield Fix(name, at + shift, SendPos(*place, v, t=at))


def _named(tracks: Sequence[Track], choices: Sequence[str], file: Path) -> list[tuple[Track, str]]:
    """Return the chosen tracks, with the names of their robots."""
    known = {track.robot: track for track in tracks}
    if len(choices) == 1 and "=" not in choices[0]:
        if len(tracks) > 1:
            raise BridgeError(
                f"{file} has {len(tracks)} robots; write --robot RECORDED={choices[0]}. Recorded are "
                f"{', '.join(list(known)[:20])}"
            )
        return [(tracks[0], check_robot_name(choices[0]))]
    pairs = [_pair("--robot", text) for text in choices] or [(name, name) for name in known]
    for recorded, _ in pairs:
        if recorded not in known:
            raise BridgeError(
                f"{file}: no robot is recorded as {recorded!r}; there are {', '.join(list(known)[:20])}"
            )
    names = [check_robot_name(name) for _, name in pairs]
    if len(set(names)) < len(names):
        raise BridgeError("--robot: two drives would be of one robot; give each its own name")
    return [(known[recorded], name) for recorded, name in pairs]


def _shift(recording: Recording, begin: str | None) -> float:
    """Return the seconds from the recording's times to those since 1970."""
    at = options.seconds_of("--begin", begin)
    if at is not None:
        return at - recording.begin
    if recording.begin < _LEAST_DATE:
        raise BridgeError(
            f"{recording.file}: its times begin at {recording.begin:g} s and are no dates; give when it "
            "began with --begin 2026-11-21T08:00"
        )
    return 0.0


def _pair(option: str, text: str) -> tuple[str, str]:
    name, found, value = text.partition("=")
    if not (found and name and value):
        raise BridgeError(f"{option} {text!r} cannot be read; write it with a = between the two names")
    return name, value


def _origin(text: str) -> tuple[float, float]:
    try:
        x, y = (float(part) for part in text.split(","))
    except ValueError:
        raise BridgeError(f"--origin {text!r} cannot be read; write X,Y") from None
    return x, y


def _print_remarks(recording: Recording) -> None:
    for text in recording.remarks.texts:
        typer.echo(text, err=True)
    if recording.remarks.count:
        typer.echo(f"{recording.file}: {counted(recording.remarks.count, 'row')} left out", err=True)


# --- ``robot-bridge trajectories``: positions of robots from the database ---

app = typer.Typer(help="Where robots have been.", no_args_is_help=True)


app.command("import")(import_recording)


@app.callback()
def trajectories() -> None:
    """Where robots have been."""


@app.command()
def export(
    file: Annotated[Path, typer.Argument(help="The GeoPackage to be written.")],
    site: options.SiteOption,
    database: options.DatabaseOption = options.DEFAULT,
    database_password_file: options.PasswordFileOption = None,
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
    first, last = options.time_span(since, until)
    query = TrajectoryQuery(
        robots=tuple(check_robot_name(name) for name in robot or ()),
        since=first,
        until=last,
        bounds=_bounds(bounds),
    )
    frame = options.site_settings(site).frame
    address = options.database_address(database, database_password_file)

    async def work() -> TrajectoryFile:
        opened = Database(address, patience=None)
        try:
            return await write(opened, query, frame, file, gap)
        finally:
            await opened.close()

    written = asyncio.run(work())
    positions, tracks = counted(written.positions, "position"), counted(written.tracks, "track")
    typer.echo(f"{file}: {positions}, {tracks}")


@app.command()
def archive(
    folder: Annotated[Path, typer.Argument(help="The folder of the files, trajectories-2026-11-21.parquet.")],
    site: options.SiteOption,
    database: options.DatabaseOption = options.DEFAULT,
    database_password_file: options.PasswordFileOption = None,
    since: Annotated[str | None, typer.Option(help="The first day (UTC): 2026-11-21.")] = None,
    until: Annotated[str | None, typer.Option(help="The last day; yesterday unless given.")] = None,
    replace: Annotated[bool, typer.Option("--replace", help="Write days anew that are in FOLDER.")] = False,
) -> None:
    """Write positions as GeoParquet: a file for each day that is over and not in FOLDER yet."""
    from ..gateway.trajectories.archive import ArchivedDay, archive_days, choose_days, require_pyarrow

    require_pyarrow()
    settings = options.site_settings(site)
    first, last = options.day_of("--since", since), options.day_of("--until", until)
    address = options.database_address(database, database_password_file)

    def report(day: ArchivedDay) -> None:
        robots = counted(day.robots, "robot")
        typer.echo(f"{day.file}: {counted(day.positions, 'position')} of {robots}")

    async def work() -> int:
        opened = Database(address, patience=None)
        try:
            days = choose_days(opened, first, last, settings.trajectories.keep_days, time.time())
            return await archive_days(opened, days, settings.frame, folder, replace=replace, report=report)
        finally:
            await opened.close()

    kept = asyncio.run(work())
    if kept:
        typer.echo(f"{counted(kept, 'day')} in {folder} already; --replace writes them anew")


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
