"""Make the styles of the layers that a robot map becomes; run it with the Python that has PyQGIS.

The styles are kept in the repository beside this file.
"""

from __future__ import annotations

from collections.abc import Callable

from labels import around_points, letters
from qgis.core import (
    Qgis,
    QgsApplication,
    QgsCategorizedSymbolRenderer,
    QgsFeatureRenderer,
    QgsFillSymbol,
    QgsGeometryGeneratorSymbolLayer,
    QgsGraduatedSymbolRenderer,
    QgsHashedLineSymbolLayer,
    QgsLineSymbol,
    QgsMarkerSymbol,
    QgsPalLayerSettings,
    QgsRendererCategory,
    QgsRendererRange,
    QgsSimpleLineSymbolLayer,
    QgsSingleSymbolRenderer,
    QgsWkbTypes,
)
from qgis.PyQt.QtCore import Qt
from qgis.PyQt.QtGui import QColor
from style_file import write_look

HEIGHTS = (
    (-1e9, 0.0, "0 m: level", "#8d99a6"),
    (0.0, 0.5, "up to 0.5 m", "#fde725"),
    (0.5, 1.5, "up to 1.5 m", "#5ee06a"),
    (1.5, 4.0, "up to 4 m", "#22c3dd"),
    (4.0, 1e9, "higher", "#b14bff"),
)
SEVERITIES = {"error": ("Error", "#e01b24"), "warning": ("Warning", "#ff8c1a"), "info": ("Info", "#1c71d8")}


def segments() -> QgsFeatureRenderer:
    """Height by colour; ticks on the right, where the free space is."""
    ranges = [
        QgsRendererRange(low, high, _oriented(colour), label, True) for low, high, label, colour in HEIGHTS
    ]
    return QgsGraduatedSymbolRenderer("height_m", ranges)


def areas() -> QgsFeatureRenderer:
    return QgsSingleSymbolRenderer(_fill("30,38,54,70", "30,38,54,0"))


def lines() -> QgsFeatureRenderer:
    return QgsSingleSymbolRenderer(_strokes(_line("#301e2636", 1.6)))


def border() -> QgsFeatureRenderer:
    symbol = _fill("0,0,0,0", "255,255,255,220", 0.9)
    dashes = _line("#1e2636", 0.4)
    dashes.setPenStyle(Qt.PenStyle.DashLine)
    symbol.appendSymbolLayer(dashes)
    return QgsSingleSymbolRenderer(symbol)


def tiles() -> QgsFeatureRenderer:
    return QgsSingleSymbolRenderer(_fill("28,113,216,24", "28,113,216,235", 0.5))


def findings() -> QgsFeatureRenderer:
    categories = [
        QgsRendererCategory(value, _marked(colour), label) for value, (label, colour) in SEVERITIES.items()
    ]
    return QgsCategorizedSymbolRenderer("severity", categories)


LOOKS: dict[str, tuple[Callable[[], QgsFeatureRenderer], str, str]] = {
    "segments": (segments, "LineString?field=height_m:double", ""),
    "areas": (areas, "Polygon?field=semantics:string", ""),
    "lines": (lines, "MultiLineString?field=semantics:string", ""),
    "border": (border, "Polygon?field=area_m2:double", ""),
    "tiles": (tiles, "Polygon?field=tile:string", "tile"),
    "findings": (findings, "MultiLineString?field=severity:string&field=kind:string", "kind"),
}
"""The renderer of each style, the layer it is for, and the field that labels it."""


def _oriented(colour: str) -> QgsLineSymbol:
    ticks = QgsHashedLineSymbolLayer(True, 2.4)
    ticks.setSubSymbol(_strokes(_line(colour, 0.4)))
    ticks.setHashLength(1.5)
    ticks.setOffset(0.75)
    return _strokes(_line("#d2ffffff", 1.1), ticks, _line(colour, 0.6))


def _marked(colour: str) -> QgsLineSymbol:
    """A line that is seen close by, and a dot that is seen from afar."""
    dot = QgsGeometryGeneratorSymbolLayer.create({"geometryModifier": "point_on_surface($geometry)"})
    dot.setSymbolType(Qgis.SymbolType.Marker)
    look = {"name": "circle", "color": colour, "outline_color": "#ffffff", "size": "2.6"}
    dot.setSubSymbol(QgsMarkerSymbol.createSimple({**look, "outline_width": "0.4"}))
    return _strokes(_line("#e6ffffff", 1.5), _line(colour, 0.8), dot)


def _fill(colour: str, edge: str, width: float = 0.3) -> QgsFillSymbol:
    return QgsFillSymbol.createSimple(
        {"color": colour, "outline_color": edge, "outline_width": str(width), "joinstyle": "miter"}
    )


def _line(colour: str, width: float) -> QgsSimpleLineSymbolLayer:
    line = QgsSimpleLineSymbolLayer(QColor(colour), width)
    line.setPenCapStyle(Qt.PenCapStyle.RoundCap)
    return line


def _strokes(*layers) -> QgsLineSymbol:
    # One by one: a list given to the constructor stays Python's and is freed under QGIS.
    symbol = QgsLineSymbol()
    symbol.changeSymbolLayer(0, layers[0])
    for layer in layers[1:]:
        symbol.appendSymbolLayer(layer)
    return symbol


def _labels(field: str) -> QgsPalLayerSettings:
    settings = around_points(field, letters(8.0, 0.8), 1.6, 2500)
    settings.geometryGeneratorEnabled = True
    settings.geometryGenerator = "point_on_surface($geometry)"
    settings.geometryGeneratorType = QgsWkbTypes.GeometryType.PointGeometry
    return settings


if __name__ == "__main__":
    application = QgsApplication([], True)
    application.initQgis()
    for name, (renderer, kind, field) in LOOKS.items():
        write_look(f"robot_map_{name}", kind, renderer(), _labels(field) if field else None)
