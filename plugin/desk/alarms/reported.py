"""Alarms that the gateway judges: robots in keepouts, at obstacles, in each other's way, near people."""

from __future__ import annotations

from collections.abc import Iterable
from typing import NamedTuple

from ....robot_bridge.messages import ConflictReport, Conflicts, FenceAlarm, NearnessAlarm
from ...language import tr
from .alarm import Key
from .thresholds import AlarmKind, Thresholds


class Reported(NamedTuple):
    """An alarm as long as the gateway reports it; ``xy`` is metres in the site frame.

    ``began`` is seconds since 1970, None where the desk's own time counts.
    """

    kind: AlarmKind
    robot: str
    text: str
    xy: tuple[float, float]
    other: str = ""
    area: str = ""
    began: float | None = None

    @property
    def key(self) -> Key:
        """What makes it the same alarm in the next report."""
        return self.kind, self.robot, self.other or self.area


def fence_alarms(alarms: Iterable[FenceAlarm]) -> list[Reported]:
    """Return robots in keepouts and at obstacles as alarms, with what the gateway has done."""
    found = []
    for one in alarms:
        kind = AlarmKind.IN_KEEPOUT if one.kind == "keepout" else AlarmKind.AT_OBSTACLE
        text = _fence_text(one)
        found.append(Reported(kind, one.robot, text, (one.x, one.y), area=one.name, began=one.since))
    return found


def passing_alarms(conflicts: Conflicts, limits: Thresholds) -> list[Reported]:
    """Return the robots that will pass one another too near soon, or do so now, as alarms."""
    soon = (one for one in conflicts.conflicts if one.begins - conflicts.t <= limits.pass_within)
    found = [_passing_alarm(one) for one in soon]
    # Of several meetings of the same two the soonest is told.
    return list({alarm.key: alarm for alarm in reversed(found)}.values())


def nearness_alarms(alarms: Iterable[NearnessAlarm]) -> list[Reported]:
    """Return the people and vehicles that are near robots, or will be soon, as alarms."""
    return [
        Reported(
            AlarmKind.COMES_NEAR if one.seconds else AlarmKind.NEAR_ROBOT,
            one.seen,
            _nearness_text(one),
            (one.x, one.y),
            one.robot,
            began=one.since,
        )
        for one in alarms
    ]


def _nearness_text(one: NearnessAlarm) -> str:
    names = {"seen": one.seen, "robot": one.robot, "metres": one.metres}
    if one.seconds:
        return tr(
            "{seen} comes within {metres:.1f} m of {robot} in {seconds:.0f} s", seconds=one.seconds, **names
        )
    return tr("{seen} is {metres:.1f} m from {robot}", **names)


def _passing_alarm(one: ConflictReport) -> Reported:
    # The gateway tells first who drives: when one of them has stopped it is the same alarm.
    robot, other = sorted((one.robot, one.other))
    return Reported(AlarmKind.WILL_PASS, robot, _passing_text(one), (one.x, one.y), other)


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
