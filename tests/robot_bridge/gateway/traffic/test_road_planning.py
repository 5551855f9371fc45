"""The gateway's paths follow the roads of the site, and say where they do not."""

from __future__ import annotations

import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import shapely

from robot_bridge.core.errors import RefusedError
from robot_bridge.core.roads.network import Surface
from robot_bridge.core.roads.path_smoothing import Driving
from robot_bridge.core.robotmap.model import ShapeType
from robot_bridge.core.robotmap.outlines import OutlineRow, Outlines
from robot_bridge.core.sites.geopackage import Area, Centreline
from robot_bridge.core.sites.site import Site, read_site
from robot_bridge.gateway.traffic.road_planning import RoadPlanner, RouteOptions


class Served:
    """A site, of which another may be published meanwhile."""

    def __init__(self, find):
        self._find = find

    @property
    def site(self):
        return self._find()


@pytest.fixture(scope="module")
def sample() -> Site:
    return read_site(Path(__file__).parents[4] / "resources" / "sample_site")


@pytest.fixture(scope="module")
def planner(sample):
    return RoadPlanner(Served(lambda: sample))


def surface_of(site: Site):
    return shapely.union_all([shapely.Polygon(area.rings[0], area.rings[1:]) for area in site.surfaces])


def with_roads(site: Site, *lines, keepouts=()) -> Site:
    roads = tuple(Centreline(np.array(line, float), 6.0, "asphalt") for line in lines)
    areas = tuple(Area((np.array(ring, float),), "keepout") for ring in keepouts)
    return replace(site, centrelines=roads, keepouts=areas)


def test_random_pairs_on_the_road_are_joined_on_the_road(sample, planner):
    random = np.random.default_rng(8)
    road = surface_of(sample)
    tried = 0
    while tried < 50:
        start, goal = random.uniform((0, 0), (200, 140), (2, 2))
        if not (road.contains(shapely.Point(start)) and road.contains(shapely.Point(goal))):
            continue
        tried += 1
        planned = planner.path(tuple(start), tuple(goal))
        assert planned.note == ""
        assert planned.points[0] == tuple(start)
        assert planned.points[-1] == tuple(goal)
        line = shapely.LineString(planned.points)
        assert shapely.difference(line, road.buffer(0.01)).length <= 0.02 * line.length


def test_off_the_roads_the_path_is_straight_and_says_so(planner):
    planned = planner.path((20.0, 8.0), (500.0, 8.0))
    assert planned.points == [(20.0, 8.0), (500.0, 8.0)]
    assert planned.note.startswith("the path is a straight line and not along roads: The goal (500.00, 8.00)")


def test_the_last_metres_to_a_place_are_straight_and_lead_round_no_block(sample):
    block = [(0, 0), (50, 0), (50, 2), (0, 2)]
    roads = with_roads(sample, block[:2], block[1:3], block[2:])
    planned = RoadPlanner(Served(lambda: roads)).path((1.0, 0.0), (1.0, 2.0))
    assert planned.points == [(1.0, 0.0), (1.0, 2.0)] and planned.note.endswith("the place is 2.0 m away")
    assert len(RoadPlanner(Served(lambda: roads)).path((1.0, 0.0), (5.0, 2.0)).points) > 50
    basin = [(0.0, 0.5), (3.0, 0.5), (3.0, 1.5), (0.0, 1.5), (0.0, 0.5)]
    fenced = with_roads(sample, block[:2], block[1:3], block[2:], keepouts=[basin])
    assert len(RoadPlanner(Served(lambda: fenced)).path((1.0, 0.0), (1.0, 2.0)).points) > 50


@pytest.mark.parametrize(
    ("line", "is_straight"),
    [
        pytest.param([(0.5, 1.0), (1.5, 1.0)], False, id="across"),
        pytest.param([(1.1, 1.0), (1.9, 1.0)], False, id="too near for the robot's width"),
        pytest.param([(1.3, 1.0), (1.9, 1.0)], True, id="beside the way"),
        pytest.param([(0.8, 0.1), (0.8, -1.0)], True, id="at the robot, beside the way"),
        pytest.param([(0.5, 0.2), (1.5, 0.2)], False, id="at the robot, across"),
        pytest.param([(1.0, 2.0), (1.0, 3.0)], True, id="at the goal"),
    ],
)
def test_nor_do_they_lead_through_an_obstacle(sample, line, is_straight):
    block = [(0, 0), (50, 0), (50, 2), (0, 2)]
    roads = with_roads(sample, block[:2], block[1:3], block[2:])
    wall = OutlineRow(np.array(line, float), ShapeType.OPEN_POLYGON, 2.0, "wall", "walls:1")
    walled = replace(roads, outlines=Outlines.from_rows([wall]))
    planned = RoadPlanner(Served(lambda: walled)).path((1.0, 0.0), (1.0, 2.0))
    assert (len(planned.points) == 2) is is_straight


def test_a_site_without_roads_has_straight_paths_and_no_note(sample):
    planner = RoadPlanner(Served(lambda: with_roads(sample)))
    assert planner.path((0.0, 0.0), (5.0, 5.0)) == ([(0.0, 0.0), (5.0, 5.0)], "", False)


def test_keepouts_are_driven_round_and_where_no_way_is_left_the_question_is_refused(sample):
    loop = [(0, 0), (50, 0), (50, 50), (0, 50), (0, 0)]
    sides = [loop[k : k + 2] for k in range(4)]
    south, north = ([(20, y - 2), (30, y - 2), (30, y + 2), (20, y + 2), (20, y - 2)] for y in (0, 50))
    there = (0.0, 0.0), (50.0, 0.0)
    free = RoadPlanner(Served(lambda: with_roads(sample, *sides))).path(*there)
    assert max(y for _, y in free.points) < 0.01
    around = RoadPlanner(Served(lambda: with_roads(sample, *sides, keepouts=[south]))).path(*there)
    assert max(y for _, y in around.points) == pytest.approx(50.0)
    with pytest.raises(RefusedError, match="GetPath: No way leads"):
        RoadPlanner(Served(lambda: with_roads(sample, *sides, keepouts=[south, north]))).path(*there)


BASIN = [(20.0, -5.0), (30.0, -5.0), (30.0, 5.0), (20.0, 5.0), (20.0, -5.0)]


@pytest.mark.parametrize("roads", [[], [[(0.0, 200.0), (50.0, 200.0)]]])
def test_a_straight_line_through_a_keepout_is_refused_with_its_name(sample, roads):
    planner = RoadPlanner(Served(lambda: with_roads(sample, *roads, keepouts=[BASIN])))
    says = r"^GetPath: the way to \(50\.00, 0\.00\) leads through the keepout 'keepout'"
    with pytest.raises(RefusedError, match=says):
        planner.path((0.0, 0.0), (50.0, 0.0))
    assert planner.path((0.0, 5.0), (50.0, 5.0)).points == [(0.0, 5.0), (50.0, 5.0)]


def test_the_way_from_a_road_to_a_place_beside_it_keeps_out_too(sample):
    planner = RoadPlanner(Served(lambda: with_roads(sample, [(0.0, -10.0), (50.0, -10.0)], keepouts=[BASIN])))
    with pytest.raises(RefusedError, match="leads through the keepout"):
        planner.path((0.0, -10.0), (25.0, 6.0))


@pytest.mark.parametrize("ends", [((25.0, 0.0), (50.0, 0.0)), ((0.0, 0.0), (25.0, 0.0))])
def test_who_is_in_a_keepout_is_led_out_of_it_and_who_was_sent_there_in(sample, ends):
    planner = RoadPlanner(Served(lambda: with_roads(sample, keepouts=[BASIN])))
    assert planner.path(*ends).points == list(ends)


def test_a_new_publication_is_planned_on_at_once(sample):
    sites = [with_roads(sample, [(0, 0), (50, 0)])]
    planner = RoadPlanner(Served(lambda: sites[-1]))
    assert max(y for _, y in planner.path((0.0, 0.0), (50.0, 0.0)).points) == 0.0
    sites.append(with_roads(sample, [(0, 0), (25, 25), (50, 0)]))
    assert max(y for _, y in planner.path((0.0, 0.0), (50.0, 0.0)).points) > 20.0


def test_who_stands_beside_the_middle_of_a_road_joins_it_aslant(sample):
    site = with_roads(sample, [(0, 0), (50, 0)])
    points = np.array(
        RoadPlanner(Served(lambda: site), Driving(turning_radius=0.0)).path((10.0, 2.0), (40.0, -2.0)).points
    )
    assert np.diff(points[:, 0]).min() > 0
    assert np.abs(points[:, 1]).max() == 2.0
    assert points[np.argmin(np.abs(points[:, 0] - 12.0)), 1] == pytest.approx(0.0, abs=0.3)


@pytest.mark.parametrize(
    ("setting", "shown", "seconds"),
    [(1.0, 0.0, 100.0), (2.0, 0.0, 50.0), (1.0, 4.0, 25.0), (50.0, 0.0, 100.0 / 13.9)],
)
def test_seconds_are_the_robots_and_not_the_roads(sample, setting, shown, seconds):
    road = Centreline(np.array([(0, 0), (100, 0)], float), 6.0, "asphalt", speed_ms=13.9)
    routes = replace(sample.settings.routes, speed_ms=setting)
    site = replace(sample, centrelines=(road,), keepouts=(), settings=replace(sample.settings, routes=routes))
    report = RoadPlanner(Served(lambda: site)).route((0.0, 0.0), (100.0, 0.0), RouteOptions(speed=shown))
    assert report.metres == pytest.approx(100.0)
    assert report.seconds == pytest.approx(seconds, abs=0.1)
    straight = RoadPlanner(Served(lambda: replace(site, centrelines=()))).route((0.0, 0.0), (100.0, 0.0))
    assert straight.seconds == pytest.approx(100.0 / setting, abs=0.1)


@pytest.mark.parametrize(
    ("start", "goal", "metres"), [((0.0, 15.0), (100.0, 0.0), 115.0), ((0.0, 15.0), (5.0, -15.0), 35.0)]
)
def test_the_way_to_the_road_and_from_it_takes_time_as_well(sample, start, goal, metres):
    road = Centreline(np.array([(0, 0), (100, 0)], float), 6.0, "asphalt", speed_ms=13.9)
    site = replace(sample, centrelines=(road,), keepouts=())
    report = RoadPlanner(Served(lambda: site)).route(start, goal)
    speed = site.settings.routes.speed_ms
    # Corners are rounded, which is a little shorter.
    assert metres - 5.0 < report.metres <= metres
    assert report.seconds == pytest.approx(report.metres / speed, abs=3.0)


def test_a_road_without_a_surface_has_that_of_the_area_that_it_lies_on(sample):
    yard = Surface((np.array([(-5, -5), (60, -5), (60, 5), (-5, 5)], float),), "asphalt")
    roads = [
        Centreline(np.array(line, float), 6.0, surface)
        for line, surface in (
            ([(0, 0), (50, 0)], ""),
            ([(50, 0), (100, 0)], ""),
            ([(100, 0), (130, 0)], "gravel"),
        )
    ]
    site = replace(sample, centrelines=tuple(roads), keepouts=(), surfaces=(yard,))
    report = RoadPlanner(Served(lambda: site)).route((0.0, 0.0), (130.0, 0.0))
    assert [(one.surface, round(one.metres)) for one in report.surfaces] == [
        ("asphalt", 50),
        ("", 50),
        ("gravel", 30),
    ]


@pytest.mark.parametrize("aside", [0.01, 0.08, 0.3, 1.0, 2.0])
def test_a_place_beside_the_middle_of_a_straight_road_is_no_tight_corner(sample, aside):
    site = with_roads(sample, [(0, 0), (50, 0)])
    report = RoadPlanner(Served(lambda: site), Driving(turning_radius=3.0)).route(
        (10.0, aside), (40.0, -aside)
    )
    assert report.tight == []
    assert report.points[0] == (10.0, aside)
    assert report.points[-1] == (40.0, -aside)


def test_directions_closures_and_bridges_of_the_published_roads_are_honoured(sample):
    square = [(0, 0), (50, 0), (50, 50), (0, 50), (0, 0)]

    def highest(**south) -> float:
        sides = [
            Centreline(np.array(square[k : k + 2], float), 6.0, "asphalt", **(south if k == 0 else {}))
            for k in range(4)
        ]
        site = replace(sample, centrelines=tuple(sides), keepouts=())
        return max(y for _, y in RoadPlanner(Served(lambda: site)).path((0.0, 0.0), (50.0, 0.0)).points)

    assert highest() == pytest.approx(0.0)
    assert highest(direction=1) == pytest.approx(0.0)
    assert highest(direction=-1) == pytest.approx(50.0)
    assert highest(closed=True) == pytest.approx(50.0)
    over = [(25.0, -10.0), (25.0, 10.0)]
    crossing = [
        Centreline(np.array([(0, 0), (50, 0)], float), 6.0, ""),
        Centreline(np.array(over), 6.0, "", level=1),
    ]
    site = replace(sample, centrelines=tuple(crossing), keepouts=())
    with pytest.raises(RefusedError, match="No way leads"):
        RoadPlanner(Served(lambda: site)).path((0.0, 0.0), (25.0, 10.0))


# --- what is wrong is refused with what to do, and no program's error ------------------------------------


@pytest.fixture
def broken(sample):
    """The sample site with a road whose width is none."""
    road = Centreline(np.array([[0.0, 0.0], [50.0, 0.0]]), float("nan"), "asphalt")
    return replace(sample, centrelines=(road,), keepouts=())


WRONG = r"the roads of the site cannot be used: The width of road 0 is nan: .* publish the site again"


def test_a_planner_of_roads_that_are_wrong_says_which_and_what_to_do(broken):
    with pytest.raises(RefusedError, match=WRONG):
        RoadPlanner(Served(lambda: broken))


def test_a_publication_whose_roads_are_wrong_is_refused_and_the_one_before_is_gone_on_with(sample, broken):
    published = [sample]
    planner = RoadPlanner(Served(lambda: published[-1]))
    published.append(broken)
    for ask in (
        lambda: planner.path((20.0, 8.0), (60.0, 20.0)),
        lambda: planner.route((20.0, 8.0), (60.0, 20.0)),
        planner.renew,
    ):
        with pytest.raises(RefusedError, match=WRONG):
            ask()
    published.pop()
    assert len(planner.path((20.0, 8.0), (60.0, 20.0)).points) > 2


def test_a_missing_package_is_named_with_how_to_install_it(sample, monkeypatch):
    monkeypatch.setitem(sys.modules, "shapely", None)
    keepout = ((0.0, 0.0), (5.0, 0.0), (5.0, 5.0), (0.0, 0.0))
    with pytest.raises(RefusedError, match=r"lacks Python package shapely; .* pip install 'fleet-supervisor"):
        RoadPlanner(Served(lambda: with_roads(sample, ((0, 0), (50, 0)), keepouts=(keepout,))))
