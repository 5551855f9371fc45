"""Dijkstra's algorithm of SciPy: every node is visited for each query, in compiled code."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from ..centrelines import Floats, Ints
from .engine import Ends, Graph, cheapest_of_parallel


class ScipyEngine:
    """Searches a sparse matrix; changed costs are written into it when the next way is asked for.

    :raises ImportError: where SciPy is not installed.
    """

    name = "SciPy"

    def __init__(self, graph: Graph, costs: Floats) -> None:
        from scipy.sparse.csgraph import dijkstra

        self._dijkstra = dijkstra
        self._graph = graph
        self._costs = costs.copy()
        self._matrix: Any = None
        self._arc_of: dict[tuple[int, int], int] = {}

    def set_costs(self, arcs: Ints, costs: Floats) -> None:
        """Give ``arcs`` other costs."""
        self._costs[arcs] = costs
        self._matrix = None

    def way(self, starts: Ends, goals: Ends) -> list[int] | None:
        """Return the arcs of the cheapest way, None for none."""
        if self._matrix is None:
            self._prepare()
        nodes = [node for node, _ in starts]
        away, before = self._dijkstra(self._matrix, indices=nodes, return_predecessors=True)
        least, row, last = math.inf, -1, -1
        for k, (_, to_start) in enumerate(starts):
            for node, beyond in goals:
                if to_start + away[k, node] + beyond < least:
                    least, row, last = to_start + away[k, node] + beyond, k, node
        if row < 0:
            return None
        arcs = []
        while last != nodes[row]:
            previous = int(before[row, last])
            arcs.append(self._arc_of[previous, last])
            last = previous
        return arcs[::-1]

    def _prepare(self) -> None:
        from scipy.sparse import csr_matrix

        # A matrix adds up what parallel arcs cost, so that only the cheapest may be in it.
        best = cheapest_of_parallel(self._graph, self._costs)
        best = best[np.isfinite(self._costs[best])]
        tail, head = self._graph.tail[best], self._graph.head[best]
        size = len(self._graph.nodes)
        self._matrix = csr_matrix((self._costs[best], (tail, head)), shape=(size, size))
        self._arc_of = dict(zip(zip(tail.tolist(), head.tolist(), strict=True), best.tolist(), strict=True))
