"""Alarms in words."""

from __future__ import annotations

import numpy as np

from ...language import tr
from .alarm import Alarm, AlarmChange
from .rules import Situation
from .thresholds import AlarmKind

KINDS = {
    AlarmKind.LOST: tr("lost"),
    AlarmKind.UNSURE: tr("unsure of its place"),
    AlarmKind.IN_KEEPOUT: tr("in a keepout"),
    AlarmKind.AT_OBSTACLE: tr("at an obstacle"),
    AlarmKind.NEAR_ROBOT: tr("near a robot"),
    AlarmKind.COMES_NEAR: tr("will come near a robot"),
    AlarmKind.TOO_CLOSE: tr("too close"),
    AlarmKind.WILL_PASS: tr("will pass too near"),
    AlarmKind.OUTSIDE_SITE: tr("outside the site"),
    AlarmKind.OFF_ROAD: tr("off the road"),
    AlarmKind.STOPPED: tr("stopped unasked"),
    AlarmKind.LOW_BATTERY: tr("low battery"),
}
CHANGES = {
    AlarmChange.BEGAN: tr("began"),
    AlarmChange.ENDED: tr("ended"),
    AlarmChange.ACKNOWLEDGED: tr("acknowledged"),
}


def text_of(kind: AlarmKind, now: Situation, row: int, other: int | None = None) -> str:
    """Return what is the matter with the robot in ``row``, or with two."""
    name = now.names[row]
    x, y = now.xy[row].tolist()
    where = tr(" at {x:.1f}, {y:.1f} m", x=x, y=y) if np.isfinite(x) and np.isfinite(y) else ""
    if kind is AlarmKind.TOO_CLOSE and other is not None:
        apart = float(np.hypot(*(now.xy[row] - now.xy[other])))
        return tr(
            "{robot} and {other} are {apart:.1f} m apart{where}",
            robot=name,
            other=now.names[other],
            apart=apart,
            where=where,
        )
    if kind is AlarmKind.LOST:
        last = tr("; last{where}", where=where) if where else ""
        return tr("{robot} is lost: nothing is heard of it{last}", robot=name, last=last)
    if kind is AlarmKind.UNSURE:
        accuracy = now.accuracy[row]
        return tr(
            "{robot} does not know its place: ± {accuracy:.1f} m{where}",
            robot=name,
            accuracy=accuracy,
            where=where,
        )
    if kind is AlarmKind.LOW_BATTERY:
        return tr("{robot} has {part:.0%} of its battery left", robot=name, part=now.battery[row])
    if kind is AlarmKind.STOPPED:
        return tr("{robot} has a task and stands{where}", robot=name, where=where)
    if kind is AlarmKind.OUTSIDE_SITE:
        return tr("{robot} is outside the site{where}", robot=name, where=where)
    return tr("{robot} is off the road{where}", robot=name, where=where)


def who(alarm: Alarm) -> str:
    """Return the robot, or both."""
    if not alarm.other:
        return alarm.robot
    return tr("{robot} and {other}", robot=alarm.robot, other=alarm.other)


def state_in_words(alarm: Alarm) -> str:
    """Return whether an alarm holds and was seen, as in ``new ×3`` or ``over``."""
    if not alarm.is_new:
        return tr("seen")
    state = tr("new") if alarm.ended is None else tr("over")
    return f"{state} ×{alarm.times}" if alarm.times > 1 else state
