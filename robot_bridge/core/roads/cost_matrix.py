"""Matrix of driving costs between many places."""

from __future__ import annotations

import heapq
import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .engines import RouteGraph, cheapest_of_parallel
from .map_matching import Foothold, NearestEdge
from .network import BACKWARD, FORWARD, SAME, Floats, Ints, Network
from .routes import REACH, Place, Restrictions

_AT_ONCE_BY_SCIPY, _AT_ONCE_BY_HEAP = 32, 1
"""Nodes searched between reports of progress: some tenths of a second's work on the roads of a small
country."""


@dataclass(frozen=True)
class RoadMatrix:
    """``costs`` is (n, n), metres or seconds on the roads from the row's place to the column's.

    Infinity means no way. Not counted are the metres, (n,) in ``away``, from each place to the nearest road;
    ``away`` is infinite if none is in reach. ``engine`` names the engine.
    """

    costs: Floats
    away: Floats
    engine: str


def road_matrix(
    network: Network,
    places: Sequence[Place],
    restrictions: Restrictions | None = None,
    reach: float = REACH,
    closed: NDArray[np.bool_] | None = None,
    progress: Callable[[float], None] | None = None,
) -> RoadMatrix:
    """Return the costs of the best routes between all of ``places``, as :class:`~.routes.Router` finds them.

    ``closed``, (edges,), flags closed edges; the default comes from the roads themselves. ``progress``
    receives the finished share of the work, and may raise to end it.
    """
    restrictions = restrictions or Restrictions()
    allowed = restrictions.fit(network) & ~(network.edges.closed if closed is None else closed)
    finder = NearestEdge(network)
    found = [finder.nearest(x, y, reach, allowed) for x, y in places]
    here = np.array([k for k, foothold in enumerate(found) if foothold is not None], dtype=np.int64)
    away = np.array([math.inf if one is None else one.away for one in found])
    costs = np.full((len(places), len(places)), np.inf)
    if not len(here):
        return RoadMatrix(costs, away, "nothing")
    per_edge = network.lengths / network.edges.speed if restrictions.fastest else network.lengths
    ends = _Ends.of(network, [one for one in found if one is not None], per_edge)
    search = _search(network, np.where(allowed, per_edge, np.inf))
    between = _between(search, ends, progress or (lambda share: None))
    costs[np.ix_(here, here)] = np.minimum(between, ends.along_one_edge(network))
    return RoadMatrix(costs, away, search.engine)


@dataclass(frozen=True)
class _Ends:
    """For each of n places, its edge's nodes, (n, 2), and the costs to and from them."""

    nodes: Ints
    leaving: Floats
    coming: Floats
    edge: Ints
    station: Floats
    pace: Floats

    @classmethod
    def of(cls, network: Network, footholds: Sequence[Foothold], per_edge: Floats) -> _Ends:
        edge = np.array([one.edge for one in footholds], dtype=np.int64)
        station = np.array([one.station for one in footholds])
        length = network.lengths[edge]
        pace = per_edge[edge] / np.where(length > 0, length, 1.0)
        metres = np.column_stack([station, length - station])
        direction = network.edges.direction[edge][:, None]
        # A place on a node is on all its roads.
        near = metres <= SAME
        out = near | (direction != np.array([FORWARD, BACKWARD]))
        back = near | (direction != np.array([BACKWARD, FORWARD]))
        costs = metres * pace[:, None]
        return cls(
            np.column_stack([network.tail[edge], network.head[edge]]),
            np.where(out, costs, np.inf),
            np.where(back, costs, np.inf),
            edge,
            station,
            pace,
        )

    def along_one_edge(self, network: Network) -> Floats:
        """Return the costs between places on the same edge, infinity for others."""
        ahead = self.station[None, :] - self.station[:, None]
        direction = network.edges.direction[self.edge][:, None]
        against = np.where(ahead > SAME, BACKWARD, FORWARD)
        may = (np.abs(ahead) <= SAME) | (direction != against)
        same = (self.edge[:, None] == self.edge[None, :]) & may
        costs: Floats = np.where(same, np.abs(ahead) * self.pace[:, None], np.inf)
        return costs


@dataclass(frozen=True)
class _Search:
    """``costs`` from nodes, (k,), to nodes, (m,), as (k, m); k is at most ``at_once``."""

    engine: str
    costs: Callable[[Ints, Ints], Floats]
    at_once: int


def _between(search: _Search, ends: _Ends, progress: Callable[[float], None]) -> Floats:
    nodes, index = np.unique(ends.nodes, return_inverse=True)
    index = index.reshape(ends.nodes.shape)
    parts = []
    for begin in range(0, len(nodes), search.at_once):
        progress(begin / len(nodes))
        parts.append(search.costs(nodes[begin : begin + search.at_once], nodes))
    costs = np.concatenate(parts)
    best = np.full((len(index), len(index)), np.inf)
    for a in (0, 1):
        for b in (0, 1):
            way = costs[np.ix_(index[:, a], index[:, b])]
            best = np.minimum(best, ends.leaving[:, a, None] + way + ends.coming[None, :, b])
    return best


def _search(network: Network, per_edge: Floats) -> _Search:
    edge, tail, head = network.arcs()
    graph = RouteGraph(network.nodes, tail, head)
    costs = per_edge[edge]
    best = cheapest_of_parallel(graph, costs)
    best = best[np.isfinite(costs[best])]
    try:
        from scipy.sparse import csr_matrix
        from scipy.sparse.csgraph import dijkstra
    except ImportError:
        return _by_heap(graph, costs, best)
    size = len(network.nodes)
    matrix = csr_matrix((costs[best], (graph.tail[best], graph.head[best])), shape=(size, size))
    return _Search(
        "SciPy", lambda starts, goals: dijkstra(matrix, indices=starts)[:, goals], _AT_ONCE_BY_SCIPY
    )


def _by_heap(graph: RouteGraph, costs: Floats, arcs: Ints) -> _Search:
    onward: list[list[tuple[int, float]]] = [[] for _ in range(len(graph.nodes))]
    for arc in arcs.tolist():
        onward[int(graph.tail[arc])].append((int(graph.head[arc]), float(costs[arc])))

    def from_one(start: int) -> Floats:
        best = np.full(len(onward), np.inf)
        best[start] = 0.0
        heap = [(0.0, start)]
        while heap:
            cost, node = heapq.heappop(heap)
            if cost > best[node]:
                continue
            for to, step in onward[node]:
                if cost + step < best[to]:
                    best[to] = cost + step
                    heapq.heappush(heap, (cost + step, to))
        return best

    def from_each(starts: Ints, goals: Ints) -> Floats:
        found: Floats = np.array([from_one(node) for node in starts.tolist()])[:, goals]
        return found

    return _Search("Dijkstra in Python", from_each, _AT_ONCE_BY_HEAP)
