"""The alarms that there are, and the log of those that there were."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterable

import numpy as np

from ..picture import Gone
from .alarm import Alarm, AlarmChange, AlarmEvent, Key
from .latches import PairLatch, RowLatch
from .reported import Reported
from .rules import RULES, Situation, too_close
from .thresholds import AlarmKind, Thresholds
from .words import text_of

MOST_EVENTS = 5000
MOST_ALARMS = 1000
ON_AFTER = 1.0
"""Seconds for which a rule holds before it is an alarm; a robot that stands has longer."""
OFF_AFTER = 1.0
GONE_AFTER = 2.0
"""Seconds without a report after which a reported alarm is over: a conflict at its limit comes and goes."""
URGENCY = {kind: number for number, kind in enumerate(AlarmKind)}


class AlarmBoard:
    """Looks at one situation after the other. ``moment`` is on the monotonic clock, ``at`` since 1970."""

    def __init__(self, limits: Thresholds | None = None) -> None:
        self._limits = limits or Thresholds()
        self._rows = {kind: RowLatch() for kind in RULES}
        self._pairs = PairLatch()
        self._reported: dict[Key, float] = {}
        """The alarms that the gateway judges, with when each was reported last."""
        self._alarms: dict[Key, Alarm] = {}
        self._ordered: list[Alarm] | None = []
        self.log: deque[AlarmEvent] = deque(maxlen=MOST_EVENTS)

    @property
    def limits(self) -> Thresholds:
        """The settings."""
        return self._limits

    def alarms(self) -> list[Alarm]:
        """Return those to be shown: new ones first, what holds before what is over, pressing ones first."""
        if self._ordered is None:
            # Bar, panel, table and details ask at each change: with a thousand alarms that is to be felt.
            self._ordered = sorted(self._alarms.values(), key=_order)
        return self._ordered.copy()

    def of(self, robot: str) -> list[Alarm]:
        """Return the alarms that a robot is part of, pressing ones first."""
        return [alarm for alarm in self.alarms() if robot in (alarm.robot, alarm.other)]

    def look(self, now: Situation, moment: float, at: float) -> list[AlarmEvent]:
        """Judge a situation and return what changed by it."""
        events = []
        for kind, rule in RULES.items():
            holds, over = rule(now, self._limits)
            if kind not in self._limits.kinds:
                holds, over = np.zeros_like(holds), np.ones_like(over)
            wait = self._limits.stopped_after if kind is AlarmKind.STOPPED else ON_AFTER
            rises, falls = self._rows[kind].update(holds, over, moment, wait, OFF_AFTER)
            events += [self._begin(kind, now, row, at) for row in rises.tolist()]
            events += self._end([(kind, now.names[row], "") for row in falls.tolist()], at)
        events += self._look_at_pairs(now, at)
        self.log.extend(events)
        self._let_go()
        if events:
            self._ordered = None
        return events

    def report(self, reported: Iterable[Reported], moment: float, at: float) -> tuple[list[AlarmEvent], bool]:
        """Take in what the gateway reports now; return what changed by it, and whether a text did."""
        events, renewed = [], False
        for one in reported:
            if one.kind not in self._limits.kinds:
                continue
            if one.key not in self._reported:
                began = at if one.began is None else one.began
                alarm = Alarm(one.kind, one.robot, one.text, began, one.other, one.xy, area=one.area)
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

    def set_limits(self, limits: Thresholds) -> None:
        """Judge by other settings from the next look on."""
        self._limits = limits

    def acknowledge(self, keys: Iterable[Key], by: str, at: float) -> list[AlarmEvent]:
        """Note that somebody has seen these alarms; those that are over go."""
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
        """Forget the robots and their alarms: they are another site's. The log stays."""
        self._rows = {kind: RowLatch() for kind in RULES}
        self._pairs = PairLatch()
        self._reported.clear()
        self._alarms.clear()
        self._ordered = None

    def drop(self, gone: Gone) -> None:
        """Forget robots that are there no more, with their alarms. The log stays."""
        for latch in (*self._rows.values(), self._pairs):
            latch.drop(gone.rows)
        for key, alarm in list(self._alarms.items()):
            if {alarm.robot, alarm.other} & gone.names:
                del self._alarms[key]
                self._reported.pop(key, None)
        self._ordered = None

    def _let_go(self) -> None:
        """Leave what is over to the log where nobody has acknowledged anything for a long time."""
        too_many = len(self._alarms) - MOST_ALARMS
        if too_many > 0:
            over = (alarm for alarm in self._alarms.values() if alarm.ended is not None)
            for alarm in sorted(over, key=lambda alarm: alarm.began)[:too_many]:
                del self._alarms[alarm.key]

    def _look_at_pairs(self, now: Situation, at: float) -> list[AlarmEvent]:
        one, other, apart = too_close(now, self._limits)
        if AlarmKind.TOO_CLOSE not in self._limits.kinds:
            one, other, apart = one[:0], other[:0], apart[:0]
        rises, falls = self._pairs.update(one, other, apart, self._limits.too_close)
        kind = AlarmKind.TOO_CLOSE
        events = [self._begin(kind, now, i, at, j) for i, j in rises]
        return events + self._end([(kind, now.names[i], now.names[j]) for i, j in falls], at)

    def _begin(
        self, kind: AlarmKind, now: Situation, row: int, at: float, other: int | None = None
    ) -> AlarmEvent:
        x, y = now.xy[row].tolist()
        alarm = Alarm(
            kind,
            now.names[row],
            text_of(kind, now, row, other),
            at,
            "" if other is None else now.names[other],
            (x, y) if np.isfinite(x) and np.isfinite(y) else None,
        )
        return self._put_up(alarm, at)

    def _renew_text(self, one: Reported) -> bool:
        """Let an alarm say what the gateway says of it now, and return whether that is something else.

        How near two robots pass changes all the time: that stays as it was when the alarm began.
        """
        alarm = self._alarms.get(one.key)
        if alarm is None or alarm.text == one.text or not one.area:
            return False
        self._alarms[one.key] = alarm._replace(text=one.text)
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
