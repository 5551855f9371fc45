"""What a robot's questions are answered with.

GetMap, GetPath, GetPosIni and GetPosEnd are of the paper (1, table II), GetSurface is this project's own.
"""

from __future__ import annotations

import asyncio
from collections.abc import Sequence
from typing import NamedTuple, Protocol

from .command_life.states import is_open
from .commanding.book import CommandBook
from .errors import RefusedError
from .messages import (
    Answer,
    CommandState,
    GetMap,
    GetPath,
    GetPosIni,
    GetSurface,
    Question,
    SetMap,
    SetPath,
    SetPosEnd,
    SetPosIni,
    SetSurface,
)
from .planning import Planner, way_left
from .road_traffic.ways import Ways
from .roads.surfaces.surface import Surface
from .robots import Robots
from .store import tracks
from .store.database import Database
from .wire import decode_answer


class Maps(Protocol):
    """Where maps come from."""

    def is_quick(self, x: float, y: float, area: float) -> bool:
        """Tell whether the map of such a square is made in a few milliseconds."""

    def map_around(self, x: float, y: float, area: float) -> bytes:
        """Return the map of a square of ``area`` square metres centred on (x, y)."""

    def surfaces_at(self, points: Sequence[tuple[float, float]], crs: str | None) -> list[Surface | None]:
        """Return the road surface at each of ``points``, None where there is none."""


class Reply(NamedTuple):
    """An answer, and what the robot is told with it."""

    message: SetMap | SetPath | SetPosIni | SetPosEnd | SetSurface
    note: str = ""


class Answering:
    """Answers questions from what is known of the robots, their commands and the site."""

    def __init__(
        self,
        maps: Maps,
        database: Database,
        robots: Robots,
        book: CommandBook,
        planner: Planner,
        ways: Ways,
    ) -> None:
        self._maps = maps
        self._database = database
        self._robots = robots
        self._book = book
        self._planner = planner
        self._ways = ways

    async def answer(self, robot: str, question: Question) -> Reply:
        """Return the answer to ``question``; raises RefusedError where there is none, saying why."""
        if isinstance(question, GetMap):
            return Reply(SetMap(await self._map(question.x, question.y, question.area)))
        if isinstance(question, GetPath):
            return await self._path(robot)
        if isinstance(question, GetSurface):
            return Reply(await self._surfaces(question))
        if isinstance(question, GetPosIni):
            return Reply(await self._begin(robot))
        return Reply(await self._end(robot))

    async def _map(self, *around: float) -> bytes:
        if self._maps.is_quick(*around):
            return self._maps.map_around(*around)
        return await asyncio.to_thread(self._maps.map_around, *around)

    async def _path(self, robot: str) -> Reply:
        task = self._book.task(robot)
        if task is None:
            raise RefusedError(f"GetPath: robot {robot!r} has no task; wait for SetPosEnd or SetPath")
        known = self._robots.get(robot)
        pose = known.pose
        if pose is None or not known.located:
            raise RefusedError(f"GetPath: it is not known where robot {robot!r} is; send SendPos first")
        message, driven = task
        left = await asyncio.to_thread(way_left, message, (pose.x, pose.y), driven, self._planner)
        self._ways.told(robot, message, left.message)
        return Reply(*left)

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
        found = await self._database.read(tracks.last_given, robot, ops)
        if found is None:
            raise RefusedError(
                f"{question}: robot {robot!r} was given no {' or '.join(ops)} yet; wait for one"
            )
        if not (is_open(found.state) or found.state is CommandState.REACHED):
            raise RefusedError(
                f"{question}: the last {found.op} of robot {robot!r} is {found.state.value}; "
                "wait for a new one"
            )
        return decode_answer(found.op, found.params)
