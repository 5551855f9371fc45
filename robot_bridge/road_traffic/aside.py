"""The nearest free place that a standing robot can go to, off the ways of all others; no I/O."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from ..planning import Floats, Point
from ..roads.surfaces.index import NOWHERE
from ..sites.fences import TOUCH_M, FencedAreas
from ..sites.site import Site
from ..traffic.conflicts import Surroundings
from ..traffic.movement import Movement, driving

REACH = 25.0
"""Metres from where the robot stands within which a place is looked for."""
STEP = 0.5
"""Metres between the circles on which places are tried."""
DIRECTIONS = 32
"""Places on each circle."""
MOST_TRIED = 400
"""Places that are held against the others' movements, one after the other."""
SETS_OUT_AFTER = 3.0
"""Seconds until the robot sets out: an operator looks at the way before sending it."""

Bools = NDArray[np.bool_]


def way_aside(
    robot: Movement, others: Sequence[Movement], site: Site, speed: float, margin: float, now: float
) -> list[Point] | None:
    """Return the straight way to the nearest place where ``robot``, which stands, is in nobody's way.

    ``others`` move as planned; ``speed`` is metres a second, ``margin`` metres between two robots. The place
    lies on the site, on a road surface where the robot stands on one, and the robot's circle touches neither
    a keepout nor an obstacle there, nor on the way but for those that it is at already. None where none is.
    """
    start: Point = (float(robot.points[0, 0]), float(robot.points[0, 1]))
    places = _on_site(_around(start), site, robot.radius)
    places = places[_is_on_surface(places, start, site)]
    for areas in (site.fences.keepouts, site.fences.obstacles):
        places = places[_is_clear(places, start, areas, robot.radius)]
    places = places[_is_off_ways(places, others, robot.radius + margin)]
    around = Surroundings(others, margin, now)
    for x, y in places[:MOST_TRIED].tolist():
        moving = driving(robot.robot, [start, (x, y)], speed, now, robot.radius)
        if not around.conflicts(moving.waiting(0.0, SETS_OUT_AFTER)):
            return [start, (round(x, 3), round(y, 3))]
    return None


def _around(start: Point) -> Floats:
    """Return the places to try, (n, 2), the nearest first."""
    radii = np.arange(1, round(REACH / STEP) + 1) * STEP
    turns = np.arange(DIRECTIONS) * 2 * math.pi / DIRECTIONS
    unit = np.column_stack([np.cos(turns), np.sin(turns)])
    offsets: Floats = (radii[:, None, None] * unit).reshape(-1, 2)
    places: Floats = offsets + np.array(start)
    return places


def _on_site(places: Floats, site: Site, radius: float) -> Floats:
    x_min, y_min, x_max, y_max = site.bounds
    low, high = np.array([x_min, y_min]) + radius, np.array([x_max, y_max]) - radius
    inside: Floats = places[((places >= low) & (places <= high)).all(axis=1)]
    return inside


def _is_on_surface(places: Floats, start: Point, site: Site) -> Bools:
    """Tell which places are on a road surface; all where the robot itself stands on none."""
    index = site.surface_index
    if index.at(*start) == NOWHERE:
        return np.ones(len(places), dtype=bool)
    on: Bools = index.at_many(places) != NOWHERE
    return on


def _is_clear(places: Floats, start: Point, areas: FencedAreas, radius: float) -> Bools:
    """Tell which places, and the legs to them, are clear of areas; a robot may leave those that it is at."""
    clear = np.ones(len(places), dtype=bool)
    clear[areas.near(places, radius)[0]] = False
    for metres in (radius, TOUCH_M):
        here = areas.near(np.array([start]), metres)[1]
        leg, area = areas.near_legs(start, places, metres)
        clear[leg[~np.isin(area, here)]] = False
    return clear


def _is_off_ways(places: Floats, others: Sequence[Movement], clearance: float) -> Bools:
    """Tell which places are off the ways of others, whenever they drive them, and of where they stand."""
    off = np.ones(len(places), dtype=bool)
    for other in others:
        low, high = other.points.min(axis=0) - REACH, other.points.max(axis=0) + REACH
        if ((places >= low) & (places <= high)).all(axis=1).any():
            off &= _metres_to(other.points, places) >= clearance + other.radius
    return off


def _metres_to(line: Floats, places: Floats) -> Floats:
    """Return how far each of ``places`` is from a line through points, or from its only point."""
    nearest: Floats = np.hypot(*(places - line[0]).T)
    begin, step = line[:-1], np.diff(line, axis=0)
    square = np.maximum((step * step).sum(axis=1), 1e-12)
    # Leg by leg: all at once a long way would take as much memory as points times places.
    for origin, along, length in zip(begin, step, square, strict=True):
        share = np.clip(((places - origin) @ along) / length, 0.0, 1.0)
        foot = origin + share[:, None] * along
        nearest = np.minimum(nearest, np.hypot(*(places - foot).T))
    return nearest
