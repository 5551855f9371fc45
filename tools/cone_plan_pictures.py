"""Film a cone plan on the sample site in a QGIS of its own under Xvfb: from the layout to the report.

A double lane change is placed on the straight, planned, sent to three simulated robots and placed by them;
one is killed half-way, and the others take over its cones. Each step becomes a picture of the window.

python -m tools.cone_plan_pictures [docs/images]
"""

from __future__ import annotations

import argparse
import math
import os
import sys
from pathlib import Path

import numpy as np

from robot_bridge.core.sites.site import read_site
from tests.support.fleet import PROJECT, SITE, Start, new_database, start_gateway, start_robots
from tests.support.picture import reduce_colours
from tests.support.processes import Processes
from tests.support.program import ended
from tests.support.qgis import virtual_screen
from tests.support.session import play
from tools.plugin_files import ROOT

FOLDER = Path(os.environ.get("FLEET_DESKTOP_FOLDER") or ROOT / "build" / "cone_plan_pictures")
WINDOW = (1360, 850)
TIMEOUT = 300.0
EXTENT = (4.0, -4.0, 130.0, 136.0)
"""What of the site the map shows, metres."""
STARTS = (Start("r1", (24.0, 2.0, 0.0)), Start("r2", (62.0, 2.0, 0.0)), Start("r3", (104.0, 2.0, math.pi)))
ORIGIN = (12.0, 6.2)
"""Where the layout begins, heading east."""
DIMENSIONS = {"vehicle_width": 1.7, "exit_length": 15.0}
SPEED = 2.5


def run(pictures: Path) -> None:
    """Open the window, and save one picture for each step.

    :raises StageError: when something does not come up or does not happen.
    """
    database = new_database(FOLDER)
    with Processes(FOLDER / "logs") as processes:
        display = virtual_screen(processes, *WINDOW)
        address = start_gateway(processes, database)
        robots = start_robots(processes, address, database, SPEED, STARTS)
        session, told = "cone_plan_session.py", plan(address, pictures)
        for entry in play(processes, FOLDER, session, told, TIMEOUT, display=display, killed=["r1"]):
            print(entry["text"], flush=True)
            if entry["step"] == "kill r1":
                robots["r1"].kill()
    for picture in sorted(pictures.glob("cone-plan-*.png")):
        reduce_colours(picture)


def plan(address: str, pictures: Path) -> dict[str, object]:
    """Return what the session inside QGIS is told."""
    frame = read_site(SITE).frame
    corners = frame.to_crs(np.array([EXTENT[:2], EXTENT[2:]]))
    return {
        "project": str(PROJECT),
        "gateway": address,
        "robots": [start.name for start in STARTS],
        "pictures": str(pictures),
        "window": WINDOW,
        "crs": frame.crs,
        "extent": corners.ravel().tolist(),
        "origin": frame.to_crs(np.array([ORIGIN])).ravel().tolist(),
        "dimensions": DIMENSIONS,
        "speed": SPEED,
    }


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    default = ROOT / "docs" / "images"
    parser.add_argument("pictures", type=Path, nargs="?", default=default, metavar="FOLDER")
    pictures = parser.parse_args().pictures.resolve()
    return ended("cone_plan_pictures", lambda: run(pictures))


if __name__ == "__main__":
    sys.exit(main())
