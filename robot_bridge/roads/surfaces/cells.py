"""A grid whose cells know the surfaces that cover them and the few edges that pass through them.

Edges are cut where they leave a column of cells. Whether a place is inside a surface is then told within its
own cell: by the edges to its right there, and by whether the cell's right side is inside at that height. Both
count with the same numbers, so that no place falls between them. Even-odd rule, as for rings that cross
themselves.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..centrelines import Floats, Ints, ranges
from .outlines import Edges

_FAR = 1e300
_EDGE_CELLS, _BOX_CELLS = 6, 16
"""How many cells an edge and a surface take at most on average: more cost memory, fewer cost comparisons."""


@dataclass(frozen=True)
class Grid:
    """Square cells of ``side`` metres from ``low``; the numbers of a place never fall from left to right."""

    low: Floats
    side: float
    columns: int
    rows: int

    def column(self, x: Floats) -> Ints:
        """Return the column of each of ``x``, metres from ``low``, the outermost ones for what is beyond."""
        return _number(x, self.side, self.columns)

    def row(self, y: Floats) -> Ints:
        """Return the row of each of ``y``, as :meth:`column`."""
        return _number(y, self.side, self.rows)


def _number(along: Floats, side: float, count: int) -> Ints:
    numbers: Ints = np.clip(np.floor(along / side), 0, count - 1).astype(np.int64)
    return numbers


@dataclass(frozen=True)
class Cells:
    """What each cell of ``grid`` knows.

    Entries ``first[c]`` to ``first[c + 1]`` are the surfaces ``owner`` of cell ``c``, those that count first
    at the front; ``odd`` says whether the cell's right side, high above, is inside. Edges ``begin[e]`` to
    ``begin[e + 1]`` of entry ``e`` are rows of ``edges``: y_low, y_high, x at y_low, dx/dy, and how many
    metres along x a place may be from it to be on it; metres from ``grid.low``.
    """

    grid: Grid
    first: Ints
    owner: Ints
    odd: NDArray[np.bool_]
    begin: Ints
    edges: Floats


def cells_of(edges: Edges, rank: Ints) -> Cells:
    """Return the cells of surfaces of which those with a lower ``rank``, (count,), count first."""
    low = np.minimum(edges.a, edges.b).min(axis=0)
    near = 4 * float(np.spacing(max(np.abs(edges.a).max(), np.abs(edges.b).max())))
    a, b = edges.a - low, edges.b - low
    swap = (a[:, 0] > b[:, 0])[:, None]
    a, b = np.where(swap, b, a), np.where(swap, a, b)
    boxes = _boxes(a, b, edges.owner, len(rank))
    grid = _grid(low, a, b, boxes)
    slots = _Slots(grid, boxes)
    pieces, sides = _cut(grid, a, b)
    along, rows = _over_rows(grid, pieces)
    owner = edges.owner[pieces.of]
    at = slots.number(owner[along], pieces.column[along], rows)
    side_owner, side_row = edges.owner[sides.of], grid.row(sides.y)
    side_at = slots.number(side_owner, sides.column, side_row)
    table = np.concatenate([_slanted(pieces, near)[along], _upright(sides.y)])
    return _sorted(slots, np.concatenate([at, side_at]), table, side_at, rank)


@dataclass(frozen=True)
class _Pieces:
    """What is left of the edges ``of`` within their ``column``, from (x0, y0) to (x1, y1)."""

    of: Ints
    column: Ints
    x0: Floats
    y0: Floats
    x1: Floats
    y1: Floats


@dataclass(frozen=True)
class _Sides:
    """Where the edges ``of`` pass the right side of their ``column``, at the height ``y``."""

    of: Ints
    column: Ints
    y: Floats


class _Slots:
    """A number for each surface and each cell that its box takes: column by column, from below."""

    def __init__(self, grid: Grid, boxes: Floats) -> None:
        self.grid = grid
        self._column, self._row = grid.column(boxes[:, 0]), grid.row(boxes[:, 1])
        wide = grid.column(boxes[:, 2]) - self._column + 1
        self._high = grid.row(boxes[:, 3]) - self._row + 1
        self._begin = np.concatenate([[0], np.cumsum(wide * self._high)])
        self.owner = np.repeat(np.arange(len(boxes)), wide * self._high)

    def number(self, owner: Ints, column: Ints, row: Ints) -> Ints:
        """Return the number of a surface in a cell."""
        place = (column - self._column[owner]) * self._high[owner] + row - self._row[owner]
        numbers: Ints = self._begin[owner] + place
        return numbers

    def cells(self) -> Ints:
        """Return the cell of each number."""
        place = np.arange(len(self.owner)) - self._begin[self.owner]
        column, row = place // self._high[self.owner], place % self._high[self.owner]
        cells: Ints = (self._row[self.owner] + row) * self.grid.columns + self._column[self.owner] + column
        return cells

    def above(self, counts: Ints) -> Ints:
        """Return how many of ``counts``, one for each number, lie above each number in its column."""
        place = np.arange(len(self.owner)) - self._begin[self.owner]
        high = self._high[self.owner]
        top = np.arange(len(place)) + high - 1 - place % high
        total = np.cumsum(counts)
        above: Ints = total[top] - total
        return above


def _boxes(a: Floats, b: Floats, owner: Ints, count: int) -> Floats:
    boxes = np.empty((count, 4))
    boxes[:, :2], boxes[:, 2:] = np.inf, -np.inf
    np.minimum.at(boxes[:, :2], owner, np.minimum(a, b))
    np.maximum.at(boxes[:, 2:], owner, np.maximum(a, b))
    # A surface without edges takes one cell and is nowhere.
    boxes[~np.isfinite(boxes[:, 0])] = 0.0
    return boxes


def _grid(low: Floats, a: Floats, b: Floats, boxes: Floats) -> Grid:
    """Return the finest grid that costs no more memory than a few cells for each edge and surface."""
    wide, high = boxes[:, 2:].max(axis=0)
    side = max(float(np.sqrt(wide * high / len(a))), float(max(wide, high)) / (4 * len(a) + 16), 1e-9)
    most = _BOX_CELLS * (len(boxes) + len(a)) + 1024
    while True:
        grid = Grid(low, side, int(wide // side) + 1, int(high // side) + 1)
        size = (boxes[:, 2:] - boxes[:, :2]) // side + 2.0
        steps = (np.abs(b - a) // side).sum()
        fits = grid.columns * grid.rows <= most and size.prod(axis=1).sum() <= most + 4 * len(boxes)
        if fits and steps <= _EDGE_CELLS * len(a) + 1024:
            return grid
        side *= 1.4


def _cut(grid: Grid, a: Floats, b: Floats) -> tuple[_Pieces, _Sides]:
    """Return the pieces of edges that run from left to right, and where they pass from column to column."""
    begin = grid.column(a[:, 0])
    count = grid.column(b[:, 0]) - begin + 1
    of = np.repeat(np.arange(len(a)), count)
    step = ranges(np.zeros(len(a), np.int64), count)
    column = begin[of] + step
    rest = step < count[of] - 1
    y = np.empty(len(of))
    side: Floats = np.multiply(column[rest] + 1, grid.side)
    sides = _Sides(of[rest], column[rest], _height(a, b, of[rest], side))
    y[rest] = sides.y
    x0, y0, x1, y1 = a[of, 0], a[of, 1], b[of, 0], b[of, 1]
    x1[rest], y1[rest] = side, y[rest]
    later = np.flatnonzero(step > 0)
    x0[later], y0[later] = x1[later - 1], y1[later - 1]
    return _Pieces(of, column, x0, y0, x1, y1), sides


def _height(a: Floats, b: Floats, of: Ints, x: Floats) -> Floats:
    ax, ay, bx, by = a[of, 0], a[of, 1], b[of, 0], b[of, 1]
    y = ay + (x - ax) * ((by - ay) / (bx - ax))
    heights: Floats = np.clip(y, np.minimum(ay, by), np.maximum(ay, by))
    return heights


def _over_rows(grid: Grid, pieces: _Pieces) -> tuple[Ints, Ints]:
    """Return each piece, as often as it takes rows, and the rows."""
    begin = grid.row(np.minimum(pieces.y0, pieces.y1))
    count = grid.row(np.maximum(pieces.y0, pieces.y1)) - begin + 1
    return np.repeat(np.arange(len(begin)), count), ranges(begin, count)


def _slanted(pieces: _Pieces, near: float) -> Floats:
    """Return the pieces as rows of ``Cells.edges``; places within ``near`` metres are on them."""
    up = pieces.y1 >= pieces.y0
    y_low, y_high = np.where(up, pieces.y0, pieces.y1), np.where(up, pieces.y1, pieces.y0)
    x_low, x_high = np.where(up, pieces.x0, pieces.x1), np.where(up, pieces.x1, pieces.x0)
    wide, high = x_high - x_low, y_high - y_low
    level = high == 0
    with np.errstate(over="ignore"):
        slope = np.where(level, 0.0, wide / np.where(level, 1.0, high))
        reach = np.minimum(near * np.hypot(1.0, slope), np.abs(wide) + near)
    reach = np.where(level, np.abs(wide) / 2 + near, reach)
    x_low = np.where(level, (x_low + x_high) / 2, x_low)
    return np.column_stack([y_low, y_high, x_low, np.clip(slope, -_FAR, _FAR), reach])


def _upright(y: Floats) -> Floats:
    """Return lines from far below up to ``y``, right of every place of their cells and never met."""
    far = np.full(len(y), _FAR)
    return np.column_stack([-far, y, far, np.zeros(len(y)), np.full(len(y), -1.0)])


def _sorted(slots: _Slots, at: Ints, table: Floats, sides: Ints, rank: Ints) -> Cells:
    """Return the cells of the edges ``table``, which lie in the slots ``at``."""
    total = len(slots.owner)
    odd = slots.above(np.bincount(sides, minlength=total)) % 2 == 1
    kept = np.flatnonzero(odd | (np.bincount(at, minlength=total) > 0))
    cells = slots.cells()[kept]
    kept = kept[np.argsort(cells * len(rank) + rank[slots.owner[kept]], kind="stable")]
    entry = np.full(total, -1)
    entry[kept] = np.arange(len(kept))
    order = np.argsort(entry[at], kind="stable")
    counts = np.bincount(cells, minlength=slots.grid.columns * slots.grid.rows)
    return Cells(
        grid=slots.grid,
        first=np.concatenate([[0], np.cumsum(counts)]),
        owner=slots.owner[kept],
        odd=odd[kept],
        begin=np.concatenate([[0], np.cumsum(np.bincount(entry[at], minlength=len(kept)))]),
        edges=np.ascontiguousarray(table[order]),
    )
