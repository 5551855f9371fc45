"""A project and the live fleet by QGIS Server, as clients of others read it: GDAL, OWSLib and QGIS itself."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import urllib.parse
import urllib.request
from pathlib import Path

import numpy as np
import pytest
from osgeo import gdal, ogr
from qgis.core import (
    QgsMapRendererParallelJob,
    QgsMapSettings,
    QgsProject,
    QgsRasterLayer,
    QgsRectangle,
    QgsVectorLayer,
)
from qgis.PyQt.QtCore import QSize
from qgis.PyQt.QtGui import QImage
from sqlalchemy import insert

from robot_bridge.core.sites.settings import read_settings
from robot_bridge.gateway.storage import revisions
from robot_bridge.gateway.storage.database import run_once
from robot_bridge.gateway.storage.map_views import map_views_on, virtual_layers
from robot_bridge.gateway.storage.schema import robots, trajectories
from tests.support.databases.database_server import find_program
from tests.support.errors import StageError
from tests.support.processes import Processes, free_port

ROOT = Path(__file__).resolve().parents[2]
PROGRAM = ROOT / "tools" / "serve_maps.py"
SITE = ROOT / "resources" / "sample_site"
FRAME = read_settings(SITE / "site.toml").frame
NOW = 1_790_000_000.0
EXTENT = (640420.0, 5193485.0, 640500.0, 5193545.0)
SIZE = (640, 480)
ENVIRONMENT = {"QT_QPA_PLATFORM": "offscreen"}


class Services:
    """QGIS Server on the sample project, with a fleet in a SQLite file."""

    def __init__(self, folder: Path, processes: Processes) -> None:
        self.database = f"sqlite:///{folder}/fleet.db"
        self.fleet, self.project = folder / "fleet.vrt", folder / "written.qgs"
        run_once(self.database, revisions.create)
        run_once(self.database, self._fill)
        self.fleet.write_text(virtual_layers(f"{folder}/fleet.db", FRAME), "utf-8")
        self.port = free_port()
        command = [sys.executable, PROGRAM, "--fleet", self.fleet]
        subprocess.run(
            [*command, "--write", self.project], check=True, env={**os.environ, **ENVIRONMENT}, timeout=120
        )
        processes.start("services", [*command, "--port", str(self.port)], env={**os.environ, **ENVIRONMENT})
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


@pytest.fixture(scope="module")
def services(tmp_path_factory):
    try:
        find_program("qgis_mapserver", "/usr/bin")
    except StageError as error:
        pytest.skip(f"{error}; run: make setup")
    folder = tmp_path_factory.mktemp("services")
    # GDAL keeps tiles below the folder that it runs in.
    gdal.SetConfigOption("GDAL_DEFAULT_WMS_CACHE_PATH", str(folder / "tiles"))
    with Processes(folder / "logs") as processes:
        yield Services(folder, processes)


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
    command = [sys.executable, PROGRAM, *words, "--write", str(tmp_path / "services.qgs")]
    done = subprocess.run(
        command, capture_output=True, text=True, env={**os.environ, **ENVIRONMENT}, timeout=120
    )
    assert done.returncode == 1
    assert said in done.stderr
    assert not (tmp_path / "services.qgs").exists()
