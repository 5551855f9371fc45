"""A site needs metres that are metres."""

from __future__ import annotations

import pytest
from fleet_supervisor.plugin.layers.crs import check_site_crs, is_engineering, site_crs_for, stated_crs
from fleet_supervisor.plugin.ui.errors import SiteCrsError
from fleet_supervisor.robot_bridge.core.errors import CrsError
from fleet_supervisor.robot_bridge.core.sites.frame import check_site_crs as check_in_bridge
from osgeo import ogr
from qgis.core import QgsCoordinateReferenceSystem, QgsVectorLayer

WKT = (
    'ENGCRS["yard",EDATUM["gate"],CS[Cartesian,2],AXIS["x",east],AXIS["y",north],'
    'LENGTHUNIT["{unit}",{metres}]]'
)


def crs_of(text):
    return QgsCoordinateReferenceSystem(text)


def engineering(unit="metre", metres=1, name="yard"):
    crs = QgsCoordinateReferenceSystem()
    assert crs.createFromWkt(WKT.format(unit=unit, metres=metres).replace("yard", name))
    return crs


@pytest.mark.parametrize("code", ["EPSG:32633", "EPSG:25831", "EPSG:2193", "EPSG:5514"])
def test_projected_metres_carry_a_site_here_and_in_the_bridge(qgis_app, code):
    check_site_crs(crs_of(code))
    check_in_bridge(code)


@pytest.mark.parametrize(
    ("code", "words"),
    [
        ("EPSG:3857", "its metres are not metres.*local UTM zone, such as EPSG:32633"),
        ("EPSG:3395", "its metres are not metres"),
        ("EPSG:4326", "not metres on a plane.*local UTM zone"),
        ("EPSG:4978", "not metres on a plane"),
        ("EPSG:2263", "its unit is (US survey )?f[eo]+t.*EPSG:32618"),
    ],
)
def test_every_other_crs_is_refused_here_and_in_the_bridge(qgis_app, code, words):
    with pytest.raises(SiteCrsError, match=words) as refused:
        check_site_crs(crs_of(code))
    assert code in str(refused.value)
    with pytest.raises(CrsError):
        check_in_bridge(code)


def test_an_engineering_crs_in_metres_carries_a_site_and_one_in_feet_does_not(qgis_app):
    check_site_crs(engineering())
    with pytest.raises(SiteCrsError, match="its unit is feet"):
        check_site_crs(engineering("foot", 0.3048))


def test_the_campus_file_is_in_an_engineering_crs(qgis_app, data):
    file = data / "upc_campus_nord" / "upc_campus_nord_local.gpkg"
    crs = QgsVectorLayer(f"{file}|layername=walls", "walls", "ogr").crs()
    assert crs.isValid() and is_engineering(crs)
    assert not is_engineering(crs_of("EPSG:32633"))


def test_the_chosen_crs_wins_over_the_project_and_the_project_over_the_layers(qgis_app):
    none, utm33, utm35 = crs_of(""), crs_of("EPSG:32633"), crs_of("EPSG:32635")
    assert site_crs_for(utm33, utm35, [utm35]) == utm33
    assert site_crs_for(none, utm33, [utm35]) == utm33
    assert site_crs_for(none, none, [utm35, none]) == utm35
    assert not site_crs_for(none, none, []).isValid()


def test_layers_in_different_crss_need_one_to_be_chosen(qgis_app):
    """Nothing transforms into a CRS that is not known: their coordinates would be mixed as they are."""
    none, utm33, utm35 = crs_of(""), crs_of("EPSG:32633"), crs_of("EPSG:32635")
    with pytest.raises(SiteCrsError, match=r"EPSG:32635.*, EPSG:32633.*: give SITE_CRS"):
        site_crs_for(none, none, [utm35, utm33, utm35])
    assert site_crs_for(none, utm33, [utm35, utm33]) == utm33
    assert site_crs_for(utm35, none, [utm35, utm33]) == utm35
    with pytest.raises(SiteCrsError, match=r"yard, EPSG:32635"):
        site_crs_for(none, none, [engineering(), utm35])
    assert not site_crs_for(none, none, [engineering(), engineering(name="other")]).isValid()


def test_layers_in_one_engineering_crs_do_not_need_the_project_to_be_in_it(qgis_app):
    none, web = crs_of(""), crs_of("EPSG:3857")
    assert site_crs_for(none, web, [engineering(), engineering()]) == engineering()
    with pytest.raises(SiteCrsError, match="EPSG:3857"):
        site_crs_for(none, web, [engineering(), engineering(name="other")])


@pytest.mark.parametrize("name", ["Undefined SRS", "Undefined Cartesian SRS"])
def test_a_crs_that_says_it_is_undefined_is_none(qgis_app, name):
    assert not stated_crs(engineering(name=name)).isValid()
    assert stated_crs(engineering()) == engineering()


def test_a_geopackage_without_a_crs_says_none(qgis_app, tmp_path):
    """Its layer comes in degrees of an "Undefined geographic SRS"."""
    file = str(tmp_path / "plan.gpkg")
    source = ogr.GetDriverByName("GPKG").CreateDataSource(file)
    source.CreateLayer("walls", None, ogr.wkbLineString)
    source = None
    assert not stated_crs(QgsVectorLayer(f"{file}|layername=walls", "walls", "ogr").crs()).isValid()
    assert stated_crs(crs_of("EPSG:4326")) == crs_of("EPSG:4326")


def test_a_crs_with_a_code_is_stated(qgis_app):
    assert stated_crs(crs_of("EPSG:32633")) == crs_of("EPSG:32633")
