"""The text format loses nothing: any map round trips, any cut is said to be one."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from robot_bridge.core.errors import MapTextError, RobotMapError
from robot_bridge.core.robotmap.model import Border, Obstacle, RobotMap, ShapeType
from robot_bridge.core.robotmap.text_format import read_text, write_text

numbers = st.floats(-1e7, 1e7)
# What means something in the format, what ends lines somewhere, what UTF-8 cannot say, and plain letters.
letters = st.sampled_from(" ;%#,=\\\n\r\t\x00\x85\xa0\u2028\ud800abux27é猫")
labels = st.text(letters, max_size=8)
extras = st.dictionaries(st.text(letters, min_size=1, max_size=4), labels, max_size=2)


@st.composite
def obstacles(draw):
    n = draw(st.integers(0, 3))
    points = st.lists(st.tuples(numbers, numbers), min_size=n, max_size=n)
    return Obstacle(
        id=draw(st.integers(0, 10**9)),
        shape_type=draw(st.sampled_from(ShapeType)),
        semantics=draw(labels),
        a=np.array(draw(points), dtype=float).reshape(-1, 2),
        b=np.array(draw(points), dtype=float).reshape(-1, 2),
        height=np.array(draw(st.lists(numbers, min_size=n, max_size=n)), dtype=float),
        outdoor=np.array(draw(st.lists(st.booleans(), min_size=n, max_size=n)), dtype=bool),
        segment_semantics=tuple(draw(st.lists(labels, min_size=n, max_size=n))),
        ext=draw(extras),
        segment_ext=tuple(draw(st.lists(extras, min_size=n, max_size=n))),
    )


words = st.text(st.sampled_from("%;#,=\\abué猫1.:"), min_size=1, max_size=6)
maps = st.builds(
    RobotMap,
    border=st.builds(Border, numbers, numbers, st.floats(2e7, 3e7), st.floats(2e7, 3e7)),
    obstacles=st.lists(obstacles(), max_size=3).map(tuple),
    meta=st.dictionaries(words, words, max_size=3),
)


def facts(robot_map):
    return robot_map.border, robot_map.meta, [obstacle_facts(o) for o in robot_map.obstacles]


def obstacle_facts(o):
    labels = o.segment_semantics if any(o.segment_semantics) else ()
    extras = o.segment_ext if any(o.segment_ext) else ()
    arrays = [array.tolist() for array in (o.a, o.b, o.height, o.outdoor)]
    return o.id, o.shape_type, o.semantics, labels, o.ext, extras, arrays


@given(maps)
def test_a_map_is_read_back_as_it_was_written(robot_map):
    assert facts(read_text(write_text(robot_map))) == facts(robot_map)


@given(maps)
def test_what_was_read_is_written_back_byte_for_byte(robot_map):
    text = write_text(robot_map)
    assert write_text(read_text(text)) == text


def test_every_cut_inside_a_line_is_called_one(fig_2):
    for end in range(len(fig_2) - 1):
        if fig_2[end - 1] in "\n#" and end:
            continue
        with pytest.raises(MapTextError, match="cut off"):
            read_text(fig_2[:end])


def test_a_cut_between_two_segments_shows_in_their_number(fig_2):
    text = fig_2.replace("110;2;1", "110;2;2")
    assert "declares 2 segments, and 1 came" in read_text(text).warnings[-1]


def test_an_extra_may_hold_commas(fig_2):
    text = fig_2.replace("wall,A4;", "ramp,R1;n=0.08,0,0.997,src=ramps:1;")
    robot_map = read_text(text)
    assert robot_map.obstacles[1].ext == {"n": "0.08,0,0.997", "src": "ramps:1"}
    again = write_text(dataclasses.replace(robot_map, obstacles=(renamed(robot_map.obstacles[1]),)))
    assert "n=0.08,0,0.997,src=ramps:1;" in again


def test_extras_of_a_segment_are_read_and_written(fig_2):
    wall = read_text(fig_2.replace("greycement;", "greycement;door=1;")).obstacles[1]
    assert wall.segment_ext == ({"door": "1"},)
    assert "1.2;1;wall,greycement;door=1;\n" in write_text(
        dataclasses.replace(read_text(fig_2), obstacles=(renamed(wall),))
    )


def test_more_digits_than_centimetres_survive_a_change(fig_2):
    column = read_text(fig_2.replace("4.53", "4.5312345")).obstacles[0]
    text = write_text(dataclasses.replace(read_text(fig_2), obstacles=(renamed(column),)))
    assert "4.5312345;12.1;\n" in text


def test_an_obstacle_read_at_an_end_without_line_break_can_be_followed_by_another(fig_2):
    robot_map = read_text(fig_2.removesuffix("\n"))
    column, wall = robot_map.obstacles
    swapped = dataclasses.replace(robot_map, obstacles=(wall, column))
    assert [o.id for o in read_text(write_text(swapped)).obstacles] == [110, 1]


def test_the_arrays_of_a_map_that_was_read_cannot_be_changed_behind_its_text(fig_2):
    with pytest.raises(ValueError, match="read-only"):
        read_text(fig_2).obstacles[0].height[0] = 3


@pytest.mark.parametrize("bad", [np.nan, np.inf])
def test_a_number_that_is_not_finite_is_not_written(fig_2, bad):
    robot_map = read_text(fig_2)
    wall = dataclasses.replace(robot_map.obstacles[1], height=np.array([bad]))
    with pytest.raises(RobotMapError, match="finite"):
        write_text(dataclasses.replace(robot_map, obstacles=(wall,)))


def test_a_leading_line_without_a_key_is_not_written(fig_2):
    with pytest.raises(RobotMapError, match="one word"):
        write_text(dataclasses.replace(read_text(fig_2), meta={"two words": "x"}))


def renamed(obstacle):
    return dataclasses.replace(obstacle, id=obstacle.id + 1)
