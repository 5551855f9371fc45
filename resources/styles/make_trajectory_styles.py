"""Make the style of trajectories, a colour for each robot and times; run it with the Python that has PyQGIS.

The style is kept in the repository beside this file.
"""

from __future__ import annotations

from qgis.core import (
    Qgis,
    QgsApplication,
    QgsLineSymbol,
    QgsProperty,
    QgsSingleSymbolRenderer,
    QgsSymbolLayer,
    QgsVectorLayer,
)
from robot_colour import ROBOT_COLOUR
from style_file import CATEGORY, write_style


def save() -> None:
    """Write the style; it takes nothing but looks and times with it."""
    layer = QgsVectorLayer(
        "LineString?field=robot:string&field=begin:datetime&field=end:datetime", "trajectories", "memory"
    )
    symbol = QgsLineSymbol.createSimple({"line_width": "0.7", "capstyle": "round", "joinstyle": "round"})
    symbol.symbolLayer(0).setDataDefinedProperty(
        QgsSymbolLayer.Property.PropertyStrokeColor, QgsProperty.fromExpression(ROBOT_COLOUR)
    )
    layer.setRenderer(QgsSingleSymbolRenderer(symbol))
    times = layer.temporalProperties()
    times.setMode(Qgis.VectorTemporalMode.FeatureDateTimeStartAndEndFromFields)
    times.setStartField("begin")
    times.setEndField("end")
    times.setIsActive(True)
    write_style(layer, "trajectories", CATEGORY.Symbology | CATEGORY.Temporal)


if __name__ == "__main__":
    application = QgsApplication([], True)
    application.initQgis()
    save()
