"""Recording of trajectories: positions thinned, stored without loss, and read in pages."""

from __future__ import annotations

import asyncio
import contextlib
import logging
import math
import random
from collections import deque
from collections.abc import Callable, Iterable, Sequence, Set
from typing import Any, NamedTuple

from sqlalchemy import Connection

from ...core.clock import Clock
from ...core.errors import DataRefusedError, LockedError, StoreError
from ...core.logs import TroubleNews
from ...core.messages.records import GetTrajectory, Trajectory, TrajectoryPlace, mark_text
from ...core.messages.robots import SendPos
from ...core.sites.settings import SettingsSource
from ...core.sites.settings_tables import TrajectorySettings
from ..model.arrival import standing
from ..model.events import handles
from ..model.robots import RobotPose, Robots
from ..storage.database import Database, to_its_end
from ..storage.repositories import robots as stored_robots
from ..storage.repositories import trajectories
from ..storage.repositories.robots import SOLE_FENCE, OwnerFence
from ..storage.repositories.trajectories import Fix, PackedFix, PageMark, TrajectoryQuery, pack
from ..storage.rows import Row

# --- Thinning: which of a robot's positions are stored; no I/O ---


class PositionThinning:
    """Keeps the positions that a track needs: movements, turns, stops, and one at intervals.

    The last skipped position of each robot is kept, so that a silent robot is stored at its last position.
    """

    def __init__(self) -> None:
        self._kept: dict[str, Fix] = {}
        self._passed: dict[str, Fix] = {}

    def keeps(self, fix: Fix, settings: TrajectorySettings) -> bool:
        """Return whether ``fix`` must be stored; fixes of a robot come in the order of their time."""
        last = self._kept.get(fix.robot)
        if last is None or _worth_it(last, fix, settings):
            self._kept[fix.robot] = fix
            self._passed.pop(fix.robot, None)
            return True
        self._passed[fix.robot] = fix
        return False

    def silent(self, before: float = math.inf) -> list[Fix]:
        """Return, once, the last skipped fixes of robots silent since ``before``."""
        found = [fix for fix in self._passed.values() if fix.received_at < before]
        for fix in found:
            self._kept[fix.robot] = self._passed.pop(fix.robot)
        return found


def _worth_it(last: Fix, fix: Fix, settings: TrajectorySettings) -> bool:
    elapsed = fix.received_at - last.received_at
    # A clock set back must not stop the recording until it has caught up.
    if elapsed >= settings.max_interval_s or elapsed < 0:
        return True
    if elapsed < settings.min_interval_s:
        return False
    return _moved(last.pose, fix.pose, settings) or (standing(fix.pose) and not standing(last.pose))


def _moved(last: SendPos, pose: SendPos, settings: TrajectorySettings) -> bool:
    if math.hypot(pose.x - last.x, pose.y - last.y) >= settings.min_distance_m:
        return True
    turn = abs(math.remainder(pose.theta - last.theta, math.tau))
    return turn >= math.radians(settings.min_turn_deg)


# --- Queue of positions for the database: thinned, kept while it is away or slow ---

log = logging.getLogger(__name__)

BATCH = 5000
"""positions in one transaction: a few hundredths of a second of the database's thread."""
LOOK_INTERVAL = 1.0
"""seconds between checks for robots that have fallen silent."""


class TrajectoryRecorder:
    """Collects positions and returns them in batches; the settings are read from ``site`` each time.

    If more than ``largest_backlog`` wait, the database is away or slower than the positions: the oldest are
    dropped, which is logged once and counted.
    """

    def __init__(self, site: SettingsSource) -> None:
        self._site = site
        self._thinning = PositionThinning()
        self._waiting: deque[PackedFix] = deque()
        self._warned = False
        self._looked_at = 0.0
        self.given_up = 0

    @property
    def waiting(self) -> int:
        """Return the number of positions that wait to be stored."""
        return len(self._waiting)

    def observe(self, fixes: Sequence[Fix]) -> None:
        """Receive positions of robots."""
        settings = self._site.settings.trajectories
        kept = [pack(fix) for fix in fixes if self._thinning.keeps(fix, settings)]
        if kept:
            self._waiting.extend(kept)
            if len(self._waiting) > settings.largest_backlog:
                self._drop_oldest()

    def next_batch(self, now: float) -> list[PackedFix]:
        """Return the oldest positions to be stored; failed ones must be passed to :meth:`requeue`."""
        # Not each time: it checks every robot, and this is called for every few requests.
        if not 0 <= now - self._looked_at < LOOK_INTERVAL:
            self._looked_at = now
            self._wait(self._thinning.silent(now - self._site.settings.trajectories.max_interval_s))
        self._warned = (
            self._warned and len(self._waiting) > self._site.settings.trajectories.largest_backlog / 2
        )
        return [self._waiting.popleft() for _ in range(min(BATCH, len(self._waiting)))]

    def finish(self) -> None:
        """Queue the last position of every robot, however near the previous one: no more will come."""
        self._wait(self._thinning.silent())

    def requeue(self, fixes: Sequence[PackedFix]) -> None:
        """Requeue positions that could not be stored, as the oldest."""
        self._waiting.extendleft(reversed(fixes))
        self._drop_oldest()

    def _wait(self, fixes: Iterable[Fix]) -> None:
        self._waiting.extend(map(pack, fixes))
        self._drop_oldest()

    def _drop_oldest(self) -> None:
        too_many = len(self._waiting) - self._site.settings.trajectories.largest_backlog
        if too_many <= 0:
            return
        for _ in range(too_many):
            self._waiting.popleft()
        if not self._warned:
            log.error(
                "positions are given up, the oldest first: more than %d wait to be stored, since the "
                "database is away or takes them more slowly than they come "
                "(trajectories.largest_backlog of site.toml)",
                len(self._waiting),
            )
        self._warned = True
        self.given_up += too_many


# --- Storage of robots' tracks and current poses, in an order that loses nothing

TRIED = 5
"""robots of which a row is tried before a table counts as one that refuses all: others each time, so that
some whose rows an administrator refuses do not keep those of the others back for long."""


class TableRefusesError(StoreError):
    """The database works, and a table takes nothing of any robot, as with a trigger that refuses each row."""

    def __init__(self, error: DataRefusedError, what: str, table: str) -> None:
        super().__init__(
            f"{error}; so it is with every robot: {what}. See what triggers and rules table {table} has"
        )


class WrittenRobots(NamedTuple):
    """Outcome of storing robots: those removed by others, and those refused by the database, and why."""

    removed: set[str]
    refused: set[str]
    reason: DataRefusedError | None = None


class TrajectoryWriter:
    """Stores positions, and then robots' current poses.

    In this order: a stored pose makes older ones late, and a request processed again carries one. So current
    poses are written only when no position waits or is being written, or when none is taken at all.
    """

    def __init__(
        self,
        database: Database,
        robots: Robots,
        recorder: TrajectoryRecorder,
        clock: Clock,
        fence: OwnerFence = SOLE_FENCE,
    ) -> None:
        self._database = database
        self._robots = robots
        self._recorder = recorder
        self._clock = clock
        self._fence = fence
        self._unsaved: set[str] = set()
        self._stored: set[str] = set()
        """robots that are stored, unless removed by others."""
        self._removed: set[str] = set()
        self._jotted: list[tuple[int, list[PackedFix]]] = []
        """positions that a server may still lose, with the session in which they were written."""
        self._news = TroubleNews()
        self._refusal: StoreError | None = None
        """why no position was taken, until :meth:`save` tries again."""
        self._robots_refusal: StoreError | None = None
        """why no robot was taken; until :meth:`save` tries all again, only those registered are tried."""
        self._registered: set[str] = set()
        """robots to be stored in any case, since :meth:`save` last tried all."""
        self._writing = asyncio.Lock()
        self._begun = self._done = self._locked = 0
        """counts of writes of robots: the number of the last begun one, of the last one that succeeded, and
        of the last one that met a lock."""

    def begin(self, robots: Iterable[str]) -> None:
        """Continue with ``robots``, which an earlier gateway stored."""
        self._stored.update(robots)

    def drop(self, robots: Iterable[str]) -> None:
        """Stop storing poses of robots that another gateway owns."""
        self._unsaved.difference_update(robots)
        self._stored.difference_update(robots)

    def collect_removed(self) -> set[str]:
        """Return the robots removed from the database by others since the last call."""
        removed, self._removed = self._removed, set()
        return removed

    def observe(self, now: float, poses: Sequence[RobotPose]) -> None:
        """Queue poses of robots."""
        self._unsaved.update([robot for robot, _ in poses])
        self._recorder.observe([Fix(robot, now, pose) for robot, pose in poses])

    def touch(self, robot: str) -> None:
        """Have the state of a robot stored again."""
        self._unsaved.add(robot)

    async def save(self, *robots: str) -> None:
        """Store tracks and current poses, those of ``robots`` in any case; raises StoreError.

        Several callers that wait meanwhile are served by one write. A table that takes nothing of any robot,
        or that somebody has locked, is an error for the caller who names none. Robots are registered all the
        same, and stored later: after a crash before that they say Ready again.
        """
        self._unsaved.update(robots)
        self._registered.update(robots)
        with contextlib.suppress(*[LockedError] if robots else []):
            await to_its_end(self._save(self._begun if robots else None))

    async def write_with(self, work: Callable[..., None], *arguments: Any, lasting: bool = False) -> None:
        """Do ``work(connection, *arguments, positions)`` in one transaction with the positions that wait.

        Unless ``lasting``, a power cut may undo it; the positions are then stored again. Raises StoreError.
        """
        await to_its_end(self._write_with(work, arguments, lasting=lasting))

    async def _write_with(
        self, work: Callable[..., None], arguments: tuple[Any, ...], *, lasting: bool
    ) -> None:
        write = self._database.run if lasting else self._database.write_relaxed
        async with self._writing:
            fixes, session = self._next_batch(), self._database.session
            try:
                await write(work, *arguments, fixes)
            except DataRefusedError:
                # A position or part of the work is refused: each is stored separately.
                try:
                    await self._write_or_requeue(fixes)
                except TableRefusesError as error:
                    self._refusal = error
                fixes = []
                await write(work, *arguments, fixes)
            except LockedError as error:
                self._recorder.requeue(fixes)
                if not fixes:
                    raise
                # Robots are answered all the same: they may be asking for a map, or acknowledge an Abort.
                self._refusal, fixes = error, []
                await write(work, *arguments, fixes)
            except Exception:
                self._recorder.requeue(fixes)
                raise
            if fixes and not lasting:
                self._jotted.append((session, fixes))

    async def _save(self, begun: int | None) -> None:
        """Store robots, unless a write after number ``begun`` has already done so, or met a lock."""
        async with self._writing:
            if begun is not None and max(self._done, self._locked) > begun:
                # By the previous holder of ``_writing``, after this was requested. What met a lock of the
                # database is stored later: each would wait for it in turn.
                return
            self._requeue_lost()
            if begun is None:
                self._refusal = self._robots_refusal = None
                self._registered.clear()
            while True:
                fixes = self._next_batch()
                last, unsaved = self._refusal is not None or not self._recorder.waiting, set[str]()
                if last:
                    unsaved = (
                        self._unsaved if self._robots_refusal is None else self._unsaved & self._registered
                    )
                    self._unsaved = self._unsaved - unsaved
                    self._begun += 1
                try:
                    # As they are now: when they are written they may be ahead of the stored positions.
                    known = [
                        stored_robots.row(self._robots.get(name)) for name in unsaved if name in self._robots
                    ]
                    written = await self._write(known, fixes)
                except Exception as error:
                    self._requeue_failed(error, fixes, unsaved)
                    if not isinstance(error, TableRefusesError):
                        raise
                    # Poses are stored all the same: else no robot could be registered while it lasts.
                    self._refusal = error
                    continue
                if last:
                    self._done = self._begun
                self._removed |= written.removed
                self._stored.update(row[0] for row in known if row[0] not in written.refused)
                self._stored -= written.removed
                self._note_refusal(known, written)
                taken_back = self._requeue_lost()
                # With this commit, earlier relaxed writes of the same session are durable, too.
                self._jotted.clear()
                if last and not taken_back:
                    break
            if begun is None and (refusal := self._refusal or self._robots_refusal) is not None:
                raise refusal

    def _next_batch(self) -> list[PackedFix]:
        """Return the oldest positions to be stored; none from a refusal on until :meth:`save` tries again."""
        return [] if self._refusal is not None else self._recorder.next_batch(self._clock.time())

    def _requeue_failed(self, error: Exception, fixes: Sequence[PackedFix], unsaved: set[str]) -> None:
        """Requeue what a write of robots could not store because of ``error``."""
        self._recorder.requeue(fixes)
        self._unsaved |= unsaved
        if isinstance(error, LockedError):
            # Counted also where only positions were written: it ends the wait of all who wait by then.
            self._begun = self._locked = self._begun + 1

    def _note_refusal(self, known: Sequence[Row], written: WrittenRobots) -> None:
        """Requeue refused robots where the table takes none of several."""
        if written.reason is not None and len(written.refused) == len(known) > 1:
            self._robots_refusal = TableRefusesError(
                written.reason, "where they are is stored as soon as it goes", "robots"
            )
        if self._robots_refusal is not None:
            self._unsaved |= written.refused

    async def _write(self, known: Sequence[Row], fixes: Sequence[PackedFix]) -> WrittenRobots:
        """Store robots and positions; only data that the database refuses is left out.

        :raises TableRefusesError: when it refuses every position; nothing was stored then.
        """
        if not (known or fixes or self._stored or self._jotted):
            return WrittenRobots(set(), set())
        try:
            return await self._write_known(known, fixes)
        except DataRefusedError as error:
            fixes = await self._without_tried(fixes, error)
            if await self._refuses_all(known):
                removed = (await self._write_apart([], fixes)).removed
                return WrittenRobots(removed, {row[0] for row in known}, error)
        return await self._write_apart(known, fixes)

    async def _without_tried(
        self, fixes: Sequence[PackedFix], error: DataRefusedError
    ) -> Sequence[PackedFix]:
        """Store a position of one of several robots, and return the others; raises TableRefusesError."""
        newest = {fix[0]: fix for fix in fixes}
        # Of one robot alone nobody knows whether it is at fault.
        tried = random.sample(sorted(newest), min(TRIED, len(newest))) if len(newest) > 1 else []
        for robot in tried:
            try:
                await self._write_known([], [newest[robot]])
            except DataRefusedError:
                continue
            return [fix for fix in fixes if fix is not newest[robot]]
        if tried:
            raise TableRefusesError(error, "positions are kept until it takes them", "trajectories")
        return fixes

    async def _refuses_all(self, known: Sequence[Row]) -> bool:
        """Store some of several robots one by one, up to the first that is taken; return whether none is."""
        if len(known) < 2 and self._robots_refusal is None:
            return False
        for row in random.sample(known, min(TRIED, len(known))):
            with contextlib.suppress(DataRefusedError):
                await self._write_known([row], [])
                return False
        return bool(known)

    async def _write_known(self, known: Sequence[Row], fixes: Sequence[PackedFix]) -> WrittenRobots:
        return WrittenRobots(await self._database.run(_write, known, fixes, self._stored, self._fence), set())

    async def _write_apart(self, known: Sequence[Row], fixes: Sequence[PackedFix]) -> WrittenRobots:
        try:
            return await self._write_known(known, fixes)
        except DataRefusedError as error:
            halves = _halves(known, fixes)
            if halves is None:
                robot = str((known or fixes)[0][0])
                if self._news.has(robot, "left out"):
                    log.error("what is to be stored of robot %s is left out: %s", robot, error)
                return WrittenRobots(set(), {row[0] for row in known}, error)
        first, second = [await self._write_apart(*half) for half in halves]
        refused = first.refused | second.refused
        return WrittenRobots(first.removed | second.removed, refused, first.reason or second.reason)

    async def _write_or_requeue(self, fixes: Sequence[PackedFix]) -> None:
        try:
            await self._write([], fixes)
        except Exception:
            self._recorder.requeue(fixes)
            raise

    def _requeue_lost(self) -> bool:
        """Requeue relaxed writes of an ended session; return whether there were any.

        The server may have died and lost them.
        """
        session = self._database.session
        forgotten = [fixes for number, fixes in self._jotted if number != session]
        self._jotted = [(number, fixes) for number, fixes in self._jotted if number == session]
        for fixes in reversed(forgotten):
            self._recorder.requeue(fixes)
        return bool(forgotten)


def _halves(
    known: Sequence[Row], fixes: Sequence[PackedFix]
) -> list[tuple[Sequence[Row], Sequence[PackedFix]]] | None:
    """Return robots and positions in two parts; None if they cannot be split."""
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
    connection: Connection,
    robots: Sequence[Row],
    fixes: Sequence[PackedFix],
    stored: Set[str],
    fence: OwnerFence,
) -> set[str]:
    """Write robots and positions; return those of the robots ``stored`` that are no longer there.

    They are not written again: they were removed. Nor are robots that another gateway owns.
    """
    removed = fence.missing(connection, stored)
    gone = removed | fence.lost(connection, [row[0] for row in robots])
    stored_robots.save(connection, [row for row in robots if row[0] not in gone] if gone else robots)
    trajectories.add(connection, fixes)
    return removed


# --- Pages of stored positions for operators ---


class TrajectoryPages:
    """The stored positions of robots, in pages."""

    def __init__(self, database: Database) -> None:
        self._database = database

    @handles(GetTrajectory)
    async def read(self, request: GetTrajectory) -> Trajectory:
        """Return the page of stored positions that ``request`` asks for; raises StoreError."""
        query = TrajectoryQuery(tuple(request.robots), request.since, request.until, request.bounds)
        mark = request.mark()
        after = None if mark is None else PageMark(*mark)
        places = await self._database.run(trajectories.read, query, request.limit, after)
        more = len(places) == request.limit
        return Trajectory(
            places=[TrajectoryPlace(*place[1:]) for place in places],
            next=mark_text(places[-1].received_at, places[-1].id) if more else None,
        )
