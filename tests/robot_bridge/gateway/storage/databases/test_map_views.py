"""The fleet as GIS programs see it, by views of the database: places in the site's CRS and in WGS 84."""

from __future__ import annotations

import math
import sqlite3
import subprocess
import sys
from contextlib import closing
from pathlib import Path

import numpy as np
import pytest
from osgeo import ogr
from sqlalchemy import create_engine, insert, make_url, text
from sqlalchemy.exc import DBAPIError

from robot_bridge.core.robotmap.outlines import Outlines
from robot_bridge.core.sites.frame import SiteBounds, SiteFrame, projections
from robot_bridge.core.sites.settings import SiteSettings
from robot_bridge.core.sites.site import write_site
from robot_bridge.gateway.storage.database import run_once
from robot_bridge.gateway.storage.map_views import MapViewError, map_views_on, views_made_again
from robot_bridge.gateway.storage.schema import commands, observations, placements, robots, trajectories
from tests.support.bridge.command_line import run_command

FRAME = SiteFrame("EPSG:32633", (532700.0, 5190400.0), rotation=0.7)
NOW = 1_790_000_000.0
LAYERS = ["cones", "commands", "observations", "robots", "trajectories"]


def fill(connection):
    """Two robots, one of which has moved; a target, a path and an Abort; a cone; an observation."""
    connection.execute(
        insert(robots),
        [
            {"name": name, "magic": 1, "link": "websocket", "received_at": NOW, "ended_in_order": 0}
            for name in ("r1", "r2")
        ],
    )
    fixes = [("r1", 1.0, 2.0, 0.0), ("r1", 30.0, 40.0, math.pi), ("r2", -5.5, 8.0, -3.0)]
    connection.execute(
        insert(trajectories),
        [
            {"robot": robot, "received_at": NOW + n, "x": x, "y": y, "theta": theta, "v": 1.0}
            for n, (robot, x, y, theta) in enumerate(fixes)
        ],
    )
    given = [
        ("c1", "SetPosEnd", '{"x": 7.0, "y": 9.0}'),
        ("c2", "SetPath", '{"points": [[1.0, 2.0], [11.0, 13.0], [20.0, 13.0]]}'),
        ("c3", "Abort", "{}"),
    ]
    connection.execute(
        insert(commands),
        [
            {
                "id": id,
                "robot": "r1",
                "op": op,
                "params": params,
                "operator": "anna",
                "state": "sent",
                "sa_id": n,
                "created_at": NOW,
            }
            for n, (id, op, params) in enumerate(given)
        ],
    )
    stood = {"planned_x": 1.0, "planned_y": 1.0, "x": 3.0, "y": 4.0, "theta": 0.5, "deviation": 0.1}
    connection.execute(insert(placements).values(task="t1", robot="r1", command="c1", placed_at=NOW, **stood))
    connection.execute(
        insert(observations).values(
            robot="r1", kind="object", object="bench", x=6.0, y=5.0, received_at=NOW, state="new"
        )
    )


EXPECTED = {
    "robots": {("r1", 30.0, 40.0), ("r2", -5.5, 8.0)},
    "trajectories": {("r1", 1.0, 2.0), ("r1", 30.0, 40.0), ("r2", -5.5, 8.0)},
    "cones": {("r1", 3.0, 4.0)},
    "observations": {("r1", 6.0, 5.0)},
    "commands": {("r1", 7.0, 9.0), ("r1", 20.0, 13.0)},
}


def expected(layer: str) -> set[tuple[str, float, float]]:
    """Robot, easting and northing of the rows of a layer, in centimetres of the CRS."""
    return {(robot, *FRAME.to_crs([[x, y]])[0].round(2).tolist()) for robot, x, y in EXPECTED[layer]}


def in_layer(layer) -> set[tuple[str, float, float]]:
    """The same of what GDAL reads."""
    found = set()
    for feature in layer:
        if (point := feature.GetGeometryRef()) is not None:
            found.add((feature["robot"], round(point.GetX(), 2), round(point.GetY(), 2)))
    return found


@pytest.fixture(scope="module")
def site(tmp_path_factory) -> Path:
    folder = tmp_path_factory.mktemp("views") / "site"
    bounds = SiteBounds(-50.0, -50.0, 50.0, 50.0)
    degrees = math.degrees(FRAME.rotation)
    settings = SiteSettings("views", "Views", 1, FRAME.crs, FRAME.origin, bounds, degrees)
    write_site(folder, settings, Outlines.from_rows([]), [], [], [])
    return folder


@pytest.fixture(scope="module")
def model(new_database, postgis_server) -> str:
    """The name of a database with PostGIS, rows and views, of which each test has a copy."""
    url = new_database.another("postgresql")
    name = make_url(url).database
    postgis_server.sql("create extension postgis", name)
    run_once(url, fill)
    run_once(url, lambda connection: map_views_on(connection).make(FRAME))
    return name


@pytest.fixture
def postgis(model, postgis_server):
    """A PostgreSQL with PostGIS, rows and views, and the URL of its administrator."""
    url = postgis_server.copied_database(model)
    return url, postgis_server.admin_url(url)


@pytest.fixture
def reader(postgis, tmp_path):
    """The URL of an account that reads the views, made as an administrator makes it."""
    secret = tmp_path / "password"
    secret.write_text("Looking-on\n", encoding="utf-8")
    secret.chmod(0o600)
    name = f"looker{make_url(postgis[0]).database[-8:]}"
    words = ("database", "reader", name, "--password-file", str(secret), "--database", postgis[1])
    done = run_command(*words)
    assert done.returncode == 0, done.stderr
    yield make_url(postgis[0]).set(username=name, password="Looking-on")
    with closing(create_engine(postgis[1], isolation_level="AUTOCOMMIT").connect()) as connection:
        connection.execute(text(f'drop owned by "{name}"'))
        connection.execute(text(f'drop role "{name}"'))


def gdal_address(url) -> str:
    names = {"host": url.host, "port": url.port, "dbname": url.database, "user": url.username}
    return "PG:" + " ".join(f"{name}={value}" for name, value in {**names, "password": url.password}.items())


def test_gdal_reads_places_in_the_sites_crs_and_in_wgs84(reader):
    source = ogr.Open(gdal_address(reader) + " schemas=fleet_map")
    for name in LAYERS:
        layer = source.GetLayerByName(f"{name}(geom)")
        assert layer.GetSpatialRef().GetAuthorityCode(None) == "32633"
        assert in_layer(layer) == expected(name), name
    to_degrees = projections().Transformer.from_crs(FRAME.crs, 4326, always_xy=True)
    wanted = {(robot, *np.round(to_degrees.transform(x, y), 7)) for robot, x, y in expected("robots")}
    found = source.GetLayerByName("robots(geom_4326)")
    places = {(one["robot"], one.GetGeometryRef().GetX(), one.GetGeometryRef().GetY()) for one in found}
    assert {robot for robot, *_ in places} == {"r1", "r2"}
    for robot, *place in places:
        (near,) = [degrees for name, *degrees in wanted if name == robot]
        assert np.allclose(place, near, atol=2e-7)  # a centimetre, to which eastings are rounded here
    (path,) = source.GetLayerByName("paths(geom)")
    line = FRAME.to_crs([[1.0, 2.0], [11.0, 13.0], [20.0, 13.0]])
    assert np.allclose(np.array(path.GetGeometryRef().GetPoints())[:, :2], line)


def test_headings_are_clockwise_from_north(reader, tmp_path):
    with closing(create_engine(reader).connect()) as connection:
        found = dict(connection.execute(text("select robot, heading from fleet_map.robots")).all())
    assert found == pytest.approx(
        {
            "r1": (90 - math.degrees(math.pi + FRAME.rotation)) % 360,
            "r2": (90 - math.degrees(-3.0 + FRAME.rotation)) % 360,
        }
    )


def test_qgis_reads_them_as_layers(reader):
    code = """
import sys
from qgis.core import QgsApplication, QgsDataSourceUri, QgsVectorLayer
application = QgsApplication([], False)
application.initQgis()
uri = QgsDataSourceUri()
uri.setConnection(*sys.argv[1:6])
uri.setDataSource("fleet_map", "robots", "geom", "", "robot")
layer = QgsVectorLayer(uri.uri(False), "robots", "postgres")
print(layer.isValid(), layer.crs().authid(), sorted(one["robot"] for one in layer.getFeatures()))
"""
    words = [reader.host, str(reader.port), reader.database, reader.username, reader.password]
    done = subprocess.run([sys.executable, "-c", code, *words], capture_output=True, text=True, timeout=120)
    assert "True EPSG:32633 ['r1', 'r2']" in done.stdout, done


@pytest.mark.parametrize(
    "statement",
    [
        "select * from public.commands",
        "select * from public.rr",
        "select hash from public.tokens",
        "insert into public.rr (robot, op) values ('r1', 'Ready')",
        "delete from fleet_map.cones",
        "update fleet_map.cones set x = 0",
        "create table public.mine (n int)",
        "create table fleet_map.mine (n int)",
    ],
)
def test_a_reader_may_do_nothing_else(reader, statement):
    with closing(create_engine(reader).connect()) as connection, pytest.raises(DBAPIError, match="denied"):
        connection.execute(text(statement))


def test_views_do_not_keep_tables_from_being_upgraded(postgis, reader):
    change = text("alter table trajectories alter column v type real")

    def upgrade(connection):
        with views_made_again(connection):
            connection.execute(change)

    with pytest.raises(Exception, match="used by a view"):
        run_once(postgis[0], lambda connection: connection.execute(change))
    run_once(postgis[0], upgrade)
    with closing(create_engine(reader).connect()) as connection:
        assert connection.execute(text("select count(*) from fleet_map.robots")).scalar() == 2


def test_views_are_made_and_removed_by_the_command(postgis, site):
    url = postgis[0]
    done = run_command("database", "views", "--site", str(site), "--database", url)
    assert done.returncode == 0, done
    assert "fleet_map.robots, fleet_map.trajectories" in done.stdout
    assert run_command("database", "check", "--database", url).returncode == 0
    done = run_command("database", "views", "--remove", "--database", url)
    assert done.returncode == 0, done
    with closing(create_engine(url).connect()) as connection:
        assert (
            connection.execute(text("select count(*) from pg_views where schemaname = 'fleet_map'")).scalar()
            == 0
        )


def test_a_database_without_postgis_says_what_to_do(new_database, site):
    done = run_command("database", "views", "--site", str(site), "--database", new_database("postgresql"))
    assert done.returncode == 1
    assert "create extension postgis" in done.stderr


def test_mariadb_has_none(new_database, site):
    done = run_command("database", "views", "--site", str(site), "--database", new_database("mariadb"))
    assert done.returncode == 1
    assert "Use PostgreSQL with PostGIS, or SQLite" in done.stderr


def test_a_crs_without_a_code_is_refused(new_database):
    frame = SiteFrame("+proj=tmerc +lat_0=47 +lon_0=16.8 +datum=WGS84 +units=m", (0.0, 0.0))
    with pytest.raises(MapViewError, match="no EPSG code"):
        run_once(new_database("sqlite"), lambda connection: map_views_on(connection).make(frame))


def test_gdal_reads_sqlite_through_the_file_that_is_written(new_database, site, tmp_path):
    url, vrt = new_database("sqlite"), tmp_path / "fleet.vrt"
    run_once(url, fill)
    words = ("database", "views", "--site", str(site), "--vrt", str(vrt), "--database", url)
    done = run_command(*words)
    assert done.returncode == 0, done
    source = ogr.Open(str(vrt))
    for name in LAYERS:
        layer = source.GetLayerByName(name)
        assert layer.GetSpatialRef().GetAuthorityCode(None) == "32633"
        assert in_layer(layer) == expected(name), name
    assert run_command("database", "check", "--database", url).returncode == 0
    assert run_command("database", "upgrade", "--database", url).returncode == 0
    with closing(sqlite3.connect(make_url(url).database)) as connection:
        heading = connection.execute("select heading from map_robots where robot = 'r2'").fetchone()[0]
    assert heading == pytest.approx((90 - math.degrees(-3.0 + FRAME.rotation)) % 360)


def test_the_site_of_the_environment_keeps_no_views_from_being_removed(new_database, site):
    words, env = ("database", "views", "--database", new_database("sqlite")), {"ROBOT_BRIDGE_SITE": str(site)}
    assert "made map_robots" in run_command(*words, env=env).stdout
    assert "the views are removed" in run_command(*words, "--remove", env=env).stdout
    done = run_command(*words, "--remove", "--site", str(site), env=env)
    assert done.returncode == 1 and "give --site FOLDER to make the views, or --remove" in done.stderr


def test_a_file_that_cannot_be_written_is_named(new_database, site, tmp_path):
    vrt = tmp_path / "none" / "fleet.vrt"
    words = (
        "database",
        "views",
        "--site",
        str(site),
        "--vrt",
        str(vrt),
        "--database",
        new_database("sqlite"),
    )
    done = run_command(*words)
    assert done.returncode == 1
    assert f"{vrt} cannot be written: No such file or directory" in done.stderr
    assert "Traceback" not in done.stderr
