"""The simulated body of a robot, and the objects that it sees."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from ..core.geometry import Polyline
from ..core.messages.robots import Observed, SendImage, SetObject
from ..core.robotmap.model import PART_OF, RobotMap

# --- A simulated body with differential drive: limited speed, turn rate and accelerations ---

Pose = tuple[float, float, float]
"""x, y in metres and theta in radians, site frame."""


@dataclass(frozen=True)
class BodyLimits:
    """Limits of the body: m/s, rad/s, m/s², rad/s²."""

    speed: float = 1.5
    turn_rate: float = 1.2
    acceleration: float = 1.5
    turn_acceleration: float = 4.0

    @classmethod
    def of(cls, speed: float, turn_rate: float, acceleration: float) -> BodyLimits:
        """Return limits with proportional accelerations; ``acceleration`` is the one in m/s²."""
        return cls(speed, turn_rate, acceleration, cls.turn_acceleration * acceleration / cls.acceleration)


class SimulatedVehicle(Protocol):
    """A vehicle driven by an agent. Its ``pose`` is its own estimate.

    ``accuracy`` is the standard deviation of that in metres, ``hindrance`` is why it must not drive,
    ``remark`` further information for operators, and ``blocked_for`` the seconds for which something has
    blocked it.
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
        """Set the pose estimate to ``pose``."""

    def drive(self, v: float, turn_rate: float) -> None:
        """Request a motion, m/s and rad/s."""

    def step(self, dt: float) -> None:
        """Let ``dt`` seconds pass."""

    def use_map(self, robot_map: RobotMap) -> str | None:
        """Use a map; return why not, or None."""

    def observations(self) -> Sequence[Observed]:
        """Return objects for the map that it has seen since the last call."""


class Body:
    """The true pose of the robot. ``drive`` requests a motion, ``step`` lets time pass.

    ``driven`` is metres since the start. It knows its place without a map, and blocks nothing.
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
        self._target_speeds = (0.0, 0.0)

    def place(self, pose: Pose) -> None:
        """Set the body to ``pose``, like a robot that receives its position."""
        self.pose = pose

    def use_map(self, robot_map: RobotMap) -> str | None:
        """Accept any map: it needs none."""
        return None

    def observations(self) -> Sequence[Observed]:
        """Return nothing: it sees nothing."""
        return ()

    def drive(self, v: float, turn_rate: float) -> None:
        """Request a speed (m/s) and a turn rate (rad/s), within the limits."""
        limits = self._limits
        self._target_speeds = (
            _clamp(v, limits.speed),
            _clamp(turn_rate, limits.turn_rate),
        )

    def step(self, dt: float) -> None:
        """Move on by ``dt`` seconds along an arc."""
        limits = self._limits
        self.v += _clamp(self._target_speeds[0] - self.v, limits.acceleration * dt)
        self.turn_rate += _clamp(self._target_speeds[1] - self.turn_rate, limits.turn_acceleration * dt)
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


# --- Driving to a target or along a path: pure pursuit, slow in corners, a turn at the end

ARRIVED = 0.05
"""metres from the end at which the robot stops."""
LOOK_AHEAD = 1.2
"""metres ahead on the path of the point that the robot steers to."""
TURN_FIRST = 0.6
"""radians off course above which it turns on the spot before it drives."""
HEADING_REACHED = 0.03
"""radians."""
WINDOW = 4.0
"""metres of path searched ahead for the robot's place, so that it skips no loop."""

CORNER = 0.6
"""metres before and behind a corner within which the robot rounds it."""
TURNING = 0.6
"""Share of the turn rate used in corners: the rest is for returning to the path."""
LEAST_SPEED = 0.2
"""m/s through the sharpest corner."""
BRAKING = 0.5
"""Share of the acceleration used for braking: it can do more."""

Motion = tuple[float, float]
"""Speed in m/s and turn rate in rad/s."""


class Driver:
    """Drives one task. ``points`` are the way, (x, y) in metres; ``theta`` is the final heading."""

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
        """Return the distance of ``pose`` from the rest of its path, metres; 0 without a path."""
        if len(self._points) < 2:
            return 0.0
        station, off = self._line.feet(*pose[:2])
        ahead = (station >= self._driven) & (station <= self._driven + WINDOW)
        return float(off[ahead].min(initial=math.inf))

    def steer(self, pose: Pose) -> Motion | None:
        """Return the motion to request at ``pose``, or None when the task is done."""
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

        A robot with speed v at station s can still brake with a for each of them, if v² + 2as is not above
        it.
        """
        bends = self._line.turns(CORNER) / (2 * CORNER)
        fastest = TURNING * self._limits.turn_rate / np.maximum(bends, 1e-9)
        speeds = np.minimum(np.maximum(fastest, LEAST_SPEED), self._limits.speed)
        stations = np.array(self._line.stations)
        squares = speeds**2 + self._braking * stations
        return stations, speeds, np.minimum.accumulate(squares[::-1])[::-1]

    def _before_corners(self) -> float:
        """Return the highest speed from which the robot can still slow down for each corner ahead."""
        # A corner just behind is still being rounded, but no longer braked for.
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


# --- Scripted objects: things at known places that the simulated robot sees when near ---

SIGHT = 10.0
"""metres within which the robot sees a thing."""


@dataclass(frozen=True)
class ScriptedObject:
    """Something at (x, y), metres in the site frame, that the robot knows as ``id``."""

    x: float
    y: float
    id: str


class ScriptedObjects:
    """Observes each thing once, as an object and, if there is an ``image``, as an image of it."""

    def __init__(self, things: Sequence[ScriptedObject], image: bytes | None) -> None:
        self._unseen = list(things)
        self._image = image
        self._count = 0

    def observe(self, pose: Pose) -> list[Observed]:
        """Return the things newly seen from ``pose``."""
        observed: list[Observed] = []
        for thing in [thing for thing in self._unseen if _sees(pose, thing)]:
            self._unseen.remove(thing)
            observed.append(SetObject(thing.x, thing.y, thing.id, source=self._source()))
            if self._image is not None:
                x, y, _ = pose
                image = SendImage(self._image, round(x, 3), round(y, 3), thing.id, source=self._source())
                observed.append(image)
        return observed

    def _source(self) -> str:
        self._count += 1
        return str(self._count)


def _sees(pose: Pose, thing: ScriptedObject) -> bool:
    return math.hypot(thing.x - pose[0], thing.y - pose[1]) <= SIGHT


# --- Distance of a place from the edge of a robot's map beyond which the site continues ---

SAME_EDGE = 0.02
"""metres: tolerance for rounding between a map's border and the site's."""


def before_border(robot_map: RobotMap, x: float, y: float) -> float:
    """Return the distance of (x, y) inside the border of a map, metres; negative outside.

    Edges at which the site ends, too, do not count; infinite for a map of the whole site.
    """
    if PART_OF not in robot_map.meta:
        return math.inf
    border, whole = robot_map.border, _whole(robot_map)
    apart = (x - border.x_min, y - border.y_min, border.x_max - x, border.y_max - y)
    inner = (
        border.x_min - whole[0],
        border.y_min - whole[1],
        whole[2] - border.x_max,
        whole[3] - border.y_max,
    )
    return min((far for far, room in zip(apart, inner, strict=True) if room > SAME_EDGE), default=math.inf)


def _whole(robot_map: RobotMap) -> tuple[float, float, float, float]:
    """Return the bounds of the site; an unreadable line means unbounded."""
    try:
        x_min, y_min, x_max, y_max = (float(part) for part in robot_map.meta[PART_OF].split(","))
    except ValueError:
        return -math.inf, -math.inf, math.inf, math.inf
    return x_min, y_min, x_max, y_max
