"""The text format: the paper's sample byte for byte, what is tolerated, and what is refused and how."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from robot_bridge.core.errors import MapTextError, RobotMapError
from robot_bridge.core.robotmap.model import Border, Obstacle, RobotMap, ShapeType
from robot_bridge.core.robotmap.text_format import format_number, read_text, write_text


def test_fig_2_is_read_as_the_paper_means_it(fig_2):
    robot_map = read_text(fig_2)
    assert robot_map.border == Border(-4, -4, 100, 100)
    column, wall = robot_map.obstacles
    assert (column.id, column.shape_type, column.semantics) == (1, ShapeType.CLOSED_POLYGON, "column,A5")
    assert column.a.tolist() == [[4.53, 12.10]] and column.b.tolist() == [[7.29, 12.10]]
    assert column.height.tolist() == [5] and column.outdoor.tolist() == [True]
    assert column.segment_semantics == ("wall,orange,brick",)
    assert (wall.id, wall.shape_type, wall.height.tolist()) == (110, ShapeType.OPEN_POLYGON, [1.2])


def test_fig_2_is_written_back_byte_for_byte(fig_2):
    assert write_text(read_text(fig_2)) == fig_2


def test_a_declared_count_that_disagrees_is_a_warning_that_names_the_obstacle(fig_2):
    (warning,) = read_text(fig_2).warnings
    assert "obstacle 1 " in warning and "4" in warning and "line 6" in warning


@pytest.mark.parametrize(
    "change",
    [
        lambda text: text.replace("\n", "\r\n"),
        lambda text: text.rstrip("\n"),
        lambda text: "%version 3\n%crs EPSG:32633\n%a remark of somebody\n" + text,
        lambda text: text.replace("#\nobstacle;", "#\n\n% the next one\nobstacle;"),
        lambda text: text + "\n% the end\n\n",
        lambda text: text.replace("12.10", "+1.210e1"),
        lambda text: text.replace("column,A5;", "column,A5;src=layer\\3b1,k=v;"),
        lambda text: text.replace("orange", "oránge\x0b\x85"),
    ],
)
def test_whatever_was_read_is_written_back_byte_for_byte(fig_2, change):
    text = change(fig_2)
    assert write_text(read_text(text)) == text


def test_meta_lines_are_read(fig_2):
    assert read_text("%version 3\n%crs EPSG:32633\n" + fig_2).meta == {"version": "3", "crs": "EPSG:32633"}


def test_a_changed_obstacle_is_written_anew_and_its_neighbours_are_not(fig_2):
    robot_map = read_text(fig_2)
    column, wall = robot_map.obstacles
    moved = dataclasses.replace(column, a=column.a + 1)
    changed = read_text(write_text(with_obstacles(robot_map, moved, wall)))
    assert changed.obstacles[0].a.tolist() == [[5.53, 13.1]]
    assert changed.obstacles[1].text == wall.text


def with_obstacles(robot_map, *obstacles):
    return dataclasses.replace(robot_map, obstacles=obstacles)


def test_strict_writes_nothing_that_fig_2_does_not_have(fig_2):
    robot_map = read_text("%version 3\n" + fig_2.replace("column,A5;", "column,A5;src=x;"))
    strict = write_text(robot_map, strict=True)
    assert "%" not in strict and "=" not in strict
    assert strict.startswith("border;\n-4;100;\n100;-4;\n#\nobstacle;\n1;1;1;column,A5;\n#\n")


def test_every_prefix_that_ends_inside_an_obstacle_says_that_the_text_was_cut_off(fig_2):
    lines = fig_2.splitlines(keepends=True)
    whole = {4, 11, 18}
    for count in range(len(lines)):
        if count in whole:
            read_text("".join(lines[:count]))
            continue
        with pytest.raises(MapTextError, match=r"cut off"):
            read_text("".join(lines[:count]))


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ("4.53;12.10;", "4.53;nan;", r"line 8: in obstacle 1, expected a point"),
        ("4.53;12.10;", "4.53;1e999;", r"finite"),
        ("4.53;12.10;", "4.53;0x1p3;", r"line 8"),
        ("4.53;12.10;", "4.53;12.10", r"closed by ';'"),
        ("4.53;12.10;", "4.53;12.10;3;", r"line 8"),
        ("4.53;12.10;", "4,53;12,10;", r"line 8"),
        ("1;1;4;column,A5;", "1;7;4;column,A5;", r"ST from 1 to 6.*'1;7;4;column,A5;'"),
        ("1;1;4;column,A5;", "1;1;column,A5;", r"line 6"),
        ("1;1;4;column,A5;", "1;1;4;column,A5;src;", r"key=value"),
        ("5;1;wall,orange,brick;", "5;2;wall;", r"height;0 or 1"),
        ("5;1;wall,orange,brick;", "inf;1;wall;", r"finite"),
        ("border;", "boarder;", r"line 1: in the head of the map, expected 'border;', found 'boarder;'"),
        ("-4;100;\n100;-4;", "100;-4;\n-4;100;", r"left-upper"),
    ],
)
def test_what_is_wrong_is_named_with_its_line(fig_2, old, new, said):
    assert old in fig_2
    with pytest.raises(MapTextError, match=said):
        read_text(fig_2.replace(old, new))


def test_repeated_ids_are_a_warning(fig_2):
    warnings = read_text(fig_2.replace("110;2;1", "1;2;1")).warnings
    assert any("id 1 is used more than once" in warning for warning in warnings)


@pytest.mark.parametrize(
    ("value", "text"),
    [(-0.001, "0"), (12.10, "12.1"), (-4.0, "-4"), (100.0, "100"), (0.005, "0.01"), (1e6, "1000000")],
)
def test_numbers_are_written_in_centimetres_without_trailing_zeros(value, text):
    assert format_number(value) == text or abs(float(format_number(value)) - value) <= 0.005


centimetres = st.integers(-10_000_000, 10_000_000).map(lambda n: n / 100)
label = st.text(max_size=12)
point = st.tuples(centimetres, centimetres)


@st.composite
def obstacles(draw):
    count = draw(st.integers(0, 4))
    points = st.lists(point, min_size=count, max_size=count)
    return Obstacle(
        id=draw(st.integers(0, 10**9)),
        shape_type=draw(st.sampled_from(ShapeType)),
        semantics=draw(label),
        a=np.array(draw(points), dtype=float).reshape(-1, 2),
        b=np.array(draw(points), dtype=float).reshape(-1, 2),
        height=np.array(draw(st.lists(centimetres, min_size=count, max_size=count))),
        outdoor=np.array(draw(st.lists(st.booleans(), min_size=count, max_size=count)), dtype=bool),
        segment_semantics=tuple(draw(st.lists(label, min_size=count, max_size=count))),
        ext=draw(st.dictionaries(label.filter(bool), label, max_size=2)),
    )


def facts(obstacle):
    return (
        obstacle.id,
        obstacle.shape_type,
        obstacle.semantics.strip(),
        obstacle.a.tolist(),
        obstacle.b.tolist(),
        obstacle.height.tolist(),
        obstacle.outdoor.tolist(),
        tuple(label.strip() for label in obstacle.segment_semantics),
        {key.strip(): value.strip() for key, value in obstacle.ext.items()},
    )


@given(st.lists(obstacles(), max_size=3))
def test_what_is_written_is_read_with_the_same_meaning_whatever_its_labels_hold(made):
    robot_map = RobotMap(Border(-4, -4, 100, 100), tuple(made), meta={"id": "x"})
    text = write_text(robot_map)
    again = read_text(text)
    assert [facts(o) for o in again.obstacles] == [facts(o) for o in made]
    assert again.meta == {"id": "x"}
    assert write_text(again) == text


@given(st.text(alphabet="border;obstacle#%0123456789.-\n,=ae", max_size=200))
def test_no_text_raises_anything_but_the_familys_errors(text):
    try:
        read_text(text)
    except RobotMapError as error:
        assert str(error).startswith("line ")


CENTIMETRES = [-0.0, 0.0, 0.01, 0.07, 0.29, 0.5, 4.0, 12.1, 123456.78, 99999999999.99]
PLAIN = [*CENTIMETRES, -4.0, 1e15 + 0.5, 0.125]


@pytest.mark.parametrize(
    "values",
    [CENTIMETRES, [*CENTIMETRES, -0.01], PLAIN, *([*PLAIN, odd] for odd in (1e-5, 1e17, -1.5e300, 9e-5))],
)
def test_every_number_is_written_as_if_alone_whatever_stands_beside_it(values):
    ends = np.array([[x, y] for x in values for y in values])
    heights = np.resize(np.abs(values), len(ends))
    wall = Obstacle(
        3, ShapeType.OPEN_POLYGON, "a.0;0", ends, ends[::-1], heights, heights > 1, ("b.0;",) * len(ends)
    )
    rows = np.column_stack([ends, ends[::-1], heights]).tolist()
    told = [[*map(format_number, row), int(row[4] > 1)] for row in rows]
    lines = ("{};{};\n{};{};\n{};{};b.0\\3b;\n#\n".format(*one) for one in told)
    assert write_text(RobotMap(Border(0.0, 0.0, 1.0, 1.0), (wall,))).endswith("\n#\n" + "".join(lines))


@pytest.mark.parametrize("bad", [float("nan"), float("inf")])
def test_a_number_that_is_none_is_not_written(bad):
    ends = np.array([[0.0, 0.0], [bad, 1.0]])
    wall = Obstacle(1, ShapeType.OPEN_POLYGON, "", ends, ends, np.ones(2), np.ones(2, bool), ("", ""))
    with pytest.raises(RobotMapError, match="give a finite one"):
        write_text(RobotMap(Border(0.0, 0.0, 1.0, 1.0), (wall,)))
