"""What the picture programs share: a QGIS without display that knows the plugin, and maps drawn by it."""

from __future__ import annotations

import argparse
import contextlib
import importlib
import importlib.util
import os
import sys
from collections.abc import Iterator, Sequence
from pathlib import Path
from types import ModuleType
from typing import Any

from tests.support.picture import reduce_colours
from tools.plugin_files import PACKAGE, ROOT

SITE = ROOT / "resources" / "sample_site"
STYLES = ROOT / "resources" / "styles"
CRS = "EPSG:32633"
"""The sample site's."""


@contextlib.contextmanager
def drawing(doc: str) -> Iterator[Path]:
    """Start QGIS; the context is the folder for pictures that the command line names."""
    parser = argparse.ArgumentParser(description=doc.splitlines()[0])
    parser.add_argument("folder", type=Path, nargs="?", default=ROOT / "docs" / "images")
    folder = parser.parse_args().folder.resolve()
    os.environ["QT_QPA_PLATFORM"] = "offscreen"
    from qgis.core import QgsApplication

    application = QgsApplication([], True)
    application.initQgis()
    _register_plugin()
    yield folder


def part(name: str) -> ModuleType:
    """Return a module of the plugin's repository, under the name that QGIS gives it."""
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


def vector(source: str, *, style: str | None = None, provider: str = "ogr") -> Any:
    """Return the layer at ``source``, in one of the shipped styles."""
    from qgis.core import QgsVectorLayer

    layer = QgsVectorLayer(source, "layer", provider)
    if not layer.isValid():
        raise SystemExit(f"QGIS cannot open {source}.")
    if style:
        layer.loadNamedStyle(str(STYLES / f"{style}.qml"))
    return layer


def photo(file: Path = SITE / "orthophoto.tif") -> Any:
    """Return an orthophoto, the sample site's unless told otherwise."""
    from qgis.core import QgsRasterLayer

    return QgsRasterLayer(str(file), "Orthophoto", "gdal")


def draw_map(
    layers: list[Any], extent: Sequence[float], pixels_per_m: float, picture: Path, crs: str = CRS
) -> None:
    """Draw ``layers``, the top one first, within ``extent`` (x and y from, x and y to, metres of ``crs``)."""
    from qgis.core import (
        QgsCoordinateReferenceSystem,
        QgsMapRendererParallelJob,
        QgsMapSettings,
        QgsRectangle,
    )
    from qgis.PyQt.QtCore import QSize

    settings = QgsMapSettings()
    settings.setLayers(layers)
    settings.setDestinationCrs(QgsCoordinateReferenceSystem(crs))
    settings.setExtent(QgsRectangle(*extent))
    settings.setOutputSize(QSize(*(round((extent[k + 2] - extent[k]) * pixels_per_m) for k in (0, 1))))
    settings.setOutputDpi(96)
    job = QgsMapRendererParallelJob(settings)
    job.start()
    job.waitForFinished()
    if not job.renderedImage().save(str(picture)):
        raise SystemExit(f"{picture} cannot be written: choose a folder that exists.")
    reduce_colours(picture)


def _register_plugin() -> None:
    spec = importlib.util.spec_from_file_location(
        PACKAGE, ROOT / "__init__.py", submodule_search_locations=[str(ROOT)]
    )
    module = importlib.util.module_from_spec(spec)
    sys.modules[PACKAGE] = module
    spec.loader.exec_module(module)
