"""Which surface is at a place, for one place or a million."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from ..centrelines import Floats, Ints, ranges
from .cells import Cells, cells_of
from .outlines import Edges, areas_of, edges_of
from .surface import DRAWN, Surface

_AT_ONCE = 1 << 16
"""Places that are told together: what they need in between stays in the processor's caches."""

NOWHERE = -1


class SurfaceIndex:
    """Tells the surface at places. It does not change, and any thread may ask it.

    A place on the edge of a surface or of its hole is on the surface. Where surfaces lie on one another a
    drawn one counts before a generated one, then the smaller before the larger, then the later before the
    earlier. A ring that crosses itself encloses by the even-odd rule.

    :raises RoadInputError: naming a surface with a coordinate that is no number.
    """

    def __init__(self, surfaces: Sequence[Surface]) -> None:
        self.surfaces = tuple(surfaces)
        edges = edges_of(self.surfaces)
        self._cells = cells_of(edges, self._rank(edges)) if len(edges) else None
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
        # As Grid, but what is beyond the outermost cells is nowhere; NaN compares false.
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
                found[begin : begin + _AT_ONCE] = _told(self._cells, places[begin : begin + _AT_ONCE])
        return found

    def _rank(self, edges: Edges) -> Ints:
        count = len(self.surfaces)
        areas = areas_of(edges, count)
        generated = np.array([one.origin != DRAWN for one in self.surfaces], bool)
        order = np.lexsort([-np.arange(count), areas, generated])
        rank = np.empty(count, np.int64)
        rank[order] = np.arange(count)
        return rank


def _views(cells: Cells) -> tuple[Any, ...]:
    # Through a memoryview a single number costs a third of what it costs through an array.
    columns = (cells.first, cells.owner, cells.odd, cells.begin, cells.edges.ravel())
    views = [np.ascontiguousarray(column).data for column in columns]
    grid = cells.grid
    x_min, y_min = grid.low.tolist()
    return (x_min, y_min, grid.side, grid.columns, grid.rows, *views)


def _told(cells: Cells, places: Floats) -> Ints:
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
    # Those of one place stand together, the one that counts in front.
    in_front = np.ones(len(place), bool)
    in_front[1:] = place[1:] != place[:-1]
    found = np.full(len(places), NOWHERE, np.int64)
    found[place[in_front]] = cells.owner[entry[in_front]]
    return found


def _inside(cells: Cells, entry: Ints, x: Floats, y: Floats) -> Any:
    """Tell for each entry whether its surface holds its place (x, y), all (n,)."""
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
