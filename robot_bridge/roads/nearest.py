"""The nearest point of a network's edges."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .box_pairs import boxes_of, cell_number, cell_size, cells_of
from .centrelines import Floats, Ints, ranges
from .network import Network
from .points import foot_on


@dataclass(frozen=True)
class Foothold:
    """A point of an edge: ``station`` metres along it, and ``away`` metres from the place that was asked."""

    edge: int
    station: float
    away: float
    x: float
    y: float


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
        self._grid()

    def _grid(self) -> None:
        boxes = boxes_of(self._a, self._b, 0.0)
        self._low = boxes[:, :2].min(axis=0) if len(boxes) else np.zeros(2)
        self._high = boxes[:, 2:].max(axis=0) if len(boxes) else np.zeros(2)
        self._cell = cell_size(boxes) if len(boxes) else 1.0
        segment, cell = cells_of(boxes, self._low, self._cell)
        order = np.argsort(cell, kind="stable")
        self._segment, self._cells = segment[order], cell[order]

    def nearest(
        self, x: float, y: float, reach: float, allowed: NDArray[np.bool_] | None = None
    ) -> Foothold | None:
        """Return the nearest point of the ``allowed`` edges within ``reach`` metres of (x, y), or None."""
        place = np.array([x, y])
        radius = min(self._cell, reach)
        while True:
            found = self._within(place, radius, allowed)
            if found is not None or radius >= reach:
                return found
            radius = min(radius * 4, reach)

    def segments_in(self, low: Floats, high: Floats) -> tuple[Floats, Floats, Ints]:
        """Return the segments near the box ``low`` to ``high``: both ends, (n, 2), and their edge, (n,)."""
        found = np.unique(self._in_cells(low, high))
        return self._a[found], self._b[found], self._owner[found]

    def _within(self, place: Floats, radius: float, allowed: NDArray[np.bool_] | None) -> Foothold | None:
        segments = self._near(place, radius)
        if allowed is not None:
            segments = segments[allowed[self._owner[segments]]]
        if not len(segments):
            return None
        share, away = foot_on(self._a[segments], self._b[segments], place)
        k = int(np.argmin(away))
        if away[k] > radius:
            return None
        segment = int(segments[k])
        foot = self._a[segment] + share[k] * (self._b[segment] - self._a[segment])
        station = float(self._station[segment] + share[k] * self._metres[segment])
        return Foothold(int(self._owner[segment]), station, float(away[k]), float(foot[0]), float(foot[1]))

    def _near(self, place: Floats, radius: float) -> Ints:
        """Return the segments in the cells that a square around ``place`` touches; some more than once."""
        return self._in_cells(place - radius, place + radius)

    def _in_cells(self, low: Floats, high: Floats) -> Ints:
        # Plain numbers: with arrays of two the bounds would take longer than the search.
        (left, bottom), (right, top) = low.tolist(), high.tolist()
        (least_x, least_y), (most_x, most_y) = self._low.tolist(), self._high.tolist()
        left, bottom = max(left, least_x), max(bottom, least_y)
        right, top = min(right, most_x), min(top, most_y)
        if left > right or bottom > top:
            return np.empty(0, np.int64)
        rows = np.arange(int((bottom - least_y) // self._cell), int((top - least_y) // self._cell) + 1)
        columns = np.array([(left - least_x) // self._cell, (right - least_x) // self._cell + 1], np.int64)
        # The cells of a row are numbered one after another.
        bounds = np.searchsorted(self._cells, cell_number(columns, rows[:, None])).tolist()
        return np.concatenate([self._segment[begin:end] for begin, end in bounds])
