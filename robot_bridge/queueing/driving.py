"""Sends robots the tasks of their queues, one after the other.

What is to be done is seen from what is stored, never from what was heard: so a gateway that was killed goes
on where it stopped, and a task that was sent is known as sent. A task and the command that drives it are
written in one transaction.
"""

from __future__ import annotations

import asyncio
import logging
from collections.abc import Callable
from functools import partial

from sqlalchemy import Connection

from ..command_life.open_command import Order
from ..command_life.states import is_open
from ..commanding.writing import Also, AlsoOf
from ..errors import OutdatedError, RefusedError, StoreError
from ..messages import (
    CommandReport,
    CommandState,
    QueueTask,
    RobotState,
    SetPath,
    SetPosEnd,
    SetPosIni,
    TaskKind,
)
from ..messages.queues import check_path
from ..monitoring.unforeseen import note_unforeseen
from ..places import crossing
from ..queues import life
from ..queues.legs import legs, path_left, to_the_end
from ..queues.life import Path
from ..queues.queue import Queue, QueuedTask
from ..robots import AWAY
from ..store import commands as stored_commands
from ..store import queues
from ..store.commands import StoredCommand
from .context import QueueContext
from .precedence import Precedence
from .settling import QueueSettling

log = logging.getLogger(__name__)

LOOK_INTERVAL = 1.0
"""seconds after which every queue with something to do is looked at, whether anything was heard or not."""


class QueueDriving:
    """Keeps the robots' queues going."""

    def __init__(self, context: QueueContext) -> None:
        self._site = context.site
        self._robots = context.robots
        self._commands = context.commands
        self._book = context.book
        self._settling = QueueSettling(context)
        self._precedence = Precedence(context.book, context.database)
        self._planner = context.planner
        self._database = context.database
        self._clock = context.clock
        self._due: set[str] = set()
        self._event = asyncio.Event()
        self._sending: set[str] = set()
        self._told: dict[str, RobotState] = {}
        self._returned: set[str] = set()
        """robots that are back after nobody had heard them for long."""
        self.waits_for: Callable[[str, str], str | None] = lambda _robot, _task: None
        """Tells whom a robot is to let pass before it is sent a task, None for nobody."""
        context.book.due = self.look
        context.robots.is_back = self._is_back

    async def run(self) -> None:
        """Keep them going until cancelled."""
        while True:
            try:
                async with asyncio.timeout(LOOK_INTERVAL):
                    await self._event.wait()
            except TimeoutError:
                self.look_at_all()
            await self.advance()

    def look(self, robot: str) -> None:
        """Look at a robot's queue soon."""
        self._due.add(robot)
        self._event.set()

    def note_step(self, report: CommandReport) -> None:
        """Note what became of a command; called with each step of every one."""
        queue = self._book.get(report.robot)
        head = queue.head
        if head is None:
            return
        if report.command == head.command:
            if not is_open(report.state):
                self.look(report.robot)
        elif report.state is CommandState.QUEUED and self._is_beside(queue, report):
            # It has paused the queue in its own transaction.
            self._book.doubt(report.robot)

    def look_at_all(self) -> None:
        """Look at every queue that has something to do; tell of robots that are lost, or back."""
        for robot in self._book.names():
            queue = self._book.get(robot)
            if self._book.is_doubtful(robot):
                self.look(robot)
            if not queue.tasks:
                self._told.pop(robot, None)
                continue
            state = self._robots.get(robot).state
            if self._told.setdefault(robot, state) is not state:
                self._told[robot] = state
                self._book.announce(robot)
            if queue.running or queue.current is not None:
                self.look(robot)

    async def advance(self) -> None:
        """Do what is due now: settle what has ended, send what comes next."""
        self._event.clear()
        due, self._due = self._due, set()
        # A robot that was removed has a queue still, should it come back.
        await asyncio.gather(*(self._advance(robot) for robot in sorted(due) if robot in self._robots))

    async def redirect(
        self, robot: str, path: SetPath, operator: str, reason: str | None = None
    ) -> CommandReport | None:
        """Send the robot to the end of its present task by another path; its queue goes on.

        Return the command that does it, None when the robot is not doing a task of its queue. Raises
        MessageError for a path that ends elsewhere, RefusedError and StoreError.
        """
        async with self._book.holding([robot]):
            queue, current = self._book.get(robot), self._current(robot)
            if current is None:
                return None
            check_path(current.id, path.points, (current.task.x, current.task.y))
            after = life.redirected(queue, path.points)
            message = legs(after.tasks[0].task, self._site.settings.cones.offset)[0]
            return await self._send(queue, after, message, operator, reason, current.command)

    async def stop_over(self, robot: str, first: Path, rest: Path, other: str, by: str, also: AlsoOf) -> str:
        """Send the robot along ``first`` only, as a task of its own; the task that it does waits behind that.

        It is begun anew along ``rest`` as soon as :attr:`waits_for` lets it. ``also`` is written in the same
        transaction. Return the id of the command. Raises MessageError for a ``rest`` that ends elsewhere,
        RefusedError for a robot that does no task of its queue any more, and StoreError.
        """
        async with self._book.holding([robot]):
            queue = self._book.get(robot)
            current = self._current(robot)
            if current is None:
                raise RefusedError(f"robot {robot!r} has been told otherwise in the meantime")
            check_path(current.id, rest, (current.task.x, current.task.y))
            label = f"waits for {other}"
            after = life.stopping_over(queue, first, rest, label, by, self._clock())
            report = await self._send(queue, after, SetPath(first), by, label, current.command, also)
            return report.command

    def current(self, robot: str) -> QueueTask | None:
        """Return the task of its queue that the robot does, None where it does none of it."""
        current = self._current(robot)
        return None if current is None else current.task

    def to_the_end(self, task: QueueTask, left: Path) -> Path:
        """Return what is ``left`` of the path that was sent for a task, up to the task's place."""
        return to_the_end(task, self._site.settings.cones.offset, left)

    def _current(self, robot: str) -> QueuedTask | None:
        current = self._book.get(robot).current
        if current is None or current.command is None or not self._commands.is_open(current.command):
            return None
        return current

    # --------------------------------------------------------------------------------------------------

    async def _advance(self, robot: str) -> None:
        try:
            async with self._book.holding([robot]):
                await self._settling.settle(self._book.get(robot))
                await self._hold_back(self._book.get(robot))
                await self._go_on(self._book.get(robot))
        except OutdatedError:
            self.look(robot)
        except StoreError as error:
            log.error("queue of %s: %s; it is looked at again", robot, error)
        except Exception:
            # The queues of all other robots go on.
            note_unforeseen(log, f"queue of {robot}; it is looked at again")

    def _is_back(self, robot: str, away: float) -> None:
        queue = self._book.get(robot)
        if away > self._longest_silence and queue.running and queue.tasks:
            self._returned.add(robot)
            self.look(robot)

    @property
    def _longest_silence(self) -> float:
        return self._site.settings.commands.expire_after_s

    async def _hold_back(self, queue: Queue) -> None:
        """Pause the queue of a robot that was not heard for long, so that it does not set off by surprise.

        Whether it was away itself, its link or the gateway: nobody saw what became of its surroundings.
        """
        robot = self._robots.get(queue.robot)
        is_away = robot.state in AWAY and self._clock() - robot.received_at > self._longest_silence
        if (is_away or robot.name in self._returned) and queue.running and queue.tasks:
            reason = (
                f"the robot was not heard for longer than {self._longest_silence:g} s, or no gateway was "
                "there to hear it; resume when it may drive again"
            )
            await self._book.save(queue, queue.paused(reason, life.GATEWAY, self._clock()))
        self._returned.discard(robot.name)

    def _is_beside(self, queue: Queue, report: CommandReport) -> bool:
        return queue.running and report.op != SetPosIni.__name__ and report.command not in self._sending

    # --- what comes next ------------------------------------------------------------------------------

    async def _go_on(self, queue: Queue) -> None:
        """Send what comes next, or pause, saying why it cannot be sent."""
        head = queue.head
        if head is None or not queue.running or (head.is_current and head.command is not None):
            return
        if self._robots.get(queue.robot).state in AWAY:
            return
        if (why := await self._why_not_yet(queue.robot, head)) is not None:
            if head.reason != why:
                await self._book.save(queue, life.waits(queue, why))
            return
        busy, own = self._commands.busy_with(queue.robot), {task.command for task in queue.tasks}
        try:
            if busy is not None and busy not in own:
                raise RefusedError(f"the robot is busy with command {busy}, which is not of its queue")
            message = await self._message(queue, head)
            await self._send(queue, life.sent(queue, self._clock()), message, head.added_by)
        except OutdatedError:
            raise
        except RefusedError as error:
            await self._book.save(queue, life.held(queue, str(error), self._clock()))

    async def _why_not_yet(self, robot: str, head: QueuedTask) -> str | None:
        """Return why what comes next is not sent yet, None when it may be; raises StoreError."""
        if self._is_stopping(robot, head):
            return life.STOPS_FIRST
        other = self.waits_for(robot, head.id)
        if other is not None:
            return f"waits for {other}"
        known = self._robots.get(robot)
        finds_way = self._planner.has_roads and not known.asks_path
        if not known.located and (head.task.path is not None or finds_way):
            # Where it is now its path begins.
            return "waits for the robot to say where it is"
        # What was begun is not given up because of what another robot does.
        return None if head.is_current else await self._precedence.waits_for(robot, head.task)

    def _is_stopping(self, robot: str, head: QueuedTask) -> bool:
        """Tell whether the robot is to stop first: it was resumed before it has said that it did.

        By then it may be done with its task, and what it is sent meanwhile would be ended by that Abort if it
        came to read that last.
        """
        was_begun = not head.is_current and head.command is not None and self._commands.is_open(head.command)
        return was_begun or self._commands.awaits_abort(robot)

    async def _message(self, queue: Queue, head: QueuedTask) -> SetPath | SetPosEnd:
        message = legs(head.task, self._site.settings.cones.offset)[head.leg]
        if not isinstance(message, SetPath):
            return await self._with_way(queue.robot, head, message)
        pose = self._robots.get(queue.robot).pose
        assert pose is not None
        before = None if head.command is None else await self._stored(head.command)
        driven = 0.0 if before is None else before.driven or 0.0
        join = before is not None or head.task.kind is not TaskKind.DRIVE
        return path_left(message, (pose.x, pose.y), driven, join=join)

    async def _with_way(self, robot: str, head: QueuedTask, target: SetPosEnd) -> SetPath | SetPosEnd:
        """Return what sends a robot to a target without a path: along the roads from where it is now.

        It is the bare target for a robot that asks for its path, at the end of a task's path, and where no
        roads are near. A robot that does not take cones with a path drives straight to them.

        :raises RefusedError: when no way leads there, or the straight one leads through a keepout.
        """
        start = self._robots.straight_from(robot, target)
        if start is None or head.leg > 0:
            return target
        carries = target.cone or target.collect
        if self._planner.has_roads and (not carries or self._robots.get(robot).places_on_paths):
            planned = await asyncio.to_thread(self._planner.path, start, (target.x, target.y))
            if planned.along_roads:
                return SetPath(list(planned.points), target.theta, target.cone or None, target.collect)
        straight = [start, (target.x, target.y)]
        crossed = await asyncio.to_thread(self._site.keepouts_crossed, [straight])
        if crossed:
            raise RefusedError(f"{crossing(straight, crossed[0])}; give the task a path around it")
        return target

    async def _send(
        self,
        before: Queue,
        after: Queue,
        message: SetPath | SetPosEnd,
        operator: str,
        reason: str | None = None,
        instead_of: str | None = None,
        also: AlsoOf | None = None,
    ) -> CommandReport:
        task = after.tasks[0]
        assert task.command is not None
        what = f"task {task.id}" if reason is None else f"task {task.id}: {reason}"
        told = (task.command, before.robot, message, operator, what)
        order = Order(*told, task=task.id, instead_of=instead_of)
        self._sending.add(order.command)
        try:
            more = None if also is None else also(order.command)
            issuing = self._commands.issue([order], partial(_save, before, after, more))
            (report,) = await self._book.stored([before.robot], issuing)
        finally:
            self._sending.discard(order.command)
        self._book.accept(after)
        return report

    async def _stored(self, command: str) -> StoredCommand | None:
        return (await self._database.run(stored_commands.find_all, [command])).get(command)


def _save(before: Queue, after: Queue, also: Also | None, connection: Connection) -> None:
    queues.save(connection, before, after)
    if also is not None:
        also(connection)
