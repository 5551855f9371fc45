"""Paths of a plan's robots: straight or by road, around standing cones and robots."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence

import numpy as np
import numpy.typing as npt
from qgis.core import (
    QgsCoordinateReferenceSystem,
    QgsExpressionContext,
    QgsExpressionContextUtils,
    QgsFeedback,
    QgsProject,
)

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

# --- Ways that keep clear of what stands in the open: cones, and robots that do not move ---

Floats = npt.NDArray[np.float64]
_ROUND = 8
"""Points of a whole circle round an obstacle."""
_MOST_DETOURS = 50
"""Obstacles that one way is led round; a way with more in it is no way."""


class ClearTravel:
    """The ways of ``inner``, led round ``obstacles``, (n, 2) in the site frame, each by its metres of
    ``clearances``, (n,).

    ``places`` (m, 2) are those that ``inner`` numbers. Distances stay those of ``inner``: a detour round a
    cone is shorter than what a distance is known by.
    """

    def __init__(self, inner: Travel, places: Floats, obstacles: Floats, clearances: Floats) -> None:
        self._inner, self._places, self._clearances = inner, places, clearances
        self._obstacles = obstacles
        self.name, self.metres = inner.name, inner.metres

    def path(self, start: int, goal: int) -> Floats:
        """Return the points from place to place."""
        points = self._inner.path(start, goal)
        return detour(points, self._obstacles, self._clearances)


def detour(points: Floats, obstacles: Floats, clearances: Floats) -> Floats:
    """Return the way ``points``, (n, 2), led round all ``obstacles``, (m, 2), by ``clearances``, (m,) metres.

    Obstacles that the way begins or ends at are passed over: the robot stands there, or is to. Where others
    leave no room the way is returned as far as it could be led.
    """
    if len(points) < 2 or len(obstacles) == 0:
        return points
    ends = points[[0, -1]]
    away = np.hypot(*(obstacles[:, None, :] - ends[None, :, :]).transpose(2, 0, 1)).min(axis=1)
    in_the_way = (away > clearances) & (clearances > 0)
    standing, room = obstacles[in_the_way], clearances[in_the_way]
    for _ in range(_MOST_DETOURS):
        found = _first_met(points, standing, room)
        if found is None:
            return points
        points = _round_one(points, standing, found, room)
    return points


def obstacle_distances(points: Floats, obstacles: Floats) -> Floats:
    """Return how near the way ``points`` comes to each obstacle, (m,) metres."""
    start, step = points[:-1], np.diff(points, axis=0)
    length = np.maximum((step**2).sum(axis=1), 1e-18)
    part = ((obstacles[:, None, :] - start[None]) * step[None]).sum(axis=2) / length
    nearest = start[None] + np.clip(part, 0.0, 1.0)[:, :, None] * step[None]
    return np.hypot(*(nearest - obstacles[:, None, :]).transpose(2, 0, 1)).min(axis=1)


def _first_met(points: Floats, standing: Floats, room: Floats) -> int | None:
    if len(standing) == 0:
        return None
    near = np.flatnonzero(obstacle_distances(points, standing) < room - 1e-6)
    if len(near) == 0:
        return None
    stations = [_entry(points, standing[k], room[k])[0] for k in near]
    return int(near[int(np.argmin(stations))])


def _round_one(points: Floats, standing: Floats, which: int, room: Floats) -> Floats:
    """Return the way led round one obstacle, on a side that is clear of the others, else the shorter."""
    centre = standing[which]
    # Chords of the circle's arc stay outside of it when the arc is a little wider.
    radius = room[which] / math.cos(math.pi / _ROUND) * 1.02
    first, entry = _entry(points, centre, radius)
    last, leave = _leave(points, centre, radius)
    begin, end = (math.atan2(*(at - centre)[::-1]) for at in (entry, leave))
    others, their_room = np.delete(standing, which, axis=0), np.delete(room, which)
    ways = []
    for turn in (1.0, -1.0):
        span = (turn * (end - begin)) % math.tau
        count = max(math.ceil(span / (math.tau / _ROUND)), 1)
        angles = begin + turn * span * np.arange(count + 1) / count
        arc = centre + radius * np.column_stack([np.cos(angles), np.sin(angles)])
        blocked = len(others) > 0 and bool((obstacle_distances(arc, others) < their_room - 1e-6).any())
        ways.append((blocked, span, arc))
    arc = min(ways, key=lambda way: way[:2])[2]
    return np.concatenate([points[: first + 1], arc, points[last + 1 :]])


def _entry(points: Floats, centre: Floats, radius: float) -> tuple[int, Floats]:
    """Return the leg on which the way comes within ``radius`` first, and where."""
    for k in range(len(points) - 1):
        shares = _crossings(points[k], points[k + 1], centre, radius)
        if shares is not None:
            share = max(shares[0], 0.0)
            return k, points[k] + share * (points[k + 1] - points[k])
    return len(points) - 2, points[-1]


def _leave(points: Floats, centre: Floats, radius: float) -> tuple[int, Floats]:
    first, entry = _entry(points[::-1], centre, radius)
    return len(points) - 2 - first, entry


def _crossings(a: Floats, b: Floats, centre: Floats, radius: float) -> tuple[float, float] | None:
    """Return the shares of the leg from ``a`` to ``b`` at which it enters and leaves the circle."""
    d, f = b - a, a - centre
    square = float(d @ d)
    if square < 1e-18:
        return None
    half = float(f @ d) / square
    rest = half**2 - (float(f @ f) - radius**2) / square
    if rest < 0:
        return None
    root = math.sqrt(rest)
    enters, leaves = -half - root, -half + root
    return (enters, leaves) if leaves >= 0.0 and enters <= 1.0 else None


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
            travel = _NearOrByRoad(job, travel, roads, self.settings.direct_m)
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


class _NearOrByRoad:
    """Straight up to ``nearby`` metres, by road farther off."""

    def __init__(self, job: AssignmentJob, straight: Travel, roads: Travel, nearby: float) -> None:
        self._straight, self._roads = straight, roads
        self._near = straight.metres <= nearby
        self.metres: Floats = np.where(self._near, straight.metres, roads.metres)
        self.name = tr("{name}, straight within {nearby:g} m", name=roads.name, nearby=nearby)

    def path(self, start: int, goal: int) -> Floats:
        """Return the points from place to place."""
        return (self._straight if self._near[start][goal] else self._roads).path(start, goal)
