"""Objects missing on the map: things that the laser sees repeatedly where the map has nothing."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...core.images import encode_png
from ...core.robotmap.model import RobotMap
from .ray_casting import RayCaster
from .segments import distances
from .sensors import TruePose
from .settings import LaserSettings
from .world import walls_of

OFF_MAP = 0.6
"""metres from everything on the map: smaller differences may be errors of the map."""
NEAR = 10.0
"""metres: beyond it neighbouring beams are too far apart to detect a thing."""
TOGETHER = 0.3
"""metres between the ends of neighbouring beams on one thing, in addition to their angular spacing."""
ONE_THING = 1.0
"""metres within which ends belong to one thing."""
AGAIN = 0.25
"""metres that the robot drives between two scans that count: while standing a thing counts once."""
OFTEN = 10
"""scans that must see a thing."""
PASSES = 0.3
"""Share of the scans that may see through it: people walk on, things do not."""
WANDERED = 0.5
"""metres that a thing may seem to move while being passed, as its other side comes into view."""
LARGEST = 1.5
"""metres: the radius of the largest thing that is reported; larger ones are walls for a surveyor."""
PIXELS, PIXEL = 64, 0.05
"""pixels of the image of a thing, and the side of one in metres."""


@dataclass(frozen=True)
class FoundObject:
    """A thing at (x, y) of ``radius``, metres, and a PNG ``image`` of its outline from above."""

    x: float
    y: float
    radius: float
    image: bytes


@dataclass(eq=False)
class _Thing:
    """Something not on the map: the ends of beams, the number of scans that saw it, and saw through it."""

    middle: NDArray[Any]
    ends: list[NDArray[Any]] = field(default_factory=list)
    seen: int = 0
    passed: int = 0
    reported: bool = False


class MapGaps:
    """Gathers things that are not on ``robot_map``, seen by a robot that knows its place."""

    def __init__(self, robot_map: RobotMap, laser: LaserSettings, bearings: NDArray[Any]) -> None:
        self._laser, self._bearings = laser, bearings
        self._things: list[_Thing] = []
        self._from: tuple[float, float] | None = None
        self.use_map(robot_map)

    def use_map(self, robot_map: RobotMap) -> None:
        """Switch to another map of the same frame."""
        self._walls = walls_of(robot_map).higher_than(self._laser.height)
        self._caster = RayCaster(self._walls.a, self._walls.b, self._laser.reach, compiled=False)

    def observe(self, pose: TruePose, ranges: NDArray[Any]) -> list[FoundObject]:
        """Process a scan, (B,) metres, from the robot's pose; return newly confirmed things."""
        if self._from is not None and math.dist(self._from, pose[:2]) < AGAIN:
            return []
        self._from = pose[:2]
        ends = self._off_map(pose, ranges)
        for thing in self._things:
            self._judge(thing, pose, ranges, ends)
        for end in ends:
            if all(np.hypot(*(thing.middle - end)) > ONE_THING for thing in self._things):
                self._things.append(_Thing(end, [end], 1))
        self._things = [thing for thing in self._things if thing.reported or not self._is_gone(thing)]
        return [found for thing in self._things if (found := self._found(thing, pose)) is not None]

    def _off_map(self, pose: TruePose, ranges: NDArray[Any]) -> NDArray[Any]:
        """Return the ends of beams away from everything on the map, (n, 2) metres."""
        expected = self._caster.cast(np.array([pose]), self._bearings)[0]
        angle = pose[2] + self._bearings
        ends = np.array(pose[:2]) + ranges[:, None] * np.column_stack([np.cos(angle), np.sin(angle)])
        with np.errstate(invalid="ignore"):
            short = (ranges < NEAR) & (ranges < expected - OFF_MAP)
            apart = np.hypot(*np.diff(ends, axis=0).T)
            wide = TOGETHER + np.abs(np.diff(self._bearings)) * np.minimum(ranges[1:], ranges[:-1])
        pair = short[1:] & short[:-1] & (apart < wide)
        confirmed = np.zeros(len(ranges), dtype=bool)
        confirmed[1:] |= pair
        confirmed[:-1] |= pair
        kept = [
            end
            for end in ends[confirmed]
            if distances(end, self._walls.a, self._walls.b).min(initial=np.inf) > OFF_MAP
        ]
        return np.array(kept).reshape(-1, 2)

    def _judge(self, thing: _Thing, pose: TruePose, ranges: NDArray[Any], ends: NDArray[Any]) -> None:
        """Count whether a scan sees a thing, or sees through its place."""
        near = ends[np.hypot(*(ends - thing.middle).T) < ONE_THING]
        if len(near):
            thing.seen += 1
            thing.ends += list(near)
            thing.middle = np.mean(thing.ends, axis=0)
            return
        off = thing.middle - pose[:2]
        away = math.hypot(*off)
        turned = np.abs((np.arctan2(off[1], off[0]) - pose[2] - self._bearings + np.pi) % (2 * np.pi) - np.pi)
        beam = int(turned.argmin())
        if away < NEAR and turned[beam] < math.radians(3) and ranges[beam] > away + ONE_THING:
            thing.passed += 1

    @staticmethod
    def _is_gone(thing: _Thing) -> bool:
        return thing.passed > 2 and thing.passed > PASSES * (thing.seen + thing.passed)

    def _found(self, thing: _Thing, pose: TruePose) -> FoundObject | None:
        """Return a thing once, when it was seen often and lies behind the robot or beside it."""
        off = thing.middle - pose[:2]
        ahead = off[0] * math.cos(pose[2]) + off[1] * math.sin(pose[2])
        if thing.reported or thing.seen < OFTEN or ahead > 0 or self._is_gone(thing):
            return None
        if _wandered(thing.ends) > WANDERED:
            return None
        thing.reported = True
        x, y, radius = _circle(np.array(thing.ends))
        if radius > LARGEST:
            return None
        return FoundObject(round(x, 2), round(y, 2), round(radius, 2), _image(np.array(thing.ends), (x, y)))


def _wandered(ends: Sequence[NDArray[Any]]) -> float:
    """Return the distance between the last third of ``ends`` and the first third, metres."""
    third = max(1, len(ends) // 3)
    first, last = np.mean(ends[:third], axis=0), np.mean(ends[-third:], axis=0)
    return math.dist(first, last)


def _circle(ends: NDArray[Any]) -> tuple[float, float, float]:
    """Return centre and radius, metres, of the circle that best goes through ``ends``, (n, 2).

    If they do not fit a circle of their own width, their middle is used.
    """
    middle = np.median(ends, axis=0)
    away = np.hypot(*(ends - middle).T)
    ends = ends[away <= np.percentile(away, 90)]
    middle = ends.mean(axis=0)
    wide = float(np.hypot(*(ends - middle).T).max())
    x, y = (ends - middle).T
    (a, b, c), *_ = np.linalg.lstsq(
        np.column_stack([2 * x, 2 * y, np.ones(len(x))]), x * x + y * y, rcond=None
    )
    radius = math.sqrt(max(c + a * a + b * b, 0.0))
    if math.hypot(a, b) < 1.5 * wide and radius < 2 * wide:
        return float(middle[0] + a), float(middle[1] + b), max(radius, 0.05)
    return float(middle[0]), float(middle[1]), max(wide, 0.05)


def _image(ends: NDArray[Any], middle: tuple[float, float]) -> bytes:
    """Return a PNG of ``ends``, (n, 2), from above, black on white, north up."""
    picture = np.full((PIXELS, PIXELS), 255, dtype=np.uint8)
    column, row = np.round((ends - middle) / PIXEL).astype(np.int64).T + PIXELS // 2
    inside = (column >= 0) & (column < PIXELS) & (row >= 0) & (row < PIXELS)
    picture[PIXELS - 1 - row[inside], column[inside]] = 0
    return encode_png(picture)
