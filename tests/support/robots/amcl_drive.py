"""One logged drive through Nav2's AMCL: ``amcl_drive.py MAP.yaml LOG.npz SETTINGS.json BELIEFS.npz``.

Run by the Python of :mod:`.amcl_peer`, which knows nothing of this project: all that it has of the map are
the two files that Nav2 reads. ``LOG`` holds what a SensorLog of ``robot_bridge/reference_robot/localisation``
does, with the ``bearings`` and the ``reach`` of the laser; ``BELIEFS`` gets ``belief``, (n, 3), and the
``seconds`` of processor time of each update.
"""

from __future__ import annotations

import json
import math
import re
import sys
import time
from pathlib import Path

import amcl
import numpy as np


def main() -> None:
    """Drive, and write what was believed after each scan."""
    image, log, settings, beliefs = sys.argv[1:]
    grid = read_grid(Path(image))
    belief, seconds = drive(grid, np.load(log), json.loads(Path(settings).read_text()))
    np.savez(beliefs, belief=belief, seconds=seconds)


def read_grid(file: Path) -> amcl.OccupancyGrid:
    """Return the grid of a Nav2 map in trinary mode, as map_server reads it."""
    text = file.read_text()
    words = dict(re.findall(r"^(\w+): (.*)$", text, re.MULTILINE))
    x_min, y_min, _ = json.loads(words["origin"])
    pgm = (file.parent / words["image"]).read_bytes()
    columns, rows = map(int, re.match(rb"P5\n(\d+) (\d+)\n255\n", pgm).groups())
    pixels = np.frombuffer(pgm[-columns * rows :], np.uint8).reshape(rows, columns)[::-1]
    occupied = (255 - pixels.astype(float)) / 255
    cells = np.full(pixels.shape, -1)
    cells[occupied > float(words["occupied_thresh"])] = 100
    cells[occupied < float(words["free_thresh"])] = 0
    return amcl.create_occupancy_grid_from_list(cells.tolist(), float(words["resolution"]), x_min, y_min)


def drive(grid: amcl.OccupancyGrid, log: dict, settings: dict) -> tuple[np.ndarray, np.ndarray]:
    """Return the pose believed after each motion, (n, 3), and the processor time of each update."""
    found = amcl.AMCL(
        settings["min_particles"],
        settings["max_particles"],
        0.0,
        0.0,
        amcl.MotionParameters(*[settings["alpha"]] * 5),
        amcl.LaserParameters(*settings["weights"], settings["sigma_hit"], 0.1, 0.0, settings["max_beams"]),
        "differential",
    )
    found.set_map(grid)
    found.set_laser_pose(amcl.Vector3D(0.0, 0.0, 0.0))
    x, y, theta = log["start"].tolist()
    spread = settings["start_m"] ** 2, settings["start_m"] ** 2, settings["start_rad"] ** 2
    found.set_initial_pose(amcl.Vector3D(x, y, theta), amcl.create_diagonal_covariance(*spread))
    reach, bearings = float(log["reach"]), log["bearings"]
    found.update(scan_of(log["scans"][0], bearings, reach), amcl.Vector3D(x, y, theta))
    wheels = updated = believed = x, y, theta
    beliefs, seconds = [], []
    for motion, ranges in zip(log["motions"].tolist(), log["scans"][1:], strict=True):
        wheels = moved(wheels, *motion)
        turned = math.remainder(wheels[2] - updated[2], math.tau)
        # Nav2's update_min_d and update_min_a: standing still the same scan is not weighed again.
        if math.dist(wheels[:2], updated[:2]) > settings["min_d"] or abs(turned) > settings["min_a"]:
            scan = scan_of(ranges, bearings, reach)
            began = time.process_time()
            found.update(scan, amcl.Vector3D(*wheels))
            seconds.append(time.process_time() - began)
            pose = found.get_pose_mean()
            updated, believed = wheels, (pose.x, pose.y, pose.theta)
        beliefs.append(carried(believed, updated, wheels))
    return np.array(beliefs), np.array(seconds)


def scan_of(ranges: np.ndarray, bearings: np.ndarray, reach: float) -> amcl.LaserScan:
    """Return a scan; what has no reading has the greatest range, as laser drivers for Nav2 tell it."""
    ranges = np.where(np.isfinite(ranges), np.minimum(ranges, reach), reach)
    return amcl.create_laser_scan_from_list(np.column_stack([ranges, bearings]).tolist(), reach)


def moved(pose: tuple, distance: float, turn: float) -> tuple:
    """Return where a motion on an arc leads."""
    x, y, theta = pose
    middle = theta + turn / 2
    return (
        x + distance * math.cos(middle),
        y + distance * math.sin(middle),
        math.remainder(theta + turn, math.tau),
    )


def carried(believed: tuple, then: tuple, now: tuple) -> tuple:
    """Return a belief moved on by what the wheels say since, as Nav2's transform from map to odom does."""
    turned = believed[2] - then[2]
    dx, dy = now[0] - then[0], now[1] - then[1]
    return (
        believed[0] + dx * math.cos(turned) - dy * math.sin(turned),
        believed[1] + dx * math.sin(turned) + dy * math.cos(turned),
        math.remainder(now[2] + turned, math.tau),
    )


if __name__ == "__main__":
    main()
