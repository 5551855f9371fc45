"""GeoPackage of a map, read by GDAL and by SQLite."""

from __future__ import annotations

import json
import sqlite3
import sys

import numpy as np
import pytest
import shapely
from osgeo import ogr

from robot_bridge.core.errors import ExportError, MissingExportPackageError
from robot_bridge.core.robotmap.exporters.vector_files import write_geopackage
from robot_bridge.core.sites.frame import frame_of_map


@pytest.fixture
def written(site_on_disk, tmp_path):
    """The sample site's map as a GeoPackage: the map and the file."""
    robot_map = site_on_disk.whole_map()
    frame = frame_of_map(robot_map.meta)
    write_geopackage(robot_map, tmp_path / "map.gpkg", frame.crs, frame.to_crs)
    return robot_map, tmp_path / "map.gpkg"


def geometries(layer):
    return [shapely.from_wkb(bytes(feature.GetGeometryRef().ExportToWkb())) for feature in layer]


def test_gdal_reads_every_layer_in_the_sites_crs(written):
    robot_map, file = written
    source = ogr.Open(str(file))
    layers = {source.GetLayer(k).GetName(): source.GetLayer(k) for k in range(source.GetLayerCount())}
    assert list(layers) == ["obstacle_areas", "obstacle_lines", "segments", "border"]
    assert {layer.GetSpatialRef().GetAuthorityCode(None) for layer in layers.values()} == {"32633"}
    assert layers["segments"].GetFeatureCount() == robot_map.segment_count
    areas, lines = layers["obstacle_areas"].GetFeatureCount(), layers["obstacle_lines"].GetFeatureCount()
    courtyards = sum(len(json.loads(feature["courtyards"])) for feature in layers["obstacle_areas"])
    assert areas + lines + courtyards == len(robot_map.obstacles) and courtyards == 1


def test_geometries_are_valid_and_where_the_map_has_them(written):
    robot_map, file = written
    source = ogr.Open(str(file))
    assert all(shape.is_valid for shape in geometries(source.GetLayer("obstacle_areas")))
    ends = np.array([line.coords for line in geometries(source.GetLayer("segments"))])
    wanted = np.concatenate([np.stack([o.a, o.b], axis=1) for o in robot_map.obstacles])
    assert np.abs(ends - (640420.0, 5193480.0) - wanted).max() < 1e-6
    (border,) = geometries(source.GetLayer("border"))
    assert border.bounds == (640420.0, 5193480.0, 640620.0, 5193640.0)


def test_attributes_are_columns_of_their_kind(written):
    robot_map, file = written
    with sqlite3.connect(file) as connection:
        row = connection.execute(
            "select shape, height_m, outdoor, source, ext from obstacle_areas where semantics = ?",
            ("building,Library",),
        ).fetchone()
        (meta,) = connection.execute("select meta from border").fetchone()
    obstacle = next(o for o in robot_map.obstacles if o.semantics == "building,Library")
    assert row[:4] == ("closed polygon", obstacle.height.max(), 1, obstacle.ext["src"])
    assert json.loads(row[4]) == obstacle.ext
    assert json.loads(meta) == robot_map.meta


def test_a_map_without_a_crs_is_in_its_own_metres(make_map, house, tmp_path):
    write_geopackage(make_map([(house, {})], (10, 20, 30, 40)), tmp_path / "map.gpkg")
    source = ogr.Open(str(tmp_path / "map.gpkg"))
    layer = source.GetLayer("obstacle_areas")
    (shape,) = geometries(layer)
    assert shape.equals(shapely.Polygon(house))
    assert layer.GetSpatialRef() is None or layer.GetSpatialRef().GetAuthorityCode(None) is None


def test_a_folder_that_is_not_there_is_named_and_nothing_is_left(make_map, house, tmp_path):
    with pytest.raises(ExportError, match="cannot be written"):
        write_geopackage(make_map([(house, {})], (10, 20, 30, 40)), tmp_path / "none" / "map.gpkg")
    (tmp_path / "map.gpkg").write_text("a map of somebody else's")
    with pytest.raises(ExportError, match="is there already"):
        write_geopackage(make_map([(house, {})], (10, 20, 30, 40)), tmp_path / "map.gpkg")
    assert (tmp_path / "map.gpkg").read_text() == "a map of somebody else's"


def test_without_pyogrio_it_says_what_to_install(make_map, house, tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "pyogrio", None)
    with pytest.raises(MissingExportPackageError, match="needs the Python package pyogrio"):
        write_geopackage(make_map([(house, {})], (10, 20, 30, 40)), tmp_path / "map.gpkg")
    assert list(tmp_path.iterdir()) == []
