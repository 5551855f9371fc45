"""How the robot drives to a target or along a path: pure pursuit, then a turn on the spot."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

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
        self._points = np.asarray(points, dtype=np.float64)
        steps = np.hypot(*np.diff(self._points, axis=0).T) if len(points) > 1 else np.empty(0)
        self._stations = np.concatenate([[0.0], np.cumsum(steps)])
        self._theta = theta
        self._limits = limits
        self._driven = 0.0
        self._at_end = False

    def steer(self, pose: Pose) -> Motion | None:
        """Return the motion to ask the body for at ``pose``, or None when the task is done."""
        x, y, theta = pose
        self._locate(x, y)
        end = self._points[-1]
        distance = math.hypot(end[0] - x, end[1] - y)
        self._at_end = self._at_end or (self._on_last_metres() and distance < ARRIVED)
        if self._at_end:
            return self._turn_to_heading(theta)
        aim_x, aim_y = end if self._on_last_metres() and distance < LOOK_AHEAD else self._aim()
        bearing = math.remainder(math.atan2(aim_y - y, aim_x - x) - theta, math.tau)
        turn = 2.5 * bearing
        if abs(bearing) > TURN_FIRST:
            return 0.0, turn
        to_go = max(distance, self._stations[-1] - self._driven)
        braking = math.sqrt(2 * 0.5 * self._limits.acceleration * to_go)
        return min(self._limits.speed, braking) * math.cos(bearing), turn

    def _on_last_metres(self) -> bool:
        return bool(self._driven >= self._stations[-1] - LOOK_AHEAD)

    def _locate(self, x: float, y: float) -> None:
        if len(self._points) == 1:
            return
        start, step = self._points[:-1], np.diff(self._points, axis=0)
        length = np.maximum(np.hypot(*step.T), 1e-9)
        along = np.clip(((np.array([x, y]) - start) * step).sum(axis=1) / length**2, 0, 1)
        off = np.hypot(*(start + along[:, None] * step - (x, y)).T)
        station = self._stations[:-1] + along * length
        ahead = (station >= self._driven) & (station <= self._driven + WINDOW)
        if ahead.any():
            self._driven = float(station[ahead][np.argmin(off[ahead])])

    def _aim(self) -> tuple[float, float]:
        station = self._driven + LOOK_AHEAD
        return (
            float(np.interp(station, self._stations, self._points[:, 0])),
            float(np.interp(station, self._stations, self._points[:, 1])),
        )

    def _turn_to_heading(self, theta: float) -> Motion | None:
        if self._theta is None:
            return None
        left = math.remainder(self._theta - theta, math.tau)
        return None if abs(left) < HEADING_REACHED else (0.0, 2.0 * left)
