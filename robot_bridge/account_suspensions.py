"""Robots' accounts of the database that keep the others waiting again and again lose their connections."""

from __future__ import annotations

import logging
import time
from collections import Counter, defaultdict, deque
from collections.abc import Callable
from typing import Any, Protocol

from .messages import to_json
from .messages.service import Suspension, Suspensions
from .store.accounts import suspension
from .store.database import Database

log = logging.getLogger(__name__)

MOST_OFFENCES, WITHIN_S = 3, 60.0
"""So often an account may keep the gateway waiting in so many seconds; a flood is once too many."""
FIRST_S, LONGEST_S = 60.0, 3600.0
"""How long an account is locked; each time twice as long as the last time, unless that was long ago."""
FORGIVEN_AFTER_S = 6 * 3600.0
BLOCKS = "its transactions kept the gateway waiting again and again"
FLOODS = "it sent notifications without end"
UPGRADE = "have an administrator run: robot-bridge database upgrade"

Announce = Callable[[str, str, dict[str, Any]], None]


class Commands(Protocol):
    """The commands that robots have."""

    def awaits_any_abort(self, robot: str) -> bool:
        """Tell whether an Abort is on its way to the robot, an emergency stop's or another."""


class AccountSuspensions:
    """Locks such accounts for a while, says so to operators, and unlocks them.

    Those that an earlier gateway has locked are unlocked in time, too. No account is locked while an Abort is
    on its way to its robot: a stop that could not be read would be worse than what the account does.
    """

    def __init__(
        self,
        database: Database,
        commands: Commands,
        announce: Announce,
        clock: Callable[[], float] = time.time,
    ) -> None:
        self._database = database
        self._commands = commands
        self._announce = announce
        self._clock = clock
        self._offences: defaultdict[str, deque[float]] = defaultdict(deque)
        self._last: dict[str, tuple[float, float]] = {}
        self._in_force: dict[str, tuple[float, str]] = {}
        self._not_locked: set[str] = set()

    def report(self) -> Suspensions:
        """Return which accounts are suspended now."""
        return Suspensions(
            [
                Suspension(robot, why, None if robot in self._not_locked else until)
                for robot, (until, why) in sorted(self._in_force.items())
            ]
        )

    async def restore(self) -> None:
        """Take over what an earlier gateway has locked; raises StoreError."""
        self._in_force = await self._database.read(suspension.stored)
        if self._in_force:
            self._tell()

    async def update(self) -> None:
        """Lock accounts that have offended too often, unlock those whose time is over; raises StoreError."""
        now = self._clock()
        for robot, why in (await self._offenders(now)).items():
            if robot not in self._in_force and not self._commands.awaits_any_abort(robot):
                await self._suspend(robot, why, now)
        for robot, (until, _) in list(self._in_force.items()):
            # A clock that was set back must not lock an account for ever.
            is_over = until <= now or until > now + LONGEST_S
            if is_over or self._commands.awaits_any_abort(robot):
                await self._resume(robot)

    async def _offenders(self, now: float) -> dict[str, str]:
        blocking, backends = self._database.offences.drain()
        flooding: list[str] = []
        if backends:
            flooding = await self._database.read(suspension.robots_of_backends, backends)
        for robot, times in Counter(blocking).items():
            seen = self._offences[robot]
            seen.extend([now] * times)
            while seen and seen[0] < now - WITHIN_S:
                seen.popleft()
        often = [robot for robot, seen in self._offences.items() if len(seen) >= MOST_OFFENCES]
        for robot in often:
            del self._offences[robot]
        return dict.fromkeys(often, BLOCKS) | dict.fromkeys(flooding, FLOODS)

    async def _suspend(self, robot: str, why: str, now: float) -> None:
        last, lasted = self._last.get(robot, (0.0, 0.0))
        seconds = min(2 * lasted, LONGEST_S) if lasted and now - last < FORGIVEN_AFTER_S else FIRST_S
        self._last[robot] = now, seconds
        in_force = self._in_force | {robot: (now + seconds, why)}
        # Noted before it is done: whoever comes after a crash in between unlocks what may be locked.
        await self._database.run(suspension.store, in_force)
        self._in_force = in_force
        if await self._database.run_alone(suspension.set_suspended, robot, True):
            log.error("database account of robot %s: %s; locked for %.0f s", robot, why, seconds)
        else:
            self._not_locked.add(robot)
            log.error("database account of robot %s: %s; it cannot be locked: %s", robot, why, UPGRADE)
        self._tell()

    async def _resume(self, robot: str) -> None:
        await self._database.run_alone(suspension.set_suspended, robot, False)
        in_force = {name: one for name, one in self._in_force.items() if name != robot}
        await self._database.run(suspension.store, in_force)
        self._in_force = in_force
        self._not_locked.discard(robot)
        log.warning("database account of robot %s: not locked any more", robot)
        self._tell()

    def _tell(self) -> None:
        self._announce("suspensions", "", to_json(self.report()))
