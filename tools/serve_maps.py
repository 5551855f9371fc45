"""Serve a QGIS project and the live fleet by QGIS Server: WMS, WMTS, WFS and OGC API Features.

``serve_maps.py [--project FILE] [--fleet FLEET] [--port 8790]`` writes a copy of the project in which every
layer is published, with the layers of the fleet on top, and runs QGIS Server's own small HTTP server on it
until it is interrupted. FLEET is what ``robot-bridge database views`` made: the VRT file of SQLite, or the
address of PostgreSQL, postgresql://ACCOUNT@HOST/DATABASE, whose password is asked of PGPASSWORD or .pgpass.
``--write FILE`` writes the project only, for another server; see docs/services.md.
"""

from __future__ import annotations

import argparse
import os
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import urllib.error
import urllib.request
from pathlib import Path

from qgis.core import (
    Qgis,
    QgsApplication,
    QgsCoordinateReferenceSystem,
    QgsCoordinateTransform,
    QgsDataSourceUri,
    QgsMapLayerType,
    QgsMarkerSymbol,
    QgsProject,
    QgsProperty,
    QgsRectangle,
    QgsSingleSymbolRenderer,
    QgsSymbolLayer,
    QgsVectorLayer,
)
from sqlalchemy import make_url

from robot_bridge.gateway.storage.database import shown
from robot_bridge.gateway.storage.map_views import SCHEMA

ROOT = Path(__file__).resolve().parents[1]
SAMPLE = ROOT / "resources" / "sample_site" / "sample_site.qgz"
SERVER = "qgis_mapserver"
PLUGINS = Path(__file__).resolve().with_name("qgis_server_plugins")
"""What refuses requests that reach for more than the project, and says where the fleet's layers lie."""
GUARDED = b"REQUEST of WMS is one of"
"""How it refuses."""
WIDEST = 4096
"""Pixels that a picture may have each way: one of 20 000 took 30 s and 1.6 GB, and all others waited."""
FLEET = {
    "trajectories": "Trajectories",
    "observations": "Observations",
    "cones": "Placed cones",
    "commands": "Commands",
    "robots": "Robots",
}
"""The views and the names of their layers, the lowest first."""
KEYS = {"robots": "robot"}
"""Columns that tell rows of a view apart, where it is not the id."""
POSTGRESQL = "postgresql://"
WEB = ("EPSG:3857", "EPSG:4326")
"""CRSs that every client asks for, beside the project's own."""


class ServiceError(Exception):
    """Why there are no services, and what to do."""


def main() -> int:
    """Write the project and serve it; return the status."""
    arguments = _arguments()
    try:
        if arguments.write is not None:
            layers = write_project(arguments.project, arguments.fleet, arguments.write)
            print(f"{arguments.write}: {', '.join(layers)}")
            return 0
        program = shutil.which(SERVER)
        if program is None:
            raise ServiceError(f"{SERVER} is not installed; run: apt-get install qgis-server")
        with tempfile.TemporaryDirectory(prefix="fleet-services-") as folder:
            project = Path(folder) / "services.qgs"
            write_project(arguments.project, arguments.fleet, project)
            return _serve(program, project, arguments.port)
    except ServiceError as error:
        sys.exit(f"serve_maps: {error}")


def write_project(source: Path, fleet: str | None, target: Path) -> list[str]:
    """Write a copy of project ``source`` whose layers, and those of ``fleet``, are published.

    Return the names of the layers.
    """
    application = QgsApplication.instance() or _application()
    project = QgsProject()
    if not source.is_file() or not project.read(str(source)):
        raise ServiceError(f"project {source} cannot be read ({project.error() or 'there is none'})")
    missing = [layer.name() for layer in project.mapLayers().values() if not layer.isValid()]
    if missing:
        raise ServiceError(
            f"project {source}: the data of layer {', '.join(missing)} is gone; open it in QGIS and mend or "
            "remove the layer"
        )
    around = _extent(project)
    for layer in fleet_layers(fleet):
        project.addMapLayer(layer)
        extent = _transformed(around, project.crs(), layer.crs(), project)
        layer.setCustomProperty("fleet/extent", extent.asWktPolygon())
    _publish(project, around)
    project.setFilePathStorage(Qgis.FilePathType.Absolute)
    if not project.write(str(target)):
        raise ServiceError(f"project {target} cannot be written: {project.error()}")
    names = sorted(layer.name() for layer in project.mapLayers().values())
    # Layers go before the application does.
    project.clear()
    del application
    return names


def fleet_layers(fleet: str | None) -> list[QgsVectorLayer]:
    """Return the layers of the fleet's views, styled; raises ServiceError for one that cannot be read."""
    layers = []
    for view, title in FLEET.items() if fleet else ():
        layer = QgsVectorLayer(*_source(fleet or "", view, title))
        if not layer.isValid():
            raise ServiceError(
                f"fleet {_shown(fleet or '')}: there is no view {view} to read; make the views with: "
                "robot-bridge database views"
            )
        _style(view, layer)
        layers.append(layer)
    return layers


def _extent(project: QgsProject) -> QgsRectangle:
    """Return where the layers of the site are, in the CRS of ``project``: where robots may be."""
    around = QgsRectangle()
    for layer in project.mapLayers().values():
        if layer.isSpatial() and not layer.extent().isEmpty():
            around.combineExtentWith(_transformed(layer.extent(), layer.crs(), project.crs(), project))
    return around


def _transformed(
    rectangle: QgsRectangle,
    of: QgsCoordinateReferenceSystem,
    to: QgsCoordinateReferenceSystem,
    project: QgsProject,
) -> QgsRectangle:
    return QgsCoordinateTransform(of, to, project).transformBoundingBox(rectangle)


def _application() -> QgsApplication:
    os.environ.setdefault("QT_QPA_PLATFORM", "offscreen")
    # Symbols and labels of a project need fonts.
    application = QgsApplication([], True)
    application.initQgis()
    return application


def _source(fleet: str, view: str, title: str) -> tuple[str, str, str]:
    """Return what a layer of ``view`` is opened by: source, name and provider."""
    if not fleet.startswith(POSTGRESQL):
        return f"{Path(fleet).absolute()}|layername={view}", title, "ogr"
    address, uri = make_url(fleet), QgsDataSourceUri()
    uri.setConnection(
        address.host or "localhost",
        str(address.port or 5432),
        address.database or "",
        address.username or "",
        address.password or "",
    )
    uri.setDataSource(SCHEMA, view, "geom", "", KEYS.get(view, "id"))
    return uri.uri(False), title, "postgres"


def _shown(fleet: str) -> str:
    return shown(make_url(fleet)) if fleet.startswith(POSTGRESQL) else fleet


def _style(view: str, layer: QgsVectorLayer) -> None:
    looks = {
        "robots": {"name": "filled_arrowhead", "color": "#1565c0", "outline_color": "white", "size": "5"},
        "cones": {"name": "triangle", "color": "#ef6c00", "outline_color": "white", "size": "3"},
        "commands": {"name": "cross2", "color": "#6a1b9a", "outline_color": "#6a1b9a", "size": "3"},
        "observations": {"name": "diamond", "color": "#c62828", "outline_color": "white", "size": "3"},
        "trajectories": {"name": "circle", "color": "#90caf9", "outline_style": "no", "size": "0.8"},
    }
    symbol = QgsMarkerSymbol.createSimple(looks[view])
    if view == "robots":
        # The arrowhead of the symbol points to the right, and headings are from the north.
        angle = QgsProperty.fromExpression('"heading" - 90')
        symbol.symbolLayer(0).setDataDefinedProperty(QgsSymbolLayer.Property.PropertyAngle, angle)
    layer.setRenderer(QgsSingleSymbolRenderer(symbol))


def _publish(project: QgsProject, around: QgsRectangle) -> None:
    """Have QGIS Server publish every layer of ``project``: pictures of all, features of those with any."""
    corners = (around.xMinimum(), around.yMinimum(), around.xMaximum(), around.yMaximum())
    layers = project.mapLayers()
    vectors = [id for id, layer in layers.items() if layer.type() == QgsMapLayerType.VectorLayer]
    crs = list(dict.fromkeys([project.crs().authid(), *WEB]))
    title = project.title() or Path(project.fileName()).stem
    entries = [
        ("WMSServiceCapabilities", "/", True),
        ("WMSServiceTitle", "/", title),
        ("WMSCrsList", "/", crs),
        ("WFSLayers", "/", vectors),
        ("WMSExtent", "/", [str(corner) for corner in corners]),
        ("WMSMaxWidth", "/", WIDEST),
        ("WMSMaxHeight", "/", WIDEST),
        ("WMTSLayers", "Project", True),
        ("WMTSLayers", "Layer", list(layers)),
        ("WMTSPngLayers", "Project", True),
        ("WMTSPngLayers", "Layer", list(layers)),
        *(
            ("WFSLayersPrecision", f"/{id}", 3 if not layers[id].crs().isGeographic() else 9)
            for id in vectors
        ),
    ]
    for scope, key, value in entries:
        project.writeEntry(scope, key, value)
    # Whatever the project allows, these services only read.
    for key in ("Update", "Insert", "Delete"):
        project.removeEntry("WFSTLayers", key)


def _serve(program: str, project: Path, port: int) -> int:
    """Run QGIS Server until this program is interrupted or told to end; return its status."""
    address = f"127.0.0.1:{port}"
    environment = {
        "QGIS_PROJECT_FILE": str(project),
        "QGIS_PLUGINPATH": str(PLUGINS),
        "QT_QPA_PLATFORM": "offscreen",
        "QGIS_SERVER_LOG_STDERR": "1",
    }
    server = subprocess.Popen([program, address], env={**os.environ, **environment})
    signal.signal(signal.SIGTERM, lambda *_: server.terminate())
    try:
        _check_guard(server, address)
        print(
            f"WMS, WMTS and WFS at http://{address}/, OGC API Features at http://{address}/wfs3/", flush=True
        )
        status = server.wait()
    except KeyboardInterrupt:
        server.terminate()
        status = server.wait()
    return 0 if status in (0, -signal.SIGTERM, -signal.SIGINT) else status


def _check_guard(server: subprocess.Popen[bytes], address: str) -> None:
    """Wait until the server answers; raise ServiceError where it does not refuse what it has to."""
    while server.poll() is None:
        try:
            urllib.request.urlopen(
                f"http://{address}/?SERVICE=WMS&REQUEST=GetProjectSettings", timeout=60
            ).close()
        except urllib.error.HTTPError as error:
            if error.code == 400 and GUARDED in error.read():
                return
        except OSError:
            time.sleep(0.1)
            continue
        server.terminate()
        server.wait()
        raise ServiceError(
            f"{SERVER} does not load {PLUGINS}, so it would read files for whoever asks; run: apt-get "
            "install libqgispython" + Qgis.QGIS_VERSION.partition("-")[0]
        )


def _arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n\n")[0])
    parser.add_argument(
        "--project", type=Path, default=SAMPLE, help="QGIS project (default: the sample site)"
    )
    parser.add_argument("--fleet", help="VRT file, or postgresql://ACCOUNT@HOST/DATABASE")
    parser.add_argument("--port", type=int, default=8790, help="on this computer (default: 8790)")
    parser.add_argument("--write", type=Path, metavar="FILE", help="write the project only")
    return parser.parse_args()


if __name__ == "__main__":
    sys.exit(main())
