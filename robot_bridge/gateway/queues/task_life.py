"""States of a task, and the commands that it is sent as."""

from __future__ import annotations

import dataclasses
import math
import uuid
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from ...core.errors import RefusedError, counted
from ...core.geometry import Polyline
from ...core.messages.commands import CommandReport, CommandState
from ...core.messages.queues import QueueState, QueueTask, Share, TakeOver, TaskKind, TaskState, check_path
from ...core.messages.robots import MOTIONS, SetPath, SetPosEnd
from ..commands.active_command import ActiveCommand, because
from ..model.task_queue import Queue, QueuedTask, return_task

# --- States of a task: it is sent, and its command is reached, refused, or ended by an operator ---

GATEWAY = "gateway"
STOPS_FIRST = "goes on as soon as the robot has acknowledged that it is to stop"
"""Reason why a task that was resumed before its robot had stopped is not sent yet."""
Path = list[tuple[float, float]]
"""(x, y) in metres in the site frame."""


@dataclass(frozen=True)
class SettledTask:
    """A queue after the end of its current task's command, and the task if it has ended, too."""

    queue: Queue
    ended: QueuedTask | None = None


def command_id(task: QueuedTask) -> str:
    """Return the id of the command for this leg of this attempt: the same after a restart."""
    return str(uuid.uuid5(uuid.NAMESPACE_OID, f"{task.id} {task.attempts} {task.leg}"))


def abort_id(task: QueuedTask) -> str:
    """Return the id of the command that ends this attempt of a task."""
    return str(uuid.uuid5(uuid.NAMESPACE_OID, f"{task.id} {task.attempts} abort"))


def mark_sent(queue: Queue, at: float) -> Queue:
    """Return the queue with its head as the current task, with the command to send."""
    head = queue.tasks[0]
    is_new_attempt = not head.is_current
    head = dataclasses.replace(
        head,
        state=TaskState.CURRENT,
        attempts=head.attempts + is_new_attempt,
        began_at=head.began_at or at,
        reason=None,
    )
    return queue.with_head(dataclasses.replace(head, command=command_id(head)))


def settle_task(queue: Queue, report: CommandReport, legs: int, *, skips: bool) -> SettledTask:
    """Return the outcome of the end of the current task's command, one of ``legs``.

    With ``skips`` a task that a robot refuses or gives up is skipped, else the queue pauses. It continues
    if an operator has resumed it since the command ended.
    """
    head, step = queue.tasks[0], report.steps[-1]
    if report.state is CommandState.REACHED:
        if head.leg + 1 < legs:
            return SettledTask(queue.with_head(dataclasses.replace(head, leg=head.leg + 1, command=None)))
        done = end_task(head, TaskState.DONE, step.at, deviation=report.deviation)
        return SettledTask(queue.with_tasks(queue.tasks[1:]), done)
    if report.state is CommandState.FAILED:
        reason = step.reason or "the robot gave no reason"
        return mark_failed(
            queue, f"robot {queue.robot} refused it or gave it up: {reason}", step.at, skips=skips
        )
    why = because(f"its command is {report.state.value}", step.reason)
    given = queue.with_head(return_task(head, why))
    # Resumed at the same time counts as after: a pause by the command would have been stored by now.
    resumed_since = queue.at is not None and queue.at >= step.at
    return SettledTask(given if resumed_since else given.paused(f"task {head.id}: {why}", step.by, step.at))


def done_after_all(queue: Queue, legs: int) -> Queue | None:
    """Return the queue with its head as the current task again, if its last command was the last of ``legs``.

    A task may be given back just when its robot comes to its end: then it must not be done again. A task that
    was made of a command does not have a command id from here.
    """
    head = queue.tasks[0]
    last = dataclasses.replace(head, state=TaskState.CURRENT, leg=legs - 1)
    return queue.with_head(last) if legs == 1 or head.command == command_id(last) else None


def mark_failed(queue: Queue, reason: str, at: float, *, skips: bool) -> SettledTask:
    """Return the outcome of a failure of the task at the head of a queue."""
    head = queue.tasks[0]
    if skips:
        return SettledTask(queue.with_tasks(queue.tasks[1:]), end_task(head, TaskState.SKIPPED, at, reason))
    head = dataclasses.replace(head, state=TaskState.FAILED, leg=0, reason=reason)
    return SettledTask(queue.with_head(head).paused(f"task {head.id} failed: {reason}", GATEWAY, at))


def pause_before_head(queue: Queue, reason: str, at: float) -> Queue:
    """Return the queue paused before its head is sent; the task keeps the ``reason``, too."""
    head = dataclasses.replace(queue.tasks[0], reason=reason)
    return queue.with_head(head).paused(reason, GATEWAY, at)


def mark_waiting(queue: Queue, reason: str) -> Queue:
    """Return the queue with the ``reason`` why its head is not sent yet; it continues by itself."""
    return queue.with_head(dataclasses.replace(queue.tasks[0], reason=reason))


def end_task(
    task: QueuedTask,
    state: TaskState,
    at: float,
    reason: str | None = None,
    deviation: float | None = None,
) -> QueuedTask:
    """Return a task as ended."""
    return dataclasses.replace(task, state=state, ended_at=at, reason=reason, deviation=deviation)


def with_deviation(task: QueuedTask, deviation: float) -> QueuedTask:
    """Return a task with the deviation of its cone in metres."""
    return dataclasses.replace(task, deviation=deviation)


def split_at_stop(queue: Queue, first: Path, rest: Path, label: str, by: str, at: float) -> Queue:
    """Return the queue with the current task's path split in two, the first part as a task of its own.

    The task itself waits after that, to be begun again along ``rest``.
    """
    x, y = first[-1]
    stop = QueuedTask(QueueTask(str(uuid.uuid4()), x, y, path=first, label=label), by, at)
    head = return_task(queue.tasks[0], label)
    head = dataclasses.replace(head, task=dataclasses.replace(head.task, path=rest), command=None)
    return mark_sent(queue.with_tasks([stop, head, *queue.tasks[1:]], edited=True), at)


def redirect_task(queue: Queue, path: Path) -> Queue:
    """Return the queue with the current task to be driven again, along another path to the same place."""
    head = queue.tasks[0]
    task = dataclasses.replace(head.task, path=path)
    head = dataclasses.replace(head, task=task, leg=0, attempts=head.attempts + 1)
    return queue.with_head(dataclasses.replace(head, command=command_id(head)))


# --- Takeover: the waiting tasks of one queue are moved to others, none lost and none duplicated ---


def transfer_tasks(queues: Mapping[str, Queue], request: TakeOver, by: str, at: float) -> dict[str, Queue]:
    """Return the queues after ``request``; all that it names are in ``queues``.

    :raises RefusedError: when a task would be lost or duplicated; MessageError for a path.
    """
    giver = queues[request.robot]
    taken = transferred_current_task(giver, request) is not None
    given = [return_task(task) for task in giver.tasks] if taken else list(giver.waiting)
    pool = {task.id: (giver.robot, task) for task in given}
    for share in request.shares:
        pool.update({task.id: (share.robot, task) for task in queues[share.robot].waiting})
    _check_complete([shared_task.task for share in request.shares for shared_task in share.tasks], pool)
    after = {share.robot: _with_share(queues[share.robot], share, pool) for share in request.shares}
    reason = because("its tasks were taken over", request.reason)
    kept = [task for task in giver.tasks if task.id not in pool]
    # Pausing makes a new revision already.
    left = giver.with_tasks(kept, edited=not giver.running).paused(reason, by, at)
    return {**after, giver.robot: left}


def transferred_current_task(giver: Queue, request: TakeOver) -> QueuedTask | None:
    """Return the current task of the giving robot, if it is to be transferred."""
    current = giver.current
    shared = (shared_task.task for share in request.shares for shared_task in share.tasks)
    return current if current is not None and current.id in shared else None


def _check_complete(shared: list[str], pool: Mapping[str, object]) -> None:
    counts = Counter(shared)
    for what, tasks in (
        ("in no share, to be lost", [task for task in pool if task not in counts]),
        ("in more than one place, to be done twice", [t for t, n in counts.items() if n > 1]),
        ("not waiting in any of these queues", [task for task in counts if task not in pool]),
    ):
        if tasks:
            raise RefusedError(
                f"shares: {counted(len(tasks), 'task')} {what}, such as {tasks[0]}; look at the queues "
                "again, and share every task that waits once"
            )


def _with_share(queue: Queue, share: Share, pool: Mapping[str, tuple[str, QueuedTask]]) -> Queue:
    current = queue.current
    tasks = [current] if current else []
    for shared_task in share.tasks:
        owner, task = pool[shared_task.task]
        tasks.append(_adopted(task, shared_task.path, moves=owner != share.robot))
    return queue.with_tasks(tasks, edited=True)


def _adopted(task: QueuedTask, path: list[tuple[float, float]] | None, *, moves: bool) -> QueuedTask:
    """Return a task with its new path; one that comes from another robot is begun again."""
    if path is not None:
        check_path(task.id, path, (task.task.x, task.task.y))
    if path is None and (not moves or task.task.kind is TaskKind.DRIVE):
        path = task.task.path
    if not moves and path == task.task.path:
        return task
    # The command of another robot must not be taken for this one's.
    spec = dataclasses.replace(task.task, path=path)
    return dataclasses.replace(task, task=spec, leg=0, command=None)


# --- The commands of a task: its path first, then the action at its end ---
# A path carries no cone (paper 1, table III: SetPath), so a cone's task with a path takes two commands.

Offset = tuple[float, float]
"""Position of a placed cone relative to its robot: metres ahead and to the left."""
Place = tuple[float, float]

CORRIDOR = 2.0
"""metres that a robot may be off a path that it is sent along."""
_LEAST = 0.05
"""least metres of path that are worth a command."""
_BRING = "drive it there, or give the task another path"


def commands_of_task(task: QueueTask, offset: Offset) -> list[SetPath | SetPosEnd]:
    """Return the commands of ``task`` in order; raises RefusedError where it cannot be driven."""
    if task.kind is TaskKind.DRIVE:
        if task.path is not None:
            return [SetPath(task.path, task.theta)]
        return [SetPosEnd(task.x, task.y, task.theta)]
    x, y = standing_place(task, offset)
    collect = True if task.kind is TaskKind.COLLECT else None
    end = SetPosEnd(x, y, task.theta, cone=task.kind is TaskKind.PLACE, collect=collect)
    path = _approach(task, math.hypot(*offset))
    return [end] if path is None else [SetPath(path), end]


def standing_place(task: QueueTask, offset: Offset) -> Place:
    """Return the robot's position for a cone at the task's place; raises RefusedError."""
    if offset == (0.0, 0.0):
        return task.x, task.y
    if task.theta is None:
        raise RefusedError(
            f"task {task.task} has no theta, and on this site a cone stands {math.hypot(*offset):.2f} m off "
            "its robot (cones of site.toml): give the heading that the robot is to stand in"
        )
    ahead, left = _turned(offset, task.theta)
    return task.x - ahead, task.y - left


def cone_place(stood: tuple[float, float, float], offset: Offset) -> Place:
    """Return the position of the cone of a robot that stands at x, y, theta."""
    x, y, theta = stood
    ahead, left = _turned(offset, theta)
    return x + ahead, y + left


def remaining_task_path(path: SetPath, here: Place, driven: float, *, join: bool) -> SetPath:
    """Return the rest of ``path`` for a robot that stands ``here`` and has ``driven`` some metres of it.

    With ``join`` it may continue from its position beside the path, else it must stand at the beginning.

    :raises RefusedError: when the robot is too far off; an operator must decide how it gets there.
    """
    away = math.dist(here, path.points[0])
    if away <= CORRIDOR and driven <= CORRIDOR:
        return path
    line = Polyline(path.points)
    if not join:
        raise RefusedError(f"the robot stands {away:.1f} m from where the path begins; {_BRING}")
    station, off = line.feet(*here)
    ahead = station >= driven - CORRIDOR
    near = ahead & (off <= CORRIDOR)
    if not near.any():
        away = min([math.dist(here, line.at(driven)), *off[ahead]])
        raise RefusedError(f"the robot stands {away:.1f} m off what is left of the path; {_BRING}")
    # Where a path passes a place twice the earlier station counts: nothing of it is left out.
    near &= station <= station[near].min() + 2 * CORRIDOR
    joint = float(station[near][off[near].argmin()])
    rest = [p for p, at in zip(path.points, line.stations, strict=True) if at > joint + _LEAST]
    return SetPath([here, *(rest or [line.end])], path.theta)


def path_to_task_end(task: QueueTask, offset: Offset, left: list[Place]) -> list[Place]:
    """Return the rest, ``left``, of the path that was sent for ``task``, extended to the task's place.

    The path of a cone's task was sent without its last metres.
    """
    short_by = 0.0 if task.kind is TaskKind.DRIVE else math.hypot(*offset)
    if short_by == 0:
        return left
    if task.path is None:
        # It was planned by the gateway, up to the robot's position for the cone.
        return [*left, (task.x, task.y)]
    line = Polyline(task.path)
    tail = [point for point, at in zip(task.path, line.stations, strict=True) if at > line.length - short_by]
    return [*left, *(tail or [line.end])]


def _approach(task: QueueTask, short_by: float) -> list[Place] | None:
    """Return the path of a cone's task without its last metres, up to the cone; None if none."""
    if task.path is None:
        return None
    if short_by == 0:
        return task.path
    line = Polyline(task.path)
    end = line.length - short_by
    if end <= _LEAST:
        return None
    kept = [point for point, at in zip(task.path, line.stations, strict=True) if at < end - _LEAST]
    return [*kept, line.at(end)]


def _turned(offset: Offset, theta: float) -> Place:
    ahead, left = offset
    cos, sin = math.cos(theta), math.sin(theta)
    return ahead * cos - left * sin, ahead * sin + left * cos


# --- Commands outside a robot's queue, kept as its first task, so that they can be continued


def task_of_command(command: ActiveCommand, offset: Offset, here: Place | None) -> QueuedTask:
    """Return the task that corresponds to an open ``command`` outside the queue.

    ``offset`` is the position of cones relative to robots on this site, ``here`` the robot's position, if
    known.
    """
    message, report = command.message, command.report
    assert isinstance(message, MOTIONS)
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
    """Return the task of a robot that was to be sent along ``rest`` from the end of ``command``."""
    return QueuedTask(_along(_id("rest", command), rest, offset), by, at)


def pause_with_task(queue: Queue, kept: Sequence[QueuedTask], reason: str, by: str, at: float) -> Queue:
    """Return the queue paused, with the ``kept`` tasks in front of the others."""
    tasks = (*kept, *(return_task(task) for task in queue.tasks)) if kept else queue.tasks
    return dataclasses.replace(
        queue.with_tasks(tasks, edited=True), state=QueueState.PAUSED, reason=reason, by=by, at=at
    )


def _id(what: str, command: str) -> str:
    """Return the id of the task that is made of a command: always the same."""
    return str(uuid.uuid5(uuid.NAMESPACE_OID, f"{command} {what}"))


def _to_target(id: str, target: SetPosEnd, offset: Offset) -> QueueTask:
    kind, x, y = _kind(target), target.x, target.y
    if kind is not TaskKind.DRIVE and target.theta is not None:
        x, y = cone_place((x, y, target.theta), offset)
    return QueueTask(id, x, y, target.theta, kind)


def _along(id: str, path: SetPath, offset: Offset) -> QueueTask:
    """Return the task of a path; for a cone placed off its robot, the path leads up to the cone."""
    x, y = path.points[-1]
    kind = _kind(path)
    if kind is TaskKind.DRIVE or offset == (0.0, 0.0) or path.theta is None:
        return QueueTask(id, x, y, path.theta, kind, path=path.points)
    x, y = cone_place((x, y, path.theta), offset)
    return QueueTask(id, x, y, path.theta, kind, path=[*path.points, (x, y)])


def _kind(end: SetPath | SetPosEnd) -> TaskKind:
    """Return the action of a robot at the end of its command."""
    if end.cone:
        return TaskKind.PLACE
    return TaskKind.COLLECT if end.collect else TaskKind.DRIVE


def _with_way_to_it(path: SetPath, here: Place | None) -> SetPath:
    """Return a path with a straight line to its beginning, for a robot that has not reached any of it."""
    if here is None or Polyline(path.points).feet(*here)[1].min() <= CORRIDOR:
        return path
    return dataclasses.replace(path, points=[here, *path.points])
