"""Windows: what they cover and which are refused."""

from __future__ import annotations

import math

import pytest

from robot_bridge.core.errors import WindowError
from robot_bridge.core.robotmap.model import Window


def test_width_runs_along_x_and_height_along_y():
    border = Window(48, 48, 104, 50).border
    assert (border.left_upper, border.right_lower) == ((-4, 73), (100, 23))


def test_a_square_has_the_area_that_was_asked_for():
    border = Window.square(10, -20, 10_000).border
    assert border == (-40, -70, 60, 30) and border.area == 10_000


def test_a_window_between_two_corners_has_these_corners():
    assert Window.from_bounds(-4, -4, 100, 100).border == (-4, -4, 100, 100)


@pytest.mark.parametrize("bad", [0.0, -1.0, 0.004, math.nan, math.inf])
def test_a_window_without_an_inside_is_refused_by_the_name_of_its_side(bad):
    with pytest.raises(WindowError, match="width"):
        Window(0, 0, bad, 1)
    with pytest.raises(WindowError, match="height"):
        Window(0, 0, 1, bad)


@pytest.mark.parametrize("bad", [0.0, -100.0, math.nan, math.inf])
def test_an_area_that_is_none_is_refused(bad):
    with pytest.raises(WindowError, match="area"):
        Window.square(0, 0, bad)


def test_a_centre_that_is_nowhere_is_refused():
    with pytest.raises(WindowError, match="x is nan"):
        Window(math.nan, 0, 1, 1)
