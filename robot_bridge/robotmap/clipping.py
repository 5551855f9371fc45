"""Segments cut by a rectangle; arrays throughout."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from .model import Border
from .segments import Segments

_ON_BORDER = 1e-5
"""centimetres; how far floating point may put a cut off its border where coordinates are large."""

_HEIGHT, _OUTLINE, _NUMBER = 4, 5, 6
"""Columns of a table of segments, after the two ends."""
_HELD = ((np.int32, 2.0**31 - 1), (np.int64, 2.0**53))
"""Types of whole numbers, and up to where each holds all of them."""
_WHOLE = np.array([[0.0], [1.0]])
"""Where a segment that is not cut begins and ends, of its length."""
_INWARDS = np.array([[0, 0], [1, -1], [_ON_BORDER, -_ON_BORDER]]).reshape(3, 2, 1, 1)
"""From the lower and the upper side to themselves, to what lies beside them, and to how far they reach."""


def table_of(segments: Segments) -> NDArray[Any]:
    """Return ``segments`` as one row of float64 each, (n, 7), so that they are gathered by one call.

    Its columns are a and b in centimetres, then height, outline and number as they are.
    """
    ends = np.rint(np.column_stack([segments.a, segments.b]) * 100)
    return np.column_stack([ends, segments.height, segments.outline, segments.number])


def rows_of(segments: Segments, heights: NDArray[Any], first: tuple[int, float] = (0, 0)) -> NDArray[Any]:
    """Return ``segments`` as whole numbers in as few bytes as hold them, (n, 7).

    As :func:`table_of`, but for the height: 1 for that of the outline, which ``heights`` has, 0 for none.
    ``first`` is added to outlines and numbers: how many outlines, and the last number, come before these.
    """
    table = table_of(segments)
    table[:, _HEIGHT] = segments.height == heights[segments.outline]
    table[:, _OUTLINE:] += first
    largest = np.abs(table).max(initial=0.0)
    return table.astype(next((kind for kind, most in _HELD if largest <= most), np.float64))


def corners_of_rows(rows: NDArray[Any]) -> tuple[NDArray[Any], NDArray[Any]]:
    """Return the lower and upper corners, (n, 2) metres each, of the segments in ``rows``."""
    a, b = rows[:, 0:2].astype(np.float64) / 100, rows[:, 2:4].astype(np.float64) / 100
    return np.minimum(a, b), np.maximum(a, b)


def table_of_rows(rows: NDArray[Any], heights: NDArray[Any]) -> NDArray[Any]:
    """Return what :func:`table_of` said of the segments in ``rows``, made by :func:`rows_of`."""
    table = rows.astype(np.float64)
    table[:, _HEIGHT] *= heights[rows[:, _OUTLINE].astype(np.int64)]
    return table


def clip(segments: Segments, border: Border) -> Segments:
    """Return what of the segments lies inside ``border``: :func:`clip_table` of all of them."""
    return clip_table(table_of(segments), border)


def clip_table(table: NDArray[Any], border: Border) -> Segments:
    """Return what of the segments in ``table`` lies inside ``border``, in the order of their numbers.

    Segments are cut one by one (Liang and Barsky, 1984), so no wall is invented along the border. Where one
    is cut is rounded to centimetres, which the border is in. A window of a city has so few segments that
    the number of calls is what counts, not the number of segments: all of them go through every step.
    """
    sides = np.array([round(100 * side) for side in border], dtype=np.float64).reshape(2, 2, 1)
    # A column each, side by side in memory.
    columns = table.T.copy()
    shares = _shares(columns[:4].reshape(2, 2, -1), sides)
    kept = (shares[0] < shares[1]).nonzero()[0]
    kept = kept.take(columns[_NUMBER].take(kept).argsort())
    columns, shares = columns.take(kept, axis=1), shares.take(kept, axis=1)
    ends, cut = columns[:4].reshape(2, 2, -1), shares != _WHOLE
    np.copyto(ends, _crossings(ends, shares, sides), where=cut[:, None])
    ends = ends / 100
    outline = columns[_OUTLINE].astype(np.int64)
    return Segments(ends[0].T, ends[1].T, columns[_HEIGHT], outline, columns[_NUMBER], cut)


def _shares(ends: NDArray[Any], sides: NDArray[Any]) -> NDArray[Any]:
    """Return from where to where of its length each of n segments is inside, (2, n) from 0 to 1.

    One that is outside does not end after it begins. ``ends`` is (2, 2, n) and ``sides`` (2, 2, 1): from
    and to, then x and y.
    """
    a, shares = ends[0], np.empty((2, ends.shape[2]))
    direction = ends[1] - a
    with np.errstate(divide="ignore", invalid="ignore"):
        # Of a segment along a side: minus infinity and infinity inside, infinity twice outside, and no number
        # on the side itself, where the other axis decides.
        low, high = (sides[0] - a) / direction, (sides[1] - a) / direction
    first, last = np.minimum(low, high), np.maximum(low, high)
    np.fmax(first[0], first[1], out=shares[0])
    np.fmin(last[0], last[1], out=shares[1])
    return shares.clip(0.0, 1.0)


def _crossings(ends: NDArray[Any], shares: NDArray[Any], sides: NDArray[Any]) -> NDArray[Any]:
    """Return the places, (2, 2, n), at those shares of segments, in whole centimetres.

    A coordinate that is near another side of the border and not on it stays off it: rounded onto it, the
    stub that a segment leaves in a corner would become a wall along the border.
    """
    a, limits = ends[0], sides + _INWARDS
    (low, high), beside, reach = limits[0], limits[1], limits[2]
    places = a + shares[:, None] * (ends[1] - a)
    crossings: NDArray[Any] = np.minimum(np.maximum(np.rint(places), beside[0]), beside[1])
    np.copyto(crossings, low, where=places <= reach[0])
    np.copyto(crossings, high, where=places >= reach[1])
    return crossings
