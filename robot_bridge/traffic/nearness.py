"""Who comes near whom at all: boxes of where each is in one stretch of time after the other.

It spares looking closely at robots that pass the same places at other times, as nearly all of them do.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from .movement import Floats, Movement

Ints = NDArray[np.int64]

_WINDOW = 5.0
"""seconds of a stretch: about as long as two robots take to pass one another."""
_MOST_WINDOWS = 256
"""Stretches at most: where some drive for hours, each is longer."""
_SLACK = 1e-6
"""Metres by which boxes are larger than they need be, for the rounding of what made them."""


class Near(NamedTuple):
    """Two movements, by their numbers, that may be near one another between two times and at no other."""

    one: int
    two: int
    begins: float
    ends: float


class Windows:
    """Time from ``now`` on in stretches, the last of them without an end."""

    def __init__(self, movements: Sequence[Movement], now: float) -> None:
        span = max((movement.ends for movement in movements), default=now) - now
        count = min(max(math.ceil(span / _WINDOW), 1), _MOST_WINDOWS)
        self._begins = now + max(span, 0.0) * np.arange(count) / count

    def boxes(self, movement: Movement, more: float) -> Floats:
        """Return where the movement is in each stretch as x_min, y_min, x_max, y_max, (n, 4), with ``more``
        metres round it."""
        times, points = movement.times, movement.points
        at = movement.at(self._begins)
        low = np.minimum(at, np.concatenate([at[1:], points[-1:]]))
        high = np.maximum(at, np.concatenate([at[1:], points[-1:]]))
        # The points in between belong to the stretch that they are reached in.
        of = np.searchsorted(self._begins, times, side="right") - 1
        inner = of >= 0
        if inner.any():
            window, first = np.unique(of[inner], return_index=True)
            low[window] = np.minimum(low[window], np.minimum.reduceat(points[inner], first))
            high[window] = np.maximum(high[window], np.maximum.reduceat(points[inner], first))
        return np.hstack([low - more - _SLACK, high + more + _SLACK])

    def span(self, first: int, last: int) -> tuple[float, float]:
        """Return when stretch ``first`` begins and stretch ``last`` ends."""
        ends = self._begins[last + 1] if last + 1 < len(self._begins) else math.inf
        return float(self._begins[first]), float(ends)


def near_pairs(movements: Sequence[Movement], margin: float, now: float) -> list[Near]:
    """Return the pairs that may come nearer than their radii and ``margin`` metres, ``one`` < ``two``."""
    if len(movements) < 2:
        return []
    windows = Windows(movements, now)
    boxes = np.stack([windows.boxes(one, one.radius + margin / 2) for one in movements], axis=1)
    found = [(*_touching(at), window) for window, at in enumerate(boxes)]
    one, two = (np.concatenate([pairs[k] for pairs in found]) for k in (0, 1))
    window = np.repeat(np.arange(len(found)), [len(pairs[0]) for pairs in found])
    # The windows rise, so that a pair's first is where it comes first, and its last where it comes last.
    key = one * len(movements) + two
    _, first = np.unique(key, return_index=True)
    last = len(key) - 1 - np.unique(key[::-1], return_index=True)[1]
    columns = one[first], two[first], window[first], window[last]
    rows = zip(*(column.tolist() for column in columns), strict=True)
    return [Near(a, b, *windows.span(begin, end)) for a, b, begin, end in rows]


def _touching(boxes: Floats) -> tuple[Ints, Ints]:
    """Return the pairs of ``boxes``, (n, 4), that touch, the lower number first."""
    order = np.argsort(boxes[:, 0], kind="stable")
    left = boxes[order, 0]
    # Those that begin, from the left, before a box ends, and are not to the left of it themselves.
    count = np.searchsorted(left, boxes[order, 2], side="right") - np.arange(len(order)) - 1
    one = np.repeat(np.arange(len(order)), count)
    two = np.arange(len(one)) - np.repeat(np.cumsum(count) - count, count) + one + 1
    one, two = order[one], order[two]
    touch = (boxes[one, 1] <= boxes[two, 3]) & (boxes[two, 1] <= boxes[one, 3])
    one, two = one[touch], two[touch]
    return np.minimum(one, two), np.maximum(one, two)
