"""Samples that every reader makes of a file: positions, times, remarks, errors."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, field
from datetime import UTC, datetime
from typing import NamedTuple

from ..core.errors import BridgeError
from ..core.messages.validation import COORDINATE, SPEED, THETA

# --- The exception family of recordings ---


class RecordingError(BridgeError):
    """A file of which nothing can be played; the text names file, row and column, and what to do."""


# --- What every reader makes of a file: positions one by one, and remarks on those that cannot be used

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

    ``theta`` is radians counter-clockwise from the x axis (from east in WGS84), ``v`` m/s; NaN for what the
    recording does not say. ``row`` is where it stands in the file.
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
    """Positions as they stand in a file.

    ``crs`` is ``wgs84`` (x is the longitude, degrees) or a code of a projected CRS; None where the file does
    not say it.
    """

    crs: str | None
    samples: Iterator[Sample]


@dataclass
class Remarks:
    """What in a file cannot be used, and where: all are counted, the first few are kept as texts."""

    count: int = 0
    texts: list[str] = field(default_factory=list)

    def add(self, where: str, what: str) -> None:
        """Note that what stands at ``where`` is left out."""
        self.count += 1
        if len(self.texts) < MOST_REMARKS:
            self.texts.append(f"{where}: {what}")


class ValueRefusedError(ValueError):
    """A value that cannot be used; the text says why, and :attr:`column` which it is."""

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
    """Return what people are shown of a text from a file."""
    return repr(text if len(text) <= 40 else f"{text[:40]}…") if text else "nothing"


TIME_BOUNDS, SPEED_BOUNDS, THETA_BOUNDS = (-LATEST, LATEST), SPEED, THETA


# --- Times in recordings: seconds, parts of seconds, or dates as ISO 8601 ---

UNITS = {"s": 1.0, "ms": 1e3, "us": 1e6, "ns": 1e9}
"""How many of each are a second."""


def seconds_of(text: str, column: str, unit: str = "s") -> float:
    """Return a time as seconds: a number in ``unit``, or a date and time, UTC where it has no offset.

    :raises ValueRefusedError: for what is neither.
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
