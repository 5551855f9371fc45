"""Runner of queues: sends task after task, and records the outcome of each."""

from __future__ import annotations

import asyncio
import logging
import math
from functools import partial

from sqlalchemy import Connection

from ...core.errors import DataRefusedError, OutdatedError, RefusedError, StoreError
from ...core.logs import TroubleNews, log_unforeseen
from ...core.messages.commands import CommandReport, CommandState
from ...core.messages.queues import QueueTask, TaskKind, TaskState, check_path
from ...core.messages.records import PlacementReport
from ...core.messages.robots import SetPath, SetPosEnd, SetPosIni
from ...core.messages.safety import RobotState
from ..commands.active_command import CommandOrder
from ..commands.persistence import Also, AlsoOf
from ..model.robots import AWAY
from ..model.task_queue import ENDS, Queue, QueuedTask, Whereabouts
from ..monitoring import until_tick, wait_at_most
from ..site.places import crossing
from ..storage.database import Database
from ..storage.repositories import commands as stored_commands
from ..storage.repositories import queues, records
from ..storage.repositories.commands import StoredCommand
from ..storage.repositories.records import CollectedCone, NewPlacement
from . import task_life
from .registry import QueueContext, QueueRegistry
from .task_life import Path, SettledTask, commands_of_task, cone_place, path_to_task_end, remaining_task_path

# --- Outcome of a task after the end of its command: stored with the position of its cone ---


class QueueOutcomes:
    """Settles tasks after the ends of their commands."""

    def __init__(self, context: QueueContext) -> None:
        self._site = context.site
        self._commands = context.commands
        self._registry = context.registry
        self._database = context.database
        self._clock = context.clock

    async def settle(self, queue: Queue) -> None:
        """Store the outcome of the current task's command, if that has ended."""
        await self._settle_current(queue)
        await self._settle_given_back(self._registry.get(queue.robot))

    async def _settle_current(self, queue: Queue) -> None:
        current = queue.current
        if current is None or current.command is None or self._commands.is_open(current.command):
            return
        found = (await self._database.run(stored_commands.find_all, [current.command])).get(current.command)
        if found is None:
            reason = "what its command came to is not stored any more"
            await self._registry.save(
                queue, task_life.mark_failed(queue, reason, self._clock.time(), skips=False).queue
            )
            return
        if found.report.state.is_open:
            return
        skips = self._site.settings.queues.on_failure == "skip"
        outcome = task_life.settle_task(queue, found.report, self._legs_of(current), skips=skips)
        await self._write(queue, outcome, found.report)

    async def _settle_given_back(self, queue: Queue) -> None:
        """Store the next task as done, if its robot came to its end after the task was given back."""
        head = queue.head
        if head is None or head.is_current or head.command is None or not queue.running:
            return
        found = (await self._database.run(stored_commands.find_all, [head.command])).get(head.command)
        if found is None or found.report.state is not CommandState.REACHED:
            return
        count = self._legs_of(head)
        again = task_life.done_after_all(queue, count)
        if again is not None:
            await self._write(
                queue, task_life.settle_task(again, found.report, count, skips=False), found.report
            )

    async def _write(self, before: Queue, outcome: SettledTask, report: CommandReport) -> None:
        ended, placed, collected = outcome.ended, None, None
        if ended is not None and report.state is CommandState.REACHED:
            if ended.task.kind is TaskKind.PLACE:
                placed = _placed(before.robot, ended, report, self._site.settings.cones.offset)
                ended = task_life.with_deviation(ended, placed.deviation)
            elif ended.task.kind is TaskKind.COLLECT:
                task, at = ended.task, report.steps[-1].at
                collected = CollectedCone(before.robot, at, task.placement, task.cone, task.layout)
        gone = [] if ended is None else [ended]
        write = self._registry.fenced([before], write_outcome)
        writing = self._database.run(write, before, outcome.queue, gone, placed, collected)
        written = await self._registry.stored([before.robot], writing)
        self._registry.accept(outcome.queue, gone)
        if written is not None:
            self._registry.announce_placement(written)

    def _legs_of(self, current: QueuedTask) -> int:
        try:
            return len(commands_of_task(current.task, self._site.settings.cones.offset))
        except RefusedError:
            # The site's settings have changed since; the sent command was the last one.
            return current.leg + 1


def _placed(robot: str, task: QueuedTask, report: CommandReport, offset: tuple[float, float]) -> NewPlacement:
    """Return the cone that a robot has placed by the command of ``report``."""
    requested = task.task
    assert report.stood is not None
    x, y = cone_place(report.stood, offset)
    return NewPlacement(
        task=task.id,
        robot=robot,
        command=report.command,
        planned_x=requested.x,
        planned_y=requested.y,
        x=x,
        y=y,
        theta=report.stood[2],
        deviation=math.hypot(x - requested.x, y - requested.y),
        placed_at=report.steps[-1].at,
        cone=requested.cone,
        label=requested.label,
        layout=requested.layout,
        plan=requested.plan,
    )


def write_outcome(
    connection: Connection,
    before: Queue,
    after: Queue,
    ended: list[QueuedTask],
    placed: NewPlacement | None,
    collected: CollectedCone | None,
) -> PlacementReport | None:
    """Write a task's end, and the present position of its cone."""
    queues.save(connection, before, after, ended)
    if placed is not None:
        return records.add_placed_cones(connection, placed)
    return None if collected is None else records.collect(connection, collected)


# --- Precedence: tasks that must be done before a task, by any robot, and whenever they are submitted ---

_MOST_NAMED = 2
"""Most preceding tasks that are named in a text; the others are counted."""


class TaskPrecedence:
    """Finds the preceding tasks that are not done; those once done are not queried again."""

    def __init__(self, registry: QueueRegistry, database: Database) -> None:
        self._registry = registry
        self._database = database
        self._done: set[str] = set()

    async def waits_for(self, robot: str, task: QueueTask) -> str | None:
        """Return in words the tasks that ``task`` of ``robot`` waits for, None when all of them are done.

        A task that was removed or skipped is not done: whether to wait for it is the operators' decision.
        Raises StoreError.
        """
        unfinished = [id for id in task.after or () if id not in self._done]
        if not unfinished:
            return None
        queued = {
            one.id: (name, one) for name in self._registry.names() for one in self._registry.get(name).tasks
        }
        elsewhere = [id for id in unfinished if id not in queued]
        known = await self._database.read(queues.whereabouts, elsewhere) if elsewhere else {}
        done = {id for id, found in known.items() if found.state is TaskState.DONE}
        left = [id for id in unfinished if id not in done]
        if not left:
            # It is sent now, and needs them no more.
            self._done.difference_update(task.after or ())
            return None
        self._done |= done
        reasons = []
        for id in left[:_MOST_NAMED]:
            name, one = queued.get(id, ("", None))
            reasons.append(
                _gone(id, known.get(id)) if one is None else _queued(name, one, mine=name == robot)
            )
        return _in_words(reasons, len(left))


def _in_words(reasons: list[str], count: int) -> str:
    more = f" and {count - len(reasons)} more" if count > len(reasons) else ""
    return f"waits for {', '.join(reasons)}{more}"


def _queued(robot: str, task: QueuedTask, *, mine: bool) -> str:
    name = f"cone {task.task.cone}" if task.task.cone else f"task {task.id}"
    if mine:
        return f"{name}, which comes later in this queue: move it to the front"
    if task.state is TaskState.FAILED:
        return f"{name} of {robot}, which failed"
    return f"{name} of {robot}"


def _gone(id: str, found: Whereabouts | None) -> str:
    if found is None:
        return f"task {id}, which no robot has been given"
    if found.state not in ENDS:
        # It is in the queue of a robot of another gateway.
        return f"task {id} of {found.robot}"
    return f"task {id}, which was {found.state.value} at {found.robot}: give this task anew without it"


# --- Sending the tasks of queues to their robots, one after the other ---
# The work to do is derived from the stored state, never from received messages: so a gateway that was killed
# continues where it stopped, and a task that was sent is known as sent. A task and the command that drives it
# are written in one transaction.

log = logging.getLogger(__name__)

LOOK_INTERVAL = 1.0
"""seconds after which every queue with something to do is checked, with or without new messages."""


class QueueRunner:
    """Runs the robots' queues."""

    def __init__(self, context: QueueContext) -> None:
        self._site = context.site
        self._robots = context.robots
        self._commands = context.commands
        self._registry = context.registry
        self._settling = QueueOutcomes(context)
        self._precedence = TaskPrecedence(context.registry, context.database)
        self._planner = context.planner
        self._database = context.database
        self._clock = context.clock
        self._due: set[str] = set()
        self._advancing: set[str] = set()
        self._event = asyncio.Event()
        self._sending: set[str] = set()
        self._last_states: dict[str, RobotState] = {}
        self._returned: set[str] = set()
        """robots that are back after a long silence."""
        self._waiting = context.waiting
        self._news = TroubleNews()

    async def run(self) -> None:
        """Run the queues until cancelled."""
        loop = asyncio.get_running_loop()
        look_at = loop.time() + until_tick(LOOK_INTERVAL)
        running: set[asyncio.Task[None]] = set()
        try:
            while True:
                await wait_at_most(self._event, look_at - loop.time())
                # Not only when nothing comes: in a busy fleet something always does.
                if loop.time() >= look_at:
                    self.schedule_all()
                    look_at = loop.time() + until_tick(LOOK_INTERVAL)
                for task in self._begin():
                    running.add(task)
                    task.add_done_callback(running.discard)
        finally:
            # Not by a TaskGroup, which would raise a group of errors in place of the one.
            for task in running:
                task.cancel()
            await asyncio.gather(*running, return_exceptions=True)

    def schedule(self, robot: str) -> None:
        """Schedule a check of a robot's queue."""
        self._due.add(robot)
        self._event.set()

    def note_step(self, report: CommandReport) -> None:
        """Process a step of a command; called with each step of every command."""
        queue = self._registry.get(report.robot)
        head = queue.head
        if head is None:
            return
        if report.command == head.command:
            if not report.state.is_open:
                self.schedule(report.robot)
        elif report.state is CommandState.QUEUED and self._is_beside(queue, report):
            # It has paused the queue in its own transaction.
            self._registry.doubt(report.robot)

    def schedule_all(self) -> None:
        """Schedule every queue with something to do; report queues of robots with changed liveness."""
        for robot in self._registry.names():
            queue = self._registry.get(robot)
            if self._registry.is_doubtful(robot):
                self.schedule(robot)
            if not queue.tasks:
                self._last_states.pop(robot, None)
                continue
            state = self._robots.get(robot).state
            if self._last_states.setdefault(robot, state) is not state:
                self._last_states[robot] = state
                self._registry.announce(robot)
            if queue.running or queue.current is not None:
                self.schedule(robot)

    async def advance(self) -> None:
        """Process the scheduled queues: settle ended tasks, send the next ones."""
        await asyncio.gather(*self._begin())

    async def redirect(
        self, robot: str, path: SetPath, operator: str, reason: str | None = None
    ) -> CommandReport | None:
        """Send the robot to the end of its present task by another path; its queue continues.

        Return the new command, None when the robot is not doing a task of its queue. Raises MessageError for
        a path that ends elsewhere, RefusedError and StoreError.
        """
        async with self._registry.holding([robot]):
            queue, current = self._registry.get(robot), self._current(robot)
            if current is None:
                return None
            check_path(current.id, path.points, (current.task.x, current.task.y))
            after = task_life.redirect_task(queue, path.points)
            message = commands_of_task(after.tasks[0].task, self._site.settings.cones.offset)[0]
            return await self._send(queue, after, message, operator, reason, current.command)

    async def stop_over(self, robot: str, first: Path, rest: Path, other: str, by: str, also: AlsoOf) -> str:
        """Send the robot along ``first`` only, as a task of its own; its present task waits after that.

        The latter is begun again along ``rest`` as soon as the robot need not wait any more. ``also`` is
        written in the same transaction. Return the id of the command. Raises MessageError for a ``rest`` that
        ends elsewhere, RefusedError for a robot that no longer does a task of its queue, and StoreError.
        """
        async with self._registry.holding([robot]):
            queue = self._registry.get(robot)
            current = self._current(robot)
            if current is None:
                raise RefusedError(f"robot {robot!r} has another command by now")
            check_path(current.id, rest, (current.task.x, current.task.y))
            label = f"waits for {other}"
            after = task_life.split_at_stop(queue, first, rest, label, by, self._clock.time())
            report = await self._send(queue, after, SetPath(first), by, label, current.command, also)
            return report.command

    def current(self, robot: str) -> QueueTask | None:
        """Return the task of its queue that the robot is doing, None if it is doing none."""
        current = self._current(robot)
        return None if current is None else current.task

    def to_the_end(self, task: QueueTask, left: Path) -> Path:
        """Return the rest, ``left``, of the path that was sent for a task, extended to the task's place."""
        return path_to_task_end(task, self._site.settings.cones.offset, left)

    def _current(self, robot: str) -> QueuedTask | None:
        current = self._registry.get(robot).current
        if current is None or current.command is None or not self._commands.is_open(current.command):
            return None
        return current

    # --------------------------------------------------------------------------------------------------

    def _begin(self) -> list[asyncio.Task[None]]:
        """Begin to process each scheduled queue, or leave it scheduled while it is being processed."""
        self._event.clear()
        begun = self._due - self._advancing
        self._due -= begun
        tasks = []
        # A robot that was removed still has a queue, in case it comes back.
        for robot in sorted(robot for robot in begun if robot in self._robots):
            self._advancing.add(robot)
            # Of its own: while a long way of one robot is planned, the others are sent on.
            task = asyncio.create_task(self._advance(robot))
            task.add_done_callback(partial(self._end, robot))
            tasks.append(task)
        return tasks

    def _end(self, robot: str, _task: asyncio.Task[None]) -> None:
        self._advancing.discard(robot)
        if robot in self._due:
            self._event.set()

    async def _advance(self, robot: str) -> None:
        try:
            async with self._registry.holding([robot]):
                await self._settling.settle(self._registry.get(robot))
                await self._hold_back(self._registry.get(robot))
                await self._send_next(self._registry.get(robot))
        except OutdatedError:
            self.schedule(robot)
        except StoreError as error:
            # A database that takes nothing is said of one queue, and not of each every two seconds.
            if self._news.has(robot if isinstance(error, DataRefusedError) else "", str(error)):
                log.error("queue of %s: %s; it is looked at again", robot, error)
        except Exception as error:
            # The queues of all other robots continue.
            if self._news.has(robot, repr(error)):
                log_unforeseen(log, f"queue of {robot}; it is looked at again")

    def note_return(self, robot: str, away: float) -> None:
        """Record that a robot that was lost or offline for ``away`` seconds is received again."""
        queue = self._registry.get(robot)
        if away > self._longest_silence and queue.running and queue.tasks:
            self._returned.add(robot)
            self.schedule(robot)

    @property
    def _longest_silence(self) -> float:
        return self._site.settings.commands.expire_after_s

    async def _hold_back(self, queue: Queue) -> None:
        """Pause the queue of a robot after a long silence, so that it does not start by surprise.

        Whether the robot, its link or the gateway was away: its surroundings may have changed unseen.
        """
        robot = self._robots.get(queue.robot)
        is_away = robot.state in AWAY and self._clock.time() - robot.received_at > self._longest_silence
        if (is_away or robot.name in self._returned) and queue.running and queue.tasks:
            reason = (
                f"the robot was not heard for longer than {self._longest_silence:g} s, or no gateway was "
                "there to hear it; resume when it may drive again"
            )
            await self._registry.save(queue, queue.paused(reason, task_life.GATEWAY, self._clock.time()))
        self._returned.discard(robot.name)

    def _is_beside(self, queue: Queue, report: CommandReport) -> bool:
        return queue.running and report.op != SetPosIni.__name__ and report.command not in self._sending

    # --- the next task --------------------------------------------------------------------------------

    async def _send_next(self, queue: Queue) -> None:
        """Send the next command of the queue, or pause with the reason why it cannot be sent."""
        head = queue.head
        if head is None or not queue.running or (head.is_current and head.command is not None):
            return
        if self._robots.get(queue.robot).state in AWAY:
            return
        if (why := await self._why_not_yet(queue.robot, head)) is not None:
            if head.reason != why:
                await self._registry.save(queue, task_life.mark_waiting(queue, why))
            return
        busy, own = self._commands.busy_with(queue.robot), {task.command for task in queue.tasks}
        try:
            if busy is not None and busy not in own:
                raise RefusedError(f"the robot is busy with command {busy}, which is not of its queue")
            message = await self._message(queue, head)
            await self._send(queue, task_life.mark_sent(queue, self._clock.time()), message, head.added_by)
        except OutdatedError:
            raise
        except RefusedError as error:
            await self._registry.save(
                queue, task_life.pause_before_head(queue, str(error), self._clock.time())
            )

    async def _why_not_yet(self, robot: str, head: QueuedTask) -> str | None:
        """Return why the next command is not sent yet, None when it may be; raises StoreError."""
        if self._is_stopping(robot, head):
            return task_life.STOPS_FIRST
        other = self._waiting.waits_for(robot, head.id)
        if other is not None:
            return f"waits for {other}"
        known = self._robots.get(robot)
        finds_way = self._planner.has_roads and not known.asks_path
        if not known.located and (head.task.path is not None or finds_way):
            # Its path begins at its present position.
            return "waits for the robot to say where it is"
        # A task that was begun is not given up because of another robot.
        return None if head.is_current else await self._precedence.waits_for(robot, head.task)

    def _is_stopping(self, robot: str, head: QueuedTask) -> bool:
        """Return whether the robot must stop first: it was resumed before it acknowledged an Abort.

        By then it may have done its task, and a command sent meanwhile would be ended by that Abort if the
        robot read the Abort last.
        """
        was_begun = not head.is_current and head.command is not None and self._commands.is_open(head.command)
        return was_begun or self._commands.awaits_abort(robot)

    async def _message(self, queue: Queue, head: QueuedTask) -> SetPath | SetPosEnd:
        message = commands_of_task(head.task, self._site.settings.cones.offset)[head.leg]
        if not isinstance(message, SetPath):
            return await self._with_way(queue.robot, head, message)
        pose = self._robots.get(queue.robot).pose
        assert pose is not None
        before = None if head.command is None else await self._stored(head.command)
        driven = 0.0 if before is None else before.driven or 0.0
        join = before is not None or head.task.kind is not TaskKind.DRIVE
        return remaining_task_path(message, (pose.x, pose.y), driven, join=join)

    async def _with_way(self, robot: str, head: QueuedTask, target: SetPosEnd) -> SetPath | SetPosEnd:
        """Return the command to a target without a path: along the roads from the robot's present position.

        It is the bare target for a robot that requests its path, at the end of a task's path, and where no
        roads are near. A robot that does not take cones with a path drives straight to them.

        :raises RefusedError: when no path leads there, or the straight one leads through a keepout.
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
        details = (task.command, before.robot, message, operator, what)
        order = CommandOrder(*details, task=task.id, instead_of=instead_of)
        self._sending.add(order.command)
        try:
            more = None if also is None else also(order.command)
            issuing = self._commands.issue([order], partial(_save, before, after, more))
            (report,) = await self._registry.stored([before.robot], issuing)
        finally:
            self._sending.discard(order.command)
        self._registry.accept(after)
        return report

    async def _stored(self, command: str) -> StoredCommand | None:
        return (await self._database.run(stored_commands.find_all, [command])).get(command)


def _save(before: Queue, after: Queue, also: Also | None, connection: Connection) -> None:
    queues.save(connection, before, after)
    if also is not None:
        also(connection)
