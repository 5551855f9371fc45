"""Draw docs/images/assignment.png: a double lane change shared out among three robots on the sample site.

python -m tools.pictures.assignment [docs/images]
"""

from __future__ import annotations

import tempfile
from pathlib import Path
from typing import Any

from tools.pictures.cones import DIMENSIONS, EXTENT, PIXELS_PER_M, PLACE
from tools.pictures.stage import CRS, SITE, draw_map, drawing, photo, run, vector

STORE = (640428.0, 5193490.0)
ROBOTS = {"r1": (640429.0, 5193487.5), "r2": (640429.0, 5193485.5), "r3": (640429.0, 5193483.5)}


def main() -> None:
    with drawing(__doc__) as folder, tempfile.TemporaryDirectory() as place:
        draw(Path(place), folder / "assignment.png")


def draw(place: Path, picture: Path) -> None:
    """Place the layout, assign its cones, and draw what the robots are to do over the orthophoto."""
    layout = {"LAYOUT": "iso3888_1", "POINT": f"{PLACE[0]},{PLACE[1]} [{CRS}]", "HEADING": 90}
    cones = run(
        "cone_layout.ConeLayout",
        {**layout, "DIMENSIONS": DIMENSIONS, "SITE_CRS": CRS, "CONES": str(place / "cones.gpkg")},
    )["CONES"]
    layers = {"robots": points(ROBOTS), "stores": points({"shed": STORE})}
    plan = run(
        "assign_cones.AssignCones",
        {
            "CONES": cones,
            "ROBOTS": layers["robots"],
            "STORES": layers["stores"],
            "ROADS": f"{SITE / 'sample_site.gpkg'}|layername=road_centrelines",
            "CAPACITY": 4,
            "TIME_LIMIT": 2,
            "TARGETS": str(place / "targets.gpkg"),
            "PATHS": str(place / "paths.gpkg"),
        },
    )
    print(plan)
    shown = [vector(plan[name.upper()], style=f"assigned_{name}") for name in ("targets", "paths")]
    draw_map([*shown, photo()], EXTENT, PIXELS_PER_M, picture)


def points(places: dict[str, tuple[float, float]]) -> Any:
    """Return a layer of ``places`` with their names as ids."""
    from qgis.core import QgsFeature, QgsGeometry, QgsPointXY, QgsVectorLayer

    layer = QgsVectorLayer(f"Point?crs={CRS}&field=id:string", "points", "memory")
    for name, place in places.items():
        feature = QgsFeature(layer.fields())
        feature.setGeometry(QgsGeometry.fromPointXY(QgsPointXY(*place)))
        feature.setAttributes([name])
        layer.dataProvider().addFeature(feature)
    return layer


if __name__ == "__main__":
    main()
