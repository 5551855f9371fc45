"""Queue of tasks of a robot: its content, and the edits that operators make."""

from __future__ import annotations

import dataclasses
import itertools
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

from ...core.errors import RefusedError
from ...core.messages.queues import LONGEST_QUEUE, QueueReport, QueueState, QueueTask, TaskReport, TaskState
from ...core.messages.safety import RobotState

# --- A robot's queue as the gateway holds it, and the reports of it to operators ---

ENDS = (TaskState.DONE, TaskState.SKIPPED, TaskState.REMOVED)


@dataclass(frozen=True)
class QueuedTask:
    """A task, its progress, and the command that drives it.

    ``place`` orders the tasks of a queue; ``leg`` counts the commands of this task that were reached, and
    ``attempts`` how often it was begun. A current task without ``command`` waits for its next leg to be sent.
    """

    task: QueueTask
    added_by: str
    added_at: float
    state: TaskState = TaskState.WAITING
    place: int = 0
    leg: int = 0
    attempts: int = 0
    command: str | None = None
    began_at: float | None = None
    ended_at: float | None = None
    reason: str | None = None
    deviation: float | None = None

    @property
    def id(self) -> str:
        """The id that the desk gave it."""
        return self.task.task

    @property
    def is_current(self) -> bool:
        """Whether the robot is doing it."""
        return self.state is TaskState.CURRENT


REPORTED_ENDED = 10
"""number of ended tasks in a queue's report."""


@dataclass(frozen=True)
class Queue:
    """The open tasks of a robot in order; a current one is the first."""

    robot: str
    revision: int = 0
    state: QueueState = QueueState.RUNNING
    tasks: tuple[QueuedTask, ...] = ()
    reason: str | None = None
    by: str | None = None
    at: float | None = None

    @property
    def running(self) -> bool:
        """Whether the next task is sent automatically."""
        return self.state is QueueState.RUNNING

    @property
    def head(self) -> QueuedTask | None:
        """The task that is current, or comes next."""
        return self.tasks[0] if self.tasks else None

    @property
    def current(self) -> QueuedTask | None:
        """The task that the robot is doing."""
        return self.tasks[0] if self.tasks and self.tasks[0].is_current else None

    @property
    def waiting(self) -> tuple[QueuedTask, ...]:
        """The tasks that the robot is not doing."""
        return self.tasks[1:] if self.current else self.tasks

    def paused(self, reason: str, by: str, at: float) -> Queue:
        """Return the queue paused, one revision further; one that is paused already is unchanged."""
        if not self.running:
            return self
        return dataclasses.replace(
            self, state=QueueState.PAUSED, revision=self.revision + 1, reason=reason, by=by, at=at
        )

    def with_tasks(self, tasks: Iterable[QueuedTask], *, edited: bool = False) -> Queue:
        """Return the queue with other tasks, one revision further if an operator ``edited`` it."""
        return dataclasses.replace(self, tasks=ordered_tasks(tasks), revision=self.revision + edited)

    def with_head(self, head: QueuedTask) -> Queue:
        """Return the queue with its first task replaced."""
        return self.with_tasks((head, *self.tasks[1:]))


def ordered_tasks(tasks: Iterable[QueuedTask]) -> tuple[QueuedTask, ...]:
    """Return ``tasks`` with ascending places; ascending ones are kept, as most are after a step."""
    found = tuple(tasks)
    places = [task.place for task in found]
    if all(a < b for a, b in itertools.pairwise(places)):
        return found
    return tuple(dataclasses.replace(task, place=place) for place, task in enumerate(found))


def queue_report(
    queue: Queue, robot_state: RobotState, ended: Iterable[QueuedTask] = (), *, paths: bool = False
) -> QueueReport:
    """Return the report of a queue for operators; ``ended`` are the newest ended tasks."""
    return QueueReport(
        robot=queue.robot,
        revision=queue.revision,
        state=queue.state,
        robot_state=robot_state,
        tasks=[task_report(queue.robot, task, paths=paths) for task in queue.tasks],
        ended=[task_report(queue.robot, task, paths=paths) for task in ended],
        reason=queue.reason,
        by=queue.by,
        at=queue.at,
    )


def task_report(robot: str, queued: QueuedTask, *, paths: bool = False) -> TaskReport:
    """Return the report of a task for operators."""
    task = queued.task
    return TaskReport(
        task=task.task,
        robot=robot,
        kind=task.kind,
        state=queued.state,
        x=task.x,
        y=task.y,
        added_by=queued.added_by,
        added_at=queued.added_at,
        theta=task.theta,
        cone=task.cone,
        label=task.label,
        layout=task.layout,
        plan=task.plan,
        placement=task.placement,
        path_points=len(task.path or ()),
        path=task.path if paths else None,
        attempts=queued.attempts,
        command=queued.command,
        began_at=queued.began_at,
        ended_at=queued.ended_at,
        reason=queued.reason,
        deviation=queued.deviation,
    )


# --- Edits of a queue by operators. Every edit returns the queue one revision further ---


@dataclasses.dataclass(frozen=True)
class Whereabouts:
    """Location of a task that was submitted before: the robot with its queue, and its state there."""

    robot: str
    state: TaskState


def replace_tasks(
    queue: Queue, tasks: Sequence[QueueTask], known: Mapping[str, Whereabouts], by: str, at: float
) -> Queue:
    """Return the queue with ``tasks`` in place of those not begun.

    Those of this queue that are current or done are skipped; one that waits keeps its history. ``known``
    locates each task that was submitted before. Raises RefusedError for one that is elsewhere.
    """
    waiting = {task.id: task for task in queue.waiting}
    current = queue.current
    tasks_now: list[QueuedTask] = []
    for task in tasks:
        found = known.get(task.task)
        if task.task in waiting:
            tasks_now.append(_renewed(waiting[task.task], task))
        elif found is None:
            tasks_now.append(QueuedTask(task, by, at))
        elif found.robot != queue.robot or found.state not in (TaskState.CURRENT, TaskState.DONE):
            raise RefusedError(_used(task.task, found))
    return _fitting(queue.with_tasks([*([current] if current else []), *tasks_now], edited=True))


def add_tasks(
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


def move_task(queue: Queue, task: str, before: str | None) -> Queue:
    """Return the queue with a waiting task in front of ``before``, or at its end; raises RefusedError."""
    found = _waiting(queue, task)
    if before == task:
        return queue.with_tasks(queue.tasks, edited=True)
    rest = queue.with_tasks([other for other in queue.tasks if other.id != task])
    at_place = _place(rest, before)
    return queue.with_tasks([*rest.tasks[:at_place], found, *rest.tasks[at_place:]], edited=True)


def remove_task(queue: Queue, task: str) -> Queue:
    """Return the queue without a waiting task; raises RefusedError."""
    found = _waiting(queue, task)
    return queue.with_tasks([other for other in queue.tasks if other is not found], edited=True)


def move_task_first(queue: Queue, task: str) -> Queue:
    """Return the queue with a waiting task first, and the current one behind it; raises RefusedError."""
    found = _waiting(queue, task)
    rest = [return_task(other) for other in queue.tasks if other is not found]
    return queue.with_tasks([found, *rest], edited=True)


def resume_queue(queue: Queue, by: str, at: float) -> Queue:
    """Return the queue running; raises RefusedError for one that is not paused."""
    if queue.running:
        raise RefusedError(f"the queue of robot {queue.robot!r} is not paused; there is nothing to resume")
    return dataclasses.replace(
        queue, state=QueueState.RUNNING, revision=queue.revision + 1, reason=None, by=by, at=at
    )


def return_task(task: QueuedTask, reason: str | None = None) -> QueuedTask:
    """Return a current task as waiting to be begun again; others are returned unchanged."""
    if not task.is_current:
        return task
    return dataclasses.replace(task, state=TaskState.WAITING, leg=0, reason=reason)


def _renewed(waiting: QueuedTask, task: QueueTask) -> QueuedTask:
    """Return a waiting task with its new content; with another path or place it is begun again."""
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
