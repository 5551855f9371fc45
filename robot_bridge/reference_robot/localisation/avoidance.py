"""Avoidance of obstacles and of people, and the people that a simulation moves."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .sensors import Motion, TruePose

NEAR = 4.0
"""metres: things farther away are not in the way yet."""
TOGETHER = 0.3
"""metres between the ends of neighbouring beams on one thing; a single beam is noise."""
STEADY = 0.5
"""metres within which a thing must have been seen one scan before."""
GAP = 0.3
"""metres that the robot keeps from obstacles ahead."""
WAITS = 3.0
"""seconds that it waits for an obstacle, people above all, before it drives round it."""
SIDEWAYS = tuple(math.radians(degrees) for degrees in (15, -15, 30, -30, 45, -45, 60, -60, 80, -80))
"""Directions relative to its own in which it searches for a free way."""
ROUND = 1.2
"""metres that must be free in such a direction, and that it then drives."""
ROUND_SPEED = 0.4
"""m/s while it drives round something."""
PASSED = 3.0
"""metres driven after which an obstacle counts as passed."""
AIMS = 2.5
"""1/s: turn rate per angle to the direction of steering."""


@dataclass(frozen=True)
class ObstacleShape:
    """A round body of ``radius`` metres that brakes with ``braking`` m/s²."""

    radius: float = 0.35
    braking: float = 0.75


class Avoidance:
    """Changes a wanted motion so that the robot hits nothing that its laser sees.

    ``blocked_for`` is the seconds for which something has blocked it, including its tries to drive round it;
    ``waits`` says whether it stands because of it now.
    """

    def __init__(self, bearings: NDArray[Any], shape: ObstacleShape) -> None:
        self._bearings = bearings
        self._shape = shape
        self._points = self._earlier = np.empty((0, 2))
        self._things = np.empty((0, 2))
        self._heading: float | None = None
        """radians to turn until it faces its way round something, None otherwise."""
        self._left = 0.0
        self.blocked_for = 0.0
        self.waits = False
        self._waited = 0.0
        self._clear = 0.0
        """metres driven since something was last in the way."""

    def observe(self, ranges: NDArray[Any], motion: Motion) -> None:
        """Process a scan, (B,) metres, and the robot's motion since the one before."""
        self._earlier = _seen_after(self._points, motion)
        self._points = _points(ranges, self._bearings)
        if len(self._points) and len(self._earlier):
            apart = np.hypot(*(self._points[:, None] - self._earlier[None]).transpose(2, 0, 1))
            self._things = self._points[apart.min(axis=1) < STEADY]
        else:
            self._things = self._points[:0]

    def move(self, motion: Motion) -> None:
        """Apply the robot's motion since the newest scan, so that things keep their places."""
        self._things = _seen_after(self._things, motion)
        self._points = _seen_after(self._points, motion)
        self._clear += abs(motion.distance)
        if self._heading is not None:
            self._heading -= motion.turn
            self._left -= abs(motion.distance)

    def adjusted(self, v: float, turn_rate: float, dt: float) -> tuple[float, float]:
        """Return the motion, m/s and rad/s, for the wanted one in the next ``dt`` seconds."""
        if v == 0 and turn_rate == 0:
            # A request to stand is obeyed even while driving round something.
            self._heading, self.blocked_for, self._waited, self.waits = None, 0.0, 0.0, False
            return 0.0, 0.0
        self.waits = False
        self.blocked_for = self.blocked_for + dt if self.blocked_for and self._clear < PASSED else 0.0
        if v <= 0 and self._heading is None:
            # A round body cannot hit anything by turning on the spot.
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
            self._find_way_round(turn_rate / AIMS)
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

    def _find_way_round(self, angle_wanted: float) -> None:
        free = [side for side in SIDEWAYS if self.free_ahead(side) > ROUND + self._shape.radius]
        if free:
            self._heading = min(free, key=lambda side: abs(side - angle_wanted))
            self._left = ROUND

    def _fastest(self, bearing: float) -> float:
        """Return the speed from which the robot can still stop before the obstacle ahead."""
        room = self.free_ahead(bearing) - GAP
        return math.sqrt(2 * self._shape.braking * room) if room > 0 else 0.0

    def free_ahead(self, bearing: float) -> float:
        """Return the metres that the body can move in a direction before touching something, or infinite."""
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
    """Return the ends of beams that a neighbouring beam confirms, (n, 2) metres, x ahead."""
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


PERSON = 0.25
"""metres: the radius of one."""
WALKING = 1.2
"""m/s on average."""
NEAREST = 0.2
"""metres before a robot at which a person stops."""

Discs = NDArray[Any]
"""(n, 3): x, y and radius in metres."""


class People:
    """People who walk to and fro between points of a line, and stop before a robot in their way."""

    def __init__(self, count: int, line: NDArray[Any], aside: float, rng: np.random.Generator) -> None:
        """``line`` is (m, 2) metres; people keep within ``aside`` metres of it."""
        self._line, self._aside, self._rng = line, aside, rng
        lengths = np.hypot(*np.diff(line, axis=0).T)
        self._stations = np.concatenate([[0.0], np.cumsum(lengths)])
        self.places = np.array([self._anywhere() for _ in range(count)]).reshape(-1, 2)
        """(n, 2) metres."""
        self._goals = np.array([self._near(place) for place in self.places]).reshape(-1, 2)
        self._speeds = rng.uniform(0.7, 1.3, count) * WALKING

    def step(self, dt: float, robots: Discs) -> None:
        """Let ``dt`` seconds pass; nobody walks into one of ``robots``."""
        for one, goal in enumerate(self._goals):
            way = goal - self.places[one]
            far = math.hypot(*way)
            if far < 0.2:
                self._goals[one] = self._near(self.places[one])
                continue
            place = self.places[one] + way / far * min(far, self._speeds[one] * dt)
            gap = _gap(place, robots)
            # A person whom a robot has come too near to walks away from it.
            if gap < NEAREST and gap <= _gap(self.places[one], robots):
                if self._rng.random() < 0.05:
                    self._goals[one] = self._near(self.places[one])
                continue
            self.places[one] = place

    @property
    def discs(self) -> Discs:
        """Everybody."""
        return np.column_stack([self.places, np.full(len(self.places), PERSON)])

    def _anywhere(self) -> NDArray[Any]:
        return self._at(self._rng.uniform(0, self._stations[-1]))

    def _near(self, place: NDArray[Any]) -> NDArray[Any]:
        """Return a goal on the piece of the line beside a place, so that nothing is in between."""
        begin, end = self._line[:-1], self._line[1:]
        along = end - begin
        part = np.clip(
            ((place - begin) * along).sum(axis=1) / np.maximum((along * along).sum(axis=1), 1e-9), 0, 1
        )
        off = np.hypot(*(begin + part[:, None] * along - place).T)
        piece = int(self._rng.choice(np.flatnonzero(off <= off.min() + self._aside)))
        return self._at(self._rng.uniform(self._stations[piece], self._stations[piece + 1]))

    def _at(self, station: float) -> NDArray[Any]:
        x = np.interp(station, self._stations, self._line[:, 0])
        y = np.interp(station, self._stations, self._line[:, 1])
        place: NDArray[Any] = np.array([x, y]) + self._rng.uniform(-self._aside, self._aside, 2)
        return place


def _gap(place: NDArray[Any], robots: Discs) -> float:
    """Return the metres between a person and the nearest robot, infinite without any."""
    apart = np.hypot(*(robots[:, :2] - place).T) - robots[:, 2] - PERSON
    return float(apart.min(initial=math.inf))


class MovingObstacles:
    """Moving obstacles, shared by all robots of one world: ``others`` are queried for each scan."""

    def __init__(self) -> None:
        self._sources: list[tuple[object, Callable[[], Discs]]] = []

    def add(self, owner: object, discs: Callable[[], Discs]) -> None:
        """Make the result of ``discs`` visible to all but ``owner``."""
        self._sources.append((owner, discs))

    def around(self, owner: object) -> Discs:
        """Return all that ``owner`` can see, except itself."""
        found = [discs() for whose, discs in self._sources if whose is not owner]
        return np.concatenate([np.empty((0, 3)), *found])


def ranges_to(discs: Discs, pose: TruePose, bearings: NDArray[Any]) -> NDArray[Any]:
    """Return the distance of each beam to a cylinder, (B,) metres, infinite without a hit."""
    if not len(discs):
        return np.full(len(bearings), np.inf)
    angle = pose[2] + bearings[:, None]
    x, y = discs[:, 0] - pose[0], discs[:, 1] - pose[1]
    along = x * np.cos(angle) + y * np.sin(angle)
    square = x * x + y * y - along * along
    room = discs[:, 2] ** 2 - square
    way = np.where((room >= 0) & (along > 0), along - np.sqrt(np.maximum(room, 0.0)), np.inf)
    nearest: NDArray[Any] = np.maximum(way.min(axis=1), 0.0)
    return nearest
