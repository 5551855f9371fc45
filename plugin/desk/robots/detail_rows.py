"""What is known of one robot, as sections of names and values."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from ....robot_bridge.messages import CommandReport, QueueReport
from ...language import tr
from ..alarms.alarm import Alarm
from ..alarms.words import state_in_words
from ..command_book import asked_at, in_words, state_word
from ..last_heard import heard_in_words
from ..picture import RobotView
from ..queues.task_words import queue_in_words, task_in_words
from ..queues.task_words import state_in_words as task_state
from ..state_words import COMMAND_STATES, ROBOT_STATES
from ..wall_clock import date_and_time, time_of_day

Row = tuple[str, str]
TIMES = ("device_time", "fix_time")
"""Fields that are seconds since 1970, by the robot's own clock."""
UNITS = {
    "age": "s",
    "pose_age": "s",
    "latency": "s",
    "x": "m",
    "y": "m",
    "altitude": "m",
    "accuracy": "m",
    "v": "m/s",
    "theta": "rad",
}
MOST = 20
"""Commands and tasks that are listed."""


def state_rows(view: RobotView, task: CommandReport | None, off: str, position: str, crs: str) -> list[Row]:
    """Return how a robot is now, as the operator needs it first."""
    told = view.told
    heard = heard_in_words(ROBOT_STATES[view.state], view.age, told.get("link"))
    rows = [(tr("State"), heard)]
    if position:
        rows.append((tr("Position, {crs}", crs=crs), position))
    rows.append(
        (tr("Task"), tr("none") if task is None else f"{in_words(task)}: {COMMAND_STATES[task.state]}")
    )
    if off:
        rows.append((tr("Off path or target"), off))
    if told.get("status"):
        rows.append((tr("It says"), str(told["status"])))
    return rows


def received_rows(told: dict[str, Any]) -> list[Row]:
    """Return all that was received last, every field by its own name, nothing left out or rounded."""
    return [(name, _value(name, value)) for name, value in told.items()]


def alarm_rows(alarms: Iterable[Alarm]) -> list[Row]:
    """Return a robot's alarms."""
    return [(time_of_day(alarm.began), f"{alarm.text} ({state_in_words(alarm)})") for alarm in alarms]


def queue_rows(queue: QueueReport | None) -> list[Row]:
    """Return a robot's queue: how it stands, then its tasks."""
    if queue is None:
        return []
    rows = [(tr("Queue"), queue_in_words(queue))]
    for number, task in enumerate(queue.tasks[:MOST], 1):
        rows.append((f"{number}.", f"{task_in_words(task)}: {task_state(task)}"))
    if len(queue.tasks) > MOST:
        rows.append(("…", tr("and {more} more", more=len(queue.tasks) - MOST)))
    return rows


def command_rows(commands: Iterable[CommandReport]) -> list[Row]:
    """Return a robot's commands, newest first."""
    rows = []
    for report in commands:
        why = report.steps[-1].reason if report.steps else None
        off = "" if report.deviation is None else tr(", {metres:.2f} m off", metres=report.deviation)
        because = f": {why}" if why else ""
        what = f"{in_words(report)}: {state_word(report.op, report.state)}{off}{because}"
        told = tr("{told}, by {operator}", told=what, operator=report.operator)
        rows.append((time_of_day(asked_at(report)), told))
    return rows


def _value(name: str, value: Any) -> str:
    if name in TIMES and isinstance(value, (int, float)):
        return f"{value!r} ({date_and_time(value)})"
    unit = f" {UNITS[name]}" if name in UNITS and isinstance(value, (int, float)) else ""
    return f"{value}{unit}"
