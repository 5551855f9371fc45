"""Writes down who did what, without making anybody wait for it."""

from __future__ import annotations

import asyncio
import logging
import time
from collections import deque
from collections.abc import Callable

from sqlalchemy import Connection

from ..errors import StoreError
from ..store.database import Database
from . import accounts, audit, session_rows
from .audit import Entry
from .session_rows import SessionRow

log = logging.getLogger(__name__)

Work = Callable[[Connection], None]

LARGEST_BACKLOG = 20_000
BATCH = 500
RETRY_AFTER = 1.0


class Journal:
    """The audit log and the sessions of a running gateway.

    What is noted is written within milliseconds, in the order in which it happened. While the database is
    away it waits here, up to :data:`LARGEST_BACKLOG` pieces; beyond that the oldest are lost, and how many is
    said.
    """

    def __init__(self, database: Database, clock: Callable[[], float] = time.time) -> None:
        self._database = database
        self._clock = clock
        self._waiting: deque[Work] = deque()
        self._event = asyncio.Event()
        self._dropped = 0
        self._batch = BATCH
        self._writing = asyncio.Lock()

    def note(
        self,
        who: str,
        action: str,
        *,
        done: bool = True,
        role: str | None = None,
        address: str | None = None,
        subject: str | None = None,
        detail: str | None = None,
    ) -> None:
        """Note that ``who`` did ``action``, or tried to."""
        entry = Entry(self._clock(), who, action, done, role, address, subject, detail)
        self._put(lambda connection: audit.add(connection, [entry]))

    def began(self, session: SessionRow) -> None:
        """Note a session's beginning."""
        self._put(lambda connection: session_rows.begin(connection, session))

    def renamed(self, id: str, operator: str) -> None:
        """Note who a session says it is."""
        self._put(lambda connection: session_rows.rename(connection, id, operator))

    def ended(self, id: str, reason: str) -> None:
        """Note a session's end."""
        at = self._clock()
        self._put(lambda connection: session_rows.note_end(connection, id, at, reason))

    def used(self, token: str) -> None:
        """Note that a token opened a connection."""
        at = self._clock()
        self._put(lambda connection: accounts.note_use(connection, [(token, at)]))

    async def run(self) -> None:
        """Write what is noted until cancelled."""
        while True:
            try:
                await self._event.wait()
                self._event.clear()
                await self.flush()
            except StoreError as error:
                log.error("%s; the audit log is written later", error)
                await asyncio.sleep(RETRY_AFTER)
                self._event.set()

    async def flush(self) -> None:
        """Write all that waits; raises StoreError when the database is away."""
        async with self._writing:
            while self._waiting:
                await self._write(min(self._batch, len(self._waiting)))
            if self._dropped:
                log.error("%d pieces of the audit log were lost", self._dropped)
                self._dropped = 0

    async def _write(self, count: int) -> None:
        batch = [self._waiting.popleft() for _ in range(count)]
        try:
            await self._database.run(_do_all, batch)
        except StoreError as error:
            if count == 1 and (await self._succeeds(batch) or await self._says_lost(error)):
                return
            self._waiting.extendleft(reversed(batch))
            self._batch = max(1, count // 2)
            raise
        self._batch = min(BATCH, 2 * self._batch)

    async def _says_lost(self, error: StoreError) -> bool:
        """Give up one piece, which must not keep back all that come after it, and write that it is missing.

        A database that cannot be written, such as on a full disk, does not take that either: the piece waits.
        """
        gap = Entry(self._clock(), "gateway", "audit", False, detail=f"an entry is missing here: {error}")
        lost = await self._succeeds([lambda connection: audit.add(connection, [gap])])
        self._dropped += lost
        return lost

    async def _succeeds(self, batch: list[Work]) -> bool:
        try:
            await self._database.run(_do_all, batch)
        except StoreError:
            return False
        return True

    def _put(self, work: Work) -> None:
        self._waiting.append(work)
        if len(self._waiting) > LARGEST_BACKLOG:
            self._waiting.popleft()
            self._dropped += 1
        self._event.set()


def _do_all(connection: Connection, batch: list[Work]) -> None:
    for work in batch:
        work(connection)
