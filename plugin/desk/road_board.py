"""The desk's roads: which are closed, which robots are in each other's way, and what is asked about them."""

from __future__ import annotations

import uuid
from collections.abc import Callable

from qgis.PyQt.QtCore import QObject, pyqtSignal

from ...robot_bridge.messages import (
    CloseRoad,
    ClosureReport,
    Conflicts,
    OpenRoad,
    ReplannedRobot,
    ResolveConflict,
    to_json,
)
from ..language import tr
from ..wire.outbox import Order
from ..wire.road_news import RoadNews
from .drafts import Point

SILENT_AFTER = 10.0
"""Seconds without news of them after which conflicts are not known any more."""


class RoadBoard(QObject):
    """Keeps what the gateway tells of roads; ``ask`` takes an order and what it is in words."""

    closures_changed = pyqtSignal()
    conflicts_changed = pyqtSignal()
    failed = pyqtSignal(str, str)
    """A robot stopped, or drives where it should not: the text, which must not go unseen, and the robot."""
    remarked = pyqtSignal(str)

    def __init__(
        self,
        ask: Callable[[Order, str], None],
        clock: Callable[[], float],
        parent: QObject | None = None,
    ):
        super().__init__(parent)
        self._ask = ask
        self._clock = clock
        self._told_at = -SILENT_AFTER
        self.closures: tuple[ClosureReport, ...] = ()
        self.conflicts = Conflicts(0.0)

    def take(self, news: RoadNews) -> None:
        """Take in what the gateway told."""
        if news.closures is not None and self.closures != tuple(news.closures.closures):
            self.closures = tuple(news.closures.closures)
            self.closures_changed.emit()
        if news.conflicts is not None:
            self._told_at = self._clock()
            self._put(news.conflicts)
        elif self._clock() - self._told_at > SILENT_AFTER:
            # A gateway tells of them every second for as long as there are any.
            self._put(Conflicts(self.conflicts.t))
        for robot in news.replanned:
            self._tell(robot)

    def clear(self) -> None:
        """Forget everything: it is another site's."""
        self.closures = ()
        self.closures_changed.emit()
        self._put(Conflicts(0.0))

    def close(self, place: Point, reach: float, reason: str, seconds: float | None) -> str:
        """Ask for the road at ``place`` to be closed and return the closure's id.

        :raises NotSentError: when that cannot be sent.
        """
        closure = str(uuid.uuid4())
        request = CloseRoad(closure, *place, reason or None, seconds, reach)
        self._ask(
            self._order(closure, request),
            tr(
                "Closing the road at {x:.1f}, {y:.1f} m",
                x=place[0],
                y=place[1],
            ),
        )
        return closure

    def open(self, closure: str) -> None:
        """Ask for a closed road to be opened; raises NotSentError when that cannot be sent."""
        self._ask(self._order(str(uuid.uuid4()), OpenRoad(closure)), tr("Opening the road"))

    def resolve(self, robot: str, other: str) -> None:
        """Ask for ``robot`` to give way to ``other``; raises NotSentError when that cannot be sent."""
        request = ResolveConflict(robot, other)
        self._ask(
            self._order(str(uuid.uuid4()), request),
            tr(
                "{robot} gives way to {other}",
                robot=robot,
                other=other,
            ),
        )

    def _order(self, key: str, request: CloseRoad | OpenRoad | ResolveConflict) -> Order:
        return Order(key, request.method, to_json(request), self._clock())

    def _put(self, conflicts: Conflicts) -> None:
        same = (conflicts.conflicts, conflicts.waiting) == (self.conflicts.conflicts, self.conflicts.waiting)
        self.conflicts = conflicts
        if not same:
            self.conflicts_changed.emit()

    def _tell(self, robot: ReplannedRobot) -> None:
        if robot.became == "another way":
            self.remarked.emit(robot.text)
        else:
            self.failed.emit(robot.text, robot.robot)
