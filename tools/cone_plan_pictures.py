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
from tests.support.fleet import PROJECT, SITE, start_gateway
from tests.support.picture import reduce_colours
from tests.support.processes import Processes
from tests.support.program import ended
from tests.support.qgis import Profile, virtual_screen
from tests.support.session import follow, start_qgis
from tools.plugin_files import ROOT

FOLDER = Path(os.environ.get("FLEET_DESKTOP_FOLDER") or ROOT / "build" / "cone_plan_pictures")
WINDOW = (1360, 850)
TIMEOUT = 300.0
EXTENT = (4.0, -4.0, 130.0, 136.0)
"""What of the site the map shows, metres."""
STARTS = {"r1": (24.0, 2.0, 0.0), "r2": (62.0, 2.0, 0.0), "r3": (104.0, 2.0, math.pi)}
ORIGIN = (12.0, 6.2)
"""Where the layout begins, heading east."""
DIMENSIONS = {"vehicle_width": 1.7, "exit_length": 15.0}
SPEED = 2.5


def run(pictures: Path) -> None:
    """Open the window, and save one picture for each step.

    :raises StageError: when something does not come up or does not happen.
    """
    FOLDER.mkdir(parents=True, exist_ok=True)
    database = FOLDER / "fleet.db"
    for file in FOLDER.glob("fleet.db*"):
        file.unlink()
    with Processes(FOLDER / "logs") as processes:
        display = virtual_screen(processes, *WINDOW)
        address = start_gateway(processes, database)
        killed = start_robots(processes, address)
        profile = Profile(FOLDER / "profile", link=False)
        told = plan(address, pictures)
        qgis = start_qgis(processes, profile, "cone_plan_session.py", told, display)
        for entry in follow(processes, qgis, Path(str(told["journal"])), TIMEOUT, killed=["r1"]):
            print(entry["text"], flush=True)
            if entry["step"] == "kill r1":
                killed.kill()
    for picture in sorted(pictures.glob("cone-plan-*.png")):
        reduce_colours(picture)


def start_robots(processes: Processes, address: str):
    """Start three robots and return the process of the first."""
    made = {}
    for seed, (name, pose) in enumerate(STARTS.items(), start=1):
        where = ",".join(str(number) for number in pose)
        options = ["--name", name, f"--pose={where}", "--seed", str(seed), "--speed", str(SPEED)]
        command = [sys.executable, "-m", "robot_bridge", "robot", "--url", f"{address}/robot", *options]
        made[name] = processes.start(name, command)
    return made["r1"]


def plan(address: str, pictures: Path) -> dict[str, object]:
    """Return what the session inside QGIS is told."""
    frame = read_site(SITE).frame
    corners = frame.to_crs(np.array([EXTENT[:2], EXTENT[2:]]))
    return {
        "journal": str(FOLDER / "journal.jsonl"),
        "project": str(PROJECT),
        "gateway": address,
        "robots": list(STARTS),
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
