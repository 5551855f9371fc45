"""Road network of the published site, with its closures."""

from __future__ import annotations

import logging
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field, replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...core.errors import RefusedError
from ...core.roads.engines import EngineFactory, RouteGraph, safe_engines
from ...core.roads.map_matching import NearestEdge, edges_along, edges_of_closure
from ...core.roads.network import Floats, Ints, Network, build_network, flags
from ...core.roads.routes import REACH, Router
from ...core.roads.surface_index import NOWHERE, SurfaceIndex
from ...core.sites.geopackage import road_lines
from ...core.sites.site import Site
from .route_process import EngineReport, ProcessEngines

# --- Closed roads of a network at one moment; immutable, so that any thread may read them without waiting

Place = tuple[float, float]
"""x, y in metres, site frame."""


@dataclass(frozen=True)
class ClosedRoads:
    """``closures`` has the edges that each closure closes, ``closed`` flags all closed edges, (n,).

    ``nearest`` is None where the site has no roads.
    """

    nearest: NearestEdge | None = None
    closures: Mapping[str, frozenset[int]] = field(default_factory=dict)
    closed: NDArray[np.bool_] = field(default_factory=lambda: np.zeros(0, bool))

    def along(self, path: Sequence[Place], among: Collection[str] | None = None) -> list[str]:
        """Return the closures, of ``among`` or all, of roads that ``path`` leads along."""
        closures = {
            id: self.closures.get(id, frozenset()) for id in (self.closures if among is None else among)
        }
        shut = frozenset().union(*closures.values())
        if self.nearest is None or not shut or len(path) < 2:
            return []
        points = np.asarray(path, dtype=np.float64)
        found = set(edges_along(self.nearest, points, self._flags(shut)).tolist())
        return [id for id, edges in closures.items() if edges & found]

    def at(self, place: Place) -> str | None:
        """Return the closure of the road at ``place``, if no open road is there."""
        shut = frozenset().union(*self.closures.values())
        if self.nearest is None or not shut:
            return None
        width = self.nearest.network.edges.width
        reach = float(width[list(shut)].max()) / 2
        found = self.nearest.nearest(*place, reach, self._flags(shut))
        if found is None or found.away > width[found.edge] / 2:
            return None
        free = self.nearest.nearest(*place, float(width.max()) / 2, ~self.closed)
        if free is not None and free.away <= width[free.edge] / 2:
            return None
        return next(id for id, edges in self.closures.items() if found.edge in edges)

    def _flags(self, edges: Iterable[int]) -> NDArray[np.bool_]:
        assert self.nearest is not None
        return flags(len(self.nearest.network), np.array(sorted(edges), dtype=np.int64))


# --- The roads of one publication: its network, its router, and its closures ---

log = logging.getLogger(__name__)

_APART_M = 2.0
"""Metres between the sampled places of an edge."""
_MOST_PLACES = 50
"""Most sampled places of one edge."""


class RoadStretch(NamedTuple):
    """A stretch of road, (n, 2) metres in the site frame, on its level."""

    line: Floats
    level: int


@dataclass
class SiteRoads:
    """The roads of ``site``; ``router`` is None where it has none. Not to be used by two threads at once."""

    site: Site
    router: Router | None
    _always_closed: NDArray[np.bool_]
    _closures: dict[str, set[int]] = field(default_factory=dict)

    @classmethod
    def of(cls, site: Site, engines: Callable[[RouteGraph], EngineFactory] = safe_engines) -> SiteRoads:
        """Build the network of ``site`` and close the edges through its keepouts.

        ``engines`` find the ways: by default those that cannot crash this process.
        """
        if not site.centrelines:
            return cls(site, None, np.zeros(0, bool))
        network = build_network(road_lines(site.centrelines))
        if (network.edges.surface == "").any():
            network = _with_surfaces(network, site.surface_index)
        router = Router(network, engines)
        closed = site.keepout_index.edges_through(network)
        router.close(closed.tolist())
        log.info(
            "paths follow the roads of site %s: %d edges, %d of them closed by keepouts, found by %s",
            site.id,
            len(network),
            len(closed),
            router.engine_name,
        )
        return cls(site, router, router.closed)

    @property
    def engine_report(self) -> EngineReport | None:
        """The engine in use, None where there are no roads."""
        if self.router is None:
            return None
        engines = self.router.engines
        return (
            engines.report if isinstance(engines, ProcessEngines) else EngineReport(self.router.engine_name)
        )

    def close(self) -> None:
        """End the process that finds ways."""
        if self.router is not None and isinstance(self.router.engines, ProcessEngines):
            self.router.engines.close()

    def stretch(self, place: Place, reach: float) -> RoadStretch:
        """Return the road nearest to ``place``; raises RefusedError where none is within ``reach`` metres."""
        x, y = place
        found = None if self.router is None else self.router.nearest.nearest(x, y, reach)
        if found is None or self.router is None:
            raise RefusedError(
                f"no road of site {self.site.id} is within {reach:g} m of ({x:.2f}, {y:.2f}); "
                "choose a place on a road"
            )
        edges = self.router.network.edges
        return RoadStretch(edges.line(found.edge), int(edges.level[found.edge]))

    def is_near(self, x: float, y: float) -> bool:
        """Return whether (x, y) is near any road, usable or not."""
        return self.router is not None and self.router.nearest.nearest(x, y, REACH) is not None

    def set_closures(self, closures: Mapping[str, RoadStretch]) -> dict[str, int]:
        """Close these stretches and no others; return the number of edges that each closes."""
        if self.router is None:
            self._closures = {id: set() for id in closures}
            return self.edge_counts()
        before = self._all_closed()
        nearest = self.router.nearest
        self._closures = {
            id: known if (known := self._closures.get(id)) else set(edges_of_closure(nearest, *one).tolist())
            for id, one in closures.items()
        }
        after = self._all_closed()
        self._change(before - after, after - before)
        return self.edge_counts()

    def edge_counts(self) -> dict[str, int]:
        """Return the number of edges that each closure closes."""
        return {id: len(edges) for id, edges in self._closures.items()}

    @contextmanager
    def opened(self, closure: str) -> Iterator[None]:
        """Open the road of one closure within the context."""
        edges = self._closures.get(closure, set())
        elsewhere = {edge for id, some in self._closures.items() if id != closure for edge in some}
        alone = edges - elsewhere
        self._closures[closure] = set()
        self._change(alone, set())
        try:
            yield
        finally:
            self._closures[closure] = edges
            self._change(set(), alone)

    def edges_of(self, path: Sequence[Place]) -> list[int]:
        """Return the edges along which ``path`` leads."""
        if self.router is None or len(path) < 2:
            return []
        found: list[int] = edges_along(self.router.nearest, np.asarray(path, dtype=np.float64)).tolist()
        return found

    def closed_roads(self) -> ClosedRoads:
        """Return the closed roads now."""
        closures = {id: frozenset(edges) for id, edges in self._closures.items()}
        if self.router is None:
            return ClosedRoads(None, closures)
        return ClosedRoads(self.router.nearest, closures, self.router.closed)

    def check_open(self, *places: Place) -> None:
        """Raise RefusedError for the first of ``places`` that is on a closed road."""
        if not any(self._closures.values()):
            return
        closed = self.closed_roads()
        for x, y in places:
            if closed.at((x, y)) is not None:
                raise RefusedError(
                    f"({x:.2f}, {y:.2f}) is on a road that an operator closed; open the road, or choose "
                    "another place"
                )

    def _all_closed(self) -> set[int]:
        return {edge for edges in self._closures.values() for edge in edges}

    def _change(self, opened: set[int], closed: set[int]) -> None:
        if self.router is None:
            return
        if opened := {edge for edge in opened if not self._always_closed[edge]}:
            self.router.open(sorted(opened))
        if closed:
            self.router.close(sorted(closed))


def _with_surfaces(network: Network, index: SurfaceIndex) -> Network:
    """Return ``network`` with surfaces for edges that have none and lie on one by more than half.

    Roads have a surface attribute where it is known; published ones often have it only by their areas.
    """
    edges = network.edges
    unknown = np.flatnonzero(edges.surface == "")
    if not len(unknown) or not index.surfaces:
        return network
    surface = edges.surface.copy()
    for edge in unknown.tolist():
        found = index.at_many(_places_along(edges.line(edge), float(network.lengths[edge])))
        surface[edge] = _most_common(found, index)
    return replace(network, edges=replace(edges, surface=surface))


def _places_along(line: Floats, metres: float) -> Floats:
    """Return the midpoints of equal steps along ``line``, (k, 2)."""
    count = int(np.clip(np.ceil(metres / _APART_M), 1, _MOST_PLACES))
    stations = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(line, axis=0).T))])
    at = (np.arange(count) + 0.5) * (stations[-1] / count)
    return np.column_stack([np.interp(at, stations, line[:, k]) for k in (0, 1)])


def _most_common(found: Ints, index: SurfaceIndex) -> str:
    names = [index.surfaces[number].label for number in found.tolist() if number != NOWHERE]
    best = max(sorted(set(names)), key=names.count, default="")
    return best if 2 * names.count(best) > len(found) else ""
