"""Operators' requests on queues, and pauses of robots."""

from __future__ import annotations

import contextlib
import uuid
from collections.abc import AsyncIterator, Collection, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import partial

from sqlalchemy import Connection

from ...core.errors import RefusedError
from ...core.messages import queues as messages
from ...core.messages.commands import AbortTask, CommandState
from ...core.messages.records import (
    CollectingTasks,
    CollectLayout,
    GetPlacements,
    PlacementReport,
    Placements,
)
from ...core.messages.robots import Abort, SetPath, SetPosEnd
from ..commands.active_command import ActiveCommand, CommandOrder, because
from ..commands.persistence import Also
from ..commands.requests import CommandRequests
from ..model import task_queue
from ..model.events import handles
from ..model.task_queue import Queue, QueuedTask, queue_report
from ..site.places import check_keepouts, check_places, tasks_in_site_frame
from ..storage.database import start_task
from ..storage.repositories import commands, queues, records
from ..storage.repositories.robots import OwnerFence
from . import task_life
from .registry import QueueContext, again_if_moved
from .task_life import commands_of_task, pause_with_task, task_of_command, task_of_rest

# --- Pause of a robot: it stands and continues later, for any task and any sender ---
# The protocol has no pause: the robot is sent an Abort, and its task waits at the head of its queue, which is
# paused. Resumed, the queue sends the robot on from where it stands by then.

_TRIES = 3
"""Most attempts to pause a robot that gets another command in between."""


class PauseService:
    """Pauses robots. One whose pause cannot be stored at once is sent an Abort by ``orders`` all the same."""

    def __init__(self, context: QueueContext, orders: CommandRequests) -> None:
        self._orders = orders
        self._site = context.site
        self._robots = context.robots
        self._commands = context.commands
        self._registry = context.registry
        self._clock = context.clock
        self._waiting = context.waiting

    @handles(messages.PauseRobot)
    async def pause(self, request: messages.PauseRobot, operator: str) -> messages.QueueReport:
        """Make a robot stand, and keep its task; return its queue when this is stored.

        A repeated request changes nothing. Raises RefusedError for an unknown robot, MessageError for a path
        that is too long to be kept, and StoreError.
        """
        self._robots.check_known(request.robot)
        # What is refused must not stop the robot while it waits for its turn.
        self._doing_and_kept(request.robot)
        self._commands.note_stop([request.robot])
        # An Abort of whatever the robot does by then, which holds its queue too, also where it does nothing.
        why = request.abort_reason
        abort = CommandOrder(str(uuid.uuid4()), request.robot, Abort(), operator, why, of_pause=True)
        # What the last pause has left would end the task that this one keeps, unless this one fails, too.
        with self._commands.replacing_failed_pauses(request.robot):
            pausing = start_task(self._pause_held(request, operator))
            return await self._orders.send_if_unstored([abort], pausing, is_pause=True)

    async def _pause_held(self, request: messages.PauseRobot, operator: str) -> messages.QueueReport:
        async with self._registry.holding([request.robot]):
            await self._commands.await_stored(request.robot)
            for _ in range(_TRIES - 1):
                try:
                    return await self._pause(request, operator)
                except RefusedError:
                    # Its task ended in between, or it was given another one.
                    continue
            return await self._pause(request, operator)

    async def _pause(self, request: messages.PauseRobot, operator: str) -> messages.QueueReport:
        robot, queue = request.robot, self._registry.get(request.robot)
        reason, now = because(f"paused by {operator}", request.reason), self._clock.time()
        doing, own, kept = self._doing_and_kept(robot)
        if own is None and not kept:
            return await self._registry.save(queue, queue.paused(reason, operator, now))
        after = pause_with_task(queue, kept, reason, operator, now)
        abort = CommandOrder(
            str(uuid.uuid4()),
            robot,
            Abort(),
            operator,
            request.abort_reason,
            aborts=None if doing is None else doing.report.command,
            task=(own or kept[0]).id,
        )
        write = partial(queues.save, before=queue, after=after)
        await self._registry.stored([robot], self._commands.issue([abort], write))
        return self._registry.accept(after)

    def _doing_and_kept(self, robot: str) -> tuple[ActiveCommand | None, QueuedTask | None, list[QueuedTask]]:
        """Return the command of a robot, its task of the queue, and else what is kept of it as tasks."""
        doing = self._commands.carried_out(robot)
        own = None if doing is None else _task_by(self._registry.get(robot), doing.report.command)
        return doing, own, self._kept(robot, doing) if own is None else []

    def _kept(self, robot: str, doing: ActiveCommand | None) -> list[QueuedTask]:
        """Return as tasks the robot's motion outside its queue, and its motion after another has passed."""
        kept, known, row = [], self._robots.get(robot), self._waiting.get(robot)
        if doing is not None:
            here = (known.pose.x, known.pose.y) if known.located and known.pose is not None else None
            kept.append(task_of_command(doing, self._site.settings.cones.offset, here))
        # A target with a wait on the way to it, or a task of the queue, is kept as a whole already.
        if row is not None and row.task is None and not (doing and isinstance(doing.message, SetPosEnd)):
            rest, offset = SetPath(**row.rest), self._site.settings.cones.offset
            kept.append(task_of_rest(rest, offset, row.command, row.by, self._clock.time()))
        return kept


def _task_by(queue: Queue, command: str) -> QueuedTask | None:
    """Return the task of the queue that a command drives."""
    return next((task for task in queue.tasks if task.command == command), None)


# --- Edits of queues by operators: decoded, checked against robots and site, and stored


QueueChange = tuple[Queue, Queue, list[QueuedTask]]
"""A queue before and after, and the tasks that ended by the change."""


@dataclass(frozen=True)
class QueueEntries:
    """``tasks`` in place of those that the robots have not begun; None leaves a queue as it is.

    A queue at another revision than in ``revisions``, or different from ``seen``, is refused. Queues of
    ``resumed`` robots continue, those of ``paused`` ones pause for ``reason`` at the time ``at`` (s). Robots
    that are ``away`` are paused and lose the tasks ``withdrawn``, for ``reason``; one of these tasks that is
    being done is aborted. ``override`` as in SetQueue.
    """

    tasks: Mapping[str, Sequence[messages.QueueTask] | None]
    revisions: Mapping[str, int] = field(default_factory=dict)
    seen: Mapping[str, Queue] = field(default_factory=dict)
    resumed: Collection[str] = ()
    paused: Collection[str] = ()
    away: Sequence[str] = ()
    withdrawn: Collection[str] = ()
    reason: str | None = None
    override: str | None = None
    at: float | None = None


def _write_entries(changes: Sequence[QueueChange], also: Also, connection: Connection) -> None:
    queues.save_each(connection, changes)
    also(connection)


def _write_taking(
    write: Also,
    fence: OwnerFence,
    aborts: Sequence[CommandOrder],
    elsewhere: Sequence[CommandOrder],
    connection: Connection,
) -> None:
    """Write queues that lost the tasks of the commands in ``aborts``.

    Aborts of robots ``elsewhere`` are requested from their gateways.
    """
    stored = commands.find_all(connection, [abort.aborts for abort in aborts if abort.aborts is not None])
    for one in stored.values():
        if one.report.state is CommandState.REACHED:
            # Its robot has done it, and its queue is about to be updated.
            raise queues.ChangedError(f"robot {one.report.robot!r} has come to its end; look at it again")
    write(connection)
    for abort in elsewhere:
        request = AbortTask(abort.command, aborts=abort.aborts, reason=abort.reason)
        fence.ask(connection, abort.robot, request, abort.operator)


def _removed(tasks: Sequence[QueuedTask], reason: str, operator: str, at: float) -> list[QueuedTask]:
    why = because(f"removed by {operator}", reason)
    return [task_life.end_task(task, messages.TaskState.REMOVED, at, why) for task in tasks]


class QueueEditor:
    """Handles operators' requests on queues. Each method returns when its change is stored.

    Those that change a queue raise OutdatedError when it is not as the operator saw it, RefusedError for a
    change that cannot be done, MessageError for an invalid one, and StoreError when it cannot be stored.
    """

    def __init__(self, context: QueueContext) -> None:
        self._site = context.site
        self._robots = context.robots
        self._commands = context.commands
        self._registry = context.registry
        self._database = context.database
        self._clock = context.clock
        self._fence = context.fence

    @handles(messages.SetQueue)
    async def set(self, request: messages.SetQueue, operator: str) -> messages.QueueReport:
        """Replace the tasks that are not begun."""
        request = replace(request, tasks=await tasks_in_site_frame(self._site, request.tasks))
        async with self._editing(request.robot, request.revision) as queue:
            known = await self._checked(request, queue)
            after = task_queue.replace_tasks(queue, request.tasks, known, operator, self._clock.time())
            return await self._edit(queue, after, operator, "another list took its place")

    @handles(messages.AddTasks)
    async def add(self, request: messages.AddTasks, operator: str) -> messages.QueueReport:
        """Insert tasks into a queue, once: a repetition changes nothing."""
        request = replace(request, tasks=await tasks_in_site_frame(self._site, request.tasks))
        async with self._registry.holding([request.robot]):
            self._robots.check_known(request.robot)
            queue = self._registry.get(request.robot)
            if queue.revision != request.revision and await self._are_given(request):
                return self._registry.announce(request.robot)
            self._check_revision(request.robot, request.revision)
            known = await self._checked(request, queue)
            now = self._clock.time()
            after = task_queue.add_tasks(queue, request.tasks, request.before, known, operator, now)
            return await self._edit(queue, after, operator)

    @handles(messages.MoveTask)
    async def move(self, request: messages.MoveTask, operator: str) -> messages.QueueReport:
        """Move a task to another place of its queue."""
        async with self._editing(request.robot, request.revision) as queue:
            return await self._edit(
                queue, task_queue.move_task(queue, request.task, request.before), operator
            )

    @handles(messages.RemoveTask)
    async def remove(self, request: messages.RemoveTask, operator: str) -> messages.QueueReport:
        """Remove a task from its queue."""
        async with self._editing(request.robot, request.revision) as queue:
            return await self._edit(
                queue, task_queue.remove_task(queue, request.task), operator, request.reason
            )

    @handles(messages.MakeCurrent)
    async def make_current(self, request: messages.MakeCurrent, operator: str) -> messages.QueueReport:
        """Make a task the current one."""
        async with self._editing(request.robot, request.revision) as queue:
            return await self._edit(queue, task_queue.move_task_first(queue, request.task), operator)

    @handles(messages.PauseQueue)
    async def pause(self, request: messages.PauseQueue, operator: str) -> messages.QueueReport:
        """Pause a queue: no further task is sent automatically."""
        reason = because(f"paused by {operator}", request.reason)
        # An order outside the queue may come in between.
        return await again_if_moved(partial(self._pause, request.robot, reason, operator))

    @handles(messages.ResumeQueue)
    async def resume(self, request: messages.ResumeQueue, operator: str) -> messages.QueueReport:
        """Resume a queue; if its robot has not acknowledged an Abort yet, as soon as it has."""
        # One that is kept would hold the queue after that.
        await self._commands.store_kept(request.robot)
        async with self._editing(request.robot, request.revision) as queue:
            after, current = task_queue.resume_queue(queue, operator, self._clock.time()), queue.current
            if current is not None and self._is_being_aborted(queue.robot, current):
                after = after.with_head(task_queue.return_task(current, task_life.STOPS_FIRST))
            return await self._edit(queue, after, operator)

    @handles(messages.TakeOver)
    async def take_over(self, request: messages.TakeOver, operator: str) -> messages.Queues:
        """Give the waiting tasks of one robot's queue to other robots, all of them or none."""
        return await again_if_moved(partial(self._take_over, request, operator))

    async def _take_over(self, request: messages.TakeOver, operator: str) -> messages.Queues:
        names = [request.robot, *(share.robot for share in request.shares)]
        revisions = {request.robot: request.revision}
        revisions.update({share.robot: share.revision for share in request.shares})
        async with self._registry.holding(names):
            for name in names:
                self._robots.check_known(name)
                self._check_revision(name, revisions[name])
            before = {name: self._registry.get(name) for name in names}
            after = task_life.transfer_tasks(before, request, operator, self._clock.time())
            for share in request.shares:
                paths = [task.path for task in share.tasks if task.path]
                for path in paths:
                    check_places(self._site, path)
                if request.override is None:
                    await check_keepouts(self._site, [SetPath(path) for path in paths])
            write = partial(queues.save_many, changes=[(before[name], after[name]) for name in names])
            taken = task_life.transferred_current_task(before[request.robot], request)
            ended = [] if taken is None else [(request.robot, taken)]
            await self._stored(list(before.values()), write, ended, operator)
            return messages.Queues([self._registry.accept(after[name]) for name in names])

    async def enter(self, entries: QueueEntries, operator: str, also: Also) -> list[messages.QueueReport]:
        """Enter the tasks of several robots in one transaction, with the writes ``also``.

        The robots may be at any gateways. Raises OutdatedError where a queue is not as it was seen.
        """
        return await again_if_moved(partial(self._enter, entries, operator, also))

    async def _enter(self, entries: QueueEntries, operator: str, also: Also) -> list[messages.QueueReport]:
        names = [*entries.tasks, *(name for name in entries.away if name not in entries.tasks)]
        async with self._registry.holding(names):
            for name in names:
                self._robots.check_known(name)
                self._check_revision(name, entries.revisions.get(name, self._registry.get(name).revision))
                self._check_seen(name, entries.seen)
            leaving = {task.id for name in entries.tasks for task in self._registry.get(name).waiting}
            leaving |= set(entries.withdrawn)
            changes = [await self._entered(name, entries, leaving, operator) for name in entries.tasks]
            changes += [self._withdrawn(name, entries, operator) for name in entries.away]
            taken = [
                (before.robot, task)
                for before, after, _ in changes
                if (task := before.current) is not None and after.current is None
            ]
            write = partial(_write_entries, changes, also)
            await self._stored([before for before, _, _ in changes], write, taken, operator)
            return [self._registry.accept(after, ended) for _, after, ended in changes]

    async def _stored(
        self, before: Sequence[Queue], write: Also, taken: Sequence[tuple[str, QueuedTask]], operator: str
    ) -> None:
        """Write queues, and abort the current tasks that were ``taken`` from their robots.

        The Abort of a robot of another gateway is requested from that one in the same transaction.
        """
        orders = [
            CommandOrder(
                task_life.abort_id(task),
                robot,
                Abort(),
                operator,
                f"task {task.id} is taken over by another robot",
                aborts=task.command,
                task=task.id,
            )
            for robot, task in taken
            if task.command is not None
        ]
        others = [order for order in orders if self._robots.gateway_of(order.robot) is not None]
        own = [
            replace(order, aborts=None)
            for order in orders
            if order not in others and order.aborts is not None and self._commands.is_open(order.aborts)
        ]
        write = self._registry.fenced(before, partial(_write_taking, write, self._fence, orders, others))
        writing = self._commands.issue(own, write) if own else self._database.run(write)
        await self._registry.stored([queue.robot for queue in before], writing)

    async def _entered(
        self, name: str, entries: QueueEntries, leaving: Collection[str], operator: str
    ) -> QueueChange:
        before, tasks, now = self._registry.get(name), entries.tasks[name], self._clock.time()
        after = before
        if tasks is not None:
            request = messages.SetQueue(name, before.revision, list(tasks), entries.override)
            known = await self._checked(request, before, leaving)
            after = task_queue.replace_tasks(before, tasks, known, operator, now)
        if name in entries.paused:
            why = because(f"paused by {operator}", entries.reason)
            after = after.paused(why, operator, now if entries.at is None else entries.at)
        if name in entries.resumed and not after.running:
            after, current = task_queue.resume_queue(after, operator, now), after.current
            if current is not None and self._is_being_aborted(name, current):
                after = after.with_head(task_queue.return_task(current, task_life.STOPS_FIRST))
        kept = {task.id for task in after.tasks}
        gone = [task for task in before.tasks if task.id not in kept]
        return before, after, _removed(gone, "another list took its place", operator, now)

    def _withdrawn(self, name: str, entries: QueueEntries, operator: str) -> QueueChange:
        before, now = self._registry.get(name), self._clock.time()
        gone = [task for task in before.tasks if task.id in entries.withdrawn]
        kept = [task for task in before.tasks if task.id not in entries.withdrawn]
        reason = because("its tasks were taken over", entries.reason)
        after = before.with_tasks(kept, edited=not before.running).paused(reason, operator, now)
        return before, after, _removed(gone, reason, operator, now)

    async def end(self, robot: str, operator: str, reason: str) -> None:
        """End every task of a robot's queue, begun or not: the robot was removed."""
        async with self._registry.holding([robot]):
            queue = self._registry.get(robot)
            if robot in self._robots and queue.tasks:
                await self._edit(queue, queue.with_tasks((), edited=True), operator, reason)

    @handles(messages.GetQueue)
    async def read(self, request: messages.GetQueue) -> messages.Queues:
        """Return the present queues."""
        if request.robot is not None:
            self._robots.check_known(request.robot)
        names = [request.robot] if request.robot is not None else self._registry.names()
        asked = {name: self._registry.get(name) for name in names}
        if request.robot is None and (others := self._robots.commanded_elsewhere()):
            # Queues stored by other gateways of the fleet.
            asked |= await self._database.read(queues.load, others)
        found = []
        for name, queue in asked.items():
            ended = await self._database.read(queues.newest_ended, name, request.ended)
            if name in self._robots:
                state = self._robots.get(name).state
                found.append(queue_report(queue, state, ended, paths=request.paths))
        return messages.Queues(found)

    @handles(GetPlacements)
    async def placed_cones(self, request: GetPlacements) -> Placements:
        """Return placed cones, newest first."""
        return Placements(await self._database.read(records.newest_placed_cones, request))

    @handles(CollectLayout)
    async def collecting(self, request: CollectLayout) -> CollectingTasks:
        """Return a task for each placed cone that is in no queue yet."""
        found = await self._database.read(records.standing, request.layout)
        queued = {task.task.placement for queue in await self._registry.everywhere() for task in queue.tasks}
        turns = self._site.settings.cones.offset != (0.0, 0.0)
        tasks = [_collecting(cone, turns) for cone in found if cone.placement not in queued]
        return CollectingTasks(tasks, len(found) - len(tasks))

    def _is_being_aborted(self, robot: str, task: QueuedTask) -> bool:
        return task.command is not None and self._commands.is_being_aborted(robot, task.command)

    async def _pause(self, robot: str, reason: str, operator: str) -> messages.QueueReport:
        async with self._registry.holding([robot]):
            self._robots.check_known(robot)
            queue = self._registry.get(robot)
            return await self._edit(queue, queue.paused(reason, operator, self._clock.time()), operator)

    @contextlib.asynccontextmanager
    async def _editing(self, robot: str, revision: int) -> AsyncIterator[Queue]:
        async with self._registry.holding([robot]):
            self._robots.check_known(robot)
            self._check_revision(robot, revision)
            yield self._registry.get(robot)

    async def _edit(
        self, before: Queue, after: Queue, operator: str, reason: str | None = None
    ) -> messages.QueueReport:
        kept = {task.id for task in after.tasks}
        why = because(f"removed by {operator}", reason)
        now = self._clock.time()
        gone = [
            task_life.end_task(task, messages.TaskState.REMOVED, now, why)
            for task in before.tasks
            if task.id not in kept
        ]
        return await self._registry.save(before, after, gone)

    async def _are_given(self, request: messages.AddTasks) -> bool:
        """Return whether all tasks were given to this robot before."""
        ids = [task.task for task in request.tasks]
        known = await self._database.read(queues.whereabouts, ids)
        return bool(ids) and all(one in known and known[one].robot == request.robot for one in ids)

    def _check_revision(self, robot: str, revision: int) -> None:
        now = self._registry.get(robot).revision
        if revision != now:
            raise self._registry.outdated(
                robot, f"the queue of robot {robot!r} is at revision {now}, not {revision}; look at it again"
            )

    def _check_seen(self, robot: str, seen: Mapping[str, Queue]) -> None:
        if robot in seen and self._registry.get(robot) != seen[robot]:
            raise self._registry.outdated(
                robot, f"the queue of robot {robot!r} has changed since it was looked at; look again"
            )

    async def _checked(
        self, request: messages.SetQueue | messages.AddTasks, queue: Queue, leaving: Collection[str] = ()
    ) -> dict[str, task_queue.Whereabouts]:
        """Return the tasks that were submitted before; raises RefusedError for one that cannot be driven.

        Cones to be collected by tasks that are ``leaving`` their queues are free.

        A task that is unchanged in the robot's ``queue`` may lead into a keepout: that was overridden.
        """
        tasks = request.tasks
        driven = {task.task: self._driven(task) for task in tasks}
        if request.override is None:
            waiting = {queued.id: queued.task for queued in queue.tasks}
            new = [leg for task in tasks if waiting.get(task.task) != task for leg in driven[task.task]]
            await check_keepouts(self._site, new)
        tasks_by_placement = {task.placement: task.task for task in tasks if task.placement is not None}
        for other in await self._registry.everywhere() if tasks_by_placement else ():
            for queued in other.tasks:
                if queued.id in leaving or queued.task.placement not in tasks_by_placement:
                    continue
                if tasks_by_placement[queued.task.placement] != queued.id:
                    raise RefusedError(
                        f"placed cone {queued.task.placement} is collected by task {queued.id} of robot "
                        f"{other.robot!r} already; leave it out"
                    )
        standing = await self._database.read(records.standing_ids, sorted(tasks_by_placement))
        gone = sorted(tasks_by_placement.keys() - standing)
        if gone:
            raise RefusedError(
                f"placed cone {gone[0]} does not stand: it was collected, or never put down; "
                "see get_placements"
            )
        return await self._database.read(queues.whereabouts, [task.task for task in tasks])

    def _driven(self, task: messages.QueueTask) -> list[SetPath | SetPosEnd]:
        """Return the commands that drive a task; raises RefusedError where it cannot be driven."""
        driven = commands_of_task(task, self._site.settings.cones.offset)
        check_places(self._site, [(task.x, task.y), *(task.path or ())])
        return driven


def _collecting(cone: PlacementReport, turns: bool) -> messages.QueueTask:
    """Return the task that collects a cone; one placed off its robot is approached from the same side."""
    return messages.QueueTask(
        task=str(uuid.uuid4()),
        x=cone.x,
        y=cone.y,
        theta=cone.theta if turns else None,
        kind=messages.TaskKind.COLLECT,
        cone=cone.cone,
        label=cone.label,
        layout=cone.layout,
        plan=cone.plan,
        placement=cone.placement,
    )
