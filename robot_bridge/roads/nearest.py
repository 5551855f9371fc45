"""The nearest point of a network's edges."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .box_pairs import boxes_of, cell_number, cell_size, cells_of
from .centrelines import Floats, Ints, ranges
from .network import Network


@dataclass(frozen=True)
class Foothold:
    """A point of an edge: ``station`` metres along it, and ``away`` metres from the place that was asked."""

    edge: int
    station: float
    away: float
    x: float
    y: float


_AS_COMPLEX = np.array([1.0, 1.0j])
"""Makes x + yj of points, (n, 2)."""


class NearestEdge:
    """Finds the nearest edge through a grid of their segments."""

    def __init__(self, network: Network) -> None:
        self.network = network
        edges = network.edges
        at = ranges(edges.first[:-1], edges.counts() - 1)
        self._owner = np.repeat(np.arange(len(edges)), edges.counts() - 1)
        self._a, self._b = edges.xy[at], edges.xy[at + 1]
        metres = np.hypot(*(self._b - self._a).T)
        total = np.concatenate([[0.0], np.cumsum(metres)])
        begin = np.searchsorted(self._owner, np.arange(len(edges)))
        self._station = total[:-1] - total[begin][self._owner]
        self._metres = metres
        # A place as one complex number: on as few segments as are near a place the count of steps is what
        # costs, and this takes half as many.
        self._from = self._a @ _AS_COMPLEX
        self._step = self._b @ _AS_COMPLEX - self._from
        self._square = np.maximum(np.abs(self._step) ** 2, 1e-18)
        self._grid()

    def _grid(self) -> None:
        boxes = boxes_of(self._a, self._b, 0.0)
        self._low = boxes[:, :2].min(axis=0) if len(boxes) else np.zeros(2)
        high = boxes[:, 2:].max(axis=0) if len(boxes) else np.zeros(2)
        self._bounds = *self._low.tolist(), *high.tolist()
        self._cell = cell_size(boxes) if len(boxes) else 1.0
        segment, cell = cells_of(boxes, self._low, self._cell)
        order = np.argsort(cell, kind="stable")
        self._segment, self._cells = segment[order], cell[order]

    def nearest(
        self, x: float, y: float, reach: float, allowed: NDArray[np.bool_] | None = None
    ) -> Foothold | None:
        """Return the nearest point of the ``allowed`` edges within ``reach`` metres of (x, y), or None."""
        radius = min(self._cell, reach)
        while True:
            found = self._within(x, y, radius, allowed)
            if found is not None or radius >= reach:
                return found
            radius = min(radius * 4, reach)

    def segments_in(self, low: Floats, high: Floats) -> tuple[Floats, Floats, Ints]:
        """Return the segments near the box ``low`` to ``high``: both ends, (n, 2), and their edge, (n,)."""
        found = np.unique(self._in_cells(*low.tolist(), *high.tolist()))
        return self._a[found], self._b[found], self._owner[found]

    def _within(
        self, x: float, y: float, radius: float, allowed: NDArray[np.bool_] | None
    ) -> Foothold | None:
        segments = self._in_cells(x - radius, y - radius, x + radius, y + radius)
        if allowed is not None:
            segments = segments[allowed[self._owner[segments]]]
        if not len(segments):
            return None
        step = self._step[segments]
        there = complex(x, y) - self._from[segments]
        share = np.minimum(np.maximum((there * step.conj()).real / self._square[segments], 0.0), 1.0)
        away = np.abs(there - share * step)
        k = int(away.argmin())
        if away[k] > radius:
            return None
        segment, part = int(segments[k]), float(share[k])
        foot = complex(self._from[segment] + part * step[k])
        station = float(self._station[segment] + part * self._metres[segment])
        return Foothold(int(self._owner[segment]), station, float(away[k]), foot.real, foot.imag)

    def _in_cells(self, left: float, bottom: float, right: float, top: float) -> Ints:
        """Return the segments in the cells that a box touches; some more than once."""
        # Plain numbers: with arrays of two the bounds would take longer than the search.
        least_x, least_y, most_x, most_y = self._bounds
        left, bottom = max(left, least_x), max(bottom, least_y)
        right, top = min(right, most_x), min(top, most_y)
        if left > right or bottom > top:
            return np.empty(0, np.int64)
        rows = range(int((bottom - least_y) // self._cell), int((top - least_y) // self._cell) + 1)
        columns = int((left - least_x) // self._cell), int((right - least_x) // self._cell) + 1
        # The cells of a row are numbered one after another.
        ends = [cell_number(column, row) for row in rows for column in columns]
        bounds = self._cells.searchsorted(ends).tolist()
        spans = zip(bounds[::2], bounds[1::2], strict=True)
        return np.concatenate([self._segment[begin:end] for begin, end in spans])
