"""Another way for robots whose road was closed; where there is none they stop, or operators are told."""

from __future__ import annotations

import asyncio
import logging
import uuid
from collections.abc import Callable, Collection
from functools import partial
from typing import Protocol

from sqlalchemy import Connection

from ..command_life.open_command import NOTHING, Order, because
from ..commanding.book import CommandBook
from ..commanding.orders import Orders
from ..commanding.writing import Also, AlsoOf
from ..errors import BridgeError, RefusedError, StoreError
from ..messages import (
    AbortTask,
    CommandReport,
    MessageError,
    QueueTask,
    ReplannedRobot,
    SetPath,
    SetPosEnd,
    path_to_end,
)
from ..planning import Point
from ..store import answers
from .road_planning import RoadPlanner
from .ways import Underway, Way, Ways

log = logging.getLogger(__name__)


class Queues(Protocol):
    """The robots' queues, as far as another way concerns them.

    ``waits_for`` is asked whom a robot is to let pass before it is sent a task of its queue.
    """

    waits_for: Callable[[str, str], str | None]

    async def redirect(self, robot: str, path: SetPath, operator: str, reason: str) -> CommandReport | None:
        """Send a task of a queue by another path; None where the robot's task is none of a queue."""

    async def stop_over(
        self, robot: str, first: list[Point], rest: list[Point], other: str, by: str, also: AlsoOf
    ) -> str:
        """Send the robot along ``first``, and along ``rest`` for its task once ``other`` has passed."""

    def current(self, robot: str) -> QueueTask | None:
        """Return the task of its queue that the robot does, None where it does none of it."""

    def to_the_end(self, task: QueueTask, left: list[Point]) -> list[Point]:
        """Return what is ``left`` of the path that was sent for a task, up to the task's place."""

    def look(self, robot: str) -> None:
        """Look soon whether a robot's queue has something to send."""


class Detours:
    """Finds and sends other ways; ``stops`` tells whether a robot without another way is to stop."""

    def __init__(
        self,
        ways: Ways,
        roads: RoadPlanner | None,
        orders: Orders,
        queues: Queues,
        book: CommandBook,
        stops: Callable[[], bool],
    ) -> None:
        self._ways = ways
        self._roads = roads
        self._orders = orders
        self.queues = queues
        self._book = book
        self._stops = stops
        self._later: set[str] = set()

    def restore(self) -> None:
        """Have all robots led round later: nobody knows which of them an earlier gateway has come to."""
        self._later = set(self._ways.names())

    def placed(self) -> set[str]:
        """Return the robots that were to be led round later and can be now; each of them once."""
        placed = {robot for robot in self._later if self._ways.is_placed(robot)}
        self._later -= placed
        return placed

    async def around(
        self, closure: str, reason: str | None, operator: str, only: Collection[str] | None = None
    ) -> list[ReplannedRobot]:
        """Send every robot, or ``only`` some, whose way leads along the road of ``closure`` another way.

        The road is closed by now. A robot of which it is not known where it is now is led round later, as
        :meth:`placed` tells: another way from where it was would lead it back.
        """
        if self._roads is None:
            return []
        underway = [one for one in self._ways.all() if only is None or one.robot in only]
        self._later.update(one.robot for one in underway if not self._ways.is_placed(one.robot))
        concerned = await asyncio.to_thread(self._concerned, self._roads, closure, underway)
        why = because("a road was closed", reason)
        found = await asyncio.gather(*(self._lead(way, why, operator) for way in concerned))
        return sorted(found, key=lambda robot: robot.robot)

    def queued(self, way: Way) -> QueueTask | None:
        """Return the task of the robot's queue whose path this way is, None where it is no such path."""
        return self.queues.current(way.robot) if isinstance(way.task, SetPath) else None

    def goal(self, way: Way) -> Point:
        """Return where the robot's task ends."""
        task = self.queued(way)
        return way.points[-1] if task is None else (task.x, task.y)

    async def send(
        self, way: Way, path: SetPath, operator: str, reason: str, also: AlsoOf | None = None
    ) -> str:
        """Send a robot along ``path``; return the id of the command that it then carries out.

        A target stays the task that it is: the robot is told the way to it as if it had asked. ``also`` is
        written in the same transaction. Raises RefusedError, as when the robot was told otherwise in the
        meantime or is to stop, and StoreError.
        """
        if isinstance(way.task, SetPosEnd) and way.command != NOTHING:
            more = None if also is None else also(way.command)
            await self._book.lead(way.robot, way.command, path, partial(_tell, way.robot, path, more))
            self._ways.told(way.robot, way.task, path)
            return way.command
        done = await self.queues.redirect(way.robot, path, operator, reason)
        if done is None:
            order = Order(str(uuid.uuid4()), way.robot, path, operator, reason, instead_of=way.command)
            (done,) = await self._book.issue([order], None if also is None else also(order.command))
        return done.command

    async def stop(self, robot: str, reason: str, operator: str) -> str:
        """Tell a robot to give up its task; return the id of the command."""
        report = await self._orders.abort(AbortTask(str(uuid.uuid4()), robot, reason=reason), operator)
        return report.command

    def _concerned(self, roads: RoadPlanner, closure: str, underway: list[Underway]) -> list[Way]:
        found = []
        for way in (one.way() for one in underway):
            points = way.points
            if not way.known:
                # It may have its own idea; the shortest way along the roads is the likeliest.
                planned = roads.path_with_open(closure, points[0], points[-1])
                points = points if planned is None else list(planned.points)
            if roads.closed.along(points, [closure]) or roads.closed.at(points[-1]) == closure:
                found.append(way)
        return found

    async def _lead(self, way: Way, why: str, operator: str) -> ReplannedRobot:
        if way.robot in self._later:
            text = f"{way.robot} is sent another way when it has said where it is now: {why}. Look after it."
            return ReplannedRobot(way.robot, "later", text)
        try:
            points, none = await asyncio.to_thread(self._other_way, way)
            if points is None:
                return await self._without_way(way, f"{why}; {none}", operator)
            path = path_to_end(way.task, points)
            command = await self.send(way, path, operator, why[:500])
            text = f"{way.robot} was sent another way: {why}"
            return ReplannedRobot(way.robot, "another way", text, command)
        except StoreError as error:
            self._later.add(way.robot)
            text = f"{way.robot} is sent another way when that can be stored: {why}; {error}. Look after it."
            return ReplannedRobot(way.robot, "later", text)
        except (BridgeError, MessageError) as error:
            log.error("robot %s, whose road was closed: %s", way.robot, error)
            text = f"{way.robot} was NOT sent another way: {why}; {error}. Look after it."
            return ReplannedRobot(way.robot, "failed", text)

    def _other_way(self, way: Way) -> tuple[list[Point] | None, str]:
        assert self._roads is not None
        try:
            planned = self._roads.path(way.points[0], self.goal(way))
        except RefusedError as error:
            return None, str(error)
        # Straight over the fields is no other way.
        return (None, planned.note) if planned.note else (list(planned.points), "")

    async def _without_way(self, way: Way, why: str, operator: str) -> ReplannedRobot:
        if not self._stops():
            text = f"{way.robot} drives on as it was told, though {why}. Look after it."
            return ReplannedRobot(way.robot, "told only", text)
        command = await self.stop(way.robot, f"no other way: {why}"[:500], operator)
        return ReplannedRobot(way.robot, "stopped", f"{way.robot} was stopped: {why}", command)


def _tell(robot: str, path: SetPath, more: Also | None, connection: Connection) -> None:
    answers.add_all(connection, [(robot, path)])
    if more is not None:
        more(connection)
