"""Which outlines can be obstacles, and what is said of those that cannot."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .model import Border, ShapeType
from .outlines import Outlines
from .segments import is_closed, signed_areas

SMALLEST_AREA = 1e-4
"""m² below which a ring encloses nothing at the precision of a map."""


@dataclass(frozen=True)
class Inspection:
    """K outlines whose rings close, which of them can be obstacles, and what is said of them.

    ``low`` and ``high``, (K, 2), are the corners of their bounding boxes. Note k is about outline
    ``note_row[k]``; ``note_everywhere`` marks those of outlines that have no place. Notes stand by what is
    wrong: the first ``note_counts[0]`` are of the first kind, and so on.
    """

    outlines: Outlines
    usable: NDArray[Any]
    low: NDArray[Any]
    high: NDArray[Any]
    notes: tuple[str, ...]
    note_row: NDArray[Any]
    note_everywhere: NDArray[Any]
    note_counts: tuple[int, ...]

    def near(self, border: Border) -> NDArray[Any]:
        """Tell which outlines' bounding boxes touch the border's rectangle, (K,) bool."""
        return touching(self.low, self.high, border)

    def notes_on(self, near: NDArray[Any]) -> tuple[str, ...]:
        """Return the notes on the outlines marked in ``near``, (K,) bool, and on those without a place."""
        kept = np.flatnonzero(self.note_everywhere | near[self.note_row])
        return tuple(self.notes[k] for k in kept)


def inspected(outlines: Outlines) -> Inspection:
    """Return ``outlines`` with every ring closed, and what is wrong with which."""
    outlines, closed = _closed_rings(outlines)
    low, high = _boxes(outlines.coordinates, outlines)
    lengths = np.diff(outlines.offsets)
    finite = _finite(outlines) & np.isfinite(outlines.height)
    ring = is_closed(outlines.shape_type)
    reasons = (
        (~finite, "has a coordinate or a height that is not a finite number"),
        (lengths < np.where(ring, 4, 2), "has too few points"),
        (ring & _flat(outlines), "is a ring that encloses nothing"),
        (
            (outlines.shape_type == ShapeType.STAIRS) & (lengths % 2 == 1),
            "is a flight of stairs whose risers are not pairs of points",
        ),
        (_extent(outlines) < 0.01, "is smaller than a centimetre"),
    )
    usable = np.ones(len(outlines), dtype=bool)
    rows = [closed]
    notes = [f"{outlines.source[k]}: is a ring that does not close; it is closed" for k in closed]
    for bad, reason in reasons:
        rows.append(np.flatnonzero(bad & usable))
        notes += [f"{outlines.source[k]}: {reason}; it is left out" for k in rows[-1]]
        usable &= ~bad
    note_row = np.concatenate(rows)
    everywhere = (~finite | (lengths == 0))[note_row]
    everywhere[: len(closed)] = False
    return Inspection(outlines, usable, low, high, tuple(notes), note_row, everywhere, tuple(map(len, rows)))


def touching(low: NDArray[Any], high: NDArray[Any], border: Border) -> NDArray[Any]:
    """Tell which boxes, from ``low`` to ``high``, (n, 2) each, touch the border's rectangle, (n,) bool."""
    corner_low, corner_high = (border.x_min, border.y_min), (border.x_max, border.y_max)
    touches: NDArray[Any] = np.all((high >= corner_low) & (low <= corner_high), axis=1)
    return touches


def _closed_rings(outlines: Outlines) -> tuple[Outlines, NDArray[Any]]:
    """Return the outlines with each ring closed by its first point, and the rows of those that were not."""
    lengths = np.diff(outlines.offsets)
    ring = np.flatnonzero(is_closed(outlines.shape_type) & (lengths >= 3))
    first, last = outlines.offsets[ring], outlines.offsets[ring + 1] - 1
    ends = outlines.coordinates[[first, last]]
    open_ = ring[((ends[0] != ends[1]) & np.isfinite(ends).all(axis=0)).any(axis=1)] if len(ring) else ring
    if not len(open_):
        return outlines, open_
    added = outlines.coordinates[outlines.offsets[open_]]
    coordinates = np.insert(outlines.coordinates, outlines.offsets[open_ + 1], added, axis=0)
    lengths[open_] += 1
    offsets = np.concatenate([np.zeros(1, dtype=np.int64), np.cumsum(lengths, dtype=np.int64)])
    return replace(outlines, coordinates=coordinates, offsets=offsets), open_


def _finite(outlines: Outlines) -> NDArray[Any]:
    finite = np.ones(len(outlines), dtype=bool)
    finite[_row(outlines)[~np.isfinite(outlines.coordinates).all(axis=1)]] = False
    return finite


def _flat(outlines: Outlines) -> NDArray[Any]:
    with np.errstate(invalid="ignore"):
        flat: NDArray[Any] = np.abs(signed_areas(outlines)) < SMALLEST_AREA
    return flat


def _extent(outlines: Outlines) -> NDArray[Any]:
    """Return the longer side of each outline's bounding box in whole centimetres, (K,) metres."""
    low, high = _boxes(np.round(outlines.coordinates, 2), outlines)
    with np.errstate(invalid="ignore"):
        # A centimetre is a little less than 0.01 in the difference of two large coordinates.
        extent: NDArray[Any] = np.round((high - low).max(axis=1), 2)
    return extent


def _boxes(coordinates: NDArray[Any], outlines: Outlines) -> tuple[NDArray[Any], NDArray[Any]]:
    """Return the lower and upper corners, (K, 2) each, of all outlines; without points, an inverted box."""
    low, high = np.full((len(outlines), 2), np.inf), np.full((len(outlines), 2), -np.inf)
    filled = np.diff(outlines.offsets) > 0
    if filled.any():
        starts = outlines.offsets[:-1][filled]
        low[filled] = np.minimum.reduceat(coordinates, starts)
        high[filled] = np.maximum.reduceat(coordinates, starts)
    return low, high


def _row(outlines: Outlines) -> NDArray[Any]:
    return np.repeat(np.arange(len(outlines)), np.diff(outlines.offsets))
