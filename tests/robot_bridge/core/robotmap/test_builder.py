"""Building maps: orientation, clipping without invented walls, chains, ids, and what is left out and why."""

from __future__ import annotations

import math

import numpy as np
import pytest
import shapely
from hypothesis import given
from hypothesis import strategies as st

from robot_bridge.core.errors import WindowError
from robot_bridge.core.robotmap.builder import build_map
from robot_bridge.core.robotmap.model import Border, ShapeType, Window
from robot_bridge.core.robotmap.outlines import OutlineRow, Outlines
from robot_bridge.core.robotmap.text_format import write_text

SQUARE = [(0, 0), (10, 0), (10, 10), (0, 10), (0, 0)]
POLYGON, CURVE, WALL = ShapeType.CLOSED_POLYGON, ShapeType.CLOSED_CURVE, ShapeType.OPEN_POLYGON


def row(points, shape_type=POLYGON, **more):
    values = {"height": 3.0, "semantics": "building,A", "source": "buildings:1", **more}
    return OutlineRow(np.array(points, dtype=float), shape_type, **values)


def made(*rows, window=None):
    return build_map(Outlines.from_rows(rows), window)


def area_of(obstacle):
    (x1, y1), (x2, y2) = obstacle.a.T, obstacle.b.T
    return float((x1 * y2 - x2 * y1).sum() / 2)


def lines_of(obstacles):
    return shapely.union_all(
        [shapely.LineString([a, b]) for o in obstacles for a, b in zip(o.a, o.b, strict=True)]
    )


@pytest.mark.parametrize("points", [SQUARE, SQUARE[::-1]])
@pytest.mark.parametrize("courtyard", [False, True])
def test_free_space_is_to_the_right_whichever_way_a_ring_was_drawn(points, courtyard):
    (obstacle,) = made(row(points, courtyard=courtyard)).obstacles
    assert area_of(obstacle) == (-100 if courtyard else 100)
    middle, step = (obstacle.a + obstacle.b) / 2, obstacle.b - obstacle.a
    right = middle + np.column_stack([step[:, 1], -step[:, 0]]) / 10
    inside = shapely.contains_xy(shapely.Polygon(SQUARE), right)
    assert inside.all() if courtyard else not inside.any()


def test_a_ring_inside_the_window_stays_one_closed_obstacle():
    robot_map = made(row(SQUARE), window=Window(5, 5, 30, 30))
    (obstacle,) = robot_map.obstacles
    assert obstacle.shape_type is POLYGON and len(obstacle.a) == 4
    assert (obstacle.b == np.roll(obstacle.a, -1, axis=0)).all()
    assert robot_map.border == Border(-10, -10, 20, 20)


def test_a_cut_ring_is_open_and_has_no_wall_on_the_border():
    (obstacle,) = made(row(SQUARE), window=Window(10, 5, 10, 30)).obstacles
    assert obstacle.shape_type is WALL
    assert obstacle.a.tolist() == [[5, 0], [10, 0], [10, 10]]
    assert obstacle.b.tolist() == [[10, 0], [10, 10], [5, 10]]


def test_a_chain_goes_on_across_the_point_where_its_ring_begins():
    (obstacle,) = made(row(SQUARE), window=Window(0, 0, 10, 10)).obstacles
    assert obstacle.a.tolist() == [[0, 5], [0, 0]] and obstacle.b.tolist() == [[0, 0], [5, 0]]


def test_a_ring_cut_in_two_becomes_two_obstacles_with_different_ids_and_one_source():
    first, second = made(row(SQUARE), row(SQUARE, source="b:2"), window=Window(5, 5, 30, 4)).obstacles[:2]
    assert first.id == 1 and second.id not in (1, 2)
    assert first.ext == second.ext == {"src": "buildings:1", "cut": "1"}


def test_only_rings_are_marked_as_cut_and_only_where_they_are_and_never_in_strict_text():
    wall, ramp = row([(-20, 5), (20, 5)], WALL), row(SQUARE, ShapeType.RAMP, height=0)
    robot_map = made(wall, row(SQUARE), ramp, window=Window(5, 5, 10, 4))
    marked = {(o.shape_type, o.ext.get("cut")) for o in robot_map.obstacles}
    assert marked == {(WALL, None), (WALL, "1"), (ShapeType.RAMP, "1")}
    assert all("cut" not in o.ext for o in made(wall, row(SQUARE)).obstacles)
    assert "cut" in write_text(robot_map) and "cut" not in write_text(robot_map, strict=True)


def test_a_cut_curve_is_an_open_curve_and_a_whole_one_is_closed():
    circle = [(5 * math.cos(a), 5 * math.sin(a)) for a in np.linspace(0, math.tau, 33)]
    assert made(row(circle, CURVE)).obstacles[0].shape_type is CURVE
    cut = made(row(circle, CURVE), window=Window(5, 0, 10, 20)).obstacles
    assert [o.shape_type for o in cut] == [ShapeType.OPEN_CURVE]


def test_a_wall_on_the_border_stays():
    (obstacle,) = made(row([(0, 0), (10, 0)], WALL), window=Window(5, 5, 20, 10)).obstacles
    assert obstacle.a.tolist() == [[0, 0]] and obstacle.b.tolist() == [[10, 0]]


def test_what_only_touches_the_window_is_not_in_the_map():
    assert made(row(SQUARE), window=Window(15, 15, 10, 10)).obstacles == ()


def test_stairs_are_one_segment_a_riser_and_end_with_height_0():
    risers = [(0, 0), (2, 0), (0, 0.3), (2, 0.3), (0, 0.6), (2, 0.6)]
    (stairs,) = made(row(risers, ShapeType.STAIRS, height=0.17, semantics="stairs")).obstacles
    assert stairs.shape_type is ShapeType.STAIRS
    assert stairs.a.tolist() == [[0, 0], [0, 0.3], [0, 0.6]]
    assert stairs.height.tolist() == [0.17, 0.17, 0]


def test_obstacles_are_grouped_by_type_and_keep_their_order_within_it():
    rows = [
        row(SQUARE, semantics=s, source=f"s:{n}")
        for n, s in enumerate(["wall", "building,B", "wall,x", "building,A"])
    ]
    assert [o.semantics for o in made(*rows).obstacles] == ["building,B", "building,A", "wall", "wall,x"]


def test_ids_do_not_depend_on_the_window():
    rows = [row(np.array(SQUARE) + 20 * n, source=f"b:{n}") for n in range(5)]
    whole = {o.ext["src"]: o.id for o in made(*rows).obstacles}
    (one,) = made(*rows, window=Window(65, 65, 15, 15)).obstacles
    assert whole[one.ext["src"]] == one.id


def test_no_id_means_another_building_in_another_window():
    comb = [
        (0, 0),
        (30, 0),
        (30, 9),
        (26, 9),
        (26, 2),
        (17, 2),
        (17, 9),
        (13, 9),
        (13, 2),
        (4, 2),
        (4, 9),
        (0, 9),
    ]
    rows = [row(np.add([*comb, comb[0]], (0, 20 * n)), source=f"b:{n}") for n in range(3)]
    sources: dict[int, set[str]] = {}
    for low in range(0, 60, 2):
        found = made(*rows, window=Window(15, low, 40, 11)).obstacles
        assert len({obstacle.id for obstacle in found}) == len(found)
        for obstacle in found:
            sources.setdefault(obstacle.id, set()).add(obstacle.ext["src"])
    assert len(sources) > 6 and all(len(names) == 1 for names in sources.values())


def test_segments_shorter_than_a_centimetre_vanish_and_the_chain_holds():
    points = [(0, 0), (5, 0), (5.001, 0.001), (10, 0), (10, 10), (0, 10), (0, 0)]
    (obstacle,) = made(row(points), window=Window(5, 5, 30, 30)).obstacles
    assert obstacle.shape_type is POLYGON and len(obstacle.a) == 5
    assert (obstacle.b == np.roll(obstacle.a, -1, axis=0)).all()


@pytest.mark.parametrize(
    ("bad", "reason"),
    [
        (row([(0, 0), (float("nan"), 0), (1, 1), (0, 0)], source="layer:7"), "not a finite number"),
        (row(SQUARE, height=float("inf"), source="layer:7"), "not a finite number"),
        (row([(0, 0), (1, 1), (0, 0)], source="layer:7"), "too few points"),
        (row([(0, 0)], WALL, source="layer:7"), "too few points"),
        (row([(0, 0), (1, 1), (2, 2), (0, 0)], source="layer:7"), "encloses nothing"),
        (row([(0, 0), (1, 0), (0, 1)], ShapeType.STAIRS, source="layer:7"), "pairs of points"),
    ],
)
def test_what_is_no_obstacle_is_left_out_with_a_warning_that_names_it(bad, reason):
    robot_map = made(row(SQUARE), bad)
    assert [o.id for o in robot_map.obstacles] == [1]
    (warning,) = robot_map.warnings
    assert warning.startswith("layer:7: ") and reason in warning


@pytest.mark.parametrize("width", [0, -1, math.nan, math.inf])
def test_an_empty_window_is_refused(width):
    with pytest.raises(WindowError, match="width is"):
        Window(0, 0, width, 10)
    with pytest.raises(WindowError):
        Window.square(0, 0, width)


def test_no_outlines_and_no_window_is_refused():
    with pytest.raises(WindowError, match="give a window"):
        made()
    assert made(window=Window(0, 0, 1, 1)).obstacles == ()


coordinate = st.integers(-3000, 3000).map(lambda n: n / 100)


@st.composite
def polygons(draw):
    """A simple polygon, possibly with a courtyard, on whole centimetres."""
    x, y = draw(coordinate), draw(coordinate)
    count = draw(st.integers(3, 9))
    angles = np.linspace(0, math.tau, count, endpoint=False) + draw(st.floats(0, 1))
    radii = np.array(draw(st.lists(st.floats(2, 15), min_size=count, max_size=count)))
    ring = np.round(np.column_stack([x + radii * np.cos(angles), y + radii * np.sin(angles)]), 2)
    return np.vstack([ring, ring[:1]])[:: draw(st.sampled_from([1, -1]))]


@given(
    st.lists(polygons(), min_size=1, max_size=4),
    coordinate,
    coordinate,
    st.integers(100, 4000),
    st.integers(100, 4000),
)
def test_a_window_holds_exactly_what_shapely_says_of_every_outline(rings, x, y, width, height):
    rings = [ring for ring in rings if shapely.Polygon(ring).is_valid]
    window = Window(x, y, width / 100, height / 100)
    border = window.border
    box = shapely.box(*border)
    robot_map = made(*(row(ring, source=f"b:{n}") for n, ring in enumerate(rings)), window=window)
    for n, ring in enumerate(rings):
        mine = [o for o in robot_map.obstacles if o.ext["src"] == f"b:{n}"]
        wanted = shapely.intersection(shapely.LineString(ring), box)
        wanted = shapely.union_all([part for part in shapely.get_parts(wanted) if part.length > 0.03])
        found = lines_of(mine)
        assert shapely.length(shapely.difference(wanted, shapely.buffer(found, 0.02))) < 0.05
        assert (
            shapely.length(shapely.difference(found, shapely.buffer(shapely.LineString(ring), 0.02))) < 0.05
        )
        assert found.is_empty or shapely.covers(shapely.buffer(box, 0.006), found)
        for obstacle in mine:
            assert (obstacle.b[:-1] == obstacle.a[1:]).all()
            assert is_on_the_left(ring, obstacle)


def is_on_the_left(ring, obstacle):
    """The inside of the building is to the left of each segment long enough to tell."""
    step = obstacle.b - obstacle.a
    length = np.hypot(*step.T)
    long = length > 0.5
    middle = (obstacle.a + obstacle.b)[long] / 2
    left = middle + np.column_stack([-step[long, 1], step[long, 0]]) / length[long, None] * 0.03
    return shapely.contains_xy(shapely.buffer(shapely.Polygon(ring), 0.02), left).all()
