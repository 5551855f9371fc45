"""What moves in a simulated world: people who walk about, and other robots. All are upright cylinders."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .sensors import Pose

PERSON = 0.25
"""metres: the radius of one."""
WALKING = 1.2
"""m/s on average."""

Discs = NDArray[Any]
"""(n, 3): x, y and radius in metres."""


class People:
    """Walk to and fro between points of a line, and stop before a robot that is in their way."""

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
            if len(robots):
                apart = np.hypot(*(robots[:, :2] - place).T) - robots[:, 2] - PERSON
                if apart.min() < 0.2:
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
        """Return a goal on the piece of the line that a place is beside: nothing is in between."""
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


class Surroundings:
    """What moves, shared by all robots of one world: ``others`` are asked anew for each scan."""

    def __init__(self) -> None:
        self._sources: list[tuple[object, Callable[[], Discs]]] = []

    def add(self, owner: object, discs: Callable[[], Discs]) -> None:
        """Let what ``discs`` returns be seen by all but ``owner``."""
        self._sources.append((owner, discs))

    def around(self, owner: object) -> Discs:
        """Return all that ``owner`` can see, and not itself."""
        found = [discs() for whose, discs in self._sources if whose is not owner]
        return np.concatenate([np.empty((0, 3)), *found])


def ranges_to(discs: Discs, pose: Pose, bearings: NDArray[Any]) -> NDArray[Any]:
    """Return how far each beam goes until it meets a cylinder, (B,) metres, infinite where it meets none."""
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
