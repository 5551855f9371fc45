"""What an operator ordered beside a robot's queue, kept as the first task of that: it can be gone on with."""

from __future__ import annotations

import dataclasses
import uuid
from collections.abc import Sequence

from ..command_life.open_command import OpenCommand
from ..messages import QueueState, QueueTask, SetPath, SetPosEnd, TaskKind, TaskState
from ..polyline import Polyline
from .edits import given_back
from .legs import CORRIDOR, Offset, Place, cone_place
from .queue import Queue, QueuedTask


def task_of(command: OpenCommand, offset: Offset, here: Place | None) -> QueuedTask:
    """Return the task that the robot does with an open ``command`` that is of no queue.

    ``offset`` is where on this site a cone stands from its robot, ``here`` where the robot is, if that is
    known.
    """
    message, report = command.message, command.report
    assert isinstance(message, (SetPath, SetPosEnd))
    id, begun = _id("kept", report.command), report.steps[0].at
    if isinstance(message, SetPosEnd):
        task = _to_target(id, message, offset)
    else:
        task = _along(id, message if command.driven else _with_way_to_it(message, here), offset)
    return QueuedTask(
        task,
        report.operator,
        begun,
        TaskState.CURRENT,
        attempts=1,
        command=report.command,
        began_at=begun,
    )


def task_of_rest(rest: SetPath, offset: Offset, command: str, by: str, at: float) -> QueuedTask:
    """Return the task of a robot that was to be sent along ``rest`` from where ``command`` leads it."""
    return QueuedTask(_along(_id("rest", command), rest, offset), by, at)


def halted(queue: Queue, kept: Sequence[QueuedTask], reason: str, by: str, at: float) -> Queue:
    """Return the queue paused, with what is ``kept`` in front of what else is to be done."""
    tasks = (*kept, *(given_back(task) for task in queue.tasks)) if kept else queue.tasks
    return dataclasses.replace(
        queue.with_tasks(tasks, edited=True), state=QueueState.PAUSED, reason=reason, by=by, at=at
    )


def _id(what: str, command: str) -> str:
    """Return the id of the task that is made of a command: the same whenever that is asked."""
    return str(uuid.uuid5(uuid.NAMESPACE_OID, f"{command} {what}"))


def _to_target(id: str, target: SetPosEnd, offset: Offset) -> QueueTask:
    kind, x, y = _kind(target), target.x, target.y
    if kind is not TaskKind.DRIVE and target.theta is not None:
        x, y = cone_place((x, y, target.theta), offset)
    return QueueTask(id, x, y, target.theta, kind)


def _along(id: str, path: SetPath, offset: Offset) -> QueueTask:
    """Return the task of a path; where a cone of it stands off its robot, the path leads up to the cone."""
    x, y = path.points[-1]
    kind = _kind(path)
    if kind is TaskKind.DRIVE or offset == (0.0, 0.0) or path.theta is None:
        return QueueTask(id, x, y, path.theta, kind, path=path.points)
    x, y = cone_place((x, y, path.theta), offset)
    return QueueTask(id, x, y, path.theta, kind, path=[*path.points, (x, y)])


def _kind(end: SetPath | SetPosEnd) -> TaskKind:
    """Return what a robot does at the end of what it was sent."""
    if end.cone:
        return TaskKind.PLACE
    return TaskKind.COLLECT if end.collect else TaskKind.DRIVE


def _with_way_to_it(path: SetPath, here: Place | None) -> SetPath:
    """Return a path with the straight way to its beginning, for a robot that has not come to any of it."""
    if here is None or Polyline(path.points).feet(*here)[1].min() <= CORRIDOR:
        return path
    return dataclasses.replace(path, points=[here, *path.points])
