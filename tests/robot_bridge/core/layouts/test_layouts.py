"""Layouts have the dimensions of the standards; the numbers here are written down from their sources."""

from __future__ import annotations

import math
from pathlib import Path

import pytest

from robot_bridge.core.errors import DimensionError
from robot_bridge.core.layouts.catalogue import LAYOUTS
from robot_bridge.core.layouts.cone_files import ConeColumns, cones_of, read_csv
from robot_bridge.core.layouts.layout import COLOURS, Cone

BASE = 0.2
HALF = 0.1


def cones(name: str, **values: float) -> list[Cone]:
    return LAYOUTS[name].of({"cone_base": BASE, **values}).cones()


def row(made: list[Cone], role: str) -> list[tuple[float, float]]:
    return [(cone.x, cone.y) for cone in made if cone.role == role]


def limits(made: list[Cone], lane: str) -> tuple[list[float], float, float]:
    """Return the x of a lane's cones and its limits, right and left, which the cones touch from outside."""
    left, right = row(made, f"{lane} left".strip()), row(made, f"{lane} right".strip())
    assert [x for x, _ in left] == [x for x, _ in right]
    assert len({y for _, y in left}) == len({y for _, y in right}) == 1
    return [x for x, _ in left], right[0][1] + HALF, left[0][1] - HALF


@pytest.mark.parametrize("name", LAYOUTS)
def test_every_layout_names_its_standard_and_numbers_its_cones(name: str) -> None:
    kind = LAYOUTS[name]
    made = kind.of({}).cones()
    assert kind.TITLE and kind.STANDARD and kind.__doc__
    assert [cone.order for cone in made] == list(range(1, len(made) + 1))
    assert len({cone.id for cone in made}) == len(made)
    assert {cone.colour for cone in made} <= set(COLOURS)
    assert all(cone.role for cone in made)
    assert min(math.dist((a.x, a.y), (b.x, b.y)) for a in made for b in made if a is not b) > 0.5


@pytest.mark.parametrize("name", LAYOUTS)
def test_every_dimension_changes_the_layout(name: str) -> None:
    kind = LAYOUTS[name]
    plain = kind.of({}).spots()
    for one in kind.dimensions():
        assert one.text
        other = next((c for c in one.choices if c != one.standard), one.standard + 2)
        given = {one.name: other}
        if one.name == "exit_factor":
            given = {one.name: 2.5}
        if one.name == "exit_margin":
            given = {one.name: 2.0}
        if one.name == "exit_least":
            given = {one.name: 4.0}
        assert kind.of(given).spots() != plain, f"{name}: {one.name} changes nothing"


def test_iso_3888_1_has_the_lengths_and_widths_of_table_1() -> None:
    # Table 1: 15, 30, 25, 25, 15 + 15 m; 1.1, 1.2, 1.3 times the width and 0.25 m; offset 3.5 m. 2 m wide:
    made = cones("iso3888_1", vehicle_width=2.0)
    along, right, left = limits(made, "entry")
    assert along == pytest.approx([0, 7.5, 15])
    assert (right, left) == pytest.approx((-1.225, 1.225))
    along, right, left = limits(made, "side")
    assert along == pytest.approx([45, 57.5, 70])
    assert (right, left) == pytest.approx((-1.225 + 3.5, -1.225 + 3.5 + 2.65))
    along, right, left = limits(made, "exit")
    assert along == pytest.approx([95, 110, 125])
    assert (right, left) == pytest.approx((-1.425, 1.425))
    assert len(made) == 18


def test_iso_3888_2_has_the_lengths_and_widths_of_table_1() -> None:
    # Table 1: 12, 13.5, 11, 12.5, 12 m, 61 m in all; widths 1.1 b + 0.25, b + 1,
    # max(1.3 b + 0.25, 3) m; 1 m between.
    made = cones("iso3888_2", vehicle_width=1.8)
    along, right, left = limits(made, "entry")
    assert along == pytest.approx([0, 6, 12])
    assert left - right == pytest.approx(2.23)
    side_along, side_right, side_left = limits(made, "side")
    assert side_along == pytest.approx([25.5, 31, 36.5])
    assert side_left - side_right == pytest.approx(2.8)
    assert side_right - left == pytest.approx(1.0)
    exit_along, exit_right, exit_left = limits(made, "exit")
    assert exit_along == pytest.approx([49, 55, 61])
    assert exit_left - exit_right == pytest.approx(3.0)
    assert exit_left == pytest.approx(left)


def test_a_wide_vehicle_gets_a_wider_exit_of_iso_3888_2() -> None:
    _, right, left = limits(cones("iso3888_2", vehicle_width=2.3), "exit")
    assert left - right == pytest.approx(3.24)


def test_a_lane_change_to_the_right_is_the_mirror_of_one_to_the_left() -> None:
    left, right = cones("iso3888_2"), cones("iso3888_2", turn=-1)
    assert row(right, "side right") == [(x, -y) for x, y in row(left, "side left")]
    assert min(y for _, y in row(right, "side right")) < -3


def test_the_slalom_is_156_m_long_with_nine_cones() -> None:
    made = cones("slalom")
    assert row(made, "slalom") == [(6.0 + 18 * k, 0.0) for k in range(9)]
    assert {x for x, _ in row(made, "finish left") + row(made, "finish right")} == {156.0}


def test_the_circle_has_its_radius_and_is_driven_round() -> None:
    made = cones("circle", radius=100, width=3.5)
    inner = [math.hypot(*place) for place in row(made, "inner")]
    outer = [math.hypot(*place) for place in row(made, "outer")]
    assert inner == pytest.approx([98.25 - HALF] * 63)
    assert outer == pytest.approx([101.75 + HALF] * 63)
    for cone in made:
        assert math.cos(cone.theta) * cone.x + math.sin(cone.theta) * cone.y == pytest.approx(0, abs=1e-9)
        assert math.cos(cone.theta) * -cone.y + math.sin(cone.theta) * cone.x > 0


def test_the_skid_pad_is_that_of_the_rules() -> None:
    # D 4.1: centres 18.25 m apart, circles of 15.25 and 21.25 m, 16 cones inside and 13 outside, path of 3 m.
    made = cones("fs_skidpad")
    for side, centre in (("left", 9.125), ("right", -9.125)):
        inner, outer = row(made, f"{side} inner"), row(made, f"{side} outer")
        assert [math.dist(place, (0, centre)) for place in inner] == pytest.approx([7.625 - HALF] * 16)
        assert [math.dist(place, (0, centre)) for place in outer] == pytest.approx([10.625 + HALF] * 13)
        assert len({(round(x, 6), round(y, 6)) for x, y in inner}) == 16
        # Between the circles one drives through: no cone of either stands in the path of 3 m.
        assert all(abs(y) >= 1.5 for _, y in inner + outer)
    for way in ("entry", "exit"):
        _, right, left = limits(made, way)
        assert (right, left) == pytest.approx((-1.5, 1.5))


def test_the_colours_of_the_skid_pad_are_blue_left_and_yellow_right() -> None:
    colour = {cone.role: cone.colour for cone in cones("fs_skidpad")}
    assert (colour["left inner"], colour["left outer"]) == ("blue", "yellow")
    assert (colour["right inner"], colour["right outer"]) == ("yellow", "blue")
    assert colour["timing"] == "big_orange"


def test_one_drives_to_the_right_first_and_past_each_cone_as_its_circle_goes() -> None:
    for cone in cones("fs_skidpad"):
        turn = {"left": 1, "right": -1}.get(cone.role.split()[0])
        if turn is None:
            continue
        x, y = cone.x, cone.y - turn * 9.125
        assert (math.cos(cone.theta) * -y + math.sin(cone.theta) * x) * turn > 0


def test_the_acceleration_is_that_of_the_rules() -> None:
    # D 5.1: 75 m from line to line, 3 m wide, cones about 5 m apart, 100 m to stop in.
    made = cones("fs_acceleration")
    along, right, left = limits(made, "track")
    assert along == pytest.approx([5.0 * k for k in range(1, 15)])
    assert (right, left) == pytest.approx((-1.5, 1.5))
    out, *_ = limits(made, "exit")
    assert (out[0], out[-1]) == (80.0, 175.0)
    assert row(made, "end") == [(175.0, 0.0)]
    assert limits(made, "finish")[0] == pytest.approx([74.7, 75.3])


def test_the_braking_lane_is_as_long_as_the_regulation_lets_cars_stop() -> None:
    # UN R13-H: 0.1 v + 0.006 v²: 70 m at 100 km/h, 20 m at 50 km/h.
    for speed, metres in ((100, 70.0), (50, 20.0)):
        made = cones("braking_lane", speed=speed, approach=20)
        assert row(made, "braking left")[0][0] == 20
        assert max(cone.x for cone in made) == pytest.approx(20 + metres)
    _, right, left = limits(made, "stopping")
    assert left - right == pytest.approx(3.5)


def test_the_corridor_has_pairs_evenly_apart() -> None:
    made = cones("corridor", length=12, spacing=5, width=4)
    along, right, left = limits(made, "")
    assert along == pytest.approx([0, 6, 12])
    assert left - right == pytest.approx(4)
    assert {cone.colour for cone in made if cone.y > 0} == {"blue"}


@pytest.mark.parametrize(
    ("name", "values", "reason"),
    [
        ("slalom", {"spacings": 3}, "slalom has no dimension 'spacings': give cone_base, count"),
        ("slalom", {"count": 2.5}, "count is 2.5: give a whole number"),
        ("slalom", {"spacing": 0}, "spacing is 0: give 0.5 or more"),
        ("iso3888_1", {"turn": 2}, "turn is 2: give one of -1, 1"),
        ("iso3888_1", {"vehicle_width": math.nan}, "vehicle_width is nan: give a number"),
        ("circle", {"radius": 1}, "the lane is wider than the circle"),
        ("slalom", {"count": 1e9}, "count is 1e.09: that makes 1000000000 cones, and a plan has 5000"),
        ("corridor", {"length": 1e300}, "length is 1e.300: that makes"),
        ("braking_lane", {"speed": 1e200}, "speed is 1e.200: that makes inf cones"),
        ("circle", {"radius": 1e9}, "radius is 1e.09: that makes"),
        ("iso3888_2", {"cones_per_row": 900}, "cones_per_row is 900: that makes 5400 cones"),
        ("fs_skidpad", {"outer_count": 2600}, "outer_count is 2600: that makes"),
        ("fs_acceleration", {"end_cones": 4990}, "end_cones is 4990: that makes"),
        ("fs_skidpad", {"inner": 30}, "give an outer circle larger than the inner one"),
    ],
)
def test_what_cannot_be_is_refused_with_what_to_give(
    name: str, values: dict[str, float], reason: str
) -> None:
    with pytest.raises(DimensionError, match=reason):
        LAYOUTS[name].of(values).cones()


@pytest.mark.parametrize("name", LAYOUTS)
def test_cones_are_counted_before_they_are_made(name: str) -> None:
    kind = LAYOUTS[name]
    counted = set(kind.of({}).cone_counts())
    # Each of them larger, one after the other, and what is a spacing smaller.
    for one in kind.dimensions():
        if one.name in counted or "spacing" in one.name:
            layout = kind.of({one.name: one.standard * (5 if one.name in counted else 0.5)})
            made = len(layout.spots())
            assert sum(layout.cone_counts().values()) == pytest.approx(made, abs=12), one.name


def test_with_the_width_of_a_real_acceleration_every_cone_stands_where_it_stood(data: Path) -> None:
    head, rows = read_csv(data / "cones" / "cone_layouts.csv")
    columns = ConeColumns(colour="colour", layout="track", only="fssim_acceleration")
    real = {(c.colour, round(c.x, 6), round(c.y, 6)) for c in cones_of(rows, head, columns, "real")}
    made = LAYOUTS["fs_acceleration"].of({"width": 3.8, "cone_base": 0}).cones()
    assert {(c.colour, round(c.x, 6), round(c.y, 6)) for c in made} == real


def test_with_the_size_of_a_real_skid_pad_every_cone_stands_within_2_cm_of_where_it_stood(data: Path) -> None:
    head, rows = read_csv(data / "cones" / "cone_layouts.csv")
    columns = ConeColumns(colour="colour", layout="track", only="eufs_skidpad")
    real = cones_of(rows, head, columns, "real")
    sizes = {"centres": 18.5, "inner": 15.225, "outer": 21.225, "path_width": 3.275, "cone_base": 0.0}
    made = LAYOUTS["fs_skidpad"].of(sizes).cones()
    # It is drawn along y there, and two cones are in it twice.
    places = {(c.colour, round(c.y, 6), round(-c.x, 6)) for c in real}
    assert len(made) == len(places) == 82
    for colour, x, y in places:
        assert min(math.dist((x, y), (c.x, c.y)) for c in made if c.colour == colour) < 0.02
