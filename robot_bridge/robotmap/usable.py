"""Which outlines can be obstacles, and what is said of those that cannot."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .model import Border, ShapeType
from .outlines import Outlines
from .segments import is_closed, signed_areas

SMALLEST_AREA = 1e-4
"""m² below which a ring encloses nothing at the precision of a map."""


def closed_rings(outlines: Outlines, border: Border | None) -> tuple[Outlines, list[str]]:
    """Return the outlines with their first point repeated at the end of rings that do not close.

    Also a warning for each of them that touches ``border``.
    """
    lengths = np.diff(outlines.offsets)
    ring = np.flatnonzero(is_closed(outlines.shape_type) & (lengths >= 3))
    first, last = outlines.offsets[ring], outlines.offsets[ring + 1] - 1
    ends = outlines.coordinates[[first, last]]
    open_ = ring[((ends[0] != ends[1]) & np.isfinite(ends).all(axis=0)).any(axis=1)] if len(ring) else ring
    if not len(open_):
        return outlines, []
    added = outlines.coordinates[outlines.offsets[open_]]
    coordinates = np.insert(outlines.coordinates, outlines.offsets[open_ + 1], added, axis=0)
    lengths[open_] += 1
    offsets = np.concatenate([np.zeros(1, dtype=np.int64), np.cumsum(lengths, dtype=np.int64)])
    near = _near(outlines, border)
    warnings = [
        f"{outlines.source[k]}: is a ring that does not close; it is closed" for k in open_ if near[k]
    ]
    return replace(outlines, coordinates=coordinates, offsets=offsets), warnings


def usable_outlines(outlines: Outlines, border: Border | None) -> tuple[NDArray[Any], list[str]]:
    """Return (K,) bool, true for outlines to cut at ``border``, and a warning for each other that touches it.

    An outline with no points, or with one that is not finite, touches everything.
    """
    closed = is_closed(outlines.shape_type)
    lengths = np.diff(outlines.offsets)
    finite = _finite(outlines) & np.isfinite(outlines.height)
    reasons = (
        (~finite, "has a coordinate or a height that is not a finite number"),
        (lengths < np.where(closed, 4, 2), "has too few points"),
        (closed & _flat(outlines), "is a ring that encloses nothing"),
        (
            (outlines.shape_type == ShapeType.STAIRS) & (lengths % 2 == 1),
            "is a flight of stairs whose risers are not pairs of points",
        ),
        (_extent(outlines) < 0.01, "is smaller than a centimetre"),
    )
    near = _near(outlines, border) | ~finite | (lengths == 0)
    usable = np.ones(len(outlines), dtype=bool)
    warnings = []
    for bad, reason in reasons:
        warnings += [
            f"{outlines.source[k]}: {reason}; it is left out" for k in np.flatnonzero(bad & usable & near)
        ]
        usable &= ~bad
    return usable & near, warnings


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


def _near(outlines: Outlines, border: Border | None) -> NDArray[Any]:
    """Tell which outlines' bounding boxes touch the border's rectangle."""
    if border is None:
        return np.ones(len(outlines), dtype=bool)
    low, high = _boxes(outlines.coordinates, outlines)
    corner_low, corner_high = (border.x_min, border.y_min), (border.x_max, border.y_max)
    near: NDArray[Any] = ((high >= corner_low) & (low <= corner_high)).all(axis=1)
    return near


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
