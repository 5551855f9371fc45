"""Which edges a path runs along: those that it shares the direction and the room of, not those it crosses."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from .box_pairs import boxes_of
from .centrelines import Centrelines, Floats, Ints, ranges
from .nearest import NearestEdge
from .network import Network

_STEP = 0.5
"""Metres between the places of a path that are looked at."""
_ASLANT = math.cos(math.radians(40.0))
"""Beyond this angle a path crosses an edge, it does not run along it."""
_LEAST = 1.0
"""Metres of a path along an edge below which it only touches that edge, as at a junction."""
_SAME = 0.01
"""Metres by which of two edges one must be nearer to be the one that a place is on."""
_TOGETHER = 64
"""Places that are looked at together, so that few edges are near them."""


def edges_along(
    nearest: NearestEdge, points: Floats, among: NDArray[np.bool_] | None = None, least: float = _LEAST
) -> Ints:
    """Return the edges, of those flagged in ``among``, that the path ``points``, (n, 2), runs along.

    A place of the path is on the nearest edge that it heads along and is no more than half its width away
    from. A path runs along an edge on which it has ``least`` metres, or half of the edge where that is less.
    Levels are not known of a path and do not count.
    """
    network = nearest.network
    places, heading, step = _looked_at(points)
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
    """Return the runs of places that are looked at: those that come near an edge of ``among``."""
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


def _looked_at(points: Floats) -> tuple[Floats, Floats, float]:
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
    """Return the edges that the places are on, each as often as places are on it."""
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
    # Two segments of one edge meet where a place is as near to either.
    once = np.unique(np.column_stack([place, owner[segment]]), axis=0)
    edges: Ints = once[:, 1]
    return edges
