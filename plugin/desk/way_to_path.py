"""Whether a robot has come to its path yet: it drives to the first point, by a way that nobody prescribed."""

from __future__ import annotations

import math
from dataclasses import dataclass

ON_PATH_M = 1.0
"""Metres beside a path within which a robot has come to it."""
AWAY_M = 1.0
"""Metres by which a robot has to go away from a path's first point to have passed it."""


@dataclass
class WayToPath:
    """How a robot comes to its path: ``nearest`` is metres to its first point, the least."""

    nearest: float = math.inf
    is_over: bool = False

    def go_on(self, off: float, to_first: float) -> None:
        """Take in where the robot is: metres beside the path and to its first point.

        One that never comes near passes the first point all the same: it goes away from that again.
        """
        self.is_over = self.is_over or off <= ON_PATH_M or to_first > self.nearest + AWAY_M
        self.nearest = min(self.nearest, to_first)
