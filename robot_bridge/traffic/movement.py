"""A robot's way in space and time."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Movement:
    """``robot`` is at ``points[k]``, (n, 2) metres in the site frame, at ``times[k]``, (n,) seconds.

    Before the first time it stands at the first point, after the last time at the last. Between two it drives
    at one speed. ``times`` do not fall. ``radius`` is metres: of a circle that the robot is within.
    """

    robot: str
    points: Floats
    times: Floats
    radius: float

    @cached_property
    def stands(self) -> bool:
        """Whether it goes nowhere."""
        return not bool((np.abs(self.points - self.points[0]) > 1e-9).any())

    @property
    def ends(self) -> float:
        """When it has come to its end."""
        return float(self.times[-1])

    def at(self, times: Any) -> Floats:
        """Return where it is at ``times``, (m,) seconds, as (m, 2)."""
        return np.column_stack([np.interp(times, self.times, self.points[:, k]) for k in (0, 1)])

    def times_around(self, begins: float, ends: float) -> Floats:
        """Return its times in a span, with the last before it and the first after it where there are any."""
        first = np.searchsorted(self.times, begins, side="right") - 1
        last = np.searchsorted(self.times, ends, side="left") + 1
        return self.times[max(first, 0) : last]

    def station_at(self, time: float) -> float:
        """Return the metres that it has driven at ``time``."""
        return float(np.interp(time, self.times, self._stations))

    def time_at(self, station: float) -> float:
        """Return when it comes to ``station`` metres along its way."""
        return float(np.interp(station, self._stations, self.times))

    @cached_property
    def _stations(self) -> Floats:
        return _stations(self.points)

    def waiting(self, station: float, seconds: float) -> Movement:
        """Return the movement that stands ``seconds`` at ``station`` metres along its way."""
        along = self._stations
        station = float(np.clip(station, 0.0, along[-1]))
        at = float(np.interp(station, along, self.times))
        place = np.array([[np.interp(station, along, self.points[:, k]) for k in (0, 1)]])
        before, after = along < station - 1e-9, along > station + 1e-9
        return replace(
            self,
            points=np.concatenate([self.points[before], place, place, self.points[after]]),
            times=np.concatenate(
                [self.times[before], [at, at + seconds], self.times[after] + seconds],
            ),
        )


def standing(robot: str, place: tuple[float, float], now: float, radius: float) -> Movement:
    """Return the movement of a robot that stands where it is."""
    return Movement(robot, np.array([place], dtype=np.float64), np.array([now]), radius)


def driving(robot: str, points: Any, speed: float, begins: float, radius: float) -> Movement:
    """Return the movement along ``points``, (n, 2), at ``speed`` m/s from the second ``begins`` on."""
    line = np.asarray(points, dtype=np.float64).reshape(-1, 2)
    return Movement(robot, line, begins + _stations(line) / speed, radius)


def _stations(points: Floats) -> Floats:
    return np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(points, axis=0).T))])
