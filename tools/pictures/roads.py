"""Draw docs/images/roads.png with a QGIS that has no display: network, route and path on the sample site.

python -m tools.pictures.roads [docs/images]
"""

from __future__ import annotations

import tempfile
from typing import Any

from tools.pictures.stage import CRS, SITE, draw_map, drawing, photo, run, vector

ROADS = f"{SITE / 'site.gpkg'}|layername=road_centrelines"
PLACES = {"START": f"640430,5193530 [{CRS}]", "GOAL": f"640600,5193570 [{CRS}]"}
EXTENT = (640416.0, 5193482.0, 640624.0, 5193622.0)
PIXELS_PER_M = 5


def main() -> None:
    with drawing(__doc__) as folder, tempfile.TemporaryDirectory() as place:
        outputs = {name: f"{place}/{name}.gpkg" for name in ("EDGES", "NODES", "ROUTE", "PATH")}
        network = {"ROADS": ROADS, "EDGES": outputs["EDGES"], "NODES": outputs["NODES"]}
        print(run("road_network.BuildRoadNetwork", network))
        way = {"ROUTE": outputs["ROUTE"], "PATH": outputs["PATH"], "TURNING_RADIUS": 3}
        print(run("road_network.FindRoute", {"ROADS": ROADS, "SURFACES": "asphalt", **PLACES, **way}))
        looks = {"NODES": "point", "PATH": "path", "EDGES": "edge"}
        layers = [_layer(outputs[name], look) for name, look in looks.items()]
        draw_map([*layers, photo()], EXTENT, PIXELS_PER_M, folder / "roads.png")


def _layer(source: str, look: str) -> Any:
    from qgis.core import QgsLineSymbol, QgsMarkerSymbol, QgsSingleSymbolRenderer

    layer = vector(source)
    made = {
        "point": lambda: QgsMarkerSymbol.createSimple(
            {"name": "circle", "size": "2.2", "color": "#ffffff", "outline_color": "#1a202c"}
        ),
        "edge": lambda: QgsLineSymbol.createSimple({"line_color": "#1c71d8", "line_width": "0.6"}),
        "path": lambda: QgsLineSymbol.createSimple(
            {"line_color": "#ff8c1a", "line_width": "1.4", "capstyle": "round"}
        ),
    }[look]()
    layer.setRenderer(QgsSingleSymbolRenderer(made))
    return layer


if __name__ == "__main__":
    main()
