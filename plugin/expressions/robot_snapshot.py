"""Snapshot of robots that expressions read, and its updates."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from qgis.core import QgsCoordinateReferenceSystem, QgsPointXY
from qgis.PyQt.QtCore import QObject

from ...robot_bridge.core.clock import steady_time
from ..gateway_client.fleet_state import FleetState
from ..gateway_client.robot_table import STATES
from ..layers.site_transform import frame_of
from ..ui.scheduling import UpdateScheduler

Numbers = npt.NDArray[np.float64]


@dataclass(frozen=True)
class RobotSnapshot:
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


class SnapshotHolder:
    """Holds the newest :class:`RobotSnapshot`, None while no gateway has told of any robot."""

    def __init__(self) -> None:
        self.robots: RobotSnapshot | None = None

    def replace(self, robots: RobotSnapshot | None) -> None:
        """Hold another snapshot from now on."""
        self.robots = robots


_NAMES = np.array([state.value for state in STATES], dtype=object)


class ExpressionUpdater(QObject):
    """Makes a new picture for expressions out of the desk's; :meth:`remove` leaves them without one."""

    def __init__(self, state: FleetState, scheduler: UpdateScheduler, fleet: SnapshotHolder):
        super().__init__(state)
        self._state, self._fleet = state, fleet
        self._turn = scheduler.turn()
        self._rows: dict[str, int] = {}
        self._arrangement = -1
        state.updated.connect(self._pulled)
        state.site_changed.connect(self.feed)
        state.robots_removed.connect(self.feed)

    def remove(self) -> None:
        """Feed nothing more."""
        self._fleet.replace(None)

    def feed(self) -> None:
        """Make the picture of this moment."""
        state, now = self._state, self._state.clock.steady()
        if state.site is None:
            self._fleet.replace(None)
            return
        robots = state.robots.arrays(now)
        if self._arrangement != state.robots.arrangement or len(self._rows) != len(robots.names):
            self._arrangement = state.robots.arrangement
            self._rows = {name: row for row, name in enumerate(robots.names)}
        frame = frame_of(state.site)
        snapshot = RobotSnapshot(
            crs=QgsCoordinateReferenceSystem(state.site.crs),
            rows=self._rows,
            states=_NAMES[robots.state].tolist(),
            xy=frame.to_crs(robots.xy),
            age=robots.age,
            battery=state.robots.column("battery"),
            taken=now,
        )
        self._fleet.replace(snapshot)

    def _pulled(self) -> None:
        if self._turn.has_come():
            self.feed()
