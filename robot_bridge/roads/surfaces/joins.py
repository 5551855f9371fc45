"""What is missing between strips that end in one point at an angle: the wedge on the outer side."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from ..centrelines import Centrelines, Floats, Ints
from ..points import same_points
from .strips import strips_of, widened

MEETING_M = 0.001
"""Ends this near to one another are one point, as in the network."""

_SHARPEST = np.cos(np.radians(100.0))
"""Roads that part at a sharper turn do not lead on into each other, and their strips overlap anyway."""

_LONGEST_STUB = 1.0
"""How many widths of a road next to its end are looked at."""


def wedges(roads: Centrelines, rank: Sequence[int]) -> tuple[Any, Ints]:
    """Return polygons that fill the corners between roads that end in one point, and the road of each.

    The road is the one whose class has the lower ``rank``, and its class is that of the wedge, which takes
    nothing from roads of other classes there. The corner is as wide as the narrower of the two.
    """
    import shapely

    road, node, away = _ends(roads)
    one, other = _pairs(node)
    lengths = np.hypot(*away.T)
    turn = -(away[one] * away[other]).sum(axis=1) / np.maximum(lengths[one] * lengths[other], 1e-12)
    leads_on = (turn > _SHARPEST) & (turn < 1 - 1e-9)
    one, other = one[leads_on], other[leads_on]
    width = np.minimum(roads.width[road[one]], roads.width[road[other]])
    at = _points_of(roads)[one]
    corners = np.stack([at + away[one], at, at + away[other]], axis=1)
    lines = shapely.linestrings(corners) if len(corners) else np.empty(0, dtype=object)
    made = widened(lines, width)
    ranks = np.asarray(rank, np.int64)
    first = ranks[road[one]] <= ranks[road[other]]
    winner = np.where(first, road[one], road[other])
    mixed = roads.surface[road[one]] != roads.surface[road[other]]
    for k in np.flatnonzero(mixed).tolist():
        meeting = np.unique(road[node == node[one[k]]])
        others = meeting[roads.surface[meeting] != roads.surface[winner[k]]]
        made[k] = shapely.difference(made[k], shapely.union_all(strips_of(roads, others)))
    return made, winner


def _points_of(roads: Centrelines) -> Floats:
    return np.concatenate([roads.xy[roads.first[:-1]], roads.xy[roads.first[1:] - 1]])


def _ends(roads: Centrelines) -> tuple[Ints, Ints, Floats]:
    """Return, for the beginning and the end of each road, its index, its node, and a step along the road."""
    count = len(roads)
    points = _points_of(roads)
    inner = np.concatenate([roads.xy[roads.first[:-1] + 1], roads.xy[roads.first[1:] - 2]])
    road = np.tile(np.arange(count), 2)
    step = inner - points
    length = np.maximum(np.hypot(*step.T), 1e-12)
    shorter = np.minimum(1.0, _LONGEST_STUB * roads.width[road] / length)
    return road, same_points(points, MEETING_M), step * shorter[:, None]


def _pairs(node: Ints) -> tuple[Ints, Ints]:
    """Return all pairs of ends that share a node."""
    order = np.argsort(node, kind="stable")
    _, begin, count = np.unique(node[order], return_index=True, return_counts=True)
    pairs = [
        (order[first + i], order[first + j])
        for first, size in zip(begin.tolist(), count.tolist(), strict=True)
        for i in range(size)
        for j in range(i + 1, size)
    ]
    one, other = np.array(pairs, np.int64).reshape(-1, 2).T
    return one, other
