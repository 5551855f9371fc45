"""A world made of a site's map, and robots in it that know their place by their sensors alone."""

from __future__ import annotations

from concurrent.futures import Executor
from pathlib import Path

import msgspec
import numpy as np

from ..robot.body import BodyLimits, Pose
from ..robotmap.model import RobotMap
from .errors import ReferenceRobotError
from .localised_body import LocalisedBody, LocalisedSettings, SimulatedWorld
from .localiser import InitialBelief
from .settings import RobotSettings, tables
from .world import changed, inside_solids, walls_of

MAP_MARGIN = 20.0
"""metres from the border of its map at which such a robot asks for the next one."""


def read_robot_settings(file: Path) -> RobotSettings:
    """Return what a robot and its world are set to by a TOML ``file``; raises ReferenceRobotError."""
    try:
        return msgspec.convert(tables(file), RobotSettings)
    except msgspec.ValidationError as error:
        raise ReferenceRobotError(f"settings {file}: {error}; see docs/experiments.md") from None


def simulated_world(robot_map: RobotMap, settings: RobotSettings, seed: int) -> SimulatedWorld:
    """Return the world of which ``robot_map`` is the map; another one for each ``seed``."""
    seen = walls_of(robot_map).higher_than(settings.laser.height)
    return SimulatedWorld(
        changed(seen, settings.world, np.random.default_rng([seed, 0])), walls_of(robot_map)
    )


def localised_robot(
    robot_map: RobotMap,
    settings: RobotSettings,
    limits: BodyLimits,
    pose: Pose,
    executor: Executor,
    *,
    knows_pose: bool = True,
    gps: bool = False,
    seed: int = 1,
) -> LocalisedBody:
    """Return a robot at ``pose`` of a world made of ``robot_map``, whose filter works on ``executor``.

    :raises ReferenceRobotError: for a place that is not in that world, or in something solid.
    """
    x, y, _ = pose
    if not robot_map.border.holds(x, y) or inside_solids(robot_map, np.array([[x, y]]))[0]:
        raise ReferenceRobotError(
            f"pose ({x:.1f}, {y:.1f}) is not on the map of world {robot_map.meta.get('id', 'without id')}, "
            "or in something solid there; choose a place that is free"
        )
    belief = InitialBelief(pose, unknown=not knows_pose)
    robot = LocalisedSettings(settings, limits, pose, belief, gps=gps, seed=seed)
    return LocalisedBody(robot, simulated_world(robot_map, settings, seed), executor)
