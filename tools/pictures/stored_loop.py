"""Draw docs/images/stored-loop.png, the first paper's loop as a gateway stored it, with QGIS offscreen.

python -m tools.pictures.stored_loop [docs/images]

The campus beside the project is published, a robot drives round building A5 at a gateway, and the positions
that this stored are written as layers by ``robot-bridge trajectories export``.
"""

from __future__ import annotations

import subprocess
import sys
import tempfile
from pathlib import Path

from benchmarks.localisation import campus
from tools.pictures.stage import draw_map, drawing, vector
from tools.plugin_files import ROOT

DATA = ROOT.parent / "shared" / "data"
CRS, ORIGIN = "EPSG:25831", (426000.0, 4582000.0)
EXTENT = (-8.0, -1.0, 57.0, 47.0)
"""metres in the site frame: x and y from, x and y to."""
PIXELS_PER_M = 14


def main() -> None:
    with drawing(__doc__) as folder, tempfile.TemporaryDirectory() as place:
        site = campus(DATA, Path(place))
        drive = ["experiment", "a5-loop", "--site", site, "--gateway", "--seeds", "1", "--output", place]
        database = f"sqlite:///{place}/a5-loop.db"
        stored = Path(place) / "loop.gpkg"
        for words in (drive, ["trajectories", "export", stored, "--site", site, "--database", database]):
            program = Path(sys.executable).with_name("robot-bridge")
            subprocess.run([str(word) for word in (program, *words)], check=True)
        tracks = vector(f"{stored}|layername=tracks")
        tracks.renderer().symbol().setColor(_colour("#1f5fd6"))
        tracks.renderer().symbol().setWidth(0.9)
        obstacles = vector(f"{site / 'site.gpkg'}|layername=obstacles|geometrytype=LineString")
        obstacles.renderer().symbol().setColor(_colour("#555555"))
        x, y = ORIGIN
        west, south, east, north = EXTENT
        extent = (x + west, y + south, x + east, y + north)
        draw_map([tracks, obstacles], extent, PIXELS_PER_M, folder / "stored-loop.png", CRS)


def _colour(name: str) -> object:
    from qgis.PyQt.QtGui import QColor

    return QColor(name)


if __name__ == "__main__":
    main()
