"""The robots as expressions see them: whatever thread they are evaluated in, one picture that is whole."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from qgis.core import QgsCoordinateReferenceSystem, QgsPointXY

from ...robot_bridge.steady_time import steady_time

Numbers = npt.NDArray[np.float64]


@dataclass(frozen=True)
class RobotsNow:
    """Every robot at ``taken`` (seconds, monotonic clock); nothing in it is changed afterwards.

    ``rows`` leads from a name to a row of the arrays: ``states`` (n) names of states, ``xy`` (n, 2) places in
    ``crs``, ``age`` (n,) seconds since the last message and ``battery`` (n,) part of a full one, NaN where
    not known.
    """

    crs: QgsCoordinateReferenceSystem
    rows: dict[str, int]
    states: list[str]
    xy: Numbers
    age: Numbers
    battery: Numbers
    taken: float

    def state(self, robot: str) -> str | None:
        """Return a robot's state, None for a robot that is not known."""
        row = self.rows.get(robot)
        return None if row is None else self.states[row]

    def charge(self, robot: str) -> float | None:
        """Return how full a robot's battery is, 0 to 1; None where that is not known."""
        return self._number(self.battery, robot)

    def silence(self, robot: str, now: float | None = None) -> float | None:
        """Return the seconds since a robot's last message."""
        age = self._number(self.age, robot)
        now = steady_time() if now is None else now
        return None if age is None else age + max(0.0, now - self.taken)

    def place(self, robot: str) -> QgsPointXY | None:
        """Return where a robot is, in :attr:`crs`; None where that is not known."""
        row = self.rows.get(robot)
        if row is None or not np.isfinite(self.xy[row]).all():
            return None
        return QgsPointXY(*self.xy[row].tolist())

    def _number(self, column: Numbers, robot: str) -> float | None:
        row = self.rows.get(robot)
        return None if row is None or not np.isfinite(column[row]) else float(column[row])


class FleetNow:
    """Holds the newest :class:`RobotsNow`, None while no gateway has told of any robot."""

    def __init__(self) -> None:
        self.robots: RobotsNow | None = None
