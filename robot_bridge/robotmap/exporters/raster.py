"""Lines and areas on a grid, array by array: which cells a line touches, which centres a ring encloses."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .grid import Grid

Cells = NDArray[Any]

_NOISE_DIGITS = 6
"""Digits of a cell that count; what follows is floating point's, not the point's."""

_FAR = 1e9
"""cells; a file may hold any number, and integers do not hold all of them."""

_BAND_CELLS = 1 << 21
"""cells that are summed up at once, so that memory stays far below that of whole grids of integers."""


def touched_cells(grid: Grid, a: NDArray[Any], b: NDArray[Any]) -> Cells:
    """Return (rows, columns) bool, true for each cell that one of the segments a→b, (n, 2) metres, touches.

    Cells of one line share edges, never only corners, so nothing slips through a thin wall. A line along the
    edge of two cells belongs to the upper or right one, on the far border of the grid to the last one.
    """
    lower, upper = _in_cells(grid, a, b)
    first = np.maximum(_floor(lower[:, 1], grid.rows), 0)
    last = np.minimum(_floor(upper[:, 1], grid.rows), grid.rows - 1)
    inside = (upper[:, 1] >= 0) & (lower[:, 1] <= grid.rows)
    segment, row = _rows_of(first, last, inside)
    low, high = lower[segment], upper[segment]
    ends = (_x_at(low, high, np.maximum(low[:, 1], row)), _x_at(low, high, np.minimum(high[:, 1], row + 1)))
    flat = low[:, 1] == high[:, 1]
    left = np.where(flat, np.minimum(low[:, 0], high[:, 0]), np.minimum(*ends))
    right = np.where(flat, np.maximum(low[:, 0], high[:, 0]), np.maximum(*ends))
    left, right = np.round(left, _NOISE_DIGITS), np.round(right, _NOISE_DIGITS)
    kept = (right >= 0) & (left <= grid.columns)
    begin = np.maximum(_floor(left[kept], grid.columns), 0)
    end = np.minimum(_floor(right[kept], grid.columns), grid.columns - 1) + 1
    row = row[kept]
    ones = np.ones(len(row))
    return _summed(
        grid, np.concatenate([row, row]), np.concatenate([begin, end]), np.concatenate([ones, -ones])
    )


def enclosed_cells(grid: Grid, a: NDArray[Any], b: NDArray[Any]) -> Cells:
    """Return (rows, columns) bool, true where rings of segments a→b, (n, 2) metres, enclose a cell's centre.

    Counter-clockwise rings count up and clockwise ones down, so a courtyard opens its building and a building
    in a courtyard closes it again.
    """
    lower, upper = _in_cells(grid, a, b)
    first = np.maximum(np.ceil(lower[:, 1] - 0.5).astype(np.int64), 0)
    last = np.minimum(np.ceil(upper[:, 1] - 0.5).astype(np.int64) - 1, grid.rows - 1)
    segment, row = _rows_of(first, last, np.ones(len(first), dtype=bool))
    x = np.round(_x_at(lower[segment], upper[segment], row + 0.5), _NOISE_DIGITS)
    column = np.clip(np.ceil(x - 0.5).astype(np.int64), 0, grid.columns)
    # What runs down has its inside on the right of the sheet, where the row goes on.
    return _summed(grid, row, column, np.sign(a[segment, 1] - b[segment, 1]))


def _in_cells(grid: Grid, a: NDArray[Any], b: NDArray[Any]) -> tuple[NDArray[Any], NDArray[Any]]:
    """Return the lower and the upper end of each segment, (n, 2) each, in cells from the grid's corner."""
    origin = (grid.x_min, grid.y_min)
    ends = [(end.reshape(-1, 2) - origin) / grid.resolution for end in (a, b)]
    ends = [np.clip(end, -_FAR, _FAR).round(_NOISE_DIGITS) for end in ends]
    upward = (ends[0][:, 1] <= ends[1][:, 1])[:, None]
    return np.where(upward, ends[0], ends[1]), np.where(upward, ends[1], ends[0])


def _floor(values: NDArray[Any], count: int) -> NDArray[Any]:
    """Return the cell of each coordinate; the far border belongs to the last cell."""
    cells: NDArray[Any] = np.where(values == count, count - 1, np.floor(values)).astype(np.int64)
    return cells


def _rows_of(
    first: NDArray[Any], last: NDArray[Any], inside: NDArray[Any]
) -> tuple[NDArray[Any], NDArray[Any]]:
    """Return the segment and the row of each pair of the two."""
    count = np.where(inside, np.maximum(last - first + 1, 0), 0)
    segment = np.repeat(np.arange(len(count)), count)
    begin = np.cumsum(count) - count
    return segment, first[segment] + np.arange(len(segment)) - begin[segment]


def _x_at(low: NDArray[Any], high: NDArray[Any], y: NDArray[Any]) -> NDArray[Any]:
    rise = high[:, 1] - low[:, 1]
    part = np.divide(y - low[:, 1], rise, out=np.zeros(len(rise)), where=rise > 0)
    x: NDArray[Any] = low[:, 0] + np.clip(part, 0.0, 1.0) * (high[:, 0] - low[:, 0])
    return x


def _summed(grid: Grid, row: NDArray[Any], column: NDArray[Any], weight: NDArray[Any]) -> Cells:
    """Return where the weights at or to the left of a cell in its row sum up to more than 0."""
    cells = np.zeros((grid.rows, grid.columns), dtype=bool)
    order = np.argsort(row, kind="stable")
    row, column, weight = row[order], column[order], weight[order]
    width = grid.columns + 1
    for low, high in _bands(grid):
        start, end = np.searchsorted(row, (low, high))
        if start == end:
            continue
        place = (row[start:end] - low) * width + column[start:end]
        steps = np.bincount(place, weights=weight[start:end], minlength=(high - low) * width)
        cells[low:high] = np.cumsum(steps.reshape(-1, width), axis=1)[:, :-1] > 0.5
    return cells


def _bands(grid: Grid) -> Iterator[tuple[int, int]]:
    height = max(1, _BAND_CELLS // grid.columns)
    for low in range(0, grid.rows, height):
        yield low, min(low + height, grid.rows)
