"""Answers to robots' questions: maps, paths, surfaces."""

from __future__ import annotations

import asyncio
import logging
from collections.abc import Iterable, Sequence
from typing import NamedTuple, Protocol

from ...core.errors import RefusedError, StoreError
from ...core.logs import log_unforeseen
from ...core.messages.base import Done
from ...core.messages.commands import CommandState, SendMap
from ...core.messages.roads import GetSurface, SetSurface
from ...core.messages.robots import (
    Answer,
    GetMap,
    GetPath,
    GetPosIni,
    Question,
    SetMap,
    SetPath,
    SetPosEnd,
    SetPosIni,
)
from ...core.messages.safety import RobotState
from ...core.roads.network import Surface
from ...core.robotmap.model import Border, EncodedMap
from ...protocol.codec import decode_answer
from ..commands.service import CommandService
from ..model.arrival import Planner, remaining_path
from ..model.events import handles
from ..model.robots import Robots
from ..site.places import ServedSite
from ..storage.database import Database
from ..storage.repositories import commands
from ..traffic.robot_paths import RobotPaths
from .outbox import WHOLE_SITE, RequestOutcome, RobotOutboxes

# --- What a robot's questions are answered with ---
# GetMap, GetPath, GetPosIni and GetPosEnd are of the paper (1, table II), GetSurface is this project's own.


class Maps(Protocol):
    """Where maps come from."""

    def is_quick(self, x: float, y: float, area: float) -> bool:
        """Tell whether the map of such a square is made in a few milliseconds."""

    def map_around(self, x: float, y: float, area: float) -> bytes:
        """Return the map of a square of ``area`` square metres centred on (x, y)."""

    def surfaces_at(self, points: Sequence[tuple[float, float]], crs: str | None) -> list[Surface | None]:
        """Return the road surface at each of ``points``, None where there is none."""


class RobotReply(NamedTuple):
    """An answer, and what the robot is told with it."""

    message: SetMap | SetPath | SetPosIni | SetPosEnd | SetSurface
    note: str = ""


class RobotAnswers:
    """Answers questions from what is known of the robots, their commands and the site."""

    def __init__(
        self,
        maps: Maps,
        database: Database,
        robots: Robots,
        book: CommandService,
        planner: Planner,
        ways: RobotPaths,
    ) -> None:
        self._maps = maps
        self._database = database
        self._robots = robots
        self._book = book
        self._planner = planner
        self._ways = ways

    async def answer(self, robot: str, question: Question) -> RobotReply:
        """Return the answer to ``question``; raises RefusedError where there is none, saying why."""
        if isinstance(question, GetMap):
            return RobotReply(SetMap(await self._map(question.x, question.y, question.area)))
        if isinstance(question, GetPath):
            return await self._path(robot)
        if isinstance(question, GetSurface):
            return RobotReply(await self._surfaces(question))
        if isinstance(question, GetPosIni):
            return RobotReply(await self._begin(robot))
        return RobotReply(await self._end(robot))

    async def _map(self, *around: float) -> bytes:
        if self._maps.is_quick(*around):
            return self._maps.map_around(*around)
        return await asyncio.to_thread(self._maps.map_around, *around)

    async def _path(self, robot: str) -> RobotReply:
        task = self._book.task(robot)
        if task is None:
            raise RefusedError(f"GetPath: robot {robot!r} has no task; wait for SetPosEnd or SetPath")
        known = self._robots.get(robot)
        pose = known.pose
        if pose is None or not known.located:
            raise RefusedError(f"GetPath: it is not known where robot {robot!r} is; send SendPos first")
        message, driven = task
        left = await asyncio.to_thread(remaining_path, message, (pose.x, pose.y), driven, self._planner)
        self._ways.note_reported(robot, message, left.message)
        return RobotReply(*left)

    async def _surfaces(self, question: GetSurface) -> SetSurface:
        try:
            found = await asyncio.to_thread(self._maps.surfaces_at, question.points, question.crs)
        except RefusedError as error:
            raise RefusedError(f"GetSurface: {error}") from error
        return SetSurface([None if one is None else one.label for one in found], question.source)

    async def _begin(self, robot: str) -> SetPosIni:
        given = await self._given("GetPosIni", robot, "SetPosIni", "SetPath")
        if isinstance(given, SetPath):
            return SetPosIni(*given.points[0])
        assert isinstance(given, SetPosIni)
        return given

    async def _end(self, robot: str) -> SetPosEnd:
        given = await self._given("GetPosEnd", robot, "SetPosEnd", "SetPath")
        if isinstance(given, SetPath):
            return SetPosEnd(*given.points[-1], given.theta, bool(given.cone), given.collect)
        assert isinstance(given, SetPosEnd)
        return given

    async def _given(self, question: str, robot: str, *ops: str) -> Answer:
        """Return the newest of such commands, unless it was given up."""
        found = await self._database.read(commands.last_given_track, robot, ops)
        if found is None:
            raise RefusedError(
                f"{question}: robot {robot!r} was given no {' or '.join(ops)} yet; wait for one"
            )
        if not (found.state.is_open or found.state is CommandState.REACHED):
            raise RefusedError(
                f"{question}: the last {found.op} of robot {robot!r} is {found.state.value}; "
                "wait for a new one"
            )
        return decode_answer(found.op, found.params)


# --- Maps on their way to robots: what there is at once, and what follows when more is known ---

log = logging.getLogger(__name__)

RETRY_AFTER = 1.0
"""seconds after which a map that could not be stored is stored once more."""

Place = tuple[float, float]


class MapSender:
    """Sends robots the map of the whole site, or that of a window around them where the whole is too large.

    A robot never waits for a map to be made: it is sent a window, and the whole one when it is there.
    """

    def __init__(
        self, site: ServedSite, robots: Robots, mailboxes: RobotOutboxes, database: Database
    ) -> None:
        self._site = site
        self._robots = robots
        self._mailboxes = mailboxes
        self._database = database
        self._parts: dict[str, Border] = {}
        """what the newest map of a robot covers that was not sent the whole one."""
        self._making = asyncio.Lock()
        self._unplaced: set[str] = set()
        """robots that have such a map, and are still to say where they are."""

    async def first(self, robot: str) -> EncodedMap:
        """Return the map that ``robot`` is sent behind the acknowledgement of its Ready.

        Of a part :meth:`.Mailboxes.finish` is to be told, so that more can follow. Raises StoreError.
        """
        offer = await self._offer(robot)
        self._unplaced.discard(robot)
        self._parts[robot] = offer.border
        return offer

    def located(self, robots: Iterable[str]) -> None:
        """Note that ``robots`` have said where they are."""
        for robot in self._unplaced.intersection(robots):
            self._unplaced.discard(robot)
            self._mailboxes.parts.put_nowait(robot)

    @handles(SendMap)
    async def send_requested(self, request: SendMap) -> Done:
        """Return when the map for a robot is stored; it replaces one that still waits for it.

        :raises RefusedError: for a robot that is not known, or is not there.
        """
        self._robots.check_known(request.robot)
        robot = self._robots.get(request.robot)
        if robot.state is RobotState.OFFLINE:
            raise RefusedError(
                f"robot {request.robot!r} is offline; it is sent the map by itself when it connects"
            )
        if not robot.can("map"):
            raise RefusedError(f"robot {request.robot!r} takes no maps, as it said when it connected")
        await self.send(request.robot)
        return Done()

    async def send(self, robot: str) -> None:
        """Send ``robot`` the map of the whole site, or of what is around it; raises StoreError."""
        content = await asyncio.to_thread(self._site.whole_map)
        if content is None:
            await self._store(robot, SetMap((await self._offer(robot)).content))
        else:
            await self._store_whole(robot, content)

    async def whole_or_around(self, robot: str) -> bytes:
        """Return the map of the whole site, or of what is around ``robot``; raises StoreError."""
        # While it is made again all robots may wait for it, but in one thread: others have work for the rest.
        async with self._making:
            content = await asyncio.to_thread(self._site.whole_map)
        return (await self._offer(robot)).content if content is None else content

    async def send_all(self) -> None:
        """Send the robots of this gateway their map; those that are offline get it with their next Ready."""
        for name in self._robots.names():
            if name not in self._robots:
                continue
            robot = self._robots.get(name)
            if robot.gateway is None and robot.state is not RobotState.OFFLINE and robot.can("map"):
                await self.send(name)

    async def run(self) -> None:
        """Send what follows the parts that robots were sent, until cancelled."""
        await asyncio.to_thread(self._site.whole_map)
        while True:
            robot = await self._mailboxes.parts.get()
            try:
                await self._follow(robot)
            except StoreError as error:
                log.error("the map for robot %r: %s; trying again in %g s", robot, error, RETRY_AFTER)
                self._mailboxes.parts.put_nowait(robot)
                await asyncio.sleep(RETRY_AFTER)
            except Exception:
                # The maps of all other robots go out; again and again it would end the gateway.
                log_unforeseen(log, f"the map for robot {robot!r}")

    async def _follow(self, robot: str) -> None:
        content = await asyncio.to_thread(self._site.whole_map)
        if robot not in self._robots:
            return
        known = self._robots.get(robot)
        if content is not None:
            await self._store_whole(robot, content)
        elif known.pose is None or not known.located:
            self._unplaced.add(robot)
        elif not self._parts[robot].holds(known.pose.x, known.pose.y):
            await self.send(robot)

    async def _offer(self, robot: str) -> EncodedMap:
        place = await self._place(robot)
        return await asyncio.to_thread(self._site.map_at_once, place)

    async def _place(self, robot: str) -> Place | None:
        """Return where the robot was last, else where it was told that it stands."""
        pose = self._robots.get(robot).pose if robot in self._robots else None
        if pose is not None:
            return pose.x, pose.y
        given = await self._database.read(commands.last_given_track, robot, ("SetPosIni",))
        if given is None:
            return None
        x, y = given.params.get("x"), given.params.get("y")
        return (float(x), float(y)) if isinstance(x, (int, float)) and isinstance(y, (int, float)) else None

    async def _store_whole(self, robot: str, content: bytes) -> None:
        reads_itself = self._robots.get(robot).link == "sql"
        await self._store(robot, SetMap(content) if reads_itself else WHOLE_SITE)

    async def _store(self, robot: str, message: SetMap) -> None:
        await self._mailboxes.finish([RequestOutcome(robot, answer=message)], [], acks=False)
