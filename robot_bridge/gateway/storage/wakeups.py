"""How a reader learns that there are new rows: the database says so, or it looks again and again."""

from __future__ import annotations

import asyncio
import logging
import os
import time
from collections import Counter
from pathlib import Path
from typing import TYPE_CHECKING, Any, Protocol

from sqlalchemy import Engine

from ...core.errors import in_one_line
from ..monitoring import wait_at_most
from .roles.blocking_sessions import Offences

if TYPE_CHECKING:
    from psycopg import Connection

log = logging.getLogger(__name__)

GATEWAY_CHANNEL = "rr"
"""Robots inserted requests, or deleted answers."""

SHORTEST_S = 0.0003
LONGEST_S = 0.02
SELDOM_S, QUIET_AFTER_S = 0.1, 5.0
"""The pause where nothing was found for so many seconds: robots that report by SQL do so more often."""
UNSEEN_S = 0.25
"""How long a write may go unseen that left its log as it was."""
FALLBACK_S = 1.0
"""How long a reader that is told of new rows trusts that it would have been."""
RETRY_AFTER_S = 1.0
FLOOD, FLOOD_WITHIN_S = 300, 1.0
"""Notifications of one backend in so many seconds: a robot sends one each time the gateway dozes."""
FLOOD_PAUSE_S = 10.0
"""How long nobody listens after a flood: the server keeps its notifications to itself, the reader looks."""
FIRST_PACE_S = 0.001
"""Seconds that the reader waits after a notification if there was nothing behind the last one."""


def robot_channel(robot: str) -> str:
    """Return the channel on which ``robot`` is told of its answers."""
    return f"sa_{robot}"[:63]


class Wakeup(Protocol):
    """Tells when to look for new rows."""

    async def enable_notifications(self) -> bool:
        """Ask to be told of new rows from now on; false where nobody tells, or not yet.

        When it is true, look once more before :meth:`wait`: what came before it may not be told.
        """

    async def wait(self, *, found: bool) -> None:
        """Return when it is time to look again; ``found``: there was something the last time."""

    async def close(self) -> None:
        """Stop."""


class OwnBackend(Protocol):
    """What writes for this program."""

    @property
    def backend(self) -> int | None:
        """The number of its backend at the server, None while there is none."""


class ReaderLock(Protocol):
    """The lock by which those that write know whether the reader is awake."""

    async def enable_notifications(self) -> bool:
        """Hold it; false while somebody writes who thinks that the reader is awake."""

    async def disable_notifications(self) -> None:
        """Let it go."""


class PollingWakeup:
    """Looks again at once where there was something, else less and less often.

    That is down to every 20 ms, and every 100 ms after five seconds without anything.
    """

    def __init__(self) -> None:
        self._pause = SHORTEST_S
        self._found_at = time.monotonic()

    async def enable_notifications(self) -> bool:
        """Return false: nobody tells."""
        return False

    async def wait(self, *, found: bool) -> None:
        """Return after a pause."""
        now = time.monotonic()
        if found:
            self._found_at = now
        longest = LONGEST_S if now - self._found_at < QUIET_AFTER_S else SELDOM_S
        self._pause = SHORTEST_S if found else min(2 * self._pause, longest)
        await asyncio.sleep(self._pause)

    async def close(self) -> None:
        """Do nothing."""


class LogWakeup(PollingWakeup):
    """Returns when the file ``log``, SQLite's write-ahead log, was written to, or after :data:`UNSEEN_S`.

    To stat a file takes a twentieth of the time of a question to the database. Two writes within one tick of
    the file system's clock may leave the same time and size: hence the limit.
    """

    def __init__(self, log: Path) -> None:
        super().__init__()
        self._log = log
        self._seen: tuple[int, int] | None = None
        """What the log was before the reader last began to look at the tables."""

    async def wait(self, *, found: bool) -> None:
        """Return when the log was written to; without a log after a pause."""
        until = time.monotonic() + UNSEEN_S
        while True:
            await super().wait(found=found)
            state = self._state()
            if found or state is None or state != self._seen or time.monotonic() > until:
                break
        self._seen = state

    def _state(self) -> tuple[int, int] | None:
        try:
            now = self._log.stat()
        except OSError:
            return None
        return now.st_mtime_ns, now.st_size


class NotifiedWakeup:
    """LISTEN on a channel of PostgreSQL. What a notification carries is never looked at: anyone may send one.

    Those of its ``own`` backend are passed over: what this program wrote itself is no news to it. A backend
    that sends a flood of them is noted in ``offences``, and for a while nobody listens: the reader looks.
    """

    def __init__(self, engine: Engine, channel: str, own: OwnBackend, offences: Offences) -> None:
        self._engine = engine
        self._channel = channel
        self._own = own
        self._offences = offences
        self.is_flooded = False
        """Whether nobody listens because of a flood."""
        self._news = asyncio.Event()
        self._task: asyncio.Task[None] | None = None

    async def enable_notifications(self) -> bool:
        """Return true: every new row is told of."""
        return True

    async def wait(self, *, found: bool) -> None:
        """Return when something was written, or after a second."""
        if self._task is None:
            self._task = asyncio.create_task(self._listen())
        if self.is_flooded:
            await asyncio.sleep(LONGEST_S)
            return
        await wait_at_most(self._news, FALLBACK_S)
        self._news.clear()

    async def close(self) -> None:
        """End the connection."""
        if self._task is not None:
            self._task.cancel()
            await asyncio.gather(self._task, return_exceptions=True)

    async def _listen(self) -> None:
        import psycopg

        while True:
            try:
                with await asyncio.to_thread(self._connect) as connection:
                    # Something may have been written while nobody listened.
                    self._news.set()
                    await self._hear(connection)
            except FloodError as flood:
                log.warning("%s; nobody listens for %g s", flood, FLOOD_PAUSE_S)
                self._offences.add_flood(flood.backend)
                self.is_flooded = True
                self._news.set()
                await asyncio.sleep(FLOOD_PAUSE_S)
                self.is_flooded = False
                continue
            except (psycopg.Error, OSError) as error:
                log.warning("notifications are lost, looking once a second meanwhile: %s", in_one_line(error))
            await asyncio.sleep(RETRY_AFTER_S)

    def _connect(self) -> Connection[Any]:
        import psycopg
        from psycopg import sql

        from .dialects import CONNECT_ARGUMENTS

        arguments, options = self._engine.dialect.create_connect_args(self._engine.url)
        options = {**options, **CONNECT_ARGUMENTS, "autocommit": True}
        connection: Connection[Any] = psycopg.connect(*arguments, **options)
        connection.execute(sql.SQL("listen {}").format(sql.Identifier(self._channel)))
        return connection

    async def _hear(self, connection: Connection[Any]) -> None:
        """Take in notifications until the connection is lost, which raises psycopg.Error."""
        loop = asyncio.get_running_loop()
        lost: asyncio.Future[None] = loop.create_future()
        own, rate = self._own, NotificationRate()

        def take_in() -> None:
            try:
                connection.pgconn.consume_input()
                while notice := connection.pgconn.notifies():
                    if notice.be_pid != own.backend:
                        self._news.set()
                        rate.count(notice.be_pid, loop.time())
            except Exception as error:
                if not lost.done():
                    lost.set_exception(error)

        # By the socket itself: the driver's own way takes ten times the processor time for each notification.
        # By a second number for it: libpq closes its own as soon as the connection is lost, and a client that
        # is accepted while the loop still watches that one would be given the same number, and not be heard.
        number = os.dup(connection.fileno())
        try:
            loop.add_reader(number, take_in)
            await lost
        finally:
            loop.remove_reader(number)
            os.close(number)


class FloodError(Exception):
    """One backend sends notifications without end."""

    def __init__(self, backend: int) -> None:
        super().__init__(f"backend {backend} sends more than {FLOOD} notifications in {FLOOD_WITHIN_S:g} s")
        self.backend = backend


class NotificationRate:
    """How many notifications came from each backend of late."""

    def __init__(self) -> None:
        self._since = 0.0
        self._counts: Counter[int] = Counter()

    def count(self, backend: int, now: float) -> None:
        """Count one at ``now``, in seconds; raises FloodError when it is one too many."""
        if now - self._since > FLOOD_WITHIN_S:
            self._since = now
            self._counts.clear()
        self._counts[backend] += 1
        if self._counts[backend] > FLOOD:
            raise FloodError(backend)


class AdaptiveWakeup:
    """Looks again and again while there is much to do, and is told of new rows when there is not.

    Telling costs: PostgreSQL lets transactions that notify commit one after the other, each waiting for the
    disk by itself. So those that write look first whether the reader is awake, by a lock that it holds only
    while it dozes (migration 0006), and that none of them may hold while it begins to: so nothing is missed.
    """

    def __init__(
        self,
        listening: NotifiedWakeup,
        lock: ReaderLock,
    ) -> None:
        self._listening = listening
        self._polling = PollingWakeup()
        self._lock = lock
        self._is_notified = False
        self._pace = 0.0
        """Seconds to wait after a notification, as long as there was nothing behind the last ones."""

    async def enable_notifications(self) -> bool:
        """Begin to doze; false while somebody writes who thinks that the reader is awake."""
        # While nobody listens it would sleep until the second is over.
        self._is_notified = not self._listening.is_flooded and await self._lock.enable_notifications()
        return self._is_notified

    async def wait(self, *, found: bool) -> None:
        """Return when something was written, or after a second; while awake, after a pause."""
        if found:
            self._pace = 0.0
        if not self._is_notified:
            await self._polling.wait(found=found)
            return
        if not found:
            await self._listening.wait(found=False)
            # However many come, each look at the tables answers all of them.
            await asyncio.sleep(self._pace)
            self._pace = min(max(2 * self._pace, FIRST_PACE_S), LONGEST_S)
        self._is_notified = False
        await self._lock.disable_notifications()

    async def close(self) -> None:
        """End the connection."""
        await self._listening.close()
