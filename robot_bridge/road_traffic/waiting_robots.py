"""Robots that wait for others to pass: sent to where they wait, and on from there when the way is free."""

from __future__ import annotations

import asyncio
import logging
import math
from functools import partial

from ..command_life.open_command import NOTHING
from ..commanding.book import CommandBook
from ..commanding.writing import Also, AlsoOf
from ..errors import BridgeError, RefusedError, UncertainError
from ..messages import CommandReport, CommandState, HoldReport, SetPath, path_to_end, to_json
from ..monitoring.unforeseen import note_unforeseen
from ..planning import Point
from ..store import closures as stored
from ..store.closures import HoldRow
from ..store.database import Database
from ..traffic.conflicts import conflicts_with
from .detours import Detours
from .traffic_picture import Seen, hold_report
from .ways import Way

log = logging.getLogger(__name__)

ENDING = ("Abort", "SetPosEnd", "SetPath")
NEAR = 1.0
"""Metres within which a robot is where it is to wait."""


class WaitingRobots:
    """Every robot that waits. What it drives afterwards is stored, so that it is sent on after a restart."""

    def __init__(self, database: Database, book: CommandBook, detours: Detours) -> None:
        self._database = database
        self._book = book
        self._detours = detours
        self._rows: dict[str, HoldRow] = {}
        self._doubtful = False
        """whether a robot may be stored as one that waits without being known here."""
        book.drafting.waits = self.waits
        detours.queues.waits_for = self.waits_for

    def __len__(self) -> int:
        return len(self._rows)

    def rows(self) -> dict[str, HoldRow]:
        """Return who waits, by name."""
        return dict(self._rows)

    def row_of(self, robot: str) -> HoldRow | None:
        """Return how a robot waits, None for one that does not."""
        return self._rows.get(robot)

    def report(self) -> list[HoldReport]:
        """Return who waits as operators are told it."""
        return [hold_report(row) for row in self._rows.values()]

    async def restore(self) -> None:
        """Take up the robots that wait since an earlier gateway."""
        self._rows = {row.robot: row for row in await self._database.run(stored.held)}

    async def catch_up(self) -> None:
        """Take up robots that were stored as waiting without that being known; raises StoreError."""
        if self._doubtful:
            await self._book.look_up()
            await self.restore()
            self._doubtful = False

    async def send(
        self, way: Way, first: list[Point], rest: list[Point], other: str, until: float, operator: str
    ) -> str:
        """Send a robot along ``first`` and let it wait there for ``other`` until ``until`` at least.

        Then it is sent along ``rest``; the path of a queue's task goes on as that task. Return the id of the
        command that it carries out; raises as :meth:`.Detours.send`.
        """
        task, queues = self._detours.queued(way), self._detours.queues
        if task is not None:
            rest = queues.to_the_end(task, rest)
        after = to_json(path_to_end(way.task, rest))
        row = HoldRow(way.robot, other, "", after, until, operator, None if task is None else task.task)

        def also(command: str) -> Also:
            return partial(stored.hold, row=row._replace(command=command))

        try:
            command = await self._send(way, first, row, rest, also)
        except UncertainError:
            self._doubtful = True
            raise
        self._rows[way.robot] = row._replace(command=command)
        return command

    async def _send(self, way: Way, first: list[Point], row: HoldRow, rest: list[Point], also: AlsoOf) -> str:
        if row.task is None:
            reason = f"waits for {row.other}"
            return await self._detours.send(way, SetPath(first), row.by, reason, also)
        return await self._detours.queues.stop_over(way.robot, first, rest, row.other, row.by, also)

    def waits(self, robot: str) -> bool:
        """Tell whether a robot waits."""
        return robot in self._rows

    def waits_for(self, robot: str, task: str) -> str | None:
        """Return whom a robot is to let pass before a task of its queue goes on, None for nobody."""
        row = self._rows.get(robot)
        return None if row is None or row.task != task else row.other

    def note_step(self, report: CommandReport) -> None:
        """Note a command: whoever is told anything else waits no longer, and is sent on by nobody."""
        row = self._rows.get(report.robot)
        ends = report.state is CommandState.QUEUED and report.op in ENDING
        # What leads it to where it waits may be written for it once more.
        if ends and row is not None and row.command != report.command:
            del self._rows[report.robot]
            log.warning("robot %s was told %s, and waits no longer", report.robot, report.op)

    def check(self, robot: str) -> None:
        """Raise RefusedError for a robot that asks for its way while it is to wait."""
        row = self._rows.get(robot)
        if row is not None and self._book.busy_with(robot) == row.command:
            raise RefusedError(
                f"GetPath: robot {robot!r} waits for {row.other!r}; it is told its way when that has passed"
            )

    async def see_to(self, seen: Seen) -> None:
        """Send on who waits no longer: the time is over and nobody is in the way.

        Of a robot of which it is not known where it is now nothing is decided yet.
        """
        for row in [row for row in self._rows.values() if row.robot in seen.placed]:
            try:
                await self._see_to(row, seen)
            except BridgeError as error:
                log.warning("robot %s, which waits for %s, is not sent on: %s", row.robot, row.other, error)
            except Exception:
                note_unforeseen(log, f"robot {row.robot}, which waits for {row.other}")

    async def _see_to(self, row: HoldRow, seen: Seen) -> None:
        task = self._book.busy_with(row.robot)
        if not self._goes_on(row, task, seen):
            log.warning("robot %s has been told otherwise, or gave up; it waits no longer", row.robot)
            await self._forget(row.robot)
            return
        if seen.now < row.until:
            return
        rest = SetPath(**row.rest)
        if not await asyncio.to_thread(_is_free, row, seen):
            return
        if row.task is not None:
            await self._forget(row.robot)
            self._detours.queues.look(row.robot)
            return
        given = self._book.task(row.robot)
        target = given[0] if given is not None else rest
        points = _from_here(seen, row.robot, rest)
        way = Way(row.robot, task or NOTHING, target, points, True)
        path = path_to_end(rest, points)

        def also(_command: str) -> Also:
            return partial(stored.release, robot=row.robot)

        await self._detours.send(way, path, row.by, f"{row.other} has passed", also)
        self._rows.pop(row.robot, None)

    def _goes_on(self, row: HoldRow, task: str | None, seen: Seen) -> bool:
        """Tell whether the robot still does what it was told to, or stands where it was to wait."""
        if task is not None:
            return task == row.command
        place, _ = seen.places[row.robot]
        return math.dist(place, SetPath(**row.rest).points[0]) <= NEAR

    async def forget(self, robot: str) -> None:
        """Let a robot wait no longer, and send it nowhere; raises StoreError."""
        if robot in self._rows:
            await self._forget(robot)

    async def _forget(self, robot: str) -> None:
        await self._database.run(stored.release, robot)
        self._rows.pop(robot, None)


def _is_free(row: HoldRow, seen: Seen) -> bool:
    """Tell whether the robot meets nobody on the rest of its way if it goes on now."""
    movements = seen._replace(holds={**seen.holds, row.robot: row._replace(until=seen.now)}).movements()
    mine = movements.pop(row.robot)
    return not conflicts_with(mine, movements.values(), seen.settings.margin_m, seen.now)


def _from_here(seen: Seen, robot: str, rest: SetPath) -> list[tuple[float, float]]:
    way = next((one.way() for one in seen.underway if one.robot == robot), None)
    before = [seen.places[robot][0]] if way is None else way.points[:-1]
    return [*before, *rest.points]
