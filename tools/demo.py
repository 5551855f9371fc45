"""Run the main job once, for real and without a display, and leave build/demo/.

    .venv/bin/python -m tools.demo [cluster|zalazone]

`cluster` is another demonstration, of several gateways (:mod:`tools.cluster_demo`), and `zalazone` one on the
real proving ground (:mod:`tools.zalazone`); they leave build/cluster/ and build/zalazone/.

A gateway with SQLite, three simulated robots, a robot map exported by qgis_process, QGIS Desktop with the
plugin on a virtual screen, and an operator who clicks. The exit status is 0 only when every step really
happened; every process that was started has ended then, and also when something failed.
"""

from __future__ import annotations

import os
import platform
import shutil
import sys
import time
from pathlib import Path

import numpy as np

from robot_bridge.core.sites.site import Site, read_site
from tests.support.fleet import PROJECT, SITE, STARTS, start_gateway, start_robots
from tests.support.map_export import export
from tests.support.operators import ask
from tests.support.processes import Processes
from tests.support.program import ended
from tests.support.qgis import Profile, virtual_screen
from tests.support.report import PAPER_BYTES_PER_M2, Report
from tests.support.session import play
from tests.support.verdict import Errand, Outcome, judge
from tools import cluster_demo
from tools.plugin_files import ROOT, version
from tools.zalazone import demonstration

FOLDER = Path(os.environ.get("FLEET_DEMO_FOLDER") or ROOT / "build" / "demo")
SCREEN = (1440, 900)
EXTENT = (0.0, 0.0, 130.0, 126.0)
CONE = (46.0, 8.0)
ROUTE = [(54.0, 84.0), (68.0, 84.0), (71.5, 82.0), (72.0, 76.0)]
FAR = (44.0, 22.0)
ERRANDS = (Errand("r1", CONE, "reached"), Errand("r2", ROUTE[-1], "reached"), Errand("r3", FAR, "aborted"))
SPEED = 2.5
"""m/s: fast enough that the demonstration is short."""

DESK_TIMEOUT = 240.0


class Demonstration:
    """Does one step after the other, printing and noting each when it has happened."""

    def __init__(self, processes: Processes, report: Report):
        self._processes = processes
        self._report = report
        self._site = read_site(SITE)
        self._began = time.monotonic()

    def run(self) -> None:
        """Do everything.

        :raises StageError: at the first step that does not happen.
        """
        database = FOLDER / "fleet.db"
        address = start_gateway(self._processes, database)
        self._happened(f"the gateway serves {self._site.name!r} at {address}, SQLite")
        start_robots(self._processes, address, database, SPEED)
        profile = Profile(FOLDER / "profile", link=False)
        self._export(profile)
        self._drive(address)
        self._judge(address)

    def _export(self, profile: Profile) -> None:
        exported = self._report.exported = export(profile, FOLDER / "site.map", FOLDER / "site.bin")
        self._happened(
            f"qgis_process wrote the robot map: {exported.obstacles} obstacles, {exported.segments} segments"
        )
        per_m2 = f"{exported.text_bytes / exported.area:.2f} bytes/m² (paper: {PAPER_BYTES_PER_M2:g})"
        self._happened(
            f"as text {exported.text_bytes} bytes, {per_m2}; as binary {exported.binary_bytes}, the same map"
        )

    def _drive(self, address: str) -> None:
        plan = desk_plan(self._site, address)
        display, session = virtual_screen(self._processes, *SCREEN), "demo_session.py"
        for entry in play(self._processes, FOLDER, session, plan, DESK_TIMEOUT, display=display):
            self._happened(entry["text"])

    def _judge(self, address: str) -> None:
        commands, positions = ask(address, ("get_commands", {}), ("get_positions", {}))
        poses = {robot["robot"]: robot for robot in positions["robots"]}
        tolerance = self._site.settings.reached_tolerance_m
        outcomes = [judge(errand, commands["commands"], poses, tolerance) for errand in ERRANDS]
        self._report.outcomes = outcomes
        self._happened("the gateway's own record agrees: " + ", ".join(map(in_words, outcomes)))

    def _happened(self, text: str) -> None:
        at = time.monotonic() - self._began
        self._report.steps.append((at, text))
        print(f"{at:6.1f} s  {text}", flush=True)


def in_words(outcome: Outcome) -> str:
    """Return an outcome in a few words."""
    off = "" if outcome.off_target is None else f", {outcome.off_target:.2f} m off"
    return f"{outcome.errand.robot} {outcome.errand.outcome}{off}"


def desk_plan(site: Site, address: str) -> dict[str, object]:
    """Return what the session inside QGIS is told; places are in the site's CRS, metres."""
    return {
        "project": str(PROJECT),
        "gateway": address,
        "robots": [start.name for start in STARTS],
        "crs": site.frame.crs,
        "extent": site.frame.to_crs(np.array([EXTENT[:2], EXTENT[2:]])).ravel().tolist(),
        "cone": site.frame.to_crs(np.array([CONE]))[0].tolist(),
        "route": site.frame.to_crs(np.array(ROUTE)).tolist(),
        "far": site.frame.to_crs(np.array([FAR]))[0].tolist(),
        "picture": str(FOLDER / "canvas.png"),
    }


def versions() -> dict[str, str]:
    """Return the versions that the report names."""
    from qgis.core import Qgis

    return {"Fleet Supervisor": version(), "QGIS": Qgis.QGIS_VERSION, "Python": platform.python_version()}


def run() -> None:
    """Do the main job on the sample site, and write the report of it."""
    shutil.rmtree(FOLDER, ignore_errors=True)
    FOLDER.mkdir(parents=True)
    report = Report(versions())
    with Processes(FOLDER / "logs") as processes:
        Demonstration(processes, report).run()
    (FOLDER / "report.md").write_text(report.text(), encoding="utf-8")
    print(f"see {FOLDER}: report.md, canvas.png, site.map, site.bin")


PARTS = {
    "": (run, FOLDER),
    "cluster": (cluster_demo.run, cluster_demo.FOLDER),
    "zalazone": (demonstration.run, demonstration.FOLDER),
}
KNOWN = ", ".join(f"PARTS={part}" for part in PARTS if part)


def main() -> int:
    part = " ".join(sys.argv[1:])
    if part not in PARTS:
        print(f"demo: error: there is no PARTS={part}; write {KNOWN}, or nothing", file=sys.stderr)
        return 1
    work, folder = PARTS[part]
    return ended("demo", work, f"logs: {folder / 'logs'}")


if __name__ == "__main__":
    sys.exit(main())
