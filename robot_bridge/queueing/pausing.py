"""A robot that is to stand and go on later, whatever it is doing and whoever ordered it.

The protocol has no pause: the robot is told to abort, and what it was doing waits at the head of its queue,
which is paused. Resumed, the queue sends it on from where it stands by then.
"""

from __future__ import annotations

import uuid
from collections.abc import Callable
from functools import partial

from ..command_life.open_command import OpenCommand, Order, because
from ..errors import RefusedError
from ..messages import Abort, PauseRobot, QueueReport, SetPath, SetPosEnd
from ..queues.keeping import halted, task_of, task_of_rest
from ..queues.queue import Queue, QueuedTask
from ..store import queues
from ..store.closures import HoldRow
from .context import QueueContext

_TRIES = 3
"""So often it is looked what a robot does that is told otherwise in between."""


class RobotPauses:
    """Pauses robots. ``waiting`` tells how a robot waits for another, and what it is to drive afterwards."""

    def __init__(self, context: QueueContext, waiting: Callable[[str], HoldRow | None]) -> None:
        self._site = context.site
        self._robots = context.robots
        self._commands = context.commands
        self._book = context.book
        self._clock = context.clock
        self._waiting = waiting

    async def pause(self, request: PauseRobot, operator: str) -> QueueReport:
        """Let a robot stand, and keep what it was doing; return its queue when that is stored.

        Asked again it changes nothing. Raises RefusedError for a robot that is not known, MessageError for a
        path that is too long to be kept, and StoreError.
        """
        self._robots.check_known(request.robot)
        async with self._book.holding([request.robot]):
            for _ in range(_TRIES - 1):
                try:
                    return await self._pause(request, operator)
                except RefusedError:
                    # Something came in between: its task ended, or it was given another one.
                    continue
            return await self._pause(request, operator)

    async def _pause(self, request: PauseRobot, operator: str) -> QueueReport:
        robot, queue = request.robot, self._book.get(request.robot)
        reason, now = because(f"paused by {operator}", request.reason), self._clock()
        doing = self._commands.carried_out(robot)
        own = None if doing is None else _task_by(queue, doing.report.command)
        kept = self._kept(robot, doing) if own is None else []
        if own is None and not kept:
            return await self._book.save(queue, queue.paused(reason, operator, now))
        after = halted(queue, kept, reason, operator, now)
        abort = Order(
            str(uuid.uuid4()),
            robot,
            Abort(),
            operator,
            because("paused", request.reason),
            aborts=None if doing is None else doing.report.command,
            task=(own or kept[0]).id,
        )
        write = partial(queues.save, before=queue, after=after)
        await self._book.stored([robot], self._commands.issue([abort], write))
        return self._book.accept(after)

    def _kept(self, robot: str, doing: OpenCommand | None) -> list[QueuedTask]:
        """Return as tasks what the robot does beside its queue, and is to do after another has passed."""
        kept, known, row = [], self._robots.get(robot), self._waiting(robot)
        if doing is not None:
            here = (known.pose.x, known.pose.y) if known.located and known.pose is not None else None
            kept.append(task_of(doing, self._site.settings.cones.offset, here))
        # A target that is waited on the way to, or a task of the queue, is kept as a whole already.
        if row is not None and row.task is None and not (doing and isinstance(doing.message, SetPosEnd)):
            rest, offset = SetPath(**row.rest), self._site.settings.cones.offset
            kept.append(task_of_rest(rest, offset, row.command, row.by, self._clock()))
        return kept


def _task_by(queue: Queue, command: str) -> QueuedTask | None:
    """Return the task of the queue that a command drives."""
    return next((task for task in queue.tasks if task.command == command), None)
