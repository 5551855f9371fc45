"""Coordinates of any layer come out in the site frame."""

from __future__ import annotations

import math

import numpy as np
import pyproj
import pytest
from fleet_supervisor.plugin.layers.site_transform import SiteGeoreference
from fleet_supervisor.plugin.ui.errors import LayerCrsError
from fleet_supervisor.robot_bridge.core.sites.frame import SiteFrame
from osgeo import ogr
from qgis.core import QgsCoordinateReferenceSystem, QgsCoordinateTransformContext, QgsVectorLayer

ORIGIN = (640420.0, 5193480.0)
ENGINEERING = (
    'ENGCRS["yard",EDATUM["yard"],CS[Cartesian,2],AXIS["x",east],AXIS["y",north],LENGTHUNIT["metre",1]]'
)


def test_degrees_become_the_metres_that_pyproj_and_the_frame_give(make_layer, read):
    degrees = [(16.8420, 46.8770), (16.8431, 46.8779)]
    wkt = "LineString({} {}, {} {})".format(*degrees[0], *degrees[1])
    (row,) = read(make_layer(crs="EPSG:4326", features=[(wkt,)]), origin=ORIGIN, rotation=0.4).rows
    to_utm = pyproj.Transformer.from_crs("EPSG:4326", "EPSG:32633", always_xy=True)
    utm = np.column_stack(to_utm.transform(*np.array(degrees).T))
    assert row.points == pytest.approx(SiteFrame("EPSG:32633", ORIGIN, 0.4).to_site(utm), abs=1e-4)


def test_a_quarter_turn_makes_north_the_site_x_axis(make_layer, read):
    (row,) = read(
        make_layer(features=[("LineString(100 50, 100 60)",)]), origin=(100, 50), rotation=math.pi / 2
    ).rows
    assert row.points == pytest.approx(np.array([[0, 0], [10, 0]]), abs=1e-9)


def test_a_layer_without_a_crs_is_refused_by_name_unless_it_is_said_to_be_local(make_layer, read):
    layer = make_layer("scan", crs="", features=[("LineString(1 2, 3 4)",)])
    with pytest.raises(LayerCrsError, match=r"The layer scan has no CRS.*set the layer's CRS.*LOCAL=true"):
        read(layer)
    (row,) = read(layer, local=True, origin=ORIGIN, rotation=1.0).rows
    assert row.points.tolist() == [[1, 2], [3, 4]]


def test_a_geopackage_that_only_says_that_it_has_no_crs_is_placed_nowhere(qgis_app, tmp_path):
    """Its layer comes in degrees of an "Undefined geographic SRS"."""
    file = str(tmp_path / "plan.gpkg")
    source = ogr.GetDriverByName("GPKG").CreateDataSource(file)
    source.CreateLayer("roads", None, ogr.wkbLineString)
    source = None
    crs = QgsVectorLayer(f"{file}|layername=roads", "roads", "ogr").crs()
    site = QgsCoordinateReferenceSystem("EPSG:32633")
    placing = SiteGeoreference(site, SiteFrame("EPSG:32633", ORIGIN), QgsCoordinateTransformContext())
    with pytest.raises(LayerCrsError, match="The layer roads has no CRS"):
        placing.of_layer("roads", crs)


@pytest.mark.parametrize(
    ("crs", "why"), [("", "has no CRS"), (ENGINEERING, "is in the CRS yard.*EPSG:32633")]
)
def test_where_nobody_is_asked_whether_a_layer_is_local_no_such_choice_is_advised(qgis_app, crs, why):
    site = QgsCoordinateReferenceSystem("EPSG:32633")
    placing = SiteGeoreference(site, SiteFrame("EPSG:32633", ORIGIN), QgsCoordinateTransformContext())
    with pytest.raises(LayerCrsError, match=f"The layer scan {why}") as error:
        placing.of_layer("scan", QgsCoordinateReferenceSystem.fromWkt(crs))
    assert "LOCAL" not in str(error.value)


def test_an_engineering_layer_on_another_site_crs_is_refused_by_name(data, read):
    file = data / "upc_campus_nord" / "upc_campus_nord_local.gpkg"
    layer = QgsVectorLayer(f"{file}|layername=buildings", "campus", "ogr")
    with pytest.raises(LayerCrsError, match=r"campus is in the CRS UPC FIB.*no known relation.*EPSG:32633"):
        read(layer)
    assert len(read(layer, local=True).rows) >= 12


def test_the_window_in_the_layers_crs_holds_the_window_on_the_site(qgis_app):
    crs = QgsCoordinateReferenceSystem("EPSG:32633")
    frame = SiteFrame("EPSG:32633", ORIGIN, 0.3)
    degrees = QgsCoordinateReferenceSystem("EPSG:4326")
    placing = SiteGeoreference(crs, frame, QgsCoordinateTransformContext()).of_layer("any", degrees)
    area = placing.area_of((-50, -20, 80, 90))
    to_degrees = pyproj.Transformer.from_crs("EPSG:32633", "EPSG:4326", always_xy=True)
    for x, y in np.random.default_rng(3).uniform((-50, -20), (80, 90), (200, 2)):
        assert area.contains(*to_degrees.transform(*frame.to_crs([(x, y)])[0]))


def test_a_point_beyond_the_projection_is_a_warning_and_the_rest_is_read(make_layer, read):
    layer = make_layer(
        crs="EPSG:4326",
        fields="&field=height:double",
        features=[("LineString(16 46, 17 200)", 1.0), ("LineString(15 46, 15.1 46)", 1.0)],
    )
    reading = read(layer)
    assert [row.source for row in reading.rows] == ["walls:2"]
    assert reading.warnings == [
        "Layer walls, feature 1: has a coordinate that is no number, has no place in the site's CRS or "
        "lies beyond 100 000 km; it is left out"
    ]
