"""Messages to and from plain JSON values."""

from __future__ import annotations

import dataclasses
import functools
from enum import Enum
from typing import Any

from .desk import CommandReport, CommandState, CommandStep, RobotReport, SiteReport
from .known_fields import known_fields
from .observations import ObservationReport, ObservationState
from .placements import PlacementReport
from .queues import QueueReport, QueueState, TaskKind, TaskReport, TaskState
from .robot_state import RobotState
from .stopping import EmergencyReport


def to_json(message: Any) -> dict[str, Any]:
    """Return a message as JSON values; what is None is left out, a bytes field is left to the payload."""
    return {
        name: value if type(value) in _PLAIN_ALREADY else _plain(value)
        for name in _names(message.__class__)
        if (value := getattr(message, name)) is not None and not isinstance(value, bytes)
    }


_PLAIN_ALREADY = frozenset({str, int, float, bool})


@functools.cache
def _names(kind: type) -> tuple[str, ...]:
    return tuple(field.name for field in dataclasses.fields(kind))


def _plain(value: Any) -> Any:
    if dataclasses.is_dataclass(value):
        return to_json(value)
    if isinstance(value, Enum):
        return value.value
    if isinstance(value, (list, tuple)):
        return [_plain(item) for item in value]
    return value


def robot_report(values: dict[str, Any]) -> RobotReport:
    """Return the report that a gateway sent as JSON; unknown fields of newer gateways are passed over."""
    return RobotReport(**{**known_fields(RobotReport, values), "state": RobotState(values["state"])})


def command_report(values: dict[str, Any]) -> CommandReport:
    """Return the command that a gateway sent as JSON."""
    steps = [
        CommandStep(**{**known_fields(CommandStep, step), "state": CommandState(step["state"])})
        for step in values.get("steps", [])
    ]
    report = CommandReport(
        **{**known_fields(CommandReport, values), "state": CommandState(values["state"]), "steps": steps}
    )
    if report.stood is None:
        return report
    x, y, theta = report.stood
    return dataclasses.replace(report, stood=(x, y, theta))


def site_report(values: dict[str, Any]) -> SiteReport:
    """Return the site that a gateway sent as JSON."""
    known = known_fields(SiteReport, values)
    return SiteReport(**{**known, "origin": tuple(values["origin"]), "bounds": tuple(values["bounds"])})


def observation_report(values: dict[str, Any]) -> ObservationReport:
    """Return the observation that a gateway sent as JSON."""
    known = known_fields(ObservationReport, values)
    return ObservationReport(**{**known, "state": ObservationState(values["state"])})


def queue_report(values: dict[str, Any]) -> QueueReport:
    """Return the queue that a gateway sent as JSON."""
    enums = {
        "state": QueueState(values["state"]),
        "robot_state": RobotState(values["robot_state"]),
        "tasks": [task_report(task) for task in values.get("tasks", [])],
        "ended": [task_report(task) for task in values.get("ended", [])],
    }
    return QueueReport(**{**known_fields(QueueReport, values), **enums})


def task_report(values: dict[str, Any]) -> TaskReport:
    """Return the task of a queue that a gateway sent as JSON."""
    typed: dict[str, Any] = {"kind": TaskKind(values["kind"]), "state": TaskState(values["state"])}
    if values.get("path") is not None:
        typed["path"] = [tuple(point) for point in values["path"]]
    return TaskReport(**{**known_fields(TaskReport, values), **typed})


def placement_report(values: dict[str, Any]) -> PlacementReport:
    """Return the placed cone that a gateway sent as JSON."""
    return PlacementReport(**known_fields(PlacementReport, values))


def emergency_report(values: dict[str, Any]) -> EmergencyReport:
    """Return how an emergency stop stands, as a gateway sent it as JSON."""
    return EmergencyReport(**known_fields(EmergencyReport, values))
