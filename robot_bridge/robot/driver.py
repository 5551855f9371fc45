"""How the robot drives to a target or along a path: pure pursuit, slow in corners, a turn at the end."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

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

CORNER = 0.6
"""metres before and behind a corner in which the robot takes it."""
TURNING = 0.6
"""Of its turn rate, what a corner takes: with the rest the robot comes back to its path."""
LEAST_SPEED = 0.2
"""m/s through the sharpest corner."""
BRAKING = 0.5
"""Of its acceleration, what the robot brakes with: it can do more."""

Motion = tuple[float, float]
"""Speed in m/s and turn rate in rad/s."""


class Driver:
    """Drives one task. ``points`` is where to go, (x, y) in metres; ``theta`` the heading to end in."""

    def __init__(
        self, points: Sequence[tuple[float, float]], theta: float | None, limits: BodyLimits
    ) -> None:
        self._points = list(points)
        self._line = Polyline(points)
        self.theta = theta
        self._limits = limits
        self._braking = 2 * BRAKING * limits.acceleration
        self._stations, self._speeds, self._squares = self._corners()
        self._driven = 0.0
        self._at_end = False

    @property
    def left(self) -> list[tuple[float, float]]:
        """The points that are still ahead, the last one at least."""
        ahead = [p for p, at in zip(self._points, self._line.stations, strict=True) if at > self._driven]
        return ahead or [self._points[-1]]

    def off(self, pose: Pose) -> float:
        """Return how far ``pose`` is from what is left of its path, metres; 0 without a path."""
        if len(self._points) < 2:
            return 0.0
        station, off = self._line.feet(*pose[:2])
        ahead = (station >= self._driven) & (station <= self._driven + WINDOW)
        return float(off[ahead].min(initial=math.inf))

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
        speed = min(self._limits.speed, math.sqrt(self._braking * to_go), self._before_corners())
        return speed * math.cos(bearing), turn

    def _corners(self) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
        """Return stations, the speed through each, and the least of v² + 2as of the corners from there on.

        Who drives with v at a station s can then still brake by a for each of them, where 2as less is left.
        """
        bends = self._line.turns(CORNER) / (2 * CORNER)
        fastest = TURNING * self._limits.turn_rate / np.maximum(bends, 1e-9)
        speeds = np.minimum(np.maximum(fastest, LEAST_SPEED), self._limits.speed)
        stations = np.array(self._line.stations)
        squares = speeds**2 + self._braking * stations
        return stations, speeds, np.minimum.accumulate(squares[::-1])[::-1]

    def _before_corners(self) -> float:
        """Return the speed with which the robot can still be slow enough in each corner ahead."""
        # One that lies just behind is still being driven round, and no longer braked for.
        begin, ahead = np.searchsorted(self._stations, [self._driven - CORNER, self._driven])
        fastest = float(self._speeds[begin:ahead].min(initial=math.inf))
        if ahead < len(self._squares):
            left = float(self._squares[ahead]) - self._braking * self._driven
            fastest = min(fastest, math.sqrt(max(left, LEAST_SPEED**2)))
        return fastest

    def _on_last_metres(self) -> bool:
        return bool(self._driven >= self._line.length - LOOK_AHEAD)

    def _locate(self, x: float, y: float) -> None:
        station, off = self._line.feet(x, y)
        ahead = (station >= self._driven) & (station <= self._driven + WINDOW)
        if ahead.any():
            self._driven = float(station[ahead][np.argmin(off[ahead])])

    def _turn_to_heading(self, theta: float) -> Motion | None:
        if self.theta is None:
            return None
        left = math.remainder(self.theta - theta, math.tau)
        return None if abs(left) < HEADING_REACHED else (0.0, 2.0 * left)
