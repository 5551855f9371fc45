"""What a site has in a box beside its obstacles: keepouts, and roads with their widths and speeds."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from ..messages.links import MOST_AREA_POINTS, SiteArea, SiteAreas, SiteRoad
from .errors import SiteError
from .frame import Points
from .site import Site


def areas_in_box(site: Site, box: tuple[float, float, float, float]) -> SiteAreas:
    """Return the keepouts and roads that may touch ``box``: x_min, y_min, x_max, y_max, site frame.

    Closed roads and those on bridges and in tunnels are left out: a robot on the ground drives by others.

    :raises SiteError: where they have more points than one answer holds.
    """
    keepouts = [
        SiteArea(area.label, [_places(ring) for ring in area.rings])
        for area in site.keepouts
        if _touches(area.rings[0], box, 0.0)
    ]
    roads = [
        SiteRoad(_places(line.points), line.width_m, line.speed_ms)
        for line in site.centrelines
        if not line.closed and line.level == 0 and _touches(line.points, box, line.width_m / 2)
    ]
    count = sum(map(len, _lines(keepouts, roads)))
    if count > MOST_AREA_POINTS:
        raise SiteError(f"keepouts and roads have {count} points there, and {MOST_AREA_POINTS} are the most")
    return SiteAreas(site.version, keepouts, roads)


def _lines(keepouts: list[SiteArea], roads: list[SiteRoad]) -> Iterable[list[tuple[float, float]]]:
    for area in keepouts:
        yield from area.rings
    for road in roads:
        yield road.points


def _touches(points: Points, box: tuple[float, float, float, float], beside: float) -> bool:
    x_min, y_min, x_max, y_max = box
    low, high = points.min(axis=0) - beside, points.max(axis=0) + beside
    return bool(low[0] <= x_max and high[0] >= x_min and low[1] <= y_max and high[1] >= y_min)


def _places(points: Points) -> list[tuple[float, float]]:
    return [(x, y) for x, y in np.round(points, 3).tolist()]
