"""Keepout and speed masks, as Nav2's costmap filters use them."""

from __future__ import annotations

import math

import numpy as np
import pytest
import yaml

from robot_bridge.core.errors import MaskAreaError
from robot_bridge.core.robotmap.exporters.nav2 import (
    MaskArea,
    RasterGrid,
    filter_parameters,
    keepout_mask,
    scale_files,
    speed_mask,
    trinary_files,
)

GRID = RasterGrid(100.0, 50.0, 0.1, 200, 100)


def rectangle(x_min, y_min, x_max, y_max):
    return np.array([(x_min, y_min), (x_max, y_min), (x_max, y_max), (x_min, y_max), (x_min, y_min)])


def area(*corners, name="area", **given):
    return MaskArea([rectangle(*corners)], name, **given)


def limit(made, read, x, y):
    """Return the limit at a place, m/s, as SpeedFilter computes it; None without one."""
    value = read.at(x, y)
    assert value >= 0, "SpeedFilter refuses unknown cells"
    return None if value == 0 else value * made.multiplier


@pytest.mark.parametrize("backwards", [False, True])
def test_a_keepout_is_lethal_its_hole_and_the_rest_are_free(read_written, backwards):
    rings = [rectangle(102, 51, 106, 55), rectangle(103, 52, 105, 54)]
    rings = [ring[::-1] for ring in rings] if backwards else rings
    made = read_written(trinary_files("keepout", GRID, keepout_mask(GRID, [MaskArea(rings, "lab")])))
    assert made.at(102.5, 53) == made.at(105.5, 51.5) == 100
    assert made.at(104, 53) == made.at(108, 53) == made.at(101, 51) == 0
    assert set(np.unique(made.cells)) == {0, 100}


def test_a_keepout_that_is_thinner_than_a_cell_is_not_lost():
    made = keepout_mask(GRID, [area(103.01, 52.01, 103.03, 54.0)])
    assert (made == 100).sum() == 21


def test_overlapping_keepouts_are_kept_out_of_where_they_overlap(read_written):
    cells = keepout_mask(GRID, [area(102, 51, 106, 55), area(104, 53, 108, 57)])
    assert read_written(trinary_files("keepout", GRID, cells)).at(105, 54) == 100


def test_limits_are_read_back_as_they_were_asked(read_written):
    made = speed_mask(GRID, [area(101, 51, 104, 59, speed=1.4), area(106, 51, 110, 59, speed=8.3)])
    read = read_written(scale_files("speed", GRID, made.cells))
    assert read.mode == "scale"
    assert limit(made, read, 102, 55) == pytest.approx(1.4)
    assert limit(made, read, 108, 55) == pytest.approx(8.3)
    assert limit(made, read, 105, 55) is None


def test_the_lower_limit_holds_where_areas_overlap_whichever_comes_first(read_written):
    areas = [area(101, 51, 110, 59, speed=5.0), area(103, 53, 106, 57, speed=1.0)]
    for order in (areas, areas[::-1]):
        made = speed_mask(GRID, order)
        read = read_written(scale_files("speed", GRID, made.cells))
        assert limit(made, read, 104, 55) == pytest.approx(1.0)
        assert limit(made, read, 102, 55) == pytest.approx(5.0)


@pytest.mark.parametrize("speed", [0.013, 0.5, 0.999, 1.0, 1.01, 2.7, 8.33, 13.9, 33.3, 99.99])
def test_a_limit_is_never_higher_than_asked_and_at_most_a_step_lower(read_written, speed):
    made = speed_mask(GRID, [area(101, 51, 104, 59, speed=speed)])
    found = limit(made, read_written(scale_files("speed", GRID, made.cells)), 102, 55)
    assert speed - made.multiplier < found <= speed * (1 + 1e-9)


def test_every_value_of_a_mask_survives_the_image(read_written):
    cells = np.arange(101, dtype=np.int8).reshape(1, -1)
    assert (read_written(scale_files("m", RasterGrid(0, 0, 1.0, 101, 1), cells)).cells == cells).all()


@pytest.mark.parametrize("speed", [0.0, -1.0, math.nan, math.inf])
def test_a_speed_that_is_none_is_refused_by_name(speed):
    with pytest.raises(MaskAreaError, match=f"ring road: its speed is {speed:g} m/s; give one above 0"):
        speed_mask(GRID, [area(101, 51, 104, 59, name="ring road", speed=speed)])


def test_a_speed_that_the_mask_cannot_tell_from_none_is_refused_by_name():
    areas = [area(101, 51, 104, 59, name="dock", speed=0.04), area(105, 51, 106, 59, speed=10.0)]
    with pytest.raises(
        MaskAreaError, match=r"dock: 0\.04 m/s cannot be told from 0 .* give at least 0\.1 m/s"
    ):
        speed_mask(GRID, areas)
    with pytest.raises(MaskAreaError, match="5000 m/s is above 1000 m/s"):
        speed_mask(GRID, [area(101, 51, 104, 59, speed=5000.0)])


@pytest.mark.parametrize("ring", [[(0, 0), (1, 1)], [(0, 0), (1, 0), (math.nan, 1)]])
def test_an_area_that_is_no_polygon_is_refused_by_name(ring):
    with pytest.raises(MaskAreaError, match="lab: ring 1 is no polygon"):
        keepout_mask(GRID, [MaskArea([np.array(ring)], "lab")])


def test_no_area_is_no_limit():
    assert not keepout_mask(GRID, []).any()
    assert not speed_mask(GRID, []).cells.any()


def test_the_parameters_for_nav2_say_how_to_read_the_mask():
    made = yaml.safe_load(filter_parameters(2, "speed", 0.1))
    assert made["speed_filter_info_server"]["ros__parameters"] == {
        "type": 2,
        "filter_info_topic": "speed_filter_info",
        "mask_topic": "speed_filter_mask",
        "base": 0.0,
        "multiplier": 0.1,
    }
