"""Centrelines of roads as columns, and road surfaces: what the network is built from."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, fields, replace
from typing import Any, Final, Literal

import numpy as np
from numpy.typing import NDArray

from ..errors import RoadInputError

# --- Centrelines of roads as columns: what the network is built from ---

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

BOTH, FORWARD, BACKWARD = 0, 1, -1
"""Directions in which a road may be driven, as seen along its digitised line."""

DEFAULT_SPEED = 1.0
"""m/s on a road of which no speed is known."""


@dataclass(frozen=True)
class Centrelines:
    """``m`` lines with attributes, metres in the site frame.

    Line ``k`` is ``xy[first[k]:first[k + 1]]``; ``xy`` is (n, 2), ``first`` (m + 1,). ``width`` is in metres,
    ``speed`` in m/s, ``direction`` one of BOTH, FORWARD and BACKWARD, ``level`` 0 on the ground, above it on
    bridges and below it in tunnels. ``source`` is the index of the road that each line is a piece of.
    """

    xy: Floats
    first: Ints
    width: Floats
    surface: NDArray[np.object_]
    direction: NDArray[np.int8]
    speed: Floats
    closed: NDArray[np.bool_]
    level: Ints
    source: Ints

    def __len__(self) -> int:
        return len(self.first) - 1

    def line(self, k: int) -> Floats:
        """Return the points of line ``k``, (n, 2)."""
        return self.xy[self.first[k] : self.first[k + 1]]

    def counts(self) -> Ints:
        """Return how many points each line has, (m,)."""
        return np.diff(self.first)

    def lengths(self) -> Floats:
        """Return the metres of each line, (m,)."""
        along = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(self.xy, axis=0).T))])
        lengths: Floats = along[self.first[1:] - 1] - along[self.first[:-1]]
        return lengths

    def taken(self, keep: NDArray[Any]) -> Centrelines:
        """Return the lines with the indices ``keep``, in that order."""
        counts = self.counts()[keep]
        first = np.concatenate([[0], np.cumsum(counts)])
        points = ranges(self.first[:-1][keep], counts)
        return self.with_lines(self.xy[points], first, keep)

    def with_lines(self, xy: Floats, first: Ints, of: NDArray[Any]) -> Centrelines:
        """Return other lines; line ``k`` has the attributes that line ``of[k]`` has here."""
        columns = {name: getattr(self, name)[of] for name in _ATTRIBUTES}
        return replace(self, xy=xy, first=first, **columns)


_ATTRIBUTES = tuple(field.name for field in fields(Centrelines) if field.name not in ("xy", "first"))


def centrelines(
    lines: Sequence[Any],
    width: Any = 3.5,
    surface: Any = "",
    direction: Any = BOTH,
    speed: Any = DEFAULT_SPEED,
    closed: Any = False,
    level: Any = 0,
) -> Centrelines:
    """Return ``lines``, each (n, 2) with n ≥ 2, as columns; an attribute is one value or one for each line.

    :raises RoadInputError: naming the first road that is none.
    """
    arrays = [np.asarray(line, dtype=np.float64) for line in lines]
    for k, line in enumerate(arrays):
        if line.ndim != 2 or line.shape[1] != 2 or len(line) < 2:
            raise RoadInputError(f"Road {k} has the shape {line.shape}: give two points (x, y) or more.")
    count = len(arrays)
    made = Centrelines(
        xy=np.concatenate(arrays) if arrays else np.empty((0, 2)),
        first=np.concatenate([[0], np.cumsum([len(line) for line in arrays])]).astype(np.int64),
        width=_column(width, count, np.float64),
        surface=_column(surface, count, np.object_),
        direction=_column(direction, count, np.int8),
        speed=_column(speed, count, np.float64),
        closed=_column(closed, count, np.bool_),
        level=_column(level, count, np.int64),
        source=np.arange(count),
    )
    _check(made)
    return made


def ranges(start: Ints, count: Ints) -> Ints:
    """Return start[0], start[0] + 1, ... (count[0] of them), start[1], ... in one array."""
    total = int(count.sum())
    ends = np.cumsum(count)
    numbers: Ints = np.arange(total) + np.repeat(start - (ends - count), count)
    return numbers


def _column(value: Any, count: int, kind: Any) -> NDArray[Any]:
    column = np.asarray(value, dtype=kind)
    return np.full(count, value, dtype=kind) if column.ndim == 0 else column.reshape(count)


def _check(roads: Centrelines) -> None:
    finite = np.isfinite(roads.xy).all(axis=1)
    if not finite.all():
        k = int(np.searchsorted(roads.first, int(np.argmin(finite)), side="right")) - 1
        raise RoadInputError(f"Road {k} has a coordinate that is no number: correct it or leave it out.")
    for name in ("width", "speed"):
        values = getattr(roads, name)
        good = np.isfinite(values) & (values > 0)
        if not good.all():
            k = int(np.argmin(good))
            raise RoadInputError(f"The {name} of road {k} is {values[k]:g}: give a number above 0.")
    if not np.isin(roads.direction, (BOTH, FORWARD, BACKWARD)).all():
        k = int(np.argmin(np.isin(roads.direction, (BOTH, FORWARD, BACKWARD))))
        raise RoadInputError(f"The direction of road {k} is {roads.direction[k]}: give 0, 1 or -1.")


# --- One piece of ground to drive on ---

Origin = Literal["drawn", "generated"]
"""Where a surface comes from: a person's hand, or the widths of centrelines."""

DRAWN: Final = "drawn"
GENERATED: Final = "generated"


@dataclass(frozen=True)
class Surface:
    """One polygon of a class such as ``asphalt``, its ``label``.

    ``rings`` holds the outer ring and then its holes, each (n, 2), metres in the site frame, closed.
    ``origin`` is DRAWN or GENERATED.
    """

    rings: tuple[Floats, ...]
    label: str
    name: str = ""
    origin: Origin = DRAWN
