"""Draw docs/images/exported-window.png and findings.png with a QGIS that has no display.

python -m tools.pictures.robot_maps [docs/images]

The first is a window of the sample site, exported as a robot map and loaded again over the orthophoto. The
second is the same map with faults put into it, and what the check finds.
"""

from __future__ import annotations

import tempfile
from dataclasses import replace
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np

from tools.pictures.stage import CRS, SITE, draw_map, drawing, part, photo, run, vector

ORIGIN = (640420.0, 5193480.0)
LAYERS = ("buildings", "walls", "columns", "litter_bins", "benches", "stairs")
CENTER, WIDTH, HEIGHT = (148.0, 98.0), 92, 72
MARGIN_M = 4.0
PIXELS_PER_M = 10
EXTRA_WALLS = (
    ((165.0, 96.0), (165.0, 110.0)),
    ((180.0, 120.0), (172.07, 120.0)),
    ((105.0, 76.0), (118.0, 76.0), (118.0, 88.0), (105.0, 88.0), (105.0, 76.0)),
)
SLIVER = ((138.0, 84.0), (150.0, 84.0), (150.0, 84.03), (138.0, 84.03))


def main() -> None:
    with drawing(__doc__) as folder, tempfile.TemporaryDirectory() as place:
        sound, faulty = Path(place) / "window.txt", Path(place) / "faulty.txt"
        print(run("export_robot_map.ExportRobotMap", export_parameters(sound)))
        loaded = load(sound)
        draw(loaded, folder / "exported-window.png")
        put_faults_in(sound, faulty)
        found = run("read_robot_maps.CheckRobotMap", {"MAP": str(faulty), "FINDINGS": str(faulty) + ".gpkg"})
        print(found)
        findings = vector(found["FINDINGS"], style="robot_map_findings")
        draw([findings, *load(faulty)], folder / "findings.png")


def export_parameters(target: Path) -> dict[str, Any]:
    x, y = CENTER[0] + ORIGIN[0], CENTER[1] + ORIGIN[1]
    return {
        "OBSTACLES": [f"{SITE / 'sample_site.gpkg'}|layername={name}" for name in LAYERS],
        "CENTER": f"{x},{y} [{CRS}]",
        "WIDTH": WIDTH,
        "HEIGHT": HEIGHT,
        "SITE_CRS": CRS,
        "ORIGIN": f"{ORIGIN[0]},{ORIGIN[1]} [{CRS}]",
        "OUTPUT": str(target),
    }


def load(file: Path) -> list[Any]:
    """Return the layers of a robot map, topmost first, in their styles."""
    names = {"SEGMENTS": "segments", "LINES": "lines", "AREAS": "areas", "BORDER": "border"}
    outputs = {name: f"{file}.{look}.gpkg" for name, look in names.items()}
    made = run("read_robot_maps.LoadRobotMap", {"MAP": str(file), **outputs})
    return [vector(made[name], style=f"robot_map_{look}") for name, look in names.items()]


def put_faults_in(sound: Path, faulty: Path) -> None:
    """Write the map in ``sound`` with a fault of each kind to ``faulty``."""
    text, model = part("robot_bridge.core.robotmap.text_format"), part("robot_bridge.core.robotmap.model")
    robot_map = text.read_text(sound.read_text(encoding="utf-8"))
    obstacles = []
    for obstacle in robot_map.obstacles:
        x, y = obstacle.a.min(axis=0)
        if (122 <= x <= 130) and (66 <= y <= 74):
            obstacle = replace(obstacle, a=obstacle.b[::-1], b=obstacle.a[::-1])
        elif obstacle.semantics.startswith("litter") and x > 175:
            obstacle = replace(obstacle, height=np.zeros(len(obstacle.a)))
        obstacles.append(obstacle)
    first = max(obstacle.id for obstacle in obstacles) + 1
    kinds = model.ShapeType
    for id, points in enumerate((*EXTRA_WALLS, (*SLIVER, SLIVER[0])), first):
        kind = kinds.CLOSED_POLYGON if points[:-1] == SLIVER else kinds.OPEN_POLYGON
        obstacles.append(obstacle_along(model, id, kind, points))
    faulty.write_text(text.write_text(replace(robot_map, obstacles=tuple(obstacles))), encoding="utf-8")


def obstacle_along(model: ModuleType, id: int, kind: Any, points: Any) -> Any:
    line = np.array(points)
    count = len(line) - 1
    return model.Obstacle(
        id=id,
        shape_type=kind,
        semantics="wall",
        a=line[:-1],
        b=line[1:],
        height=np.full(count, 2.0),
        outdoor=np.ones(count, dtype=bool),
        segment_semantics=("",) * count,
    )


def draw(layers: list[Any], picture: Path) -> None:
    """Draw ``layers`` over the orthophoto of the sample site."""
    x, y = CENTER[0] + ORIGIN[0], CENTER[1] + ORIGIN[1]
    across, up = WIDTH / 2 + MARGIN_M, HEIGHT / 2 + MARGIN_M
    draw_map([*layers, photo()], (x - across, y - up, x + across, y + up), PIXELS_PER_M, picture)


if __name__ == "__main__":
    main()
