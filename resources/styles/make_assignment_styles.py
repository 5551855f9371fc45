"""Make the styles of what robots are to do, a colour for each robot; run it with the Python that has PyQGIS.

The styles are kept in the repository beside this file.
"""

from __future__ import annotations

from pathlib import Path

from qgis.core import (
    QgsApplication,
    QgsLineSymbol,
    QgsMarkerSymbol,
    QgsPalLayerSettings,
    QgsProperty,
    QgsSingleSymbolRenderer,
    QgsSymbol,
    QgsSymbolLayer,
    QgsTextFormat,
    QgsUnitTypes,
    QgsVectorLayer,
    QgsVectorLayerSimpleLabeling,
)
from qgis.PyQt.QtGui import QFont
from style_file import write_style

HERE = Path(__file__).resolve().parent

# Hues by the golden angle: neighbours in the order of names are far apart.
COLOUR = (
    'color_hsl((array_find(array_distinct(array_agg("robot", order_by:="robot")), "robot") * 137 + 210)'
    " % 360, 75, 42)"
)
SHAPE = "if(\"kind\" = 'store', 'square', if(\"kind\" = 'home', 'diamond', 'circle'))"
FIELDS = "field=robot:string&field=trip:integer&field=sequence:integer&field=kind:string"


def targets() -> QgsSymbol:
    """A circle for a cone, a square for a store, a diamond for the way home."""
    symbol = QgsMarkerSymbol.createSimple({"name": "circle", "size": "3", "outline_color": "255,255,255"})
    layer = symbol.symbolLayer(0)
    layer.setDataDefinedProperty(
        QgsSymbolLayer.Property.PropertyFillColor, QgsProperty.fromExpression(COLOUR)
    )
    layer.setDataDefinedProperty(QgsSymbolLayer.Property.PropertyName, QgsProperty.fromExpression(SHAPE))
    return symbol


def paths() -> QgsSymbol:
    """A line in the robot's colour."""
    symbol = QgsLineSymbol.createSimple({"line_width": "0.5", "capstyle": "round", "joinstyle": "round"})
    symbol.symbolLayer(0).setDataDefinedProperty(
        QgsSymbolLayer.Property.PropertyStrokeColor, QgsProperty.fromExpression(COLOUR)
    )
    return symbol


def _labels() -> QgsVectorLayerSimpleLabeling:
    letters = QgsTextFormat()
    letters.setFont(QFont("Sans Serif", weight=QFont.Weight.DemiBold))
    letters.setSize(7)
    letters.setSizeUnit(QgsUnitTypes.RenderUnit.RenderPoints)
    halo = letters.buffer()
    halo.setEnabled(True)
    halo.setSize(0.7)
    letters.setBuffer(halo)
    settings = QgsPalLayerSettings()
    settings.fieldName = "if(\"kind\" in ('place', 'collect'), \"robot\" || ' ' || \"sequence\", '')"
    settings.isExpression = True
    settings.placement = QgsPalLayerSettings.Placement.AroundPoint
    settings.dist = 1.2
    settings.setFormat(letters)
    settings.scaleVisibility, settings.minimumScale, settings.maximumScale = True, 1500, 0
    return QgsVectorLayerSimpleLabeling(settings)


def save(look: str, kind: str, symbol: QgsSymbol, labels: QgsVectorLayerSimpleLabeling | None) -> None:
    """Write the style beside this file; it takes nothing but looks with it."""
    layer = QgsVectorLayer(f"{kind}?{FIELDS}", look, "memory")
    layer.setRenderer(QgsSingleSymbolRenderer(symbol))
    if labels is not None:
        layer.setLabeling(labels)
        layer.setLabelsEnabled(True)
    write_style(layer, HERE / f"{look}.qml")


if __name__ == "__main__":
    application = QgsApplication([], True)
    application.initQgis()
    save("assigned_targets", "Point", targets(), _labels())
    save("assigned_paths", "LineString", paths(), None)
