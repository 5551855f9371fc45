"""Where each robot came from: samples of its way, all robots in one table."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

Points = npt.NDArray[np.float64]

SHORTEST_STEP = 0.05
"""Metres: a robot that stands adds nothing."""
SHORTEST_WAIT = 0.4
"""Seconds between samples."""


@dataclass(frozen=True)
class TrailLength:
    """How long trails are with so many robots: many long ones would hide the map."""

    robots: float
    seconds: float
    wide: bool

    @property
    def samples(self) -> int:
        """How many samples that takes."""
        return int(self.seconds / SHORTEST_WAIT) + 2


LENGTHS = (
    TrailLength(25, 90.0, True),
    TrailLength(300, 30.0, True),
    TrailLength(np.inf, 15.0, False),
)


class Trails:
    """The last places of every robot in the site frame, with the time when each was seen.

    One row a robot, as in :class:`~.desk.picture.RobotArrays`; a ring of samples for each. Samples taken at
    the same time stand side by side, as robots that tell of themselves together are sampled together.
    """

    def __init__(self) -> None:
        self.length = LENGTHS[0]
        self.generation = 0
        """Counts how often something was forgotten, or trails got another length."""
        self._forget()

    def __len__(self) -> int:
        return len(self._taken)

    @property
    def taken(self) -> npt.NDArray[np.intp]:
        """How many samples were taken of each robot so far."""
        return self._taken.copy()

    def clear(self) -> None:
        """Forget every trail."""
        self.length = LENGTHS[0]
        self._forget()
        self.generation += 1

    def drop(self, rows: npt.NDArray[np.intp]) -> None:
        """Forget the trails of robots that are there no more; those below them move up."""
        rows = rows[rows < len(self)]
        self._ring = np.delete(self._ring, rows, axis=1)
        self._taken = np.delete(self._taken, rows)
        self._last, self._last_time = np.delete(self._last, rows, axis=0), np.delete(self._last_time, rows)
        self.generation += 1

    def extend(self, xy: Points, now: float) -> None:
        """Take in where the robots are: (n, 2) metres in the site frame, NaN where not known."""
        self._provide(len(xy))
        rows = self._due(xy, now)
        if len(rows) == 0:
            return
        samples = np.empty((len(rows), 3))
        # To take rows with [] instead takes numpy ten times as long.
        samples[:, :2], samples[:, 2] = xy.take(rows, axis=0), now
        self._last[rows], self._last_time[rows] = samples[:, :2], now
        self._ring[self._taken[rows] % len(self._ring), rows] = samples
        self._taken[rows] += 1

    def before(self, taken: npt.NDArray[np.intp]) -> Points:
        """Return of the first robots the last of so many samples, (n, 3): x, y, time; NaN where gone."""
        rows = np.arange(len(taken))
        sample = self._ring.reshape(-1, 3).take((taken - 1) % len(self._ring) * len(self) + rows, axis=0)
        sample[(taken < 1) | (taken <= self._taken[rows] - len(self._ring))] = np.nan
        return sample

    def of(self, row: int, now: float) -> Points:
        """Return the (m, 3) trail of one robot: x, y in metres, age in seconds; oldest first."""
        samples = np.roll(self._ring[:, row], -int(self._taken[row]), axis=0)
        samples = samples[now - samples[:, 2] <= self.length.seconds]
        return np.column_stack([samples[:, :2], now - samples[:, 2]])

    def _empty(self, robots: int) -> Points:
        return np.full((self.length.samples, robots, 3), np.nan)

    def _due(self, xy: Points, now: float) -> npt.NDArray[np.intp]:
        """Return the rows of the robots that have gone on long enough after their last samples."""
        # Of a robot without samples the last time is NaN, of which no comparison is true.
        rows = np.flatnonzero(self._last_time <= now - SHORTEST_WAIT)
        if len(rows):
            away = np.abs(xy.take(rows, axis=0) - self._last.take(rows, axis=0))
            rows = rows[away[:, 0] + away[:, 1] >= SHORTEST_STEP]
        first = np.flatnonzero(np.isnan(self._last_time))
        if len(first):
            rows = np.concatenate([rows, first[np.isfinite(xy[first]).all(axis=1)]])
        return rows

    def _forget(self) -> None:
        self._ring = self._empty(0)
        self._taken = np.zeros(0, dtype=np.intp)
        # Each one's newest sample again: to gather them out of the ring takes ten times as long.
        self._last, self._last_time = np.empty((0, 2)), np.empty(0)

    def _provide(self, robots: int) -> None:
        length = next(length for length in LENGTHS if robots <= length.robots)
        # They only grow shorter until all are forgotten: what was cut off does not come back.
        if length.samples < self.length.samples:
            self._cut(length)
        missing = robots - len(self)
        if missing > 0:
            self._ring = np.concatenate([self._ring, self._empty(missing)], axis=1)
            self._taken = np.concatenate([self._taken, np.zeros(missing, dtype=np.intp)])
            self._last = np.concatenate([self._last, np.full((missing, 2), np.nan)])
            self._last_time = np.concatenate([self._last_time, np.full(missing, np.nan)])

    def _cut(self, length: TrailLength) -> None:
        kept = [self.before(self._taken - back) for back in range(length.samples)]
        self.length = length
        self._ring = self._empty(len(self))
        rows = np.arange(len(self))
        for back, sample in enumerate(kept):
            self._ring[(self._taken - 1 - back) % length.samples, rows] = sample
        self.generation += 1
