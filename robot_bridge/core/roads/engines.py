"""Route engines: Dijkstra by heap or SciPy, contraction hierarchies; all give the same answers."""

from __future__ import annotations

import contextlib
import heapq
import importlib
import math
import threading
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from ..errors import MissingEngineError
from .network import Floats, Ints

# --- The interface of an engine for routes ---

Ends = Sequence[tuple[int, float]]
"""Nodes with the cost from the start to each, or from each to the goal."""


@dataclass(frozen=True)
class RouteGraph:
    """A directed graph: arc ``k`` leads from node ``tail[k]`` to node ``head[k]``; ``nodes`` is (n, 2)."""

    nodes: Floats
    tail: Ints
    head: Ints


class Engine(Protocol):
    """Finds cheapest ways on one graph under one set of costs, which may change arc by arc."""

    name: str
    """The engine's name for messages."""

    def set_costs(self, arcs: Ints, costs: Floats) -> None:
        """Give ``arcs`` other costs, above 0; infinity closes one."""

    def way(self, starts: Ends, goals: Ends) -> list[int] | None:
        """Return the arcs of the cheapest way from any of ``starts`` to any of ``goals``; None for none.

        A way may be empty: from a node that is both.
        """


def cheapest_of_parallel(graph: RouteGraph, costs: Floats) -> Ints:
    """Return the cheapest arc of each group of parallel ones."""
    order = np.lexsort([costs, graph.head, graph.tail])
    tail, head = graph.tail[order], graph.head[order]
    new = np.ones(len(order), bool)
    new[1:] = (tail[1:] != tail[:-1]) | (head[1:] != head[:-1])
    best: Ints = order[new]
    return best


# --- Dijkstra's algorithm with a heap: slow, without dependencies ---


class PlainEngine:
    """Searches outwards from the start until the goal is reached."""

    name = "Dijkstra in Python"

    def __init__(self, graph: RouteGraph, costs: Floats) -> None:
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


# --- Dijkstra's algorithm of SciPy: every node is visited for each query, in compiled code ---


def scipy_engines(graph: RouteGraph) -> Callable[[Floats], ScipyEngine]:
    """Return the factory of engines on ``graph`` from the cost of each arc.

    :raises ImportError: if SciPy is not installed, so that another engine can be chosen in time.
    """
    importlib.import_module("scipy.sparse.csgraph")
    return lambda costs: ScipyEngine(graph, costs)


class ScipyEngine:
    """Searches a sparse matrix, in which changed costs are written in place.

    Its entries are the pairs of nodes that arcs lead between, in the order of cheapest_of_parallel. The
    matrix would add up the costs of parallel arcs, so it holds only the cheapest arc of each pair; if that is
    closed, the entry is infinite.

    :raises ImportError: if SciPy is not installed.
    """

    name = "SciPy"

    def __init__(self, graph: RouteGraph, costs: Floats) -> None:
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


def _entries(graph: RouteGraph, order: Ints) -> Ints:
    """Return the number of the pair of nodes that each arc leads between, for arcs in ``order``, by pairs."""
    tail, head = graph.tail[order], graph.head[order]
    new = np.zeros(len(order), np.int64)
    new[1:] = (tail[1:] != tail[:-1]) | (head[1:] != head[:-1])
    entries: Ints = np.cumsum(new)
    return entries


# --- Customisable contraction hierarchies (Dibbelt, Strasser and Wagner, 2016) by RoutingKit ---
# The graph is ordered once; costs are applied to it afterwards, and a few of them can be changed in
# milliseconds.

_INFINITE = 2**31 - 1
_UNIT = 1e-4
"""Metres or seconds per integer unit: RoutingKit counts in 31 bits, which limits ways to 214 km."""


class ContractionEngines:
    """Makes engines on one graph, which is ordered once, through the package ``routingkit-cch``.

    :raises ImportError: if that package is not installed.
    """

    name = "contraction hierarchies (RoutingKit)"

    def __init__(self, graph: RouteGraph) -> None:
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

    If two ways differ by less than rounding, either may be found.
    """

    name = ContractionEngines.name

    def __init__(self, made_by: ContractionEngines, costs: Floats) -> None:
        self._graph = made_by.graph
        self._costs = costs.copy()
        self._lengths = _Metric(made_by, _whole(costs))
        # Ways have too few arcs for this to overflow, so it marks unreachable nodes.
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
        # There is a way, but it is too long to count.
        return PlainEngine(self._graph, costs).way(starts, goals)


class _Metric:
    """One set of whole costs over the ordered graph.

    Changes are applied when the next way is requested: closing an edge for one way costs no more than leaving
    it closed.
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
        # A query belongs to its thread, engines are used from several, and costs cannot change while a query
        # exists. Creating one takes less time than passing the request to its thread.
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


# --- The fastest available engine ---

EngineFactory = Callable[[Floats], Engine]
"""Makes an engine on one graph from the cost of each arc."""

AUTOMATIC = "automatic"

_MAKERS: dict[str, tuple[str, str, Callable[[RouteGraph], EngineFactory]]] = {
    "contraction": ("routingkit_cch", "routingkit-cch", ContractionEngines),
    "scipy": ("scipy", "scipy", scipy_engines),
    "plain": ("heapq", "", lambda graph: lambda costs: PlainEngine(graph, costs)),
}
"""For each engine its module, the package of that, and its factory."""

ENGINES = (AUTOMATIC, *_MAKERS)


def engines_for(graph: RouteGraph, name: str = AUTOMATIC) -> EngineFactory:
    """Return the factory of engines ``name``; for AUTOMATIC the fastest one available.

    :raises MissingEngineError: when ``name`` is unknown, or its package is not installed.
    """
    if name not in ENGINES:
        raise MissingEngineError(f"There is no engine {name!r} for routes: choose of {', '.join(ENGINES)}.")
    if not len(graph.tail):
        # There is no way to find, and RoutingKit crashes the process on a graph without arcs.
        return lambda costs: PlainEngine(graph, costs)
    if name == AUTOMATIC:
        return _fastest(graph)
    module, package, maker = _MAKERS[name]
    try:
        return maker(graph)
    except ImportError as error:
        raise MissingEngineError(
            f"The engine {name!r} for routes needs {module}, which does not load here ({error}): "
            f"install it with 'pip install {package}', or choose another of {', '.join(ENGINES)}."
        ) from error


def safe_engines(graph: RouteGraph) -> EngineFactory:
    """Return the factory of the fastest engines here that cannot crash the process: all but RoutingKit's."""
    return _fastest(graph, [name for name in _MAKERS if name != "contraction"])


def _fastest(graph: RouteGraph, names: Iterable[str] = tuple(_MAKERS)) -> EngineFactory:
    for _, _, maker in (_MAKERS[name] for name in names):
        with contextlib.suppress(ImportError):
            return maker(graph)
    raise AssertionError("the plain engine needs nothing")
