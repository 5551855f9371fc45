"""Make the styles of cones and of what is wrong with them; run it with the Python that has PyQGIS.

The styles are kept in the repository beside this file.
"""

from __future__ import annotations

from labels import around_points, letters
from qgis.core import (
    QgsApplication,
    QgsCategorizedSymbolRenderer,
    QgsFeatureRenderer,
    QgsMarkerSymbol,
    QgsRendererCategory,
    QgsSingleSymbolRenderer,
)
from style_file import write_look

COLOURS = {
    "orange": ("Orange", "#f26a1b", "#6b2600", "2.4"),
    "big_orange": ("Big orange", "#f24a00", "#ffffff", "3.2"),
    "blue": ("Blue", "#2d6cdf", "#ffffff", "2.4"),
    "yellow": ("Yellow", "#ffd21f", "#3a2d00", "2.4"),
    "": ("Other", "#8d99a6", "#ffffff", "2.4"),
}


def cones() -> QgsFeatureRenderer:
    """A small circle in the cone's colour."""
    return QgsCategorizedSymbolRenderer(
        "colour",
        [
            QgsRendererCategory(value or None, _circle(fill, edge, size), label)
            for value, (label, fill, edge, size) in COLOURS.items()
        ],
    )


def findings() -> QgsFeatureRenderer:
    """A ring round the cone."""
    look = {"name": "circle", "color": "0,0,0,0", "outline_color": "#e01b24", "size": "5.4"}
    return QgsSingleSymbolRenderer(QgsMarkerSymbol.createSimple({**look, "outline_width": "0.8"}))


LOOKS = {
    "cones": (cones, "Point?field=colour:string&field=order:integer", "order", 1500),
    "cone_findings": (findings, "Point?field=kind:string", "kind", 1500),
}
"""The renderer of each style, the layer it is for, the field that labels it, and from which scale on."""


def _circle(fill: str, edge: str, size: str) -> QgsMarkerSymbol:
    return QgsMarkerSymbol.createSimple(
        {"name": "circle", "color": fill, "outline_color": edge, "outline_width": "0.3", "size": size}
    )


if __name__ == "__main__":
    application = QgsApplication([], True)
    application.initQgis()
    for name, (renderer, kind, field, scale) in LOOKS.items():
        write_look(name, kind, renderer(), around_points(field, letters(7.0, 0.7), 1.2, scale))
