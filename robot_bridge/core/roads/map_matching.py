"""Map matching: nearest edges of places, edges along a path, edges of a closure."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .network import (
    Centrelines,
    Floats,
    Ints,
    Network,
    boxes_of,
    cell_number,
    cell_size,
    cells_of,
    foot_on,
    ranges,
)

# --- The nearest point of a network's edges ---


@dataclass(frozen=True)
class Foothold:
    """A point of an edge: ``station`` metres along it, and ``away`` metres from the given place."""

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
        # Places are complex numbers: with the few segments near a place the number of operations dominates,
        # and this halves it.
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
        # Plain numbers: computing the bounds with arrays of two would take longer than the search.
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


# --- Edges that a path runs along: those whose direction and room it shares, not those that it crosses

_STEP = 0.5
"""Metres between the sampled places of a path."""
_ASLANT = math.cos(math.radians(40.0))
"""Beyond this angle a path crosses an edge instead of running along it."""
_LEAST = 1.0
"""Metres of a path along an edge below which it only touches that edge, as at a junction."""
_SAME = 0.01
"""Metres by which one of two edges must be nearer to be the one that a place is on."""
_TOGETHER = 64
"""Places that are processed together, so that few edges are near them."""


def edges_along(
    nearest: NearestEdge, points: Floats, among: NDArray[np.bool_] | None = None, least: float = _LEAST
) -> Ints:
    """Return the edges, of those flagged in ``among``, that the path ``points``, (n, 2), runs along.

    A place of the path is on the nearest edge that it heads along and is no more than half its width away
    from. A path runs along an edge on which it has ``least`` metres, or half of the edge where that is less.
    A path has no levels, so these are ignored.
    """
    network = nearest.network
    places, heading, step = _sampled(points)
    found = [np.empty(0, np.int64)]
    room = float(network.edges.width.max()) / 2 if len(network) else 0.0
    for some in _runs(network, places, among, room):
        low, high = places[some].min(axis=0) - room, places[some].max(axis=0) + room
        found.append(_on(network, *nearest.segments_in(low, high), places[some], heading[some]))
    edges, count = np.unique(np.concatenate(found), return_counts=True)
    enough = step * count >= np.minimum(least, network.lengths[edges] / 2) - 1e-9
    along: Ints = edges[enough if among is None else enough & among[edges]]
    return along


def _runs(network: Network, places: Floats, among: NDArray[np.bool_] | None, room: float) -> list[slice]:
    """Return the runs of places to check: those near an edge of ``among``."""
    begins = np.arange(0, len(places), _TOGETHER)
    if not len(begins) or not len(network):
        return []
    runs = [slice(begin, begin + _TOGETHER) for begin in begins.tolist()]
    if among is None:
        return runs
    edges = network.edges.taken(np.flatnonzero(among))
    if not len(edges):
        return []
    low, high = (reduce.reduceat(edges.xy, edges.first[:-1], axis=0) for reduce in (np.minimum, np.maximum))
    run_low, run_high = (reduce.reduceat(places, begins, axis=0) for reduce in (np.minimum, np.maximum))
    meets = (run_low[:, None] <= high + room) & (run_high[:, None] >= low - room)
    near = np.flatnonzero(np.any(np.all(meets, axis=2), axis=1)).tolist()
    # The box of a bent edge holds much that is far from it.
    boxes = _segment_boxes(edges, room)
    return [runs[k] for k in near if _is_any_in(places[runs[k]], boxes)]


def _segment_boxes(edges: Centrelines, room: float) -> Floats:
    at = ranges(edges.first[:-1], edges.counts() - 1)
    return boxes_of(edges.xy[at], edges.xy[at + 1], room)


def _is_any_in(places: Floats, boxes: Floats) -> bool:
    inside = (places[:, None] >= boxes[:, :2]) & (places[:, None] <= boxes[:, 2:])
    return bool(inside.all(axis=2).any())


def _sampled(points: Floats) -> tuple[Floats, Floats, float]:
    """Return the middles of equal steps along ``points``, (k, 2), their unit vectors, and the step."""
    legs = np.diff(points, axis=0)
    metres = np.hypot(*legs.T)
    moves = metres > 1e-9
    legs, metres, start = legs[moves], metres[moves], points[:-1][moves]
    if not len(legs):
        return np.empty((0, 2)), np.empty((0, 2)), 0.0
    end = np.cumsum(metres)
    count = max(math.ceil(end[-1] / _STEP), 1)
    step = float(end[-1]) / count
    station = (np.arange(count) + 0.5) * step
    leg = np.minimum(np.searchsorted(end, station), len(legs) - 1)
    unit = (legs / metres[:, None])[leg]
    return start[leg] + unit * (station - (end - metres)[leg])[:, None], unit, step


def _on(network: Network, a: Floats, b: Floats, owner: Ints, places: Floats, heading: Floats) -> Ints:
    """Return the edges that the places are on, once per place."""
    if not len(a):
        return np.empty(0, np.int64)
    step = b - a
    metres = np.maximum(np.hypot(*step.T), 1e-9)
    unit = step / metres[:, None]
    away = places[:, None, :] - a[None, :, :]
    along = (away * unit).sum(axis=2)
    aside = np.abs(away[..., 0] * unit[:, 1] - away[..., 1] * unit[:, 0])
    beyond = np.maximum(np.maximum(-along, along - metres), 0.0)
    off = np.hypot(aside, beyond)
    off[(off > network.edges.width[owner] / 2) | (np.abs(heading @ unit.T) < _ASLANT)] = np.inf
    least = off.min(axis=1, keepdims=True)
    place, segment = np.nonzero(np.isfinite(off) & (off <= least + _SAME))
    # A place is equally near to two segments of one edge where they meet.
    once = np.unique(np.column_stack([place, owner[segment]]), axis=0)
    edges: Ints = once[:, 1]
    return edges


# --- Temporary closures: finding a closed stretch of road on the present network
# Edges have no ids that outlive a publication, so a closure stores the line of its edge.

BESIDE = 0.5
"""Metres by which a road may move in a new publication and still count as the closed one."""


def edges_of_closure(nearest: NearestEdge, line: Floats, level: int) -> Ints:
    """Return the edges that lie where ``line``, (n, 2), was closed on ``level``.

    An edge that has been split since is found in all its pieces, one that has been joined to others as the
    longer edge that it is a part of: closing too much is safer than closing too little.
    """
    network = nearest.network
    along = edges_along(nearest, line)
    along = along[network.edges.level[along] == level]
    near = [edge for edge in along.tolist() if _beside(network, edge, line)]
    return np.array(near, dtype=np.int64)


def _beside(network: Network, edge: int, line: Floats) -> bool:
    """Return whether the shorter of the edge and ``line`` lies on the longer, so that they are one road."""
    own = network.edges.line(edge)
    shorter, longer = (own, line) if _metres(own) <= _metres(line) else (line, own)
    middle = _middle(shorter)
    return _off(longer, middle) <= BESIDE


def _metres(line: Floats) -> float:
    return float(np.hypot(*np.diff(line, axis=0).T).sum())


def _middle(line: Floats) -> Floats:
    stations = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(line, axis=0).T))])
    return np.array([np.interp(stations[-1] / 2, stations, line[:, k]) for k in (0, 1)])


def _off(line: Floats, place: Floats) -> float:
    return float(foot_on(line[:-1], line[1:], place)[1].min())
