"""Taking over: what waits in one robot's queue goes into others', none of it lost and none twice."""

from __future__ import annotations

import dataclasses
from collections import Counter
from collections.abc import Mapping

from ..command_life.open_command import because
from ..counting import counted
from ..errors import RefusedError
from ..messages import Share, TakeOver, TaskKind
from ..messages.queues import check_path
from .edits import given_back
from .queue import Queue, QueuedTask


def taken_over(queues: Mapping[str, Queue], request: TakeOver, by: str, at: float) -> dict[str, Queue]:
    """Return the queues as they are after ``request``; all that it names are in ``queues``.

    :raises RefusedError: when a task would be lost, or be there twice; MessageError for a path.
    """
    giver = queues[request.robot]
    taken = takes_current(giver, request) is not None
    given = [given_back(task) for task in giver.tasks] if taken else list(giver.waiting)
    pool = {task.id: (giver.robot, task) for task in given}
    for share in request.shares:
        pool.update({task.id: (share.robot, task) for task in queues[share.robot].waiting})
    _check_complete([wanted.task for share in request.shares for wanted in share.tasks], pool)
    after = {share.robot: _with_share(queues[share.robot], share, pool) for share in request.shares}
    reason = because("its tasks were taken over", request.reason)
    kept = [task for task in giver.tasks if task.id not in pool]
    # Pausing makes a new revision already.
    left = giver.with_tasks(kept, edited=not giver.running).paused(reason, by, at)
    return {**after, giver.robot: left}


def takes_current(giver: Queue, request: TakeOver) -> QueuedTask | None:
    """Return the task that the giving robot is doing, if another one is to do it."""
    current = giver.current
    shared = (wanted.task for share in request.shares for wanted in share.tasks)
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
    for wanted in share.tasks:
        owner, task = pool[wanted.task]
        tasks.append(_adopted(task, wanted.path, moves=owner != share.robot))
    return queue.with_tasks(tasks, edited=True)


def _adopted(task: QueuedTask, path: list[tuple[float, float]] | None, *, moves: bool) -> QueuedTask:
    """Return a task with its new path; one that comes from another robot is begun anew."""
    if path is not None:
        check_path(task.id, path, (task.task.x, task.task.y))
    if path is None and (not moves or task.task.kind is TaskKind.DRIVE):
        path = task.task.path
    if not moves and path == task.task.path:
        return task
    # The command of another robot must not be taken for this one's.
    spec = dataclasses.replace(task.task, path=path)
    return dataclasses.replace(task, task=spec, leg=0, command=None)
