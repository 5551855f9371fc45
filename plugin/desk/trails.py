"""Where each robot came from, for the last minute or so."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import numpy.typing as npt

from ..wire.mailbox import Sighting

Points = npt.NDArray[np.float64]

LONGEST = 90.0
MOST_POINTS = 400
SHORTEST_STEP = 0.05
MANY = 25
SHORTENED = 15.0
"""With more than ``MANY`` moving robots trails would hide the map and fill the processor: shorter ones."""


class Trails:
    """The last positions of every robot in the site frame, with the time when they arrived."""

    def __init__(self, seconds: float = LONGEST):
        self._seconds = seconds
        self._trails: dict[str, _Trail] = {}

    def extend(self, sightings: Mapping[str, Sighting]) -> None:
        """Take in newer positions; a robot that stands adds none."""
        for name, sighting in sightings.items():
            report = sighting.report
            if report.x is not None and report.y is not None:
                self._trails.setdefault(name, _Trail()).add(report.x, report.y, sighting.received)

    def clear(self) -> None:
        """Forget every trail."""
        self._trails.clear()

    def arrays(self, now: float) -> list[Points]:
        """Return an (n, 3) array for each robot that moved: x, y in metres, age in s; oldest first."""
        seconds = self._seconds if len(self._trails) <= MANY else min(self._seconds, SHORTENED)
        trails = (trail.since(now - seconds) for trail in self._trails.values())
        return [np.column_stack([trail[:, :2], now - trail[:, 2]]) for trail in trails if len(trail) > 1]


class _Trail:
    """One robot's x, y and time of arrival, in a table that is moved up only when it is full."""

    def __init__(self) -> None:
        self._table: Points = np.empty((2 * MOST_POINTS, 3))
        self._end = 0

    def add(self, x: float, y: float, received: float) -> None:
        table, end = self._table, self._end
        if end and abs(table[end - 1, 0] - x) + abs(table[end - 1, 1] - y) < SHORTEST_STEP:
            return
        if end == len(table):
            table[:MOST_POINTS] = table[MOST_POINTS:]
            end = MOST_POINTS
        table[end] = (x, y, received)
        self._end = end + 1

    def since(self, time: float) -> Points:
        """Return the rows that arrived at ``time`` or later, at most the newest ``MOST_POINTS``."""
        table = self._table[max(0, self._end - MOST_POINTS) : self._end]
        return table[np.searchsorted(table[:, 2], time) :]
