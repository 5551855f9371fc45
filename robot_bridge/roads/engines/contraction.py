"""Customisable contraction hierarchies (Dibbelt, Strasser and Wagner, 2016) by RoutingKit.

The graph is ordered once; costs are laid over it afterwards, and a few of them are changed in milliseconds.
"""

from __future__ import annotations

import threading
from collections.abc import Sequence

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
        self._graph = made_by.graph
        self._costs = costs.copy()
        self._lengths = _Metric(made_by, _whole(costs))
        # Ways are too short in arcs for this to overflow, so that it knows what cannot be reached.
        self._arcs = _Metric(made_by, _one_each(costs))
        self._lock = threading.Lock()

    def set_costs(self, arcs: Ints, costs: Floats) -> None:
        """Give ``arcs`` other costs."""
        with self._lock:
            self._costs[arcs] = costs
            self._lengths.change(arcs, _whole(costs))
            self._arcs.change(arcs, _one_each(costs))

    def way(self, starts: Ends, goals: Ends) -> list[int] | None:
        """Return the arcs of the cheapest way, None for none."""
        from_there, to_there = (
            [(node, round(cost / _UNIT)) for node, cost in ends] for ends in (starts, goals)
        )
        with self._lock:
            way = self._lengths.way(from_there, to_there)
            if way is not None or self._arcs.way(*_without_costs(starts, goals)) is None:
                return way
            costs = self._costs.copy()
        # There is a way, and it is too long to be counted.
        return PlainEngine(self._graph, costs).way(starts, goals)


class _Metric:
    """One set of whole costs over the ordered graph.

    Changes are laid over it when the next way is asked for: what is closed for one way and opened after it
    costs no more than what stays closed.
    """

    def __init__(self, made_by: ContractionEngines, costs: Ints) -> None:
        self._kit, self._hierarchy = made_by.kit, made_by.hierarchy
        self._metric = self._kit.CCHMetric(self._hierarchy, costs.tolist())
        self._changes: dict[int, int] = {}

    def change(self, arcs: Ints, costs: Ints) -> None:
        self._changes.update(zip(arcs.tolist(), costs.tolist(), strict=True))

    def way(self, starts: Sequence[tuple[int, int]], goals: Sequence[tuple[int, int]]) -> list[int] | None:
        if self._changes:
            self._kit.CCHMetricPartialUpdater(self._hierarchy).apply(self._metric, self._changes)
            self._changes = {}
        # A query belongs to the thread that made it, engines are asked from several, and as long as there is
        # one the costs cannot be changed. To make one takes less than to hand the question to its thread.
        query = self._kit.CCHQuery(self._metric)
        result = query.run_multi(starts, goals)
        if result.distance is None:
            return None
        way: list[int] = result.arc_path
        return way


def _without_costs(*ends: Ends) -> tuple[list[tuple[int, int]], ...]:
    return tuple([(node, 0) for node, _ in some] for some in ends)


def _one_each(costs: Floats) -> Ints:
    return np.where(np.isfinite(costs), 1, _INFINITE)


def _whole(costs: Floats) -> Ints:
    whole = np.full(len(costs), _INFINITE, np.int64)
    finite = np.isfinite(costs)
    whole[finite] = np.clip(np.rint(costs[finite] / _UNIT), 1, _INFINITE)
    return whole
