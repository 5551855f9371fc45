"""Board of alarms from the plugin's rules and the gateway's reports, their colours, and the log."""

from __future__ import annotations

from collections import deque
from collections.abc import Collection, Iterable
from typing import NamedTuple

import numpy as np
from qgis.PyQt.QtGui import QColor, QPalette
from qgis.PyQt.QtWidgets import QApplication

from ....robot_bridge.core.messages.roads import ConflictReport, Conflicts
from ....robot_bridge.core.messages.safety import FenceAlarm, NearnessAlarm
from ...gateway_client.robot_states import RemovedRobots
from ...ui.glyphs import is_dark
from ...ui.language import tr
from . import rules
from .rules import (
    Alarm,
    AlarmChange,
    AlarmEvent,
    AlarmKind,
    AlarmSnapshot,
    Key,
    PairHysteresis,
    RowHysteresis,
)

CHANGES = {
    AlarmChange.BEGAN: tr("began"),
    AlarmChange.ENDED: tr("ended"),
    AlarmChange.ACKNOWLEDGED: tr("acknowledged"),
}


def robots_of(alarm: Alarm) -> str:
    """Return the robot of an alarm, or both."""
    if not alarm.other:
        return alarm.robot
    return tr("{robot} and {other}", robot=alarm.robot, other=alarm.other)


def alarm_state_in_words(alarm: Alarm) -> str:
    """Return whether an alarm holds and was acknowledged, as in ``new ×3`` or ``over``."""
    if not alarm.is_new:
        return tr("seen")
    state = tr("new") if alarm.ended is None else tr("over")
    return f"{state} ×{alarm.times}" if alarm.times > 1 else state


def colour_of(alarm: Alarm) -> QColor:
    """Return the text colour of an alarm; pale where it is over."""
    if alarm.ended is not None:
        return QApplication.palette().color(QPalette.ColorGroup.Disabled, QPalette.ColorRole.Text)
    return alarm_colour(alarm.kind.is_urgent)


def alarm_colour(pressing: bool) -> QColor:
    """Return red for an urgent alarm, else amber, legible on the background of lists."""
    if pressing:
        return QColor("#FF8A80" if is_dark() else "#B71C1C")
    return QColor("#FFB74D" if is_dark() else "#A15C00")


class ReportedAlarm(NamedTuple):
    """An alarm for as long as the gateway reports it; ``xy`` is metres in the site frame.

    ``began`` is seconds since 1970, None where the desk's own time counts. ``unsure`` names those of the two
    robots that may be elsewhere.
    """

    kind: AlarmKind
    robot: str
    text: str
    xy: tuple[float, float]
    other: str = ""
    area: str = ""
    began: float | None = None
    unsure: tuple[str, ...] = ()

    @property
    def key(self) -> Key:
        """The key by which the next report is recognised as the same alarm."""
        return self.kind, self.robot, self.other or self.area


def fence_alarms(alarms: Iterable[FenceAlarm]) -> list[ReportedAlarm]:
    """Return alarms for robots in keepouts and at obstacles, with the gateway's reaction."""
    found = []
    for one in alarms:
        kind = AlarmKind.IN_KEEPOUT if one.kind == "keepout" else AlarmKind.AT_OBSTACLE
        text = _fence_text(one)
        found.append(ReportedAlarm(kind, one.robot, text, (one.x, one.y), area=one.name, began=one.since))
    return found


def passing_alarms(conflicts: Conflicts, limits: rules.Thresholds) -> list[ReportedAlarm]:
    """Return alarms for robots that pass one another too near now or soon."""
    soon = (one for one in conflicts.conflicts if one.begins - conflicts.t <= limits.pass_within)
    found = [_passing_alarm(one) for one in soon]
    # If the same two meet several times, the soonest meeting is reported.
    return list({alarm.key: alarm for alarm in reversed(found)}.values())


def nearness_alarms(alarms: Iterable[NearnessAlarm], doubted: Collection[str] = ()) -> list[ReportedAlarm]:
    """Return alarms for people and vehicles that are near robots now or soon; those ``doubted`` may
    be elsewhere."""
    found = []
    for one in alarms:
        kind = AlarmKind.COMES_NEAR if one.seconds else AlarmKind.NEAR_ROBOT
        unsure = tuple(name for name in (one.seen, one.robot) if name in doubted)
        text = _nearness_text(one)
        for name in unsure:
            text = tr("{text}; {robot} may be elsewhere", text=text, robot=name)
        place = (one.x, one.y)
        found.append(ReportedAlarm(kind, one.seen, text, place, one.robot, began=one.since, unsure=unsure))
    return found


def _nearness_text(one: NearnessAlarm) -> str:
    names = {"seen": one.seen, "robot": one.robot, "metres": one.metres}
    if one.seconds:
        return tr(
            "{seen} comes within {metres:.1f} m of {robot} in {seconds:.0f} s", seconds=one.seconds, **names
        )
    return tr("{seen} is {metres:.1f} m from {robot}", **names)


def _passing_alarm(one: ConflictReport) -> ReportedAlarm:
    # The gateway names the moving one first: when one of them has stopped it is still the same alarm.
    robot, other = sorted((one.robot, one.other))
    return ReportedAlarm(AlarmKind.WILL_PASS, robot, _passing_text(one), (one.x, one.y), other)


def _fence_text(alarm: FenceAlarm) -> str:
    if alarm.kind == "keepout":
        where = tr("{robot} is in the keepout {name}", robot=alarm.robot, name=alarm.name)
    else:
        where = tr("{robot} is at the obstacle {name}", robot=alarm.robot, name=alarm.name)
    done = _outcome(alarm)
    text = f"{where}: {done}" if done else where
    return text if alarm.current else tr("{text} (it is not heard now)", text=text)


def _outcome(alarm: FenceAlarm) -> str:
    if alarm.outcome == "asked":
        return tr("it is being paused") if alarm.action == "pause" else tr("it is being aborted")
    if alarm.outcome == "failed":
        return tr("it could NOT be stopped yet: {why}", why=alarm.reason or "")
    return {
        "paused": tr("the gateway has paused it"),
        "aborted": tr("the gateway has aborted its task"),
        "stopped": tr("the emergency stop holds it"),
    }.get(alarm.outcome, "")


def _passing_text(one: ConflictReport) -> str:
    where = tr(" at {x:.1f}, {y:.1f} m", x=one.x, y=one.y)
    names = {"robot": one.robot, "other": one.other, "metres": one.metres, "where": where}
    if one.clearance is None:
        return tr("{robot} will pass {other} at {metres:.1f} m{where}", **names)
    return tr(
        "{robot} will pass {other} at {metres:.1f} m (clearance {clearance:.1f} m){where}",
        clearance=one.clearance,
        **names,
    )


MOST_EVENTS = 5000
MOST_ALARMS = 1000
ON_AFTER = 1.0
"""Seconds for which a rule must hold before it is an alarm; for a robot that stands they are more."""
OFF_AFTER = 1.0
GONE_AFTER = 2.0
"""Seconds without a report after which a reported alarm is over: a conflict at its limit flickers."""
URGENCY = {kind: number for number, kind in enumerate(AlarmKind)}


class AlarmBoard:
    """Evaluates one snapshot after the other. ``moment`` is on the monotonic clock, ``at`` since 1970."""

    def __init__(self, limits: rules.Thresholds | None = None) -> None:
        self._limits = limits or rules.Thresholds()
        self._rows = {kind: RowHysteresis() for kind in rules.RULES}
        self._doubted = RowHysteresis()
        self._pairs = PairHysteresis()
        self._reported: dict[Key, float] = {}
        """The alarms judged by the gateway, with the time of their last report."""
        self._alarms: dict[Key, Alarm] = {}
        self._ordered: list[Alarm] | None = []
        self.log: deque[AlarmEvent] = deque(maxlen=MOST_EVENTS)

    @property
    def limits(self) -> rules.Thresholds:
        """The thresholds."""
        return self._limits

    def alarms(self) -> list[Alarm]:
        """Return the alarms to show: new ones first, holding before over, urgent ones first."""
        if self._ordered is None:
            # Bar, panel, table and details call this at each change: with a thousand alarms that is
            # noticeable.
            self._ordered = sorted(self._alarms.values(), key=_order)
        return self._ordered.copy()

    def of(self, robot: str) -> list[Alarm]:
        """Return the alarms of a robot, urgent ones first."""
        return [alarm for alarm in self.alarms() if robot in (alarm.robot, alarm.other)]

    def evaluate(self, now: AlarmSnapshot, moment: float, at: float) -> list[AlarmEvent]:
        """Evaluate a snapshot and return the changes."""
        events = []
        for kind, rule in rules.RULES.items():
            holds, over = rule(now, self._limits)
            if kind not in self._limits.kinds:
                holds, over = np.zeros_like(holds), np.ones_like(over)
            wait = self._limits.stopped_after if kind is AlarmKind.STOPPED else ON_AFTER
            rises, falls = self._rows[kind].update(holds, over, moment, wait, OFF_AFTER)
            events += [self._begin(kind, now, row, at) for row in rises.tolist()]
            events += self._end([(kind, now.names[row], "") for row in falls.tolist()], at)
        events += self._begin_for_doubts(now, moment, at)
        events += self._check_pairs(now, at)
        self.log.extend(events)
        self._drop_oldest()
        if events:
            self._ordered = None
        return events

    def report(
        self, reported: Iterable[ReportedAlarm], moment: float, at: float
    ) -> tuple[list[AlarmEvent], bool]:
        """Apply the gateway's present reports; return the changes, and whether a text changed."""
        events, renewed = [], False
        for one in reported:
            if one.kind not in self._limits.kinds:
                continue
            if one.key not in self._reported:
                began = at if one.began is None else one.began
                alarm = Alarm(
                    one.kind, one.robot, one.text, began, one.other, one.xy, area=one.area, unsure=one.unsure
                )
                events.append(self._put_up(alarm, at))
            self._reported[one.key] = moment
            renewed |= self._renew_text(one)
        gone = [key for key, seen in self._reported.items() if moment - seen >= GONE_AFTER]
        for key in gone:
            del self._reported[key]
        events += self._end(gone, at)
        self.log.extend(events)
        if events or renewed:
            self._ordered = None
        return events, renewed

    def set_limits(self, limits: rules.Thresholds) -> None:
        """Use other thresholds from the next evaluation on."""
        self._limits = limits

    def acknowledge(self, keys: Iterable[Key], by: str, at: float) -> list[AlarmEvent]:
        """Record that these alarms were acknowledged; those that are over are removed."""
        events = []
        for key in keys:
            alarm = self._alarms.get(key)
            if alarm is None or not alarm.is_new:
                continue
            seen = alarm._replace(acknowledged=at, by=by)
            events.append(AlarmEvent(at, AlarmChange.ACKNOWLEDGED, seen, by))
            if alarm.ended is None:
                self._alarms[key] = seen
            else:
                del self._alarms[key]
        self.log.extend(events)
        self._ordered = None
        return events

    def clear(self) -> None:
        """Forget the robots and their alarms: they belong to another site. The log stays."""
        self._rows = {kind: RowHysteresis() for kind in rules.RULES}
        self._doubted = RowHysteresis()
        self._pairs = PairHysteresis()
        self._reported.clear()
        self._alarms.clear()
        self._ordered = None

    def drop(self, gone: RemovedRobots) -> None:
        """Forget robots that no longer exist or are out of view, with their alarms. The log stays."""
        for latch in (*self._rows.values(), self._doubted, self._pairs):
            latch.drop(gone.rows)
        names = gone.all_names
        for key, alarm in list(self._alarms.items()):
            if {alarm.robot, alarm.other} & names:
                del self._alarms[key]
                self._reported.pop(key, None)
        self._ordered = None

    def _drop_oldest(self) -> None:
        """Remove the oldest alarms that are over, where there are too many; they stay in the log."""
        too_many = len(self._alarms) - MOST_ALARMS
        if too_many > 0:
            over = (alarm for alarm in self._alarms.values() if alarm.ended is not None)
            for alarm in sorted(over, key=lambda alarm: alarm.began)[:too_many]:
                del self._alarms[alarm.key]

    def _begin_for_doubts(self, now: AlarmSnapshot, moment: float, at: float) -> list[AlarmEvent]:
        """Begin an alarm for poor accuracy again where the robot may be elsewhere by now."""
        kind = AlarmKind.UNSURE
        holds = now.doubted & self._rows[kind].on
        rises, _ = self._doubted.update(holds, ~now.doubted, moment, 0.0, 0.0)
        held = [(row, self._alarms.get((kind, now.names[row], ""))) for row in rises.tolist()]
        begun_again = [row for row, alarm in held if alarm is not None and not alarm.unsure]
        return [self._begin(kind, now, row, at) for row in begun_again]

    def _check_pairs(self, now: AlarmSnapshot, at: float) -> list[AlarmEvent]:
        one, other, apart = rules.too_close(now, self._limits)
        if AlarmKind.TOO_CLOSE not in self._limits.kinds:
            one, other, apart = one[:0], other[:0], apart[:0]
        rises, falls = self._pairs.update(one, other, apart, self._limits.too_close)
        kind = AlarmKind.TOO_CLOSE
        events = [self._begin(kind, now, i, at, j) for i, j in rises]
        return events + self._end([(kind, now.names[i], now.names[j]) for i, j in falls], at)

    def _begin(
        self, kind: AlarmKind, now: AlarmSnapshot, row: int, at: float, other: int | None = None
    ) -> AlarmEvent:
        x, y = now.xy[row].tolist()
        alarm = Alarm(
            kind,
            now.names[row],
            rules.alarm_text(kind, now, row, other),
            at,
            "" if other is None else now.names[other],
            (x, y) if np.isfinite(x) and np.isfinite(y) else None,
            unsure=(now.names[row],) if kind is AlarmKind.UNSURE and now.doubted[row] else (),
        )
        return self._put_up(alarm, at)

    def _renew_text(self, one: ReportedAlarm) -> bool:
        """Update the text of an alarm from the gateway's report, and return whether it has changed.

        The distance at which two robots pass changes all the time: the text keeps the one from when the alarm
        began, or from when one of them became unsure, or sure again.
        """
        alarm = self._alarms.get(one.key)
        if alarm is None or alarm.text == one.text or not (one.area or alarm.unsure != one.unsure):
            return False
        self._alarms[one.key] = alarm._replace(text=one.text, unsure=one.unsure)
        return True

    def _put_up(self, alarm: Alarm, at: float) -> AlarmEvent:
        before = self._alarms.get(alarm.key)
        if before is not None and before.is_new:
            alarm = alarm._replace(times=before.times + 1)
        self._alarms[alarm.key] = alarm
        return AlarmEvent(at, AlarmChange.BEGAN, alarm)

    def _end(self, keys: list[Key], at: float) -> list[AlarmEvent]:
        events = []
        for key in keys:
            alarm = self._alarms.get(key)
            if alarm is None:
                continue
            over = alarm._replace(ended=at)
            events.append(AlarmEvent(at, AlarmChange.ENDED, over))
            if alarm.is_new:
                self._alarms[key] = over
            else:
                del self._alarms[key]
        return events


def _order(alarm: Alarm) -> tuple[bool, bool, int, float]:
    return not alarm.is_new, alarm.ended is not None, URGENCY[alarm.kind], -alarm.began
