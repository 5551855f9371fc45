"""A robot's queue as the gateway holds it, and the reports that operators are told of it."""

from __future__ import annotations

import dataclasses
import itertools
from collections.abc import Iterable
from dataclasses import dataclass

from ..messages import QueueReport, QueueState, QueueTask, RobotState, TaskReport, TaskState

ENDS = (TaskState.DONE, TaskState.SKIPPED, TaskState.REMOVED)


@dataclass(frozen=True)
class QueuedTask:
    """A task, how far it is, and the command that drives it.

    ``place`` orders the tasks of a queue; ``leg`` counts the commands of this task that were reached, and
    ``attempts`` how often it was begun. A current task without ``command`` waits to be sent its next leg.
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
        """The id that the operator's side gave it."""
        return self.task.task

    @property
    def is_current(self) -> bool:
        """Whether the robot is doing it."""
        return self.state is TaskState.CURRENT


@dataclass(frozen=True)
class Queue:
    """The open tasks of a robot in order; one that is current is the first."""

    robot: str
    revision: int = 0
    state: QueueState = QueueState.RUNNING
    tasks: tuple[QueuedTask, ...] = ()
    reason: str | None = None
    by: str | None = None
    at: float | None = None

    @property
    def running(self) -> bool:
        """Whether the next task is sent by itself."""
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
        """Return the queue paused, one revision further; one that is paused already stays as it is."""
        if not self.running:
            return self
        return dataclasses.replace(
            self, state=QueueState.PAUSED, revision=self.revision + 1, reason=reason, by=by, at=at
        )

    def with_tasks(self, tasks: Iterable[QueuedTask], *, edited: bool = False) -> Queue:
        """Return the queue with other tasks, one revision further if an operator ``edited`` it."""
        return dataclasses.replace(self, tasks=in_order(tasks), revision=self.revision + edited)

    def with_head(self, head: QueuedTask) -> Queue:
        """Return the queue with another first task in place of the present one."""
        return self.with_tasks((head, *self.tasks[1:]))


def in_order(tasks: Iterable[QueuedTask]) -> tuple[QueuedTask, ...]:
    """Return ``tasks`` with places that rise; those that rise already are kept, as most are after a step."""
    found = tuple(tasks)
    places = [task.place for task in found]
    if all(a < b for a, b in itertools.pairwise(places)):
        return found
    return tuple(dataclasses.replace(task, place=place) for place, task in enumerate(found))


def queue_report(
    queue: Queue, robot_state: RobotState, ended: Iterable[QueuedTask] = (), *, paths: bool = False
) -> QueueReport:
    """Return what operators are told of a queue; ``ended`` are the newest tasks that did."""
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
    """Return what operators are told of a task."""
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
