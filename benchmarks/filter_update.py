"""The part on what one update of the reference robot's particle filter costs, by numpy and by numba."""

from __future__ import annotations

import importlib.util
import time
from pathlib import Path
from tempfile import TemporaryDirectory

import msgspec
import numpy as np

from benchmarks.clock import spread
from benchmarks.localisation import campus
from benchmarks.page import Part, goal
from benchmarks.trial import IS_TRIAL, size
from robot_bridge.core.robotmap.model import RobotMap
from robot_bridge.core.sites.site import read_site
from robot_bridge.reference_robot.localisation.experiment import (
    EXPERIMENTS,
    ExperimentSettings,
    SensorLog,
    read_settings,
    run,
)
from robot_bridge.reference_robot.localisation.particle_filter import ParticleFilter
from robot_bridge.reference_robot.localisation.sensors import Motion

PARTICLES = 500
WARM = 10
"""updates before it is measured, in which numba compiles."""
LENGTH = size(143.0, 20.0)
"""metres of the drive."""
MOST_MS = {"numpy": 12.0, "numba": 5.0}

TEXT = """\
{particles} particles and the {beams} beams of a scan: motion, weighing, resampling and belief, for each scan
of a drive of `robot-bridge experiment a5-loop` ([how](experiments.md)). Milliseconds of processor time of one
thread, {count} updates each.

| | median [quartiles] | goal |
|---|---|---|
{rows}
"""


def measure(data: Path) -> Part:
    """Measure on the campus."""
    with TemporaryDirectory(prefix="fleet-filter-") as folder:
        robot_map = read_site(campus(data, Path(folder))).whole_map()
    settings = read_settings(EXPERIMENTS / "a5-loop.toml")
    log = run(robot_map, msgspec.structs.replace(settings, length=LENGTH), 1).log
    assert log is not None
    rows, failed = [], False
    for name, most in MOST_MS.items():
        if name == "numba" and not importlib.util.find_spec("numba"):
            rows.append("| numba | not measured: it is not installed | – |")
            continue
        found = spread(_updates(robot_map, settings, log, compiled=name == "numba"))
        is_met = found.median <= most
        failed |= not is_met and not IS_TRIAL
        rows.append(f"| {name} | {found:.1f} | {goal(f'at most {most:g} ms', is_met)} |")
    text = TEXT.format(
        particles=PARTICLES, beams=settings.laser.beams, count=len(log.motions) - WARM, rows="\n".join(rows)
    )
    return Part("An update of the particle filter", text, failed)


def _updates(
    robot_map: RobotMap, settings: ExperimentSettings, log: SensorLog, *, compiled: bool
) -> list[float]:
    """Return milliseconds of processor time of each update of a logged drive."""
    filter_settings = msgspec.structs.replace(settings.filter, least=PARTICLES, most=PARTICLES)
    found = ParticleFilter(robot_map, settings.laser, filter_settings, np.random.default_rng(1), compiled)
    found.place(log.start, (settings.start_m, np.radians(settings.start_deg)))
    found.observe(log.scans[0])
    times = []
    for motion, scan in zip(log.motions.tolist(), log.scans[1:], strict=True):
        begin = time.thread_time()
        found.move(Motion(*motion))
        found.observe(scan)
        assert found.belief is not None
        times.append(1e3 * (time.thread_time() - begin))
    return times[WARM:]
