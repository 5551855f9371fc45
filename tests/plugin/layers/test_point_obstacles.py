"""Points of furniture become small closed shapes: by template, turned as they stand, else by width."""

from __future__ import annotations

import math

import numpy as np
import pytest
import shapely
from fleet_supervisor.plugin.layers.roles import FURNITURE, LayerExpressions, LayerSetup, keep_setup
from fleet_supervisor.plugin.ui.errors import ExpressionError
from fleet_supervisor.robot_bridge.core.robotmap.parametric_shapes import template

FIELDS = "&field=height:double&field=shape:string&field=way:string&field=across:double"
SAID = LayerExpressions(template='"shape"', rotation='"way"', width='"across"')


@pytest.fixture
def furniture(make_layer):
    """Return a layer of points 1 m high, each with shape, way and width."""

    def make(*points, said=SAID):
        features = [(f"Point({place})", 1.0, *values) for place, *values in points]
        layer = make_layer("things", "Point", FIELDS, features)
        keep_setup(layer, LayerSetup(FURNITURE, said))
        return layer

    return make


def outline(row):
    return shapely.Polygon(row.points)


def test_a_template_stands_around_its_point(furniture, read):
    reading = read(furniture(("7 9", "bench"), ("20 0", "circle 3 16"), ("30 0", "rectangle 2 0.5")))
    assert reading.warnings == []
    bench, circle, rectangle = (outline(row) for row in reading.rows)
    np.testing.assert_allclose(reading.rows[0].points, template("bench").at(7, 9), atol=1e-9)
    np.testing.assert_allclose(bench.bounds, (6.1, 8.7, 7.9, 9.3), atol=1e-9)
    assert len(circle.exterior.coords) == 17
    np.testing.assert_allclose(rectangle.bounds, (29, -0.25, 31, 0.25), atol=1e-9)


@pytest.mark.parametrize(
    ("way", "bounds"), [("90", (-0.3, -0.9, 0.3, 0.9)), ("180°", (-0.9, -0.3, 0.9, 0.3))]
)
def test_a_rotation_turns_it(furniture, read, way, bounds):
    (row,) = read(furniture(("0 0", "bench", way))).rows
    np.testing.assert_allclose(outline(row).bounds, bounds, atol=1e-9)


@pytest.mark.parametrize("rotation", [0.0, math.radians(30)])
def test_it_is_turned_clockwise_whatever_the_frame_of_the_site(furniture, read, rotation):
    # Its long side goes from west to east; turned by 45 degrees, from north-west to south-east.
    (row,) = read(furniture(("0 0", "rectangle 4 0.1", "45")), rotation=rotation).rows
    long_side = row.points[1] - row.points[0]
    towards = math.degrees(math.atan2(long_side[1], long_side[0]))
    assert towards == pytest.approx(-45 - math.degrees(rotation))


def test_without_a_template_the_width_counts_and_without_a_width_half_a_metre(furniture, read):
    reading = read(furniture(("0 0", "", None, 2.0), ("9 9", None, None, None)))
    assert reading.warnings == []
    near = [outline(row).exterior.distance(outline(row).centroid) for row in reading.rows]
    assert near == pytest.approx([1.0, 0.25])
    assert [len(row.points) for row in reading.rows] == [9, 9]


@pytest.mark.parametrize(
    ("values", "said"),
    [
        (("bnech",), "there is no template 'bnech'; give one of bench, "),
        (("square 0",), "the template 'square 0' is not square SIDE"),
        (("bench", "north"), "its rotation 'north' is not a number of degrees; it is not turned"),
        (("bench", "inf"), "its rotation 'inf' is not a number of degrees; it is not turned"),
        (("", None, 900.0), "its width 900 m is none of furniture; 0.5 is used"),
        (("", None, -1.0), "its width -1.0 is not a number of metres above 0; the default is used"),
    ],
)
def test_what_is_not_understood_is_named_and_the_thing_stays(furniture, read, values, said):
    reading = read(furniture(("0 0", *values)))
    assert len(reading.rows) == 1
    (warning,) = reading.warnings
    assert warning.startswith(f"Layer things, feature 1: {said}")


def test_a_thing_beside_the_window_is_read_where_it_reaches_in(furniture, read):
    things = [("10.8 5", "bench"), ("11 5", "bench"), ("109 5", "circle 100 3"), ("300 5", "bnech")]
    reading = read(furniture(*things), window=(0, 0, 10, 10))
    assert [row.source for row in reading.rows] == ["things:1", "things:3"]
    assert reading.warnings == []


@pytest.mark.parametrize("what", ["template", "rotation", "width"])
def test_what_is_no_expression_is_refused(furniture, read, what):
    with pytest.raises(ExpressionError, match=f"The {what} expression '1 \\+' for the layer things"):
        read(furniture(("0 0",), said=LayerExpressions(**{what: "1 +"})))
