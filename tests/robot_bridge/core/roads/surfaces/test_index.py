"""The surface at a place, held against shapely."""

from __future__ import annotations

import numpy as np
import pyogrio.raw
import pytest
import shapely

from robot_bridge.core.errors import RoadInputError
from robot_bridge.core.roads.network import GENERATED, Surface
from robot_bridge.core.roads.surface_generation import polygon_of, rings_of
from robot_bridge.core.roads.surface_index import NOWHERE, SurfaceIndex


def ring(*corners):
    return np.array([*corners, corners[0]], float)


def box(x0, y0, x1, y1):
    return ring((x0, y0), (x1, y0), (x1, y1), (x0, y1))


def both_ways(index, xy):
    """Return what is told in bulk, after seeing that one by one the same is told."""
    bulk = index.at_many(xy)
    assert [index.at(x, y) for x, y in np.asarray(xy).tolist()] == bulk.tolist()
    return bulk


def expected(surfaces, xy):
    """Return what shapely says: drawn before generated, the smaller, the later."""
    shapes = np.array([polygon_of(one.rings) for one in surfaces])
    order = sorted(range(len(shapes)), key=lambda k: (surfaces[k].origin == GENERATED, shapes[k].area, -k))
    found = np.full(len(xy), NOWHERE)
    points = shapely.points(xy)
    for k in reversed(order):
        shapely.prepare(shapes[k])
        found[shapely.covers(shapes[k], points)] = k
    return found


def star(rng, x, y, size, corners):
    angles = np.sort(rng.uniform(0, 2 * np.pi, corners))
    reach = rng.uniform(0.3, 1.0, corners) * size
    return ring(*np.column_stack([x + np.cos(angles) * reach, y + np.sin(angles) * reach]))


@pytest.mark.parametrize("seed", range(6))
@pytest.mark.parametrize("shift", [0.0, 5e6])
def test_stars_with_holes_that_lie_on_one_another(seed, shift):
    rng = np.random.default_rng(seed)
    surfaces = []
    for _ in range(40):
        x, y = rng.uniform(0, 100, 2) + shift
        size = rng.choice([2.0, 15.0, 60.0])
        hole = (star(rng, x, y, 0.25 * size, 6),) if rng.random() < 0.5 else ()
        outer = star(rng, x, y, size, int(rng.integers(8, 60)))
        surfaces.append(Surface((outer, *hole), "a", origin=rng.choice(["drawn", "generated"])))
    # Holes that reach beyond their outer ring are in the test of what is broken.
    surfaces = [one for one in surfaces if shapely.Polygon(one.rings[0], one.rings[1:]).is_valid]
    assert len(surfaces) > 20
    places = rng.uniform(-60, 160, (5_000, 2)) + shift
    found = both_ways(SurfaceIndex(surfaces), places)
    assert (found == expected(surfaces, places)).all()
    assert 0.1 < (found == NOWHERE).mean() < 0.9


def test_places_on_whole_numbers_of_squares_on_whole_numbers():
    rng = np.random.default_rng(3)
    corners = rng.integers(0, 20, (60, 2))
    sizes = rng.integers(1, 6, (60, 2))
    surfaces = [Surface((box(*low, *(low + size)),), "a") for low, size in zip(corners, sizes, strict=True)]
    x, y = np.meshgrid(np.arange(-1.0, 28.0, 0.5), np.arange(-1.0, 28.0, 0.5))
    places = np.column_stack([x.ravel(), y.ravel()])
    assert (both_ways(SurfaceIndex(surfaces), places) == expected(surfaces, places)).all()


def test_slanted_shapes_on_whole_numbers_at_their_corners_and_between():
    rng = np.random.default_rng(4)
    surfaces = []
    while len(surfaces) < 60:
        shape = shapely.convex_hull(shapely.multipoints(rng.integers(0, 12, (6, 2)).astype(float)))
        if shape.geom_type == "Polygon":
            surfaces.append(Surface(rings_of(shape), "a"))
    x, y = np.meshgrid(np.arange(-1.0, 13.0, 0.5), np.arange(-1.0, 13.0, 0.5))
    places = np.column_stack([x.ravel(), y.ravel()])
    assert (both_ways(SurfaceIndex(surfaces), places) == expected(surfaces, places)).all()


def test_the_edge_of_a_surface_and_of_its_hole_is_on_it():
    index = SurfaceIndex([Surface((box(0, 0, 10, 10), box(4, 4, 6, 6)), "a")])
    on = [(0, 0), (10, 10), (10, 5), (3.3, 10), (4, 4), (6, 5), (5, 4), (0, 7.7)]
    off = [(5, 5), (4.001, 5), (10.001, 5), (-0.001, 5), (5, 10.001), (5, -0.001)]
    assert both_ways(index, on).tolist() == [0] * len(on)
    assert both_ways(index, off).tolist() == [NOWHERE] * len(off)


def test_drawn_before_generated_smaller_before_larger_later_before_earlier():
    large, small, made = box(0, 0, 30, 30), box(10, 10, 20, 20), box(12, 12, 14, 14)
    surfaces = [
        Surface((small,), "small"),
        Surface((large,), "large"),
        Surface((made,), "made", origin=GENERATED),
        Surface((small,), "later"),
        Surface((box(28, 28, 40, 40),), "beside", origin=GENERATED),
    ]
    index = SurfaceIndex(surfaces)
    places = [(13, 13), (5, 5), (29, 29), (35, 35), (50, 50)]
    labels = [surface.label if (surface := index.surface_at(*place)) else None for place in places]
    assert labels == ["later", "large", "large", "beside", None]


def test_a_hole_makes_a_surface_smaller_whichever_way_round_it_is_drawn():
    for hole in (box(11, 11, 19, 19), box(11, 11, 19, 19)[::-1]):
        ringed = Surface((box(10, 10, 20, 20), hole), "ringed")
        index = SurfaceIndex([ringed, Surface((box(5, 8.5, 12, 15.5),), "plain")])
        assert index.surface_at(10.5, 12).label == "ringed"


def test_what_crosses_itself_encloses_by_the_even_odd_rule_as_when_it_is_mended():
    bow = Surface((ring((0, 0), (10, 10), (10, 0), (0, 10)),), "bow")
    astray = Surface((box(20, 0, 30, 10), box(28, 4, 34, 6)), "hole beyond its ring")
    spike = Surface((ring((40, 0), (50, 0), (50, 10), (50, 15), (50, 10), (40, 10)),), "spike")
    surfaces = [bow, astray, spike]
    places = np.random.default_rng(5).uniform((-2, -2), (55, 20), (5_000, 2))
    assert (both_ways(SurfaceIndex(surfaces), places) == expected(surfaces, places)).all()


def test_rings_that_are_not_closed_repeated_points_and_rings_that_enclose_nothing():
    surfaces = [
        Surface((box(0, 0, 10, 10)[:-1],), "open"),
        Surface((np.repeat(box(20, 0, 30, 10), 3, axis=0),), "repeated"),
        Surface((ring((40, 0), (50, 0)),), "flat"),
        Surface((np.array([[60.0, 0.0]]),), "point"),
        Surface((np.empty((0, 2)),), "nothing"),
    ]
    index = SurfaceIndex(surfaces)
    places = [(5, 5), (25, 5), (45, 5), (45, 0), (60, 0), (60, 1), (0, 0)]
    assert both_ways(index, places).tolist() == [0, 1, NOWHERE, 2, 3, NOWHERE, 0]


@pytest.mark.parametrize("surfaces", [[], [Surface((), "none")], [Surface((np.empty((0, 2)),), "empty")]])
def test_where_there_is_nothing_there_is_nothing(surfaces):
    index = SurfaceIndex(surfaces)
    assert both_ways(index, [(0.0, 0.0), (1e9, -1e9)]).tolist() == [NOWHERE] * 2
    assert index.at_many(np.empty((0, 2))).tolist() == []


def test_places_that_are_none_are_nowhere():
    index = SurfaceIndex([Surface((box(0, 0, 10, 10),), "a")])
    places = [(np.nan, 5), (5, np.nan), (np.inf, 5), (5, -np.inf), (1e300, 1e300), (5, 5)]
    assert both_ways(index, places).tolist() == [NOWHERE] * 5 + [0]


def test_a_coordinate_that_is_no_number_is_refused_with_its_surface():
    bad = Surface((box(0, 0, np.nan, 10),), "gravel")
    with pytest.raises(RoadInputError, match=r"Surface 1 \(gravel\) has a coordinate that is no number"):
        SurfaceIndex([Surface((box(0, 0, 1, 1),), "a"), bad])


def test_one_surface_over_thousands_of_small_ones_costs_no_more_than_they_do():
    rng = np.random.default_rng(6)
    lows = rng.uniform(0, 1000, (2000, 2))
    surfaces = [Surface((box(x, y, x + 3, y + 3),), "small") for x, y in lows]
    surfaces += [Surface((box(-k, -k, 1000 + k, 1000 + k),), "large") for k in range(50)]
    index = SurfaceIndex(surfaces)
    places = rng.uniform(-60, 1060, (5000, 2))
    assert (both_ways(index, places) == expected(surfaces, places)).all()


@pytest.mark.parametrize(
    ("file", "layer"),
    [
        ("zalazone/university_track_surfaces_derived_utm33.gpkg", "surfaces"),
        ("zalazone/zalazone_lanelets_utm33.gpkg", "lanes"),
        ("osm/helsinki_centre_utm35n.gpkg", "areas"),
    ],
)
def test_real_areas_as_shapely_has_them(data, file, layer):
    _, _, wkb, _ = pyogrio.raw.read(data / file, layer=layer)
    with np.errstate(invalid="ignore"):
        parts = shapely.get_parts(shapely.from_wkb(wkb, on_invalid="ignore"))
    parts = parts[(shapely.get_type_id(parts) == 3) & ~shapely.is_empty(parts)]
    surfaces = [Surface(rings_of(shapely.force_2d(part)), "a") for part in parts]
    places = np.random.default_rng(7).uniform(*(shapely.total_bounds(parts).reshape(2, 2)), size=(5_000, 2))
    found = both_ways(SurfaceIndex(surfaces), places)
    told = expected(surfaces, places)
    valid = np.append(shapely.is_valid(parts), True)
    # Where a broken ring winds twice round a place mending it is a matter of taste.
    assert (found == told)[valid[found] & valid[told]].all()
    assert (found != NOWHERE).mean() > 0.02
