"""From the database into a GeoPackage, whole or not at all."""

from __future__ import annotations

import asyncio
import tempfile
from collections.abc import Sequence
from pathlib import Path

from ..errors import BridgeError
from ..known_names import told
from ..sites.frame import SiteFrame
from ..store import robots as stored_robots
from ..store import trajectories
from ..store.database import Database
from ..store.trajectories import Mark, Wanted
from .geopackage import TrajectoryFile

PAGE = 20_000
"""positions read and written at once."""


async def export(
    database: Database, wanted: Wanted, frame: SiteFrame, file: Path, gap: float
) -> TrajectoryFile:
    """Write what is ``wanted`` into the new GeoPackage ``file``; return what was written.

    :raises BridgeError: for a robot of which nothing is stored, and when the file cannot be written;
        StoreError for the database.
    """
    await _check_robots(database, wanted.robots)
    try:
        # A folder beside the file, so that the finished one is put into its place at once.
        with tempfile.TemporaryDirectory(prefix=".exporting-", dir=file.parent) as folder:
            partial = Path(folder) / f"{file.stem}.gpkg"
            written = TrajectoryFile(partial, frame, gap)
            await _copy(database, wanted, written)
            partial.replace(file)
    except OSError as error:
        raise BridgeError(f"{file} cannot be written: {error.strerror or error}; check its folder") from error
    return written


async def _check_robots(database: Database, robots: Sequence[str]) -> None:
    unknown = await database.run(trajectories.never_seen, robots)
    if unknown:
        known = await database.run(stored_robots.names)
        raise BridgeError(
            f"no position of robot {unknown[0]!r} is stored in this database; robots that are known in it: "
            f"{told(known)}. Nothing was written"
        )


async def _copy(database: Database, wanted: Wanted, written: TrajectoryFile) -> None:
    after = None
    while True:
        places = await database.run(trajectories.read, wanted, PAGE, after)
        await asyncio.to_thread(written.add, places)
        if len(places) < PAGE:
            break
        after = Mark(places[-1].received_at, places[-1].id)
    await asyncio.to_thread(written.finish)
