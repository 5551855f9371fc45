"""Outlines turned into oriented segments; arrays throughout."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .model import ShapeType
from .outlines import Outlines

CLOSED_TYPES = (ShapeType.CLOSED_POLYGON, ShapeType.CLOSED_CURVE, ShapeType.RAMP)
_IS_CLOSED = np.array([t in [int(closed) for closed in CLOSED_TYPES] for t in range(len(ShapeType) + 1)])


@dataclass(frozen=True)
class Segments:
    """n oriented segments in the order of their outlines.

    ``outline`` is the row each belongs to. ``number`` rises; a segment that begins where the one before it
    in its outline ends has the next number, any other one a number beyond that. ``cut``, (2, n) bool, tells
    which are cut where they begin, and which where they end.
    """

    a: NDArray[Any]
    b: NDArray[Any]
    height: NDArray[Any]
    outline: NDArray[Any]
    number: NDArray[Any]
    cut: NDArray[Any]

    @property
    def joined(self) -> NDArray[Any]:
        """Whether each begins where the one before it in the arrays ends, neither cut there, (n,) bool."""
        joined = np.zeros(len(self.number), dtype=bool)
        joined[1:] = (np.diff(self.number) == 1) & ~self.cut[1, :-1] & ~self.cut[0, 1:]
        return joined


def uncut(
    a: NDArray[Any], b: NDArray[Any], height: NDArray[Any], outline: NDArray[Any], joined: NDArray[Any]
) -> Segments:
    """Return segments that nothing has cut; ``joined`` tells which go on where the one before them ends."""
    return Segments(a, b, height, outline, np.cumsum(2 - joined), np.zeros((2, len(a)), dtype=bool))


def is_closed(shape_type: NDArray[Any]) -> NDArray[Any]:
    """Tell which shape types, (K,), are rings."""
    closed: NDArray[Any] = _IS_CLOSED.take(shape_type, mode="clip")
    return closed


def signed_areas(outlines: Outlines) -> NDArray[Any]:
    """Return the area of each outline, (K,) m², positive where its points run counter-clockwise."""
    if not len(outlines.coordinates):
        return np.zeros(len(outlines))
    lengths = np.diff(outlines.offsets)
    row = np.repeat(np.arange(len(outlines)), lengths)
    filled = lengths > 0
    # Relative to each outline's first point: UTM-sized coordinates would cost six digits.
    first = np.zeros((len(outlines), 2))
    first[filled] = outlines.coordinates[outlines.offsets[:-1][filled]]
    x, y = (outlines.coordinates - first[row]).T
    cross = np.zeros(len(x))
    cross[:-1] = x[:-1] * y[1:] - x[1:] * y[:-1]
    cross[outlines.offsets[1:][filled] - 1] = 0.0
    return np.bincount(row, weights=cross, minlength=len(outlines)) / 2


def oriented_segments(outlines: Outlines, usable: NDArray[Any]) -> Segments:
    """Return the segments of the outlines marked in ``usable``, (K,) bool.

    Solid rings run counter-clockwise, courtyards clockwise: free space is to the right of a→b. Lines keep the
    direction they were drawn in. Each riser of stairs is a segment, the last of height 0; the way up is on
    its left, so that it is seen from below (paper 1, section II). Coordinates are rounded to centimetres
    here, before any clipping, so that a corner is the same in every window.
    """
    coordinates = np.round(outlines.coordinates, 2)
    lengths = np.diff(outlines.offsets)
    row = np.repeat(np.arange(len(outlines)), lengths)
    index = np.arange(len(row)) - outlines.offsets[:-1][row]
    stairs = outlines.shape_type == ShapeType.STAIRS
    begins = (index < lengths[row] - 1) & (~stairs[row] | (index % 2 == 0)) & usable[row]
    start = np.flatnonzero(begins)
    a, b, outline = coordinates[start], coordinates[start + 1], row[start]
    height = outlines.height[outline].astype(np.float64)
    height[stairs[outline] & (index[start] >= lengths[outline] - 2)] = 0.0
    joined = np.zeros(len(start), dtype=bool)
    joined[1:] = (outline[1:] == outline[:-1]) & ~stairs[outline[1:]]
    turn = _seen_from_above(outlines, a, b, outline)[:, None]
    segments = uncut(np.where(turn, b, a), np.where(turn, a, b), height, outline, joined)
    backwards = is_closed(outlines.shape_type) & ((signed_areas(outlines) > 0) == outlines.courtyard)
    return _turned_round(segments, backwards) if backwards.any() else segments


def _seen_from_above(
    outlines: Outlines, a: NDArray[Any], b: NDArray[Any], outline: NDArray[Any]
) -> NDArray[Any]:
    """Tell which segments are risers with the way up on their right."""
    stairs = outlines.shape_type[outline] == ShapeType.STAIRS
    first, last = outlines.offsets[outline], outlines.offsets[outline + 1] - 1
    points = outlines.coordinates
    top = points[np.maximum(last - 1, first)] + points[last]
    up, along = top - points[first] - points[np.minimum(first + 1, last)], b - a
    above: NDArray[Any] = stairs & (along[:, 0] * up[:, 1] - along[:, 1] * up[:, 0] < 0)
    return above


def _turned_round(segments: Segments, backwards: NDArray[Any]) -> Segments:
    """Return the segments with those of the outlines in ``backwards`` in the opposite direction and order."""
    turn = backwards[segments.outline]
    first = np.searchsorted(segments.outline, segments.outline, side="left")
    last = np.searchsorted(segments.outline, segments.outline, side="right") - 1
    position = np.arange(len(segments.outline))
    order = np.where(turn, first + last - position, position)
    a = np.where(turn[:, None], segments.b[order], segments.a[order])
    b = np.where(turn[:, None], segments.a[order], segments.b[order])
    return replace(segments, a=a, b=b, height=segments.height[order])


def without_vanished(segments: Segments) -> Segments:
    """Return the segments that have a length in centimetres."""
    a, b = segments.a, segments.b
    kept = (a != b).any(axis=1)
    # A chain goes on across a segment that vanished: the run it belongs to is what counts.
    run = np.cumsum(~segments.joined)[kept]
    joined = np.zeros(len(run), dtype=bool)
    joined[1:] = run[1:] == run[:-1]
    return uncut(a[kept], b[kept], segments.height[kept], segments.outline[kept], joined)
