"""Watch that runs the alarm rules: snapshot, road surfaces, alarms in QGIS's message log and message bar."""

from __future__ import annotations

import math
import time
from collections.abc import Iterable, Sequence

import numpy as np
from qgis.core import Qgis, QgsMessageLog
from qgis.gui import QgsMessageBar, QgsMessageBarItem
from qgis.PyQt.QtCore import QObject, pyqtSignal
from qgis.PyQt.QtWidgets import QToolButton

from ....robot_bridge.core.clock import Clock
from ....robot_bridge.core.messages.commands import CommandState
from ....robot_bridge.core.roads.surface_index import NOWHERE
from ...control.messages import TITLE, MessageLabel, NoticeBody
from ...gateway_client.connection_status import ConnectionPhase
from ...gateway_client.fleet_state import FleetState
from ...gateway_client.robot_states import RemovedRobots, RobotArrays
from ...layers.road_surfaces import SurfaceMap, SurfaceStore, key_of
from ...layers.site_transform import SiteToCanvas, SiteToMapTransform, transform_points_or_nan
from ...ui.errors import FleetError, MapTransformError
from ...ui.language import first_of, plain_tip, tr, tr_count
from ...ui.scheduling import ONE_STEP, CooperativeTask, Steps, UpdateScheduler
from . import rules
from .board import AlarmBoard, fence_alarms, nearness_alarms, passing_alarms
from .rules import Alarm, AlarmChange, AlarmEvent, AlarmKind, AlarmSnapshot, Bools, Floats, Key, Thresholds

AROUND = np.array([(np.cos(turn), np.sin(turn)) for turn in np.arange(8) * np.pi / 4])
"""Directions in which the margin is sampled."""


class RoadGround(QObject):
    """Queries ``store`` for road surfaces; those not read yet are read in the background."""

    def __init__(self, store: SurfaceStore, parent: QObject | None = None):
        super().__init__(parent)
        self._store = store
        self._failed_once = False
        self.why_not = ""
        """Why it is unknown who is on the road; empty where that is known."""
        store.forgotten.connect(self._forgotten)
        store.ended.connect(self._have_read)

    def evaluate(
        self, xy: Floats, transform: SiteToMapTransform, margin: float
    ) -> tuple[Bools, Bools] | None:
        """Return which of (n, 2) metres in the site frame are off the road by ``margin``, and which on it.

        None where no surfaces are known (see :attr:`why_not`). A robot without a position is neither.
        """
        surfaces = self._surfaces()
        if surfaces is None:
            return None
        there = np.isfinite(xy).all(axis=1)
        on = np.zeros(len(xy), dtype=bool)
        on[there] = _on_a_surface(xy[there], transform, surfaces)
        off = np.zeros(len(xy), dtype=bool)
        beside = np.flatnonzero(there & ~on)
        rim = (xy[beside, None, :] + AROUND * margin).reshape(-1, 2)
        off[beside] = ~_on_a_surface(rim, transform, surfaces).reshape(-1, len(AROUND)).any(axis=1)
        return off, on

    def report_failure(self, why: str) -> None:
        """Report why it is unknown who is on the road."""
        self.why_not = why

    def remove(self) -> None:
        """Disconnect from the store."""
        self._store.forgotten.disconnect(self._forgotten)
        self._store.ended.disconnect(self._have_read)

    def _surfaces(self) -> SurfaceMap | None:
        layers = self._store.layers()
        if not layers:
            self.why_not = tr("no layer of the project has the role road surface")
            return None
        found = self._store.kept(layers)
        if found is not None and not found.index.surfaces:
            # Otherwise every robot would be off the road.
            names = ", ".join(layer.name() for layer in layers)
            self.why_not = tr("layers of road surfaces hold no areas ({names})", names=names)
            return None
        if found is not None:
            self.why_not = ""
        elif not self._failed_once:
            self.why_not = tr("the road surfaces are being read")
            try:
                self._store.begin(layers)
            except FleetError as error:
                self._give_up(str(error))
        return found

    def _have_read(self, key: object, why: str) -> None:
        if why and key == key_of(self._store.layers()):
            self._give_up(why)

    def _give_up(self, why: str) -> None:
        # Not tried again before a layer has changed.
        self._failed_once = True
        self.why_not = tr("layers of road surfaces cannot be read: {why}", why=why)

    def _forgotten(self) -> None:
        self._failed_once = False
        self.why_not = ""


def _on_a_surface(xy: Floats, transform: SiteToMapTransform, surfaces: SurfaceMap) -> Bools:
    if len(xy) == 0:
        return np.zeros(0, dtype=bool)
    way = surfaces.way_from(transform.site_crs)
    return surfaces.index.at_many(transform_points_or_nan(transform.frame.to_crs(xy), way)) != NOWHERE


class SnapshotBuilder:
    """Makes successive snapshots; from two of them it derives the speed of robots that do not report it."""

    def __init__(self, state: FleetState, site_to_canvas: SiteToCanvas, ground: RoadGround):
        self._state, self._site_to_canvas = state, site_to_canvas
        self._ground = ground
        self._before: tuple[float, Floats] = (0.0, np.empty((0, 2)))
        self._arrangement = state.robots.arrangement

    def at(self, moment: float, limits: Thresholds) -> AlarmSnapshot:
        """Return the snapshot at ``moment`` of the desk's clock; the site must be known."""
        robots = self._state.robots.arrays(moment)
        off, on = self._roads(robots.xy, limits)
        only_seen = self._state.robots.only_seen()
        return AlarmSnapshot(
            names=robots.names,
            xy=robots.xy,
            v=self._speeds(robots, moment),
            battery=self._state.robots.column("battery"),
            # Not for robots that are only seen: a phone's position is metres, or seconds, off all day.
            accuracy=np.where(only_seen, np.nan, robots.accuracy),
            state=robots.state,
            stopped=self._state.robots.column("stopped") == 1.0,
            driving=self._driving(len(robots.names)),
            only_seen=only_seen,
            bounds=self._state.site.bounds,
            doubted=robots.doubted & ~only_seen,
            doubts=self._state.robots.doubts(),
            off_road=off,
            on_road=on,
        )

    def _speeds(self, robots: RobotArrays, moment: float) -> Floats:
        then, places = self._before
        if self._arrangement != self._state.robots.arrangement:
            # These rows belonged to other robots.
            self._arrangement, places = self._state.robots.arrangement, places[:0]
        self._before = moment, robots.xy
        seen = np.full(len(robots.v), np.nan)
        if moment > then and 0 < len(places) <= len(robots.xy):
            seen[: len(places)] = np.hypot(*(robots.xy[: len(places)] - places).T) / (moment - then)
        return np.where(np.isnan(robots.v), seen, np.abs(robots.v))

    def _driving(self, count: int) -> Bools:
        driving = np.zeros(count, dtype=bool)
        if self._state.emergency is not None and self._state.emergency.in_force:
            return driving
        waits = {hold.robot for hold in self._state.conflicts.waiting}
        for task in self._state.commands.under_way():
            row = self._state.robots.row(task.robot)
            if row is not None and task.state is CommandState.ACKNOWLEDGED and task.robot not in waits:
                driving[row] = True
        return driving

    def _roads(self, xy: Floats, limits: Thresholds) -> tuple[Bools | None, Bools | None]:
        if AlarmKind.OFF_ROAD not in limits.kinds:
            return None, None
        try:
            judged = self._ground.evaluate(xy, self._site_to_canvas.transform(), limits.road_margin)
        except MapTransformError as error:
            self._ground.report_failure(str(error))
            return None, None
        return (None, None) if judged is None else judged


MOST_LINES = 20
"""Alarms that are written within :data:`WITHIN`: a fleet that keeps losing its radio would otherwise
take megabytes an hour. The log of alarms has all of them."""
WITHIN = 600.0
"""Seconds."""


class AlarmMessages:
    """Writes alarms that began to the message log, by the steady time of ``clock``."""

    def __init__(self, clock: Clock):
        self._clock = clock
        self._until = -math.inf
        self._left = 0
        self._counted = 0

    def write(self, began: Sequence[Alarm]) -> None:
        """Write these as far as the limit allows; of others the number at once, and the rest later.

        Must be called again and again, also without alarms.
        """
        if self._clock.steady() >= self._until:
            self._restart()
        for alarm in began[: self._left]:
            _write(alarm.text)
        more = max(0, len(began) - self._left)
        if more and self._left:
            _count(more)
        else:
            self._counted += more
        self._left = max(0, self._left - len(began))

    def _restart(self) -> None:
        if self._counted:
            _count(self._counted)
        self._until, self._left, self._counted = self._clock.steady() + WITHIN, MOST_LINES, 0


def _count(more: int) -> None:
    _write(
        tr_count(
            more,
            "and 1 more alarm: see the log of alarms in the Fleet panel",
            "and %n more alarms: see the log of alarms in the Fleet panel",
        )
    )


def _write(text: str) -> None:
    QgsMessageLog.logMessage(text, TITLE, Qgis.MessageLevel.Warning, False)


FENCED = frozenset({AlarmKind.IN_KEEPOUT, AlarmKind.AT_OBSTACLE})
NEARNESS = frozenset({AlarmKind.NEAR_ROBOT, AlarmKind.COMES_NEAR})
MANY = 500
"""Number of robots above which the alarms are evaluated half as often."""


class AlarmWatch(QObject):
    """Evaluates the alarms while the link is up: without reports of the gateway nothing can be judged."""

    changed = pyqtSignal()
    """Alarms began, ended or were acknowledged, or the watch started or stopped; signalled shortly after."""
    happened = pyqtSignal(list)
    """The AlarmEvents since this was last signalled; signalled shortly after."""

    def __init__(
        self,
        state: FleetState,
        site_to_canvas: SiteToCanvas,
        scheduler: UpdateScheduler,
        surfaces: SurfaceStore,
        parent: QObject | None = None,
    ):
        super().__init__(parent)
        self._state = state
        self._ground = RoadGround(surfaces, self)
        self._situations = SnapshotBuilder(state, site_to_canvas, self._ground)
        self._messages = AlarmMessages(state.clock)
        self._turn = scheduler.turn()
        self._generation = state.robots.generation
        self._reason = ""
        self._unannounced: list[AlarmEvent] = []
        self._unseen: set[Key] = set()
        """Alarms that have begun and have not been shown yet."""
        self._announcing = CooperativeTask(self, ONE_STEP)
        self.board = AlarmBoard(rules.read_thresholds())
        state.updated.connect(self._pulled)
        state.robots_removed.connect(self._drop)

    def remove(self) -> None:
        """Stop watching."""
        self._state.updated.disconnect(self._pulled)
        self._state.robots_removed.disconnect(self._drop)
        self._announcing.stop()
        self._ground.remove()

    def why_not(self) -> str:
        """Return what is not watched and why, empty when everything is."""
        if self._state.link.phase is not ConnectionPhase.CONNECTED:
            return tr("Nothing is watched: the desk is not connected.")
        off = [kind.words for kind in AlarmKind if kind not in self.board.limits.kinds]
        texts = [tr("Switched off: {kinds}.", kinds=", ".join(off))] if off else []
        if (unfenced := self._state.geofence.why_not()) and FENCED & self.board.limits.kinds:
            texts.append(unfenced)
        if (unwatched := self._state.nearness.why_not()) and NEARNESS & self.board.limits.kinds:
            texts.append(unwatched)
        if self._ground.why_not and AlarmKind.OFF_ROAD in self.board.limits.kinds:
            why = self._ground.why_not.rstrip(".")
            texts.append(tr("Off the road is not watched: {why}.", why=why))
        return " ".join(texts)

    def evaluate(self) -> None:
        """Evaluate the alarms now."""
        if self._state.link.phase is ConnectionPhase.CONNECTED and self._state.site is not None:
            moment = self._state.clock.steady()
            situation = self._situations.at(moment, self.board.limits)
            self._announce(self.board.evaluate(situation, moment, time.time()))
            self._apply_reported(moment)
        self._announce_watching()

    def acknowledge(self, keys: Iterable[Key]) -> None:
        """Acknowledge these alarms for the operator."""
        link = self._state.link
        operator = (link.who if link.phase is ConnectionPhase.CONNECTED else "") or tr("this desk")
        self._announce(self.board.acknowledge(keys, operator, time.time()))
        self._announcing.finish()

    def acknowledge_all(self) -> None:
        """Acknowledge every alarm that has been shown."""
        self.acknowledge([alarm.key for alarm in self.board.alarms() if alarm.key not in self._unseen])

    def set_limits(self, limits: Thresholds) -> None:
        """Use these thresholds from now on, in later sessions as well."""
        rules.write_thresholds(limits)
        self.board.set_limits(limits)
        self.changed.emit()

    def _apply_reported(self, moment: float) -> None:
        reported = fence_alarms(self._state.geofence.alarms)
        if self._state.nearness.alarms:
            reported += nearness_alarms(self._state.nearness.alarms, self._state.robots.doubted())
        reported += passing_alarms(self._state.conflicts, self.board.limits)
        events, renewed = self.board.report(reported, moment, time.time())
        self._announce(events)
        if renewed and not events:
            self.changed.emit()

    def _pulled(self) -> None:
        if self._generation != self._state.robots.generation:
            self._generation = self._state.robots.generation
            self.board.clear()
            self.changed.emit()
        if self._turn.is_due(1 if len(self._state.robots) <= MANY else 2):
            self.evaluate()

    def _drop(self, gone: RemovedRobots) -> None:
        self.board.drop(gone)
        self.changed.emit()

    def _announce(self, events: list[AlarmEvent]) -> None:
        self._messages.write([event.alarm for event in events if event.change is AlarmChange.BEGAN])
        if events:
            self._unannounced += events
            self._unseen.update(event.alarm.key for event in events if event.change is AlarmChange.BEGAN)
            self._announcing.begin_soon(self._parts())

    def _parts(self) -> Steps[None]:
        """Signal events in parts: judging and showing hundreds at once would block the window."""
        events, self._unannounced = self._unannounced, []
        self.happened.emit(events)
        # The message bar counts them and describes the most urgent ones.
        self._unseen.clear()
        yield 0.5
        self.changed.emit()

    def _announce_watching(self) -> None:
        reason = self.why_not()
        if reason != self._reason:
            self._reason = reason
            self.changed.emit()


# --- Alarms in QGIS's message bar: one item that counts, with its button ---

NAMED = 2
"""Alarms that are described; the others are counted."""


class AlarmBar(QObject):
    """A bar item, present while there are unacknowledged alarms. Closed, it returns with the next one."""

    requested = pyqtSignal()
    """The operator wants to see the alarms."""

    def __init__(self, bar: QgsMessageBar, watch: AlarmWatch, parent: QObject | None = None):
        super().__init__(parent)
        self._bar = bar
        self._watch = watch
        self._item: QgsMessageBarItem | None = None
        self._label: MessageLabel | None = None
        self._level = Qgis.MessageLevel.Warning
        self._shown = "", ""
        bar.widgetRemoved.connect(self._removed)
        watch.happened.connect(self._happened)
        watch.changed.connect(self._changed)

    def text(self) -> str:
        """Return the text of the item, empty for none."""
        return "" if self._label is None else self._label.text()

    def remove(self) -> None:
        """Remove the item and disconnect."""
        self._bar.widgetRemoved.disconnect(self._removed)
        self._watch.happened.disconnect(self._happened)
        self._watch.changed.disconnect(self._changed)
        self._remove_item()

    def _happened(self, events: list) -> None:
        self._show(has_begun=any(event.change is AlarmChange.BEGAN for event in events))

    def _changed(self) -> None:
        # Alarms also vanish without an event: with their robots, or when the link changes to others. And the
        # gateway's reaction to one is shown while the item is there.
        if self._item is not None:
            self._show(has_begun=False)

    def _show(self, *, has_begun: bool) -> None:
        new = self._new()
        if not new:
            self._remove_item()
            return
        pressing = any(alarm.kind.is_urgent and alarm.ended is None for alarm in new)
        level = Qgis.MessageLevel.Critical if pressing else Qgis.MessageLevel.Warning
        if has_begun:
            self._bring_to_front(level)
        self._show_words()

    def _new(self) -> list[Alarm]:
        return [alarm for alarm in self._watch.board.alarms() if alarm.is_new]

    def _show_words(self) -> None:
        """Show the present text of the alarms."""
        if self._label is None:
            return
        new = self._new()
        text, tip = in_words(new), "\n".join(alarm.text for alarm in new[:20])
        if new and (text, tip) != self._shown:
            self._shown = text, tip
            self._label.show_text(text)
            self._label.setToolTip(plain_tip(tip))

    def _bring_to_front(self, level: Qgis.MessageLevel) -> None:
        """Show the item with this level, in front; it is replaced only when behind another notice, since
        that takes QGIS as long as a frame of the map."""
        if self._item is None:
            self._add_item(level)
        elif self._bar.currentItem() is not self._item:
            self._remove_item()
            self._add_item(level)
        elif level != self._level:
            self._level = level
            self._item.setLevel(level)

    def _add_item(self, level: Qgis.MessageLevel) -> None:
        self._level = level
        self._shown = "", ""
        self._label = MessageLabel("", self._bar)
        self._label.setObjectName("fleet_alarm_text")
        show = QToolButton()
        show.setObjectName("fleet_show_alarms")
        show.setText(tr("Show"))
        show.clicked.connect(lambda: self.requested.emit())
        # The item has no other button: the bar comes and goes, and a click aimed at what was there before
        # would acknowledge unread alarms.
        body = NoticeBody(self._label, [show], self._bar)
        body.setObjectName("fleet_alarm_bar")
        self._item = QgsMessageBarItem(body, level, 0)
        self._bar.pushItem(self._item)

    def _remove_item(self) -> None:
        item, self._item, self._label = self._item, None, None
        if item is not None:
            self._bar.popWidget(item)

    def _removed(self, item: QgsMessageBarItem) -> None:
        if item is self._item:
            self._item = self._label = None


def in_words(new: list[Alarm]) -> str:
    """Return the number of unacknowledged alarms, and descriptions of the most urgent ones."""
    head = tr_count(len(new), "1 alarm", "%n alarms")
    return f"{head}: {'; '.join(first_of([alarm.text for alarm in new], NAMED))}"
