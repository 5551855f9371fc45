"""The layers of a report's map: plan, cones, and lines that show deviations larger than they are."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from qgis.core import (
    QgsCoordinateReferenceSystem,
    QgsFeature,
    QgsGeometry,
    QgsLineSymbol,
    QgsMarkerSymbol,
    QgsPalLayerSettings,
    QgsPointXY,
    QgsRectangle,
    QgsSingleSymbolRenderer,
    QgsSymbol,
    QgsVectorLayer,
    QgsVectorLayerSimpleLabeling,
)

from .placed_cones import PlacedCone

MOST_NAMES = 60
"""Cones that have their names on the map; with more of them names would hide the cones."""
LONGEST_LINE = 0.1
"""The part of the map's width that the largest deviation is to be long."""
SMALLEST_VIEW = 10.0
"""Metres across."""


def extent_of(cones: Sequence[PlacedCone]) -> QgsRectangle:
    """Return what the map has to show, with a margin."""
    places = np.array([place for cone in cones for place in (cone.planned, cone.placed)])
    (x_min, y_min), (x_max, y_max) = places.min(axis=0), places.max(axis=0)
    extent = QgsRectangle(x_min, y_min, x_max, y_max)
    extent.grow(max(0.08 * max(x_max - x_min, y_max - y_min), (SMALLEST_VIEW - (x_max - x_min)) / 2))
    return extent


def factor_of(cones: Sequence[PlacedCone], width: float) -> int:
    """Return by how much deviations are to be drawn longer on a map that is ``width`` metres wide."""
    most = max(cone.deviation for cone in cones)
    wanted = LONGEST_LINE * width / most if most > 0 else 1.0
    power = 10.0 ** math.floor(math.log10(max(wanted, 1.0)))
    return int(max(1, *(power * digit for digit in (1, 2, 5) if power * digit <= max(wanted, 1.0))))


def map_layers(
    cones: Sequence[PlacedCone], crs: QgsCoordinateReferenceSystem, tolerance: float, factor: int
) -> list[QgsVectorLayer]:
    """Return the layers, the uppermost first."""
    good = [cone for cone in cones if cone.deviation <= tolerance]
    bad = [cone for cone in cones if cone.deviation > tolerance]
    plan = {
        "name": "cross2",
        "color": "33,37,41",
        "outline_color": "33,37,41",
        "outline_width": "0.35",
        "size": "2.2",
    }
    layers = [
        _lines("Deviations", crs, cones, factor),
        _points("Planned", crs, cones, True, plan, named=False),
    ]
    for name, those, colour in (("Beyond", bad, "198,40,40"), ("Within", good, "42,111,151")):
        mark = {
            "name": "circle",
            "color": f"{colour},110",
            "outline_color": colour,
            "outline_width": "0.35",
            "size": "2.6",
        }
        layers.append(_points(name, crs, those, False, mark, named=len(cones) <= MOST_NAMES))
    return layers


def _points(
    name: str,
    crs: QgsCoordinateReferenceSystem,
    cones: Sequence[PlacedCone],
    planned: bool,
    mark: dict,
    *,
    named: bool,
) -> QgsVectorLayer:
    shapes = [QgsGeometry.fromPointXY(QgsPointXY(*(c.planned if planned else c.placed))) for c in cones]
    layer = _layer(name, "Point", crs, cones, shapes, QgsMarkerSymbol.createSimple(mark))
    if named:
        settings = QgsPalLayerSettings()
        settings.fieldName = "cone"
        settings.placement, settings.dist = QgsPalLayerSettings.Placement.OrderedPositionsAroundPoint, 1.8
        letters = settings.format()
        letters.setSize(7)
        halo = letters.buffer()
        halo.setEnabled(True)
        halo.setSize(0.6)
        letters.setBuffer(halo)
        settings.setFormat(letters)
        layer.setLabeling(QgsVectorLayerSimpleLabeling(settings))
        layer.setLabelsEnabled(True)
    return layer


def _lines(
    name: str, crs: QgsCoordinateReferenceSystem, cones: Sequence[PlacedCone], factor: int
) -> QgsVectorLayer:
    shapes = []
    for cone in cones:
        (x, y), (east, north) = cone.planned, cone.off
        ends = [QgsPointXY(x, y), QgsPointXY(x + factor * east, y + factor * north)]
        shapes.append(QgsGeometry.fromPolylineXY(ends))
    line = {"line_color": "217,72,15", "line_width": "0.5", "capstyle": "round"}
    return _layer(name, "LineString", crs, cones, shapes, QgsLineSymbol.createSimple(line))


def _layer(
    name: str,
    kind: str,
    crs: QgsCoordinateReferenceSystem,
    cones: Sequence[PlacedCone],
    shapes: list[QgsGeometry],
    symbol: QgsSymbol,
) -> QgsVectorLayer:
    layer = QgsVectorLayer(f"{kind}?field=cone:string", name, "memory")
    layer.setCrs(crs)
    features = []
    for cone, shape in zip(cones, shapes):  # noqa: B905
        feature = QgsFeature(layer.fields())
        feature.setGeometry(shape)
        feature.setAttributes([cone.name])
        features.append(feature)
    layer.dataProvider().addFeatures(features)
    layer.updateExtents()
    layer.setRenderer(QgsSingleSymbolRenderer(symbol))
    return layer
