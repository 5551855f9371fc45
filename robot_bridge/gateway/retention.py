"""Retention: data older than the site's settings allow, and OpAcks that nobody reads, are deleted in pieces.

Daily partitions of positions are made ahead here, and dropped as a whole.
"""

from __future__ import annotations

import asyncio
import logging
from collections.abc import Callable, Iterator
from typing import NamedTuple

from sqlalchemy import Connection

from ..core.clock import SYSTEM_CLOCK, Clock, ClockWatch
from ..core.sites.settings import SettingsSource, SiteSettings
from .auth import audit
from .storage.database import Database
from .storage.repositories import closures, commands, emergency_stops, queues, records, requests, trajectories
from .storage.repositories.trajectories import DAY

log = logging.getLogger(__name__)

AT_ONCE = 1000
IMAGES_AT_ONCE = 20
"""images deleted in one transaction; one may be 15 MiB."""
PAUSE = 0.05
"""seconds between two deletions, in which robots and operators have the database."""
LARGEST_STEP = 3600.0
DAYS_AHEAD = 3
"""days with a partition made ahead, today included: a backup may take hours, and blocks making any."""
DOUBT = DAY
"""seconds without deletions while the clock may be ahead: all data would be too old at once, and deletions
cannot be undone."""


class RetainedRows(NamedTuple):
    """Rows of one kind: ``forget(connection, before, limit)`` deletes some, and returns their number."""

    name: str
    days: float
    forget: Callable[[Connection, float, int], int]
    at_once: int = AT_ONCE


def kept(settings: SiteSettings) -> Iterator[RetainedRows]:
    """Yield all kinds of rows that are kept for a limited time, with the days set by the site."""
    yield RetainedRows("whole days of positions", settings.trajectories.keep_days, trajectories.drop_day)
    yield RetainedRows("positions", settings.trajectories.keep_days, trajectories.forget)
    yield RetainedRows("ended commands", settings.commands.keep_days, commands.forget)
    yield RetainedRows("ended tasks", settings.commands.keep_days, queues.forget)
    yield RetainedRows("ended plans", settings.commands.keep_days, queues.forget_plans)
    yield RetainedRows("collected cones", settings.commands.keep_days, records.forget)
    yield RetainedRows("emergency stops", settings.commands.keep_days, emergency_stops.forget)
    yield RetainedRows("opened roads", settings.commands.keep_days, closures.forget)
    yield RetainedRows("rejected objects", settings.observations.keep_days, records.forget_rejected)
    yield RetainedRows(
        "images", settings.observations.keep_images_days, records.forget_images, IMAGES_AT_ONCE
    )
    yield RetainedRows("entries of the audit log", settings.audit.keep_days, audit.forget_entries)
    yield RetainedRows("sessions", settings.audit.keep_days, audit.forget_ended_sessions)


class Retention:
    """Deletes data that is too old; ``settings`` are read each time, so they may change."""

    def __init__(
        self,
        database: Database,
        site: SettingsSource,
        clock: Clock = SYSTEM_CLOCK,
    ) -> None:
        self._database = database
        self._site = site
        self._clock = clock
        self._clock_watch = ClockWatch(clock)
        self._doubtful_until = clock.steady()
        self._missing = 0

    def doubt_clock(self) -> None:
        """Delete nothing for a day: the clock may be ahead."""
        self._doubtful_until = self._clock.steady() + DOUBT

    async def make_days(self) -> None:
        """Make the partitions of positions for today and the next days, where days are partitions.

        Raises StoreError. A missing partition does not prevent positions from being stored.
        """
        if not self._database.dialect.partitions_days:
            return
        today = int(self._clock.time() // DAY)
        missing = await self._database.run(trajectories.make_days, range(today, today + DAYS_AHEAD))
        if missing and not self._missing:
            log.warning(
                "days of positions have no partition yet: somebody reads the table at length, or they have "
                "too many positions already; their positions are stored all the same, and deleted row by row"
            )
        self._missing = missing

    async def prune(self) -> None:
        """Delete data beyond the limits of the settings, and unread OpAcks; raises StoreError."""
        for robot, newest in (await self._database.run(requests.surplus_acks)).items():
            if removed := await self._in_pieces(requests.remove_acks, robot, newest, AT_ONCE):
                log.warning("robot %s: it does not read its OpAcks in sa: %d were deleted", robot, removed)
        if not self._trusts_clock():
            return
        for kind in kept(self._site.settings):
            if removed := await self._forget(kind):
                log.info("deleted %d %s, older than %g days", removed, kind.name, kind.days)

    def _trusts_clock(self) -> bool:
        step = self._clock_watch.measure_step()
        if step is not None and step.by > LARGEST_STEP:
            self.doubt_clock()
            log.warning(
                "the clock of this computer was set forward by %.1f days; for a day nothing is deleted for "
                "its age. If it is wrong, set it right before then, and before the gateway is started anew",
                step.by / DAY,
            )
        return self._clock.steady() >= self._doubtful_until

    async def _forget(self, kind: RetainedRows) -> int:
        return await self._in_pieces(kind.forget, self._clock.time() - kind.days * DAY, kind.at_once)

    async def _in_pieces(self, forget: Callable[..., int], *arguments: object) -> int:
        removed = 0
        while some := await self._database.run(forget, *arguments):
            removed += some
            await asyncio.sleep(PAUSE)
        return removed
