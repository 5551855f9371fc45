"""``fleet:exportrobotmaptiles``: all tiles and their index, or nothing."""

from __future__ import annotations

import os
from itertools import pairwise

import numpy as np
import pytest
from fleet_supervisor.plugin.processing.algorithms.export_robot_map_tiles import (
    TileSize,
    area_of,
    grid_tiles,
    route_tiles,
)
from fleet_supervisor.plugin.processing.common.algorithm import ParameterError
from fleet_supervisor.robot_bridge.core.robotmap.binary import decode
from fleet_supervisor.robot_bridge.core.robotmap.model import Border
from fleet_supervisor.robot_bridge.core.robotmap.text_format import read_text
from qgis.core import (
    QgsProcessingContext,
    QgsProcessingException,
    QgsProcessingOutputLayerDefinition,
    QgsProject,
    QgsVectorLayer,
)

from tests.support.errors import StageError
from tests.support.faults.disk import Disk

UTM = "EPSG:32633"
EXTENT = "600000,600100,5100000,5100060"


@pytest.fixture
def wall(make_layer):
    """A wall through the whole area, and one that is not in it."""
    return make_layer(
        "walls",
        features=[
            ("LineString(600000 5100030, 600100 5100030)", 2.0),
            ("LineString(600500 5100500, 600510 5100500)", 2.0),
        ],
    )


@pytest.fixture
def tiles(provider, tmp_path, listener):
    """Run the algorithm and return its outputs; the tiles are in the folder ``out``."""
    import processing

    project = QgsProject()

    def run(*layers, feedback=None, **parameters):
        context = QgsProcessingContext()
        context.setProject(project)
        everything = {
            "OBSTACLES": list(layers),
            "OUTPUT": str(tmp_path / "out"),
            "INDEX": "memory:",
            "SITE_CRS": UTM,
            "OVERLAP": 0,
            **parameters,
        }
        return processing.run(
            "fleet:exportrobotmaptiles", everything, context=context, feedback=feedback or listener
        )

    return run


def names(folder):
    return sorted(file.name for file in folder.iterdir())


def contents(folder):
    return {file.name: file.read_bytes() for file in folder.iterdir()} if folder.exists() else None


def test_a_grid_covers_the_area_and_neighbours_share_the_overlap():
    area = Border(3.0, 5.0, 103.0, 65.0)
    plain = grid_tiles(area, TileSize(50, 30))
    assert [(tile.row, tile.column) for tile in plain] == [(1, 1), (1, 2), (2, 1), (2, 2)]
    assert area_of(plain) == area
    assert plain[0].window.border == Border(3.0, 5.0, 53.0, 35.0)
    shared = grid_tiles(area, TileSize(50, 30, 10))
    assert {tile.window.border.x_min for tile in shared} == {3.0, 43.0, 83.0}
    assert area_of(shared).x_max >= 103.0 and area_of(shared).y_max >= 65.0


@pytest.mark.parametrize("angle", np.linspace(0, np.pi / 2, 7))
def test_a_route_lies_in_its_tiles_and_they_share_at_least_the_overlap(angle):
    along = np.array([[0.0, 0.0], [0.4, 0.0], [0.4, 0.6], [1.0, 0.7]]) * 300
    turn = np.array([[np.cos(angle), np.sin(angle)], [-np.sin(angle), np.cos(angle)]])
    made = route_tiles([along @ turn], TileSize(60, 40, 10))
    borders = np.array([tile.window.border for tile in made])
    steps = np.abs(np.diff(borders[:, :2], axis=0))
    assert (steps <= (50.01, 30.01)).all()
    dense = np.concatenate([a + (b - a) * np.linspace(0, 1, 500)[:, None] for a, b in pairwise(along @ turn)])
    inside = ((dense[:, None] >= borders[:, :2] + 4.9) & (dense[:, None] <= borders[:, 2:] - 4.9)).all(axis=2)
    assert inside.any(axis=1).all()
    assert made[0].along == 0 and made[-1].along == pytest.approx(482.48)


def test_where_two_routes_meet_there_is_one_tile():
    first, second = np.array([[0.0, 0.0], [100.0, 0.0]]), np.array([[100.0, 0.0], [100.0, 100.0]])
    assert len(route_tiles([first, second], TileSize(50, 50))) == 3 + 2


@pytest.mark.parametrize("size", [(0, 50, 0), (50, float("nan"), 0), (50, 50, 46), (50, 50, -1)])
def test_a_tile_without_a_size_is_refused(size):
    with pytest.raises(ParameterError):
        TileSize(*size)


def test_too_many_tiles_are_refused():
    with pytest.raises(ParameterError, match="1000000 tiles, and 10000 are the most"):
        grid_tiles(Border(0, 0, 1000, 1000), TileSize(1, 1))


def test_every_tile_is_a_file_and_a_feature_with_its_border_counts_and_bytes(tiles, wall, tmp_path):
    results = tiles(wall, EXTENT=EXTENT, TILE_WIDTH=50, TILE_HEIGHT=30)
    features = list(results["INDEX"].getFeatures())
    assert names(tmp_path / "out") == sorted(f["file"] for f in features)
    assert len(features) == results["TILE_COUNT"] == 4
    assert results["INDEX"].crs().authid() == UTM
    for feature in features:
        file = tmp_path / "out" / feature["file"]
        robot_map = read_text(file.read_text())
        assert feature["bytes"] == file.stat().st_size
        assert (feature["obstacles"], feature["segments"]) == (
            len(robot_map.obstacles),
            robot_map.segment_count,
        )
        assert tuple(robot_map.border) == tuple(feature[n] for n in ("x_min", "y_min", "x_max", "y_max"))
        box = feature.geometry().boundingBox()
        assert (box.xMinimum(), box.yMaximum()) == (feature["x_min"], feature["y_max"])
    assert results["BYTES"] == sum(f["bytes"] for f in features)


def test_an_obstacle_keeps_its_id_in_every_tile_and_nothing_of_it_is_lost(tiles, make_layer, tmp_path):
    walls = make_layer(
        "walls",
        features=[
            ("LineString(600010 5100010, 600020 5100010)", 2.0),
            ("LineString(600000 5100020, 600100 5100020)", 2.0),
        ],
    )
    tiles(walls, EXTENT=EXTENT, TILE_WIDTH=50, TILE_HEIGHT=60)
    maps = [read_text(file.read_text()) for file in sorted((tmp_path / "out").iterdir())]
    assert [[o.id for o in m.obstacles] for m in maps] == [[1, 2], [2]]
    long = [o for m in maps for o in m.obstacles if o.id == 2]
    assert [(o.a[0, 0], o.b[-1, 0]) for o in long] == [(600000, 600050), (600050, 600100)]


def test_a_tile_is_what_the_export_of_its_window_writes(tiles, export, make_layer, tmp_path):
    # The export reads what touches its window; here that is every feature, so the ids agree, too.
    houses = make_layer(
        "houses",
        "Polygon",
        features=[("Polygon((600040 5100010, 600060 5100010, 600060 5100050, 600040 5100010))", 7.0)],
    )
    tiles(houses, EXTENT=EXTENT, TILE_WIDTH=50, TILE_HEIGHT=60)
    alone = export(houses, EXTENT="600000,600050,5100000,5100060", SITE_CRS=UTM)
    assert (tmp_path / "out" / "tile_r001_c001.txt").read_text() == alone.text


def test_tiles_follow_a_route_in_another_crs(tiles, wall, make_layer, tmp_path):
    route = make_layer(
        "drive", crs="EPSG:25833", features=[("LineString(600010 5100030, 600090 5100030)", 0.0)]
    )
    results = tiles(wall, ROUTE=route, TILE_WIDTH=40, TILE_HEIGHT=40, OVERLAP=10)
    found = [(f["along_m"], f["x_min"], f["obstacles"]) for f in results["INDEX"].getFeatures()]
    assert [f[0] for f in found] == pytest.approx([0, 26.67, 53.33, 80], abs=0.01)
    assert [f[1] for f in found] == pytest.approx([599990, 600016.67, 600043.33, 600070], abs=0.02)
    assert all(f[2] == 1 for f in found)
    assert names(tmp_path / "out")[0] == "route_0001.txt"


def test_tiles_follow_what_the_filter_of_the_route_keeps(tiles, wall, make_layer):
    lines = [
        ("LineString(600010 5100030, 600090 5100030)", 1.0),
        ("LineString(0 0, 9e5 0)", 2.0),
        (None, 3.0),
    ]
    route = make_layer("drive", features=lines)
    route.setCustomProperty("fleet/filter", '"height" < 1.5')
    assert tiles(wall, ROUTE=route, TILE_WIDTH=40, TILE_HEIGHT=40, OVERLAP=10)["TILE_COUNT"] == 4
    route.setCustomProperty("fleet/filter", "to_int('a')")
    with pytest.raises(
        QgsProcessingException, match="ROUTE: feature 1 of drive: the filter expression fails"
    ):
        tiles(wall, ROUTE=route)
    route.setCustomProperty("fleet/filter", "1 +")
    with pytest.raises(QgsProcessingException, match=r"The filter expression '1 \+' for the layer drive"):
        tiles(wall, ROUTE=route)


def test_binary_strict_and_empty_tiles(tiles, wall, tmp_path):
    results = tiles(wall, EXTENT=EXTENT, TILE_WIDTH=100, TILE_HEIGHT=20, FORMAT="binary", SKIP_EMPTY=True)
    assert results["TILE_COUNT"] == 1
    assert names(tmp_path / "out") == ["tile_r002_c001.rmap"]
    assert decode((tmp_path / "out" / "tile_r002_c001.rmap").read_bytes()).segment_count == 1


def test_cancelling_leaves_neither_tiles_nor_index_nor_folder(tiles, wall, tmp_path, cancels_at):
    index = tmp_path / "index.gpkg"
    for percent in (5, 60, 90):
        feedback = cancels_at(percent)
        tiles(wall, EXTENT=EXTENT, TILE_WIDTH=10, TILE_HEIGHT=10, INDEX=str(index), feedback=feedback)
        assert feedback.isCanceled()
        assert not (tmp_path / "out").exists() and not index.exists()


def test_cancelling_leaves_older_tiles_as_they_were(tiles, wall, tmp_path, cancels_at):
    older = tmp_path / "out" / "tile_r001_c001.txt"
    older.parent.mkdir()
    older.write_text("an older tile")
    tiles(wall, EXTENT=EXTENT, TILE_WIDTH=10, TILE_HEIGHT=10, feedback=cancels_at(80))
    assert older.read_text() == "an older tile" and names(older.parent) == [older.name]
    tiles(wall, EXTENT=EXTENT)
    assert read_text(older.read_text()).segment_count == 1


def test_a_folder_that_cannot_be_written_is_named_and_nothing_is_left(tiles, wall, tmp_path):
    (tmp_path / "out").mkdir()
    (tmp_path / "out" / "tile_r001_c002.txt").mkdir()
    with pytest.raises(QgsProcessingException, match="is a folder, where a file is to be written"):
        tiles(wall, EXTENT=EXTENT, TILE_WIDTH=50)
    assert names(tmp_path / "out") == ["tile_r001_c002.txt"]
    (tmp_path / "file").write_text("")
    with pytest.raises(QgsProcessingException, match="is a file: choose a folder"):
        tiles(wall, EXTENT=EXTENT, OUTPUT=str(tmp_path / "file"))


@pytest.fixture
def small_disk(tmp_path):
    """A disk that can be filled up."""
    try:
        with Disk(tmp_path / "disk", megabytes=2) as disk:
            yield disk
    except StageError as error:
        pytest.skip(str(error))


def full_but_for(disk, kilobytes):
    """Fill the disk but for so many kilobytes."""
    disk.fill()
    filler = disk.folder / "filler"
    os.truncate(filler, filler.stat().st_size - kilobytes * 1024)


@pytest.mark.parametrize(
    ("suffix", "kilobytes", "earlier"),
    [
        ("gpkg", 0, True),
        ("gpkg", 90, False),
        ("gpkg", 110, False),
        ("gpkg", 110, True),
        ("shp", 0, False),
        ("shp", 90, True),
    ],
)
def test_a_disk_that_is_full_when_the_index_is_written_leaves_all_as_it_was(
    tiles, wall, tmp_path, small_disk, earlier, suffix, kilobytes
):
    """The schema of a GeoPackage takes about 100 kB, before any tile is in it."""
    out, index = tmp_path / "out", small_disk.folder / f"index.{suffix}"
    if earlier:
        tiles(wall, EXTENT=EXTENT, TILE_WIDTH=50, TILE_HEIGHT=30, INDEX=str(index))
    before = contents(out), contents(small_disk.folder)
    full_but_for(small_disk, kilobytes)
    many = {"EXTENT": EXTENT, "TILE_WIDTH": 5, "TILE_HEIGHT": 5, "SKIP_EMPTY": False, "INDEX": str(index)}
    with pytest.raises(QgsProcessingException):
        tiles(wall, **many)
    small_disk.free()
    assert (contents(out), contents(small_disk.folder)) == before
    tiles(wall, **many)
    assert len(names(out)) == 240
    assert QgsVectorLayer(str(index)).featureCount() == 240


def test_a_disk_that_is_full_when_tiles_are_written_leaves_what_was_there(tiles, wall, small_disk):
    out = small_disk.folder / "out"
    tiles(wall, EXTENT=EXTENT, TILE_WIDTH=50, OUTPUT=str(out))
    before = contents(out)
    small_disk.fill()
    with pytest.raises(QgsProcessingException, match="cannot be written"):
        tiles(wall, EXTENT=EXTENT, TILE_WIDTH=30, OUTPUT=str(out))
    assert contents(out) == before


def test_an_index_that_cannot_be_written_leaves_no_tiles(tiles, wall, tmp_path):
    for index in (
        str(tmp_path / "nowhere" / "index.gpkg"),
        QgsProcessingOutputLayerDefinition(str(tmp_path / "nowhere" / "index.gpkg")),
    ):
        with pytest.raises(QgsProcessingException, match=f"The index .*: there is no folder {tmp_path}"):
            tiles(wall, EXTENT=EXTENT, INDEX=index)
        assert not (tmp_path / "out").exists()


def test_the_index_may_lie_among_the_tiles(tiles, wall, tmp_path):
    tiles(wall, EXTENT=EXTENT, TILE_WIDTH=100, TILE_HEIGHT=100, INDEX=str(tmp_path / "out" / "index.gpkg"))
    assert "index.gpkg" in names(tmp_path / "out")


def test_the_choice_of_area_is_checked_before_anything_is_read(tiles, wall):
    for parameters, said in (
        ({}, "Neither EXTENT nor ROUTE"),
        ({"EXTENT": EXTENT, "ROUTE": wall}, "Both EXTENT and ROUTE"),
        ({"EXTENT": EXTENT, "TILE_WIDTH": 0}, "The width of a tile is 0.0 m"),
        ({"EXTENT": EXTENT, "OVERLAP": 100}, "OVERLAP is 100.0 m"),
        ({"EXTENT": EXTENT, "TILE_WIDTH": 1, "TILE_HEIGHT": 0.5}, "The height of a tile"),
        ({"EXTENT": EXTENT, "SITE_CRS": "EPSG:3857"}, "its metres are not metres"),
    ):
        with pytest.raises(QgsProcessingException) as error:
            tiles(wall, **parameters)
        assert said in str(error.value)


def test_a_route_without_a_line_is_refused(tiles, wall, make_layer):
    with pytest.raises(QgsProcessingException, match="ROUTE holds no line"):
        tiles(wall, ROUTE=make_layer("empty", features=[]))


def test_what_is_left_out_of_a_route_is_warned_of(tiles, wall, make_layer, listener):
    drive = "LineString(600010 5100030, 600090 5100030)"
    route = make_layer(
        "drive", features=[(drive, 0.0), (None, 0.0), ("LineString(600010 5100030, 600010 5100030)", 0.0)]
    )
    tiles(wall, ROUTE=route, feedback=listener)
    assert "Layer drive, feature 2: has no geometry; it is left out" in listener.warnings
    assert any("feature 3: line 1 has fewer than two different points" in text for text in listener.warnings)


def test_no_obstacle_anywhere_is_said(tiles, wall, listener):
    results = tiles(wall, EXTENT="700000,700100,5100000,5100100")
    assert results["TILE_COUNT"] == 1 and results["WARNING_COUNT"] == 1
    assert any("no obstacle in any tile" in warning for warning in listener.warnings)


def test_helsinki_in_tiles_by_a_script_is_helsinki_in_one_window(by_words, data, tmp_path):
    file = data / "osm" / "helsinki_centre_utm35n.gpkg"
    layers = [f"OBSTACLES={file}|layername={name}" for name in ("buildings", "barriers")]
    area = "EXTENT=385700,386100,6671500,6671900"
    index = tmp_path / "index.gpkg"
    tiled = by_words(
        "run",
        "fleet:exportrobotmaptiles",
        "--",
        *layers,
        area,
        "OVERLAP=0",
        f"OUTPUT={tmp_path / 'out'}",
        f"INDEX={index}",
    )
    assert tiled.status == 0, tiled.said
    whole = by_words("run", "fleet:exportrobotmap", "--", *layers, area, f"OUTPUT={tmp_path / 'whole.txt'}")
    assert whole.status == 0, whole.said
    assert tiled.result("TILE_COUNT") == 16 == QgsVectorLayer(str(index)).featureCount()
    together = sum(length_of(read_text(f.read_text())) for f in (tmp_path / "out").iterdir())
    assert together == pytest.approx(length_of(read_text((tmp_path / "whole.txt").read_text())), rel=1e-4)
    assert set(tiled.warnings) == set(whole.warnings)


def length_of(robot_map) -> float:
    return float(sum(np.hypot(*(o.b - o.a).T).sum() for o in robot_map.obstacles))


def test_what_whole_tiles_lie_in_is_named_once(tiles, make_layer, wall, listener):
    square = "600010 5099900, 600300 5099900, 600300 5100300, 600010 5100300, 600010 5099900"
    park = make_layer("park", "Polygon", features=[(f"Polygon(({square}))", 4.0)])
    tiles(park, wall, EXTENT=EXTENT, TILE_WIDTH=20, TILE_HEIGHT=20)
    (warning,) = listener.warnings
    assert warning.startswith("A whole map lies inside of park:1 and has no wall of it")
