"""Tracks of Formula Student simulators, read into rows of cones."""

from __future__ import annotations

import pytest

from robot_bridge.core.errors import ConeTableError
from robot_bridge.core.layouts.cone_files import (
    LARGEST_FILE,
    colour_table,
    headless_rows,
    is_track,
    read_track,
)

YAML = """
cones_left:
- - 1.5
  - 2.0
- [3.0, 4.0, 0.1]
cones_orange: []
cones_orange_big:
- [0.0, 2.5]
cones_right:
- [1.5, -2.0]
starting_pose_front_wing: [0.0, 0.0, 0.0]
tk_device:
- [6.0, 3.0]
"""
SDF = """<?xml version="1.0"?>
<sdf version="1.6"><model name="track">
  <include><uri>model://fssim_gazebo/models/cone_blue</uri><pose>1.5 2 0 0 0 0</pose></include>
  <include><uri>model://eufs/models/yellow_cone</uri><pose>
     1.5  -2 0 0 0 1.2 </pose></include>
  <link name="big_orange_cone_0"><pose>0 2.5 0 0 0 0</pose></link>
  <include><uri>model://fssim_gazebo/models/time_keeping</uri><pose>6 3 0 0 0 0</pose></include>
  <include><uri>model://sun</uri></include>
</model></sdf>
"""


@pytest.fixture
def track(tmp_path):
    def write(text, name="track.yaml"):
        file = tmp_path / name
        file.write_text(text, encoding="utf-8")
        return file

    return write


def cones(rows):
    return [(row["colour"], float(row["x_m"]), float(row["y_m"])) for row in rows]


def test_yaml_has_the_cones_by_side_and_colour(track):
    assert is_track(file := track(YAML))
    assert cones(read_track(file)) == [
        ("blue", 1.5, 2.0),
        ("blue", 3.0, 4.0),
        ("yellow", 1.5, -2.0),
        ("big_orange", 0.0, 2.5),
    ]


def test_sdf_has_the_models_and_links_that_are_cones(track):
    assert cones(read_track(track(SDF, "track.sdf"))) == [
        ("blue", 1.5, 2.0),
        ("yellow", 1.5, -2.0),
        ("big_orange", 0.0, 2.5),
    ]


def test_a_table_without_a_head_line_begins_with_a_cone(track):
    file = track("blue,0,0,0,0.01,0.01,0\nbig_orange,4,5,0,0.01,0.01,0\n", "fsds.csv")
    assert cones(headless_rows(file)) == [("blue", 0.0, 0.0), ("big_orange", 4.0, 5.0)]
    assert headless_rows(track("colour,x_m,y_m\nblue,1,2\n", "head.csv")) is None
    with pytest.raises(ConeTableError, match=r"fsds\.csv, row 2: a table without a head line has a colour"):
        headless_rows(track("blue,0,0\ngreen,1,1\n", "fsds.csv"))


@pytest.mark.parametrize(
    "head", [["blue_x", "blue_y", "x_yellow", "y_yellow"], ["Blue X", "Blue Y_m", "yellow_x", "yellow_y"]]
)
def test_a_wide_table_has_two_columns_for_each_colour(head):
    rows = [dict(zip(head, values, strict=True)) for values in (("1", "2", "3", "4"), ("5", "6", "", ""))]
    assert cones(colour_table(head, rows)) == [("blue", 1, 2), ("blue", 5, 6), ("yellow", 3, 4)]
    assert colour_table(["x_m", "y_m", "colour"], []) is None


@pytest.mark.parametrize(
    ("name", "text", "said"),
    [
        ("a.yaml", "[1, 2", "a.yaml is no YAML"),
        ("a.yaml", "- 1", "a.yaml is no track: give lists of points under cones_left"),
        ("a.yaml", "cones_left: 3", "cones_left is no list of points"),
        ("a.yaml", "cones_left: [[1, 2], [3]]", r"point 2 of cones_left is no \[x, y\]"),
        ("a.yaml", "speed: 3", "a.yaml holds no cones: in YAML they stand under"),
        ("a.yaml", "!!python/object/apply:os.system [true]", "a.yaml is no YAML"),
        ("a.yaml", "[" * 200_000, "a.yaml is no YAML"),
        ("a.yaml", "{a: " * 60_000, "a.yaml is no YAML"),
        ("a.sdf", "<sdf>", "a.sdf is no SDF"),
        ("a.sdf", "<sdf/>", "a.sdf holds no cones"),
        ("a.sdf", SDF.replace("1.5 2 0 0 0 0", "1.5"), "the pose '1.5' of .* has no x and y"),
        ("a.sdf", '<!DOCTYPE a [<!ENTITY b "c">]><sdf>&b;</sdf>', "defines entities"),
        ("a.sdf", "<a>" * 50_000, "a.sdf is no SDF"),
        ("a.yaml", "#" * (LARGEST_FILE + 1), "has 300001 bytes, a track may have 300000"),
    ],
)
def test_what_is_no_track_is_named_with_what_is_read(track, name, text, said):
    with pytest.raises(ConeTableError, match=said):
        read_track(track(text, name))
