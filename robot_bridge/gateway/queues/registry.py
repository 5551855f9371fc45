"""Registry of the fleet's queues, each change stored before it is reported, and the context of services."""

from __future__ import annotations

import asyncio
import contextlib
from collections.abc import AsyncIterator, Awaitable, Callable, Coroutine, Iterable, Sequence
from dataclasses import dataclass, field
from functools import partial
from typing import Any, TypeVar

from sqlalchemy import Connection

from ...core.clock import Clock
from ...core.errors import OutdatedError
from ...core.messages.base import to_json
from ...core.messages.queues import QueueReport
from ...core.messages.records import PlacementReport
from ..commands.service import CommandService
from ..commands.validation import WaitingRobots
from ..model.arrival import Planner, StraightPlanner
from ..model.events import (
    EventBus,
    Listeners,
    PlacementChanged,
    QueueChanged,
    QueueEditedElsewhere,
    QueueReported,
)
from ..model.robots import Robots
from ..model.task_queue import REPORTED_ENDED, Queue, QueuedTask, queue_report
from ..site.places import ServedSite
from ..storage.database import Database
from ..storage.repositories import queues
from ..storage.repositories.queues import ChangedError
from ..storage.repositories.robots import SOLE_FENCE, OwnerFence

# --- The queues of the fleet as stored; each change is stored before it is reported ---

T = TypeVar("T")
TRIES, AGAIN_S = 5, 0.05
"""most attempts of a change of queues, and seconds between them."""
RESTORED_AT_ONCE = 500
"""number of robots with their ended tasks read in one transaction."""


class QueueMovedError(OutdatedError):
    """A queue was changed by others between its reading and the change; nothing is stored."""


async def again_if_moved(work: Callable[[], Coroutine[Any, Any, T]]) -> T:
    """Return the result of ``work``, repeated where a queue moved meanwhile; raises as ``work`` does."""
    for _ in range(TRIES - 1):
        with contextlib.suppress(QueueMovedError):
            return await work()
        await asyncio.sleep(AGAIN_S)
    return await work()


class QueueRegistry:
    """Holds every queue as stored; its lock must be held to change it.

    QueueChanged is published for each robot with a queue that may have something to send. Queues of robots of
    other gateways are read when they are held, and change only if they are stored as they were read;
    QueueEditedElsewhere is then published, for the gateway that runs them to read them again.
    """

    def __init__(
        self,
        database: Database,
        robots: Robots,
        listeners: Listeners,
        events: EventBus,
        fence: OwnerFence = SOLE_FENCE,
    ) -> None:
        self._database = database
        self._fence = fence
        self._robots = robots
        self._listeners = listeners
        self._events = events
        self._queues: dict[str, Queue] = {}
        self._ended: dict[str, list[QueuedTask]] = {}
        self._locks: dict[str, asyncio.Lock] = {}
        self._doubtful: set[str] = set()
        self._elsewhere: dict[str, Queue] = {}
        self._versions: dict[str, str] = {}
        """version of each queue elsewhere, from before that was read last."""

    async def restore(self) -> None:
        """Load the queues that an earlier gateway left."""
        found = await self._database.run(queues.load)
        self._queues = {robot: queue for robot, queue in found.items() if self._fence.owns(robot)}
        names = list(self._queues)
        for begin in range(0, len(names), RESTORED_AT_ONCE):
            some = names[begin : begin + RESTORED_AT_ONCE]
            self._ended.update(await self._database.run(queues.newest_ended_of, some, REPORTED_ENDED))
        for robot in self.names():
            self._events.publish(QueueChanged(robot))

    def adopt(self, stored: Iterable[tuple[Queue, list[QueuedTask]]]) -> None:
        """Add queues of robots that another gateway had, each with its newest ended tasks."""
        for queue, ended in stored:
            self._ended[queue.robot] = ended
            self._queues[queue.robot] = queue
            self._events.publish(QueueChanged(queue.robot))

    def drop(self, robots: Iterable[str]) -> None:
        """Remove the queues of robots that another gateway has."""
        for robot in robots:
            self._queues.pop(robot, None)
            self._ended.pop(robot, None)
            self._doubtful.discard(robot)
            self._elsewhere.pop(robot, None)
            self._versions.pop(robot, None)

    def get(self, robot: str) -> Queue:
        """Return a robot's queue as stored last; an empty one where there is none.

        One of another gateway is as it was when last held here, or read by :meth:`read_elsewhere`.
        """
        known = self._elsewhere if self._is_elsewhere(robot) else self._queues
        return known.get(robot) or Queue(robot)

    def names(self) -> list[str]:
        """Return the names of the robots that have a queue."""
        return sorted(name for name in self._queues if name in self._robots)

    async def everywhere(self) -> list[Queue]:
        """Return the queues of all robots, including those of other gateways; raises StoreError."""
        own = [self.get(robot) for robot in self.names() if not self._is_elsewhere(robot)]
        others = self._robots.commanded_elsewhere()
        return [*own, *(await self._database.read(queues.load, others)).values()] if others else own

    async def read_elsewhere(self, robots: Iterable[str]) -> None:
        """Read the changed queues of those of ``robots`` that other gateways have.

        :raises StoreError: when this fails.
        """
        names = sorted(robot for robot in robots if self._is_elsewhere(robot))
        if not names:
            return
        versions = await self._database.read(queues.versions, names)
        changed = [
            robot
            for robot in names
            if robot not in self._elsewhere or versions.get(robot, "") != self._versions.get(robot)
        ]
        if changed:
            await self._read_elsewhere(changed)
            self._versions.update({robot: versions.get(robot, "") for robot in changed})

    def is_doubtful(self, robot: str) -> bool:
        """Return whether the stored queue of a robot may differ from the one here."""
        return robot in self._doubtful

    def doubt(self, robot: str) -> None:
        """Read a robot's queue from the database before it is used again: it may have been paused there."""
        self._doubtful.add(robot)
        self._events.publish(QueueChanged(robot))

    @contextlib.asynccontextmanager
    async def holding(self, robots: Iterable[str]) -> AsyncIterator[None]:
        """Hold the locks of some robots' queues, with the queues as stored."""
        names = sorted(set(robots))
        async with contextlib.AsyncExitStack() as stack:
            for robot in names:
                await stack.enter_async_context(self._locks.setdefault(robot, asyncio.Lock()))
                if robot in self._doubtful:
                    await self._read_again(robot)
            others = [robot for robot in names if self._is_elsewhere(robot)]
            if others:
                await self._read_elsewhere(others)
            yield

    async def save(self, before: Queue, after: Queue, ended: Sequence[QueuedTask] = ()) -> QueueReport:
        """Store the changes of a queue, and report it; raises as :meth:`stored`."""
        writing = self._database.run(self.fenced([before], queues.save), before, after, ended)
        await self.stored([after.robot], writing)
        return self.accept(after, ended)

    def fenced(self, before: Sequence[Queue], write: Callable[..., T]) -> Callable[..., T]:
        """Return ``write``, refused where the queues are not as in ``before``.

        This gateway must still have the robots of its own queues; those of others must be stored task by task
        as they were read.
        """
        if self._fence is SOLE_FENCE:
            return write
        own = [queue.robot for queue in before if not self._is_elsewhere(queue.robot)]
        others = [queue for queue in before if self._is_elsewhere(queue.robot)]
        return partial(_fenced, self._fence, own, others, write)

    async def stored(self, robots: Sequence[str], writing: Awaitable[T]) -> T:
        """Await ``writing``; after a failure the queues are read again before they are used.

        :raises QueueMovedError: when one of the queues is not as assumed; nothing is written then.
        """
        try:
            return await writing
        except ChangedError as error:
            self._doubtful.update(robots)
            for robot in robots:
                await self._read_again(robot)
            raise QueueMovedError(str(error), self._newest(robots[0])) from None
        except BaseException:
            self._doubtful.update(robots)
            raise

    def outdated(self, robot: str, text: str) -> OutdatedError:
        """Return the refusal of a change, with the present queue."""
        return OutdatedError(text, self._newest(robot))

    def accept(self, queue: Queue, ended: Sequence[QueuedTask] = ()) -> QueueReport:
        """Apply a stored queue, and report it to operators, or notify the gateway that has its robot."""
        if self._is_elsewhere(queue.robot):
            self._elsewhere[queue.robot] = queue
            self._events.publish(QueueEditedElsewhere(queue.robot))
            return queue_report(queue, self._robots.get(queue.robot).state, ended)
        self._queues[queue.robot] = queue
        ended_tasks = self._ended.setdefault(queue.robot, [])
        ended_tasks[:0] = reversed(ended)
        del ended_tasks[REPORTED_ENDED:]
        self._events.publish(QueueChanged(queue.robot))
        return self.announce(queue.robot)

    def announce(self, robot: str) -> QueueReport:
        """Report a robot's queue to operators."""
        report = queue_report(self.get(robot), self._robots.get(robot).state, self._ended.get(robot, ()))
        self._listeners.announce("queue", robot, to_json(report))
        self._events.publish(QueueReported(robot))
        return report

    def announce_placement(self, report: PlacementReport) -> None:
        """Report a cone that was placed or collected."""
        self._events.publish(PlacementChanged(report))

    def _is_elsewhere(self, robot: str) -> bool:
        return self._robots.gateway_of(robot) is not None

    def _newest(self, robot: str) -> dict[str, Any]:
        return to_json(queue_report(self.get(robot), self._robots.get(robot).state))

    async def _read_elsewhere(self, robots: Sequence[str]) -> None:
        found = await self._database.read(queues.load, robots)
        self._elsewhere.update({robot: found.get(robot, Queue(robot)) for robot in robots})

    async def _read_again(self, robot: str) -> None:
        if self._is_elsewhere(robot):
            # It is read every time it is held.
            self._doubtful.discard(robot)
            return
        found = await self._database.run(queues.load, [robot])
        self._doubtful.discard(robot)
        if robot in found and found[robot] != self._queues.get(robot):
            self._queues[robot] = found[robot]
            self._ended[robot] = await self._database.run(queues.newest_ended, robot, REPORTED_ENDED)
            self.announce(robot)


def _fenced(
    fence: OwnerFence,
    own: Sequence[str],
    others: Sequence[Queue],
    write: Callable[..., T],
    connection: Connection,
    *arguments: Any,
) -> T:
    if own:
        fence.check(connection, own)
    queues.check_unchanged(connection, others)
    return write(connection, *arguments)


# --- Context of the services that work on queues ---


@dataclass(frozen=True)
class QueueContext:
    """The queues in their ``registry``, and their dependencies: site, robots, commands, database, clock (s).

    ``planner`` plans the paths to tasks without one; ``waiting`` robots let another pass first; ``fence``
    knows the robots of this gateway.
    """

    site: ServedSite
    robots: Robots
    commands: CommandService
    registry: QueueRegistry
    database: Database
    clock: Clock
    waiting: WaitingRobots
    planner: Planner = field(default_factory=StraightPlanner)
    fence: OwnerFence = SOLE_FENCE
