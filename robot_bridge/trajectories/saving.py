"""Where robots are and have been, on its way into the database, in an order in which nothing is lost."""

from __future__ import annotations

import asyncio
import logging
from collections.abc import Callable, Iterable, Sequence, Set
from typing import Any, NamedTuple

from sqlalchemy import Connection

from ..errors import DataRefusedError
from ..robots import RobotPose, Robots
from ..store import robots as stored_robots
from ..store import trajectories
from ..store.database import Database, to_its_end
from ..store.rows import Row
from ..store.trajectories import Fix, PackedFix
from .recorder import Recorder

log = logging.getLogger(__name__)


class Written(NamedTuple):
    """What came of storing robots: which somebody has removed, and which the database refused."""

    removed: set[str]
    refused: set[str]


class Saving:
    """Stores positions, and then where robots are.

    In this order: a stored pose makes older ones late, and a request that is dealt with again tells one. So
    where robots are is written only when no position waits, and none is on its way.
    """

    def __init__(
        self, database: Database, robots: Robots, recorder: Recorder, clock: Callable[[], float]
    ) -> None:
        self._database = database
        self._robots = robots
        self._recorder = recorder
        self._clock = clock
        self._unsaved: set[str] = set()
        self._stored: set[str] = set()
        """robots that are stored, unless somebody has removed them from there."""
        self._removed: set[str] = set()
        self._jotted: list[tuple[int, list[PackedFix]]] = []
        """what a server may still forget, with the session in which it was written."""
        self._complained: set[str] = set()
        """robots of which the log was told that something cannot be stored."""
        self._writing = asyncio.Lock()

    def begin(self, robots: Iterable[str]) -> None:
        """Go on with ``robots``, which an earlier gateway stored."""
        self._stored.update(robots)

    def take_removed(self) -> set[str]:
        """Return the robots that somebody has removed from the database since the last call."""
        removed, self._removed = self._removed, set()
        return removed

    def observe(self, now: float, poses: Sequence[RobotPose]) -> None:
        """Have the places of robots stored."""
        self._unsaved.update([robot for robot, _ in poses])
        self._recorder.observe([Fix(robot, now, pose) for robot, pose in poses])

    def touch(self, robot: str) -> None:
        """Have what is known of a robot stored anew."""
        self._unsaved.add(robot)

    async def save(self, *robots: str) -> None:
        """Store where robots have been and are, those of ``robots`` in any case; raises StoreError.

        Whoever waits meanwhile for robots of his own has them stored together with all others.
        """
        self._unsaved.update(robots)
        await to_its_end(self._save(robots))

    async def jot_with(self, work: Callable[..., None], *arguments: Any) -> None:
        """Do ``work(connection, *arguments, positions)`` in one transaction with the positions that wait.

        A power cut may undo it; the positions are then stored again. Raises StoreError.
        """
        await to_its_end(self._jot_with(work, arguments))

    async def _jot_with(self, work: Callable[..., None], arguments: tuple[Any, ...]) -> None:
        async with self._writing:
            fixes, session = self._recorder.take(self._clock()), self._database.session
            try:
                await self._database.jot(work, *arguments, fixes)
            except DataRefusedError:
                # One of the positions is refused, or something of the work: each is stored by itself.
                await self._write_or_give_back(fixes)
                fixes = []
                await self._database.jot(work, *arguments, fixes)
            except Exception:
                self._recorder.give_back(fixes)
                raise
            if fixes:
                self._jotted.append((session, fixes))

    async def _save(self, robots: Sequence[str]) -> None:
        async with self._writing:
            if robots and self._unsaved.isdisjoint(robots):
                # Stored by whoever had the turn before.
                return
            self._take_back()
            while True:
                fixes = self._recorder.take(self._clock())
                last, unsaved = not self._recorder.waiting, set[str]()
                if last:
                    unsaved, self._unsaved = self._unsaved, set()
                try:
                    # As they are now: by the time they are written they may be further on than is stored.
                    known = [
                        stored_robots.row(self._robots.get(name)) for name in unsaved if name in self._robots
                    ]
                    written = await self._write(known, fixes)
                except Exception:
                    self._recorder.give_back(fixes)
                    self._unsaved |= unsaved
                    raise
                self._removed |= written.removed
                self._stored.update(row[0] for row in known if row[0] not in written.refused)
                self._stored -= written.removed
                taken_back = self._take_back()
                # Now that this is stored for good, so is what was jotted down before in the same session.
                self._jotted.clear()
                if last and not taken_back:
                    return

    async def _write(self, known: Sequence[Row], fixes: Sequence[PackedFix]) -> Written:
        """Store robots and positions; of what the database refuses as data only that is left out."""
        try:
            return Written(await self._database.run(_write, known, fixes, self._stored), set())
        except DataRefusedError as error:
            halves = _halves(known, fixes)
            if halves is None:
                robot = str((known or fixes)[0][0])
                if robot not in self._complained:
                    log.error("what is to be stored of robot %s is left out: %s", robot, error)
                self._complained.add(robot)
                return Written(set(), {row[0] for row in known})
        first, second = [await self._write(*half) for half in halves]
        return Written(first.removed | second.removed, first.refused | second.refused)

    async def _write_or_give_back(self, fixes: Sequence[PackedFix]) -> None:
        try:
            await self._write([], fixes)
        except Exception:
            self._recorder.give_back(fixes)
            raise

    def _take_back(self) -> bool:
        """Have that stored again which was jotted down in a session that has ended; tell whether any was.

        The server may have died, and have forgotten it.
        """
        session = self._database.session
        forgotten = [fixes for number, fixes in self._jotted if number != session]
        self._jotted = [(number, fixes) for number, fixes in self._jotted if number == session]
        for fixes in reversed(forgotten):
            self._recorder.give_back(fixes)
        return bool(forgotten)


def _halves(
    known: Sequence[Row], fixes: Sequence[PackedFix]
) -> list[tuple[Sequence[Row], Sequence[PackedFix]]] | None:
    """Return robots and positions in two parts; None for what cannot be parted."""
    if known and fixes:
        return [(known, []), ([], fixes)]
    if len(known) > 1:
        half = len(known) // 2
        return [(known[:half], []), (known[half:], [])]
    if len(fixes) > 1:
        half = len(fixes) // 2
        return [([], fixes[:half]), ([], fixes[half:])]
    return None


def _write(
    connection: Connection, robots: Sequence[Row], fixes: Sequence[PackedFix], stored: Set[str]
) -> set[str]:
    """Write robots and positions; return those of the robots ``stored`` that are there no more.

    They are not written anew: somebody has removed them.
    """
    removed = stored_robots.missing(connection, stored)
    stored_robots.save(connection, [row for row in robots if row[0] not in removed])
    trajectories.add(connection, fixes)
    return removed
