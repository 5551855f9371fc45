"""An archive of trajectories: each whole day (UTC) as one GeoParquet 1.1 file, written in bounded memory.

A point for each stored position, as WKB in the site's CRS, in the order of time. pyarrow is imported only
here; only ``robot-bridge trajectories archive`` uses this module.
"""

from __future__ import annotations

import asyncio
import json
import math
from collections.abc import AsyncIterator, Callable, Sequence
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

import numpy as np

from ...core.errors import BridgeError
from ...core.files import replacement
from ...core.sites.frame import SiteFrame, crs_of
from ..storage.database import Database
from ..storage.repositories import trajectories
from ..storage.repositories.trajectories import DAY, PageMark, StoredPosition, TrajectoryQuery
from .exchange import position_columns

PAGE = 50_000
"""positions read at once, and in one row group: some 80 MB of memory."""
_POINT = np.dtype([("order", "u1"), ("kind", "<u4"), ("x", "<f8"), ("y", "<f8")])
"""A point as well-known binary."""
_BOX = ("xmin", "ymin", "xmax", "ymax")


@dataclass(frozen=True)
class ArchivedDay:
    """An archived day: its file, and the numbers of positions and robots."""

    file: Path
    positions: int
    robots: int


def require_pyarrow() -> None:
    """Raise BridgeError where pyarrow is not installed."""
    try:
        import pyarrow.parquet  # noqa: F401 - only to see if it is installed
    except ImportError as error:
        raise BridgeError(
            f"an archive needs pyarrow ({error}); install it with: "
            "pip install 'fleet-supervisor-robot-bridge[archive]'"
        ) from None


# --- Choice of days ---


def choose_days(
    database: Database, first: int | None, last: int | None, keep_days: float, now: float
) -> AsyncIterator[int]:
    """Return the days from ``first`` to ``last``, days since 1970-01-01, of which positions are stored.

    Unless given, ``last`` is yesterday (UTC). If old positions are deleted one by one (``keep_days``),
    ``first`` is the first day without deletions; if days are dropped whole, the oldest.

    :raises BridgeError: for a day not over at ``now``, and if there is no day from first to last.
    """
    today = int(now // DAY)
    if last is not None and last >= today:
        raise BridgeError(f"{day_name(last)} is not over yet, by UTC; the last day to archive is yesterday")
    last = today - 1 if last is None else last
    if first is not None and first > last:
        raise BridgeError(f"no day is from {day_name(first)} to {day_name(last)}")
    if first is None:
        whole = math.ceil(now / DAY - keep_days)
        first = 0 if database.dialect.partitions_days else max(0, whole)
    return _stored_days(database, first, last)


async def _stored_days(database: Database, day: int, last: int) -> AsyncIterator[int]:
    while day <= last:
        at = await database.run(trajectories.next_time, day * DAY)
        if at is None or (day := int(at // DAY)) > last:
            return
        yield day
        day += 1


def day_name(day: int) -> str:
    """Return a day as 2026-11-21."""
    return datetime.fromtimestamp(day * DAY, UTC).strftime("%Y-%m-%d")


# --- Export from the database into files, each whole or not at all ---


async def archive_days(
    database: Database,
    days: AsyncIterator[int],
    frame: SiteFrame,
    folder: Path,
    *,
    replace: bool,
    report: Callable[[ArchivedDay], None],
) -> int:
    """Write ``days`` into ``folder``, and report each; return how many already existed and were kept.

    :raises BridgeError: when a file cannot be written, and when a day is deleted meanwhile; StoreError for
    the database. Files written before stay.
    """
    kept = 0
    async for day in days:
        file = folder / f"trajectories-{day_name(day)}.parquet"
        if file.exists() and not replace:
            kept += 1
            continue
        try:
            with replacement(file) as partial:
                positions, robots = await _write_day(database, day, frame, partial)
        except OSError as error:
            raise BridgeError(
                f"{file} cannot be written: {error.strerror or error}; check its folder and free space"
            ) from error
        report(ArchivedDay(file, positions, robots))
    return kept


async def _write_day(database: Database, day: int, frame: SiteFrame, file: Path) -> tuple[int, int]:
    """Write ``file``; return the numbers of positions and robots."""
    with DayFile(file, frame) as written:
        query = TrajectoryQuery(since=day * DAY, until=math.nextafter((day + 1) * DAY, 0))
        begin = page = await database.run(trajectories.read, query, PAGE)
        while page:
            await asyncio.to_thread(written.add, page)
            if len(page) < PAGE:
                break
            after = PageMark(page[-1].received_at, page[-1].id)
            page = await database.run(trajectories.read, query, PAGE, after)
        # Old positions are deleted oldest first, or the day at once.
        if not begin or await database.run(trajectories.read, query, 1) != begin[:1]:
            raise BridgeError(
                f"positions of {day_name(day)} were deleted or added while they were archived; that day is "
                "not written. Archive days before they are too old (trajectories.keep_days of site.toml)"
            )
    return written.positions, len(written.robots)


class DayFile:
    """Writes one GeoParquet file, a row group for each page; to be used in a ``with`` block.

    :raises OSError: when it cannot be written.
    """

    def __init__(self, file: Path, frame: SiteFrame) -> None:
        import pyarrow.parquet

        self._frame = frame
        self._bounds = np.array([math.inf, math.inf, -math.inf, -math.inf])
        self.positions, self.robots = 0, set[str]()
        self._writer = pyarrow.parquet.ParquetWriter(
            file,
            _schema(),
            compression="zstd",
            use_dictionary=["robot"],
            # Half as many bytes as plain ones.
            use_byte_stream_split=_SPLIT,
            write_statistics=True,
        )

    def __enter__(self) -> DayFile:
        """Return itself."""
        return self

    def __exit__(self, kind: type[BaseException] | None, *_: object) -> None:
        """Write the end of the file, with its geometry metadata."""
        if kind is None:
            self._writer.add_key_value_metadata(self._metadata())
        self._writer.close()

    def add(self, places: Sequence[StoredPosition]) -> None:
        """Write the next positions, in the order of their time."""
        import pyarrow

        columns = position_columns(places, self._frame)
        points = self._frame.to_crs(np.column_stack([columns["x"], columns["y"]]))
        boxes = _boxes(points)
        self._bounds = np.concatenate(
            [
                np.minimum(self._bounds[:2], points.min(axis=0)),
                np.maximum(self._bounds[2:], points.max(axis=0)),
            ]
        )
        self.positions += len(places)
        self.robots.update(columns["robot"])
        columns["time"] = _microseconds(places)
        schema = _schema()
        arrays = [
            pyarrow.array(columns[name], schema.field(name).type, from_pandas=True)
            for name in schema.names
            if name in columns
        ]
        box_arrays = [pyarrow.array(boxes[:, k]) for k in range(len(_BOX))]
        arrays += [pyarrow.StructArray.from_arrays(box_arrays, list(_BOX)), _wkb(points)]
        self._writer.write_table(pyarrow.Table.from_arrays(arrays, schema=schema), row_group_size=PAGE)

    def _metadata(self) -> dict[str, str]:
        frame = self._frame
        geometry = {
            "encoding": "WKB",
            "geometry_types": ["Point"],
            "crs": crs_of(frame.crs).to_json_dict(),
            "bbox": self._bounds.tolist(),
            "covering": {"bbox": {name: ["bbox", name] for name in _BOX}},
        }
        geo = {"version": "1.1.0", "primary_column": "geometry", "columns": {"geometry": geometry}}
        # The frame of x, y and theta.
        own = {"crs": frame.crs, "origin": frame.origin, "rotation_deg": math.degrees(frame.rotation)}
        return {"geo": json.dumps(geo), "site_frame": json.dumps(own)}


_NUMBERS = ("x", "y", "theta", "heading", "v", "device_time", "fix_time")
_SPLIT = [*_NUMBERS, *(f"bbox.{name}" for name in _BOX)]


def _schema() -> Any:
    import pyarrow

    box = pyarrow.struct([(name, pyarrow.float32()) for name in _BOX])
    return pyarrow.schema(
        [
            ("robot", pyarrow.string()),
            ("time", pyarrow.timestamp("us", "UTC")),
            *((name, pyarrow.float64()) for name in _NUMBERS),
            ("bbox", box),
            ("geometry", pyarrow.binary()),
        ]
    )


def _microseconds(places: Sequence[StoredPosition]) -> Any:
    seconds = np.array([place.received_at for place in places], dtype=np.float64)
    return np.round(seconds * 1e6).astype("datetime64[us]")


def _boxes(points: Any) -> Any:
    """Return the (n, 4) float32 boxes around (n, 2) points, which lie within."""
    near = points.astype(np.float32)
    low = np.where(near > points, np.nextafter(near, np.float32(-np.inf)), near)
    high = np.where(near < points, np.nextafter(near, np.float32(np.inf)), near)
    return np.concatenate([low, high], axis=1)


def _wkb(points: Any) -> Any:
    """Return (n, 2) points as an Arrow array of well-known binary."""
    import pyarrow

    blobs = np.zeros(len(points), dtype=_POINT)
    blobs["order"], blobs["kind"] = 1, 1
    blobs["x"], blobs["y"] = points.T
    offsets = np.arange(len(points) + 1, dtype=np.int32) * _POINT.itemsize
    buffers = [None, pyarrow.py_buffer(offsets), pyarrow.py_buffer(blobs)]
    return pyarrow.Array.from_buffers(pyarrow.binary(), len(points), buffers)
