"""Exchange of trajectories: export to a GeoPackage, import of recorded drives."""

from __future__ import annotations

import asyncio
import logging
import struct
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, field
from datetime import UTC, datetime
from itertools import islice
from pathlib import Path
from typing import Any

import numpy as np

from ...core.errors import BridgeError, listed_names
from ...core.files import replacement, write_geopackage_layer
from ...core.geometry import headings_of
from ...core.sites.frame import SiteFrame, projections
from ...core.sites.settings_tables import TrajectorySettings
from ..storage.database import Database
from ..storage.repositories import robots as stored_robots
from ..storage.repositories import trajectories
from ..storage.repositories import trajectories as stored_trajectories
from ..storage.repositories.trajectories import Fix, PackedFix, PageMark, StoredPosition, TrajectoryQuery
from .recording import PositionThinning

# --- Trajectories as a GeoPackage: every stored position, and the lines between them with times ---
# Layer ``positions``: points with the site's coordinates and UTC times. Layer ``tracks``: one line for each
# drive of a robot, its measure M the time in seconds since 1970-01-01 UTC. The CRS is the site's.

POSITIONS, TRACKS = "positions", "tracks"

_MEASURED_LINE = 2002
"""The code of a LineString with M in well-known binary (ISO)."""


@dataclass
class TrajectoryLine:
    """The places of one robot without a gap: rows of time, x, y in CRS metres."""

    robot: str
    rows: list[tuple[float, float, float]] = field(default_factory=list)

    @property
    def length(self) -> float:
        """Length in metres."""
        xy = np.asarray(self.rows)[:, 1:]
        return float(np.hypot(*np.diff(xy, axis=0).T).sum())


class TrajectoryFile:
    """Writes a GeoPackage of trajectories, page by page.

    A robot silent for more than ``gap`` seconds begins a new track.
    """

    def __init__(self, file: Path, frame: SiteFrame, gap: float) -> None:
        self._file = file
        self._frame = frame
        self._gap = gap
        self._open: dict[str, TrajectoryLine] = {}
        self.positions = 0
        self.tracks = 0

    def add(self, places: Sequence[StoredPosition]) -> None:
        """Write the next page of places, in the order of their time.

        :raises BridgeError: when the file cannot be written.
        """
        if not places and self._file.exists():
            return
        points = self._frame.to_crs([(place.x, place.y) for place in places])
        self._write(POSITIONS, "Point", _point_blobs(points), position_columns(places, self._frame))
        self.positions += len(places)
        ended = [
            track for place, (x, y) in zip(places, points, strict=True) for track in self._extend(place, x, y)
        ]
        self._write_tracks(ended)

    def finish(self) -> None:
        """Write the unfinished tracks."""
        open_tracks, self._open = list(self._open.values()), {}
        self._write_tracks(open_tracks)

    def _extend(self, place: StoredPosition, x: float, y: float) -> Iterable[TrajectoryLine]:
        track = self._open.get(place.robot)
        if track is not None and place.received_at - track.rows[-1][0] > self._gap:
            yield track
            track = None
        if track is None:
            track = self._open[place.robot] = TrajectoryLine(place.robot)
        track.rows.append((place.received_at, x, y))

    def _write_tracks(self, tracks: Sequence[TrajectoryLine]) -> None:
        lines = [track for track in tracks if len(track.rows) > 1]
        self.tracks += len(lines)
        columns = {
            "robot": _texts(track.robot for track in lines),
            "begin": _times(track.rows[0][0] for track in lines),
            "end": _times(track.rows[-1][0] for track in lines),
            "length_m": np.array([track.length for track in lines], dtype=np.float64),
            "count": np.array([len(track.rows) for track in lines], dtype=np.int32),
        }
        self._write(TRACKS, "Measured LineString", _blobs(_line_blob(track) for track in lines), columns)

    def _write(self, layer: str, kind: str, geometry: Any, columns: dict[str, Any]) -> None:
        projections()  # before pyogrio imports pyproj with warnings
        try:
            write_geopackage_layer(self._file, layer, kind, geometry, columns, self._frame.crs)
        except OSError as error:
            raise BridgeError(
                f"{self._file} cannot be written: {error}; check the folder and free space"
            ) from error


def position_columns(places: Sequence[StoredPosition], frame: SiteFrame) -> dict[str, Any]:
    """Return (n,) columns of ``places`` by name, in the site frame; times to the millisecond, UTC.

    Unknown values are NaN. ``heading`` is in degrees, clockwise from grid north.
    """
    numbers = np.array(
        [
            (place.x, place.y, place.theta, place.v, _or_nan(place.device_time), _or_nan(place.fix_time))
            for place in places
        ],
        dtype=np.float64,
    ).reshape(-1, 6)
    heading = headings_of(numbers[:, 2] + frame.rotation)
    return {
        "robot": _texts(place.robot for place in places),
        "time": _times(place.received_at for place in places),
        "x": numbers[:, 0],
        "y": numbers[:, 1],
        "theta": numbers[:, 2],
        "heading": heading,
        "v": numbers[:, 3],
        "device_time": numbers[:, 4],
        "fix_time": numbers[:, 5],
    }


def _or_nan(value: float | None) -> float:
    return float("nan") if value is None else value


def _texts(values: Iterable[str]) -> Any:
    return np.array(list(values), dtype=object)


def _times(seconds: Iterable[float]) -> Any:
    return (np.array(list(seconds), dtype=np.float64) * 1000).round().astype("datetime64[ms]")


def _point_blobs(points: Any) -> Any:
    return _blobs(struct.pack("<BI2d", 1, 1, x, y) for x, y in points)


def _line_blob(track: TrajectoryLine) -> bytes:
    rows = np.asarray(track.rows)[:, [1, 2, 0]]
    return struct.pack("<BII", 1, _MEASURED_LINE, len(rows)) + rows.astype("<f8").tobytes()


def _blobs(blobs: Iterable[bytes]) -> Any:
    found = list(blobs)
    column = np.empty(len(found), dtype=object)
    column[:] = found
    return column


# --- Export from the database into a GeoPackage, whole or not at all ---

PAGE = 20_000
"""positions read and written at once."""


async def export_trajectories(
    database: Database, query: TrajectoryQuery, frame: SiteFrame, file: Path, gap: float
) -> TrajectoryFile:
    """Write the result of ``query`` into the new GeoPackage ``file``; return the written file.

    :raises BridgeError: for a robot without stored positions, and when the file cannot be written;
        StoreError for the database.
    """
    await _check_robots(database, query.robots)
    try:
        with replacement(file) as partial:
            written = TrajectoryFile(partial, frame, gap)
            await _copy(database, query, written)
    except OSError as error:
        raise BridgeError(f"{file} cannot be written: {error.strerror or error}; check its folder") from error
    return written


async def _check_robots(database: Database, robots: Sequence[str]) -> None:
    unknown = await database.run(trajectories.never_seen, robots)
    if unknown:
        known = await database.run(stored_robots.names)
        raise BridgeError(
            f"no position of robot {unknown[0]!r} is stored in this database; robots that are known in it: "
            f"{listed_names(known)}. Nothing was written"
        )


async def _copy(database: Database, query: TrajectoryQuery, written: TrajectoryFile) -> None:
    after = None
    while True:
        places = await database.run(trajectories.read, query, PAGE, after)
        await asyncio.to_thread(written.add, places)
        if len(places) < PAGE:
            break
        after = PageMark(places[-1].received_at, places[-1].id)
    await asyncio.to_thread(written.finish)


# --- Import of recorded drives, into times without stored positions, thinned as by the gateway

log = logging.getLogger(__name__)

BATCH = 5000
"""positions in one transaction: a gateway running on the database waits for no more than these."""


@dataclass(frozen=True)
class RecordedDrive:
    """A recording of ``robot`` from ``begin`` to ``end``, seconds since 1970.

    ``fixes`` are in the order of their times, and are iterated once.
    """

    robot: str
    begin: float
    end: float
    fixes: Iterable[Fix]

    @property
    def span(self) -> str:
        """Its times as readable text."""
        return f"{_text(self.begin)} to {_text(self.end)}"


async def import_drives(
    database: Database, drives: Sequence[RecordedDrive], settings: TrajectorySettings, now: float
) -> int:
    """Store ``drives``, all or none; return the number of positions stored after thinning.

    :raises BridgeError: if positions of a robot are stored in the time of its drive, for drives that the
    gateway would delete at once, and for unfinished ones; StoreError for the database.
    """
    for drive in drives:
        _check_times(drive, settings, now)
        if await database.run(trajectories.is_known_within, drive.robot, drive.begin, drive.end):
            raise BridgeError(
                f"positions of robot {drive.robot!r} are stored from {drive.span} already; nothing was "
                "written. Give another name with --robot, or another time with --begin"
            )
    count = 0
    begun: list[RecordedDrive] = []
    try:
        for drive in drives:
            begun.append(drive)
            for batch in _batches(_thinned(drive.fixes, settings)):
                if database.dialect.partitions_days:
                    await database.run(trajectories.make_days, trajectories.days_of(batch))
                await database.run(trajectories.add, batch)
                count += len(batch)
    except BaseException:
        for drive in begun:
            await _undo(database, drive)
        raise
    return count


def _check_times(drive: RecordedDrive, settings: TrajectorySettings, now: float) -> None:
    if drive.end > now:
        raise BridgeError(
            f"the drive of robot {drive.robot!r} is from {drive.span}, which is not over yet; give when it "
            "began with --begin"
        )
    if drive.begin < now - settings.keep_days * stored_trajectories.DAY:
        raise BridgeError(
            f"the drive of robot {drive.robot!r} is from {drive.span}; the gateway deletes what is older "
            f"than {settings.keep_days:g} days (trajectories.keep_days of site.toml). Give another time with "
            "--begin, or keep positions for longer"
        )


async def _undo(database: Database, drive: RecordedDrive) -> None:
    while await database.run(trajectories.forget_within, drive.robot, drive.begin, drive.end, BATCH):
        log.info("robot %s: positions are taken back", drive.robot)


def _thinned(fixes: Iterable[Fix], settings: TrajectorySettings) -> Iterator[PackedFix]:
    thinning = PositionThinning()
    for fix in fixes:
        if thinning.keeps(fix, settings):
            yield stored_trajectories.pack(fix)
    yield from map(stored_trajectories.pack, thinning.silent())


def _batches(fixes: Iterator[PackedFix]) -> Iterator[list[PackedFix]]:
    while batch := list(islice(fixes, BATCH)):
        yield batch


def _text(at: float) -> str:
    return datetime.fromtimestamp(at, UTC).strftime("%Y-%m-%dT%H:%M:%SZ")
