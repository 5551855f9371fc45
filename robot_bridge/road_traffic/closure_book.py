"""Roads that operators closed: stored, kept closed for every way that is found, opened again in time."""

from __future__ import annotations

import asyncio
import contextlib
import logging
import time
from collections import deque
from collections.abc import AsyncIterator, Callable, Collection, Sequence
from typing import Any

import numpy as np

from ..errors import RefusedError, UncertainError
from ..messages import (
    CloseRoad,
    ClosureReport,
    Closures,
    Command,
    OpenRoad,
    ReplannedRobot,
    RoadClosed,
    SetPath,
    SetPosEnd,
    to_json,
)
from ..store import closures
from ..store.closures import ClosureRow
from ..store.database import Database
from .closed_roads import ClosedRoads
from .detours import Detours
from .road_planning import RoadPlanner
from .site_roads import Stretch

log = logging.getLogger(__name__)

GATEWAY = "gateway"
MOST_CONSIDERED = 16
"""paths that are remembered until they are sent."""


class ClosureBook:
    """Every closure that is in force. ``roads`` is None where the gateway plans without roads.

    ``announce`` tells every operator; a closure is stored before anybody is told, and in force before any
    robot is sent another way.
    """

    def __init__(
        self,
        database: Database,
        clock: Callable[[], float],
        roads: RoadPlanner | None,
        detours: Detours,
        announce: Callable[[str, str, dict[str, Any]], None],
    ) -> None:
        self._database = database
        self._clock = clock
        self._roads = roads
        self._detours = detours
        self._announce_news = announce
        self._rows: dict[str, ClosureRow] = {}
        self._edges: dict[str, int] = {}
        self._considered: deque[tuple[SetPath, ClosedRoads, str | None]] = deque(maxlen=MOST_CONSIDERED)
        self._lock = asyncio.Lock()
        self._doubtful = False
        """whether a closure may be stored, or ended, without being known here."""

    async def restore(self) -> None:
        """Close what an earlier gateway left closed."""
        self._rows = {row.id: row for row in await self._database.run(closures.in_force)}
        self._detours.restore()
        await self._enforce()

    async def site_changed(self) -> None:
        """Find the closed roads on the network of the new publication."""
        if self._roads is None:
            return
        async with self._lock:
            self._edges = await asyncio.to_thread(self._roads.renew)
            for id, edges in self._edges.items():
                if not edges:
                    log.warning("closure %s: the site, as it is published now, has no such road", id)
        self._announce()

    def report(self) -> Closures:
        """Return the roads that are closed."""
        return Closures([self._reported(row) for row in self._rows.values()])

    async def close(self, request: CloseRoad, operator: str) -> RoadClosed:
        """Close a road and send the robots that it concerns another way; the same again changes nothing.

        :raises RefusedError: when no road is there; StoreError when it cannot be stored, and is not closed.
        """
        roads = self._need_roads()
        async with self._looked_up():
            known = await self._database.run(closures.find, request.closure)
            if known is not None:
                return RoadClosed(self._reported(known))
            line, level = await asyncio.to_thread(roads.stretch, (request.x, request.y), request.reach)
            now = self._clock()
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
        return RoadClosed(self._reported(row), await self._lead_round(row))

    async def catch_up(self) -> None:
        """Lead those robots round that could not be led when their road was closed, as Detours tells."""
        placed = self._detours.placed()
        if not placed:
            return
        for row in list(self._rows.values()):
            await self._lead_round(row, only=placed)

    async def open(self, request: OpenRoad, operator: str) -> ClosureReport:
        """Open a road; the same again changes nothing.

        :raises RefusedError: when it was never closed; StoreError when it cannot be stored, and stays closed.
        """
        async with self._looked_up():
            known = await self._database.run(closures.find, request.closure)
            if known is None:
                raise RefusedError(f"no road was closed as {request.closure!r}; see get_closures")
            if known.opened_at is not None:
                return self._reported(known)
            return await self._open(known, operator)

    async def expire(self) -> None:
        """Open the roads that were closed until now."""
        now = self._clock()
        async with self._looked_up():
            for row in [row for row in self._rows.values() if row.until is not None and row.until <= now]:
                await self._open(row, GATEWAY)

    async def consider(self, message: Command) -> None:
        """Find out in a thread what :meth:`check` asks about a path: for a long one that takes a while."""
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
    async def _looked_up(self) -> AsyncIterator[None]:
        """Hold the lock, with the closures as they are stored; raises StoreError."""
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
        """Keep roads closed whose closures are stored, and tell of all that are."""
        self._rows.update({row.id: row for row in rows})
        await self._enforce()
        self._announce()
        for row in rows:
            log.warning("%s closed a road%s", row.closed_by, f" ({row.reason})" if row.reason else "")

    async def _lead_round(self, row: ClosureRow, only: Collection[str] | None = None) -> list[ReplannedRobot]:
        robots = await self._detours.around(row.id, row.reason, row.closed_by, only)
        for robot in robots:
            self._announce_news("replanned", robot.robot, to_json(robot))
        return robots

    async def _run(self, work: Callable[..., None], *arguments: Any) -> None:
        try:
            await self._database.run(work, *arguments)
        except UncertainError:
            self._doubtful = True
            raise

    async def _open(self, row: ClosureRow, by: str) -> ClosureReport:
        at = self._clock()
        await self._run(closures.end, row.id, at, by)
        self._rows.pop(row.id, None)
        await self._enforce()
        self._announce()
        return self._reported(row._replace(opened_at=at, opened_by=by))

    async def _enforce(self) -> None:
        if self._roads is None:
            return
        stretches = {row.id: Stretch(np.array(row.line), row.level) for row in self._rows.values()}
        self._edges = await asyncio.to_thread(self._roads.set_closures, stretches)

    def _need_roads(self) -> RoadPlanner:
        if self._roads is None:
            raise RefusedError("this gateway plans without roads; publish a site with road centrelines")
        return self._roads

    def _reported(self, row: ClosureRow) -> ClosureReport:
        return ClosureReport(
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
        self._announce_news("closures", "closures", to_json(self.report()))


def _on_the_way(closed: ClosedRoads, path: SetPath) -> str | None:
    """Return the closure whose road ``path`` leads along, or ends on."""
    along = closed.along(path.points)
    return along[0] if along else closed.at(path.points[-1])


def _clock(at: float) -> str:
    return time.strftime("%H:%M:%S UTC", time.gmtime(at))
