"""Passes the robots on to QGIS's expressions, twice a second."""

from __future__ import annotations

import numpy as np
from qgis.core import QgsCoordinateReferenceSystem
from qgis.PyQt.QtCore import QObject

from ..expressions.robots_now import FleetNow, RobotsNow
from .desk import Desk
from .picture import STATES
from .placement import frame_of

_NAMES = np.array([state.value for state in STATES], dtype=object)


class RobotFeed(QObject):
    """Makes a new picture for expressions out of the desk's; :meth:`remove` leaves them without one."""

    def __init__(self, desk: Desk, fleet: FleetNow):
        super().__init__(desk)
        self._desk, self._fleet = desk, fleet
        self._turn = desk.beat.turn()
        self._rows: dict[str, int] = {}
        self._arrangement = -1
        desk.pulled.connect(self._pulled)
        desk.site_changed.connect(self.feed)
        desk.robots_removed.connect(self.feed)

    def remove(self) -> None:
        """Feed nothing more."""
        self._fleet.robots = None

    def feed(self) -> None:
        """Make the picture of this moment."""
        desk, now = self._desk, self._desk.clock()
        if desk.site is None:
            self._fleet.robots = None
            return
        robots = desk.picture.arrays(now)
        if self._arrangement != desk.picture.arrangement or len(self._rows) != len(robots.names):
            self._arrangement = desk.picture.arrangement
            self._rows = {name: row for row, name in enumerate(robots.names)}
        frame = frame_of(desk.site)
        self._fleet.robots = RobotsNow(
            crs=QgsCoordinateReferenceSystem(desk.site.crs),
            rows=self._rows,
            states=_NAMES[robots.state].tolist(),
            xy=frame.to_crs(robots.xy),
            age=robots.age,
            battery=desk.picture.column("battery"),
            taken=now,
        )

    def _pulled(self) -> None:
        if self._turn.has_come():
            self.feed()
