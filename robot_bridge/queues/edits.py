"""What an operator changes in a queue. Every edit returns the queue one revision further."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping, Sequence

from ..errors import RefusedError
from ..messages import QueueState, QueueTask, TaskState
from ..messages.queues import LONGEST_QUEUE
from .queue import Queue, QueuedTask


@dataclasses.dataclass(frozen=True)
class Whereabouts:
    """Where a task that was given before is: in whose queue, and what became of it there."""

    robot: str
    state: TaskState


def replaced(
    queue: Queue, tasks: Sequence[QueueTask], known: Mapping[str, Whereabouts], by: str, at: float
) -> Queue:
    """Return the queue with ``tasks`` in place of what is not begun.

    Those of this queue that are current or done are passed over; one that waits keeps its history. ``known``
    says of each task that was given before where it is. Raises RefusedError for one that is elsewhere.
    """
    waiting = {task.id: task for task in queue.waiting}
    current = queue.current
    wanted: list[QueuedTask] = []
    for task in tasks:
        found = known.get(task.task)
        if task.task in waiting:
            wanted.append(_renewed(waiting[task.task], task))
        elif found is None:
            wanted.append(QueuedTask(task, by, at))
        elif found.robot != queue.robot or found.state not in (TaskState.CURRENT, TaskState.DONE):
            raise RefusedError(_used(task.task, found))
    return _fitting(queue.with_tasks([*([current] if current else []), *wanted], edited=True))


def added(
    queue: Queue,
    tasks: Sequence[QueueTask],
    before: str | None,
    known: Mapping[str, Whereabouts],
    by: str,
    at: float,
) -> Queue:
    """Return the queue with ``tasks`` in front of task ``before``, or at its end; raises RefusedError."""
    for task in tasks:
        if task.task in known:
            raise RefusedError(_used(task.task, known[task.task]))
    new = [QueuedTask(task, by, at) for task in tasks]
    at_place = _place(queue, before)
    return _fitting(queue.with_tasks([*queue.tasks[:at_place], *new, *queue.tasks[at_place:]], edited=True))


def moved(queue: Queue, task: str, before: str | None) -> Queue:
    """Return the queue with a waiting task in front of ``before``, or at its end; raises RefusedError."""
    found = _waiting(queue, task)
    if before == task:
        return queue.with_tasks(queue.tasks, edited=True)
    rest = queue.with_tasks([other for other in queue.tasks if other.id != task])
    at_place = _place(rest, before)
    return queue.with_tasks([*rest.tasks[:at_place], found, *rest.tasks[at_place:]], edited=True)


def removed(queue: Queue, task: str) -> Queue:
    """Return the queue without a waiting task; raises RefusedError."""
    found = _waiting(queue, task)
    return queue.with_tasks([other for other in queue.tasks if other is not found], edited=True)


def put_first(queue: Queue, task: str) -> Queue:
    """Return the queue with a waiting task first, and what was current behind it; raises RefusedError."""
    found = _waiting(queue, task)
    rest = [given_back(other) for other in queue.tasks if other is not found]
    return queue.with_tasks([found, *rest], edited=True)


def resumed(queue: Queue, by: str, at: float) -> Queue:
    """Return the queue as one that goes on; raises RefusedError for one that is not paused."""
    if queue.running:
        raise RefusedError(f"the queue of robot {queue.robot!r} is not paused; there is nothing to resume")
    return dataclasses.replace(
        queue, state=QueueState.RUNNING, revision=queue.revision + 1, reason=None, by=by, at=at
    )


def given_back(task: QueuedTask, reason: str | None = None) -> QueuedTask:
    """Return a current task as one that waits to be begun anew; others are returned as they are."""
    if not task.is_current:
        return task
    return dataclasses.replace(task, state=TaskState.WAITING, leg=0, reason=reason)


def _renewed(waiting: QueuedTask, task: QueueTask) -> QueuedTask:
    """Return a waiting task as it is wanted now; with another path or place it is begun anew."""
    if waiting.task == task:
        return waiting
    return dataclasses.replace(waiting, task=task, state=TaskState.WAITING, command=None, reason=None)


def _waiting(queue: Queue, task: str) -> QueuedTask:
    found = next((other for other in queue.tasks if other.id == task), None)
    if found is None:
        raise RefusedError(
            f"task {task} is not in the queue of robot {queue.robot!r} any more; look at the queue again"
        )
    if found.is_current:
        raise RefusedError(
            f"robot {queue.robot!r} is doing task {task}; abort its command, or make another one current"
        )
    return found


def _place(queue: Queue, before: str | None) -> int:
    if before is None:
        return len(queue.tasks)
    return queue.tasks.index(_waiting(queue, before))


def _fitting(queue: Queue) -> Queue:
    if len(queue.tasks) > LONGEST_QUEUE:
        raise RefusedError(
            f"the queue of robot {queue.robot!r} would hold {len(queue.tasks)} tasks, and takes "
            f"{LONGEST_QUEUE} at most; give it the rest later"
        )
    return queue


def _used(task: str, found: Whereabouts) -> str:
    return (
        f"task {task} was given to robot {found.robot!r} before and is {found.state.value} there; "
        "what is to be done once more needs an id of its own"
    )
