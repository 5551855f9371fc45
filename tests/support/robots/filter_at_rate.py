"""The reference robot's filter on a logged drive, by the clock: ``filter_at_rate SITE LOG RATE [GROUP]``.

With GROUP, the file of a control group, it goes in there once all is loaded. Prints as JSON for how many
milliseconds each scan waited until it was weighed, and the processor time that it took.
"""

from __future__ import annotations

import json
import sys
import time
from pathlib import Path

import numpy as np

from robot_bridge.core.sites.site import read_site
from robot_bridge.reference_robot.localisation.particle_filter import ParticleFilter
from robot_bridge.reference_robot.localisation.sensors import Motion
from robot_bridge.reference_robot.localisation.settings import FilterSettings, LaserSettings

WARM = 10
"""scans before it is measured, in which numba compiles."""


def main() -> None:
    """Weigh each scan when it is due."""
    site, file, rate, *group = sys.argv[1:]
    log = np.load(file)
    robot_map = read_site(Path(site)).whole_map()
    found = ParticleFilter(robot_map, LaserSettings(), FilterSettings(), np.random.default_rng(1))
    found.place(tuple(log["start"].tolist()), (0.1, 0.03))
    found.observe(log["scans"][0])
    drive = list(zip(log["motions"].tolist(), log["scans"][1:], strict=True))
    for motion, scan in drive[:WARM]:
        weigh(found, motion, scan)
    for name in group:
        Path(name).write_text("0")
    waited, used = [], []
    begin = time.monotonic()
    for number, (motion, scan) in enumerate(drive[WARM:]):
        due = begin + number / float(rate)
        time.sleep(max(0.0, due - time.monotonic()))
        before = time.process_time()
        weigh(found, motion, scan)
        used.append(1e3 * (time.process_time() - before))
        waited.append(1e3 * (time.monotonic() - due))
    print(json.dumps({"waited": waited, "used": used}))


def weigh(found: ParticleFilter, motion: list[float], scan: np.ndarray) -> None:
    """Take in what was done and seen, and find the belief."""
    found.move(Motion(*motion))
    found.observe(scan)
    assert found.belief is not None


if __name__ == "__main__":
    main()
