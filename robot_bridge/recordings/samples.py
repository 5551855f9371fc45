"""What every reader makes of a file: positions one by one, and remarks on those that cannot be used."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import NamedTuple

from ..messages.bounds import COORDINATE, SPEED, THETA

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
