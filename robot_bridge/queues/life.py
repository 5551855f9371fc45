"""What becomes of a task: it is sent, and its command is reached, refused, or ended by somebody."""

from __future__ import annotations

import dataclasses
import uuid
from dataclasses import dataclass

from ..command_life.open_command import because
from ..messages import CommandReport, CommandState, QueueTask, TaskState
from .edits import given_back
from .queue import Queue, QueuedTask

GATEWAY = "gateway"
STOPS_FIRST = "goes on as soon as the robot has acknowledged that it is to stop"
"""Why a task is not sent that was resumed before its robot had stopped."""
Path = list[tuple[float, float]]
"""(x, y) in metres in the site frame."""


@dataclass(frozen=True)
class Settled:
    """A queue after its current task's command has ended, and the task if that has ended with it."""

    queue: Queue
    ended: QueuedTask | None = None


def command_id(task: QueuedTask) -> str:
    """Return the id of the command for this leg of this attempt: the same after a restart."""
    return str(uuid.uuid5(uuid.NAMESPACE_OID, f"{task.id} {task.attempts} {task.leg}"))


def abort_id(task: QueuedTask) -> str:
    """Return the id of the command that ends this attempt of a task."""
    return str(uuid.uuid5(uuid.NAMESPACE_OID, f"{task.id} {task.attempts} abort"))


def sent(queue: Queue, at: float) -> Queue:
    """Return the queue with its head as the current task, with the command that is to be sent."""
    head = queue.tasks[0]
    anew = not head.is_current
    head = dataclasses.replace(
        head,
        state=TaskState.CURRENT,
        attempts=head.attempts + anew,
        began_at=head.began_at or at,
        reason=None,
    )
    return queue.with_head(dataclasses.replace(head, command=command_id(head)))


def settled(queue: Queue, report: CommandReport, legs: int, *, skips: bool) -> Settled:
    """Return what comes of the end of the current task's command, one of ``legs``.

    With ``skips`` a task that a robot refuses or gives up is passed over, else the queue pauses. It goes on
    where somebody has resumed it since the command ended.
    """
    head, step = queue.tasks[0], report.steps[-1]
    if report.state is CommandState.REACHED:
        if head.leg + 1 < legs:
            return Settled(queue.with_head(dataclasses.replace(head, leg=head.leg + 1, command=None)))
        done = ended(head, TaskState.DONE, step.at, deviation=report.deviation)
        return Settled(queue.with_tasks(queue.tasks[1:]), done)
    if report.state is CommandState.FAILED:
        reason = step.reason or "the robot gave no reason"
        return failed(queue, f"robot {queue.robot} refused it or gave it up: {reason}", step.at, skips=skips)
    why = because(f"its command is {report.state.value}", step.reason)
    given = queue.with_head(given_back(head, why))
    # Resumed in the same moment it was after that: what pauses it then has done so by now.
    resumed_since = queue.at is not None and queue.at >= step.at
    return Settled(given if resumed_since else given.paused(f"task {head.id}: {why}", step.by, step.at))


def done_after_all(queue: Queue, legs: int) -> Queue | None:
    """Return the queue with its head as the current task again, if its last command was the last of ``legs``.

    A task may be given back just when its robot comes to its end: then it is not to be done once more. One
    that was made of a command has not got the id of that from here.
    """
    head = queue.tasks[0]
    last = dataclasses.replace(head, state=TaskState.CURRENT, leg=legs - 1)
    return queue.with_head(last) if legs == 1 or head.command == command_id(last) else None


def failed(queue: Queue, reason: str, at: float, *, skips: bool) -> Settled:
    """Return what comes of a failure of the task at the head of a queue."""
    head = queue.tasks[0]
    if skips:
        return Settled(queue.with_tasks(queue.tasks[1:]), ended(head, TaskState.SKIPPED, at, reason))
    head = dataclasses.replace(head, state=TaskState.FAILED, leg=0, reason=reason)
    return Settled(queue.with_head(head).paused(f"task {head.id} failed: {reason}", GATEWAY, at))


def held(queue: Queue, reason: str, at: float) -> Queue:
    """Return the queue paused before its head is sent, for a ``reason`` that the task keeps, too."""
    head = dataclasses.replace(queue.tasks[0], reason=reason)
    return queue.with_head(head).paused(reason, GATEWAY, at)


def waits(queue: Queue, reason: str) -> Queue:
    """Return the queue with the ``reason`` why its head is not sent yet; it goes on by itself."""
    return queue.with_head(dataclasses.replace(queue.tasks[0], reason=reason))


def ended(
    task: QueuedTask,
    state: TaskState,
    at: float,
    reason: str | None = None,
    deviation: float | None = None,
) -> QueuedTask:
    """Return a task at its end."""
    return dataclasses.replace(task, state=state, ended_at=at, reason=reason, deviation=deviation)


def measured(task: QueuedTask, deviation: float) -> QueuedTask:
    """Return a task with how many metres its cone is off."""
    return dataclasses.replace(task, deviation=deviation)


def stopping_over(queue: Queue, first: Path, rest: Path, label: str, by: str, at: float) -> Queue:
    """Return the queue whose current task's path is driven in two parts, the first as a task of its own.

    The task itself waits behind that, to be begun anew along ``rest``.
    """
    x, y = first[-1]
    stop = QueuedTask(QueueTask(str(uuid.uuid4()), x, y, path=first, label=label), by, at)
    head = given_back(queue.tasks[0], label)
    head = dataclasses.replace(head, task=dataclasses.replace(head.task, path=rest), command=None)
    return sent(queue.with_tasks([stop, head, *queue.tasks[1:]], edited=True), at)


def redirected(queue: Queue, path: Path) -> Queue:
    """Return the queue whose current task is driven anew, along another path to the same place."""
    head = queue.tasks[0]
    task = dataclasses.replace(head.task, path=path)
    head = dataclasses.replace(head, task=task, leg=0, attempts=head.attempts + 1)
    return queue.with_head(dataclasses.replace(head, command=command_id(head)))
