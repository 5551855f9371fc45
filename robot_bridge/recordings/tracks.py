"""Samples from the readers of files, and the tracks of a recording that are gathered from them."""

from __future__ import annotations

import math
from array import array
from bisect import bisect_left
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from datetime import UTC, datetime
from pathlib import Path
from typing import Literal, NamedTuple

import numpy as np
import numpy.typing as npt

from ..core.errors import BridgeError
from ..core.messages.base import COORDINATE, SPEED, THETA

# --- Samples from the readers of files ---

# --- The exception family of recordings ---


class RecordingError(BridgeError):
    """A file without usable positions; the text names file, row, column and remedy."""


# --- Results of every reader: positions one by one, and remarks on unusable ones

WGS84 = "wgs84"
MOST_SAMPLES = 10_000_000
"""positions of a recording: half a gigabyte of memory."""
MOST_ROBOTS = 2_000
MOST_REMARKS = 20
LATEST = 4e9
"""seconds since 1970 or since the recording began; a time beyond is in another unit."""
LATITUDE, LONGITUDE = (-90.0, 90.0), (-180.0, 180.0)
NOTHING = math.nan


class Sample(NamedTuple):
    """Where a robot was: ``t`` seconds, ``x`` and ``y`` in the CRS of its :class:`Source`.

    ``theta`` is radians counter-clockwise from the x axis (from east in WGS84), ``v`` m/s; NaN for values
    missing in the recording. ``row`` is its row in the file.
    """

    row: int
    robot: str
    t: float
    x: float
    y: float
    theta: float = NOTHING
    v: float = NOTHING


@dataclass(frozen=True)
class Source:
    """Positions as stored in a file.

    ``crs`` is ``wgs84`` (x is the longitude, degrees) or a code of a projected CRS; None if the file does
    not say it.
    """

    crs: str | None
    samples: Iterator[Sample]


@dataclass
class Remarks:
    """Unusable parts of a file with their places: all are counted, the first few are kept as texts."""

    count: int = 0
    texts: list[str] = field(default_factory=list)

    def add(self, where: str, what: str) -> None:
        """Record that the position at ``where`` is left out."""
        self.count += 1
        if len(self.texts) < MOST_REMARKS:
            self.texts.append(f"{where}: {what}")


class ValueRefusedError(ValueError):
    """An unusable value; the text says why, and :attr:`column` names its column."""

    def __init__(self, column: str, why: str) -> None:
        super().__init__(f"column {column}: {why}")
        self.column = column


def number(text: str, column: str, bounds: tuple[float, float]) -> float:
    """Return the number in ``text``; raises ValueRefusedError."""
    try:
        value = float(text)
    except ValueError:
        raise ValueRefusedError(column, f"{shown(text)} is no number") from None
    if not bounds[0] <= value <= bounds[1]:
        raise ValueRefusedError(column, f"{shown(text)} is not a number from {bounds[0]:g} to {bounds[1]:g}")
    return value


def place_bounds(is_earth: bool) -> tuple[tuple[float, float], tuple[float, float]]:
    """Return the bounds of x and of y."""
    return (LONGITUDE, LATITUDE) if is_earth else (COORDINATE, COORDINATE)


def shown(text: str) -> str:
    """Return a text from a file in a form for messages."""
    return repr(text if len(text) <= 40 else f"{text[:40]}…") if text else "nothing"


TIME_BOUNDS, SPEED_BOUNDS, THETA_BOUNDS = (-LATEST, LATEST), SPEED, THETA


# --- Times in recordings: seconds, parts of seconds, or dates as ISO 8601 ---

UNITS = {"s": 1.0, "ms": 1e3, "us": 1e6, "ns": 1e9}
"""Units per second."""


def seconds_of(text: str, column: str, unit: str = "s") -> float:
    """Return a time as seconds: a number in ``unit``, or a date and time, UTC where it has no offset.

    :raises ValueRefusedError: for any other text.
    """
    try:
        at = float(text) / UNITS[unit]
    except ValueError:
        at = _of_date(text, column)
    if not -LATEST <= at <= LATEST:
        raise ValueRefusedError(column, f"{shown(text)} is no time in {unit}; give time_unit")
    return at


def _of_date(text: str, column: str) -> float:
    try:
        found = datetime.fromisoformat(text.strip())
        return (found if found.tzinfo else found.replace(tzinfo=UTC)).timestamp()
    except (ValueError, OverflowError):
        raise ValueRefusedError(column, f"{shown(text)} is no time") from None


# --- Tracks as columns, with headings and speeds from movement ---

# --- Headings and speeds from movement, for recordings without them; no I/O ---

Column = npt.NDArray[np.float64]

MEASURED, COURSE, LAST, UNKNOWN = range(4)
ORIGINS: tuple[Literal["course", "last", "unknown"] | None, ...] = (None, "course", "last", "unknown")
"""Values of ``theta_from``; columns hold their indices."""
LEAST_MOVE = 0.5
"""metres below which a move gives no course."""
STANDS_AFTER = 2.0
"""seconds without such a move after which a robot counts as standing."""
EARTH = 6_371_008.8
"""metres, the mean radius."""


def filled(
    t: Column, x: Column, y: Column, theta: Column, v: Column, *, is_earth: bool
) -> tuple[Column, npt.NDArray[np.int8], Column]:
    """Return headings, their origins, and speeds, with all unknown values filled.

    A missing heading becomes the course over ground, or the last one while the robot stands; before either is
    known it is 0. A missing speed becomes that over ground.
    """
    origins = np.zeros(len(t), dtype=np.int8)
    if not (np.isnan(theta).any() or np.isnan(v).any()):
        return theta, origins, v
    theta, v = theta.copy(), v.copy()
    east, north = _metres(x, y) if is_earth else (x, y)
    last_x, last_y, last_t = float(east[0]), float(north[0]), float(t[0])
    known, speed, course = math.nan, 0.0, math.nan
    for n, (at, px, py) in enumerate(zip(t.tolist(), east.tolist(), north.tolist(), strict=True)):
        move = math.hypot(px - last_x, py - last_y)
        if move > LEAST_MOVE:
            speed, course = move / (at - last_t), math.atan2(py - last_y, px - last_x)
            last_x, last_y, last_t = px, py, at
        elif at - last_t > STANDS_AFTER:
            speed = 0.0
        if not math.isnan(theta[n]):
            known = theta[n]
        elif speed > 0 and not math.isnan(course):
            theta[n] = known = course
            origins[n] = COURSE
        elif not math.isnan(known):
            theta[n], origins[n] = known, LAST
        else:
            theta[n], origins[n] = 0.0, UNKNOWN
        if math.isnan(v[n]):
            v[n] = speed
    return theta, origins, v


def _metres(lon: Column, lat: Column) -> tuple[Column, Column]:
    """Return metres east and north of the first place; accurate enough for moves of some metres."""
    scale = EARTH * math.pi / 180.0
    return (lon - lon[0]) * scale * np.cos(np.radians(lat)), (lat - lat[0]) * scale


# --- A recording in memory: for each robot its positions as columns, with increasing times ---


@dataclass(frozen=True)
class Track:
    """The positions of one robot: (n,) columns, ``t`` increasing.

    ``theta`` is known everywhere; ``theta_from`` (n,) is its origin, as indices into
    :data:`.tracks.ORIGINS`. ``v`` is m/s.
    """

    robot: str
    t: Column
    x: Column
    y: Column
    theta: Column
    theta_from: npt.NDArray[np.int8]
    v: Column


@dataclass(frozen=True)
class Recording:
    """The tracks of a file; ``crs`` is that of their coordinates, None if the file does not state it."""

    file: Path
    crs: str | None
    tracks: tuple[Track, ...]
    remarks: Remarks

    @property
    def begin(self) -> float:
        """The time of the first position, seconds."""
        return min(float(track.t[0]) for track in self.tracks)

    @property
    def end(self) -> float:
        """The time of the last position, seconds."""
        return max(float(track.t[-1]) for track in self.tracks)

    @property
    def count(self) -> int:
        """The number of positions."""
        return sum(len(track.t) for track in self.tracks)


def gather(file: Path, source: Source, remarks: Remarks) -> Recording:
    """Return the recording that ``source`` reads from ``file``.

    As few positions as possible are left out so that times increase; these are recorded in ``remarks``.

    :raises RecordingError: for a file without a position, and one with too many.
    """
    columns: dict[str, array[float]] = {}
    count = 0
    for count, sample in enumerate(source.samples, 1):
        known = columns.get(sample.robot)
        if known is None:
            known = columns[sample.robot] = array("d")
            if len(columns) > MOST_ROBOTS:
                raise RecordingError(
                    f"{file}: row {sample.row}: more than {MOST_ROBOTS} robots; is their column right?"
                )
        if count > MOST_SAMPLES:
            raise RecordingError(
                f"{file}: row {sample.row}: more than {MOST_SAMPLES} positions; part the file"
            )
        known.extend((sample.row, sample.t, sample.x, sample.y, sample.theta, sample.v))
    if not count:
        raise RecordingError(f"{file}: no position can be used{_because(remarks)}")
    tracks = [_track(file, name, column, source.crs, remarks) for name, column in columns.items()]
    return Recording(file, source.crs, tuple(tracks), remarks)


def _because(remarks: Remarks) -> str:
    return f"; the first of {remarks.count} remarks: {remarks.texts[0]}" if remarks.texts else ""


def _track(file: Path, robot: str, values: array[float], crs: str | None, remarks: Remarks) -> Track:
    rows = np.frombuffer(values, dtype=np.float64).reshape(-1, 6)
    times = rows[:, 1]
    if (np.diff(times) <= 0).any():
        kept = longest_rising(times.tolist())
        left_out = np.setdiff1d(np.arange(len(rows)), kept)
        for one in left_out.tolist():
            remarks.add(
                f"{file}: row {rows[one, 0]:.0f}",
                f"the time of robot {robot} does not go on: {times[one]:.3f} s",
            )
        rows = rows[kept]
    _, t, x, y, theta, v = (np.ascontiguousarray(column) for column in rows.T)
    headings, origins, speeds = filled(t, x, y, theta, v, is_earth=crs == WGS84)
    return Track(robot, t, x, y, headings, origins, speeds)


def longest_rising(values: Sequence[float]) -> npt.NDArray[np.int64]:
    """Return the indices of a longest increasing subsequence.

    If either of two values could be dropped, the earlier one is kept.
    """
    count = len(values)
    falling = _rising([-value for value in reversed(values)])
    return (count - 1 - falling)[::-1]


def _rising(values: Sequence[float]) -> npt.NDArray[np.int64]:
    # Patience sorting: of interchangeable values it keeps the later ones.
    ends: list[float] = []
    """the smallest last value of a run of each length."""
    at: list[int] = []
    before: list[int] = []
    for n, value in enumerate(values):
        length = bisect_left(ends, value)
        before.append(at[length - 1] if length else -1)
        if length == len(ends):
            ends.append(value)
            at.append(n)
        else:
            ends[length], at[length] = value, n
    found = np.empty(len(ends), dtype=np.int64)
    n = at[-1] if at else -1
    for place in range(len(ends) - 1, -1, -1):
        found[place] = n
        n = before[n]
    return found
