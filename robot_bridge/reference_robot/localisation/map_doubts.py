"""Doubtful objects of the map: things that the laser repeatedly does not see and that may be gone."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...core.robotmap.model import RobotMap
from .map_gaps import AGAIN, OFF_MAP
from .ray_casting import RayCaster
from .segments import distances
from .sensors import TruePose
from .settings import LaserSettings
from .world import Walls, standing_obstacles, walls_of

NEAR = 8.0
"""metres: beyond it beams are too far apart to prove that something is absent."""
BEAMS = 2
"""least beams through a thing in one scan: a single one may just miss it."""
OFTEN = 10
"""scans through a thing, a quarter of a metre of driving apart, until it is in doubt."""
SEEN = 0.25
"""Share of the informative scans that may see the thing: people stand there, too."""
SMALL = 3.0
"""metres: of larger things, beams must have passed half of the width: a gap is not the whole wall."""
MOST = 1000
"""Things that are suspected at a time."""


@dataclass(frozen=True)
class Doubt:
    """A thing of the map, ``source`` and ``semantics`` as the map has them: around (x, y), metres."""

    source: str
    semantics: str
    x: float
    y: float
    radius: float


@dataclass(eq=False)
class _Suspect:
    """The number of scans through a thing and of those that saw it, and the box where beams passed."""

    low: NDArray[Any]
    high: NDArray[Any]
    passed: int = 0
    seen: int = 0


class MapDoubts:
    """Gathers things of ``robot_map`` through which the laser of a robot that knows its place sees."""

    def __init__(self, robot_map: RobotMap, laser: LaserSettings, bearings: NDArray[Any]) -> None:
        self._laser, self._bearings = laser, bearings
        self._suspects: dict[str, _Suspect] = {}
        self._reported: set[str] = set()
        self._from: tuple[float, float] | None = None
        self.use_map(robot_map)

    def use_map(self, robot_map: RobotMap) -> None:
        """Switch to another map of the same frame; things are identified by their source."""
        self._walls: Walls = walls_of(robot_map).higher_than(self._laser.height)
        self._caster = RayCaster(self._walls.a, self._walls.b, self._laser.reach, compiled=False)
        standing = standing_obstacles(robot_map)
        self._names = [(one.ext.get("src", ""), one.semantics) for one in standing]

    def observe(self, pose: TruePose, ranges: NDArray[Any]) -> list[Doubt]:
        """Process a scan, (B,) metres, from the robot's pose; return new doubts."""
        if self._from is not None and math.dist(self._from, pose[:2]) < AGAIN:
            return []
        self._from = pose[:2]
        angle = pose[2] + self._bearings
        ways = np.column_stack([np.cos(angle), np.sin(angle)])
        expected = self._caster.cast(np.array([pose]), self._bearings)[0]
        passes = self._passes(pose, ways, ranges, expected)
        known = np.isfinite(ranges)
        ends = np.array(pose[:2]) + ranges[known, None] * ways[known]
        for source in {*passes, *self._suspects} - self._reported:
            self._judge(source, passes.get(source), ends)
        return [doubt for source in passes if (doubt := self._doubt(source)) is not None]

    def _passes(
        self, pose: TruePose, ways: NDArray[Any], ranges: NDArray[Any], expected: NDArray[Any]
    ) -> dict[str, NDArray[Any]]:
        """Return where beams pass through things, (n, 2) metres, by their sources."""
        # A beam without an echo counts to the laser's reach; one without a reading is ignored.
        through = (expected < NEAR) & (ranges > expected + OFF_MAP)
        found: dict[str, list[NDArray[Any]]] = {}
        for hit in np.array(pose[:2]) + expected[through, None] * ways[through]:
            nearest = int(distances(hit, self._walls.a, self._walls.b).argmin())
            found.setdefault(self._names[self._walls.obstacle[nearest]][0], []).append(hit)
        return {
            source: np.array(hits)
            for source, hits in found.items()
            if source and len(hits) >= BEAMS and (source in self._suspects or len(self._suspects) < MOST)
        }

    def _judge(self, source: str, hits: NDArray[Any] | None, ends: NDArray[Any]) -> None:
        """Count whether a scan sees a thing, else whether it passes through."""
        rows = self._rows_of(source)
        if not len(rows):
            return
        near = sum(distances(end, self._walls.a[rows], self._walls.b[rows]).min() < OFF_MAP for end in ends)
        # Some beams miss a thing slightly off its place; where it is gone people shorten some.
        if hits is None or 2 * near >= len(hits):
            if near and source in self._suspects:
                self._suspects[source].seen += 1
            return
        suspect = self._suspects.setdefault(source, _Suspect(hits.min(axis=0), hits.max(axis=0)))
        suspect.low = np.minimum(suspect.low, hits.min(axis=0))
        suspect.high = np.maximum(suspect.high, hits.max(axis=0))
        suspect.passed += 1

    def _doubt(self, source: str) -> Doubt | None:
        suspect = self._suspects.get(source)
        if suspect is None or source in self._reported or suspect.passed < OFTEN:
            return None
        if suspect.seen > SEEN * (suspect.seen + suspect.passed):
            return None
        rows = self._rows_of(source)
        ends = np.concatenate([self._walls.a[rows], self._walls.b[rows]])
        low, high = ends.min(axis=0), ends.max(axis=0)
        wide = math.dist(low, high)
        if wide > SMALL and math.dist(suspect.low, suspect.high) < wide / 2:
            return None
        self._reported.add(source)
        del self._suspects[source]
        x, y = (low + high) / 2
        semantics = self._names[self._walls.obstacle[rows[0]]][1]
        return Doubt(source, semantics, round(float(x), 2), round(float(y), 2), round(max(wide / 2, 0.05), 2))

    def _rows_of(self, source: str) -> NDArray[Any]:
        """Return the segments of a thing; none if the present map does not have it."""
        obstacles = [number for number, (own, _) in enumerate(self._names) if own == source]
        return np.flatnonzero(np.isin(self._walls.obstacle, obstacles))
