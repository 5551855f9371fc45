"""Path planning along the roads of the published site."""

from __future__ import annotations

import asyncio
import math
import threading
from collections.abc import Collection, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import replace
from typing import NamedTuple, Protocol

import numpy as np

from ...core.errors import NoRouteError, OffNetworkError, RefusedError, RoadsError
from ...core.messages.roads import GetRoute, RouteReport, SurfaceMetres
from ...core.roads.network import Floats
from ...core.roads.path_smoothing import DensePath, Driving, dense_path
from ...core.roads.routes import Restrictions, Route, Router, with_ends
from ...core.sites.site import Site
from ..model.arrival import PlannedPath, Point
from ..model.robots import Robots
from .robot_paths import RobotPaths
from .route_process import EngineReport, ProcessEngines
from .site_roads import ClosedRoads, RoadStretch, SiteRoads

# --- Paths along the roads of the published site ---


class RouteOptions(NamedTuple):
    """Requirements of a route besides open roads: :class:`.Restrictions`, and paths with roads to avoid.

    ``speed`` is the robot's in m/s; the site's setting counts where it is greater.
    """

    restrictions: Restrictions = Restrictions()
    avoid: Sequence[Sequence[Point]] = ()
    speed: float = 0.0


ANY = Restrictions()
BESIDE_M = 3.0
"""Metres to a goal that are driven straight: a robot is off the end of a path by 2 m at most."""


class NoOpenRouteError(RefusedError):
    """There are roads, but no permitted route along them."""


class PublishedSite(Protocol):
    """Source of the served site, which may change."""

    @property
    def site(self) -> Site:
        """The site as published last."""


class RoadPlanner:
    """Finds the shortest way along the centrelines of the site that is ``served``, around its keepouts.

    The network is built here, and again when the site changes. Roads closed by operators stay closed on it,
    and those narrower than robots are never used. Safe to use from several threads; :attr:`closed` is read
    without waiting for another thread.
    """

    def __init__(self, served: PublishedSite, driving: Driving | None = None) -> None:
        self._served = served
        self._driving = driving
        self._using = threading.Lock()
        self._building = threading.Lock()
        self._closures: dict[str, RoadStretch] = {}
        with refuse_road_errors():
            self._roads = SiteRoads.of(served.site, ProcessEngines)
        self._closed = self._roads.closed_roads()

    @property
    def has_roads(self) -> bool:
        """Whether the site has any roads."""
        return self._roads.router is not None

    @property
    def engine_report(self) -> EngineReport | None:
        """The engine in use, None where the site has no roads."""
        return self._roads.engine_report

    def close(self) -> None:
        """End the process that finds ways; ways are still found, more slowly."""
        with self._building:
            self._roads.close()

    def path(self, start: Point, goal: Point) -> PlannedPath:
        """Return the path, a straight line with a note where the site has no roads near both places.

        :raises RefusedError: when roads are near and no way leads along them, a place is on a closed one, or
            a straight part leads through a keepout.
        """
        try:
            with self._in_use() as roads:
                site, found = roads.site, self._found(roads, start, goal)
        except NoOpenRouteError as error:
            raise RefusedError(f"GetPath: {error}") from error
        planned = self._planned(found, start, goal)
        _check_keepouts(site, planned)
        return planned

    def path_with_open(self, closure: str, start: Point, goal: Point) -> PlannedPath | None:
        """Return the path as if the road of ``closure`` were open; None without a way."""
        with self._in_use() as roads, roads.opened(closure):
            try:
                found = self._found(roads, start, goal)
            except RefusedError:
                return None
        return self._planned(found, start, goal)

    def route(self, start: Point, goal: Point, options: RouteOptions | None = None) -> RouteReport:
        """Return the route as a report for operators.

        :raises RefusedError: as :meth:`path`; and at once while a new publication's roads are being read.
        """
        options = options or RouteOptions()
        with self._in_use(patient=False) as roads:
            avoid = {edge for path in options.avoid for edge in roads.edges_of(path)}
            try:
                found = self._found(roads, start, goal, options.restrictions, avoid)
            except NoOpenRouteError as error:
                more = " Roads on which other robots' tasks lead were left out." if avoid else ""
                raise RefusedError(f"{error}{more}") from error
        speed = max(options.speed, self._served.site.settings.routes.speed_ms)
        if isinstance(found, str):
            why = f" and not along roads: {found}" if found else "; the site has no roads"
            return _straight(start, goal, speed, f"the way is a straight line{why}")
        # Long routes take long to make dense; other threads need not wait for the roads meanwhile.
        return self._reported(found, start, goal, speed)

    def stretch(self, place: Point, reach: float) -> RoadStretch:
        """Return the road nearest to ``place``, from junction to junction.

        :raises RefusedError: when none is within ``reach`` metres.
        """
        with self._in_use() as roads:
            return roads.stretch(place, reach)

    def set_closures(self, closures: Mapping[str, RoadStretch]) -> dict[str, int]:
        """Close the stretches of ``closures`` and no others; return the number of edges that each closes."""
        with self._in_use() as roads:
            self._closures = dict(closures)
            counts = roads.set_closures(self._closures)
            self._closed = roads.closed_roads()
            return counts

    @property
    def closed(self) -> ClosedRoads:
        """The roads closed now; a new object after every change."""
        return self._closed

    def router_of_its_own(self) -> Router | None:
        """Return a router on the roads that are open now, for a single thread; None without roads.

        Queries of it for seconds block no other thread. Raises RefusedError.
        """
        with self._in_use() as roads:
            return None if roads.router is None else roads.router.copy()

    def renew(self) -> dict[str, int]:
        """Adopt the roads of a new publication; return the number of edges that each closure closes there."""
        self._adopt_publication(patient=True)
        with self._using:
            return self._roads.edge_counts()

    @contextmanager
    def _in_use(self, *, patient: bool = True) -> Iterator[SiteRoads]:
        self._adopt_publication(patient=patient)
        with self._using, refuse_road_errors():
            yield self._roads

    def _adopt_publication(self, *, patient: bool) -> None:
        """Build the roads of a new publication, while the former ones stay in use."""
        if self._roads.site is self._served.site:
            return
        if not self._building.acquire(blocking=patient):
            raise RefusedError("the roads of a new publication are being read; try again in a moment")
        try:
            site = self._served.site
            if self._roads.site is not site:
                with refuse_road_errors():
                    roads = SiteRoads.of(site, ProcessEngines)
                with self._using:
                    roads.set_closures(self._closures)
                    before, self._roads, self._closed = self._roads, roads, roads.closed_roads()
                before.close()
        finally:
            self._building.release()

    def _found(
        self,
        roads: SiteRoads,
        start: Point,
        goal: Point,
        options: Restrictions = ANY,
        avoid: Collection[int] = (),
    ) -> Route | str:
        """Return the way along the roads, or the reason why there is none, empty for a site without roads."""
        if roads.router is None:
            return ""
        roads.check_open(start, goal)
        robot_width = self._how().robot_width
        if _is_beside(roads.site, start, goal, robot_width / 2):
            return f"the place is {math.dist(start, goal):.1f} m away"
        width = max(options.least_width, robot_width)
        try:
            return roads.router.route(start, goal, replace(options, least_width=width), avoid=avoid)
        except OffNetworkError as error:
            if not all(roads.is_near(*place) for place in (start, goal)):
                return str(error)
            raise NoOpenRouteError(str(error)) from error
        except NoRouteError as error:
            raise NoOpenRouteError(str(error)) from error

    def _planned(self, found: Route | str, start: Point, goal: Point) -> PlannedPath:
        if isinstance(found, str):
            note = f"the path is a straight line and not along roads: {found}" if found else ""
            return PlannedPath([start, goal], note)
        return PlannedPath(_rounded(self._dense(found, start, goal).points, start, goal), along_roads=True)

    def _reported(self, route: Route, start: Point, goal: Point, speed: float) -> RouteReport:
        dense = self._dense(route, start, goal)
        driven = float(np.hypot(*np.diff(dense.points, axis=0).T).sum())
        # Before the first road and after the last one no road limits a robot's speed.
        seconds = route.seconds_at(speed) + max(0.0, driven - route.metres) / speed
        metres: dict[str, float] = {}
        for surface, length in zip(route.surfaces, route.lengths.tolist(), strict=True):
            metres[surface] = metres.get(surface, 0.0) + length
        return RouteReport(
            points=_rounded(dense.points, start, goal),
            metres=round(driven, 2),
            seconds=round(seconds, 1),
            surfaces=[SurfaceMetres(surface, round(length, 2)) for surface, length in metres.items()],
            tight=[(round(x, 2), round(y, 2)) for x, y in dense.tight.tolist()],
            off_goal=round(route.off_goal, 2),
            engine=route.engine,
        )

    def _dense(self, route: Route, start: Point, goal: Point) -> DensePath:
        how = self._how()
        points, widths = with_ends(route, start, goal, how.turning_radius)
        return dense_path(points, widths, how)

    def _how(self) -> Driving:
        if self._driving is not None:
            return self._driving
        how = self._served.site.settings.routes
        return Driving(how.spacing_m, how.turning_radius_m, how.robot_width_m)


def check_roads(site: Site) -> None:
    """Raise RefusedError when the roads of ``site`` cannot be used for routing."""
    with refuse_road_errors():
        SiteRoads.of(site)


@contextmanager
def refuse_road_errors() -> Iterator[None]:
    """Raise RefusedError for errors in roads, or in the routing on them."""
    try:
        yield
    except RoadsError as error:
        raise RefusedError(
            f"the roads of the site cannot be used: {error} Correct the road layers, and publish the site "
            "again"
        ) from error
    except ImportError as error:
        raise RefusedError(
            f"no ways can be found: the gateway lacks Python package {error.name or error}; install it there "
            "with: pip install 'fleet-supervisor-robot-bridge[routes]'"
        ) from error


def _is_beside(site: Site, start: Point, goal: Point, clearance: float) -> bool:
    """Return whether a robot at ``start`` is so near to ``goal`` that roads would only be a detour.

    This is so at the end of the path of a cone's task: cones stand around it, and the path kept clear of
    them. Neither a keepout nor, within ``clearance`` metres, an obstacle of the site is in between.
    """
    if math.dist(start, goal) > BESIDE_M or site.keepout_between([start, goal]) is not None:
        return False
    return not site.fences.obstacles.are_between(start, goal, clearance)


def _check_keepouts(site: Site, planned: PlannedPath) -> None:
    """Raise RefusedError for a keepout between the ends: roads lead around them, straight lines do not."""
    keepout = site.keepout_between(planned.points)
    if keepout is not None:
        x, y = planned.points[-1]
        why = f": {planned.note}" if planned.note else ""
        raise RefusedError(
            f"GetPath: the way to ({x:.2f}, {y:.2f}) leads through the keepout {keepout!r}{why}"
        )


def _straight(start: Point, goal: Point, speed: float, note: str) -> RouteReport:
    metres = float(np.hypot(goal[0] - start[0], goal[1] - start[1]))
    return RouteReport([start, goal], round(metres, 2), round(metres / speed, 1), note=note)


def _rounded(points: Floats, start: Point, goal: Point) -> list[Point]:
    return [start, *map(tuple, points[1:-1].round(3).tolist()), goal]


# --- Route requested by an operator ---


async def route_for_operator(
    roads: RoadPlanner | None, robots: Robots, ways: RobotPaths, request: GetRoute
) -> RouteReport:
    """Return the route along the roads that an operator requests.

    :raises RefusedError: when there is none, or its start is unknown.
    """
    if roads is None:
        raise RefusedError("this gateway plans without roads; publish a site with road centrelines")
    start, speed = request.start, 0.0
    if request.robot is not None:
        if request.robot not in robots:
            raise RefusedError(f"get_route: robot {request.robot!r} is not known to this gateway")
        pose = robots.get(request.robot).pose
        if pose is None:
            raise RefusedError(f"get_route: robot {request.robot!r} has not said yet where it is")
        start, speed = (pose.x, pose.y), abs(pose.v)
    assert start is not None
    surfaces = None if request.surfaces is None else frozenset(request.surfaces)
    restrictions = Restrictions(request.fastest, surfaces, request.least_width)
    underway = ways.all() if request.avoid_reserved else []

    def found() -> RouteReport:
        others = [one.way() for one in underway if one.robot != request.robot]
        avoid = [way.points for way in others if way.known]
        return roads.route(start, (request.x, request.y), RouteOptions(restrictions, avoid, speed))

    return await asyncio.to_thread(found)
