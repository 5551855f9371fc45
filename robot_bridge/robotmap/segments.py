"""Outlines turned into oriented segments, and segments clipped by a rectangle; arrays throughout."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .model import Border, ShapeType
from .outlines import Outlines

CLOSED_TYPES = (ShapeType.CLOSED_POLYGON, ShapeType.CLOSED_CURVE, ShapeType.RAMP)


@dataclass(frozen=True)
class Segments:
    """n oriented segments in the order of their outlines.

    ``outline`` is the row each belongs to. ``joined`` tells whether a segment begins where the one before
    it in the arrays ends, both of the same outline and neither cut there.
    """

    a: NDArray[Any]
    b: NDArray[Any]
    height: NDArray[Any]
    outline: NDArray[Any]
    joined: NDArray[Any]


def is_closed(shape_type: NDArray[Any]) -> NDArray[Any]:
    """Tell which shape types, (K,), are rings."""
    return np.isin(shape_type, [int(t) for t in CLOSED_TYPES])


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

    Solid rings run counter-clockwise, courtyards clockwise: free space is to the right of a→b. Lines and
    stairs keep the direction they were drawn in; each riser of stairs is a segment, the last of height 0.
    """
    lengths = np.diff(outlines.offsets)
    row = np.repeat(np.arange(len(outlines)), lengths)
    index = np.arange(len(row)) - outlines.offsets[:-1][row]
    stairs = outlines.shape_type == ShapeType.STAIRS
    begins = (index < lengths[row] - 1) & (~stairs[row] | (index % 2 == 0)) & usable[row]
    start = np.flatnonzero(begins)
    a, b, outline = outlines.coordinates[start], outlines.coordinates[start + 1], row[start]
    height = outlines.height[outline].astype(np.float64)
    height[stairs[outline] & (index[start] >= lengths[outline] - 2)] = 0.0
    joined = np.zeros(len(start), dtype=bool)
    joined[1:] = (outline[1:] == outline[:-1]) & ~stairs[outline[1:]]
    segments = Segments(a, b, height, outline, joined)
    backwards = is_closed(outlines.shape_type) & ((signed_areas(outlines) > 0) == outlines.courtyard)
    return _turned_round(segments, backwards) if backwards.any() else segments


def _turned_round(segments: Segments, backwards: NDArray[Any]) -> Segments:
    """Return the segments with those of the outlines in ``backwards`` in the opposite direction and order."""
    turn = backwards[segments.outline]
    first = np.searchsorted(segments.outline, segments.outline, side="left")
    last = np.searchsorted(segments.outline, segments.outline, side="right") - 1
    position = np.arange(len(segments.outline))
    order = np.where(turn, first + last - position, position)
    a = np.where(turn[:, None], segments.b[order], segments.a[order])
    b = np.where(turn[:, None], segments.a[order], segments.b[order])
    return Segments(a, b, segments.height[order], segments.outline, segments.joined)


def clip(segments: Segments, border: Border) -> Segments:
    """Return what of the segments lies inside ``border`` (Liang and Barsky's clipping, 1984).

    Segments are cut one by one, so no wall is invented along the border.
    """
    direction = segments.b - segments.a
    enter, leave = np.zeros(len(segments.a)), np.ones(len(segments.a))
    outside = np.zeros(len(segments.a), dtype=bool)
    for axis, low, high in ((0, border.x_min, border.x_max), (1, border.y_min, border.y_max)):
        for p, q in (
            (-direction[:, axis], segments.a[:, axis] - low),
            (direction[:, axis], high - segments.a[:, axis]),
        ):
            with np.errstate(divide="ignore", invalid="ignore"):
                t = q / p
            enter = np.where(p < 0, np.maximum(enter, t), enter)
            leave = np.where(p > 0, np.minimum(leave, t), leave)
            outside |= (p == 0) & (q < 0)
    return _between(segments, direction, enter, leave, ~outside & (enter < leave))


def _between(
    segments: Segments,
    direction: NDArray[Any],
    enter: NDArray[Any],
    leave: NDArray[Any],
    inside: NDArray[Any],
) -> Segments:
    """Return the segments marked in ``inside``, each from ``enter`` to ``leave`` of its length (0 to 1)."""
    kept = np.flatnonzero(inside)
    enter, leave, a, step = enter[kept], leave[kept], segments.a[kept], direction[kept]
    joined = segments.joined[kept] & (enter == 0)
    joined[1:] &= (kept[1:] == kept[:-1] + 1) & (leave[:-1] == 1)
    joined[:1] = False
    return Segments(
        a=np.where((enter > 0)[:, None], a + enter[:, None] * step, a),
        b=np.where((leave < 1)[:, None], a + leave[:, None] * step, segments.b[kept]),
        height=segments.height[kept],
        outline=segments.outline[kept],
        joined=joined,
    )


def in_centimetres(segments: Segments) -> Segments:
    """Return the segments with coordinates rounded to centimetres, without those that vanish by it."""
    a, b = np.round(segments.a, 2), np.round(segments.b, 2)
    kept = (a != b).any(axis=1)
    # A chain goes on across a segment that vanished: the run it belongs to is what counts.
    run = np.cumsum(~segments.joined)[kept]
    joined = np.zeros(len(run), dtype=bool)
    joined[1:] = run[1:] == run[:-1]
    return Segments(a[kept], b[kept], segments.height[kept], segments.outline[kept], joined)
