"""Which of many boxes may touch a rectangle: a grid that only knows the cells where something is."""

from __future__ import annotations

from math import floor
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .model import Border

_SMALLEST_CELL = 20.0
"""metres; a robot's window is some cells wide, and a cell holds some walls."""
_GROWTH = 8
"""How much larger the cells of the next level are."""
_LEVELS = 12
_FARTHEST = 1 << 28
"""cells from the first; what lies beyond is taken to be there."""
_ROW = 4 * _FARTHEST
_LEVEL = 2 * _FARTHEST * _ROW
_FITS = 0.999
"""of a cell; spares the largest boxes from rounding."""


class BoxGrid:
    """n boxes from ``low`` to ``high``, (n, 2) each, finite metres, each in the cell of its lower corner.

    A box is in the first level whose cells are larger than itself, so a rectangle has to look at no more
    than one further row and column of cells. ``order``, (n,) int64, are the boxes cell by cell.
    """

    def __init__(self, low: NDArray[Any], high: NDArray[Any]) -> None:
        self._origin = np.median(low, axis=0).tolist() if len(low) else [0.0, 0.0]
        sizes = _SMALLEST_CELL * float(_GROWTH) ** np.arange(_LEVELS)
        level = np.searchsorted(_FITS * sizes, (high - low).max(axis=1, initial=0.0))
        placed = level < _LEVELS
        cell = np.floor((low - self._origin) / sizes[np.minimum(level, _LEVELS - 1)][:, None])
        column, row = cell.clip(-_FARTHEST, _FARTHEST).astype(np.int64).T
        keys = np.where(placed, level * _LEVEL + row * _ROW + column, _LEVELS * _LEVEL)
        self.order: NDArray[Any] = np.argsort(keys, kind="stable")
        self._keys, starts = np.unique(keys[self.order], return_index=True)
        self._starts = np.append(starts, len(keys))
        # Boxes larger than any cell are looked at in every query.
        self._always = [] if placed.all() else [slice(int(placed.sum()), len(keys))]
        self._levels = [(int(k) * _LEVEL, float(sizes[k])) for k in np.unique(level[placed])]

    def spans(self, border: Border) -> list[slice]:
        """Return where in ``order`` the boxes are that may touch ``border``."""
        x, y = self._origin
        begins: list[int] = []
        ends: list[int] = []
        for base, size in self._levels:
            left, right = floor((border.x_min - size - x) / size), floor((border.x_max - x) / size)
            lower, upper = floor((border.y_min - size - y) / size), floor((border.y_max - y) / size)
            if upper - lower >= len(self._keys):
                return [slice(0, len(self.order))]
            if min(left, lower) < -_FARTHEST or max(right, upper) > _FARTHEST:
                left, right, lower, upper = map(_within_reach, (left, right, lower, upper))
            first, last = base + lower * _ROW + left, base + upper * _ROW + left
            begins += range(first, last + 1, _ROW)
            ends += range(first + right - left + 1, last + right - left + 2, _ROW)
        places = self._starts.take(self._keys.searchsorted(begins + ends)).tolist() if begins else []
        return [*map(slice, places[: len(begins)], places[len(begins) :]), *self._always]


def _within_reach(cell: int) -> int:
    return max(-_FARTHEST, min(_FARTHEST, cell))
