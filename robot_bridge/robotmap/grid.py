"""Which of many boxes may touch a rectangle: a grid that only knows the cells where something is."""

from __future__ import annotations

from collections.abc import Sequence
from math import floor
from typing import Any, NamedTuple

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
_SIZES = _SMALLEST_CELL * float(_GROWTH) ** np.arange(_LEVELS)


class Cells(NamedTuple):
    """What a grid is made of: the m cells that are not empty, and where their boxes begin.

    ``keys`` is (m,) and ``starts`` (m + 1,) int64. ``placed`` boxes are in cells of ``levels``; behind them
    come those that are larger than any.
    """

    keys: NDArray[Any]
    starts: NDArray[Any]
    origin: list[float]
    placed: int
    levels: tuple[int, ...]


class BoxGrid:
    """n boxes from ``low`` to ``high``, (n, 2) each, finite metres, each in the cell of its lower corner.

    A box is in the first level whose cells are larger than itself, so a rectangle has to look at no more
    than one further row and column of cells. It speaks of boxes by their places when they stand cell by cell.
    """

    def __init__(self, cells: Cells) -> None:
        self.cells = cells
        self._origin, self._keys, self._starts = cells.origin, cells.keys, cells.starts
        self._count = int(cells.starts[-1])
        # Boxes larger than any cell are looked at in every query.
        self._always = [slice(cells.placed, self._count)] if cells.placed < self._count else []
        self._levels = [(level * _LEVEL, _SMALLEST_CELL * float(_GROWTH) ** level) for level in cells.levels]

    @classmethod
    def of(cls, low: NDArray[Any], high: NDArray[Any]) -> tuple[BoxGrid, NDArray[Any]]:
        """Return the grid of boxes, and the boxes cell by cell: (n,) int64."""
        origin = np.median(low, axis=0).tolist() if len(low) else [0.0, 0.0]
        level = levels_of(low, high)
        keys = cell_keys(low, level, origin)
        order = np.argsort(keys, kind="stable")
        cells, starts = np.unique(keys[order], return_index=True)
        made = Cells(cells, np.append(starts, len(keys)), origin, *placed_in(level_counts(level)))
        return cls(made), order

    def spans(self, border: Border) -> list[slice]:
        """Return where in ``order`` the boxes are that may touch ``border``."""
        x, y = self._origin
        begins: list[int] = []
        ends: list[int] = []
        for base, size in self._levels:
            left, right = floor((border.x_min - size - x) / size), floor((border.x_max - x) / size)
            lower, upper = floor((border.y_min - size - y) / size), floor((border.y_max - y) / size)
            if upper - lower >= len(self._keys):
                return [slice(0, self._count)]
            if min(left, lower) < -_FARTHEST or max(right, upper) > _FARTHEST:
                left, right, lower, upper = map(_within_reach, (left, right, lower, upper))
            first, last = base + lower * _ROW + left, base + upper * _ROW + left
            begins += range(first, last + 1, _ROW)
            ends += range(first + right - left + 1, last + right - left + 2, _ROW)
        places = self._starts.take(self._keys.searchsorted(begins + ends)).tolist() if begins else []
        return [*map(slice, places[: len(begins)], places[len(begins) :]), *self._always]

    def pairs(self, low: NDArray[Any], high: NDArray[Any]) -> tuple[NDArray[Any], NDArray[Any]]:
        """Return which boxes may touch which of the rectangles from ``low`` to ``high``, (k, 2) each.

        Two arrays of int64: rectangle and box. For many small rectangles.
        """
        asked = [np.repeat(np.arange(len(low)), len(self._always))]
        begins = [np.tile(np.array([one.start for one in self._always], dtype=np.int64), len(low))]
        ends = [np.tile(np.array([one.stop for one in self._always], dtype=np.int64), len(low))]
        for base, size in self._levels:
            first = np.floor((low - size - self._origin) / size).clip(-_FARTHEST, _FARTHEST).astype(np.int64)
            last = np.floor((high - self._origin) / size).clip(-_FARTHEST, _FARTHEST).astype(np.int64)
            rectangle, row = _ranges(first[:, 1], last[:, 1] + 1)
            keys = base + row * _ROW + first[rectangle, 0]
            beyond = keys + (last - first)[rectangle, 0] + 1
            asked.append(rectangle)
            begins.append(self._starts[np.searchsorted(self._keys, keys)])
            ends.append(self._starts[np.searchsorted(self._keys, beyond)])
        span, box = _ranges(np.concatenate(begins), np.concatenate(ends))
        return np.concatenate(asked)[span], box


def levels_of(low: NDArray[Any], high: NDArray[Any]) -> NDArray[Any]:
    """Return the level of each box from ``low`` to ``high``, (n, 2) each: (n,) int64."""
    levels: NDArray[Any] = np.searchsorted(_FITS * _SIZES, (high - low).max(axis=1, initial=0.0))
    return levels


def level_counts(levels: NDArray[Any]) -> NDArray[Any]:
    """Return how many of ``levels`` are each of those that there are, and at the end beyond them."""
    return np.bincount(levels, minlength=_LEVELS + 1)


def placed_in(counts: NDArray[Any]) -> tuple[int, tuple[int, ...]]:
    """Return how many boxes are in cells, and of which levels those are, told by :func:`level_counts`."""
    return int(counts[:_LEVELS].sum()), tuple(np.flatnonzero(counts[:_LEVELS]).tolist())


def cell_keys(low: NDArray[Any], level: NDArray[Any], origin: Sequence[float]) -> NDArray[Any]:
    """Return the cell of each box by its lower corner and its level: (n,) int64.

    In their order boxes stand cell by cell, and behind all others those that are larger than any cell.
    """
    cell = np.floor((low - origin) / _SIZES[np.minimum(level, _LEVELS - 1)][:, None])
    column, row = cell.clip(-_FARTHEST, _FARTHEST).astype(np.int64).T
    return np.where(level < _LEVELS, level * _LEVEL + row * _ROW + column, _LEVELS * _LEVEL)


def _ranges(begins: NDArray[Any], ends: NDArray[Any]) -> tuple[NDArray[Any], NDArray[Any]]:
    """Return the numbers of each range one after the other, behind which range they are of."""
    lengths = ends - begins
    of = np.repeat(np.arange(len(begins)), lengths)
    return of, np.arange(len(of)) + (begins - np.cumsum(lengths) + lengths)[of]


def _within_reach(cell: int) -> int:
    return max(-_FARTHEST, min(_FARTHEST, cell))
