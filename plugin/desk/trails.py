"""Where each robot came from, for the last minute or so."""

from __future__ import annotations

from collections import deque
from collections.abc import Mapping

import numpy as np
import numpy.typing as npt

from .wire.mailbox import Sighting

LONGEST = 90.0
MOST_POINTS = 300
SHORTEST_STEP = 0.05


class Trails:
    """The last positions of every robot in the site frame, with the time when they arrived."""

    def __init__(self, seconds: float = LONGEST):
        self.seconds = seconds
        self._points: dict[str, deque[tuple[float, float, float]]] = {}

    def extend(self, sightings: Mapping[str, Sighting]) -> None:
        """Take in newer positions; a robot that stands adds none."""
        for name, sighting in sightings.items():
            x, y = sighting.report.x, sighting.report.y
            if x is None or y is None:
                continue
            points = self._points.setdefault(name, deque(maxlen=MOST_POINTS))
            if points and abs(points[-1][0] - x) + abs(points[-1][1] - y) < SHORTEST_STEP:
                continue
            points.append((x, y, sighting.received))

    def clear(self) -> None:
        """Forget every trail."""
        self._points.clear()

    def arrays(self, now: float) -> list[npt.NDArray[np.float64]]:
        """Return an (n, 3) array for each robot that moved: x, y in metres, age in s; oldest first."""
        trails = []
        for points in self._points.values():
            while points and now - points[0][2] > self.seconds:
                points.popleft()
            if len(points) > 1:
                trail = np.array(points, dtype=np.float64)
                trail[:, 2] = now - trail[:, 2]
                trails.append(trail)
        return trails
