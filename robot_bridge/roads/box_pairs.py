"""Which boxes may touch: a grid in plain numpy, so that a stock QGIS needs no spatial library."""

from __future__ import annotations

from typing import TypeVar

import numpy as np

from .centrelines import Floats, Ints, ranges

_Numbers = TypeVar("_Numbers", int, Ints)

_CELLS_FOR_EACH_BOX = 8.0
"""How many cells a box covers on average at most: more cells cost memory, fewer cost comparisons."""


def boxes_of(a: Floats, b: Floats, margin: float) -> Floats:
    """Return the boxes x_min, y_min, x_max, y_max, (n, 4), of segments from ``a`` to ``b``, both (n, 2)."""
    return np.hstack([np.minimum(a, b) - margin, np.maximum(a, b) + margin])


def touching(one: Floats, other: Floats) -> tuple[Ints, Ints]:
    """Return the indices (i, j) of all boxes of ``one`` and ``other``, (n, 4) and (m, 4), that touch."""
    if not len(one) or not len(other):
        return np.empty(0, np.int64), np.empty(0, np.int64)
    both = np.concatenate([one, other])
    cell = cell_size(both)
    low = both[:, :2].min(axis=0)
    of_one, cell_one = cells_of(one, low, cell)
    of_other, cell_other = cells_of(other, low, cell)
    order = np.argsort(cell_other, kind="stable")
    of_other, cell_other = of_other[order], cell_other[order]
    begin = np.searchsorted(cell_other, cell_one, side="left")
    count = np.searchsorted(cell_other, cell_one, side="right") - begin
    i, j = np.repeat(of_one, count), of_other[ranges(begin, count)]
    touch = (one[i, :2] <= other[j, 2:]).all(axis=1) & (other[j, :2] <= one[i, 2:]).all(axis=1)
    pairs = np.unique(i[touch] * len(other) + j[touch])
    return pairs // len(other), pairs % len(other)


def cell_size(boxes: Floats) -> float:
    """Return the side of cells of which ``boxes`` cover few on average."""
    sides = boxes[:, 2:] - boxes[:, :2]
    cell = max(float(np.median(sides.max(axis=1))), 1e-3)
    while np.prod(np.floor(sides / cell) + 2.0, axis=1).mean() > _CELLS_FOR_EACH_BOX:
        cell *= 1.5
    return cell


def cells_of(boxes: Floats, low: Floats, cell: float) -> tuple[Ints, Ints]:
    """Return, for each cell that a box covers, the index of the box and the cell's number."""
    begin = np.floor((boxes[:, :2] - low) / cell).astype(np.int64)
    size = np.floor((boxes[:, 2:] - low) / cell).astype(np.int64) - begin + 1
    count = size.prod(axis=1)
    box = np.repeat(np.arange(len(boxes)), count)
    number = ranges(np.zeros(len(boxes), np.int64), count)
    wide = size[box, 0]
    return box, cell_number(begin[box, 0] + number % wide, begin[box, 1] + number // wide)


def cell_number(column: _Numbers, row: _Numbers) -> _Numbers:
    """Return one number for a column and a row of the grid."""
    return (row << 31) + column
