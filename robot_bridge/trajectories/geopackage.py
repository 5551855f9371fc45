"""Trajectories as a GeoPackage: every stored position, and the lines between them with times.

Layer ``positions``: points with the site's coordinates and UTC times. Layer ``tracks``: one line for each
time a robot was under way, its measure M the time in seconds since 1970-01-01 UTC. The CRS is the site's.
"""

from __future__ import annotations

import struct
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from ..compass import headings_of
from ..errors import BridgeError
from ..sites.frame import SiteFrame
from ..sites.projections import projections
from ..store.trajectories import Place

POSITIONS, TRACKS = "positions", "tracks"

_MEASURED_LINE = 2002
"""The code of a LineString with M in well-known binary (ISO)."""
_UTC = 100
"""GDAL's code for UTC in a field of date and time."""


@dataclass
class Track:
    """The places of one robot without a gap: rows of time, x, y in CRS metres."""

    robot: str
    rows: list[tuple[float, float, float]] = field(default_factory=list)

    @property
    def length(self) -> float:
        """Metres from place to place."""
        xy = np.asarray(self.rows)[:, 1:]
        return float(np.hypot(*np.diff(xy, axis=0).T).sum())


class TrajectoryFile:
    """Writes a GeoPackage of trajectories, page by page.

    A robot that was not heard of for more than ``gap`` seconds begins a new track.
    """

    def __init__(self, file: Path, frame: SiteFrame, gap: float) -> None:
        self._file = file
        self._frame = frame
        self._gap = gap
        self._open: dict[str, Track] = {}
        self.positions = 0
        self.tracks = 0

    def add(self, places: Sequence[Place]) -> None:
        """Write the next page of places, which come in the order of their time.

        :raises BridgeError: when the file cannot be written.
        """
        if not places and self._file.exists():
            return
        points = self._frame.to_crs([(place.x, place.y) for place in places])
        self._write(POSITIONS, "Point", _point_blobs(points), _columns(places, self._frame))
        self.positions += len(places)
        ended = [
            track for place, (x, y) in zip(places, points, strict=True) for track in self._extend(place, x, y)
        ]
        self._write_tracks(ended)

    def finish(self) -> None:
        """Write the tracks that have no end yet."""
        open_tracks, self._open = list(self._open.values()), {}
        self._write_tracks(open_tracks)

    def _extend(self, place: Place, x: float, y: float) -> Iterable[Track]:
        track = self._open.get(place.robot)
        if track is not None and place.received_at - track.rows[-1][0] > self._gap:
            yield track
            track = None
        if track is None:
            track = self._open[place.robot] = Track(place.robot)
        track.rows.append((place.received_at, x, y))

    def _write_tracks(self, tracks: Sequence[Track]) -> None:
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
        projections()  # before pyogrio imports pyproj aloud
        import pyogrio

        times = [name for name, values in columns.items() if values.dtype.kind == "M"]
        try:
            pyogrio.raw.write(
                str(self._file),
                geometry=geometry,
                field_data=list(columns.values()),
                fields=list(columns),
                layer=layer,
                driver="GPKG",
                geometry_type=kind,
                crs=self._frame.crs,
                append=self._file.exists(),
                dataset_options={"VERSION": "1.3"},
                gdal_tz_offsets={name: np.full(len(geometry), _UTC) for name in times},
            )
        except (pyogrio.errors.DataSourceError, pyogrio.errors.DataLayerError, OSError) as error:
            raise BridgeError(
                f"{self._file} cannot be written: {error}; check the folder and free space"
            ) from error


def _columns(places: Sequence[Place], frame: SiteFrame) -> dict[str, Any]:
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


def _line_blob(track: Track) -> bytes:
    rows = np.asarray(track.rows)[:, [1, 2, 0]]
    return struct.pack("<BII", 1, _MEASURED_LINE, len(rows)) + rows.astype("<f8").tobytes()


def _blobs(blobs: Iterable[bytes]) -> Any:
    found = list(blobs)
    column = np.empty(len(found), dtype=object)
    column[:] = found
    return column
