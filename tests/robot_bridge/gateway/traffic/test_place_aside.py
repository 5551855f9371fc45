"""The place aside: the nearest one that is on the site and road, clear of areas, and off all ways."""

from __future__ import annotations

import math
import time

import numpy as np

from robot_bridge.core.roads.network import Surface
from robot_bridge.core.robotmap.model import ShapeType
from robot_bridge.core.robotmap.outlines import OutlineRow, Outlines
from robot_bridge.core.sites.frame import SiteBounds
from robot_bridge.core.sites.geopackage import Area
from robot_bridge.core.sites.settings import SiteSettings
from robot_bridge.core.sites.site import Site
from robot_bridge.gateway.traffic.conflicts import driving_movement, standing_movement
from robot_bridge.gateway.traffic.yielding import yield_beside_path

NOW, RADIUS, MARGIN = 1000.0, 0.5, 0.3
HERE = 50.0, 50.0


def ring(x_min, y_min, x_max, y_max):
    corners = (x_min, y_min), (x_max, y_min), (x_max, y_max), (x_min, y_max), (x_min, y_min)
    return np.array(corners, dtype=float)


def wall(*points):
    return OutlineRow(np.array(points, dtype=float), ShapeType.OPEN_POLYGON, 2.0, "wall", "walls:1")


def site(walls=(), keepouts=(), roads=(), bounds=(0.0, 0.0, 100.0, 100.0)):
    settings = SiteSettings("yard", "Yard", 1, "EPSG:32633", (0.0, 0.0), SiteBounds(*bounds))
    surfaces = tuple(Surface((road,), "asphalt") for road in roads)
    areas = tuple(Area((keepout,), "keepout") for keepout in keepouts)
    return Site(settings, Outlines.from_rows(list(walls)), (), surfaces, areas)


def passing(y=50.0, begins=0.0, robot="r1"):
    """Return a robot that comes along a line of this y from 40 m away, 1 m/s."""
    return driving_movement(robot, [(10.0, y), (90.0, y)], 1.0, NOW + begins, RADIUS)


def aside(here=HERE, others=None, **how):
    robot = standing_movement("r3", here, NOW, RADIUS)
    return yield_beside_path(robot, [passing()] if others is None else others, site(**how), 1.0, MARGIN, NOW)


def test_the_nearest_place_off_the_way_is_found():
    start, end = aside()
    assert start == HERE
    assert abs(end[1] - 50.0) >= 1.3 and math.dist(start, end) < 1.51


def test_it_is_on_a_road_surface_where_the_robot_stands_on_one():
    # A road 2 m wide with a lay-by 12 m on.
    roads = [ring(0, 49, 100, 51), ring(60, 50, 66, 54)]
    _, (x, y) = aside(roads=roads)
    assert 60 <= x <= 66 and 51 <= y <= 54
    # Beside every road it need not be on one.
    assert math.dist(HERE, aside(roads=[ring(0, 0, 1, 1)])[1]) < 1.6


def test_it_is_clear_of_keepouts_and_obstacles_by_the_robots_circle():
    south = ring(0, 0, 100, 48.4)
    _, (_, y) = aside(keepouts=[south])
    assert y > 51.2
    _, (_, y) = aside(walls=[wall((0, 51.7), (100, 51.7))])
    assert y < 48.8
    assert aside(keepouts=[south], walls=[wall((0, 51.7), (100, 51.7))]) is None


def test_the_way_there_leads_through_no_wall():
    # Behind the thin walls there is room, and none between them.
    walls = [wall((20, 51.2), (80, 51.2)), wall((20, 48.8), (80, 48.8))]
    assert aside(walls=walls) is None
    assert aside(walls=walls[:1]) is not None


def test_a_robot_at_a_wall_may_leave_it_but_not_through_it():
    _, (_, y) = aside(walls=[wall((0, 50.3), (100, 50.3))])
    assert y < 49


def test_a_robot_at_a_wall_stands_clear_of_it_afterwards():
    coming = driving_movement("r1", [(50.0, 10.0), (50.0, 48.9)], 1.0, NOW, RADIUS)
    _, (_, y) = aside(others=[coming], walls=[wall((0, 50.4), (100, 50.4))])
    assert y <= 50.4 - RADIUS


def test_it_is_on_the_site():
    _, (x, y) = aside(here=(50.0, 99.0), others=[passing(99.0)])
    assert y <= 99.0 - 1.3 and 0.5 <= x <= 99.5


def test_it_is_off_the_ways_of_robots_that_come_later_however_broad_they_are():
    others = [passing(42.0 + 1.2 * k, 100.0 + 10 * k, f"r{k + 10}") for k in range(14)]
    _, (_, y) = aside(others=[passing(begins=100.0), *others])
    assert y < 42.0 - 1.2 or y > 42.0 + 1.2 * 13 + 1.2


def test_who_is_there_before_it_can_set_out_leaves_no_way():
    assert aside(others=[driving_movement("r1", [(47.0, 50.0), (90.0, 50.0)], 1.0, NOW, RADIUS)]) is None


def test_where_everything_within_reach_is_taken_there_is_none():
    assert aside(keepouts=[ring(0, 0, 100, 49.4), ring(0, 50.6, 100, 100)]) is None


def test_a_fleet_of_a_thousand_takes_a_moment():
    generator = np.random.default_rng(3)
    places = generator.uniform(0, 100, (1000, 2))
    others = [standing_movement(f"r{k}", (x, y), NOW, 0.1) for k, (x, y) in enumerate(places.tolist())]
    began = time.thread_time()
    aside(others=[passing(), *(other for other in others if math.dist(other.points[0], HERE) > 3)])
    assert time.thread_time() - began < 2.0
