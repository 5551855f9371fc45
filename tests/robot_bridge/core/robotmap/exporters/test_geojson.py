"""GeoJSON of a map, read by GDAL, shapely and geojson-validator."""

from __future__ import annotations

import json
import math

import geojson_validator
import numpy as np
import pytest
import shapely
from osgeo import ogr

from robot_bridge.core.errors import CrsError, GeoreferenceError
from robot_bridge.core.robotmap.exporters.geometries import obstacle_shapes, segment_shapes
from robot_bridge.core.robotmap.exporters.vector_files import geojson_of
from robot_bridge.core.robotmap.model import ShapeType
from robot_bridge.core.sites.frame import SiteFrame, frame_of_map, lonlat_of

FRAME = SiteFrame("EPSG:32633", (640420.0, 5193480.0), math.radians(30))
OUTER = [(2, 2), (18, 2), (18, 18), (2, 18), (2, 2)]
INNER = [(6, 6), (14, 6), (14, 14), (6, 14), (6, 6)]


@pytest.fixture
def robot_map(make_map):
    """A building with a courtyard and a hut in it, a bent wall, stairs, a ramp, a cut building."""
    return make_map(
        [
            (OUTER, {"source": "b:1", "semantics": "building,Győr", "height": 7.5}),
            (INNER, {"source": "b:1", "semantics": "building,Győr", "courtyard": True, "height": 7.5}),
            ([(8, 8), (10, 8), (10, 10), (8, 10), (8, 8)], {"source": "b:2", "height": 2.5}),
            (
                [(20, 2), (24, 2), (24, 8)],
                {"shape_type": ShapeType.OPEN_POLYGON, "semantics": "wall", "height": 1.2},
            ),
            ([(20, 12), (22, 12), (20, 13), (22, 13)], {"shape_type": ShapeType.STAIRS, "height": 0.17}),
            ([(24, 12), (26, 12), (26, 16), (24, 16), (24, 12)], {"shape_type": ShapeType.RAMP}),
            ([(26, 2), (40, 2), (40, 8), (26, 8), (26, 2)], {"outdoor": False}),
        ],
        (0, 0, 30, 20),
    )


@pytest.fixture
def obstacles(robot_map):
    return json.loads(geojson_of(obstacle_shapes(robot_map), lonlat_of(FRAME), {"crs": FRAME.crs}))


def site_ring(coordinates):
    """Return longitudes and latitudes in the site frame again, by PROJ in the other direction."""
    from pyproj import Transformer

    back = Transformer.from_crs(4326, FRAME.crs, always_xy=True)
    return FRAME.to_site(np.column_stack(back.transform(*np.array(coordinates).T)))


def test_the_validator_finds_nothing(robot_map):
    for shapes in (obstacle_shapes(robot_map), segment_shapes(robot_map)):
        content = json.loads(geojson_of(shapes, lonlat_of(FRAME), {"crs": FRAME.crs}))
        assert geojson_validator.validate_structure(content) == {}
        found = geojson_validator.validate_geometries(content)
        assert found["invalid"] == {}
        # Courtyards are holes, and a robot needs more digits than a map on a screen.
        assert set(found["problematic"]) <= {"holes", "excessive_coordinate_precision"}


def test_the_validator_would_find_a_ring_that_runs_the_wrong_way(obstacles):
    ring = obstacles["features"][0]["geometry"]["coordinates"][0]
    ring.reverse()
    assert geojson_validator.validate_geometries(obstacles)["invalid"] != {}


def test_positions_are_where_the_site_frame_puts_them(obstacles):
    polygon = obstacles["features"][0]["geometry"]["coordinates"]
    assert np.abs(site_ring(polygon[0]) - OUTER).max() < 0.002
    assert [shapely.is_ccw(shapely.LinearRing(ring)) for ring in polygon] == [True, False]
    courtyard = shapely.Polygon(site_ring(polygon[1]))
    assert courtyard.symmetric_difference(shapely.Polygon(INNER)).area < 0.05
    assert 16.0 < polygon[0][0][0] < 17.5 and 46.0 < polygon[0][0][1] < 47.5


def test_a_courtyard_is_a_hole_and_what_stands_in_it_a_feature(obstacles):
    by_id = {feature["properties"]["id"]: feature for feature in obstacles["features"]}
    assert by_id[1]["properties"]["courtyards"] == [2]
    assert len(by_id[1]["geometry"]["coordinates"]) == 2
    assert 2 not in by_id
    assert len(by_id[3]["geometry"]["coordinates"]) == 1


def test_each_shape_has_its_geometry_and_attributes(obstacles):
    kinds = {f["properties"]["shape"]: f["geometry"]["type"] for f in obstacles["features"]}
    assert kinds == {
        "closed polygon": "Polygon",
        "open polygon": "LineString",
        "stairs": "MultiLineString",
        "ramp": "Polygon",
    }
    first = obstacles["features"][0]["properties"]
    assert first["semantics"] == "building,Győr"
    assert (first["height_m"], first["outdoor"], first["source"]) == (7.5, True, "b:1")
    assert (first["shape_type"], first["segments"], first["ext"]) == (1, 4, {"src": "b:1"})
    assert [f["properties"]["outdoor"] for f in obstacles["features"]].count(False) == 1


def test_rings_keep_their_direction_also_where_the_transform_mirrors_them(robot_map):
    content = json.loads(geojson_of(obstacle_shapes(robot_map), lambda xy: xy * (1e-3, -1e-3)))
    assert geojson_validator.validate_geometries(content)["invalid"] == {}


def test_a_courtyard_belongs_to_the_part_of_its_source_that_is_round_it(make_map):
    small = [(30, 2), (31, 2), (31, 3), (30, 3), (30, 2)]
    rows = [(small, {}), (OUTER, {}), (INNER, {"courtyard": True})]
    shapes = obstacle_shapes(
        make_map([(points, {"source": "b:1", **more}) for points, more in rows], (0, 0, 40, 20))
    )
    assert [(shape.attributes["id"], len(shape.parts)) for shape in shapes] == [(1, 1), (2, 2)]


def test_segments_keep_their_direction_and_number(robot_map):
    content = json.loads(geojson_of(segment_shapes(robot_map), lonlat_of(FRAME)))
    assert len(content["features"]) == robot_map.segment_count
    features = iter(content["features"])
    for obstacle in robot_map.obstacles:
        for k in range(len(obstacle.a)):
            feature = next(features)
            ends = site_ring(feature["geometry"]["coordinates"])
            assert np.abs(ends - [obstacle.a[k], obstacle.b[k]]).max() < 0.002
            said = feature["properties"]
            assert (said["obstacle"], said["number"]) == (obstacle.id, k + 1)
            assert said["height_m"] == obstacle.height[k]


def test_gdal_reads_every_feature_with_its_attributes(robot_map, tmp_path):
    file = tmp_path / "map.geojson"
    file.write_bytes(geojson_of(obstacle_shapes(robot_map), lonlat_of(FRAME)))
    source = ogr.Open(str(file))
    layer = source.GetLayer(0)
    assert layer.GetSpatialRef().GetAuthorityCode(None) == "4326"
    assert layer.GetFeatureCount() == len(obstacle_shapes(robot_map))
    first = layer.GetNextFeature()
    assert first["semantics"] == "building,Győr" and first["height_m"] == 7.5
    assert first.GetGeometryRef().IsValid()


def test_the_whole_sample_site_is_valid(site_on_disk):
    robot_map = site_on_disk.whole_map()
    to_lonlat = lonlat_of(frame_of_map(robot_map.meta))
    content = json.loads(geojson_of(obstacle_shapes(robot_map), to_lonlat, robot_map.meta))
    assert geojson_validator.validate_structure(content) == {}
    assert geojson_validator.validate_geometries(content)["invalid"] == {}
    assert content["robot_map"] == robot_map.meta
    west, south, east, north = content["bbox"]
    assert west < east and south < north


def test_a_map_of_nothing_is_an_empty_collection(make_map):
    content = json.loads(geojson_of([], lonlat_of(FRAME)))
    assert content == {"type": "FeatureCollection", "features": []}


def test_positions_off_the_earth_or_across_the_antimeridian_are_refused(robot_map):
    shapes = obstacle_shapes(robot_map)
    with pytest.raises(GeoreferenceError, match="none on the earth; check the CRS"):
        geojson_of(shapes, lambda xy: np.full((len(xy), 2), np.inf))
    with pytest.raises(GeoreferenceError, match="across the antimeridian"):
        geojson_of(shapes, lambda xy: np.column_stack([np.where(xy[:, 0] > 10, -179.9, 179.9), xy[:, 1]]))


@pytest.mark.parametrize(
    ("meta", "words"),
    [
        ({"crs": "EPSG:32633", "origin": "12"}, "line origin is '12': it must be 'x,y'"),
        ({"crs": "EPSG:32633", "origin": "a,b"}, "line origin is 'a,b'"),
        ({"crs": "EPSG:32633", "rotation": "nan"}, "line rotation is 'nan': it must be an angle in radians"),
    ],
)
def test_leading_lines_that_are_wrong_are_named(meta, words):
    with pytest.raises(CrsError, match=words):
        frame_of_map(meta)


def test_a_map_without_a_place_says_what_to_do():
    assert frame_of_map({"id": "lab"}) is None
    with pytest.raises(CrsError, match="no line crs; write the map with its leading lines"):
        lonlat_of(frame_of_map({}))
    with pytest.raises(CrsError, match="not known to PROJ"):
        lonlat_of(SiteFrame("EPSG:999999", (0, 0)))
    local = 'ENGCRS["lab",EDATUM["lab"],CS[Cartesian,2],AXIS["x",east],AXIS["y",north],LENGTHUNIT["metre",1]]'
    with pytest.raises(CrsError, match="no known place on the earth"):
        lonlat_of(SiteFrame(local, (0, 0)))
