"""The way that an operator wants to see."""

from __future__ import annotations

import asyncio

from ..errors import RefusedError
from ..messages import GetRoute, RouteReport
from ..roads.routes import Restrictions
from ..robots import Robots
from .road_planning import RoadPlanner, Wanted
from .ways import Ways


async def route(roads: RoadPlanner | None, robots: Robots, ways: Ways, request: GetRoute) -> RouteReport:
    """Return the way along the roads that an operator wants to see.

    :raises RefusedError: when there is none, or it is not known where it is to begin.
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
        return roads.route(start, (request.x, request.y), Wanted(restrictions, avoid, speed))

    return await asyncio.to_thread(found)
