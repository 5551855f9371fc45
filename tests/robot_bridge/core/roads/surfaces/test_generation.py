"""Surfaces made of centrelines: areas and corners that can be told by hand, and a real track."""

from __future__ import annotations

import sys
from itertools import combinations

import numpy as np
import pyogrio.raw
import pytest
import shapely

from robot_bridge.core.errors import RoadsCancelledError, RoadsError
from robot_bridge.core.roads.network import DRAWN, FORWARD, GENERATED, Surface, centrelines
from robot_bridge.core.roads.surface_generation import generate_surfaces, polygon_of
from robot_bridge.core.roads.surface_index import NOWHERE, SurfaceIndex
from robot_bridge.core.sites.site import read_site


def shapes(surfaces):
    return {one.label: shapely.union_all([polygon_of(s.rings) for s in surfaces if s.label == one.label])
            for one in surfaces}  # fmt: skip


def outline(*corners):
    return shapely.Polygon(corners)


def same(a, b):
    return a.symmetric_difference(b).area < 1e-6


def test_a_road_is_a_strip_of_its_width_with_square_ends():
    (made,) = generate_surfaces(centrelines([[(0, 0), (10, 0)]], width=4.0, surface="asphalt"))
    assert same(polygon_of(made.rings), shapely.box(0, -2, 10, 2))
    assert (made.label, made.origin) == ("asphalt", GENERATED)


CORNER = outline((0, -2), (12, -2), (12, 10), (8, 10), (8, 2), (0, 2))


@pytest.mark.parametrize(
    "lines",
    [
        [[(0, 0), (10, 0), (10, 10)]],
        [[(0, 0), (10, 0)], [(10, 0), (10, 10)]],
        [[(10, 0), (0, 0)], [(10, 10), (10, 0)]],
        [[(0, 0), (10, 0)], [(10, 0.0005), (10, 10)]],
    ],
)
def test_a_corner_is_mitred_within_a_road_and_where_two_end_in_one_point(lines):
    made = generate_surfaces(centrelines(lines, width=4.0, surface="asphalt"))
    assert len(made) == 1
    assert polygon_of(made[0].rings).symmetric_difference(CORNER).area < 0.01


def test_a_sharp_corner_is_cut_off_at_twice_half_the_width():
    (made,) = generate_surfaces(centrelines([[(0, 0), (100, 0), (0, 10)]], width=4.0))
    # Uncut it would reach 40 m further.
    assert 103 < np.array(made.rings[0])[:, 0].max() < 104.2


def test_a_merge_leaves_no_spike_beyond_its_node():
    lines = [[(0, 0), (50, 0)], [(0, 10), (50, 0)], [(50, 0), (100, 0)]]
    whole = shapes(generate_surfaces(centrelines(lines, width=4.0)))[""]
    assert whole.intersection(shapely.box(52, -50, 100, 50)).area == pytest.approx(48 * 4, abs=1e-6)


def test_roads_that_turn_back_into_each_other_have_no_tip_beyond_their_node():
    lines = [[(0, 0), (50, 0)], [(50, 0), (0, 20)]]
    whole = shapes(generate_surfaces(centrelines(lines, width=4.0)))[""]
    strips = [shapely.LineString(line).buffer(2.0, cap_style="flat") for line in lines]
    assert same(whole, shapely.union_all(strips))


def test_the_corner_of_two_widths_is_as_wide_as_the_narrower():
    lines = [[(0, 0), (10, 0)], [(10, 0), (10, 10)]]
    whole = shapes(generate_surfaces(centrelines(lines, width=[4.0, 2.0])))[""]
    boxes = [(0, -2, 10, 2), (9, 0, 11, 10), (10, -1, 11, 0)]
    assert same(whole, shapely.union_all([shapely.box(*box) for box in boxes]))


def test_a_corner_takes_nothing_from_a_wider_road_of_another_class():
    lines = [[(0, 0), (40, 0)], [(20, -30), (20, 0)], [(40, 0), (80, 0)]]
    roads = centrelines(lines, width=[16.0, 6.0, 16.0], surface=["parking pavement", "asphalt", "gravel"])
    whole = shapes(generate_surfaces(roads))
    assert same(whole["asphalt"], shapely.box(17, -30, 23, 0))
    two = [[(0, 0), (20, 0)], lines[1], [(20, 0), (40, 0)]]
    apart = centrelines(two, [16.0, 6.0, 16.0], ["parking pavement", "asphalt", "parking pavement"])
    assert same(shapes(generate_surfaces(apart))["asphalt"], shapely.box(17, -30, 23, 0))
    aside = centrelines([lines[0], [(40, -30), (40, 0)]], [16.0, 6.0], ["parking pavement", "asphalt"])
    whole = shapes(generate_surfaces(aside))
    assert same(whole["parking pavement"], shapely.box(0, -8, 40, 8) - shapely.box(37, -30, 43, 0))
    assert same(whole["asphalt"], shapely.box(37, -30, 43, 0) | shapely.box(40, 0, 43, 3))


def test_slits_between_lanes_that_almost_touch_are_closed():
    lines = [[(0, 0), (30, 0)], [(0, 3.02), (30, 3.02)], [(0, -2), (0, 5)], [(30, -2), (30, 5)]]
    (made,) = generate_surfaces(centrelines(lines, width=3.0))
    assert len(made.rings) == 1


def test_roads_that_cross_are_one_surface_with_the_holes_that_they_enclose():
    square = [[(0, 0), (20, 0)], [(20, 0), (20, 20)], [(20, 20), (0, 20)], [(0, 20), (0, 0)]]
    (made,) = generate_surfaces(centrelines([*square, [(-10, 10), (30, 10)]], width=4.0, surface="asphalt"))
    assert len(made.rings) == 3
    assert polygon_of(made.rings).area == pytest.approx(24 * 24 - 2 * 16 * 6 + 2 * 8 * 4)


ROADS = centrelines(
    [[(0, 0), (100, 0)], [(50, -20), (50, 20)], [(80, -20), (80, 20)], [(20, -20), (20, 20)]],
    width=[6.0, 4.0, 8.0, 5.0],
    surface=["asphalt", "slippery", "Parking_pavement", "gravel"],
)


def test_classes_are_kept_apart_and_the_first_in_the_order_keeps_the_ground():
    whole = shapes(generate_surfaces(ROADS))
    strips = {
        "asphalt": shapely.box(0, -3, 100, 3),
        "slippery": shapely.box(48, -20, 52, 20),
        "Parking_pavement": shapely.box(76, -20, 84, 20),
        "gravel": shapely.box(17.5, -20, 22.5, 20),
    }
    assert same(whole["slippery"], strips["slippery"])
    assert same(whole["asphalt"], strips["asphalt"] - strips["slippery"])
    assert same(whole["Parking_pavement"], strips["Parking_pavement"] - strips["asphalt"])
    assert same(whole["gravel"], strips["gravel"] - strips["asphalt"])


def test_the_order_can_be_another_and_without_one_less_ground_goes_first():
    given = shapes(generate_surfaces(ROADS, precedence=["gravel", "parking pavement"]))
    assert given["gravel"].area == pytest.approx(200)
    assert given["Parking_pavement"].area == pytest.approx(320)
    assert given["slippery"].area == pytest.approx(160)
    assert given["asphalt"].area == pytest.approx(600 - 30 - 48 - 24)


def test_ground_without_a_class_goes_last():
    roads = centrelines([[(0, 0), (10, 0)], [(0, 0), (100, 0)]], width=4.0, surface=["", "sand"])
    whole = shapes(generate_surfaces(roads))
    assert set(whole) == {"sand"}


def test_what_was_drawn_keeps_its_ground_whatever_its_class():
    square = np.array([(40, -10), (60, -10), (60, 10), (40, 10), (40, -10)], float)
    patch = Surface((square,), "sand", "Patch")
    broken = Surface((np.array([(0, 30), (9, 39), (9, 30), (0, 39), (0, 30)], float),), "bow")
    made = generate_surfaces(ROADS, [patch, broken])
    assert all(polygon_of(one.rings).intersection(polygon_of(patch.rings)).area < 1e-9 for one in made)
    index = SurfaceIndex([*made, patch, broken])
    assert index.surface_at(50, 0).origin == DRAWN
    assert index.surface_at(50, 15).label == "slippery"


def test_no_ground_is_in_two_surfaces_and_none_is_lost():
    random = np.random.default_rng(8)
    lines = random.uniform(0, 100, (60, 3, 2))
    names = random.choice(["asphalt", "slippery", "sand", "stone", ""], 60)
    roads = centrelines(lines, width=random.uniform(2, 6, 60), surface=names)
    made = [polygon_of(one.rings) for one in generate_surfaces(roads)]
    assert all(a.intersection(b).area < 1e-6 for a, b in combinations(made, 2))
    strips = [
        shapely.LineString(line).buffer(width / 2, cap_style="flat", join_style="mitre", mitre_limit=2)
        for line, width in zip(lines, roads.width, strict=True)
    ]
    assert shapely.union_all(strips).difference(shapely.union_all(made)).area < 60 * 0.01


def test_it_can_be_cancelled_and_tells_how_far_it_is():
    shares = []
    generate_surfaces(ROADS, progress=lambda share: shares.append(share) or True)
    assert shares == sorted(shares) and shares[-1] == pytest.approx(1.0)
    with pytest.raises(RoadsCancelledError):
        generate_surfaces(ROADS, progress=lambda share: share < 0.5)


def test_without_roads_there_are_no_surfaces():
    assert generate_surfaces(centrelines([])) == []


def test_without_shapely_it_says_what_to_install(monkeypatch):
    monkeypatch.setitem(sys.modules, "shapely", None)
    with pytest.raises(RoadsError, match="shapely 2 is missing"):
        generate_surfaces(ROADS)


def test_the_real_track_of_its_lanes_and_a_real_drive_on_it(data):
    """The figures themselves stand in docs/benchmarks.md."""
    where = "module = 'university_track'"
    lanes = data / "zalazone" / "zalazone_lanelets_utm33.gpkg"
    meta, _, wkb, columns = pyogrio.raw.read(lanes, layer="centrelines", where=where)
    width = dict(zip(meta["fields"], columns, strict=True))["width_m"]
    lines = [shapely.get_coordinates(line) for line in shapely.from_wkb(wkb)]
    made = generate_surfaces(centrelines(lines, width=width, surface="asphalt", direction=FORWARD))
    whole = shapely.union_all([polygon_of(one.rings) for one in made])
    _, _, wkb, _ = pyogrio.raw.read(data / "zalazone" / "university_track_surfaces_derived_utm33.gpkg")
    digitised = shapely.union_all(shapely.from_wkb(wkb))
    assert len(lines) == 110
    assert whole.intersection(digitised).area / whole.union(digitised).area > 0.85
    _, _, wkb, _ = pyogrio.raw.read(lanes, layer="lanes", where=where)
    theirs = shapely.union_all(shapely.from_wkb(wkb))
    assert whole.intersection(theirs).area / whole.union(theirs).area > 0.87
    drive = np.genfromtxt(data / "zalazone" / "uni_track_drive_utm33.csv", delimiter=",", names=True)
    places = np.column_stack([drive["x_utm33"], drive["y_utm33"]])
    assert len(places) == 232
    assert (SurfaceIndex(made).at_many(places) != NOWHERE).mean() > 0.95


def test_the_sample_sites_roads_make_the_surfaces_that_are_drawn_there_but_for_rounded_kerbs(root):
    site = read_site(root / "resources" / "sample_site")
    lines = site.centrelines
    made = shapes(
        generate_surfaces(
            centrelines(
                [line.points for line in lines],
                width=[line.width_m for line in lines],
                surface=[line.surface for line in lines],
            )
        )
    )
    drawn = shapes(site.surfaces)
    assert set(made) == set(drawn)
    for name, least in {"asphalt": 0.98, "parking pavement": 0.98, "slippery": 0.999}.items():
        both = made[name].intersection(drawn[name]).area
        assert both / made[name].union(drawn[name]).area > least, name
