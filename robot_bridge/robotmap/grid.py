"""Which of many boxes touch a rectangle: a grid that only knows the cells where something is."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .model import Border

_SMALLEST_CELL = 20.0
"""metres; a robot's window is some cells wide, and a cell holds some buildings."""
_MOST_CELLS = 16
"""of one box; larger boxes are looked at in every query."""
_FARTHEST = 1 << 30
"""cells from the first; what lies beyond is looked at in every query."""


class BoxGrid:
    """K boxes from ``low`` to ``high``, (K, 2) each, metres."""

    def __init__(self, low: NDArray[Any], high: NDArray[Any]) -> None:
        self._sides = np.concatenate([low, -high], axis=1)
        sides = (high - low).max(axis=1) if len(low) else np.zeros(0)
        self._cell = max(_SMALLEST_CELL, 2 * float(np.median(sides))) if len(low) else _SMALLEST_CELL
        self._origin = np.median(low, axis=0) if len(low) else np.zeros(2)
        first, last = self._cells(low), self._cells(high)
        spans = last - first + 1
        near = (np.abs(first) < _FARTHEST).all(axis=1) & (np.abs(last) < _FARTHEST).all(axis=1)
        small = near & (spans <= _MOST_CELLS).all(axis=1) & (spans.prod(axis=1) <= _MOST_CELLS)
        self._large = np.flatnonzero(~small)
        counts = spans[small].prod(axis=1)
        owner = np.repeat(np.flatnonzero(small), counts)
        number = np.arange(len(owner)) - np.repeat(counts.cumsum() - counts, counts)
        across = spans[owner, 0]
        keys = _key(first[owner, 0] + number % across, first[owner, 1] + number // across)
        order = np.argsort(keys, kind="stable")
        self._keys, self._boxes = keys[order], owner[order]

    def touching(self, border: Border) -> NDArray[Any]:
        """Return which boxes touch ``border``, in rising order."""
        (left, lower), (right, upper) = self._corners(border)
        if upper - lower >= len(self._keys):
            everywhere: NDArray[Any] = np.flatnonzero(self._touch(slice(None), border))
            return everywhere
        rows = np.arange(lower, upper + 1)
        first = self._keys.searchsorted(_key(left, rows)).tolist()
        last = self._keys.searchsorted(_key(right, rows), side="right").tolist()
        found = [self._boxes[start:end] for start, end in zip(first, last, strict=True)]
        candidates = np.concatenate([*found, self._large])
        near = candidates[self._touch(candidates, border)]
        near.sort()
        again = np.zeros(len(near), dtype=bool)
        again[1:] = near[1:] == near[:-1]
        once: NDArray[Any] = near[~again]
        return once

    def _touch(self, which: Any, border: Border) -> NDArray[Any]:
        limits = (border.x_max, border.y_max, -border.x_min, -border.y_min)
        touch: NDArray[Any] = (self._sides[which] <= limits).all(axis=1)
        return touch

    def _corners(self, border: Border) -> tuple[tuple[int, int], tuple[int, int]]:
        """Return the columns and rows of the border's corners, as :meth:`_cells` does for many."""
        x, y = self._origin.tolist()
        return (
            (_cell(border.x_min, x, self._cell), _cell(border.y_min, y, self._cell)),
            (_cell(border.x_max, x, self._cell), _cell(border.y_max, y, self._cell)),
        )

    def _cells(self, points: NDArray[Any]) -> NDArray[Any]:
        cells = np.floor((points - self._origin) / self._cell)
        numbers: NDArray[Any] = cells.clip(-2.0 * _FARTHEST, 2.0 * _FARTHEST).astype(np.int64)
        return numbers


def _cell(value: float, origin: float, size: float) -> int:
    return int(max(-_FARTHEST, min(_FARTHEST, math.floor((value - origin) / size))))


def _key(column: Any, row: NDArray[Any]) -> NDArray[Any]:
    key: NDArray[Any] = row * (4 * _FARTHEST) + column
    return key
