"""Dijkstra's algorithm with a heap: slow, and needs nothing."""

from __future__ import annotations

import heapq
import math

import numpy as np

from ..centrelines import Floats, Ints
from .engine import Ends, Graph


class PlainEngine:
    """Looks around from the start until it comes to the goal."""

    name = "Dijkstra in Python"

    def __init__(self, graph: Graph, costs: Floats) -> None:
        order = np.argsort(graph.tail, kind="stable")
        self._first = np.searchsorted(graph.tail[order], np.arange(len(graph.nodes) + 1)).tolist()
        self._arcs = order.tolist()
        self._tail, self._head = graph.tail.tolist(), graph.head.tolist()
        self._costs = costs.tolist()

    def set_costs(self, arcs: Ints, costs: Floats) -> None:
        """Give ``arcs`` other costs."""
        for arc, cost in zip(arcs.tolist(), costs.tolist(), strict=True):
            self._costs[arc] = cost

    def way(self, starts: Ends, goals: Ends) -> list[int] | None:
        """Return the arcs of the cheapest way, None for none."""
        best: dict[int, float] = {}
        came_by: dict[int, int] = {}
        beyond: dict[int, float] = {}
        for node, cost in goals:
            beyond[node] = min(cost, beyond.get(node, math.inf))
        heap = [(cost, node, -1) for node, cost in starts]
        heapq.heapify(heap)
        least, last = math.inf, -1
        while heap and heap[0][0] < least:
            cost, node, arc = heapq.heappop(heap)
            if node in best:
                continue
            best[node], came_by[node] = cost, arc
            if cost + beyond.get(node, math.inf) < least:
                least, last = cost + beyond[node], node
            for onward in self._arcs[self._first[node] : self._first[node + 1]]:
                to = self._head[onward]
                if to not in best and self._costs[onward] < math.inf:
                    heapq.heappush(heap, (cost + self._costs[onward], to, onward))
        return None if last < 0 else self._back(came_by, last)

    def _back(self, came_by: dict[int, int], node: int) -> list[int]:
        arcs = []
        while (arc := came_by[node]) >= 0:
            arcs.append(arc)
            node = self._tail[arc]
        return arcs[::-1]
