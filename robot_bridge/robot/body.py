"""A simulated body with differential drive: limited speed, turn rate and accelerations."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol

from ..messages import Observed
from ..robotmap.model import RobotMap

Pose = tuple[float, float, float]
"""x, y in metres and theta in radians, site frame."""


@dataclass(frozen=True)
class BodyLimits:
    """What the body can do: m/s, rad/s, m/s², rad/s²."""

    speed: float = 1.5
    turn_rate: float = 1.2
    acceleration: float = 1.5
    turn_acceleration: float = 4.0

    @classmethod
    def of(cls, speed: float, turn_rate: float, acceleration: float) -> BodyLimits:
        """Limits of a body whose two accelerations are in proportion; it is told the one in m/s²."""
        return cls(speed, turn_rate, acceleration, cls.turn_acceleration * acceleration / cls.acceleration)


class Vehicle(Protocol):
    """What an agent drives. Its ``pose`` is where it takes itself to be.

    ``accuracy`` is the standard deviation of that in metres, ``hindrance`` says why it must not drive,
    ``remark`` what else operators are to know, and ``blocked_for`` for how many seconds something has been in
    its way.
    """

    @property
    def pose(self) -> Pose: ...
    @property
    def v(self) -> float: ...
    @property
    def driven(self) -> float: ...
    @property
    def accuracy(self) -> float | None: ...
    @property
    def hindrance(self) -> str | None: ...
    @property
    def remark(self) -> str | None: ...
    @property
    def blocked_for(self) -> float: ...

    def place(self, pose: Pose) -> None:
        """Take it to be at ``pose``."""

    def drive(self, v: float, turn_rate: float) -> None:
        """Ask for a motion, m/s and rad/s."""

    def step(self, dt: float) -> None:
        """Let ``dt`` seconds pass."""

    def use_map(self, robot_map: RobotMap) -> str | None:
        """Take over a map; return why not, or None."""

    def observations(self) -> Sequence[Observed]:
        """Return what it has seen since it was asked last that belongs on the map."""


class Body:
    """Where the robot really is. ``drive`` asks for a motion, ``step`` lets time pass.

    ``driven`` is metres since the start. It knows its place without a map, and stands in nobody's way.
    """

    accuracy: float | None = None
    hindrance: str | None = None
    remark: str | None = None
    blocked_for = 0.0

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

    def use_map(self, robot_map: RobotMap) -> str | None:
        """Take any map: it needs none."""
        return None

    def observations(self) -> Sequence[Observed]:
        """Return nothing: it sees nothing."""
        return ()

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
