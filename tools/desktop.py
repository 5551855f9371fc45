"""Open QGIS Desktop with the plugin, the sample project, a gateway and three simulated robots.

When QGIS is closed the gateway and the robots end. The user's own QGIS profile is not touched.

python -m tools.desktop [--screenshot PNG]
"""

from __future__ import annotations

import argparse
import getpass
import os
import sys
from pathlib import Path

import numpy as np

from robot_bridge.core.sites.site import read_site
from tests.support.fleet import PROJECT, SITE, STARTS, start_gateway, start_robots
from tests.support.picture import reduce_colours
from tests.support.processes import Processes
from tests.support.program import ended
from tests.support.qgis import Profile, has_screen, virtual_screen
from tests.support.session import follow, start_qgis
from tools.plugin_files import ROOT

FOLDER = Path(os.environ.get("FLEET_DESKTOP_FOLDER") or ROOT / "build" / "desktop")
WINDOW = (1360, 850)
PICTURE_TIMEOUT = 120.0
EXTENT = (0.0, 0.0, 140.0, 130.0)
ERRANDS = {
    "r1": [(104.0, 8.0)],
    "r2": [(54.0, 84.0), (88.0, 84.0), (118.0, 84.0)],
    "r3": [(60.0, 22.0), (44.0, 22.0), (28.0, 22.0)],
}
"""For the picture: where each robot is sent, site frame, metres; one place is a cone target."""

DRIVE_SECONDS = 14.0


def plan(address: str, picture: Path | None) -> dict[str, object]:
    """Return what the session inside QGIS is told."""
    frame = read_site(SITE).frame
    told: dict[str, object] = {
        "journal": str(FOLDER / "journal.jsonl"),
        "project": str(PROJECT),
        "gateway": address,
        "operator": "operator" if picture else getpass.getuser(),
        "robots": [start.name for start in STARTS],
    }
    if picture is not None:
        corners = frame.to_crs(np.array([EXTENT[:2], EXTENT[2:]]))
        told |= {
            "picture": str(picture),
            "window": WINDOW,
            "crs": frame.crs,
            "extent": corners.ravel().tolist(),
            "errands": {robot: frame.to_crs(np.array(places)).tolist() for robot, places in ERRANDS.items()},
            "drive_seconds": DRIVE_SECONDS,
        }
    return told


def display_for(processes: Processes, picture: Path | None) -> str | None:
    """Return the virtual screen to use, None for the user's own."""
    if picture is None and has_screen():
        return None
    display = virtual_screen(processes, *WINDOW)
    if picture is None:
        print(f"There is no display here: QGIS opens on the virtual screen {display}. Ctrl-C ends it.")
        print("To see how it looks: make screenshots", flush=True)
    return display


def run(picture: Path | None) -> None:
    """Open the window; return when it was closed, or when the picture was taken.

    :raises StageError: when something does not come up.
    """
    FOLDER.mkdir(parents=True, exist_ok=True)
    database = FOLDER / "fleet.db"
    for file in FOLDER.glob("fleet.db*"):
        file.unlink()
    with Processes(FOLDER / "logs") as processes:
        display = display_for(processes, picture)
        address = start_gateway(processes, database)
        start_robots(processes, address, database)
        profile = Profile(FOLDER / "profile", link=False)
        told = plan(address, picture)
        qgis = start_qgis(processes, profile, "desktop_session.py", told, display)
        patience = PICTURE_TIMEOUT if picture else float("inf")
        for entry in follow(processes, qgis, Path(str(told["journal"])), patience):
            print(f"{entry['text']}", flush=True)
    if picture is not None:
        reduce_colours(picture)


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--screenshot", type=Path, metavar="PNG", help="take this picture of it and end")
    picture = parser.parse_args().screenshot
    return ended("desktop", lambda: run(picture.resolve() if picture else None))


if __name__ == "__main__":
    sys.exit(main())
