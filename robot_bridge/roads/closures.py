"""Roads closed for a time: a stretch of road as it was closed, found again on whatever network is in force.

Edges have no names that outlive a publication, so that a closure keeps the line of its edge.
"""

from __future__ import annotations

import numpy as np

from .along import edges_along
from .centrelines import Floats, Ints
from .nearest import NearestEdge
from .network import Network
from .points import foot_on

BESIDE = 0.5
"""Metres by which a road may have been moved in a new publication and still be the one that was closed."""


def edges_of_closure(nearest: NearestEdge, line: Floats, level: int) -> Ints:
    """Return the edges that lie where ``line``, (n, 2), was closed on ``level``.

    An edge that has been split since is found in all its pieces, one that has been joined to others as the
    longer edge that it is a part of: rather too much is closed than too little.
    """
    network = nearest.network
    along = edges_along(nearest, line)
    along = along[network.edges.level[along] == level]
    near = [edge for edge in along.tolist() if _beside(network, edge, line)]
    return np.array(near, dtype=np.int64)


def _beside(network: Network, edge: int, line: Floats) -> bool:
    """Tell whether the shorter of the edge and ``line`` lies on the longer, so that they are one road."""
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
