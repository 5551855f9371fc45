"""GPS positions and compass headings land where PROJ, asked another way, says they are."""

from __future__ import annotations

import math

import pyproj
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from robot_bridge.core.errors import CrsError
from robot_bridge.core.sites.frame import GpsTransform, SiteBounds, SiteFrame, is_near, lonlat_of

metres = st.floats(-5_000, 5_000)
angles = st.floats(-math.pi, math.pi)
headings = st.floats(0, 360)
PLACES = {
    "EPSG:32633": (640_420.0, 5_193_480.0),
    "EPSG:25831": (425_900.0, 4_582_100.0),
    "EPSG:31468": (4_468_000.0, 5_333_000.0),
    "EPSG:2154": (652_000.0, 6_862_000.0),
    "EPSG:32719": (346_000.0, 6_297_000.0),
}
FRAMES = st.builds(
    lambda crs, rotation: SiteFrame(crs, PLACES[crs], rotation), st.sampled_from(sorted(PLACES)), angles
)
few = settings(max_examples=40, deadline=None)


def turn(a, b):
    return abs(math.remainder(a - b, math.tau))


@few
@given(FRAMES, metres, metres)
def test_a_place_goes_to_the_earth_and_comes_back_within_a_millimetre(frame, x, y):
    ((lon, lat),) = lonlat_of(frame)([(x, y)])
    assert GpsTransform(frame).place(lat, lon) == pytest.approx((x, y), abs=1e-3)


@few
@given(FRAMES, metres, metres, headings)
def test_a_heading_is_turned_by_the_convergence_of_meridians_and_the_sites_rotation(frame, x, y, heading):
    ((lon, lat),) = lonlat_of(frame)([(x, y)])
    convergence = pyproj.Proj(frame.crs).get_factors(lon, lat).meridian_convergence
    expected = math.radians(90 - heading + convergence) - frame.rotation
    assert turn(GpsTransform(frame).theta(lat, lon, heading), expected) < 1e-4


def test_the_convergence_matters_away_from_the_middle_of_a_zone():
    # 3 degrees east of the middle meridian, at latitude 48: tan⁻¹(tan 3° · sin 48°) = 2.23°.
    theta = GpsTransform(SiteFrame("EPSG:32633", (0.0, 0.0))).theta(48.0, 18.0, 90.0)
    assert math.degrees(theta) == pytest.approx(2.23, abs=0.01)


def test_a_known_place_is_where_the_survey_says():
    # The middle meridian of zone 33 is 15° E, whose false easting is 500 000 m.
    x, y = GpsTransform(SiteFrame("EPSG:32633", (500_000.0, 0.0))).place(0.0, 15.0)
    assert (x, y) == pytest.approx((0.0, 0.0), abs=1e-6)


@pytest.mark.parametrize(("lat", "lon"), [(0.0, 105.0), (math.inf, 15.0)])
def test_a_position_that_has_no_place_in_the_crs_is_named(lat, lon):
    with pytest.raises(CrsError, match=r"has no place in the site's CRS EPSG:32633; check the order"):
        GpsTransform(SiteFrame("EPSG:32633", (0.0, 0.0))).place(lat, lon)


def test_a_crs_of_nowhere_is_named():
    local = 'LOCAL_CS["hall",UNIT["metre",1],AXIS["x",EAST],AXIS["y",NORTH]]'
    with pytest.raises(CrsError, match=r"has no known place on the earth"):
        GpsTransform(SiteFrame(local, (0.0, 0.0))).place(50.0, 15.0)


BOUNDS = SiteBounds(0.0, 0.0, 100.0, 80.0)


@pytest.mark.parametrize("crs", PLACES)
@pytest.mark.parametrize(("x", "y"), [(50.0, 50.0), (-2_000.0, 50.0), (50.0, 9_000.0)])
def test_swapped_coordinates_are_seen_on_and_beside_the_site(crs, x, y):
    earth = GpsTransform(SiteFrame(crs, PLACES[crs]))
    ((lon, lat),) = lonlat_of(SiteFrame(crs, PLACES[crs]))([(x, y)]).tolist()
    assert earth.looks_swapped(lon, lat, BOUNDS)
    assert not earth.looks_swapped(lat, lon, BOUNDS)


@pytest.mark.parametrize(
    ("lat", "lon"), [(48.1, 11.6), (0.0, 0.0), (-33.4, -70.6), (10.0, 120.0), (89.0, -170.0)]
)
def test_what_lies_nowhere_near_the_site_either_way_round_is_not_taken_for_swapped(lat, lon):
    earth = GpsTransform(SiteFrame("EPSG:32633", PLACES["EPSG:32633"]))
    assert not earth.looks_swapped(lat, lon, BOUNDS)


@pytest.mark.parametrize(
    ("place", "near"),
    [
        ((50.0, 50.0), True),
        ((10_099.0, 0.0), True),
        ((10_101.0, 0.0), False),
        ((0.0, 10_081.0), False),
        ((-9_999.0, -9_999.0), True),
        ((-10_001.0, 0.0), False),
        ((0.0, -10_001.0), False),
    ],
)
def test_near_is_on_the_site_and_ten_kilometres_beside_it(place, near):
    assert is_near(place, BOUNDS) is near
