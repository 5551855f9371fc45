"""Dijkstra's algorithm of SciPy: every node is visited for each query, in compiled code."""

from __future__ import annotations

import importlib
import math
from collections.abc import Callable

import numpy as np

from ..centrelines import Floats, Ints
from .engine import Ends, Graph, cheapest_of_parallel


def scipy_engines(graph: Graph) -> Callable[[Floats], ScipyEngine]:
    """Return what makes engines on ``graph`` from the cost of each arc.

    :raises ImportError: where SciPy is not installed, so that another engine can be chosen in time.
    """
    importlib.import_module("scipy.sparse.csgraph")
    return lambda costs: ScipyEngine(graph, costs)


class ScipyEngine:
    """Searches a sparse matrix, into which changed costs are written where they stand.

    Its entries are the pairs of nodes that arcs lead between, in the order of cheapest_of_parallel. It would
    add up what parallel arcs cost, so that of each pair it has the cheapest arc alone; where that is closed,
    the entry is infinite.

    :raises ImportError: where SciPy is not installed.
    """

    name = "SciPy"

    def __init__(self, graph: Graph, costs: Floats) -> None:
        from scipy.sparse import csr_matrix
        from scipy.sparse.csgraph import dijkstra

        self._dijkstra = dijkstra
        self._costs = costs.copy()
        self._arc_of = cheapest_of_parallel(graph, costs)
        self._sorted = np.lexsort([graph.head, graph.tail])
        entry = _entries(graph, self._sorted)
        self._first = np.searchsorted(entry, np.arange(len(self._arc_of) + 1))
        self._entry = np.empty_like(entry)
        self._entry[self._sorted] = entry
        size = len(graph.nodes)
        self._row = np.searchsorted(graph.tail[self._arc_of], np.arange(size + 1))
        self._head = graph.head[self._arc_of]
        self._matrix = csr_matrix((costs[self._arc_of], self._head, self._row), shape=(size, size))

    def set_costs(self, arcs: Ints, costs: Floats) -> None:
        """Give ``arcs`` other costs."""
        self._costs[arcs] = costs
        for entry in set(self._entry[arcs].tolist()):
            parallel = self._sorted[self._first[entry] : self._first[entry + 1]]
            arc = parallel[np.argmin(self._costs[parallel])]
            self._arc_of[entry], self._matrix.data[entry] = arc, self._costs[arc]

    def way(self, starts: Ends, goals: Ends) -> list[int] | None:
        """Return the arcs of the cheapest way, None for none."""
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
            arcs.append(self._arc_between(previous, last))
            last = previous
        return arcs[::-1]

    def _arc_between(self, tail: int, head: int) -> int:
        begin, end = self._row[tail], self._row[tail + 1]
        return int(self._arc_of[begin + np.searchsorted(self._head[begin:end], head)])


def _entries(graph: Graph, order: Ints) -> Ints:
    """Return the number of the pair of nodes that each arc leads between, for arcs in ``order``, by pairs."""
    tail, head = graph.tail[order], graph.head[order]
    new = np.zeros(len(order), np.int64)
    new[1:] = (tail[1:] != tail[:-1]) | (head[1:] != head[:-1])
    entries: Ints = np.cumsum(new)
    return entries
