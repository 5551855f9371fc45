"""Draw docs/images/roads.png with a QGIS that has no display: network, route and path on the sample site.

python scripts/roads_picture.py [docs/images]
"""

from __future__ import annotations

import argparse
import os
import tempfile
from pathlib import Path
from typing import Any

from plugin_files import ROOT
from robot_map_pictures import CRS, SITE, register_plugin, run
from stage.picture import reduce_colours

ROADS = f"{SITE / 'site.gpkg'}|layername=road_centrelines"
PLACES = {"START": f"640430,5193530 [{CRS}]", "GOAL": f"640600,5193570 [{CRS}]"}
EXTENT = (640416.0, 5193482.0, 640624.0, 5193622.0)
PIXELS_PER_M = 5


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder", type=Path, nargs="?", default=ROOT / "docs" / "images")
    folder = parser.parse_args().folder.resolve()
    os.environ["QT_QPA_PLATFORM"] = "offscreen"
    from qgis.core import QgsApplication

    application = QgsApplication([], True)
    application.initQgis()
    register_plugin()
    with tempfile.TemporaryDirectory() as place:
        outputs = {name: f"{place}/{name}.gpkg" for name in ("EDGES", "NODES", "ROUTE", "PATH")}
        network = {"ROADS": ROADS, "EDGES": outputs["EDGES"], "NODES": outputs["NODES"]}
        print(run("build_road_network.BuildRoadNetwork", network))
        way = {"ROUTE": outputs["ROUTE"], "PATH": outputs["PATH"], "TURNING_RADIUS": 3}
        print(run("find_route.FindRoute", {"ROADS": ROADS, "SURFACES": "asphalt", **PLACES, **way}))
        draw(outputs, folder / "roads.png")


def draw(made: dict[str, str], picture: Path) -> None:
    """Draw the layers over the orthophoto."""
    from qgis.core import (
        QgsCoordinateReferenceSystem,
        QgsMapRendererParallelJob,
        QgsMapSettings,
        QgsRasterLayer,
        QgsRectangle,
    )
    from qgis.PyQt.QtCore import QSize

    layers = [_layer(made["NODES"], "point"), _layer(made["PATH"], "path"), _layer(made["EDGES"], "edge")]
    photo = QgsRasterLayer(str(SITE / "orthophoto.tif"), "Orthophoto", "gdal")
    settings = QgsMapSettings()
    settings.setLayers([*layers, photo])
    settings.setDestinationCrs(QgsCoordinateReferenceSystem(CRS))
    settings.setExtent(QgsRectangle(*EXTENT))
    sides = (round((EXTENT[k + 2] - EXTENT[k]) * PIXELS_PER_M) for k in (0, 1))
    settings.setOutputSize(QSize(*sides))
    settings.setOutputDpi(96)
    job = QgsMapRendererParallelJob(settings)
    job.start()
    job.waitForFinished()
    if not job.renderedImage().save(str(picture)):
        raise SystemExit(f"{picture} cannot be written: choose a folder that exists.")
    reduce_colours(picture)


def _layer(source: str, look: str) -> Any:
    from qgis.core import QgsLineSymbol, QgsMarkerSymbol, QgsSingleSymbolRenderer, QgsVectorLayer

    layer = QgsVectorLayer(source, look, "ogr")
    made = {
        "point": lambda: QgsMarkerSymbol.createSimple(
            {"name": "circle", "size": "2.2", "color": "#ffffff", "outline_color": "#1a202c"}
        ),
        "edge": lambda: QgsLineSymbol.createSimple({"line_color": "#1c71d8", "line_width": "0.6"}),
        "path": lambda: QgsLineSymbol.createSimple(
            {"line_color": "#ff8c1a", "line_width": "1.4", "capstyle": "round"}
        ),
    }[look]()
    layer.setRenderer(QgsSingleSymbolRenderer(made))
    return layer


if __name__ == "__main__":
    main()
