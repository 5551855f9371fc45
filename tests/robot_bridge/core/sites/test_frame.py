"""The site frame against arithmetic done by hand, and the CRSs it refuses."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from robot_bridge.core.errors import CrsError, SiteError
from robot_bridge.core.sites.frame import SiteFrame, check_site_crs

METRES = st.floats(-1e4, 1e4)
FRAMES = st.builds(
    lambda x, y, rotation: SiteFrame("EPSG:32633", (x, y), rotation),
    st.floats(1e5, 9e5),
    st.floats(0, 9e6),
    st.floats(-7, 7),
)


@given(FRAMES, st.lists(st.tuples(METRES, METRES), max_size=5))
def test_a_point_comes_back_from_the_crs(frame, points):
    xy = np.array(points, dtype=float).reshape(-1, 2)
    assert np.allclose(frame.to_site(frame.to_crs(xy)), xy, atol=1e-7)


@given(FRAMES, st.tuples(METRES, METRES), st.tuples(METRES, METRES))
def test_lengths_are_the_same_in_both_frames(frame, a, b):
    ends = frame.to_crs([a, b])
    assert math.isclose(math.dist(*ends), math.dist(a, b), abs_tol=1e-6)


def test_the_x_axis_is_turned_counter_clockwise_by_the_rotation():
    frame = SiteFrame("EPSG:32633", (640000.0, 5193000.0), math.pi / 2)
    assert np.allclose(frame.to_crs([[10.0, 0.0]]), [[640000.0, 5193010.0]])
    assert np.allclose(frame.to_site([[639980.0, 5193000.0]]), [[0.0, 20.0]])


@given(st.lists(st.tuples(METRES, METRES), min_size=1, max_size=5))
def test_a_frame_that_is_not_turned_adds_its_origin_and_leaves_what_it_is_given(points):
    xy = np.array(points)
    frame = SiteFrame("EPSG:32633", (640000.0, 5193000.0))
    there = frame.to_crs(xy)
    assert there.tolist() == [[640000.0 + x, 5193000.0 + y] for x, y in points]
    assert frame.to_site(there).tolist() == [[x - 640000.0, y - 5193000.0] for x, y in there.tolist()]
    assert xy.tolist() == [list(point) for point in points]


def test_headings_turn_with_the_frame_and_stay_within_one_turn():
    frame = SiteFrame("EPSG:32633", (0.0, 0.0), math.radians(30))
    assert math.isclose(frame.theta_to_crs(math.radians(170)), math.radians(-160))
    assert math.isclose(frame.theta_to_site(math.radians(-160)), math.radians(170))


@pytest.mark.parametrize("crs", ["EPSG:32633", "EPSG:25831", "EPSG:3035", "EPSG:23700"])
def test_projected_metres_carry_a_site(crs):
    check_site_crs(crs)


@pytest.mark.parametrize(
    ("crs", "says"),
    [
        ("EPSG:3857", "its metres are not metres; 1 m on the ground is 1.56 m"),
        ("EPSG:3395", "its metres are not metres"),
        ("EPSG:4326", "its coordinates are not metres on a plane"),
        ("EPSG:4978", "its coordinates are not metres on a plane"),
        ("EPSG:2263", "its unit is US survey foot, and robots speak metres"),
        ("EPSG:999999", "not known to PROJ"),
        ("the moon", "not known to PROJ"),
    ],
)
def test_a_crs_that_cannot_carry_a_site_is_refused_with_its_reason(crs, says):
    with pytest.raises(CrsError) as caught:
        check_site_crs(crs)
    assert crs in str(caught.value)
    assert says in str(caught.value)
    assert "EPSG:32" in str(caught.value), "it says which CRS to choose instead"
    assert isinstance(caught.value, SiteError)
