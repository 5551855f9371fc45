"""Nav2's maps are read by the rules of its map server; what cannot be is named."""

from __future__ import annotations

import math

import numpy as np
import pytest

from robot_bridge.core.errors import NavigationMapError
from robot_bridge.core.robotmap.exporters.nav2 import RasterGrid, scale_files, trinary_files
from robot_bridge.core.robotmap.nav2_reader import LARGEST_MAP, cells_of, check_size, read_yaml

YAML = "image: a.pgm\nresolution: 0.05\norigin: [1.0, 2.0, 0.0]\nnegate: 0\nfree_thresh: 0.196\n"


def cells(more, *pixels, alpha=None):
    bands = [[pixels], [alpha]] if alpha else [[pixels]]
    described = read_yaml(YAML + more)
    return cells_of(np.array(bands, dtype=np.uint8), described, alpha=bool(alpha))[0].tolist()


def test_a_dark_pixel_is_occupied_a_light_one_free_and_what_is_between_unknown():
    assert cells("occupied_thresh: 0.65\n", 0, 89, 90, 205, 206, 254, 255) == [100, 100, -1, -1, 0, 0, 0]


def test_negate_turns_it_round():
    negated = YAML.replace("negate: 0", "negate: 1")
    pixels = np.array([[[0, 255]]], dtype=np.uint8)
    assert cells_of(pixels, read_yaml(negated)).tolist() == [[0, 100]]


def test_scale_is_a_value_between_the_thresholds():
    more = "mode: scale\noccupied_thresh: 1.0\n"
    whole = read_yaml(YAML.replace("0.196", "0.0") + more)
    values = cells_of(np.array([[[255, 204, 128, 51, 0]]], dtype=np.uint8), whole)[0].tolist()
    assert values == [0, 20, 50, 80, 100]


def test_raw_is_the_pixel_itself_up_to_100():
    assert cells("mode: raw\n", 0, 42, 100, 101, 255) == [0, 42, 100, -1, -1]


def test_what_can_be_seen_through_is_unknown_in_scale_and_lighter_in_trinary():
    assert cells("mode: scale\n", 0, 0, alpha=(255, 254)) == [100, -1]
    assert cells("", 0, 254, alpha=(255, 255)) == [-1, 0]


@pytest.mark.parametrize("yaw", [0.0, math.pi / 2])
def test_the_corners_are_turned_about_the_lower_left_one(yaw):
    described = read_yaml(YAML.replace("0.0]", f"{yaw}]"))
    expected = [(1, 7), (11, 7), (1, 2)] if yaw == 0 else [(-4, 2), (-4, 12), (1, 2)]
    assert np.allclose(described.corners(200, 100), expected)


def test_what_is_written_here_is_read_as_it_was():
    grid = RasterGrid(-3.0, 4.0, 0.05, 3, 2)
    written = np.array([[100, 0, -1], [0, 100, 0]], dtype=np.int8)
    files = trinary_files("site", grid, written, {"crs": "EPSG:32633", "origin": "10,20"})
    described = read_yaml(files["site.yaml"].decode())
    assert (described.image, described.origin, described.resolution) == ("site.pgm", (-3.0, 4.0, 0.0), 0.05)
    assert described.meta == {"crs": "EPSG:32633", "origin": "10,20"}
    pixels = np.frombuffer(files["site.pgm"][-6:], dtype=np.uint8).reshape(1, 2, 3)
    assert (cells_of(pixels, described)[::-1] == written).all()
    shades = np.arange(101, dtype=np.int8).reshape(1, 101)
    files = scale_files("mask", RasterGrid(0.0, 0.0, 1.0, 101, 1), shades)
    pixels = np.frombuffer(files["mask.pgm"][-101:], dtype=np.uint8).reshape(1, 1, 101)
    assert (cells_of(pixels, read_yaml(files["mask.yaml"].decode())) == shades).all()


@pytest.mark.parametrize(
    ("old", "new", "named"),
    [
        ("[1.0, 2.0, 0.0]", "[.nan, 2.0, 0.0]", "origin: nan"),
        ("[1.0, 2.0, 0.0]", "[1.0, 2.0, .inf]", "origin: inf"),
        ("[1.0, 2.0, 0.0]", "[1.0, 2.0]", r"origin: \[1.0, 2.0\]; give \[x, y, yaw\]"),
        ("[1.0, 2.0, 0.0]", "here", "origin: 'here'"),
        ("resolution: 0.05", "resolution: 0", "resolution: 0; give a number from"),
        ("resolution: 0.05", "resolution: -1", "resolution: -1"),
        ("resolution: 0.05", "", "resolution: None"),
        ("image: a.pgm", "", "image: there is none"),
        ("negate: 0", "negate: 2", "negate: 2; give 0 or 1"),
        ("negate: 0", "mode: blue", "mode: 'blue' is none of"),
        ("free_thresh: 0.196", "free_thresh: 0.7", "free_thresh: 0.7 is not below occupied_thresh, 0.65"),
        ("image: a.pgm", "image: [", "it is no YAML"),
    ],
)
def test_what_cannot_be_is_named(old, new, named):
    with pytest.raises(NavigationMapError, match=named):
        read_yaml(YAML.replace(old, new))


def test_a_text_without_keys_too_long_a_one_and_too_many_pixels_are_refused():
    for text in ("a map", "x" * 70_000):
        with pytest.raises(NavigationMapError):
            read_yaml(text)
    check_size(8000, 8000)
    with pytest.raises(NavigationMapError, match="at most 64 million"):
        check_size(LARGEST_MAP, 2)


def test_a_comment_that_only_looks_like_a_place_is_none():
    assert read_yaml("# origin is at the door\n# rotation 3\n" + YAML).meta == {}
