"""Routes: the shortest or fastest way between two places near a network."""

from __future__ import annotations

import copy
import math
from collections import OrderedDict
from collections.abc import Callable, Collection, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from ..errors import NoRouteError, OffNetworkError
from .engines import AUTOMATIC, Engine, EngineFactory, RouteGraph, engines_for
from .map_matching import Foothold, NearestEdge
from .network import BACKWARD, FORWARD, SAME, Floats, Ints, Network

# --- A sparse route: stretches of edges, one after another ---


@dataclass(frozen=True)
class Route:
    """Stretch ``k`` runs along edge ``edges[k]`` from station ``begin[k]`` to ``end[k]``, all (n,).

    It runs against the edge where ``end`` is less than ``begin``. ``off_start`` and ``off_goal`` are the
    metres from the requested places to the network; ``engine`` names the engine.
    """

    network: Network
    edges: Ints
    begin: Floats
    end: Floats
    off_start: float
    off_goal: float
    engine: str

    @cached_property
    def lengths(self) -> Floats:
        """Metres of each stretch."""
        lengths: Floats = np.abs(self.end - self.begin)
        return lengths

    @property
    def metres(self) -> float:
        """Metres of the whole route."""
        return float(self.lengths.sum())

    @property
    def seconds(self) -> float:
        """Seconds at the speeds of the roads."""
        return self.seconds_at(np.inf)

    def seconds_at(self, speed: float) -> float:
        """Return the driving time in seconds at ``speed`` m/s at most, and within the limits of the roads."""
        return float((self.lengths / np.minimum(self.network.edges.speed[self.edges], speed)).sum())

    @property
    def surfaces(self) -> tuple[str, ...]:
        """The surface of each stretch."""
        return tuple(str(surface) for surface in self.network.edges.surface[self.edges])

    @property
    def nodes(self) -> tuple[int, ...]:
        """The n - 1 nodes between the stretches."""
        back = self.end < self.begin
        passed = np.where(back, self.network.tail[self.edges], self.network.head[self.edges])
        return tuple(passed[:-1].tolist())

    @cached_property
    def points(self) -> Floats:
        """The line of the route, (m, 2)."""
        lines = self.lines
        return np.concatenate([lines[0], *(line[1:] for line in lines[1:])])

    @cached_property
    def widths(self) -> Floats:
        """Metres of road along each of the m - 1 pieces of :attr:`points`."""
        widths = self.network.edges.width[self.edges]
        return np.repeat(widths, [len(line) - 1 for line in self.lines])

    @cached_property
    def lines(self) -> list[Floats]:
        """The line of each stretch."""
        line = self.network.edges.line
        spans = zip(self.edges.tolist(), self.begin.tolist(), self.end.tolist(), strict=True)
        return [stretch(line(edge), begin, end) for edge, begin, end in spans]


def stretch(line: Floats, begin: float, end: float) -> Floats:
    """Return ``line``, (n, 2), from station ``begin`` to station ``end``, reversed if ``end`` is less."""
    low, high = min(begin, end), max(begin, end)
    stations = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(line, axis=0).T))])
    inner = line[(stations > low + 1e-9) & (stations < high - 1e-9)]
    ends = np.column_stack([np.interp([low, high], stations, line[:, k]) for k in (0, 1)])
    cut: Floats = np.concatenate([ends[:1], inner, ends[1:]])
    return cut[::-1] if end < begin else cut


# --- The legs from a robot's place onto its route, and from the route to its goal ---

Place = tuple[float, float]


def with_ends(route: Route, start: Place, goal: Place, turning_radius: float) -> tuple[Floats, Floats]:
    """Return the points from ``start`` to ``goal`` and the width of road along each piece.

    A robot beside the middle of a road joins it at a slant, not at a right angle: far enough ahead for an arc
    of ``turning_radius`` metres.
    """
    stations = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(route.points, axis=0).T))])
    half = (route.widths[0] / 2, route.widths[-1] / 2)
    ahead, behind = (
        min(max(off, math.sqrt(turning_radius * off)), route.metres / 3) if off <= wide else 0.0
        for off, wide in zip((route.off_start, route.off_goal), half, strict=True)
    )
    middle = stretch(route.points, ahead, route.metres - behind)
    points = np.concatenate([[start], middle, [goal]])
    along = ahead + np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(middle, axis=0).T))])
    piece = np.searchsorted(stations, (along[1:] + along[:-1]) / 2, side="right") - 1
    inner = route.widths[np.clip(piece, 0, len(route.widths) - 1)]
    widths = np.concatenate([route.widths[:1], inner, route.widths[-1:]])
    moves = np.hypot(*np.diff(points, axis=0).T) > math.ulp(1e6)
    moves[-1:] |= not moves.any()
    return np.concatenate([points[:1], points[1:][moves]]), widths[moves]


# --- Routes: the shortest or fastest way between two places near a network ---

REACH = 20.0
"""Metres that a place may be away from the network."""

Stretches = tuple[Ints, Floats, Floats]
"""Edges with the stations between which each is driven."""

Ends = dict[int, tuple[float, float]]
"""Nodes with the cost of the stretch between them and a place, and their station on the place's edge."""

_KEPT = 8
"""Number of restriction sets that are cached."""


@dataclass(frozen=True)
class Restrictions:
    """Restrictions of a route: allowed surfaces (None: any) and least width of roads in metres.

    ``fastest`` asks for the least seconds instead of the least metres.
    """

    fastest: bool = False
    surfaces: frozenset[str] | None = None
    least_width: float = 0.0

    def fit(self, network: Network) -> NDArray[np.bool_]:
        """Return which edges of ``network`` may be used if open, (n,)."""
        fit: NDArray[np.bool_] = network.edges.width >= self.least_width
        if self.surfaces is not None:
            fit &= np.isin(network.edges.surface.astype(str), sorted(self.surfaces))
        return fit


@dataclass
class _Ready:
    """The engine for some restrictions, which edges ``fit`` these, and which of them are ``open``."""

    engine: Engine
    fit: NDArray[np.bool_]
    open: NDArray[np.bool_]


class Router:
    """Finds routes on one network. Closed edges are closed for every query from then on.

    ``engine`` is the name of one, or a factory on a graph.

    :raises MissingEngineError: when the engine requested by name is not available.
    """

    def __init__(
        self, network: Network, engine: str | Callable[[RouteGraph], EngineFactory] = AUTOMATIC
    ) -> None:
        self.network = network
        self._edge, tail, head = network.arcs()
        self._graph = RouteGraph(network.nodes, tail, head)
        self._engines = engines_for(self._graph, engine) if isinstance(engine, str) else engine(self._graph)
        self._nearest = NearestEdge(network)
        self._closed = network.edges.closed.copy()
        self._along = int((network.edges.direction != BACKWARD).sum())
        self._arcs_of_edge = _arcs_of_edges(network)
        self._ready: OrderedDict[Restrictions, _Ready] = OrderedDict()

    @property
    def nearest(self) -> NearestEdge:
        """The search for the edge nearest to a place, closed or not."""
        return self._nearest

    @property
    def engines(self) -> EngineFactory:
        """The factory of its engines."""
        return self._engines

    @property
    def engine_name(self) -> str:
        """The engine's name for messages."""
        return self._ready_for(Restrictions()).engine.name

    def copy(self) -> Router:
        """Return a router on the same network and engines, with the same edges closed, for another thread."""
        made = copy.copy(self)
        made._closed, made._ready = self._closed.copy(), OrderedDict()
        return made

    def close(self, edges: Sequence[int]) -> None:
        """Close ``edges`` for every route from now on."""
        self._set_closed(edges, True)

    def open(self, edges: Sequence[int]) -> None:
        """Open ``edges`` again."""
        self._set_closed(edges, False)

    def route(
        self,
        start: Place,
        goal: Place,
        restrictions: Restrictions | None = None,
        reach: float = REACH,
        avoid: Collection[int] = (),
    ) -> Route:
        """Return the best route from the edge nearest to ``start`` to the edge nearest to ``goal``.

        Edges of ``avoid`` are not used, except for the stretches from ``start`` and to ``goal``.

        :raises OffNetworkError: when no usable road is within ``reach`` metres of one of them;
            NoRouteError when no way leads from one to the other.
        """
        restrictions = restrictions or Restrictions()
        ready = self._ready_for(restrictions)
        begin = self._foothold("start", start, reach, restrictions)
        end = self._foothold("goal", goal, reach, restrictions)
        with self._without(avoid):
            stretches = self._stretches(begin, end, ready.engine, restrictions)
        if stretches is None:
            raise NoRouteError(
                f"No way leads from {_text(start)} to {_text(goal)} on the roads that may be used: "
                "check closed roads, one-way roads, surfaces and widths, or repair the network."
            )
        return Route(self.network, *stretches, begin.away, end.away, ready.engine.name)

    @property
    def closed(self) -> NDArray[np.bool_]:
        """Which edges are closed now, (n,)."""
        return self._closed.copy()

    @contextmanager
    def _without(self, edges: Collection[int]) -> Iterator[None]:
        """Close ``edges`` for one route."""
        shut = [edge for edge in edges if not self._closed[edge]]
        if not shut:
            yield
            return
        self.close(shut)
        try:
            yield
        finally:
            self.open(shut)

    def _foothold(self, what: str, place: Place, reach: float, restrictions: Restrictions) -> Foothold:
        if not all(math.isfinite(value) for value in place):
            raise OffNetworkError(f"The {what} {_text(place)} is no place: give two numbers in metres.")
        found = self._nearest.nearest(*place, reach, self._ready_for(restrictions).open)
        if found is None:
            shut = self._nearest.nearest(*place, reach)
            why = (
                ""
                if shut is None
                else f" (the road {shut.away:.1f} m away {self._bar(shut.edge, restrictions)})"
            )
            raise OffNetworkError(
                f"The {what} {_text(place)} is more than {reach:g} m from every road that may be used{why}: "
                "choose a place nearer to a road, or allow a greater distance."
            )
        return found

    def _bar(self, edge: int, restrictions: Restrictions) -> str:
        """Return why ``edge`` may not be used."""
        if self._closed[edge]:
            return "is closed"
        edges = self.network.edges
        if edges.width[edge] < restrictions.least_width:
            return f"is {edges.width[edge]:g} m wide, narrower than {restrictions.least_width:g} m"
        return f"has another surface, {str(edges.surface[edge]) or 'none'}"

    def _costs(self, restrictions: Restrictions) -> Floats:
        """Return the cost of each edge, ignoring restrictions and closures."""
        lengths = self.network.lengths
        return lengths / self.network.edges.speed if restrictions.fastest else lengths

    def _ready_for(self, restrictions: Restrictions) -> _Ready:
        if restrictions not in self._ready:
            fit = restrictions.fit(self.network)
            free = fit & ~self._closed
            costs = np.where(free, self._costs(restrictions), np.inf)
            self._ready[restrictions] = _Ready(self._engines(costs[self._edge]), fit, free)
            while len(self._ready) > _KEPT:
                self._ready.popitem(last=False)
        self._ready.move_to_end(restrictions)
        return self._ready[restrictions]

    def _set_closed(self, edges: Sequence[int], closed: bool) -> None:
        changed = np.array(sorted(set(edges)), dtype=np.int64)
        self._closed[changed] = closed
        arcs = self._arcs_of_edge[changed].ravel()
        arcs = arcs[arcs >= 0]
        edge = self._edge[arcs]
        for restrictions, ready in self._ready.items():
            ready.open[changed] = ready.fit[changed] & (not closed)
            ready.engine.set_costs(arcs, np.where(ready.open[edge], self._costs(restrictions)[edge], np.inf))

    def _stretches(
        self, begin: Foothold, end: Foothold, engine: Engine, restrictions: Restrictions
    ) -> Stretches | None:
        starts = self._ends(begin, restrictions, leaving=True)
        goals = self._ends(end, restrictions, leaving=False)
        direct = self._direct(begin, end)
        way = self._way(starts, goals, engine)
        if way is None:
            return direct
        first, last = self._first_and_last(way, starts, goals)
        edge, low, high = self._whole(way)
        made = (
            np.concatenate([[begin.edge], edge, [end.edge]]),
            np.concatenate([[begin.station], low, [goals[last][1]]]),
            np.concatenate([[starts[first][1]], high, [end.station]]),
        )
        if direct is not None and self._cost(direct, restrictions) <= self._cost(made, restrictions):
            return direct
        return _without_nothing(*made)

    def _way(self, starts: Ends, goals: Ends, engine: Engine) -> list[int] | None:
        # Searching for a way that cannot exist takes an engine longest.
        parts = self.network.parts
        if {int(parts[node]) for node in starts}.isdisjoint(int(parts[node]) for node in goals):
            return None
        return engine.way(_costs_only(starts), _costs_only(goals))

    def _ends(self, foothold: Foothold, restrictions: Restrictions, *, leaving: bool) -> Ends:
        """Return the ends of its edge that can be reached from ``foothold``, or from which it can be
        reached."""
        edge, network = foothold.edge, self.network
        length = float(network.lengths[edge])
        direction = int(network.edges.direction[edge])
        reached: Ends = {}
        for node, station, against in (
            (int(network.tail[edge]), 0.0, FORWARD if leaving else BACKWARD),
            (int(network.head[edge]), length, BACKWARD if leaving else FORWARD),
        ):
            metres = abs(foothold.station - station)
            cost = metres * self._pace(edge, restrictions)
            # A place on a node is on all its roads.
            allowed = direction != against or metres <= SAME
            if allowed and (node not in reached or cost < reached[node][0]):
                reached[node] = cost, station
        return reached

    def _pace(self, edge: int, restrictions: Restrictions) -> float:
        """Return the cost of a metre of ``edge``."""
        return 1.0 / float(self.network.edges.speed[edge]) if restrictions.fastest else 1.0

    def _direct(self, begin: Foothold, end: Foothold) -> Stretches | None:
        """Return the way along one edge, if both are on it and its direction allows."""
        if begin.edge != end.edge:
            return None
        against = BACKWARD if end.station > begin.station + SAME else FORWARD
        near = abs(end.station - begin.station) <= SAME
        if not near and int(self.network.edges.direction[begin.edge]) == against:
            return None
        return np.array([begin.edge]), np.array([begin.station]), np.array([end.station])

    def _first_and_last(self, way: list[int], starts: Ends, goals: Ends) -> tuple[int, int]:
        if way:
            return int(self._graph.tail[way[0]]), int(self._graph.head[way[-1]])
        node = min(starts.keys() & goals.keys(), key=lambda one: starts[one][0] + goals[one][0])
        return node, node

    def _whole(self, way: list[int]) -> Stretches:
        arcs = np.array(way, dtype=np.int64)
        edge = self._edge[arcs]
        length = self.network.lengths[edge]
        # Arcs along the edges come before those against them.
        high = np.where(arcs < self._along, length, 0.0)
        return edge, length - high, high

    def _cost(self, stretches: Stretches, restrictions: Restrictions) -> float:
        edge, begin, end = stretches
        metres = np.abs(end - begin)
        return float((metres / self.network.edges.speed[edge] if restrictions.fastest else metres).sum())


def _without_nothing(edge: Ints, begin: Floats, end: Floats) -> Stretches:
    """Return the stretches of non-zero length; one if there is none."""
    some = np.flatnonzero(begin != end)
    some = some if len(some) else np.array([0])
    return edge[some], begin[some], end[some]


def _costs_only(ends: Ends) -> list[tuple[int, float]]:
    return [(node, cost) for node, (cost, _) in ends.items()]


def _arcs_of_edges(network: Network) -> Ints:
    """Return the arc along and the arc against each edge, (n, 2); -1 where there is none."""
    edge, _, _ = network.arcs()
    along = int((network.edges.direction != BACKWARD).sum())
    arcs = np.full((len(network), 2), -1, np.int64)
    arcs[edge[:along], 0] = np.arange(along)
    arcs[edge[along:], 1] = np.arange(along, len(edge))
    return arcs


def _text(place: Place) -> str:
    return f"({place[0]:.2f}, {place[1]:.2f})"
