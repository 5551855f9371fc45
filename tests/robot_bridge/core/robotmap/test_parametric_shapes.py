"""Furniture points as small closed shapes, by name, size and rotation."""

from __future__ import annotations

import math

import numpy as np
import pytest
import shapely
from hypothesis import given
from hypothesis import strategies as st

from robot_bridge.core.errors import ShapingError
from robot_bridge.core.robotmap.builder import build_map
from robot_bridge.core.robotmap.model import ShapeType
from robot_bridge.core.robotmap.parametric_shapes import NAMED, template
from tests.robot_bridge.core.robotmap.rows import outlines, row, signed_area


@given(st.floats(0.01, 100), st.integers(3, 64), st.floats(-1e6, 1e6), st.floats(-10, 10))
def test_a_disc_lies_within_its_circle_and_touches_every_side(across, corners, x, turned):
    ring = template(f"circle {across!r} {corners}").at(x, -x, turned)
    assert len(ring) == corners + 1 and (ring[0] == ring[-1]).all()
    middles = np.hypot(*((ring[:-1] + ring[1:]) / 2 - (x, -x)).T)
    assert middles == pytest.approx(np.full(corners, across / 2), abs=1e-8)


def test_a_circle_has_eight_corners_unless_it_says_otherwise():
    assert len(template("circle 0.5").ring) == 9
    assert len(template("circle 6 24").ring) == 25


def test_a_rectangle_has_its_width_along_x_and_is_turned_to_the_left():
    bench = template("rectangle 1.8 0.6")
    assert bench.ring.tolist() == [[-0.9, -0.3], [0.9, -0.3], [0.9, 0.3], [-0.9, 0.3], [-0.9, -0.3]]
    placed = bench.at(10, 20, math.pi / 2)
    assert placed[0] == pytest.approx([10.3, 19.1]) and placed[1] == pytest.approx([10.3, 20.9])


def test_a_square_is_a_rectangle_of_one_side():
    assert (template("square 1.2").ring == template("rectangle 1.2 1.2").ring).all()


@pytest.mark.parametrize("name", NAMED)
def test_a_named_thing_is_a_sound_ring_of_the_size_of_furniture(name):
    ring = shapely.Polygon(template(name).ring)
    assert ring.is_valid and ring.exterior.is_ccw and ring.centroid.distance(shapely.Point(0, 0)) < 1e-12
    low, high = np.reshape(ring.bounds, (2, 2))
    assert ((high - low) <= 2).all() and ((high - low) >= 0.1).all()


def test_a_bench_in_a_map_is_a_closed_polygon_with_its_free_space_outside():
    bench = row(template(" bench ").at(3, 4, 0.3), ShapeType.CLOSED_POLYGON, semantics="bench", height=0.8)
    (obstacle,) = build_map(outlines(bench)).obstacles
    assert obstacle.shape_type is ShapeType.CLOSED_POLYGON
    assert signed_area(obstacle) == pytest.approx(1.8 * 0.6, abs=0.03)


@pytest.mark.parametrize(
    "text",
    [
        *("circle", "circle 0", "circle -1", "circle nan", "circle 101", "circle one", "circle 1 2"),
        *("circle 1 65", "circle 1 4.5", "circle 1 8 1", "square", "square 1 1", "rectangle 1", "square inf"),
    ],
)
def test_a_size_that_makes_no_shape_is_refused_with_what_the_kind_needs(text):
    with pytest.raises(ShapingError, match=rf"'{text}' is not {text.split()[0]} [A-Z]"):
        template(text)


@pytest.mark.parametrize("text", ["", " ", "sofa", "Bench", "8"])
def test_a_template_that_is_not_known_is_refused_with_those_that_are(text):
    with pytest.raises(ShapingError, match=r"bench, .*rectangle WIDTH DEPTH"):
        template(text)


@pytest.mark.parametrize("place", [(math.nan, 0, 0), (0, math.inf, 0), (0, 0, math.nan)])
def test_a_place_must_be_finite(place):
    with pytest.raises(ShapingError, match="finite"):
        template("bench").at(*place)
