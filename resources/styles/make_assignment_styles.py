"""Make the styles of what robots are to do, a colour for each robot; run it with the Python that has PyQGIS.

The styles are kept in the repository beside this file.
"""

from __future__ import annotations

from labels import around_points, letters
from qgis.core import (
    QgsApplication,
    QgsLineSymbol,
    QgsMarkerSymbol,
    QgsPalLayerSettings,
    QgsProperty,
    QgsSingleSymbolRenderer,
    QgsSymbol,
    QgsSymbolLayer,
)
from robot_colour import ROBOT_COLOUR
from style_file import write_look

SHAPE = "if(\"kind\" = 'store', 'square', if(\"kind\" = 'home', 'diamond', 'circle'))"
FIELDS = "field=robot:string&field=trip:integer&field=sequence:integer&field=kind:string"


def targets() -> QgsSymbol:
    """A circle for a cone, a square for a store, a diamond for the way home."""
    symbol = QgsMarkerSymbol.createSimple({"name": "circle", "size": "3", "outline_color": "255,255,255"})
    layer = symbol.symbolLayer(0)
    layer.setDataDefinedProperty(
        QgsSymbolLayer.Property.PropertyFillColor, QgsProperty.fromExpression(ROBOT_COLOUR)
    )
    layer.setDataDefinedProperty(QgsSymbolLayer.Property.PropertyName, QgsProperty.fromExpression(SHAPE))
    return symbol


def paths() -> QgsSymbol:
    """A line in the robot's colour."""
    symbol = QgsLineSymbol.createSimple({"line_width": "0.5", "capstyle": "round", "joinstyle": "round"})
    symbol.symbolLayer(0).setDataDefinedProperty(
        QgsSymbolLayer.Property.PropertyStrokeColor, QgsProperty.fromExpression(ROBOT_COLOUR)
    )
    return symbol


def labels() -> QgsPalLayerSettings:
    """The robot and the number of the cone on its way."""
    text = "if(\"kind\" in ('place', 'collect'), \"robot\" || ' ' || \"sequence\", '')"
    settings = around_points(text, letters(7.0, 0.7), 1.2, 1500)
    settings.isExpression = True
    return settings


if __name__ == "__main__":
    application = QgsApplication([], True)
    application.initQgis()
    write_look("assigned_targets", f"Point?{FIELDS}", QgsSingleSymbolRenderer(targets()), labels())
    write_look("assigned_paths", f"LineString?{FIELDS}", QgsSingleSymbolRenderer(paths()))
