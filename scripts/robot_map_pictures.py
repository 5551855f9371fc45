"""Draw docs/images/exported-window.png and findings.png with a QGIS that has no display.

python scripts/robot_map_pictures.py [docs/images]

The first is a window of the sample site, exported as a robot map and loaded again over the orthophoto. The
second is the same map with faults put into it, and what the check finds.
"""

from __future__ import annotations

import argparse
import importlib
import importlib.util
import os
import sys
import tempfile
from dataclasses import replace
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np
from plugin_files import PACKAGE, ROOT
from stage.picture import reduce_colours

SITE = ROOT / "resources" / "sample_site"
CRS, ORIGIN = "EPSG:32633", (640420.0, 5193480.0)
LAYERS = ("buildings", "walls", "columns", "litter_bins", "benches", "stairs")
CENTER, WIDTH, HEIGHT = (148.0, 98.0), 92, 72
MARGIN_M = 4.0
PIXELS_PER_M = 10
EXTRA_WALLS = (
    ((165.0, 96.0), (165.0, 110.0)),
    ((180.0, 120.0), (172.07, 120.0)),
    ((105.0, 76.0), (118.0, 76.0), (118.0, 88.0), (105.0, 88.0), (105.0, 76.0)),
)
SLIVER = ((138.0, 84.0), (150.0, 84.0), (150.0, 84.03), (138.0, 84.03))


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
        sound, faulty = Path(place) / "window.txt", Path(place) / "faulty.txt"
        print(run("export_robot_map.ExportRobotMap", export_parameters(sound)))
        loaded = load(sound)
        draw(loaded, folder / "exported-window.png")
        put_faults_in(sound, faulty)
        found = run("check_robot_map.CheckRobotMap", {"MAP": str(faulty), "FINDINGS": str(faulty) + ".gpkg"})
        print(found)
        findings = styled(found["FINDINGS"], "Findings", "findings")
        draw([findings, *load(faulty)], folder / "findings.png")


def register_plugin() -> None:
    """Make the repository's root importable under the name that QGIS gives it."""
    spec = importlib.util.spec_from_file_location(
        PACKAGE, ROOT / "__init__.py", submodule_search_locations=[str(ROOT)]
    )
    module = importlib.util.module_from_spec(spec)
    sys.modules[PACKAGE] = module
    spec.loader.exec_module(module)


def part(name: str) -> ModuleType:
    return importlib.import_module(f"{PACKAGE}.{name}")


def run(algorithm: str, parameters: dict[str, Any]) -> dict[str, Any]:
    """Run an algorithm of the plugin, given as module.class, and return its outputs."""
    from qgis.core import QgsProcessingContext, QgsProcessingFeedback, QgsProject

    module, name = algorithm.split(".")
    made = getattr(part(f"plugin.processing.{module}"), name)().create()
    context, feedback = QgsProcessingContext(), QgsProcessingFeedback()
    context.setProject(QgsProject.instance())
    results, fine = made.run(parameters, context, feedback)
    if not fine:
        raise SystemExit(f"{name} failed:\n{feedback.textLog()}")
    return results


def export_parameters(target: Path) -> dict[str, Any]:
    x, y = CENTER[0] + ORIGIN[0], CENTER[1] + ORIGIN[1]
    return {
        "OBSTACLES": [f"{SITE / 'sample_site.gpkg'}|layername={name}" for name in LAYERS],
        "CENTER": f"{x},{y} [{CRS}]",
        "WIDTH": WIDTH,
        "HEIGHT": HEIGHT,
        "SITE_CRS": CRS,
        "ORIGIN": f"{ORIGIN[0]},{ORIGIN[1]} [{CRS}]",
        "OUTPUT": str(target),
    }


def load(file: Path) -> list[Any]:
    """Return the layers of a robot map, topmost first, in their styles."""
    names = {"SEGMENTS": "segments", "LINES": "lines", "AREAS": "areas", "BORDER": "border"}
    outputs = {name: f"{file}.{look}.gpkg" for name, look in names.items()}
    made = run("load_robot_map.LoadRobotMap", {"MAP": str(file), **outputs})
    return [styled(made[name], name, look) for name, look in names.items()]


def styled(source: str, name: str, look: str) -> Any:
    from qgis.core import QgsVectorLayer

    layer = QgsVectorLayer(source, name, "ogr")
    layer.loadNamedStyle(str(ROOT / "resources" / "styles" / f"robot_map_{look}.qml"))
    return layer


def put_faults_in(sound: Path, faulty: Path) -> None:
    """Write the map in ``sound`` with a fault of each kind to ``faulty``."""
    text, model = part("robot_bridge.robotmap.text"), part("robot_bridge.robotmap.model")
    robot_map = text.read_text(sound.read_text(encoding="utf-8"))
    obstacles = []
    for obstacle in robot_map.obstacles:
        x, y = obstacle.a.min(axis=0)
        if (122 <= x <= 130) and (66 <= y <= 74):
            obstacle = replace(obstacle, a=obstacle.b[::-1], b=obstacle.a[::-1])
        elif obstacle.semantics.startswith("litter") and x > 175:
            obstacle = replace(obstacle, height=np.zeros(len(obstacle.a)))
        obstacles.append(obstacle)
    first = max(obstacle.id for obstacle in obstacles) + 1
    kinds = model.ShapeType
    for id, points in enumerate((*EXTRA_WALLS, (*SLIVER, SLIVER[0])), first):
        kind = kinds.CLOSED_POLYGON if points[:-1] == SLIVER else kinds.OPEN_POLYGON
        obstacles.append(obstacle_along(model, id, kind, points))
    faulty.write_text(text.write_text(replace(robot_map, obstacles=tuple(obstacles))), encoding="utf-8")


def obstacle_along(model: ModuleType, id: int, kind: Any, points: Any) -> Any:
    line = np.array(points)
    count = len(line) - 1
    return model.Obstacle(
        id=id,
        shape_type=kind,
        semantics="wall",
        a=line[:-1],
        b=line[1:],
        height=np.full(count, 2.0),
        outdoor=np.ones(count, dtype=bool),
        segment_semantics=("",) * count,
    )


def draw(layers: list[Any], picture: Path) -> None:
    """Draw ``layers`` over the orthophoto of the sample site."""
    from qgis.core import (
        QgsCoordinateReferenceSystem,
        QgsMapRendererParallelJob,
        QgsMapSettings,
        QgsRasterLayer,
        QgsRectangle,
    )
    from qgis.PyQt.QtCore import QSize

    x, y = CENTER[0] + ORIGIN[0], CENTER[1] + ORIGIN[1]
    half_width, half_height = WIDTH / 2 + MARGIN_M, HEIGHT / 2 + MARGIN_M
    photo = QgsRasterLayer(str(SITE / "orthophoto.tif"), "Orthophoto", "gdal")
    settings = QgsMapSettings()
    settings.setLayers([*layers, photo])
    settings.setDestinationCrs(QgsCoordinateReferenceSystem(CRS))
    settings.setExtent(QgsRectangle(x - half_width, y - half_height, x + half_width, y + half_height))
    width, height = round(2 * half_width * PIXELS_PER_M), round(2 * half_height * PIXELS_PER_M)
    settings.setOutputSize(QSize(width, height))
    settings.setOutputDpi(96)
    job = QgsMapRendererParallelJob(settings)
    job.start()
    job.waitForFinished()
    if not job.renderedImage().save(str(picture)):
        raise SystemExit(f"{picture} cannot be written: choose a folder that exists.")
    reduce_colours(picture)


if __name__ == "__main__":
    main()
