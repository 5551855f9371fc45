"""Published roads keep their directions, speeds, levels and closures, and the gateway's paths honour them."""

from __future__ import annotations

import sqlite3

import pytest
from fleet_supervisor.robot_bridge.core.sites.geopackage import Centreline
from fleet_supervisor.robot_bridge.core.sites.site import read_site, write_site
from qgis.core import QgsProcessingContext, QgsProject

FIELDS = (
    "&field=width_m:double&field=oneway:string&field=maxspeed:string&field=closed:string&field=bridge:string"
)
ROADS = [
    ("LINESTRING(0 0, 50 0)", 6.0, "-1", "36", "no", None),
    ("LINESTRING(0 0, 0 40)", 6.0, "yes", None, "no", "viaduct"),
    ("LINESTRING(0 40, 50 0)", 6.0, None, None, "yes", "no"),
]


@pytest.fixture
def folder(provider, listener, make_layer, tmp_path):
    """The folder of a site with three roads."""
    import processing

    context = QgsProcessingContext()
    context.setProject(QgsProject())
    given = {"FOLDER": str(tmp_path / "site"), "SITE_ID": "yard", "SITE_CRS": "EPSG:32633"}
    roads = make_layer("roads", fields=FIELDS, features=ROADS)
    processing.run(
        "fleet:publishsite", {**given, "ROAD_CENTRELINES": [roads]}, context=context, feedback=listener
    )
    return tmp_path / "site"


def traffic(line: Centreline):
    return line.direction, line.speed_ms, line.closed, line.level


def test_what_is_known_of_the_traffic_is_published(folder):
    lines = read_site(folder).centrelines
    assert [traffic(line) for line in lines] == [(-1, 10.0, False, 0), (1, 1.0, False, 1), (0, 1.0, True, 0)]


def test_it_survives_being_written_without_qgis(folder, tmp_path):
    site = read_site(folder)
    write_site(tmp_path / "again", site.settings, site.outlines, site.centrelines, [], [])
    again = read_site(tmp_path / "again").centrelines
    assert [traffic(line) for line in again] == [traffic(line) for line in site.centrelines]


def test_sites_published_before_have_open_roads_on_the_ground_driven_both_ways(folder):
    with sqlite3.connect(folder / "site.gpkg") as connection:
        triggers = connection.execute("select name from sqlite_master where type = 'trigger'").fetchall()
        for (name,) in triggers:
            connection.execute(f'drop trigger "{name}"')
        for name in ("direction", "speed_ms", "closed", "level"):
            connection.execute(f"alter table road_centrelines drop column {name}")
    connection.close()
    assert {traffic(line) for line in read_site(folder).centrelines} == {(0, 1.0, False, 0)}
