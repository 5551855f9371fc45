"""QGIS's own graph search: what is left where neither RoutingKit nor SciPy is installed."""

from __future__ import annotations

import math

import numpy as np
from qgis.analysis import QgsGraph, QgsGraphAnalyzer
from qgis.core import QgsPointXY

from ...robot_bridge.roads.engines.engine import Ends, Graph


class GraphEngine:
    """Finds ways by QgsGraphAnalyzer on a graph that is kept; it is made anew when costs have changed."""

    name = "QGIS (QgsGraphAnalyzer)"

    def __init__(self, graph: Graph, costs: np.ndarray) -> None:
        self._graph = graph
        self._costs = costs.copy()
        self._made: QgsGraph | None = None
        self._arcs: list[int] = []

    def set_costs(self, arcs: np.ndarray, costs: np.ndarray) -> None:
        """Give ``arcs`` other costs."""
        self._costs[arcs] = costs
        self._made = None

    def way(self, starts: Ends, goals: Ends) -> list[int] | None:
        """Return the arcs of the cheapest way, None for none."""
        made = self._made or self._make()
        least, tree, last = math.inf, [], -1
        for node, before in starts:
            came_by, away = QgsGraphAnalyzer.dijkstra(made, node, 0)
            for goal, beyond in goals:
                # Nodes that cannot be reached cost the greatest number there is.
                cost = before + away[goal] + beyond if goal == node or came_by[goal] >= 0 else math.inf
                if cost < least:
                    least, tree, last = cost, came_by, goal
        return None if last < 0 else self._back(tree, last)

    def _back(self, tree: list[int], node: int) -> list[int]:
        arcs = []
        while tree[node] >= 0:
            arc = self._arcs[tree[node]]
            arcs.append(arc)
            node = int(self._graph.tail[arc])
        return arcs[::-1]

    def _make(self) -> QgsGraph:
        made = QgsGraph()
        for x, y in self._graph.nodes.tolist():
            made.addVertex(QgsPointXY(x, y))
        self._arcs = np.flatnonzero(np.isfinite(self._costs)).tolist()
        for arc in self._arcs:
            ends = int(self._graph.tail[arc]), int(self._graph.head[arc])
            made.addEdge(*ends, [float(self._costs[arc])])
        self._made = made
        return made
