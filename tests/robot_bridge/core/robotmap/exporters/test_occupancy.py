"""The occupancy grid of a map, as nav2_map_server reads it."""

from __future__ import annotations

import numpy as np
import pytest
import shapely
from osgeo import gdal

from robot_bridge.core.robotmap.exporters.nav2 import RasterGrid, occupancy_of, scale_files, trinary_files
from robot_bridge.core.robotmap.model import ShapeType
from robot_bridge.core.robotmap.text_format import read_text, write_text

FREE, OCCUPIED, UNKNOWN = 0, 100, -1
NAV2_MAPS = ("depot", "depot_keepout", "depot_speed", "systest_map_circular")


@pytest.fixture
def read_grid(read_written):
    """Export a map and read it back as a robot does."""

    def read(robot_map, resolution=0.1, **choices):
        made = occupancy_of(robot_map, resolution, **choices)
        return read_written(trinary_files("map", made.grid, made.cells))

    return read


def test_every_place_is_where_the_map_has_it(make_map, house, read_grid):
    """The house has no symmetry: turned, mirrored or moved, one of these places would not agree."""
    made = read_grid(make_map([(house, {})], (10, 20, 30, 40)))
    assert (made.resolution, made.origin, made.cells.shape) == (0.1, (10.0, 20.0, 0.0), (200, 200))
    assert made.at(15.05, 21.05) == OCCUPIED
    assert made.at(14.05, 24.05) == OCCUPIED
    assert made.at(17.0, 21.5) == made.at(13.0, 25.5) == UNKNOWN
    assert made.at(17.0, 25.0) == made.at(11.5, 24.0) == made.at(15.0, 20.5) == FREE


def test_the_first_row_of_the_image_is_the_highest(make_map):
    wall = {"shape_type": ShapeType.OPEN_POLYGON, "semantics": "wall"}
    made = occupancy_of(make_map([([(0, 9.5), (3, 9.5)], wall)], (0, 0, 4, 10)), 1.0)
    image = trinary_files("map", made.grid, made.cells)["map.pgm"]
    assert image == b"P5\n4 10\n255\n" + bytes([0, 0, 0, 0]) + bytes([254] * 36)


def test_a_courtyard_is_free_and_what_is_round_it_unknown_or_occupied_on_request(make_map, read_grid):
    def square(low, high):
        return [(low, low), (high, low), (high, high), (low, high), (low, low)]

    rows = [
        (square(2, 18), {"source": "b:1"}),
        (square(6, 14), {"source": "b:1", "courtyard": True}),
    ]
    robot_map = make_map(rows, (0, 0, 20, 20))
    made = read_grid(robot_map)
    assert (made.at(10, 10), made.at(4, 10), made.at(1, 1)) == (FREE, UNKNOWN, FREE)
    filled = read_grid(robot_map, inside="occupied")
    assert (filled.at(10, 10), filled.at(4, 10), filled.at(1, 1)) == (FREE, OCCUPIED, FREE)


def test_of_what_is_all_around_a_map_its_courtyards_alone_are_free(make_map, read_grid):
    def square(low, high):
        return [(low, low), (high, low), (high, high), (low, high), (low, low)]

    rows = [(square(-50, 70), {"source": "b:1"})]
    rows += [(square(low, low + 4), {"source": "b:1", "courtyard": True}) for low in (2, 12)]
    rows += [(square(13, 15), {"source": "b:2"})]
    made = read_grid(make_map(rows, (0, 0, 20, 20)))
    assert (made.at(4, 4), made.at(12.5, 12.5), made.at(4, 14), made.at(14, 14)) == (
        FREE,
        FREE,
        UNKNOWN,
        UNKNOWN,
    )


def test_unknown_stays_unknown_at_the_thresholds_in_the_file(make_map, house, read_grid):
    made = occupancy_of(make_map([(house, {})], (10, 20, 30, 40)), 0.1)
    files = trinary_files("map", made.grid, made.cells)
    assert set(files["map.pgm"][-40000:]) == {0, 205, 254}
    assert (read_grid(make_map([(house, {})], (10, 20, 30, 40))).cells == made.cells).all()


@pytest.mark.parametrize("corner", [(0, 0), (3, 0), (0, 3)])
def test_a_building_that_the_border_cuts_is_not_free_inside(make_map, read_grid, corner):
    """A U, cut so that it becomes two chains, beside a house that is whole."""
    u = np.array([(2, 2), (12, 2), (12, 12), (9, 12), (9, 5), (5, 5), (5, 12), (2, 12), (2, 2)]) - corner
    hut = [(1, 14), (2, 14), (2, 15), (1, 15), (1, 14)]
    made = read_grid(make_map([(u, {"source": "b:1"}), (np.array(hut) - (0, 6.5), {})], (0, 0, 10, 9)), 0.1)
    polygon = shapely.Polygon(u)
    x, y = np.meshgrid(np.arange(100) * 0.1 + 0.05, np.arange(90) * 0.1 + 0.05)
    shapely.prepare(polygon)
    inside = shapely.contains_xy(polygon, x, y)
    assert inside.sum() > 1000
    assert (made.cells[inside] != FREE).all()
    assert (made.cells[~inside] != UNKNOWN).sum() > 3000


def test_a_wall_from_border_to_border_has_free_space_on_both_sides(make_map, read_grid, count_regions):
    wall = {"shape_type": ShapeType.OPEN_POLYGON, "semantics": "wall", "height": 2.0}
    hut = [(1, 1), (2, 1), (2, 2), (1, 2), (1, 1)]
    made = read_grid(make_map([([(-5, 5), (15, 6)], wall), (hut, {})], (0, 0, 10, 10)))
    assert made.at(5, 9) == made.at(5, 3) == FREE
    assert count_regions(made.cells == FREE) == 2


def test_a_wall_named_as_the_buildings_are_has_free_space_on_both_sides(make_map, read_grid):
    wall = {"shape_type": ShapeType.OPEN_POLYGON}
    hut = [(1, 1), (2, 1), (2, 2), (1, 2), (1, 1)]
    made = read_grid(make_map([([(-5, 5), (15, 6)], wall), (hut, {"source": "b:1"})], (0, 0, 10, 10)))
    assert made.at(5, 9) == made.at(5, 3) == FREE


def test_a_cut_building_is_not_free_inside_though_no_other_is_whole(make_map, read_grid):
    made = read_grid(make_map([([(2, 2), (12, 2), (12, 8), (2, 8), (2, 2)], {})], (0, 0, 10, 10)))
    assert made.at(6, 5) == UNKNOWN and made.at(1, 1) == FREE


def test_a_strict_map_cannot_tell_cut_buildings_and_a_warning_says_so(make_map):
    hut = [(1, 1), (2, 1), (2, 2), (1, 2), (1, 1)]
    cut = [(2, 4), (12, 4), (12, 8), (2, 8), (2, 4)]
    built = make_map([(hut, {}), (cut, {})], (0, 0, 10, 10))
    assert occupancy_of(built, 0.1).warnings == ()
    strict = read_text(write_text(built, strict=True))
    (warning,) = occupancy_of(strict, 0.1).warnings
    assert warning.startswith("1 obstacles, 2 the first, may be parts of rings that the border cut")
    assert occupancy_of(read_text(write_text(make_map([(hut, {})], (0, 0, 10, 10)))), 0.1).warnings == ()


def test_ramps_are_free_stairs_are_not_not_even_from_the_side(make_map, read_grid):
    ramp = ([(1, 1), (4, 1), (4, 3), (1, 3), (1, 1)], {"shape_type": ShapeType.RAMP, "height": 0.0})
    risers = [(6, 2), (8, 2), (6, 3), (8, 3), (6, 4), (8, 4)]
    stairs = (risers, {"shape_type": ShapeType.STAIRS, "height": 0.15})
    robot_map = make_map([ramp, stairs], (0, 0, 10, 6))
    made = read_grid(robot_map)
    assert made.at(1.02, 1.02) == made.at(2, 2) == FREE
    assert {made.at(6.02, y) for y in (2.5, 3.5)} == {OCCUPIED}
    assert {made.at(8.02, y) for y in (2.5, 3.5)} == {OCCUPIED}
    assert {made.at(7, y) for y in (2.02, 3.02, 4.02)} == {OCCUPIED}
    assert made.at(7, 2.5) == UNKNOWN


def test_what_a_robot_drives_over_is_free_on_request(make_map, read_grid):
    kerb = ([(0, 5), (10, 5)], {"shape_type": ShapeType.OPEN_POLYGON, "height": 0.05, "semantics": "kerb"})
    slab = ([(1, 1), (4, 1), (4, 3), (1, 3), (1, 1)], {"height": 0.04})
    stairs = (
        [(6, 2), (8, 2), (6, 3), (8, 3)],
        {"shape_type": ShapeType.STAIRS, "height": 0.15},
    )
    robot_map = make_map([kerb, slab, stairs], (0, 0, 10, 10))
    assert read_grid(robot_map).at(5, 5.02) == OCCUPIED
    over = read_grid(robot_map, drives_over=0.1)
    assert over.at(5, 5.02) == over.at(2, 2) == over.at(1.02, 2) == FREE
    assert over.at(7, 3.02) == OCCUPIED


def test_a_ring_that_does_not_close_is_drawn_and_named(read_written):
    """Fig. 2 of the paper announces a closed polygon and has one segment of it."""
    made = occupancy_of(
        read_text("border;\n-4;100;\n100;-4;\n#\nobstacle;\n1;1;1;column;\n#\n4;12;\n7;12;\n5;1;;\n#\n"), 0.5
    )
    assert made.warnings[0].startswith("obstacle 1 is a closed polygon and its segments do not close")
    assert (made.cells == OCCUPIED).sum() == 7


def test_cells_beyond_the_border_are_unknown(make_map, house, read_grid):
    made = read_grid(make_map([(house, {})], (10, 20, 30.2, 40)), 0.5)
    assert made.cells.shape == (40, 41)
    assert (made.cells[:, -1] == UNKNOWN).all() and made.cells[0, -2] == FREE


@pytest.mark.parametrize("name", NAV2_MAPS)
def test_nav2s_own_maps_come_back_as_they_were(data, read_nav2_file, read_written, name):
    """Read by the rules, written by this writer, read again: the robot has the same map."""
    theirs = read_nav2_file(data / "nav2" / "maps" / f"{name}.yaml")
    rows, columns = theirs.cells.shape
    grid = RasterGrid(theirs.origin[0], theirs.origin[1], theirs.resolution, columns, rows)
    write = scale_files if theirs.mode == "scale" else trinary_files
    ours = read_written(write(name, grid, theirs.cells))
    assert (ours.cells == theirs.cells).all()
    assert (ours.resolution, ours.origin, ours.mode) == (theirs.resolution, theirs.origin, theirs.mode)
    assert len(np.unique(theirs.cells)) > 1


def test_the_image_and_the_yaml_have_the_shape_of_nav2s_own(data, make_map, house):
    import yaml

    theirs = yaml.safe_load((data / "nav2" / "maps" / "depot.yaml").read_text())
    made = occupancy_of(make_map([(house, {})], (10, 20, 30, 40)))
    files = trinary_files("depot", made.grid, made.cells, {"crs": "EPSG:32633", "odd": "a\x01\nb"})
    ours = yaml.safe_load(files["depot.yaml"])
    assert list(ours) == list(theirs)
    assert [type(value) for value in ours.values()] == [type(value) for value in theirs.values()]
    assert (data / "nav2" / "maps" / "depot.pgm").read_bytes()[:2] == files["depot.pgm"][:2] == b"P5"


@pytest.mark.parametrize("name", ["site: 1", 'ein "Platz"', "- a", "Győr #2", "null", "1e3"])
def test_any_file_name_is_found_again(make_map, house, read_written, name):
    made = occupancy_of(make_map([(house, {})], (10, 20, 30, 40)), 0.5)
    assert read_written(trinary_files(name, made.grid, made.cells)).cells.shape == (40, 40)


def test_gdal_reads_the_image_that_pillow_reads(make_map, house, tmp_path):
    made = occupancy_of(make_map([(house, {})], (10, 20, 30, 40)), 0.1)
    (tmp_path / "map.pgm").write_bytes(trinary_files("map", made.grid, made.cells)["map.pgm"])
    pixels = gdal.Open(str(tmp_path / "map.pgm")).ReadAsArray()
    assert ((pixels[::-1] == 0) == (made.cells == OCCUPIED)).all()
    assert ((pixels[::-1] == 205) == (made.cells == UNKNOWN)).all()


def test_in_a_real_city_walls_are_closed_and_insides_are_not_free(data):
    """Helsinki, 200 m x 200 m: every cell in a building is not free, every cell far from all of them is."""
    import pyogrio

    from robot_bridge.core.robotmap.builder import build_map
    from robot_bridge.core.robotmap.model import Window
    from robot_bridge.core.robotmap.outlines import OutlineRow, Outlines

    box = (385800.0, 6671600.0, 386000.0, 6671800.0)
    _, ids, shapes, _ = pyogrio.raw.read(
        data / "osm" / "helsinki_centre_utm35n.gpkg", "buildings", columns=[], bbox=box, return_fids=True
    )
    rows, polygons = [], []
    for fid, shape in zip(ids, shapely.from_wkb(shapes, on_invalid="ignore"), strict=True):
        if shape is None or not shape.is_valid or shape.area == 0:
            continue
        for polygon in getattr(shape, "geoms", [shape]):
            polygons.append(polygon)
            for k, ring in enumerate([polygon.exterior, *polygon.interiors]):
                points = np.asarray(ring.coords)[:, :2]
                rows.append(
                    OutlineRow(points, ShapeType.CLOSED_POLYGON, 3.0, "building", f"b:{fid}", courtyard=k > 0)
                )
    robot_map = build_map(Outlines.from_rows(rows), Window.from_bounds(*box))
    made = occupancy_of(robot_map, 0.5)
    assert made.warnings == ()
    x, y = np.meshgrid(box[0] + np.arange(400) * 0.5 + 0.25, box[1] + np.arange(400) * 0.5 + 0.25)
    everything = shapely.union_all(polygons)
    centres = shapely.points(x, y)
    shapely.prepare(everything)
    inside = shapely.contains(everything.buffer(-0.02), centres)
    outside = shapely.disjoint(everything.buffer(0.75), centres)
    assert inside.sum() > 20_000 and outside.sum() > 20_000
    assert (made.cells[inside] != FREE).all()
    assert (made.cells[outside] == FREE).all()
