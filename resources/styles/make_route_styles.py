"""Make the styles of a route and of the path along it; run it with the Python that has PyQGIS.

The styles are kept in the repository beside this file.
"""

from __future__ import annotations

from qgis.core import QgsApplication, QgsLineSymbol, QgsSingleSymbolRenderer
from style_file import write_look

VIOLET = "112,72,232"
"""No road, robot or command on the map has it."""


def save() -> None:
    """Write a wide band for the route and a thin line for the path, which is seen through it."""
    for name, opacity, width in (("route", 110, "2.2"), ("path", 255, "0.5")):
        line = {"line_color": f"{VIOLET},{opacity}", "line_width": width, "joinstyle": "round"}
        symbol = QgsLineSymbol.createSimple({**line, "capstyle": "round"})
        write_look(name, "LineString", QgsSingleSymbolRenderer(symbol))


if __name__ == "__main__":
    application = QgsApplication([], True)
    application.initQgis()
    save()
