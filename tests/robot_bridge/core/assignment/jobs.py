"""Jobs that the tests plan."""

from __future__ import annotations

import numpy as np

from robot_bridge.core.assignment.job import AssignmentJob, ConeTarget, PlanRobot, Store


def scattered(
    count: int, robots: int = 3, capacity: int = 4, seed: int = 1, size: float = 100.0, **job: object
) -> AssignmentJob:
    """Return ``count`` cones to place around one store, where all robots begin."""
    places = np.random.default_rng(seed).uniform(0, size, (count, 2)).round(2).tolist()
    middle = size / 2
    return AssignmentJob(
        tuple(ConeTarget(f"cone-{k}", x, y) for k, (x, y) in enumerate(places, 1)),
        tuple(PlanRobot(f"R{k}", middle, middle, capacity) for k in range(1, robots + 1)),
        (Store("shed", middle, middle),),
        **job,
    )
