"""A project and the live fleet by QGIS Server, as clients of others read it: GDAL, OWSLib and QGIS itself."""

from __future__ import annotations

import base64
import contextlib
import json
import os
import re
import ssl
import sys
import time
import urllib.error
import urllib.parse
import urllib.request
from collections.abc import Callable
from contextlib import closing
from http.client import HTTPSConnection
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from osgeo import gdal, ogr
from qgis.core import (
    Qgis,
    QgsMapRendererParallelJob,
    QgsMapSettings,
    QgsProject,
    QgsRasterLayer,
    QgsRectangle,
    QgsVectorLayer,
)
from qgis.PyQt.QtCore import QSize
from qgis.PyQt.QtGui import QImage
from sqlalchemy import insert, make_url

from robot_bridge.core.sites.settings import read_settings
from robot_bridge.gateway.auth import certificates
from robot_bridge.gateway.storage import revisions
from robot_bridge.gateway.storage.database import run_once
from robot_bridge.gateway.storage.map_views import map_views_on, virtual_layers
from robot_bridge.gateway.storage.schema import robots, trajectories
from tests.support.databases.database_server import find_program
from tests.support.databases.postgresql import PostgreSql
from tests.support.errors import StageError
from tests.support.processes import Processes, free_port
from tools import serve_maps

ROOT = Path(__file__).resolve().parents[2]
PROGRAM = Path(serve_maps.__file__)
SITE = ROOT / "resources" / "sample_site"
FRAME = read_settings(SITE / "site.toml").frame
NOW = 1_790_000_000.0
EXTENT = (640420.0, 5193485.0, 640500.0, 5193545.0)
SIZE = (640, 480)
NGINX_WRITES = ("client_body", "proxy", "fastcgi", "uwsgi", "scgi")
ENVIRONMENT = {"QT_QPA_PLATFORM": "offscreen"}


IN_POSTGIS = "Robots_in_PostGIS"
"""A layer of the same robots in PostgreSQL."""


class Services:
    """QGIS Server on the sample project, with a fleet in a SQLite file, and robots on ``postgis``."""

    def __init__(self, folder: Path, processes: Processes, postgis: PostgreSql | None = None) -> None:
        self.folder, self.processes = folder, processes
        self.postgis = postgis
        self.database = f"sqlite:///{folder}/fleet.db"
        self.fleet, self.project = folder / "fleet.vrt", folder / "written.qgs"
        run_once(self.database, revisions.create)
        run_once(self.database, self._fill)
        self.fleet.write_text(virtual_layers(f"{folder}/fleet.db", FRAME), "utf-8")
        self.port = free_port()
        command = [PROGRAM, "--fleet", self.fleet]
        if postgis is not None:
            command += ["--project", self._with_postgis(postgis)]
        assert run_here([*command, "--write", self.project]) == 0
        command = [sys.executable, *command, "--port", str(self.port)]
        processes.start("services", command, env={**os.environ, **ENVIRONMENT})
        processes.wait_for_line("services", "listening on", 120)
        self.url = f"http://127.0.0.1:{self.port}/"

    def move(self, robot: str, x: float, y: float, after: float) -> None:
        """Store where a robot is ``after`` so many seconds."""
        fix = {"robot": robot, "received_at": NOW + after, "x": x, "y": y, "theta": 0.0, "v": 1.0}
        run_once(self.database, lambda connection: connection.execute(insert(trajectories), [fix]))

    def get(self, path: str = "", **query: str) -> bytes:
        """Return what a request is answered with."""
        address = f"{self.url}{path}?{urllib.parse.urlencode(query)}"
        with urllib.request.urlopen(address, timeout=120) as answer:
            return answer.read()

    def refusal(self, body: bytes | None = None, path: str = "", **query: str) -> str:
        """Return why a request is refused; fails where it is answered."""
        address = f"{self.url}{path}?{urllib.parse.urlencode(query)}"
        with pytest.raises(urllib.error.HTTPError) as refused:
            urllib.request.urlopen(address, data=body, timeout=120)
        assert refused.value.code == 400
        return refused.value.read().decode()

    def statements(self, do: Callable[[], Any]) -> list[str]:
        """Return what reaches the views of PostgreSQL while something is done, from the server's own log."""
        log = self.postgis.folder / "server.log"
        begin = log.stat().st_size
        do()
        lines = log.read_bytes()[begin:].decode().splitlines()
        return [line for line in lines if "fleet_map" in line]

    def _with_postgis(self, server: PostgreSql) -> Path:
        """Return a copy of the sample project with a layer of the robots in PostgreSQL."""
        url = server.new_database()
        name = make_url(url).database
        server.sql("create extension postgis", name)
        server.sql(f"alter database \"{name}\" set log_statement = 'all'", name)
        run_once(url, revisions.create)
        run_once(url, self._fill)
        project = QgsProject()
        assert project.read(str(serve_maps.SAMPLE))
        layer = serve_maps.fleet_layers(url)[-1]
        layer.setName(IN_POSTGIS)
        project.addMapLayer(layer)
        project.setFilePathStorage(Qgis.FilePathType.Absolute)
        file = self.folder / "with_postgis.qgs"
        assert project.write(str(file))
        project.clear()
        return file

    @staticmethod
    def _fill(connection) -> None:
        names = [{"name": name, "magic": 1, "link": "websocket"} for name in ("r1", "r2")]
        connection.execute(
            insert(robots), [{**one, "received_at": NOW, "ended_in_order": 0} for one in names]
        )
        fixes = [("r1", 20.0, 30.0), ("r2", 50.0, 40.0)]
        connection.execute(
            insert(trajectories),
            [{"robot": r, "received_at": NOW, "x": x, "y": y, "theta": 0.5, "v": 1.0} for r, x, y in fixes],
        )
        map_views_on(connection).make(FRAME)


def run_here(words) -> int | str | None:
    """Run ``serve_maps.py`` in this process, which has QGIS already; return what it ends with."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(sys, "argv", list(map(str, words)))
        try:
            return serve_maps.main()
        except SystemExit as end:
            return end.code


@pytest.fixture(scope="module")
def services(request, tmp_path_factory, qgis_app):
    try:
        find_program("qgis_mapserver", "/usr/bin")
    except StageError as error:
        pytest.skip(f"{error}; run: make setup")
    try:
        postgis = request.getfixturevalue("postgis_server")
    except pytest.skip.Exception:
        postgis = None
    folder = tmp_path_factory.mktemp("services")
    # GDAL keeps tiles below the folder that it runs in.
    gdal.SetConfigOption("GDAL_DEFAULT_WMS_CACHE_PATH", str(folder / "tiles"))
    with Processes(folder / "logs") as processes:
        yield Services(folder, processes, postgis)


@pytest.fixture
def postgis(services):
    if services.postgis is None:
        pytest.skip("PostgreSQL with PostGIS is not installed; run: make setup")
    return services


def places(layer) -> dict[str, tuple[float, float]]:
    """Return where a layer of OGR's has its robots, in the site frame."""
    found = {}
    for feature in layer:
        point = feature.GetGeometryRef()
        (place,) = FRAME.to_site([[point.GetX(), point.GetY()]]).round(2).tolist()
        found[feature["robot"]] = tuple(place)
    return found


def test_wms_paints_what_the_desktop_paints(services, qgis_app):
    from owslib.wms import WebMapService

    wms = WebMapService(services.url, version="1.3.0")
    names = ["Orthophoto", "Road surfaces", "Buildings", "Walls", "Robots"]
    assert set(names) <= set(wms.contents)
    image = wms.getmap(
        layers=names, srs=FRAME.crs, bbox=EXTENT, size=SIZE, format="image/png", transparent=False
    )
    served = pixels(QImage.fromData(image.read()))

    project = QgsProject()
    assert project.read(str(services.project))
    settings = QgsMapSettings()
    settings.setLayers([project.mapLayersByName(name)[0] for name in reversed(names)])
    settings.setDestinationCrs(project.crs())
    settings.setExtent(QgsRectangle(*EXTENT))
    settings.setOutputSize(QSize(*SIZE))
    job = QgsMapRendererParallelJob(settings)
    job.start()
    job.waitForFinished()
    drawn = pixels(job.renderedImage())
    project.clear()
    assert drawn.std() > 20  # a picture, and no plain ground
    # Two renderers: edges are smoothed a little differently, and nothing else.
    assert np.abs(served - drawn).mean() < 2.0
    assert (np.abs(served - drawn).max(axis=2) > 60).mean() < 0.01


def pixels(image: QImage) -> np.ndarray:
    image = image.convertToFormat(QImage.Format.Format_RGB32)
    bits = image.constBits()
    bits.setsize(image.sizeInBytes())
    return (
        np.frombuffer(bytes(bits), np.uint8).reshape(image.height(), image.width(), 4)[..., :3].astype(float)
    )


def test_gdal_and_owslib_read_tiles(services):
    from owslib.wmts import WebMapTileService

    tiles = WebMapTileService(f"{services.url}?SERVICE=WMTS&REQUEST=GetCapabilities")
    assert {"Orthophoto", "Robots"} <= set(tiles.contents)
    assert {FRAME.crs, "EPSG:3857"} <= set(tiles.tilematrixsets)
    address = (
        f"WMTS:{services.url}?SERVICE=WMTS&REQUEST=GetCapabilities,layer=Orthophoto,tilematrixset=EPSG:3857"
    )
    source = gdal.Open(address)
    corner = gdal.InvGeoTransform(source.GetGeoTransform())
    x, y = web_mercator(*FRAME.to_crs([[40.0, 30.0]])[0])
    column, row = (int(value) for value in gdal.ApplyGeoTransform(corner, x, y))
    assert source.GetRasterBand(1).ReadAsArray(column - 60, row - 60, 120, 120).std() > 5


def web_mercator(east: float, north: float) -> tuple[float, float]:
    from pyproj import Transformer

    return Transformer.from_crs(FRAME.crs, 3857, always_xy=True).transform(east, north)


def test_features_are_read_by_gdal_and_owslib_and_follow_the_robots(services):
    from owslib.wfs import WebFeatureService

    wfs = WebFeatureService(services.url, version="1.1.0")
    assert {"Robots", "Road_surfaces", "Road_centrelines", "Trajectories"} <= set(wfs.contents)
    services.move("r1", 21.0, 31.0, after=1.0)
    source = ogr.Open(f"WFS:{services.url}?SERVICE=WFS&VERSION=1.1.0")
    assert places(source.GetLayerByName("Robots")) == {"r1": (21.0, 31.0), "r2": (50.0, 40.0)}
    surfaces = source.GetLayerByName("Road_surfaces").GetFeatureCount()
    own = ogr.Open(str(SITE / "sample_site.gpkg"))
    assert surfaces == own.GetLayerByName("road_surfaces").GetFeatureCount()
    services.move("r1", 22.0, 33.0, after=2.0)
    source = ogr.Open(f"WFS:{services.url}?SERVICE=WFS&VERSION=1.1.0")
    assert places(source.GetLayerByName("Robots"))["r1"] == (22.0, 33.0)


def test_ogc_api_features_is_read_by_gdal_and_over_http(services):
    source = ogr.Open(f"OAPIF:{services.url}wfs3")
    assert source.GetLayerByName("Robots").GetFeatureCount() == 2
    page = json.loads(services.get("wfs3/collections/Robots/items.json", robot="r2"))
    (feature,) = page["features"]
    assert feature["properties"]["robot"] == "r2" and feature["properties"]["heading"] >= 0


@pytest.mark.parametrize(
    ("datetime", "robots"),
    [
        ("2026-09-21T14:13:20Z", {"r1", "r2"}),
        ("2026-09-21T14:13:00Z/2026-09-21T14:13:20Z", {"r1", "r2"}),
        ("../2026-09-21T14:13:19Z", set()),
        ("2026-09-21T14:13:30Z/..", set()),
    ],
)
def test_trajectories_are_asked_for_by_time(services, datetime, robots):
    page = json.loads(services.get("wfs3/collections/Trajectories/items.json", datetime=datetime))
    assert {one["properties"]["robot"] for one in page["features"]} == robots


def test_qgis_is_a_client_too(services, qgis_app):
    picture = QgsRasterLayer(
        f"contextualWMSLegend=0&crs={FRAME.crs}&format=image/png&layers=Robots&styles=&url={services.url}",
        "w",
        "wms",
    )
    assert picture.isValid(), picture.error().summary()
    features = QgsVectorLayer(
        f"url='{services.url}' typename='Robots' version='1.1.0' srsname='{FRAME.crs}'", "f", "WFS"
    )
    assert features.isValid(), features.error().summary()
    assert sorted(one["robot"] for one in features.getFeatures()) == ["r1", "r2"]


MAP = {
    **{"SERVICE": "WMS", "REQUEST": "GetMap", "VERSION": "1.3.0", "LAYERS": "Robots", "CRS": "EPSG:4326"},
    **{"BBOX": "46,16,47,17", "WIDTH": "9", "HEIGHT": "9", "FORMAT": "image/png"},
}
INFO = MAP | {
    **{"REQUEST": "GetFeatureInfo", "CRS": FRAME.crs, "BBOX": ",".join(map(str, EXTENT))},
    **{"WIDTH": "640", "HEIGHT": "480", "QUERY_LAYERS": "Robots", "INFO_FORMAT": "application/json"},
    **{"I": "320", "J": "240", "FI_POINT_TOLERANCE": "1000000000", "FEATURE_COUNT": "1000000000"},
}
LEGEND = {"SERVICE": "WMS", "REQUEST": "GetLegendGraphic", "LAYER": "Robots", "FORMAT": "image/png"}
GET_FEATURE = {"SERVICE": "WFS", "VERSION": "1.1.0", "REQUEST": "GetFeature", "TYPENAME": "Robots"}
ENV = "<Function name='env'><Literal>HOME</Literal></Function>"


@pytest.mark.parametrize(
    ("query", "said"),
    [
        (MAP | {"map": "/srv/other.qgz"}, "MAP is no parameter"),
        ({"MAP": "/srv/other.qgz"}, "a path below /wfs3"),
        (MAP | {"SLD": "http://127.0.0.1/"}, "SLD is no parameter"),
        (MAP | {"SLD_BODY": "<a/>"}, "SLD_BODY is no parameter"),
        (MAP | {"HIGHLIGHT_SYMBOL": "<a/>"}, "HIGHLIGHT_SYMBOL is no parameter"),
        (MAP | {"LAYERS": "EXTERNAL_WMS:a", "a:url": "http://127.0.0.1/"}, "A?URL is no parameter"),
        (MAP | {"FILTER": "Robots:" + ENV}, "no functions"),
        (MAP | {"LAYERS": "Walls,walls"}, "LAYERS names a layer twice"),
        (MAP | {"WIDTH": "4097"}, "WIDTH is a number of at most 4096"),
        (INFO | {"HEIGHT": "20000"}, "HEIGHT is a number of at most 4096"),
        (INFO | {"QUERY_LAYERS": "Robots,robots"}, "QUERY_LAYERS names a layer twice"),
        (INFO | {"FILTER_GEOM": "POINT(0 0)"}, "FILTER_GEOM is no parameter"),
        (INFO | {"WITH_MAPTIP": "1"}, "WITH_MAPTIP is no parameter"),
        (LEGEND | {"SYMBOLWIDTH": "4000"}, "SYMBOLWIDTH is no parameter"),
        (LEGEND | {"DPI": "100000"}, "DPI is a number of at most 1200"),
        (MAP | {"FORMAT": "application/dxf"}, "FORMAT is none"),
        *(
            (MAP | {"REQUEST": request}, "REQUEST of WMS is one of")
            for request in ("GetPrint", "GetProjectSettings", "GetStyles", "GetContext")
        ),
        ({}, "a path below /wfs3"),
        ({"path": "wfs3/collections", "MAP": "/srv/other.qgz"}, "MAP is no parameter"),
        (GET_FEATURE | {"EXP_FILTER": "env('HOME') = '/'"}, "EXP_FILTER is no parameter"),
        (GET_FEATURE | {"FILTER": f"<Filter>{ENV}</Filter>"}, "no functions"),
        (GET_FEATURE | {"FILTER": "<!DOCTYPE a [<!ENTITY b 'c'>]><Filter>&b;</Filter>"}, "no entities"),
        (GET_FEATURE | {"SORTBY": "\"v\"*(env('HOME')~'/')"}, "SORTBY may hold names"),
        (GET_FEATURE | {"REQUEST": "Transaction"}, "REQUEST of WFS is one of"),
        ({"SERVICE": "WCS", "REQUEST": "GetCapabilities"}, "SERVICE is one of"),
    ],
)
def test_what_reaches_beyond_the_project_is_refused(services, query, said):
    assert said in services.refusal(**query)


INJECTIONS = (
    "\"robot\" = 'r1' or pg_sleep(9) IS NULL",
    "\"robot\" = (select(pg_read_file('/etc/passwd')))",
    "\"robot\" = 'r1'; drop table robots",
    "\"robot\" = 'r1' -- '",
    "\"robot\" = 'r1' /* ' */",
    '"robot"::regclass IS NULL',
    "\"robot\" = cast('r1' AS text)",
    "\"robot\" = E'\\' or true --'",
    "\"robot\" = U&'\\0072'",
    'U&"\\0072obot" IS NULL',
    '"robot" = $$r1$$',
    '"robot" = $a$r1$a$',
    '"a""b" = 1 OR "c" ( 1 )',
    "\"robot\" ~ 'r'",
    # Functions by a point, and what is a letter or a space for one side alone.
    '"robots"."row_to_json" IS NOT NULL',
    '"robots" . "pg_typeof" IS NOT NULL',
    '"robot" I\u017f NULL',
    "\"robot\" L\u0130KE 'r1'",
    '"x" =\u00a05',
    # PostgreSQL reads up to there.
    "\"robot\" = 'r1\0'",
    '"robot\0" IS NULL',
)


@pytest.mark.parametrize("request_", [MAP, INFO], ids=["GetMap", "GetFeatureInfo"])
@pytest.mark.parametrize(
    "condition",
    [
        "env('HOME') LIKE '/%'",
        "file_size('/etc/passwd') > 1",
        "eval('1 = 1')",
        "aggregate('Walls', 'count', 1) > 0",
        # All that follow pass the check of QGIS Server.
        "'a'||env('HOME')||'b'",
        "'1'=(select(count(*))from(sqlite_master))or'1'='2'",
        '"pg_sleep" ( 9 )',
        "'a\\'=env('HOME')||'b'",
        "'a'='a';<a/>",
    ],
)
def test_a_filter_of_a_map_compares_fields_with_values_and_does_nothing_else(services, request_, condition):
    assert "FILTER may compare" in services.refusal(**request_, FILTER=f"Robots:{condition}")


def test_features_at_a_place_are_those_of_the_layers_and_of_the_filter(services):
    def found(**query):
        return {one["properties"]["robot"] for one in json.loads(services.get(**INFO, **query))["features"]}

    assert found() == {"r1", "r2"}
    assert found(FILTER="Robots:\"robot\" IN ( 'r2' , 'r3' ) AND \"v\" >= 0.5;") == {"r2"}


@pytest.mark.parametrize("layer", ["Robots", IN_POSTGIS])
@pytest.mark.parametrize(
    ("condition", "robots"),
    [
        ("\"robot\" = 'r2'", {"r2"}),
        ("'r1' = \"robot\"", {"r1"}),
        ("\"robot\" != 'r2'", {"r1"}),
        ("\"robot\" IN ( 'r2' , 'r3' )", {"r2"}),
        ("\"robot\" NOT IN ( 'r2' )", {"r1"}),
        ("\"robot\" like 'r%'", {"r1", "r2"}),
        ("\"robot\" NOT LIKE '_2'", {"r1"}),
        ("\"robot\" ILIKE 'R2'", {"r2"}),
        ('"robot" IS NULL', set()),
        ('NOT "robot" IS NULL', {"r1", "r2"}),
        ('"theta" >= -5 AND ( "theta" < 0.75 OR "v" = 0.5 )', {"r1", "r2"}),
        ('"seen_at" > \'2026-09-21\' AND "v" = 1', {"r1", "r2"}),
        ("\"seen_at\" > '2026-09-22'", set()),
        ("\"robot\" = 'ő' OR \"link\" = '--'", set()),
    ],
)
def test_a_filter_of_a_map_chooses_the_same_on_each_database(postgis, layer, condition, robots):
    asked = INFO | {"LAYERS": layer, "QUERY_LAYERS": layer, "FILTER": f"{layer}:{condition}"}
    assert robots_in(postgis.get(**asked)) == robots


def robots_in(page: bytes) -> set[str]:
    return {one["properties"]["robot"] for one in json.loads(page)["features"]}


@pytest.mark.parametrize("condition", INJECTIONS)
def test_no_statement_comes_of_what_is_no_comparison(postgis, condition):
    asked = MAP | {"LAYERS": IN_POSTGIS, "FILTER": f"{IN_POSTGIS}:{condition}"}
    assert postgis.statements(lambda: postgis.refusal(**asked)) == []


def test_a_comparison_reaches_the_database_as_it_is(postgis):
    asked = MAP | {"LAYERS": IN_POSTGIS, "FILTER": f"{IN_POSTGIS}:\"robot\" = 'r1'"}
    assert any("\"robot\" = 'r1'" in line for line in postgis.statements(lambda: postgis.get(**asked)))


@pytest.mark.parametrize(
    "value",
    [
        "r1' OR pg_sleep(9) IS NULL --",
        "\\' OR pg_sleep(9) IS NULL --",
        "r1'; select pg_sleep(9); --",
        "$$ || pg_sleep(9) || $$",
        'r1" OR pg_sleep(9) IS NULL --',
        "' || pg_read_file('/etc/passwd') || '",
    ],
)
def test_a_value_that_features_are_compared_with_stays_one(postgis, value):
    features = f"wfs3/collections/{IN_POSTGIS}/items"
    asked = GET_FEATURE | {"TYPENAME": IN_POSTGIS}

    def ask() -> None:
        for path, query in (
            ("", asked | {"FILTER": equal("robot", value)}),
            ("", asked | {"FILTER": equal(value, "r1")}),
            ("", asked | {"FEATUREID": f"{IN_POSTGIS}.{value}"}),
            (f"{features}.json", {"robot": value}),
            (f"{features}/{urllib.parse.quote(value, safe='')}.json", {}),
        ):
            with contextlib.suppress(urllib.error.HTTPError):
                postgis.get(path, **query)

    said = [without_texts(line) for line in postgis.statements(ask)]
    assert said
    assert [line for line in said if "pg_sleep" in line or "pg_read" in line] == []


def without_texts(statement: str) -> str:
    """Return a statement without its texts in single quotes and its names in double quotes."""
    return re.sub(r"""E'(?:[^'\\]|\\.|'')*'|'(?:[^']|'')*'|"(?:[^"]|"")*\"""", "", statement)


def equal(name: str, value: str) -> str:
    same = f"<PropertyName>{name}</PropertyName><Literal>{value}</Literal>"
    return f"<Filter><PropertyIsEqualTo>{same}</PropertyIsEqualTo></Filter>"


@pytest.mark.parametrize("layer", ["Robots", IN_POSTGIS])
def test_filters_of_clients_choose_the_same_on_each_database(postgis, layer, qgis_app):
    from lxml.etree import tostring
    from owslib.fes import PropertyIsLike
    from owslib.wfs import WebFeatureService

    like = tostring(PropertyIsLike("robot", "*2", wildCard="*", singleChar=".", escapeChar="!").toXML())
    wfs = WebFeatureService(postgis.url, version="1.1.0")
    read = wfs.getfeature([layer], filter=f"<Filter>{like.decode()}</Filter>", outputFormat="GeoJSON").read()
    assert robots_in(read) == {"r2"}
    for address in (f"WFS:{postgis.url}?SERVICE=WFS&VERSION=1.1.0", f"OAPIF:{postgis.url}wfs3"):
        source = ogr.Open(address)
        rows = source.GetLayerByName(layer)
        rows.SetAttributeFilter("robot = 'r2'")
        assert [one["robot"] for one in rows] == ["r2"], address
    chosen = "\"robot\" = \\'r2\\'"
    features = QgsVectorLayer(
        f"url='{postgis.url}' typename='{layer}' version='1.1.0' filter='{chosen}'", "f", "WFS"
    )
    assert features.isValid(), features.error().summary()
    assert [one["robot"] for one in features.getFeatures()] == ["r2"]


def test_what_is_refused_of_ogc_api_features_is_the_error_that_its_description_has(services):
    described = json.loads(services.get("wfs3/api"))
    answers = described["paths"]["/wfs3/collections"]["get"]["responses"]["default"]["content"]
    error = described["components"]["schemas"]["exception"]["properties"]
    with pytest.raises(urllib.error.HTTPError) as refused:
        services.get("wfs3/collections", MAP="/srv/other.qgz")
    assert refused.value.code == 400 and refused.value.headers["Content-Type"] in answers
    said = json.loads(refused.value.read())
    assert set(said) == set(error) and "MAP is no parameter" in said["description"]


def test_no_error_says_where_on_this_computer_something_is(services):
    wrong = [
        *({**MAP, name: "none"} for name in ("LAYERS", "BBOX", "CRS", "FORMAT", "STYLES")),
        MAP | {"FILTER": 'Robots:"none" = 1'},
        *({**INFO, name: "none"} for name in ("QUERY_LAYERS", "INFO_FORMAT", "I", "FI_POINT_TOLERANCE")),
        *({**GET_FEATURE, name: value} for name, value in {"TYPENAME": "none", "FILTER": "<Filter>"}.items()),
    ]
    said = [services.refusal(**query) for query in wrong]
    folders = {"/usr", "/etc", "/home", "/root", str(ROOT), str(services.folder), services.project.name}
    assert [(text, one) for text in said for one in folders if one in text] == []


def test_a_body_is_refused_and_so_is_what_it_would_write(services):
    assert "have no body" in services.refusal(b"<Transaction/>")
    with pytest.raises(urllib.error.HTTPError) as refused:
        address = f"{services.url}wfs3/collections/Walls/items/1"
        urllib.request.urlopen(urllib.request.Request(address, method="DELETE"))
    assert refused.value.code == 403


def test_filters_and_orders_that_clients_ask_for_are_answered(services):
    chosen = equal("robot", "r2")
    page = json.loads(services.get(**GET_FEATURE, OUTPUTFORMAT="GeoJSON", FILTER=chosen, SORTBY="robot D"))
    assert [one["properties"]["robot"] for one in page["features"]] == ["r2"]
    assert services.get(**(MAP | {"FILTER": "Robots:\"robot\" = 'r2'"})).startswith(b"\x89PNG")


class Proxy:
    """nginx before the services, by the settings that the guide names."""

    def __init__(self, services: Services, program: str, folder: Path) -> None:
        (folder / "passwords").write_text("ada:{PLAIN}secret\n", "utf-8")
        tls = certificates.create(folder / "tls", ["localhost"], ["127.0.0.1"])
        port, written = free_port(), (ROOT / "resources" / "service" / "maps-proxy.conf").read_text("utf-8")
        for there, here in {
            "listen 443": f"listen 127.0.0.1:{port}",
            "127.0.0.1:8790": f"127.0.0.1:{services.port}",
            "/etc/nginx/maps.passwords": f"{folder}/passwords",
            "/etc/nginx/maps.pem": str(tls.certificate),
            "/etc/nginx/maps-key.pem": str(tls.key),
        }.items():
            assert there in written
            written = written.replace(there, here)
        places = " ".join(f"{kind}_temp_path {folder}/{kind};" for kind in NGINX_WRITES)
        settings = folder / "nginx.conf"
        settings.write_text(
            f"daemon off; pid {folder}/pid; error_log stderr notice; user root; events {{}}\n"
            f"http {{ access_log off; {places}\n{written} }}\n",
            "utf-8",
        )
        services.processes.start("proxy", [program, "-p", folder, "-c", settings])
        services.processes.wait_for_line("proxy", "start worker process ", 60)
        self.url = f"https://localhost:{port}/"
        self._context = ssl.create_default_context(cafile=tls.ca)

    def ask(self, path: str, password: str = "secret", headers: dict[str, str] | None = None, **how) -> str:
        """Return what a request is answered with; raises HTTPError."""
        headers = login(password) | (headers or {})
        request = urllib.request.Request(self.url + path, headers=headers, **how)
        with urllib.request.urlopen(request, timeout=120, context=self._context) as answer:
            return answer.read().decode()

    def statuses(self, password: str, times: int) -> list[int]:
        """Return how so many requests on one connection are answered."""
        found = []
        where = urllib.parse.urlsplit(self.url).netloc
        with closing(HTTPSConnection(where, timeout=120, context=self._context)) as connection:
            for _ in range(times):
                connection.request("HEAD", "/wfs3", headers=login(password))
                answer = connection.getresponse()
                answer.read()
                found.append(answer.status)
        return found


def login(password: str) -> dict[str, str]:
    return {"Authorization": f"Basic {base64.b64encode(f'ada:{password}'.encode()).decode()}"}


@pytest.fixture(scope="module")
def proxy(services, tmp_path_factory):
    try:
        program = find_program("nginx", "/usr/sbin")
    except StageError as error:
        pytest.skip(f"{error}; run: make setup")
    return Proxy(services, program, tmp_path_factory.mktemp("proxy"))


def test_a_proxy_lets_in_by_password_only_and_answers_by_its_own_address(proxy):
    for path in (
        "?SERVICE=WMS&REQUEST=GetCapabilities",
        "?SERVICE=WFS&VERSION=1.1.0&REQUEST=GetCapabilities",
        "?SERVICE=WMTS&REQUEST=GetCapabilities",
        "wfs3/collections/Robots/items.json",
        "wfs3/api",
    ):
        # A client that is led to http:// would send its password there.
        assert proxy.url in (answer := proxy.ask(path)) and "http://localhost" not in answer, path
    for how, status in {
        ("wrong", None, "GET"): 401,
        ("secret", b"<Transaction/>", "POST"): 403,
        ("secret", None, "DELETE"): 403,
    }.items():
        with pytest.raises(urllib.error.HTTPError) as refused:
            proxy.ask("wfs3/collections/Walls/items/1", how[0], data=how[1], method=how[2])
        assert refused.value.code == status


def test_addresses_in_answers_are_none_that_a_client_says(proxy):
    said = dict.fromkeys(("X-Forwarded-Host", "X-Qgis-Service-Url", "X-Qgis-WMS-Service-Url"), "a.example")
    answer = proxy.ask("?SERVICE=WMS&REQUEST=GetCapabilities", headers=said | {"Forwarded": "host=a.example"})
    assert proxy.url in answer and "a.example" not in answer


def test_layers_of_a_fleet_that_is_not_there_yet_lie_on_the_site(services):
    from owslib.wms import WebMapService

    contents = WebMapService(services.url, version="1.3.0").contents
    west, south, east, north = contents["Observations"].boundingBoxWGS84
    assert (west, south) > (16.842, 46.879) and (east, north) < (16.846, 46.882)
    own = contents["Orthophoto"].boundingBoxWGS84
    assert west <= own[0] and south <= own[1] and east >= own[2] and north >= own[3]


@pytest.mark.parametrize(
    ("options", "said"),
    [
        (["--project", "{folder}/none.qgz"], "none.qgz cannot be read (there is none)"),
        (["--fleet", "{folder}/none.vrt"], "make the views with: robot-bridge database views"),
        (["--project", "{folder}/gone.qgs"], "the data of layer Walls is gone; open it in QGIS and mend"),
    ],
)
def test_what_is_missing_is_named_before_anything_is_served(tmp_path, services, options, said):
    project = services.project.read_text("utf-8").replace("layername=walls", "layername=gone")
    (tmp_path / "gone.qgs").write_text(project, "utf-8")
    words = [word.format(folder=tmp_path) for word in options]
    assert said in run_here([PROGRAM, *words, "--write", tmp_path / "services.qgs"])
    assert not (tmp_path / "services.qgs").exists()


def test_passwords_cannot_be_guessed_fast(proxy):
    began = time.monotonic()
    refused = proxy.statuses("wrong", 400)
    assert set(refused) == {401, 429}
    assert refused.count(401) <= 200 + 20 * (time.monotonic() - began) + 2
