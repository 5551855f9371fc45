"""Closures of roads, and detours of robots around them."""

from __future__ import annotations

import asyncio
import contextlib
import logging
import time
import uuid
from collections import deque
from collections.abc import AsyncIterator, Callable, Collection, Sequence
from functools import partial
from typing import Any, Protocol

import numpy as np
from sqlalchemy import Connection

from ...core.clock import Clock
from ...core.errors import BridgeError, RefusedError, StoreError, UncertainError
from ...core.messages import roads as messages
from ...core.messages.base import MessageError, to_json
from ...core.messages.commands import AbortTask, CommandReport
from ...core.messages.queues import QueueTask
from ...core.messages.robots import Command, SetPath, SetPosEnd, path_to_end
from ..commands.active_command import NOTHING, CommandOrder, because
from ..commands.persistence import Also, AlsoOf
from ..commands.requests import CommandRequests
from ..commands.service import CommandService
from ..model.arrival import Point
from ..model.events import ClosuresChanged, EventBus, Listeners, handles
from ..site.places import ServedSite
from ..storage.database import Database
from ..storage.repositories import closures, requests
from ..storage.repositories.closures import ClosureRow
from .road_planning import RoadPlanner
from .robot_paths import DrivenTask, RobotPath, RobotPaths
from .site_roads import ClosedRoads, RoadStretch

# --- Detours for robots on a closed road; without one they stop, or operators are notified

log = logging.getLogger(__name__)


class DetourQueues(Protocol):
    """The robots' queues, as far as detours need them."""

    async def redirect(self, robot: str, path: SetPath, operator: str, reason: str) -> CommandReport | None:
        """Send a task of a queue by another path; None where the robot's task is not of a queue."""

    async def stop_over(
        self, robot: str, first: list[Point], rest: list[Point], other: str, by: str, also: AlsoOf
    ) -> str:
        """Send the robot along ``first``, and along ``rest`` for its task once ``other`` has passed."""

    def current(self, robot: str) -> QueueTask | None:
        """Return the task of its queue that the robot is doing, None if it is doing none."""

    def to_the_end(self, task: QueueTask, left: list[Point]) -> list[Point]:
        """Return the rest, ``left``, of the path that was sent for a task, extended to the task's place."""

    def schedule(self, robot: str) -> None:
        """Schedule a check of a robot's queue."""


class Detours:
    """Plans and sends detours; by the site's settings a robot without a detour stops or drives on."""

    def __init__(
        self,
        ways: RobotPaths,
        roads: RoadPlanner | None,
        orders: CommandRequests,
        queues: DetourQueues,
        commands: CommandService,
        site: ServedSite,
    ) -> None:
        self._ways = ways
        self._roads = roads
        self._orders = orders
        self.queues = queues
        self._commands = commands
        self._site = site
        self._later: set[str] = set()

    def restore(self) -> None:
        """Mark all robots for a later detour: it is unknown which of them an earlier gateway has sent one."""
        self._later = set(self._ways.names())

    def placed(self) -> set[str]:
        """Return the robots marked for a later detour that can be sent one now; each of them once."""
        placed = {robot for robot in self._later if self._ways.is_placed(robot)}
        self._later -= placed
        return placed

    async def around(
        self, closure: str, reason: str | None, operator: str, only: Collection[str] | None = None
    ) -> list[messages.ReplannedRobot]:
        """Send a detour to every robot, or ``only`` some, with a path along the road of ``closure``.

        The road is closed already. A robot with an unknown present position is sent one later, as returned by
        :meth:`placed`: a detour from its past position would lead it back.
        """
        if self._roads is None:
            return []
        underway = [one for one in self._ways.own() if only is None or one.robot in only]
        self._later.update(one.robot for one in underway if not self._ways.is_placed(one.robot))
        concerned = await asyncio.to_thread(self._concerned, self._roads, closure, underway)
        why = because("a road was closed", reason)
        found = await asyncio.gather(*(self._lead(way, why, operator) for way in concerned))
        return sorted(found, key=lambda robot: robot.robot)

    def queued(self, way: RobotPath) -> QueueTask | None:
        """Return the task of the robot's queue that has this path, None where it is not of the queue."""
        return self.queues.current(way.robot) if isinstance(way.task, SetPath) else None

    def goal(self, way: RobotPath) -> Point:
        """Return the end of the robot's task."""
        task = self.queued(way)
        return way.points[-1] if task is None else (task.x, task.y)

    async def send(
        self, way: RobotPath, path: SetPath, operator: str, reason: str, also: AlsoOf | None = None
    ) -> str:
        """Send a robot along ``path``; return the id of the command that it then carries out.

        A target stays the robot's task: the robot is sent the path to it as if it had requested that.
        ``also`` is written in the same transaction. Raises RefusedError, as when the robot was sent another
        command meanwhile or must stop, and StoreError.
        """
        if isinstance(way.task, SetPosEnd) and way.command != NOTHING:
            more = None if also is None else also(way.command)
            await self._commands.lead(way.robot, way.command, path, partial(_write, way.robot, path, more))
            self._ways.note_reported(way.robot, way.task, path)
            return way.command
        done = await self.queues.redirect(way.robot, path, operator, reason)
        if done is None:
            order = CommandOrder(str(uuid.uuid4()), way.robot, path, operator, reason, instead_of=way.command)
            (done,) = await self._commands.issue([order], None if also is None else also(order.command))
        return done.command

    async def stop(self, robot: str, reason: str, operator: str) -> str:
        """Send a robot an Abort of its task; return the id of the command."""
        report = await self._orders.abort(AbortTask(str(uuid.uuid4()), robot, reason=reason), operator)
        return report.command

    def _concerned(self, roads: RoadPlanner, closure: str, underway: list[DrivenTask]) -> list[RobotPath]:
        found = []
        for way in (one.way() for one in underway):
            points = way.points
            if not way.known:
                # It plans its own path; the shortest one along the roads is the likeliest.
                planned = roads.path_with_open(closure, points[0], points[-1])
                points = points if planned is None else list(planned.points)
            if roads.closed.along(points, [closure]) or roads.closed.at(points[-1]) == closure:
                found.append(way)
        return found

    async def _lead(self, way: RobotPath, why: str, operator: str) -> messages.ReplannedRobot:
        if way.robot in self._later:
            text = f"{way.robot} is sent another way when it has said where it is now: {why}. Look after it."
            return messages.ReplannedRobot(way.robot, "later", text)
        try:
            points, none = await asyncio.to_thread(self._other_way, way)
            if points is None:
                return await self._without_way(way, f"{why}; {none}", operator)
            path = path_to_end(way.task, points)
            command = await self.send(way, path, operator, why[:500])
            text = f"{way.robot} was sent another way: {why}"
            return messages.ReplannedRobot(way.robot, "another way", text, command)
        except StoreError as error:
            self._later.add(way.robot)
            text = f"{way.robot} is sent another way when that can be stored: {why}; {error}. Look after it."
            return messages.ReplannedRobot(way.robot, "later", text)
        except (BridgeError, MessageError) as error:
            log.error("robot %s, whose road was closed: %s", way.robot, error)
            text = f"{way.robot} was NOT sent another way: {why}; {error}. Look after it."
            return messages.ReplannedRobot(way.robot, "failed", text)

    def _other_way(self, way: RobotPath) -> tuple[list[Point] | None, str]:
        assert self._roads is not None
        try:
            planned = self._roads.path(way.points[0], self.goal(way))
        except RefusedError as error:
            return None, str(error)
        # A straight line off the roads is no detour.
        return (None, planned.note) if planned.note else (list(planned.points), "")

    async def _without_way(self, way: RobotPath, why: str, operator: str) -> messages.ReplannedRobot:
        if self._site.settings.routes.no_way != "stop":
            text = f"{way.robot} keeps to its way, though {why}. Look after it."
            return messages.ReplannedRobot(way.robot, "told only", text)
        command = await self.stop(way.robot, f"no other way: {why}"[:500], operator)
        return messages.ReplannedRobot(way.robot, "stopped", f"{way.robot} was stopped: {why}", command)


def _write(robot: str, path: SetPath, more: Also | None, connection: Connection) -> None:
    requests.add_answers(connection, [(robot, path)])
    if more is not None:
        more(connection)


# --- Roads closed by operators: stored, closed to all path planning, opened again in time

GATEWAY = "gateway"
MOST_CONSIDERED = 16
"""most checked paths that are kept until they are sent."""


class ClosureService:
    """The closures in force. ``roads`` is None where the gateway plans without roads.

    Every operator is notified through ``listeners``; a closure is stored before that, and in force before
    any robot is sent a detour.
    """

    def __init__(
        self,
        database: Database,
        clock: Clock,
        roads: RoadPlanner | None,
        detours: Detours,
        listeners: Listeners,
        events: EventBus,
    ) -> None:
        self._database = database
        self._clock = clock
        self._roads = roads
        self._detours = detours
        self._listeners = listeners
        self._events = events
        self._rows: dict[str, ClosureRow] = {}
        self._edges: dict[str, int] = {}
        self._considered: deque[tuple[SetPath, ClosedRoads, str | None]] = deque(maxlen=MOST_CONSIDERED)
        self._lock = asyncio.Lock()
        self._doubtful = False
        """whether a closure may have been stored, or ended, without being known here."""

    async def restore(self) -> None:
        """Close the roads that an earlier gateway left closed."""
        self._rows = {row.id: row for row in await self._database.run(closures.in_force)}
        self._detours.restore()
        await self._enforce()

    async def site_changed(self) -> None:
        """Match the closures to the network of the new publication."""
        if self._roads is None:
            return
        async with self._lock:
            self._edges = await asyncio.to_thread(self._roads.renew)
            for id, edges in self._edges.items():
                if not edges:
                    log.warning("closure %s: the site, as it is published now, has no such road", id)
        self._announce()

    @handles(messages.GetClosures)
    async def closed(self) -> messages.Closures:
        """Return the roads that are closed."""
        return self.report()

    def report(self) -> messages.Closures:
        """Return the roads that are closed."""
        return messages.Closures([self._reported(row) for row in self._rows.values()])

    @handles(messages.CloseRoad)
    async def close(self, request: messages.CloseRoad, operator: str) -> messages.RoadClosed:
        """Close a road and send the affected robots a detour; a repetition changes nothing.

        :raises RefusedError: when there is no road; StoreError when it cannot be stored, and is not closed.
        """
        roads = self._need_roads()
        async with self._reloaded():
            known = await self._database.run(closures.find, request.closure)
            if known is not None:
                return messages.RoadClosed(self._reported(known))
            line, level = await asyncio.to_thread(roads.stretch, (request.x, request.y), request.reach)
            now = self._clock.time()
            row = ClosureRow(
                request.closure,
                [(round(x, 3), round(y, 3)) for x, y in line.tolist()],
                level,
                now,
                operator,
                request.reason,
                None if request.seconds is None else now + request.seconds,
            )
            await self._run(closures.add, row)
            await self._put([row])
        return messages.RoadClosed(self._reported(row), await self._lead_round(row))

    @property
    def goes_on(self) -> bool:
        """Whether the stored closures must be read again."""
        return self._doubtful

    async def follow(self) -> None:
        """Apply the closures and openings by other gateways of the fleet; raises StoreError."""
        stored = await self._database.read(closures.in_force)
        if self._doubtful or {row.id for row in stored} != self._rows.keys():
            self._doubtful = True
            async with self._reloaded():
                return

    async def catch_up(self) -> None:
        """Send detours to the robots that could not be sent one when their road was closed."""
        placed = self._detours.placed()
        if not placed:
            return
        for row in list(self._rows.values()):
            await self._lead_round(row, only=placed)

    @handles(messages.OpenRoad)
    async def open(self, request: messages.OpenRoad, operator: str) -> messages.ClosureReport:
        """Open a road; a repetition changes nothing.

        :raises RefusedError: when it was never closed; StoreError when it cannot be stored, and stays closed.
        """
        async with self._reloaded():
            known = await self._database.run(closures.find, request.closure)
            if known is None:
                raise RefusedError(f"no road was closed as {request.closure!r}; see get_closures")
            if known.opened_at is not None:
                return self._reported(known)
            return await self._open(known, operator)

    async def expire(self) -> None:
        """Open the roads with an expired closure."""
        now = self._clock.time()
        async with self._reloaded():
            for row in [row for row in self._rows.values() if row.until is not None and row.until <= now]:
                await self._open(row, GATEWAY)

    async def prepare(self, message: Command) -> None:
        """Check a path in a thread, for :meth:`check`: a long one takes a while."""
        if self._roads is not None and self._rows and isinstance(message, SetPath):
            closed = self._roads.closed
            found = await asyncio.to_thread(_on_the_way, closed, message)
            self._considered.append((message, closed, found))

    def check(self, message: Command) -> None:
        """Raise RefusedError for a message that sends a robot onto or along a closed road."""
        if self._roads is None or not self._rows:
            return
        if isinstance(message, SetPath):
            found = self._known_of(message, self._roads.closed)
        elif isinstance(message, SetPosEnd):
            found = self._roads.closed.at((message.x, message.y))
        else:
            return
        if found is not None and (row := self._rows.get(found)) is not None:
            raise RefusedError(
                f"it leads along a road that {row.closed_by} closed at {_clock(row.closed_at)}"
                f"{f' ({row.reason})' if row.reason else ''}; choose another way, or open the road first"
            )

    def _known_of(self, path: SetPath, closed: ClosedRoads) -> str | None:
        for message, then, found in self._considered:
            if message is path and then is closed:
                return found
        return _on_the_way(closed, path)

    @contextlib.asynccontextmanager
    async def _reloaded(self) -> AsyncIterator[None]:
        """Hold the lock, with the closures as stored; raises StoreError."""
        async with self._lock:
            if self._doubtful:
                stored = {row.id: row for row in await self._database.run(closures.in_force)}
                new = [row for id, row in stored.items() if id not in self._rows]
                self._rows = {id: row for id, row in self._rows.items() if id in stored}
                self._doubtful = False
                await self._put(new)
                for row in new:
                    await self._lead_round(row)
            yield

    async def _put(self, rows: Sequence[ClosureRow]) -> None:
        """Enforce stored closures, and notify operators of all closures."""
        self._rows.update({row.id: row for row in rows})
        await self._enforce()
        self._announce()
        for row in rows:
            log.warning("%s closed a road%s", row.closed_by, f" ({row.reason})" if row.reason else "")

    async def _lead_round(
        self, row: ClosureRow, only: Collection[str] | None = None
    ) -> list[messages.ReplannedRobot]:
        robots = await self._detours.around(row.id, row.reason, row.closed_by, only)
        for robot in robots:
            self._listeners.announce("replanned", robot.robot, to_json(robot))
        return robots

    async def _run(self, work: Callable[..., None], *arguments: Any) -> None:
        try:
            await self._database.run(work, *arguments)
        except UncertainError:
            self._doubtful = True
            raise
        finally:
            self._events.publish(ClosuresChanged())

    async def _open(self, row: ClosureRow, by: str) -> messages.ClosureReport:
        at = self._clock.time()
        await self._run(closures.end, row.id, at, by)
        self._rows.pop(row.id, None)
        await self._enforce()
        self._announce()
        return self._reported(row._replace(opened_at=at, opened_by=by))

    async def _enforce(self) -> None:
        if self._roads is None:
            return
        stretches = {row.id: RoadStretch(np.array(row.line), row.level) for row in self._rows.values()}
        self._edges = await asyncio.to_thread(self._roads.set_closures, stretches)

    def _need_roads(self) -> RoadPlanner:
        if self._roads is None:
            raise RefusedError("this gateway plans without roads; publish a site with road centrelines")
        return self._roads

    def _reported(self, row: ClosureRow) -> messages.ClosureReport:
        return messages.ClosureReport(
            closure=row.id,
            line=row.line,
            closed_at=row.closed_at,
            closed_by=row.closed_by,
            level=row.level,
            edges=self._edges.get(row.id, 0),
            reason=row.reason,
            until=row.until,
            opened_at=row.opened_at,
            opened_by=row.opened_by,
        )

    def _announce(self) -> None:
        self._listeners.announce("closures", "closures", to_json(self.report()))


def _on_the_way(closed: ClosedRoads, path: SetPath) -> str | None:
    """Return the closure of a road that ``path`` leads along, or ends on."""
    along = closed.along(path.points)
    return along[0] if along else closed.at(path.points[-1])


def _clock(at: float) -> str:
    return time.strftime("%H:%M:%S UTC", time.gmtime(at))
