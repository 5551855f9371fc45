"""How the robot drives to a target or along a path: pure pursuit, then a turn on the spot."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from ..polyline import Polyline
from .body import BodyLimits, Pose

ARRIVED = 0.05
"""metres from the end at which the robot stops."""
LOOK_AHEAD = 1.2
"""metres ahead on the path that the robot steers to."""
TURN_FIRST = 0.6
"""radians off course above which it turns on the spot before it drives."""
HEADING_REACHED = 0.03
"""radians."""
WINDOW = 4.0
"""metres of path searched ahead for the place where the robot is, so that it cuts no loop short."""

Motion = tuple[float, float]
"""Speed in m/s and turn rate in rad/s."""


class Driver:
    """Drives one task. ``points`` is where to go, (x, y) in metres; ``theta`` the heading to end in."""

    def __init__(
        self, points: Sequence[tuple[float, float]], theta: float | None, limits: BodyLimits
    ) -> None:
        self._line = Polyline(points)
        self._theta = theta
        self._limits = limits
        self._driven = 0.0
        self._at_end = False

    def steer(self, pose: Pose) -> Motion | None:
        """Return the motion to ask the body for at ``pose``, or None when the task is done."""
        x, y, theta = pose
        self._locate(x, y)
        end = self._line.end
        distance = math.hypot(end[0] - x, end[1] - y)
        self._at_end = self._at_end or (self._on_last_metres() and distance < ARRIVED)
        if self._at_end:
            return self._turn_to_heading(theta)
        aim_x, aim_y = (
            end
            if self._on_last_metres() and distance < LOOK_AHEAD
            else self._line.at(self._driven + LOOK_AHEAD)
        )
        bearing = math.remainder(math.atan2(aim_y - y, aim_x - x) - theta, math.tau)
        turn = 2.5 * bearing
        if abs(bearing) > TURN_FIRST:
            return 0.0, turn
        to_go = max(distance, self._line.length - self._driven)
        braking = math.sqrt(2 * 0.5 * self._limits.acceleration * to_go)
        return min(self._limits.speed, braking) * math.cos(bearing), turn

    def _on_last_metres(self) -> bool:
        return bool(self._driven >= self._line.length - LOOK_AHEAD)

    def _locate(self, x: float, y: float) -> None:
        station, off = self._line.feet(x, y)
        ahead = (station >= self._driven) & (station <= self._driven + WINDOW)
        if ahead.any():
            self._driven = float(station[ahead][np.argmin(off[ahead])])

    def _turn_to_heading(self, theta: float) -> Motion | None:
        if self._theta is None:
            return None
        left = math.remainder(self._theta - theta, math.tau)
        return None if abs(left) < HEADING_REACHED else (0.0, 2.0 * left)
