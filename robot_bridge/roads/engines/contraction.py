"""Customisable contraction hierarchies (Dibbelt, Strasser and Wagner, 2016) by RoutingKit.

The graph is ordered once; costs are laid over it afterwards, and a few of them are changed in milliseconds.
"""

from __future__ import annotations

import threading

import numpy as np

from ..centrelines import Floats, Ints
from .engine import Ends, Graph
from .plain import PlainEngine

_INFINITE = 2**31 - 1
_UNIT = 1e-4
"""Metres or seconds in one whole number: RoutingKit counts in 31 bits, so that ways end at 214 km."""


class ContractionEngines:
    """Makes engines on one graph, which is ordered once, through the package ``routingkit-cch``.

    :raises ImportError: where that package is not installed.
    """

    name = "contraction hierarchies (RoutingKit)"

    def __init__(self, graph: Graph) -> None:
        import routingkit_cch as kit

        self.kit = kit
        self.graph = graph
        tail, head = graph.tail.tolist(), graph.head.tolist()
        x, y = (graph.nodes[:, k].tolist() for k in (0, 1))
        order = kit.compute_order_inertial(len(graph.nodes), tail, head, y, x)
        self.hierarchy = kit.CCH(order, tail, head, False)

    def __call__(self, costs: Floats) -> ContractionEngine:
        """Return an engine that finds ways under ``costs``."""
        return ContractionEngine(self, costs)


class ContractionEngine:
    """Finds ways under one set of costs, in whole units of a tenth of a millimetre or millisecond.

    Of two ways that differ by less than rounding either may be found.
    """

    name = ContractionEngines.name

    def __init__(self, made_by: ContractionEngines, costs: Floats) -> None:
        self._kit = made_by.kit
        self._graph = made_by.graph
        self._costs = costs.copy()
        self._metric = self._kit.CCHMetric(made_by.hierarchy, _whole(costs).tolist())
        self._updater = self._kit.CCHMetricPartialUpdater(made_by.hierarchy)
        self._query = self._kit.CCHQuery(self._metric)
        self._lock = threading.Lock()

    def set_costs(self, arcs: Ints, costs: Floats) -> None:
        """Give ``arcs`` other costs."""
        changes = dict(zip(arcs.tolist(), _whole(costs).tolist(), strict=True))
        with self._lock:
            self._costs[arcs] = costs
            # A query keeps hold of the costs that it was made with.
            del self._query
            self._updater.apply(self._metric, changes)
            self._query = self._kit.CCHQuery(self._metric)

    def way(self, starts: Ends, goals: Ends) -> list[int] | None:
        """Return the arcs of the cheapest way, None for none."""
        from_there, to_there = (
            [(node, round(cost / _UNIT)) for node, cost in ends] for ends in (starts, goals)
        )
        with self._lock:
            result = self._query.run_multi(from_there, to_there)
            if result.distance is not None:
                return list(result.arc_path)
            costs = self._costs.copy()
        if costs[np.isfinite(costs)].sum() < _INFINITE * _UNIT:
            return None
        # No way, or one too long to be counted.
        return PlainEngine(self._graph, costs).way(starts, goals)


def _whole(costs: Floats) -> Ints:
    whole = np.full(len(costs), _INFINITE, np.int64)
    finite = np.isfinite(costs)
    whole[finite] = np.clip(np.rint(costs[finite] / _UNIT), 1, _INFINITE)
    return whole
