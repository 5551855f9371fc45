"""Recorded drives into the database: where nothing is stored of a robot, thinned as the gateway does."""

from __future__ import annotations

import logging
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from datetime import UTC, datetime
from itertools import islice

from ..errors import BridgeError
from ..sites.settings import TrajectorySettings
from ..store import trajectories
from ..store.database import Database
from ..store.trajectories import Fix, PackedFix, pack
from .thinning import Thinning

log = logging.getLogger(__name__)

BATCH = 5000
"""positions in one transaction: a gateway that runs on the database waits no longer than for these."""
DAY = 86_400.0


@dataclass(frozen=True)
class Drive:
    """What is recorded of ``robot`` from ``begin`` to ``end``, seconds since 1970.

    ``fixes`` are in the order of their times, and are gone through once.
    """

    robot: str
    begin: float
    end: float
    fixes: Iterable[Fix]

    @property
    def span(self) -> str:
        """Its times for people."""
        return f"{_text(self.begin)} to {_text(self.end)}"


async def import_drives(
    database: Database, drives: Sequence[Drive], settings: TrajectorySettings, now: float
) -> int:
    """Store ``drives``, all or none; return how many positions of them were worth storing.

    :raises BridgeError: where positions of a robot are stored in the time of its drive, for drives that the
        gateway would delete at once, and such that have not ended yet; StoreError for the database.
    """
    for drive in drives:
        _check_times(drive, settings, now)
        if await database.run(trajectories.is_known_within, drive.robot, drive.begin, drive.end):
            raise BridgeError(
                f"positions of robot {drive.robot!r} are stored from {drive.span} already; nothing was "
                "written. Give another name with --robot, or another time with --begin"
            )
    count = 0
    begun: list[Drive] = []
    try:
        for drive in drives:
            begun.append(drive)
            for batch in _batches(_thinned(drive.fixes, settings)):
                await database.run(trajectories.add, batch)
                count += len(batch)
    except BaseException:
        for drive in begun:
            await _take_back(database, drive)
        raise
    return count


def _check_times(drive: Drive, settings: TrajectorySettings, now: float) -> None:
    if drive.end > now:
        raise BridgeError(
            f"the drive of robot {drive.robot!r} is from {drive.span}, which is not over yet; give when it "
            "began with --begin"
        )
    if drive.begin < now - settings.keep_days * DAY:
        raise BridgeError(
            f"the drive of robot {drive.robot!r} is from {drive.span}; the gateway deletes what is older "
            f"than {settings.keep_days:g} days (trajectories.keep_days of site.toml). Give another time with "
            "--begin, or keep positions for longer"
        )


async def _take_back(database: Database, drive: Drive) -> None:
    while await database.run(trajectories.forget_within, drive.robot, drive.begin, drive.end, BATCH):
        log.info("robot %s: positions are taken back", drive.robot)


def _thinned(fixes: Iterable[Fix], settings: TrajectorySettings) -> Iterator[PackedFix]:
    thinning = Thinning()
    for fix in fixes:
        if thinning.keeps(fix, settings):
            yield pack(fix)
    yield from map(pack, thinning.silent())


def _batches(fixes: Iterator[PackedFix]) -> Iterator[list[PackedFix]]:
    while batch := list(islice(fixes, BATCH)):
        yield batch


def _text(at: float) -> str:
    return datetime.fromtimestamp(at, UTC).strftime("%Y-%m-%dT%H:%M:%SZ")
