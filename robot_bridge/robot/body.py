"""A simulated body with differential drive: limited speed, turn rate and accelerations."""

from __future__ import annotations

import math
from dataclasses import dataclass

Pose = tuple[float, float, float]
"""x, y in metres and theta in radians, site frame."""


@dataclass(frozen=True)
class BodyLimits:
    """What the body can do: m/s, rad/s, m/s², rad/s²."""

    speed: float = 1.5
    turn_rate: float = 1.2
    acceleration: float = 1.5
    turn_acceleration: float = 4.0


class Body:
    """Where the robot really is. ``drive`` asks for a motion, ``step`` lets time pass.

    ``driven`` is metres since the start.
    """

    def __init__(self, pose: Pose, limits: BodyLimits) -> None:
        self.pose = pose
        self.v = 0.0
        self.driven = 0.0
        self.turn_rate = 0.0
        self._limits = limits
        self._wanted = (0.0, 0.0)

    def place(self, pose: Pose) -> None:
        """Take the body to be at ``pose``, as a robot that is told where it stands."""
        self.pose = pose

    def drive(self, v: float, turn_rate: float) -> None:
        """Ask for a speed (m/s) and a turn rate (rad/s), within the limits."""
        limits = self._limits
        self._wanted = (
            _clamp(v, limits.speed),
            _clamp(turn_rate, limits.turn_rate),
        )

    def step(self, dt: float) -> None:
        """Move on by ``dt`` seconds along an arc."""
        limits = self._limits
        self.v += _clamp(self._wanted[0] - self.v, limits.acceleration * dt)
        self.turn_rate += _clamp(self._wanted[1] - self.turn_rate, limits.turn_acceleration * dt)
        x, y, theta = self.pose
        self.driven += abs(self.v) * dt
        middle = theta + self.turn_rate * dt / 2
        self.pose = (
            x + self.v * math.cos(middle) * dt,
            y + self.v * math.sin(middle) * dt,
            math.remainder(theta + self.turn_rate * dt, math.tau),
        )


def _clamp(value: float, limit: float) -> float:
    return max(-limit, min(limit, value))
