"""Make the style of trajectories, a colour for each robot and times; run it with the Python that has PyQGIS.

The style is kept in the repository beside this file.
"""

from __future__ import annotations

from pathlib import Path

from qgis.core import (
    Qgis,
    QgsApplication,
    QgsLineSymbol,
    QgsProperty,
    QgsSingleSymbolRenderer,
    QgsSymbolLayer,
    QgsVectorLayer,
)
from style_file import CATEGORY, write_style

FILE = Path(__file__).resolve().parent / "trajectories.qml"
# Hues by the golden angle: neighbours in the order of names are far apart.
COLOUR = (
    'color_hsl((array_find(array_distinct(array_agg("robot", order_by:="robot")), "robot") * 137 + 210)'
    " % 360, 75, 42)"
)


def save() -> None:
    """Write the style; it takes nothing but looks and times with it."""
    layer = QgsVectorLayer(
        "LineString?field=robot:string&field=begin:datetime&field=end:datetime", "trajectories", "memory"
    )
    symbol = QgsLineSymbol.createSimple({"line_width": "0.7", "capstyle": "round", "joinstyle": "round"})
    symbol.symbolLayer(0).setDataDefinedProperty(
        QgsSymbolLayer.Property.PropertyStrokeColor, QgsProperty.fromExpression(COLOUR)
    )
    layer.setRenderer(QgsSingleSymbolRenderer(symbol))
    times = layer.temporalProperties()
    times.setMode(Qgis.VectorTemporalMode.FeatureDateTimeStartAndEndFromFields)
    times.setStartField("begin")
    times.setEndField("end")
    times.setIsActive(True)
    write_style(layer, FILE, CATEGORY.Symbology | CATEGORY.Temporal)


if __name__ == "__main__":
    application = QgsApplication([], True)
    application.initQgis()
    save()
