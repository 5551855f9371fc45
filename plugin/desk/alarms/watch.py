"""Looks at the robots again and again, and tells of alarms."""

from __future__ import annotations

import time
from collections.abc import Iterable

from qgis.PyQt.QtCore import QObject, pyqtSignal

from ...language import tr
from ...sites.surface_store import SurfaceStore
from ...wire.status import Phase
from ..desk import Desk
from ..picture import Gone
from ..time_slices import ONE_STEP, Steps, TimeSlices
from .alarm import AlarmChange, AlarmEvent, Key
from .board import AlarmBoard
from .message_log import AlarmMessages
from .reported import fence_alarms, nearness_alarms, passing_alarms
from .road_ground import RoadGround
from .situations import Situations
from .stored_limits import read_limits, write_limits
from .thresholds import AlarmKind, Thresholds
from .words import KINDS

FENCED = frozenset({AlarmKind.IN_KEEPOUT, AlarmKind.AT_OBSTACLE})
NEARNESS = frozenset({AlarmKind.NEAR_ROBOT, AlarmKind.COMES_NEAR})
MANY = 500
"""With more robots it looks half as often."""


class AlarmWatch(QObject):
    """Watches as long as the link is up: what the gateway does not tell, nobody can judge."""

    changed = pyqtSignal()
    """Alarms came, ended or were acknowledged, or whether somebody watches; soon after it was so."""
    happened = pyqtSignal(list)
    """The AlarmEvents since this was told last; soon after they were."""

    def __init__(self, desk: Desk, surfaces: SurfaceStore, parent: QObject | None = None):
        super().__init__(parent)
        self._desk = desk
        self._ground = RoadGround(surfaces, self)
        self._situations = Situations(desk, self._ground)
        self._messages = AlarmMessages(desk.clock)
        self._turn = desk.beat.turn()
        self._generation = desk.picture.generation
        self._told = ""
        self._untold: list[AlarmEvent] = []
        self._unseen: set[Key] = set()
        """Alarms that have begun and that nobody was told of yet."""
        self._telling = TimeSlices(self, ONE_STEP)
        self.board = AlarmBoard(read_limits())
        desk.pulled.connect(self._pulled)
        desk.robots_removed.connect(self._drop)

    def remove(self) -> None:
        """Look no more."""
        self._desk.pulled.disconnect(self._pulled)
        self._desk.robots_removed.disconnect(self._drop)
        self._telling.stop()
        self._ground.remove()

    def why_not(self) -> str:
        """Return what is not watched and why, empty when everything is."""
        if self._desk.link.phase is not Phase.CONNECTED:
            return tr("Nothing is watched: the desk is not connected.")
        off = [KINDS[kind] for kind in AlarmKind if kind not in self.board.limits.kinds]
        texts = [tr("Switched off: {kinds}.", kinds=", ".join(off))] if off else []
        if (unfenced := self._desk.geofence.why_not()) and FENCED & self.board.limits.kinds:
            texts.append(unfenced)
        if (unwatched := self._desk.nearness.why_not()) and NEARNESS & self.board.limits.kinds:
            texts.append(unwatched)
        if self._ground.why_not and AlarmKind.OFF_ROAD in self.board.limits.kinds:
            why = self._ground.why_not.rstrip(".")
            texts.append(tr("Off the road is not watched: {why}.", why=why))
        return " ".join(texts)

    def look(self) -> None:
        """Judge what is known now."""
        if self._desk.link.phase is Phase.CONNECTED and self._desk.site is not None:
            moment = self._desk.clock()
            situation = self._situations.at(moment, self.board.limits)
            self._tell(self.board.look(situation, moment, time.time()))
            self._take_reported(moment)
        self._tell_of_watching()

    def acknowledge(self, keys: Iterable[Key]) -> None:
        """Note that the operator has seen these alarms."""
        link = self._desk.link
        operator = (link.who if link.phase is Phase.CONNECTED else "") or tr("this desk")
        self._tell(self.board.acknowledge(keys, operator, time.time()))
        self._telling.finish()

    def acknowledge_all(self) -> None:
        """Note that the operator has seen every alarm that was told of."""
        self.acknowledge([alarm.key for alarm in self.board.alarms() if alarm.key not in self._unseen])

    def set_limits(self, limits: Thresholds) -> None:
        """Judge by these settings from now on, in later sessions as well."""
        write_limits(limits)
        self.board.set_limits(limits)
        self.changed.emit()

    def _take_reported(self, moment: float) -> None:
        reported = fence_alarms(self._desk.geofence.alarms)
        reported += nearness_alarms(self._desk.nearness.alarms)
        reported += passing_alarms(self._desk.roads.conflicts, self.board.limits)
        events, renewed = self.board.report(reported, moment, time.time())
        self._tell(events)
        if renewed and not events:
            self.changed.emit()

    def _pulled(self) -> None:
        if self._generation != self._desk.picture.generation:
            self._generation = self._desk.picture.generation
            self.board.clear()
            self.changed.emit()
        if self._turn.has_come(1 if len(self._desk.picture) <= MANY else 2):
            self.look()

    def _drop(self, gone: Gone) -> None:
        self.board.drop(gone)
        self.changed.emit()

    def _tell(self, events: list[AlarmEvent]) -> None:
        self._messages.write([event.alarm for event in events if event.change is AlarmChange.BEGAN])
        if events:
            self._untold += events
            self._unseen.update(event.alarm.key for event in events if event.change is AlarmChange.BEGAN)
            self._telling.begin_soon(self._parts())

    def _parts(self) -> Steps[None]:
        """Tell of events part by part: to judge hundreds and to show it is too much for one piece."""
        events, self._untold = self._untold, []
        self.happened.emit(events)
        # The message bar counts them and says what the most pressing ones are.
        self._unseen.clear()
        yield 0.5
        self.changed.emit()

    def _tell_of_watching(self) -> None:
        told = self.why_not()
        if told != self._told:
            self._told = told
            self.changed.emit()
