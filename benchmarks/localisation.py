"""The part on the robot that finds itself: against Nav2's AMCL on the same logs, and on a slow core."""

from __future__ import annotations

import json
import math
import os
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from pathlib import Path
from tempfile import TemporaryDirectory

import msgspec
import numpy as np

from benchmarks.clock import spread
from benchmarks.page import Part, goal
from benchmarks.qgis_process import qgis_process
from benchmarks.trial import IS_TRIAL, size
from robot_bridge.core.robotmap.exporters.nav2 import occupancy_of, trinary_files
from robot_bridge.core.robotmap.model import RobotMap
from robot_bridge.core.sites.site import read_site
from robot_bridge.reference_robot.localisation.experiment import (
    EXPERIMENTS,
    ExperimentSettings,
    Record,
    SensorLog,
    read_settings,
    run,
)
from robot_bridge.reference_robot.localisation.experiment_report import Figures, figures
from robot_bridge.reference_robot.localisation.sensors import bearings_of
from tests.support.errors import StageError
from tests.support.peers import run_peer
from tests.support.robots.amcl_peer import DRIVE, PACKAGES, amcl_python
from tests.support.robots.slow_core import slow_core

SEEDS, OWN_SEEDS = size(int(os.environ.get("DRIVES") or 10), 1), 1
"""drives, and those that AMCL makes with Nav2's own values too: each of these takes it a minute."""
RESOLUTION = 0.05
SHARES = size((1.0, 0.1, 0.05), (0.1,))
"""of a core."""
RATE = 5.0
TIMED = size(100, 30)
"""scans on each of them."""
CAMPUS = "upc_campus_nord/upc_campus_nord_local.gpkg"
LAYERS = ("buildings", "walls", "step_edges", "furniture", "ground_surfaces")
ROOT = Path(__file__).resolve().parents[1]
FILTER = "tests.support.robots.filter_at_rate"

NAV2 = {
    "min_particles": 500,
    "max_particles": 2000,
    "alpha": 0.2,
    "weights": (0.5, 0.05, 0.05, 0.5),
    "sigma_hit": 0.2,
    "max_beams": 60,
    "min_d": 0.25,
    "min_a": 0.2,
}
"""What Nav2 has where nobody sets anything."""
SET = NAV2 | {"alpha": 0.02, "max_particles": 500, "max_beams": 90, "min_d": 0.0, "min_a": -1.0}
"""Set to this robot, the best of what was tried: odometry as good as it is, all beams of every scan."""

TEXT = """\
The drives of `robot-bridge experiment a5-loop` ([how](experiments.md)): {seeds} seeds, each in another world
that differs from the map. Each drive's scans, and its motions by wheels and gyroscope, are written to a log,
and the same logs go through Nav2's AMCL ({package}, its Python bindings, with the beam model), which has the
map as the Nav2 grid that `fleet:exportnavigationmap` writes, {resolution:g} m a cell, of what the laser sees.
Both begin where the robot stands, with the same uncertainty. Errors are those at every scan; where AMCL does
not weigh one, its belief moves on with the wheels. AMCL runs with Nav2's own values, and with values set to
this robot, the best of those that were tried.

| | mean [m] | p95 [m] | max [m] | heading mean [°] | update [ms] |
|---|---|---|---|---|---|
{rows}

Against the one that is set to this robot ours is ahead in the mean in {mean_ahead} of {seeds} drives and in
the p95 in {p95_ahead} ({verdict}).

| seed | ours, mean [m] | p95 [m] | AMCL, set, mean [m] | p95 [m] |
|---|---|---|---|---|
{seeds_rows}

### On a slow core

The filter by itself on the first log, {rate:g} scans a second by the clock, {timed} of them, in a process
that a control group lets have a share of one core of this machine, a millisecond at a time. A scan is late
when it is not weighed before the next one comes. The machine was busy with other work, too.

{slow}
"""
_SLOW_HEAD = (
    "| share of a core | scan weighed after [ms], median | p95 | most | late | processor time [ms] |\n"
    "|---|---|---|---|---|---|\n"
)


def measure(data: Path) -> Part:
    """Measure on the campus."""
    with TemporaryDirectory(prefix="fleet-localisation-") as folder:
        return _measure(campus(data, Path(folder)), Path(folder))


def _measure(site: Path, folder: Path) -> Part:
    settings = read_settings(EXPERIMENTS / "a5-loop.toml")
    if IS_TRIAL:
        settings = msgspec.structs.replace(settings, length=20.0)
    robot_map = read_site(site).whole_map()
    _write_grid(robot_map, settings.laser.height, folder)
    amcl_python()
    ours, by_amcl = [], []
    with ThreadPoolExecutor(4) as pool:
        for seed in range(1, SEEDS + 1):
            record = run(robot_map, settings, seed)
            log = _write_log(record, settings, folder)
            ours.append(record)
            by_amcl.append(
                [
                    pool.submit(_by_amcl, record, log, settings, values)
                    for values in ((SET, NAV2) if seed <= OWN_SEEDS else (SET,))
                ]
            )
    contenders = {
        f"ours, {SEEDS} drives": ours,
        f"AMCL, set to this robot, {SEEDS} drives": [one[0].result() for one in by_amcl],
        f"ours, the first {OWN_SEEDS}": ours[:OWN_SEEDS],
        f"AMCL, Nav2's own values, the first {OWN_SEEDS}": [one[1].result() for one in by_amcl[:OWN_SEEDS]],
    }
    tables = {name: figures(records) for name, records in contenders.items()}
    totals = [rows[-1] for rows in tables.values()]
    each = list(zip(*(rows[:SEEDS] for rows in list(tables.values())[:2]), strict=True))
    ahead = all(
        one.mean_m < other.mean_m and one.p95_m < other.p95_m for one, other in (totals[:2], totals[2:])
    )
    text = TEXT.format(
        seeds=SEEDS,
        package=f"`{PACKAGES[0]}` of PyPI",
        resolution=RESOLUTION,
        rows="\n".join(_row(name, total) for name, total in zip(tables, totals, strict=True)),
        mean_ahead=sum(row[0].mean_m < min(one.mean_m for one in row[1:]) for row in each),
        p95_ahead=sum(row[0].p95_m < min(one.p95_m for one in row[1:]) for row in each),
        verdict=goal("ahead of both in mean and p95 of all drives", ahead),
        seeds_rows="\n".join(_seed_row(row) for row in each),
        rate=RATE,
        timed=TIMED,
        slow=_slow_rows(site, folder / "log-1.npz"),
    )
    return Part("A robot that finds itself: against Nav2's AMCL, and on a slow core", text, not ahead)


def campus(data: Path, folder: Path) -> Path:
    """Return the campus, published."""
    layers = [f"OBSTACLES={data / CAMPUS}|layername={name}" for name in LAYERS]
    words = ["PROFILE=upc_campus_nord", "SITE_ID=campus", "SITE_CRS=EPSG:25831", "ORIGIN=426000,4582000"]
    with qgis_process() as program:
        site = folder / "campus"
        program.run("run", "fleet:publishsite", "--", *layers, *words, "LOCAL=true", f"FOLDER={site}")
    return site


def _write_grid(robot_map: RobotMap, height: float, folder: Path) -> None:
    """Write the map as Nav2 reads it, of what stands above the laser."""
    found = occupancy_of(robot_map, RESOLUTION, drives_over=height)
    for name, content in trinary_files("grid", found.grid, found.cells).items():
        (folder / name).write_bytes(content)


def _write_log(record: Record, settings: ExperimentSettings, folder: Path) -> Path:
    assert isinstance(record.log, SensorLog)
    file = folder / f"log-{record.seed}.npz"
    log = record.log
    laser = {"bearings": bearings_of(settings.laser), "reach": settings.laser.reach}
    np.savez(file, start=log.start, motions=log.motions, scans=log.scans, **laser)
    return file


def _by_amcl(record: Record, log: Path, settings: ExperimentSettings, values: dict) -> Record:
    """Return the same drive with the beliefs of AMCL."""
    name = f"{log.stem}-{values['max_particles']}"
    told, beliefs = log.with_name(f"{name}.json"), log.with_name(f"{name}-beliefs.npz")
    start = {"start_m": settings.start_m, "start_rad": math.radians(settings.start_deg)}
    told.write_text(json.dumps(values | start))
    run_peer(amcl_python(), DRIVE, log.with_name("grid.yaml"), log, told, beliefs)
    found = np.load(beliefs)
    # AMCL does not say that it is lost.
    never = np.zeros(len(record.truth), dtype=bool)
    return replace(record, belief=found["belief"], seconds=found["seconds"], lost=never)


def _row(name: str, found: Figures) -> str:
    errors = f"{found.mean_m:.3f} | {found.p95_m:.3f} | {found.max_m:.3f} | {found.heading_mean_deg:.2f}"
    return f"| {name} | {errors} | {found.update_ms:.1f} |"


def _seed_row(found: tuple[Figures, ...]) -> str:
    return f"| {found[0].seed} | " + " | ".join(f"{one.mean_m:.3f} | {one.p95_m:.3f}" for one in found) + " |"


def _slow_rows(site: Path, log: Path) -> str:
    """Return the table on slow cores, or why there is none."""
    some = log.with_name("some.npz")
    found = np.load(log)
    count = TIMED + 10
    short = {"motions": found["motions"][:count], "scans": found["scans"][: count + 1]}
    np.savez(some, **{name: short.get(name, found[name]) for name in found.files})
    try:
        return _SLOW_HEAD + "\n".join(_slow_row(site, some, share) for share in SHARES)
    except StageError as error:
        return f"Not measured: {error}."


def _slow_row(site: Path, log: Path, share: float) -> str:
    with slow_core(share) as group:
        words = [sys.executable, "-m", FILTER, site, log, RATE, group]
        done = subprocess.run(
            [str(word) for word in words],
            capture_output=True,
            text=True,
            check=False,
            timeout=600,
            cwd=ROOT,
            env={**os.environ, "OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"},
        )
    if done.returncode:
        raise StageError(f"the filter on {share:g} of a core failed: {done.stderr[-500:]}")
    told = json.loads(done.stdout)
    waited = np.array(told["waited"])
    late = int((waited > 1e3 / RATE).sum())
    figures_ = f"{np.median(waited):.0f} | {np.percentile(waited, 95):.0f} | {waited.max():.0f}"
    return f"| {share:g} | {figures_} | {late} of {len(waited)} | {spread(told['used']):.1f} |"
