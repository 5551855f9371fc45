"""Robots in keepouts and at obstacles: found by shape and clearance, once an entry, without flapping."""

from __future__ import annotations

import time

import numpy as np
import pytest

from robot_bridge.core.robotmap.model import ShapeType
from robot_bridge.core.robotmap.outlines import OutlineRow, Outlines
from robot_bridge.core.sites.fences import Fences
from robot_bridge.core.sites.geopackage import Area
from robot_bridge.core.sites.settings_tables import GeofenceSettings
from robot_bridge.gateway.model.fence_stays import LEFT_AFTER_S, Clearances, Stays, find_stays

RADIUS = 0.5


def ring(x_min, y_min, x_max, y_max):
    corners = (x_min, y_min), (x_max, y_min), (x_max, y_max), (x_min, y_max), (x_min, y_min)
    return np.array(corners, dtype=float)


def obstacle(points, semantics, shape=ShapeType.CLOSED_POLYGON, **how):
    return OutlineRow(
        np.array(points, dtype=float), shape, 3.0, semantics, how.pop("source", semantics), **how
    )


BASIN = Area((ring(0, 0, 10, 10), ring(4, 4, 6, 6)), "Water basin")
TOWER = obstacle(ring(20, 0, 24, 4), "building,Control tower")
SITE = Fences.of([BASIN], Outlines.from_rows([TOWER]))


class Site:
    """Judges one place of r1 after the other, a second apart where no time is given."""

    def __init__(self, settings=None, fences=SITE):
        self.settings = settings or GeofenceSettings()
        self.fences = fences
        self.stays = Stays()
        self.now = 1000.0

    def at(self, x, y, seconds=1.0):
        self.now += seconds
        clearances = Clearances.of(self.settings, RADIUS)
        found = find_stays(["r1"], np.array([(x, y)], dtype=float), self.fences, clearances)
        return self.stays.update(found, self.settings, self.now)

    def silent(self, seconds):
        self.now += seconds
        found = find_stays([], np.empty((0, 2)), self.fences, Clearances.of(self.settings, RADIUS))
        return self.stays.update(found, self.settings, self.now)

    @property
    def names(self):
        return sorted(stay.name for stay in self.stays)


def test_a_robot_in_a_keepout_is_told_with_its_name_place_and_time():
    site = Site(GeofenceSettings(in_keepout="pause"))
    assert site.at(-1.0, 2.0).entered == []
    (stay,) = site.at(2.0, 2.0).entered
    assert (stay.robot, stay.kind, stay.name) == ("r1", "keepout", "Water basin")
    assert (stay.since, stay.place, stay.action) == (1002.0, (2.0, 2.0), "pause")


def test_the_rim_of_a_keepout_and_its_hole_are_outside_as_for_paths():
    site = Site()
    for x, y in ((0.0, 5.0), (10.0, 10.0), (5.0, 5.0)):
        assert site.at(x, y).entered == []


def test_a_clearance_of_keepouts_counts_from_their_edge():
    site = Site(GeofenceSettings(keepout_clearance_m=1.0))
    assert site.at(-1.1, 5.0).entered == []
    assert len(site.at(-0.9, 5.0).entered) == 1


def test_an_obstacle_is_told_within_the_robots_radius_or_what_the_site_sets():
    assert Site().at(19.4, 2.0).entered == []
    (stay,) = Site(GeofenceSettings(at_obstacle="abort")).at(19.6, 2.0).entered
    assert (stay.kind, stay.name, stay.action) == ("obstacle", "Control tower", "abort")
    assert len(Site(GeofenceSettings(obstacle_clearance_m=1.0)).at(19.1, 2.0).entered) == 1
    assert Site(GeofenceSettings(obstacle_clearance_m=0.1)).at(19.6, 2.0).entered == []
    # In the middle of it no wall is near.
    assert len(Site(GeofenceSettings(obstacle_clearance_m=0.1)).at(22.0, 2.0).entered) == 1


def test_courtyards_ramps_and_what_is_overhead_are_free():
    yard = obstacle(ring(22, 1, 24, 3), "building,Hall", courtyard=True, source="hall")
    rows = [
        obstacle(ring(20, 0, 26, 4), "building,Hall", source="hall"),
        yard,
        obstacle(ring(40, 0, 44, 4), "ramp", ShapeType.RAMP),
        obstacle(ring(50, 0, 54, 4), "bridge", base=4.0),
        obstacle([(60, 0), (60, 4), (61, 0), (61, 4)], "stairs", ShapeType.STAIRS),
        obstacle([(70, 0), (70, 4)], "wall,North wall", ShapeType.OPEN_POLYGON),
    ]
    site = Site(fences=Fences.of([], Outlines.from_rows(rows)))
    for x, y in ((23.0, 2.0), (42.0, 2.0), (52.0, 2.0), (71.0, 2.0)):
        assert site.at(x, y).entered == []
    assert [stay.name for stay in site.at(60.5, 2.0).entered] == ["stairs"]
    assert [stay.name for stay in site.at(70.3, 2.0).entered] == ["North wall"]


def test_a_robot_that_trembles_at_the_edge_enters_once():
    site = Site(GeofenceSettings(in_keepout="abort"))
    changes = [site.at(x, 5.0, 0.25) for x in (-0.2, 0.2) * 40]
    assert sum(len(change.entered) for change in changes) == 1
    assert sum(len(change.ended) for change in changes) == 0


def test_a_stay_ends_when_the_robot_has_been_well_outside_for_a_while_also_if_it_says_nothing_more():
    site = Site()
    site.at(1.0, 5.0)
    assert site.at(-0.6, 5.0).ended == []
    assert site.at(-0.2, 5.0, 1.9).ended == []
    assert site.at(-0.6, 5.0).ended == []
    (stay,) = site.silent(LEFT_AFTER_S).ended
    assert (stay.name, site.names) == ("Water basin", [])
    assert len(site.at(1.0, 5.0).entered) == 1


def test_a_clock_that_was_set_back_keeps_no_alarm():
    site = Site()
    site.at(1.0, 5.0)
    site.at(-2.0, 5.0)
    assert len(site.silent(-3600.0).ended) == 1


def test_a_robot_that_is_driven_out_is_not_acted_upon_again():
    site = Site(GeofenceSettings(in_keepout="pause"))
    assert len(site.at(3.0, 2.0).entered) == 1
    for x in (2.5, 2.0, 1.0, 0.2, -0.4):
        assert site.at(x, 2.0, 10.0).entered == []


def test_a_robot_that_is_not_heard_stays_where_it_was():
    site = Site()
    site.at(3.0, 2.0)
    assert site.silent(3600.0).ended == []
    assert site.names == ["Water basin"]
    assert [stay.robot for stay in site.stays.forget(["r1"])] == ["r1"]
    assert site.names == []


def test_a_new_publication_goes_on_with_stays_of_the_same_name_and_ends_the_others():
    site = Site(GeofenceSettings(in_keepout="abort"))
    site.at(3.0, 2.0)
    moved = Area((ring(1, 1, 12, 12),), "Water basin")
    site.fences = Fences.of([Area((ring(50, 50, 60, 60),), "Other"), moved], Outlines.from_rows([]))
    site.stays.begin_publication()
    change = site.at(3.0, 2.0)
    assert (change.entered, change.ended, site.names) == ([], [], ["Water basin"])
    site.fences = Fences.of([Area((ring(0, 0, 10, 10),), "Excavation")], Outlines.from_rows([]))
    site.stays.begin_publication()
    change = site.at(3.0, 2.0)
    assert [stay.name for stay in change.entered] == ["Excavation"]
    assert [stay.name for stay in change.ended] == ["Water basin"]


def test_a_name_that_cannot_be_read_keeps_no_robot_from_being_acted_upon():
    places = np.array([(3.0, 2.0), (22.0, 2.0)])
    found = find_stays(["r1", "r2"], places, SITE, Clearances(0.0, RADIUS))

    class Unreadable:
        def name(self, area):
            raise ValueError("no text")

    stays, broken = Stays(), {**found.inside, max(found.inside): (Unreadable(), 0)}
    with pytest.raises(ValueError, match="no text"):
        stays.update(found._replace(inside=broken), GeofenceSettings(), 1000.0)
    assert [stay.robot for stay in stays.update(found, GeofenceSettings(), 1001.0).entered] == ["r1", "r2"]


def test_a_site_without_areas_finds_nobody():
    site = Site(fences=Fences.of([], Outlines.from_rows([])))
    assert site.at(3.0, 2.0).entered == []


def test_ten_thousand_robots_among_five_thousand_obstacles_are_judged_in_a_blink():
    generator = np.random.default_rng(7)
    rows = [
        obstacle(ring(x, y, x + 8, y + 8), "building") for x in range(0, 1400, 20) for y in range(0, 1400, 20)
    ]
    fences = Fences.of([], Outlines.from_rows(rows))
    names = [f"r{number}" for number in range(10_000)]
    places = generator.uniform(0, 1400, (10_000, 2))
    took = []
    for _ in range(3):
        began = time.thread_time()
        found = find_stays(names, places, fences, Clearances(0.0, RADIUS))
        Stays().update(found, GeofenceSettings(), 0.0)
        took.append(time.thread_time() - began)
    assert len(found.inside) == pytest.approx(2000, rel=0.1)
    assert min(took) < 0.5
