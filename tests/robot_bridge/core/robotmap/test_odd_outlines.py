"""Outlines that are odd, or lie oddly in the window, and what becomes of them in a map."""

from __future__ import annotations

import numpy as np
import pytest

from robot_bridge.core.robotmap.builder import build_map
from robot_bridge.core.robotmap.model import ShapeType, Window
from robot_bridge.core.robotmap.text_format import read_text, write_text
from tests.robot_bridge.core.robotmap.rows import box, is_chain, outlines, ring, row, signed_area

WINDOW = Window(0, 0, 20, 20)


@pytest.mark.parametrize("first", range(4))
@pytest.mark.parametrize("step", [1, -1])
def test_chains_that_meet_where_the_ring_begins_are_one(first, step):
    corners = [(-5, -3), (15, -3), (15, 3), (-5, 3)]
    (chain,) = build_map(outlines(ring([*corners[first:], *corners[:first]][::step])), WINDOW).obstacles

    assert is_chain(chain)
    assert chain.a[0].tolist() == [10, 3] and chain.b[-1].tolist() == [10, -3]


@pytest.mark.parametrize("step", [1, -1])
def test_stairs_are_risers_from_the_bottom_seen_from_below_and_end_with_height_0(step):
    risers = [[(0, y), (3, y)][::step] for y in (0.0, 0.3, 0.6)]
    flight = row(np.array(risers).reshape(-1, 2), ShapeType.STAIRS, semantics="stairs", height=0.17)
    (stairs,) = build_map(outlines(flight), WINDOW).obstacles

    assert stairs.shape_type == ShapeType.STAIRS
    assert stairs.a.tolist() == [[0, 0], [0, 0.3], [0, 0.6]]
    assert stairs.b.tolist() == [[3, 0], [3, 0.3], [3, 0.6]]
    assert stairs.height.tolist() == [0.17, 0.17, 0]


def test_a_ramp_is_a_closed_outline_of_height_0():
    corners = [(0, 0), (4, 0), (4, 1), (0, 1), (0, 0)]
    (ramp,) = build_map(outlines(row(corners, ShapeType.RAMP, height=0.0)), WINDOW).obstacles
    assert ramp.shape_type == ShapeType.RAMP and not ramp.height.any() and signed_area(ramp) == 4


def test_a_wall_on_the_border_is_kept_and_one_beside_it_is_not():
    rows = outlines(row([(10, -5), (10, 5)]), row([(10.01, -5), (10.01, 5)], source="walls:2"))
    (wall,) = build_map(rows, WINDOW).obstacles
    assert wall.ext["src"] == "walls:1"


def test_a_building_that_touches_the_border_from_inside_stays_closed():
    noisy = 10 + 1e-12
    (building,) = build_map(outlines(box(4, 4, noisy, noisy)), WINDOW).obstacles
    assert building.shape_type == ShapeType.CLOSED_POLYGON and len(building.a) == 4


def test_coordinates_are_whole_centimetres_and_what_vanishes_by_it_is_dropped():
    points = [(0, 0), (4.0001, 0.004), (4.0049, 0), (4, 3.33333), (0, -0.0)]
    (wall,) = build_map(outlines(row(points)), WINDOW).obstacles
    assert wall.a.tolist() == [[0, 0], [4, 0], [4, 3.33]]
    assert "-0;" not in write_text(build_map(outlines(row(points)), WINDOW))


@pytest.mark.parametrize(
    ("bad", "reason"),
    [
        (ring([(0, 0), (4, 0)]), "too few points"),
        (ring([(0, 0), (4, 0), (2, 0)]), "encloses nothing"),
        (row([(0, 0)]), "too few points"),
        (row([]), "too few points"),
        (row([(0, 0), (0.001, 0)]), "smaller than a centimetre"),
        (row([(0, 0), (np.nan, 0)]), "not a finite number"),
        (row([(0, 0), (1, 0)], height=np.nan), "not a finite number"),
        (row([(0, 0), (1, 0), (1, 1)], ShapeType.STAIRS), "pairs of points"),
    ],
)
def test_what_is_no_obstacle_is_left_out_with_a_warning_that_names_its_source(bad, reason):
    good = row([(1, 1), (2, 2)], source="walls:2")
    robot_map = build_map(outlines(bad, good), WINDOW)

    assert [o.ext["src"] for o in robot_map.obstacles] == ["walls:2"]
    (warning,) = robot_map.warnings
    assert warning.startswith(bad.source) and reason in warning


def test_a_ring_that_does_not_close_is_closed_with_a_warning():
    robot_map = build_map(
        outlines(row([(0, 0), (4, 0), (4, 4)], ShapeType.CLOSED_POLYGON), box(5, 5, 6, 6)), WINDOW
    )
    assert [(len(o.a), o.shape_type) for o in robot_map.obstacles] == [(4, 1), (3, 1)]
    assert "walls:1" in robot_map.warnings[0] and "close" in robot_map.warnings[0]


def test_what_is_wrong_outside_the_window_is_not_warned_of():
    assert build_map(outlines(row([(50, 50), (50.001, 50)])), WINDOW).warnings == ()


def test_a_map_without_a_window_has_the_border_of_its_obstacles():
    assert build_map(outlines(box(-3, 2, 7, 9))).border == (-3, 2, 7, 9)


def test_a_single_straight_wall_still_has_a_border_with_an_inside():
    robot_map = build_map(outlines(row([(3, 1), (3, 5)])))
    assert robot_map.border == (2.5, 1, 3.5, 5)
    assert read_text(write_text(robot_map)).segment_count == 1


def test_a_window_without_obstacles_is_a_map_of_free_space():
    text = write_text(build_map(outlines(), WINDOW, meta={"id": "yard"}))
    assert text == "%id yard\nborder;\n-10;10;\n10;-10;\n#\n"
