"""Where there is room for a text, against a screen full of cells that are looked through one by one."""

from __future__ import annotations

import numpy as np
import pytest
from fleet_supervisor.plugin.map.overlay.labels import GRID, HEIGHT, LINES, LabelPlacer
from fleet_supervisor.plugin.map.overlay.scene import Screen

SCREEN = Screen((0.0, 0.0), (0.0, 0.0), (1.0, 0.0), (0.0, 1.0), 303, 200)
NOBODY = np.empty((0, 2))


def cells_of(corner, width):
    """Return the cells that a text lies on, as (line, column)."""
    left, line = (int(np.floor(edge / GRID)) for edge in corner)
    right = int(np.floor((corner[0] + width + GRID) / GRID))
    return {(line + down, across) for down in range(LINES) for across in range(left, right)}


def texts(number, seed):
    """Return corners and widths of texts that are whole on the screen."""
    random = np.random.default_rng(seed)
    width = random.uniform(10.0, 90.0, number)
    x = random.uniform(0.0, SCREEN.width - width)
    return np.column_stack([x, random.uniform(0.0, SCREEN.height - HEIGHT, number)]), width


def test_a_text_lies_on_as_many_lines_as_it_can_touch():
    assert (LINES - 1) * GRID >= HEIGHT > (LINES - 2) * GRID


@pytest.mark.parametrize("number", [1, 40, 400])
def test_a_text_is_without_robots_where_none_stands_in_its_cells(number):
    # Some of them reach in from beyond the border.
    robots = np.random.default_rng(number).uniform(-12, (SCREEN.width + 12, SCREEN.height + 12), (number, 2))
    taken = {(int(np.floor(y / GRID)), int(np.floor(x / GRID))) for x, y in robots}
    corner, width = texts(500, 1)
    expected = [taken.isdisjoint(cells_of(*text)) for text in zip(corner, width, strict=True)]
    room = LabelPlacer(SCREEN, robots)
    assert room.without_robots(room.cells(corner, width)).tolist() == expected


def test_a_robot_beyond_the_border_is_in_no_texts_way():
    corner, width = np.array([[0.0, 0.0], [203.0, 0.0], [0.0, 182.0], [203.0, 182.0]]), np.full(4, 100.0)
    beyond = np.array([[-1.0, 5.0], [-1.0, 190.0], [315.0, 5.0], [315.0, 190.0], [50.0, -1.0], [50.0, 220.0]])
    room = LabelPlacer(SCREEN, beyond)
    assert room.without_robots(room.cells(corner, width)).all()


def test_texts_are_taken_in_their_order_unless_one_before_has_a_cell_of_theirs():
    corner, width = texts(300, 2)
    taken, expected = set(), []
    for index, text in enumerate(zip(corner, width, strict=True)):
        cells = cells_of(*text)
        if taken.isdisjoint(cells):
            taken |= cells
            expected.append(index)
    room = LabelPlacer(SCREEN, NOBODY)
    assert room.place_labels(room.cells(corner, width)) == expected
    assert 5 < len(expected) < 300


def test_what_is_there_already_leaves_room_only_beside_it():
    room = LabelPlacer(
        SCREEN, NOBODY, [(60.0, 60.0, 119.0, 77.0), (-50.0, -50.0, 5.0, 5.0), (290.0, 190.0, 999.0, 999.0)]
    )
    above, below, left, right, over = (60.0, 36.0), (60.0, 78.0), (24.0, 60.0), (120.0, 60.0), (100.0, 50.0)
    corners = np.array([over, (0.0, 0.0), (260.0, 182.0), above, below, left, right])
    assert room.place_labels(room.cells(corners, np.full(7, 29.0))) == [3, 4, 5, 6]
