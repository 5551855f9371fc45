"""Paths of a plan's robots: straight or by road, around standing cones and robots."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence

import numpy as np
from qgis.core import (
    QgsCoordinateReferenceSystem,
    QgsExpressionContext,
    QgsExpressionContextUtils,
    QgsFeedback,
    QgsProject,
)

from ...robot_bridge.core.assignment.detours import ClearTravel, Floats, NearOrByRoad
from ...robot_bridge.core.assignment.job import (
    AssignmentJob,
    CancellableTravel,
    RoadTravel,
    StraightTravel,
    Travel,
)
from ...robot_bridge.core.errors import AssignmentCancelledError
from ...robot_bridge.core.messages import ClosureReport
from ...robot_bridge.core.roads.map_matching import edges_of_closure
from ...robot_bridge.core.roads.network import build_network
from ...robot_bridge.core.roads.routes import Router
from ...robot_bridge.core.sites.frame import SiteFrame
from ...robot_bridge.core.sites.geopackage import road_lines
from ..layers.crs import stated_crs
from ..layers.layer_source import obstacle_sources
from ..layers.road_layers import DEFAULT_WIDTH_M, edges_through, read_areas, read_centrelines
from ..layers.roles import KEEPOUT, ROAD_CENTRELINE, LayerExpressions, layers_with_role
from ..layers.site_transform import SiteGeoreference
from ..ui.language import tr
from .plan_settings import PlanSettings

# --- How the robots of a plan get from place to place: straight nearby, along the roads farther off ---


class PlanTravel:
    """The ground of one plan; made in the window's thread, used by one task after the other.

    ``cones`` (n, 2) are those of before, beside the plan's own; ``standing`` is where robots stand that do
    not drive by it. ``closures`` are the roads that are closed at the gateway. All hold for the next plan
    that is made.
    """

    def __init__(self, project: QgsProject, frame: SiteFrame, settings: PlanSettings) -> None:
        self.settings = settings
        self.cones: Floats = np.empty((0, 2))
        self.standing: Mapping[str, tuple[float, float]] = {}
        self.closures: Sequence[ClosureReport] = ()
        self._router: Router | None = None
        self._shut: set[int] = set()
        self._read = not settings.on_roads
        crs = stated_crs(QgsCoordinateReferenceSystem(frame.crs))
        self._site = SiteGeoreference(crs, frame, project.transformContext())
        context = QgsExpressionContext(QgsExpressionContextUtils.globalProjectLayerScopes(None))

        def sources(role: str):
            layers = layers_with_role(project, role) if settings.on_roads else []
            return obstacle_sources(layers, LayerExpressions(), context)

        self._roads, self._keepouts = sources(ROAD_CENTRELINE), sources(KEEPOUT)

    def travel_of(self, job: AssignmentJob, goes_on: Callable[[], bool]) -> Travel:
        """Return the ways between the places of ``job``, clear of its cones and of what stands.

        :raises CancelledError: here and by the ways once ``goes_on()`` says no; RoadsError when a place is
            too far from every road; LayerReadingError for a layer of roads that cannot be read.
        """
        router = self._opened(goes_on)
        travel: Travel = StraightTravel(job)
        if router is not None:
            roads = RoadTravel(job, router, progress=lambda share: _ask(goes_on))
            nearby = self.settings.direct_m
            name = tr("{name}, straight within {nearby:g} m", name=roads.name, nearby=nearby)
            travel = NearOrByRoad(travel, roads, nearby, name)
        cones = np.concatenate([job.places[job.first_target :], self.cones])
        robots = np.array(list(self.standing.values()), dtype=float).reshape(-1, 2)
        clear = ClearTravel(
            travel,
            job.places,
            np.concatenate([cones, robots]),
            np.repeat([self.settings.clearance_m, self.settings.off_standing_m], [len(cones), len(robots)]),
        )
        return CancellableTravel(clear, goes_on)

    def _opened(self, goes_on: Callable[[], bool]) -> Router | None:
        if not self._read:
            self._router = self._network(goes_on)
            # Only now: who is cancelled or fails here has no roads, and must not go on without them.
            self._read = True
        if self._router is not None:
            self._close(self._router)
        return self._router

    def _close(self, router: Router) -> None:
        """Close what is closed at the gateway, and open what is not any more."""
        lines = [(np.array(one.line, dtype=float), one.level) for one in self.closures]
        wanted = {edge for line in lines for edge in edges_of_closure(router.nearest, *line).tolist()}
        always = set(np.flatnonzero(router.closed).tolist()) - self._shut
        router.open(sorted(self._shut - wanted))
        router.close(sorted(wanted - self._shut - always))
        self._shut = wanted - always

    def _network(self, goes_on: Callable[[], bool]) -> Router | None:
        feedback = _Asking(goes_on)
        roads = read_centrelines(self._roads, self._site, DEFAULT_WIDTH_M, feedback).items
        _ask(goes_on)
        if not roads:
            return None
        network = build_network(road_lines(roads), lambda: _ask(goes_on))
        _ask(goes_on)
        router = Router(network)
        areas = read_areas(self._keepouts, self._site, KEEPOUT, feedback).items
        _ask(goes_on)
        router.close(edges_through(network, [area.rings for area in areas]))
        return router


def _ask(goes_on: Callable[[], bool]) -> None:
    if not goes_on():
        raise AssignmentCancelledError(tr("The assignment was cancelled."))


class _Asking(QgsFeedback):
    """Asks another whether it is cancelled, for what reads layers until its feedback says so."""

    def __init__(self, goes_on: Callable[[], bool]) -> None:
        super().__init__()
        self._goes_on = goes_on

    def isCanceled(self) -> bool:
        return not self._goes_on()
