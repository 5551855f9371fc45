"""``fleet:exportroadnetwork``: files of road networks for other robots, in QGIS and by ``qgis_process``."""

from __future__ import annotations

import json
from pathlib import Path
from xml.etree import ElementTree

import pytest
from fleet_supervisor.plugin.processing.algorithms.export_road_network import FORMAT_NAMES, FORMAT_WRITERS
from fleet_supervisor.plugin.processing.common.map_files import SITE_METRES
from qgis.core import (
    QgsCoordinateReferenceSystem,
    QgsCoordinateTransform,
    QgsCoordinateTransformContext,
    QgsPointXY,
    QgsProcessingContext,
    QgsProcessingException,
    QgsProject,
    QgsVectorLayer,
)

FIELDS = "&field=oneway:string&field=speed_ms:double&field=closed:string"
ROADS = [
    ("LINESTRING(1000 2000, 1010 2000)", "no", 2.0, "no"),
    ("LINESTRING(1010 2000, 1010 2010, 1020 2010)", "yes", 3.0, "no"),
    ("LINESTRING(1010 2000, 1020 2000)", "no", 3.0, "yes"),
]


@pytest.fixture
def export(provider, listener, tmp_path):
    """Export a layer to a folder and return the outputs."""
    import processing

    def run(layer, feedback=None, **parameters):
        context = QgsProcessingContext()
        context.setProject(QgsProject())
        everything = {"ROADS": layer, "OUTPUT": str(tmp_path / "out"), **parameters}
        return processing.run(
            "fleet:exportroadnetwork", everything, context=context, feedback=feedback or listener
        )

    return run


@pytest.fixture
def roads(make_layer):
    return make_layer("roads", fields=FIELDS, features=ROADS)


def nav2(file):
    content = json.loads(Path(file).read_text(encoding="utf-8"))
    points = {
        feature["properties"]["id"]: tuple(feature["geometry"]["coordinates"])
        for feature in content["features"]
        if feature["geometry"]["type"] == "Point"
    }
    edges = {
        (points[one["startid"]], points[one["endid"]]): one["metadata"]["abs_speed_limit"]
        for feature in content["features"]
        if "startid" in (one := feature["properties"])
    }
    return content, edges


def test_roads_that_are_damaged_in_the_middle_are_no_network_of_half_of_them(
    export, make_layer, save_layer, tmp_path
):
    lines = [(f"LINESTRING({x} 0, {x + 1} 0)",) for x in range(5000)]
    layer = save_layer(make_layer("roads", fields="", features=lines), "roads.fgb")
    source, file = layer.source(), tmp_path / "roads.fgb"
    del layer
    # As it is while it is being copied.
    file.write_bytes(file.read_bytes()[: file.stat().st_size * 2 // 3])
    layer = QgsVectorLayer(source, "roads", "ogr")
    assert layer.isValid() and layer.featureCount() == 5000 > sum(1 for _ in layer.getFeatures()) > 0
    with pytest.raises(QgsProcessingException, match=r"The layer roads cannot be read to its end \("):
        export(layer)
    assert not (tmp_path / "out").exists()


def test_the_dialog_offers_what_is_written():
    assert list(FORMAT_NAMES) == list(FORMAT_WRITERS)


def test_the_nav2_graph_is_in_the_site_frame(export, roads, listener):
    made = export(roads, ORIGIN="1000,2000", ROTATION=90, NAME="yard", MAP_ID="hall")
    assert made["NAV2"].endswith("yard.geojson")
    assert (made["EDGE_COUNT"], made["WARNING_COUNT"]) == (2, len(listener.warnings))
    content, edges = nav2(made["NAV2"])
    rounded = {tuple(tuple(round(c, 6) + 0.0 for c in p) for p in ends): v for ends, v in edges.items()}
    assert rounded == {
        ((0, 0), (0, -10)): 2.0,
        ((0, -10), (0, 0)): 2.0,
        ((0, -10), (10, -10)): 3.0,
        ((10, -10), (10, -20)): 3.0,
    }
    assert content["site_frame"]["crs"] == "EPSG:32633"
    assert content["site_frame"]["origin"] == [1000.0, 2000.0]
    assert content["features"][0]["properties"]["frame"] == "hall"


def test_qgis_shows_a_graph_in_its_crs(export, roads):
    layer = QgsVectorLayer(export(roads)["NAV2"] + "|geometrytype=MultiLineString", "graph", "ogr")
    assert (layer.isValid(), layer.crs().authid(), layer.featureCount()) == (True, "EPSG:32633", 4)


def test_several_formats_at_once(export, roads, tmp_path):
    made = export(roads, FORMATS=["nav2", "lif"], NAME="yard", VEHICLE_TYPE="acme.carrier")
    assert sorted(file.name for file in (tmp_path / "out").iterdir()) == ["yard.geojson", "yard.lif.json"]
    (layout,) = json.loads(Path(made["LIF"]).read_text(encoding="utf-8"))["layouts"]
    assert len(layout["edges"]) == 3
    types = {edge["vehicleTypeEdgeProperties"][0]["vehicleTypeId"] for edge in layout["edges"]}
    assert types == {"acme.carrier"}


def test_coordinates_that_nav2_cannot_keep_are_warned_of(export, make_layer, listener):
    far = make_layer(
        "roads", fields=FIELDS, features=[("LINESTRING(640430 5193530, 640440 5193530)", *ROADS[0][1:])]
    )
    export(far, ORIGIN="640400,5193500")
    assert not [one for one in listener.warnings if "32 bits" in one]
    made = export(far)
    assert "moves nodes by up to 0.25 m: give ORIGIN" in listener.warnings[-1]
    assert made["WARNING_COUNT"] == 2


def test_lanelets_lie_where_the_roads_do(export, roads):
    made = export(roads, FORMATS=["lanelet2"], ORIGIN="1000,2000", KEEP_LEFT=True)
    osm = ElementTree.parse(made["LANELET2"])
    tags = [{tag.get("k"): tag.get("v") for tag in one.iter("tag")} for one in osm.iter("relation")]
    assert sorted(one["road"] for one in tags if "road" in one) == ["e0", "e0r", "e1"]
    to_utm = QgsCoordinateTransform(
        QgsCoordinateReferenceSystem("EPSG:4326"),
        QgsCoordinateReferenceSystem("EPSG:32633"),
        QgsCoordinateTransformContext(),
    )
    for node in osm.iter("node"):
        point = to_utm.transform(QgsPointXY(float(node.get("lon")), float(node.get("lat"))))
        local = {tag.get("k"): float(tag.get("v")) for tag in node.iter("tag")}
        place = (point.x() - 1000, point.y() - 2000)
        assert place == pytest.approx((local["local_x"], local["local_y"]), abs=1e-3)


def test_roads_through_keepouts_are_left_out(export, roads, make_layer):
    area = "POLYGON((1004 1995, 1006 1995, 1006 2005, 1004 2005, 1004 1995))"
    keepout = make_layer("keepout", kind="Polygon", features=[(area, 1)])
    _, edges = nav2(export(roads, KEEPOUTS=[keepout])["NAV2"])
    assert set(edges.values()) == {3.0}


@pytest.mark.parametrize(
    ("parameters", "words"),
    [
        ({"NAME": "../yard"}, "cannot be used: give a plain word"),
        ({"MAP_ID": " "}, "cannot be used: give a plain word"),
        ({"CLOSED": "true"}, "None of the 3 edges of the road network is open"),
    ],
)
def test_what_cannot_be_done_is_said_and_writes_nothing(export, roads, tmp_path, parameters, words):
    with pytest.raises(QgsProcessingException, match=words):
        export(roads, **parameters)
    assert not (tmp_path / "out").exists()


def test_roads_without_a_place_on_the_earth_are_no_lanelets(export, make_layer):
    local = make_layer("roads", fields=FIELDS, features=ROADS, crs=SITE_METRES)
    with pytest.raises(QgsProcessingException, match="no place on the Earth"):
        export(local, FORMATS=["lanelet2"])
    assert export(local, FORMATS=["nav2"])["EDGE_COUNT"] == 2


def test_a_cancelled_export_writes_nothing(export, roads, cancels_at, tmp_path):
    assert export(roads, feedback=cancels_at(60)) == {}
    assert not (tmp_path / "out").exists()


def test_the_sample_site_is_exported_as_the_guide_says(by_words, root, tmp_path):
    site = root / "resources" / "sample_site" / "site.gpkg"
    done = by_words(
        "run", "fleet:exportroadnetwork", "--", f"ROADS={site}|layername=road_centrelines",
        "FORMATS=nav2", "FORMATS=lif", "FORMATS=lanelet2",
        "ORIGIN=640420,5193480", "NAME=site", f"OUTPUT={tmp_path}",
    )  # fmt: skip
    assert done.status == 0, done.said
    _, edges = nav2(tmp_path / "site.geojson")
    assert len(edges) > 50
    assert max(abs(c) for ends in edges for point in ends for c in point) < 300
    assert (tmp_path / "site.osm").read_text().count('v="lanelet"') > 50
    assert f"LIF:\t{tmp_path}/site.lif.json" in done.stdout
