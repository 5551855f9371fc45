"""The picture of a map: every obstacle is on it, where and as what it is."""

from __future__ import annotations

import math
import re
from xml.etree import ElementTree

import numpy as np
import pytest

from robot_bridge.core.robotmap.exporters.svg import RAMP, STAIRS, colours_of_labels, label_position, svg_of
from robot_bridge.core.robotmap.model import ShapeType

NAMESPACE = {"s": "http://www.w3.org/2000/svg"}


def paths(picture: bytes, **attributes) -> list[np.ndarray]:
    """Return the points of every path that has these attributes."""
    found = []
    for path in ElementTree.fromstring(picture).iterfind(".//s:path", NAMESPACE):
        if all(path.get(name.replace("_", "-")) == value for name, value in attributes.items()):
            numbers = re.findall(r"-?[\d.]+", path.get("d"))
            found.append(np.array(numbers, dtype=float).reshape(-1, 2))
    return found


def texts(picture: bytes) -> list[str]:
    return [text.text for text in ElementTree.fromstring(picture).iterfind(".//s:text", NAMESPACE)]


def test_an_area_lies_where_the_map_has_it_with_its_upper_side_up(make_map, house):
    picture = svg_of(make_map([(house, {})], (10, 20, 30, 40)), size=200)
    (points,) = paths(picture, stroke="#6b563f")
    # 10 pixels a metre; the map's upper left corner lies at (62, 66) on the sheet.
    wanted = np.array(house[:-1]) * (10, -10) + (62 - 100, 66 + 400)
    assert {tuple(point) for point in points} == {tuple(point) for point in wanted.astype(float)}


def test_name_height_legend_and_size_are_written(make_map):
    square = [(2, 2), (18, 2), (18, 18), (2, 18), (2, 2)]
    picture = svg_of(make_map([(square, {"semantics": "building,Library", "height": 8.5})], (0, 0, 20, 20)))
    said = texts(picture)
    assert {"Robot map", "Library", "8.5 m", "building"} <= set(said)
    assert "20 m × 20 m · 1 obstacle, 4 segments" in said


def test_a_courtyard_is_a_hole_also_where_the_border_cuts_the_building(make_map):
    def square(low, high):
        return [(low, low), (high, low), (high, high), (low, high), (low, low)]

    rows = [
        (square(2, 18), {"source": "b:1", "height": 0.1}),
        (square(6, 14), {"source": "b:1", "courtyard": True, "height": 0.1}),
        (square(0.5, 1), {"height": 0.1}),
    ]
    whole = svg_of(make_map(rows, (0, 0, 20, 20)))
    assert max(len(points) for points in paths(whole, stroke="#6b563f")) == 8
    cut = svg_of(make_map(rows, (0, 0, 10, 20)), size=200)
    fills = [p for p in paths(cut) if len(p) == 8 and np.ptp(p[:, 0]) == 80]
    assert len(fills) == 1


def test_a_courtyard_never_covers_what_stands_in_it(make_map):
    """The building round it is cut, so that its courtyard is an area of its own."""

    def square(low, high, right=0.0):
        right = right or high
        return [(low, low), (right, low), (right, high), (low, high), (low, low)]

    rows = [
        (square(7, 8), {"semantics": "hut"}),
        (square(2, 18, right=25), {"source": "b:1"}),
        (square(6, 14), {"source": "b:1", "courtyard": True}),
        (square(0.5, 1), {}),
    ]
    picture = svg_of(make_map(rows, (0, 0, 20, 20)), size=200).decode()
    order = [picture.index(f'd="M{62 + 10 * x:.1f} {66 + 200 - 10 * y:.1f}L') for x, y in ((6, 6), (7, 7))]
    assert order == sorted(order)


def test_stairs_and_ramps_have_their_own_colours_whatever_they_are_called(make_map):
    picture = svg_of(
        make_map(
            [
                ([(1, 1), (4, 1), (4, 3), (1, 3), (1, 1)], {"shape_type": ShapeType.RAMP, "semantics": "x"}),
                (
                    [(6, 2), (8, 2), (6, 3), (8, 3)],
                    {"shape_type": ShapeType.STAIRS, "semantics": "x", "height": 0.2},
                ),
            ],
            (0, 0, 10, 10),
        )
    )
    assert len(paths(picture, stroke=RAMP.stroke)) == 1
    assert len(paths(picture, stroke=STAIRS.stroke)) == 1
    assert len(paths(picture, fill=STAIRS.fill)) == 1


@pytest.mark.parametrize(
    ("meta", "letter", "degrees"),
    [
        ({"crs": "EPSG:32633", "rotation": f"{math.radians(30):.9f}"}, "N", 30.0),
        ({"crs": "EPSG:32633"}, "N", 0.0),
        ({"crs": "UPC FIB square model frame"}, "y", 0.0),
        ({}, "y", 0.0),
    ],
)
def test_north_is_where_the_frame_has_it_and_only_where_it_is_known(make_map, house, meta, letter, degrees):
    picture = svg_of(make_map([(house, {})], (10, 20, 30, 40), meta))
    assert letter in texts(picture)
    assert float(re.search(rb"rotate\((.*?)\)", picture)[1]) == pytest.approx(degrees, abs=0.001)


def test_the_scale_bar_is_as_long_as_it_says(make_map, house):
    picture = svg_of(make_map([(house, {})], (10, 20, 30, 40)), size=1000)
    (said,) = [text for text in texts(picture) if re.fullmatch(r"\S+ m", text) and text != "3 m"]
    bars = [
        float(bar.get("width"))
        for bar in ElementTree.fromstring(picture).iterfind(".//s:rect", NAMESPACE)
        if bar.get("height") == "7.0"
    ]
    assert sum(bars) == pytest.approx(float(said.removesuffix(" m")) * 50)


def test_labels_that_xml_cannot_hold_do_no_harm(make_map, house):
    picture = svg_of(make_map([(house, {"semantics": 'a<b>&\x01"c'})], (10, 20, 30, 40), {"id": "<&>"}))
    assert 'a<b>&"c' in texts(picture) and "<&>" in texts(picture)


def test_a_legend_that_is_too_long_says_how_much_is_missing(make_map):
    rows = [([(k, 1), (k, 2)], {"shape_type": 2, "semantics": f"kind {k:02}"}) for k in range(20)]
    said = texts(svg_of(make_map(rows, (0, 0, 30, 30))))
    assert "kind 10" in said and "kind 11" not in said and "and 9 more" in said


def test_the_same_labels_have_the_same_colours(make_map):
    def colours(*labels):
        rows = [([(k, 1), (k, 2)], {"shape_type": 2, "semantics": label}) for k, label in enumerate(labels)]
        return colours_of_labels(make_map(rows, (0, 0, 30, 30)).obstacles)

    assert colours("kiosk", "gate", "wall") == colours("wall,old", "gate", "gate", "kiosk")


def test_a_map_of_nothing_is_an_empty_sheet(make_map, house):
    picture = svg_of(make_map([(house, {})], (100, 100, 120, 120)))
    assert "20 m × 20 m · 0 obstacles, 0 segments" in texts(picture)


def test_a_long_narrow_map_keeps_its_legend_on_the_sheet(make_map):
    picture = svg_of(make_map([([(1, 1), (900, 2)], {"shape_type": 2})], (0, 0, 1000, 4)))
    root = ElementTree.fromstring(picture)
    lowest = max(float(text.get("y")) for text in root.iterfind(".//s:text", NAMESPACE))
    assert lowest < float(root.get("height"))


def test_there_is_room_in_the_arm_of_an_l_and_not_in_its_corner():
    ring = np.array([(0, 0), (100, 0), (100, 30), (30, 30), (30, 100), (0, 100), (0, 0)], dtype=float)
    place = label_position([ring])
    assert place.away > 12 and not (place.x > 30 and place.y > 30)
    square = np.array([(0, 0), (30, 0), (30, 30), (0, 30), (0, 0)], dtype=float)
    courtyard = np.array([(2, 2), (2, 28), (28, 28), (28, 2), (2, 2)], dtype=float)
    assert label_position([square, courtyard]).away < 2
