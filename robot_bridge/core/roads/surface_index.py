"""Index of road surfaces: lookup of the surface at one place or at a million."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..errors import RoadInputError
from .network import DRAWN, Floats, Ints, Surface, ranges

# --- The edges of surfaces as columns ---


@dataclass(frozen=True)
class SurfaceEdges:
    """Edge ``k`` runs from ``a[k]`` to ``b[k]``, both (n, 2), in ring ``ring[k]`` of surface ``owner[k]``.

    Rings are counted through all surfaces; the first of each is its outer one.
    """

    a: Floats
    b: Floats
    owner: Ints
    ring: Ints

    def __len__(self) -> int:
        return len(self.owner)


def surface_edges(surfaces: Sequence[Surface]) -> SurfaceEdges:
    """Return the edges of every ring; one that is not closed is closed.

    :raises RoadInputError: naming the first surface with a coordinate that is no number.
    """
    rings = [np.asarray(ring, np.float64).reshape(-1, 2) for one in surfaces for ring in one.rings]
    owner = np.repeat(np.arange(len(surfaces)), [len(one.rings) for one in surfaces])
    kept = [k for k, ring in enumerate(rings) if len(ring)]
    rings, owner = [rings[k] for k in kept], owner[kept]
    if not rings:
        nothing = np.empty((0, 2))
        none = np.empty(0, np.int64)
        return SurfaceEdges(nothing, nothing, none, none)
    counts = np.array([len(ring) for ring in rings])
    points = np.concatenate(rings)
    of_point = np.repeat(owner, counts)
    finite = np.isfinite(points).all(axis=1)
    if not finite.all():
        k = int(of_point[np.argmin(finite)])
        raise RoadInputError(
            f"Surface {k} ({surfaces[k].label or 'without a class'}) has a coordinate that is no number: "
            "correct it or leave it out."
        )
    last = np.cumsum(counts) - 1
    following = np.arange(1, len(points) + 1)
    following[last] = last - counts + 1
    ends = points[following]
    # A ring that repeats its first point has one edge without length.
    moves = (points != ends).any(axis=1) | (counts == 1).repeat(counts)
    of_ring = np.repeat(np.arange(len(rings)), counts)
    return SurfaceEdges(points[moves], ends[moves], of_point[moves], of_ring[moves])


def areas_of(edges: SurfaceEdges, count: int) -> Floats:
    """Return the area in m² of each of ``count`` surfaces without holes, for any direction of rings."""
    areas = np.zeros(count)
    if len(edges):
        low = edges.a.min(axis=0)
        a, b = edges.a - low, edges.b - low
        rings, first, of_edge = np.unique(edges.ring, return_index=True, return_inverse=True)
        area = np.abs(np.bincount(of_edge, a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0])) / 2
        owner = edges.owner[first]
        hole = np.append(False, owner[1:] == owner[:-1])[: len(rings)]
        np.add.at(areas, owner, np.where(hole, -area, area))
    return areas


# --- A grid whose cells hold the surfaces that cover them and the few edges that pass through them ---
# Edges are cut at the borders of columns of cells. Whether a place is inside a surface is then decided within
# its own cell: by the edges to its right there, and by whether the cell's right side is inside at that
# height. Both use the same numbers, so that no place falls between them. Even-odd rule, as for rings that
# cross themselves.

_FAR = 1e300
_EDGE_CELLS, _BOX_CELLS = 6, 16
"""Most cells of an edge and of a surface on average: more cost memory, fewer cost comparisons."""


@dataclass(frozen=True)
class SurfaceGrid:
    """Square cells of ``side`` metres from ``low``; column numbers never decrease from left to right."""

    low: Floats
    side: float
    columns: int
    rows: int

    def column(self, x: Floats) -> Ints:
        """Return the column of each of ``x``, metres from ``low``, the outermost ones for places beyond."""
        return _number(x, self.side, self.columns)

    def row(self, y: Floats) -> Ints:
        """Return the row of each of ``y``, as :meth:`column`."""
        return _number(y, self.side, self.rows)


def _number(along: Floats, side: float, count: int) -> Ints:
    numbers: Ints = np.clip(np.floor(along / side), 0, count - 1).astype(np.int64)
    return numbers


@dataclass(frozen=True)
class SurfaceCells:
    """The contents of each cell of ``grid``.

    Entries ``first[c]`` to ``first[c + 1]`` are the surfaces ``owner`` of cell ``c``, in order of precedence;
    ``odd`` says whether the cell's right side, high above, is inside. Edges ``begin[e]`` to ``begin[e + 1]``
    of entry ``e`` are rows of ``edges``: y_low, y_high, x at y_low, dx/dy, and how many metres along x a
    place may be from it to be on it; metres from ``grid.low``.
    """

    grid: SurfaceGrid
    first: Ints
    owner: Ints
    odd: NDArray[np.bool_]
    begin: Ints
    edges: Floats


def surface_cells(edges: SurfaceEdges, rank: Ints) -> SurfaceCells:
    """Return the cells of surfaces; a lower ``rank``, (count,), takes precedence."""
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
    """The pieces of the edges ``of`` within their ``column``, from (x0, y0) to (x1, y1)."""

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
    """A number for each surface and each cell that its box covers: column by column, from below."""

    def __init__(self, grid: SurfaceGrid, boxes: Floats) -> None:
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
    # A surface without edges gets one cell but contains no place.
    boxes[~np.isfinite(boxes[:, 0])] = 0.0
    return boxes


def _grid(low: Floats, a: Floats, b: Floats, boxes: Floats) -> SurfaceGrid:
    """Return the finest grid that costs no more memory than a few cells for each edge and surface."""
    wide, high = boxes[:, 2:].max(axis=0)
    side = max(float(np.sqrt(wide * high / len(a))), float(max(wide, high)) / (4 * len(a) + 16), 1e-9)
    most = _BOX_CELLS * (len(boxes) + len(a)) + 1024
    while True:
        grid = SurfaceGrid(low, side, int(wide // side) + 1, int(high // side) + 1)
        size = (boxes[:, 2:] - boxes[:, :2]) // side + 2.0
        steps = (np.abs(b - a) // side).sum()
        fits = grid.columns * grid.rows <= most and size.prod(axis=1).sum() <= most + 4 * len(boxes)
        if fits and steps <= _EDGE_CELLS * len(a) + 1024:
            return grid
        side *= 1.4


def _cut(grid: SurfaceGrid, a: Floats, b: Floats) -> tuple[_Pieces, _Sides]:
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


def _over_rows(grid: SurfaceGrid, pieces: _Pieces) -> tuple[Ints, Ints]:
    """Return each piece once per row that it covers, and the rows."""
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


def _sorted(slots: _Slots, at: Ints, table: Floats, sides: Ints, rank: Ints) -> SurfaceCells:
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
    return SurfaceCells(
        grid=slots.grid,
        first=np.concatenate([[0], np.cumsum(counts)]),
        owner=slots.owner[kept],
        odd=odd[kept],
        begin=np.concatenate([[0], np.cumsum(np.bincount(entry[at], minlength=len(kept)))]),
        edges=np.ascontiguousarray(table[order]),
    )


# --- Lookup of the surface at one place or at a million ---

_AT_ONCE = 1 << 16
"""Places that are processed together: intermediate data stays in the processor's caches."""

NOWHERE = -1


class SurfaceIndex:
    """Finds the surface at places. Immutable and thread-safe.

    A place on the edge of a surface or of its hole is on the surface. Where surfaces lie on one another a
    drawn one counts before a generated one, then the smaller before the larger, then the later before the
    earlier. A ring that crosses itself encloses by the even-odd rule.

    :raises RoadInputError: naming a surface with a coordinate that is no number.
    """

    def __init__(self, surfaces: Sequence[Surface]) -> None:
        self.surfaces = tuple(surfaces)
        edges = surface_edges(self.surfaces)
        self._cells = surface_cells(edges, self._rank(edges)) if len(edges) else None
        self._views = None if self._cells is None else _views(self._cells)

    def surface_at(self, x: float, y: float) -> Surface | None:
        """Return the surface at (x, y), None where there is none."""
        number = self.at(x, y)
        return None if number == NOWHERE else self.surfaces[number]

    def at(self, x: float, y: float) -> int:  # noqa: C901 - the steps of one search, each too short for a call
        """Return the index of the surface at (x, y), NOWHERE where there is none, or for NaN."""
        if self._views is None:
            return NOWHERE
        x_min, y_min, side, columns, rows, first, owner, odd, begin, edges = self._views
        x -= x_min
        y -= y_min
        # As in SurfaceGrid, but places beyond the outermost cells are nowhere; NaN compares false.
        if not (0.0 <= x < side * (columns + 1) and 0.0 <= y < side * (rows + 1)):
            return NOWHERE
        cell = min(int(y // side), rows - 1) * columns + min(int(x // side), columns - 1)
        for entry in range(first[cell], first[cell + 1]):
            inside = odd[entry]
            for k in range(5 * begin[entry], 5 * begin[entry + 1], 5):
                low = edges[k]
                if low <= y <= edges[k + 1]:
                    off = edges[k + 2] + (y - low) * edges[k + 3] - x
                    if off > 0.0:
                        if off <= edges[k + 4]:
                            return int(owner[entry])
                        if y < edges[k + 1]:
                            inside = not inside
                    elif -off <= edges[k + 4]:
                        return int(owner[entry])
            if inside:
                return int(owner[entry])
        return NOWHERE

    def at_many(self, xy: Any) -> Ints:
        """Return the index of the surface at each of ``xy``, (n, 2), NOWHERE where there is none; (n,)."""
        places = np.asarray(xy, dtype=np.float64).reshape(-1, 2)
        found = np.full(len(places), NOWHERE, np.int64)
        if self._cells is not None:
            for begin in range(0, len(places), _AT_ONCE):
                found[begin : begin + _AT_ONCE] = _first_cells(self._cells, places[begin : begin + _AT_ONCE])
        return found

    def _rank(self, edges: SurfaceEdges) -> Ints:
        count = len(self.surfaces)
        areas = areas_of(edges, count)
        generated = np.array([one.origin != DRAWN for one in self.surfaces], bool)
        order = np.lexsort([-np.arange(count), areas, generated])
        rank = np.empty(count, np.int64)
        rank[order] = np.arange(count)
        return rank


def _views(cells: SurfaceCells) -> tuple[Any, ...]:
    # Reading a single number through a memoryview takes a third of the time through an array.
    columns = (cells.first, cells.owner, cells.odd, cells.begin, cells.edges.ravel())
    views = [np.ascontiguousarray(column).data for column in columns]
    grid = cells.grid
    x_min, y_min = grid.low.tolist()
    return (x_min, y_min, grid.side, grid.columns, grid.rows, *views)


def _first_cells(cells: SurfaceCells, places: Floats) -> Ints:
    grid = cells.grid
    x, y = (places - grid.low).T
    with np.errstate(invalid="ignore"):
        there = (x >= 0) & (x < grid.side * (grid.columns + 1))
        there &= (y >= 0) & (y < grid.side * (grid.rows + 1))
    at = np.flatnonzero(there)
    cell = grid.row(y[at]) * grid.columns + grid.column(x[at])
    count = cells.first[cell + 1] - cells.first[cell]
    place, entry = np.repeat(at, count), ranges(cells.first[cell], count)
    inside = _inside(cells, entry, x[place], y[place])
    place, entry = place[inside], entry[inside]
    # Those of one place are adjacent, the decisive one first.
    in_front = np.ones(len(place), bool)
    in_front[1:] = place[1:] != place[:-1]
    found = np.full(len(places), NOWHERE, np.int64)
    found[place[in_front]] = cells.owner[entry[in_front]]
    return found


def _inside(cells: SurfaceCells, entry: Ints, x: Floats, y: Floats) -> Any:
    """Return for each entry whether its surface holds its place (x, y), all (n,)."""
    count = cells.begin[entry + 1] - cells.begin[entry]
    pair = np.repeat(np.arange(len(entry)), count)
    edges = cells.edges[ranges(cells.begin[entry], count)]
    y_low, y_high, x_low, slope, reach = edges.T
    py = y[pair]
    beside = (y_low <= py) & (py <= y_high)
    off = x_low + (py - y_low) * slope - x[pair]
    on = beside & (np.abs(off) <= reach)
    crossed = beside & (off > 0) & (py < y_high)
    total = np.concatenate([[0], np.cumsum(crossed)])
    ends = np.cumsum(count)
    inside = cells.odd[entry] ^ ((total[ends] - total[ends - count]) % 2 == 1)
    inside[pair[on]] = True
    return inside
