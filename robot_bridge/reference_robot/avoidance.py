"""What the laser sees in the robot's way: it brakes for it, waits, and goes round it."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .sensors import Motion

NEAR = 4.0
"""metres: what is farther away is not in the way yet."""
TOGETHER = 0.3
"""metres between the ends of neighbouring beams that see one thing; a beam alone sees noise."""
STEADY = 0.5
"""metres within which a thing must have been seen one scan before."""
GAP = 0.3
"""metres that the robot keeps from what is ahead of it."""
WAITS = 3.0
"""seconds that it waits for what stands in its way, people above all, before it goes round it."""
SIDEWAYS = tuple(math.radians(degrees) for degrees in (15, -15, 30, -30, 45, -45, 60, -60, 80, -80))
"""Directions beside its own in which it looks for a free way."""
ROUND = 1.2
"""metres that must be free in such a direction, and that it drives then."""
ROUND_SPEED = 0.4
"""m/s while it goes round something."""
PASSED = 3.0
"""metres driven on after which what was in the way is passed."""
AIMS = 2.5
"""1/s: turn rate for an angle to where it steers."""


@dataclass(frozen=True)
class Shape:
    """A round body of ``radius`` metres that brakes with ``braking`` m/s²."""

    radius: float = 0.35
    braking: float = 0.75


class Avoidance:
    """Changes a wanted motion so that the robot hits nothing that its laser sees.

    ``blocked_for`` is for how many seconds something has kept it from driving on, its tries to go round it
    included; ``waits`` tells whether it stands because of it now.
    """

    def __init__(self, bearings: NDArray[Any], shape: Shape) -> None:
        self._bearings = bearings
        self._shape = shape
        self._points = self._earlier = np.empty((0, 2))
        self._things = np.empty((0, 2))
        self._heading: float | None = None
        """radians to turn until it looks where it goes round something, None while it does not."""
        self._left = 0.0
        self.blocked_for = 0.0
        self.waits = False
        self._waited = 0.0
        self._clear = 0.0
        """metres driven since something was in the way last."""

    def observe(self, ranges: NDArray[Any], motion: Motion) -> None:
        """Take in a scan, (B,) metres, and what the robot moved since the one before."""
        self._earlier = _seen_after(self._points, motion)
        self._points = _points(ranges, self._bearings)
        if len(self._points) and len(self._earlier):
            apart = np.hypot(*(self._points[:, None] - self._earlier[None]).transpose(2, 0, 1))
            self._things = self._points[apart.min(axis=1) < STEADY]
        else:
            self._things = self._points[:0]

    def move(self, motion: Motion) -> None:
        """Take in what the robot moved since the newest scan, so that things stay where they are."""
        self._things = _seen_after(self._things, motion)
        self._points = _seen_after(self._points, motion)
        self._clear += abs(motion.distance)
        if self._heading is not None:
            self._heading -= motion.turn
            self._left -= abs(motion.distance)

    def adjusted(self, v: float, turn_rate: float, dt: float) -> tuple[float, float]:
        """Return the motion, m/s and rad/s, for the wanted one in the next ``dt`` seconds."""
        if v == 0 and turn_rate == 0:
            # Who asks it to stand is obeyed whatever it is going round.
            self._heading, self.blocked_for, self._waited, self.waits = None, 0.0, 0.0, False
            return 0.0, 0.0
        self.waits = False
        self.blocked_for = self.blocked_for + dt if self.blocked_for and self._clear < PASSED else 0.0
        if v <= 0 and self._heading is None:
            # A round body hits nothing by turning on the spot.
            return v, turn_rate
        if self._heading is not None and self._left > 0:
            return self._round()
        self._heading = None
        fastest = self._fastest(0.0)
        if fastest >= min(v, 0.1):
            self._waited = 0.0
            return min(v, fastest), turn_rate
        self.waits, self._clear = True, 0.0
        self.blocked_for = max(self.blocked_for, dt)
        self._waited += dt
        if self._waited >= WAITS:
            self._look_round(turn_rate / AIMS)
        return 0.0, 0.0

    def _round(self) -> tuple[float, float]:
        assert self._heading is not None
        if abs(self._heading) > math.radians(10):
            return 0.0, AIMS * self._heading
        fastest = self._fastest(0.0)
        if fastest < 0.1:
            self._heading, self._waited, self._clear = None, 0.0, 0.0
            return 0.0, 0.0
        return min(ROUND_SPEED, fastest), AIMS * self._heading

    def _look_round(self, wanted: float) -> None:
        free = [side for side in SIDEWAYS if self.free_ahead(side) > ROUND + self._shape.radius]
        if free:
            self._heading = min(free, key=lambda side: abs(side - wanted))
            self._left = ROUND

    def _fastest(self, bearing: float) -> float:
        """Return the speed from which the robot can still stop before what is ahead of it."""
        room = self.free_ahead(bearing) - GAP
        return math.sqrt(2 * self._shape.braking * room) if room > 0 else 0.0

    def free_ahead(self, bearing: float) -> float:
        """Return how far the body can go in a direction until it touches something, metres, or infinite."""
        cos, sin = math.cos(bearing), math.sin(bearing)
        along = self._things @ (cos, sin)
        beside = self._things @ (-sin, cos)
        radius = self._shape.radius
        near = (along > 0) & (np.abs(beside) < radius)
        if not near.any():
            return math.inf
        reached = along[near] - np.sqrt(radius**2 - np.square(beside[near]))
        return max(0.0, float(reached.min()))


def _points(ranges: NDArray[Any], bearings: NDArray[Any]) -> NDArray[Any]:
    """Return where beams end that a neighbouring beam confirms, (n, 2) metres, x ahead."""
    ends = np.column_stack([ranges * np.cos(bearings), ranges * np.sin(bearings)])
    with np.errstate(invalid="ignore"):
        near = ranges < NEAR
        beside = np.hypot(*np.diff(ends, axis=0).T) < TOGETHER
    confirmed = np.zeros(len(ranges), dtype=bool)
    confirmed[1:] |= beside & near[:-1]
    confirmed[:-1] |= beside & near[1:]
    found: NDArray[Any] = ends[near & confirmed]
    return found


def _seen_after(points: NDArray[Any], motion: Motion) -> NDArray[Any]:
    """Return ``points``, (n, 2), as seen after a motion."""
    if not len(points):
        return points
    middle = motion.turn / 2
    moved = points - (motion.distance * math.cos(middle), motion.distance * math.sin(middle))
    cos, sin = math.cos(-motion.turn), math.sin(-motion.turn)
    seen: NDArray[Any] = moved @ np.array([[cos, sin], [-sin, cos]])
    return seen
