"""OpenStreetMap as ``ogr2ogr`` writes it without further ado: most tags stand together in ``other_tags``."""

from __future__ import annotations

import json

import pytest
from fleet_supervisor.plugin.layers.layer_expressions import LONGEST_TEXT, as_metres, read_tags
from fleet_supervisor.plugin.layers.layer_source import obstacle_sources
from fleet_supervisor.plugin.layers.obstacle_layers import read_outlines
from fleet_supervisor.plugin.layers.road_layers import read_centrelines
from fleet_supervisor.plugin.layers.roles import LayerExpressions, find_profile, read_profile
from fleet_supervisor.plugin.layers.site_transform import SiteGeoreference
from fleet_supervisor.robot_bridge.core.roads.network import BACKWARD, BOTH, FORWARD
from fleet_supervisor.robot_bridge.core.sites.frame import SiteFrame
from osgeo import gdal, ogr, osr
from qgis.core import (
    NULL,
    QgsCoordinateReferenceSystem,
    QgsExpressionContext,
    QgsFeedback,
    QgsProject,
    QgsVectorLayer,
)

CITY = """<?xml version="1.0" encoding="UTF-8"?>
<osm version="0.6">
 <node id="1" lat="46.8800" lon="16.8400"/><node id="2" lat="46.8800" lon="16.8420"/>
 <node id="3" lat="46.8810" lon="16.8420"/><node id="4" lat="46.8810" lon="16.8400"/>
 <node id="5" lat="46.8805" lon="16.8430"/>
 <way id="10"><nd ref="1"/><nd ref="2"/><tag k="highway" v="service"/><tag k="oneway" v="yes"/>
  <tag k="surface" v="asphalt"/><tag k="maxspeed" v="30"/><tag k="width" v="25'8&quot;"/></way>
 <way id="11"><nd ref="2"/><nd ref="3"/><tag k="highway" v="service"/><tag k="oneway" v="-1"/>
  <tag k="layer" v="1"/><tag k="bridge" v="yes"/><tag k="width" v="4 m"/></way>
 <way id="12"><nd ref="3"/><nd ref="4"/><tag k="highway" v="service"/><tag k="lanes" v="2"/></way>
 <way id="13"><nd ref="3"/><nd ref="5"/><tag k="highway" v="service"/><tag k="junction" v="roundabout"/>
  <tag k="width" v="wide"/></way>
 <way id="20"><nd ref="1"/><nd ref="2"/><nd ref="3"/><nd ref="1"/><tag k="building" v="yes"/>
  <tag k="height" v="12.5"/></way>
 <way id="21"><nd ref="1"/><nd ref="3"/><nd ref="4"/><nd ref="1"/><tag k="building" v="yes"/>
  <tag k="building:levels" v="4"/></way>
</osm>
"""


@pytest.fixture(scope="module", params=["hstore", "json", "json field"])
def city(request, qgis_app, tmp_path_factory):
    """A city as GDAL converts it by itself; tags as hstore, or as newer versions write them on request."""
    folder = tmp_path_factory.mktemp("osm")
    (folder / "city.osm").write_text(CITY, encoding="utf-8")
    target = str(folder / "city.gpkg")
    for layer, name, mode in (("lines", "roads", None), ("multipolygons", "buildings", "update")):
        known = "highway" if layer == "lines" else "building"
        options = gdal.VectorTranslateOptions(
            format="GPKG",
            layers=[layer],
            layerName=name,
            where=f"{known} IS NOT NULL",
            dstSRS="EPSG:32633",
            accessMode=mode,
        )
        written = gdal.VectorTranslate(target, str(folder / "city.osm"), options=options)
        assert written is not None
        del written
    layers = {
        name: QgsVectorLayer(f"{target}|layername={name}", name, "ogr") for name in ("roads", "buildings")
    }
    if request.param == "json":
        layers = {name: with_json(layer) for name, layer in layers.items()}
    elif request.param == "json field":
        layers = {name: with_json_field(layer, folder) for name, layer in layers.items()}
    return layers


def with_json(layer):
    """Return a copy in memory whose tags are JSON."""
    names = "".join(f"&field={field.name()}:string" for field in layer.fields())
    kind = "Polygon" if layer.name() == "buildings" else "LineString"
    copy = QgsVectorLayer(f"{kind}?crs=EPSG:32633{names}", layer.name(), "memory")
    at = layer.fields().lookupField("other_tags")
    features = list(layer.getFeatures())
    for feature in features:
        feature[at] = json.dumps(read_tags(feature[at]))
    assert copy.dataProvider().addFeatures(features)
    return copy


def with_json_field(layer, folder):
    """Return a copy in a GeoPackage whose field of tags says that it is JSON, as GDAL 3.7 writes it."""
    file = str(folder / f"json_{layer.name()}.gpkg")
    here = osr.SpatialReference()
    here.ImportFromEPSG(32633)
    target = ogr.GetDriverByName("GPKG").CreateDataSource(file)
    kind = ogr.wkbMultiPolygon if layer.name() == "buildings" else ogr.wkbLineString
    table = target.CreateLayer(layer.name(), here, kind)
    for name in layer.fields().names()[1:]:
        field = ogr.FieldDefn(name, ogr.OFTString)
        field.SetSubType(ogr.OFSTJSON if name == "other_tags" else ogr.OFSTNone)
        table.CreateField(field)
    for feature in layer.getFeatures():
        row = ogr.Feature(table.GetLayerDefn())
        row.SetGeometry(ogr.CreateGeometryFromWkb(feature.geometry().asWkb().data()))
        for name in layer.fields().names()[1:]:
            text = feature[name]
            if text != NULL:
                row[name] = json.dumps(read_tags(text)) if name == "other_tags" else str(text)
        assert table.CreateFeature(row) == ogr.OGRERR_NONE
    del row, table, target
    copy = QgsVectorLayer(f"{file}|layername={layer.name()}", layer.name(), "ogr")
    assert any(isinstance(feature["other_tags"], dict) for feature in copy.getFeatures())
    return copy


def sources(layer):
    setups = read_profile(find_profile("openstreetmap")).setup_over
    return obstacle_sources([layer], LayerExpressions(), QgsExpressionContext(), setups)


@pytest.fixture
def site():
    crs = QgsCoordinateReferenceSystem("EPSG:32633")
    return SiteGeoreference(
        crs, SiteFrame("EPSG:32633", (0.0, 0.0)), QgsProject.instance().transformContext(), False
    )


def test_one_way_roads_widths_surfaces_and_levels_are_found_in_other_tags(city, site):
    reading = read_centrelines(sources(city["roads"]), site, 3.5, QgsFeedback())
    roads = reading.items
    assert [road.direction for road in roads] == [FORWARD, BACKWARD, BOTH, FORWARD]
    assert [round(road.width_m, 3) for road in roads] == [7.823, 4.0, 6.5, 3.5]
    assert [road.level for road in roads] == [0, 1, 0, 0]
    assert roads[0].surface == "asphalt" and roads[0].speed_ms == pytest.approx(30 / 3.6)
    assert any("its width 'wide' is not a number of metres" in warning for warning in reading.warnings)
    assert not any("driven both ways" in warning for warning in reading.warnings)


def test_heights_of_buildings_are_found_in_other_tags(city, site):
    reading = read_outlines(sources(city["buildings"]), site, (-1e7, -1e7, 1e7, 1e7), 3.0, QgsFeedback())
    assert [row.height for row in reading.rows] == [12.5, 12.0]


def test_a_road_layer_that_cannot_tell_one_way_roads_is_named(make_layer, site):
    plain = make_layer("tracks", "LineString", "&field=width:double", [("LineString(0 0, 9 0)", 3.0)])
    reading = read_centrelines(sources(plain), site, 3.5, QgsFeedback())
    assert [w for w in reading.warnings if "Layer tracks" in w and "driven both ways" in w]


def test_fields_of_the_layer_come_before_tags(make_layer, site):
    both = make_layer(
        "roads",
        "LineString",
        "&field=oneway:string&field=other_tags:string",
        [("LineString(0 0, 9 0)", "no", '"oneway"=>"yes"')],
    )
    (road,) = read_centrelines(sources(both), site, 3.5, QgsFeedback()).items
    assert road.direction == BOTH


@pytest.mark.parametrize(
    "value",
    [
        None,
        7,
        "",
        "{",
        "[" * 100_000,
        '{"a":' * 15_000,
        '{"a": {"b": 1}, "c": [1]}',
        "x" * (LONGEST_TEXT + 1),
        "[1]",
    ],
)
def test_what_holds_no_tags_has_none(value):
    assert read_tags(value) == {}


@pytest.mark.parametrize(
    ("text", "metres"),
    [
        ("25'8\"", 7.8232),
        ("25'", 7.62),
        ('8"', 0.2032),
        ("30 ft", 9.144),
        ("6 feet", 1.8288),
        ("12,5 m", 12.5),
        ("7", 7.0),
        ("wide", None),
        ("3;4", None),
        ("3 - 4", None),
        ("", None),
        ("'", None),
    ],
)
def test_metres_feet_and_inches_are_read(text, metres):
    assert as_metres(text) == (None if metres is None else pytest.approx(metres))
