"""The robot maps that a site gives out, on the sample site."""

import numpy as np
import pytest

from robot_bridge.core.errors import WindowError
from robot_bridge.core.robotmap.model import ShapeType
from robot_bridge.core.robotmap.text_format import write_text
from robot_bridge.core.sites.site import read_site


@pytest.fixture(scope="module")
def site(root):
    return read_site(root / "resources" / "sample_site")


def kinds(robot_map):
    return {obstacle.semantics.partition(",")[0] for obstacle in robot_map.obstacles}


def test_the_whole_map_is_the_bounds_with_every_obstacle(site):
    whole = site.whole_map()
    assert tuple(whole.border) == tuple(site.bounds) == (0.0, 0.0, 200.0, 160.0)
    assert len(whole.obstacles) == len(site.outlines)
    assert kinds(whole) == {"building", "wall", "column", "litter bin", "bench", "stairs", "ramp"}
    assert whole.warnings == ()


def test_every_map_says_where_it_belongs(site):
    expected = {
        "version": "1",
        "crs": "EPSG:32633",
        "origin": "640420.000,5193480.000",
        "rotation": "0.000000000",
        "id": "sample",
    }
    assert site.whole_map().meta == expected
    assert site.map_around(100.0, 80.0, 1000.0**2).meta == expected
    part = {**expected, "part_of": "0.00,0.00,200.00,160.00"}
    assert site.map_around(100.0, 80.0, 400.0).meta == part
    assert "EPSG:32633" in write_text(site.whole_map()).partition("border;")[0]


def test_get_map_is_a_square_of_the_area_around_the_robot(site):
    border = site.map_around(150.0, 119.5, 10000.0).border
    assert tuple(border) == (100.0, 69.5, 200.0, 169.5)


def test_the_walls_of_the_courtyard_have_their_free_space_inside(site):
    court = site.map_around(150.0, 119.5, 400.0)
    middle = np.array([150.0, 119.5])
    (walls,) = [obstacle for obstacle in court.obstacles if obstacle.semantics == "building,Hall A"]
    assert walls.shape_type is ShapeType.CLOSED_POLYGON
    along, inwards = walls.b - walls.a, middle - walls.a
    assert np.all(along[:, 0] * inwards[:, 1] - along[:, 1] * inwards[:, 0] < 0)


def test_a_window_on_the_meadow_is_empty_and_still_a_map(site):
    assert site.map_around(20.0, 55.0, 25.0).obstacles == ()


def test_stairs_are_risers_of_15_cm_that_end_flat(site):
    (stairs,) = [o for o in site.whole_map().obstacles if o.shape_type is ShapeType.STAIRS]
    assert len(stairs.height) == 8
    assert np.allclose(stairs.height[:-1], 0.15)
    assert stairs.height[-1] == 0.0


def test_get_map_says_which_way_the_ramp_faces(site):
    text = write_text(site.map_around(178.0, 40.0, 400.0))
    # It climbs 1.05 m in 12.6 m towards the west.
    assert ";ramp,Terrace ramp;src=ramp:1,n=0.083,0,0.9965;" in text


@pytest.mark.parametrize(("x", "y"), [(-104.9, 80.0), (304.9, 80.0), (100.0, -104.9), (100.0, 264.9)])
def test_around_the_site_it_is_known_what_stands_there(site, x, y):
    assert site.map_around(x, y, 100.0).warnings == ()


@pytest.mark.parametrize(
    ("x", "y"), [(-105.1, 80.0), (305.1, 80.0), (100.0, -105.1), (100.0, 265.1), (1e6, 80.0)]
)
def test_far_from_the_site_no_map_says_that_all_is_free(site, x, y):
    with pytest.raises(WindowError, match=r"no part of 100 m² around .* what stands there is not known"):
        site.map_around(x, y, 100.0)


@pytest.mark.parametrize("area", [0.0, -4.0, float("nan"), float("inf")])
def test_an_area_that_is_none_is_refused(site, area):
    with pytest.raises(WindowError):
        site.map_around(10.0, 10.0, area)


@pytest.mark.parametrize(
    ("x", "y", "inside"),
    [(0, 0, True), (200, 160, True), (100, 80, True), (-0.01, 80, False), (100, 160.01, False)],
)
def test_the_edge_of_the_bounds_belongs_to_the_site(site, x, y, inside):
    assert site.contains(x, y) is inside


def test_a_target_that_is_not_a_number_is_not_on_the_site(site):
    assert not site.contains(float("nan"), 10.0)
