"""The part on endurance: a shift of half an hour with a crowd of robots, a bad network and a plugin that is
reloaded again and again, in QGIS Desktop itself."""

from __future__ import annotations

import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.bad_network import PAUSES, BadNetwork
from benchmarks.endurance_findings import Run, Sample, Unloaded, complaints_in, faults, grown
from benchmarks.endurance_page import report
from benchmarks.load import MALLOC, SITE, site_with_room
from benchmarks.page import Part
from robot_bridge.core.sites.site import read_site
from tests.support.faults.proxy import Proxy
from tests.support.fleet import PROJECT
from tests.support.processes import Processes
from tests.support.qgis import Profile, virtual_screen
from tests.support.session import follow, start_qgis
from tools.plugin_files import ROOT

SESSION = "endurance/session.py"
FOLDER = ROOT / "build" / "endurance"
MINUTES = 30.0
"""Without another number in the environment's MINUTES."""
RELOADS = 20
SHORTEST_SHIFT = 45.0
"""Seconds: in less no operator does all there is to do, and fewer reloads are made."""
ROBOTS = 1000
WINDOW = (1280, 800)
EXTENT = (0.0, 0.0, 200.0, 160.0)
ENOUGH = 300.0
"""Seconds for a busy machine to begin and to end."""
RASTER_CACHE = 16
"""MB of rasters that GDAL may keep in QGIS: unbounded, it goes on filling for as long as the run takes."""


def measure(_data: Path) -> Part:
    """Let it run for MINUTES of the environment, half an hour without."""
    minutes = float(os.environ.get("MINUTES") or MINUTES)
    run = endure(minutes * 60, reloads_in(minutes * 60))
    wrong = [*faults(run), *grown(run.samples, minutes * 60)]
    text = report(run, minutes, wrong, robots=ROBOTS, raster_cache=RASTER_CACHE, window=WINDOW)
    settings = {**MALLOC, "GDAL_CACHEMAX": str(RASTER_CACHE)}
    return Part("Endurance", text, failed=bool(wrong), settings=settings)


def reloads_in(seconds: float) -> int:
    """Return how often the plugin is reloaded."""
    return max(1, min(RELOADS, int(seconds / SHORTEST_SHIFT) - 1))


def endure(
    seconds: float,
    reloads: int,
    robots: int = ROBOTS,
    pauses: tuple[float, float] = PAUSES,
    folder: Path = FOLDER,
) -> Run:
    """Run gateway, robots, network and QGIS, with all their files in ``folder``, and return what was seen.

    :raises StageError: when something does not come up, or QGIS does not come to its end.
    """
    with _stage(folder, robots) as (processes, proxy):
        told = plan(folder, proxy.port, seconds, reloads, robots)
        display = virtual_screen(processes, *WINDOW)
        profile, settings = Profile(folder / "profile", link=False), {"GDAL_CACHEMAX": str(RASTER_CACHE)}
        qgis = start_qgis(processes, profile, SESSION, told, display, settings=settings)
        with BadNetwork(proxy, pauses) as network:
            entries = follow(processes, qgis, Path(str(told["journal"])), seconds + ENOUGH)
            samples, unloaded, end = _watched(entries, network)
        complaints = complaints_in(processes.log("qgis"))
    return Run(samples, unloaded, end, network.drops, complaints)


@contextmanager
def _stage(folder: Path, robots: int) -> Iterator[tuple[Processes, Proxy]]:
    folder.mkdir(parents=True, exist_ok=True)
    for file in folder.glob("fleet.db*"):
        file.unlink()
    with Processes(folder / "logs") as processes:
        options = ["--database", f"sqlite:///{folder}/fleet.db", "--port", "0"]
        command = [sys.executable, "-m", "robot_bridge", "serve", "--site", site_with_room(folder), *options]
        processes.start("gateway", command, env=MALLOC)
        port = processes.wait_for_line("gateway", r"listening on ws://\S+:(\d+)", 60).group(1)
        crowd = [sys.executable, "-m", "benchmarks.endurance_robots", "127.0.0.1", port, str(robots)]
        processes.start("robots", crowd, env={"PYTHONPATH": str(ROOT)})
        processes.wait_for_line("robots", "ready", 60)
        with Proxy(int(port)) as proxy:
            yield processes, proxy


def plan(folder: Path, port: int, seconds: float, reloads: int, robots: int) -> dict[str, object]:
    """Return what the session inside QGIS is told."""
    frame = read_site(SITE).frame
    return {
        "journal": str(folder / "journal.jsonl"),
        "project": str(PROJECT),
        "gateway": f"ws://127.0.0.1:{port}/desk",
        "operator": "endurance",
        "robots": [f"robot-{number:04d}" for number in range(robots)],
        "window": WINDOW,
        "crs": frame.crs,
        "extent": frame.to_crs(np.array([EXTENT[:2], EXTENT[2:]])).ravel().tolist(),
        "seconds": seconds,
        "reloads": reloads,
    }


def _watched(
    entries: Iterator[dict[str, Any]], network: BadNetwork
) -> tuple[list[Sample], list[Unloaded], dict[str, Any]]:
    samples: list[Sample] = []
    unloaded: list[Unloaded] = []
    end: dict[str, Any] = {}
    for entry in entries:
        figures = entry["figures"]
        if entry["step"] == "sample":
            samples.append(Sample(**figures, drops=sum(network.drops.values())))
            print(samples[-1], file=sys.stderr, flush=True)
        elif entry["step"] == "unloaded":
            unloaded.append(Unloaded(**figures))
            print(entry["text"], file=sys.stderr, flush=True)
        else:
            end = figures
    return samples, unloaded, end
