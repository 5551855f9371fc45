"""Wake-ups of readers of new rows: by a notification of the database, or by polling."""

from __future__ import annotations

import asyncio
import contextlib
import ctypes
import logging
import math
import os
import time
from collections import Counter
from pathlib import Path
from typing import TYPE_CHECKING, Any, Protocol

from sqlalchemy import Engine

from ...core.errors import in_one_line
from ...core.logs import TroubleNews
from ..monitoring import until_tick, wait_at_most
from .roles.blocking_sessions import Offences

if TYPE_CHECKING:
    from psycopg import Connection

log = logging.getLogger(__name__)

GATEWAY_CHANNEL = "rr"
"""Robots inserted requests, or deleted answers."""

SHORTEST_S = 0.0003
LONGEST_S = 0.02
SELDOM_S, QUIET_AFTER_S = 0.1, 5.0
"""The polling pause after so many seconds without rows: robots that report by SQL do so more often."""
UNSEEN_S = 0.25
"""Longest delay of a write that did not change the log's time and size."""
VISIBLE_AFTER_S = 5.0
"""How long after a write to SQLite's log its commit may become visible: a slow disk syncs the log before."""
FALLBACK_S = 1.0
"""How long a notified reader trusts the absence of notifications."""
RETRY_AFTER_S = 1.0
FLOOD, FLOOD_WITHIN_S = 300, 1.0
"""Notifications of one backend in so many seconds: a robot sends one each time the gateway dozes."""
FLOOD_PAUSE_S = 10.0
"""How long the listener is off after a flood: no notifications are received, the reader polls."""
FIRST_PACE_S = 0.001
"""Seconds that the reader waits after a notification if it found no row after the last one."""


def robot_channel(robot: str) -> str:
    """Return the channel on which ``robot`` is notified of its answers."""
    return f"sa_{robot}"[:63]


class Wakeup(Protocol):
    """Waits for the time to check for new rows."""

    async def enable_notifications(self) -> bool:
        """Enable notifications of new rows from now on; return false where there are none, or not yet.

        If true, check once more before :meth:`wait`: earlier rows may not be notified.
        """

    async def wait(self, *, found: bool) -> None:
        """Return when it is time to check again; ``found``: the last check found rows."""

    async def close(self) -> None:
        """Stop."""


class OwnBackend(Protocol):
    """The connection that writes for this program."""

    @property
    def backend(self) -> int | None:
        """The number of its backend at the server, None while not connected."""


class ReaderLock(Protocol):
    """The lock by which writers know whether the reader is awake."""

    @property
    def session(self) -> int:
        """A number that changes with every connection that may hold it."""

    async def enable_notifications(self) -> bool:
        """Take it; return false while a writer still assumes that the reader is awake."""

    async def disable_notifications(self) -> None:
        """Release it."""


class PollingWakeup:
    """Polls at once after rows were found, else less and less often.

    The pause grows to 20 ms, and to 100 ms after five seconds without rows.
    """

    def __init__(self) -> None:
        self._pause = SHORTEST_S
        self._found_at = time.monotonic()

    async def enable_notifications(self) -> bool:
        """Return false: there are no notifications."""
        return False

    async def wait(self, *, found: bool) -> None:
        """Return after a pause."""
        if found:
            self._found_at = time.monotonic()
        longest = SELDOM_S if self._is_quiet else LONGEST_S
        self._pause = SHORTEST_S if found else min(2 * self._pause, longest)
        await asyncio.sleep(self._pause)

    @property
    def _is_quiet(self) -> bool:
        return time.monotonic() - self._found_at >= QUIET_AFTER_S

    async def close(self) -> None:
        """Do nothing."""


class LogWakeup(PollingWakeup):
    """Returns when the file ``log``, SQLite's write-ahead log, was written to, or after :data:`UNSEEN_S`.

    A stat takes a twentieth of the time of a query. Two writes within one tick of the file system's clock may
    leave the same time and size: hence the limit. After a while without rows the system reports writes
    (:class:`FileEvents`), where it can, and nothing is polled while there are none.

    A report is no commit: SQLite writes to the log, syncs it, and makes the commit visible in shared memory
    afterwards, of which the system reports nothing. So after a report the log is polled, until there was none
    for :data:`VISIBLE_AFTER_S`. Every commit writes to the log, also one whose rows were written before.
    """

    def __init__(self, log: Path) -> None:
        super().__init__()
        self._log = log
        self._events: FileEvents | None = None
        self._reported_at = -math.inf
        """When the system last reported a write, or began to report them."""
        self._seen: tuple[int, int] | None = None
        """Time and size of the log before the reader last began to read the tables."""

    async def wait(self, *, found: bool) -> None:
        """Return when the log was written to; without a log after a pause."""
        if found or not self._is_quiet:
            self._unwatch()
        elif self._is_silent():
            await self._wait_for_report()
            return
        await self._poll(found=found)

    async def close(self) -> None:
        """Stop watching the log."""
        self._unwatch()

    async def _poll(self, *, found: bool) -> None:
        # Looks at the tables follow a report at growing intervals: most disks sync within milliseconds.
        now = time.monotonic()
        until = now + min(UNSEEN_S, (now - self._reported_at) / 4)
        while True:
            await super().wait(found=found)
            state = self._state()
            if found or state is None or state != self._seen or time.monotonic() > until:
                break
        self._seen = state

    async def _wait_for_report(self) -> None:
        """Return after a write, or after a second."""
        assert self._events is not None
        if await self._events.wait(until_tick(FALLBACK_S)):
            self._reported_at = time.monotonic()
            self._pause = SHORTEST_S

    def _is_silent(self) -> bool:
        """Return whether writes are reported, and were not for so long that all commits are visible."""
        # It may be another file than before.
        if self._events is None or not self._events.is_of(self._log):
            self._unwatch()
            self._events = FileEvents.of(self._log)
            if self._events is None:
                return False
            # What was written before the watch may not be visible, either.
            self._reported_at = time.monotonic()
        elif self._events.read():
            self._reported_at = time.monotonic()
        return time.monotonic() - self._reported_at >= VISIBLE_AFTER_S

    def _unwatch(self) -> None:
        events, self._events = self._events, None
        self._reported_at = -math.inf
        if events is not None:
            events.close()

    def _state(self) -> tuple[int, int] | None:
        try:
            now = self._log.stat()
        except OSError:
            return None
        return now.st_mtime_ns, now.st_size


class FileEvents:
    """Reports writes to one file, and its removal, by inotify, which only Linux has."""

    def __init__(self, descriptor: int, file: tuple[int, int]) -> None:
        self._descriptor = descriptor
        self._file = file

    @classmethod
    def of(cls, path: Path) -> FileEvents | None:
        """Return the events of the file at ``path``; None without it, and where the system has no events."""
        try:
            libc = ctypes.CDLL(None, use_errno=True)
            descriptor = libc.inotify_init1(os.O_NONBLOCK | os.O_CLOEXEC)
        except (AttributeError, OSError):
            return None
        if descriptor < 0:
            return None
        with contextlib.suppress(OSError):
            # Before the watch: of a file that takes its place meanwhile this is not the number.
            file = path.stat()
            if libc.inotify_add_watch(descriptor, os.fsencode(path), _REPORTED) >= 0:
                return cls(descriptor, (file.st_dev, file.st_ino))
        os.close(descriptor)
        return None

    def is_of(self, path: Path) -> bool:
        """Return whether ``path`` is still the file."""
        try:
            file = path.stat()
        except OSError:
            return False
        return self._file == (file.st_dev, file.st_ino)

    async def wait(self, seconds: float) -> bool:
        """Return true after a write since the last call, false after ``seconds`` without one."""
        loop = asyncio.get_running_loop()
        written = asyncio.Event()
        # Not watched between two waits: a file that is written to a thousand times a second is one event.
        loop.add_reader(self._descriptor, written.set)
        try:
            await wait_at_most(written, seconds)
        finally:
            loop.remove_reader(self._descriptor)
        return self.read()

    def read(self) -> bool:
        """Return at once whether there was a write since the last call."""
        with contextlib.suppress(BlockingIOError):
            return bool(os.read(self._descriptor, 4096))
        return False

    def close(self) -> None:
        """End the reports."""
        os.close(self._descriptor)


_IN_MODIFY, _IN_ATTRIB, _IN_MOVE_SELF = 0x2, 0x4, 0x800
_REPORTED = _IN_MODIFY | _IN_ATTRIB | _IN_MOVE_SELF
"""A file that is open somewhere and is removed has one link less: that is an attribute."""


class NotifiedWakeup:
    """LISTEN on a channel of PostgreSQL. Payloads of notifications are ignored: anyone may send one.

    Those of its ``own`` backend are skipped: they report this program's own writes. A backend that floods is
    recorded in ``offences``, and for a while the listener is off: the reader polls.
    """

    def __init__(self, engine: Engine, channel: str, own: OwnBackend, offences: Offences) -> None:
        self._engine = engine
        self._channel = channel
        self._own = own
        self._offences = offences
        self.is_flooded = False
        """Whether the listener is off because of a flood."""
        self._news = asyncio.Event()
        self._trouble = TroubleNews()
        self._task: asyncio.Task[None] | None = None

    async def enable_notifications(self) -> bool:
        """Return true: every new row is notified."""
        return True

    async def wait(self, *, found: bool) -> None:
        """Return when something was written, or after a second."""
        await self.is_notified()

    async def is_notified(self) -> bool:
        """Return true when something was written or may be unheard, false after a second without that."""
        if self._task is None:
            self._task = asyncio.create_task(self._listen())
        if self.is_flooded:
            await asyncio.sleep(LONGEST_S)
            return True
        await wait_at_most(self._news, until_tick(FALLBACK_S))
        is_notified = self._news.is_set()
        self._news.clear()
        return is_notified

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
                    # Rows may have been written while the listener was off.
                    self._news.set()
                    await self._receive(connection)
            except FloodError as flood:
                log.warning("%s; nobody listens for %g s", flood, FLOOD_PAUSE_S)
                self._offences.add_flood(flood.backend)
                self.is_flooded = True
                self._news.set()
                await asyncio.sleep(FLOOD_PAUSE_S)
                self.is_flooded = False
                continue
            except (psycopg.Error, OSError) as error:
                if self._trouble.has("notifications", why := in_one_line(error)):
                    log.warning("notifications are lost, looking once a second meanwhile: %s", why)
            await asyncio.sleep(RETRY_AFTER_S)

    def _connect(self) -> Connection[Any]:
        import psycopg
        from psycopg import sql

        from .dialects import CONNECT_ARGUMENTS, ENDLESS

        arguments, options = self._engine.dialect.create_connect_args(self._engine.url)
        options = {**options, **CONNECT_ARGUMENTS, "autocommit": True}
        connection: Connection[Any] = psycopg.connect(*arguments, **options)
        connection.execute(ENDLESS)
        connection.execute(sql.SQL("listen {}").format(sql.Identifier(self._channel)))
        return connection

    async def _receive(self, connection: Connection[Any]) -> None:
        """Receive notifications until the connection is lost, which raises psycopg.Error."""
        loop = asyncio.get_running_loop()
        lost: asyncio.Future[None] = loop.create_future()
        own, rate = self._own, NotificationRate()

        def receive() -> None:
            try:
                connection.pgconn.consume_input()
                while notice := connection.pgconn.notifies():
                    if notice.be_pid != own.backend:
                        self._news.set()
                        rate.count(notice.be_pid, loop.time())
            except Exception as error:
                if not lost.done():
                    lost.set_exception(error)

        # Watches the socket itself: the driver's own way takes ten times the processor time per notification.
        # Uses a second descriptor: libpq closes its own as soon as the connection is lost, and a client
        # accepted while the loop still watches that one would get the same number, and not be served.
        number = os.dup(connection.fileno())
        try:
            loop.add_reader(number, receive)
            await lost
        finally:
            loop.remove_reader(number)
            os.close(number)


class FloodError(Exception):
    """One backend floods the channel with notifications."""

    def __init__(self, backend: int) -> None:
        super().__init__(f"backend {backend} sends more than {FLOOD} notifications in {FLOOD_WITHIN_S:g} s")
        self.backend = backend


class NotificationRate:
    """Counts recent notifications of each backend."""

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
    """Polls while there is much to do, and is notified of new rows when there is not.

    Notifications cost: PostgreSQL serialises the commits of transactions that notify, each waiting for the
    disk by itself. So writers check first whether the reader is awake, by a lock that it holds only while it
    dozes (migration 0006), and that none of them may hold while it begins to: so nothing is missed.
    """

    def __init__(
        self,
        listening: NotifiedWakeup,
        lock: ReaderLock,
    ) -> None:
        self._listening = listening
        self._polling = PollingWakeup()
        self._lock = lock
        self._dozes_in: int | None = None
        """The session of the lock while it is held: a lost connection has lost it."""
        self._pace = 0.0
        """Seconds to wait after a notification, as long as no rows followed the last ones."""

    async def enable_notifications(self) -> bool:
        """Begin to doze, or doze on; return false while a writer still assumes that the reader is awake."""
        # With the listener off it would sleep until the second is over.
        if self._listening.is_flooded:
            self._dozes_in = None
        elif self._dozes_in != self._lock.session:
            self._dozes_in = await self._take_lock()
        return self._dozes_in is not None

    async def _take_lock(self) -> int | None:
        """Take the lock, and return the session that has it; None where it cannot be had."""
        for _ in range(2):
            session = self._lock.session
            if not await self._lock.enable_notifications():
                return None
            # Else the connection was a new one by then, or is one by now: it is asked for once more.
            if self._lock.session == session:
                return session
        return None

    async def wait(self, *, found: bool) -> None:
        """Return when something was written, or after a second; while awake, after a pause."""
        if found:
            self._pace = 0.0
        if self._dozes_in is None:
            await self._polling.wait(found=found)
            return
        if not found:
            if not await self._listening.is_notified():
                # It has a look at the tables, and dozes on: writers notify meanwhile.
                return
            # One read of the tables serves any number of notifications.
            await asyncio.sleep(self._pace)
            self._pace = min(max(2 * self._pace, FIRST_PACE_S), LONGEST_S)
        self._dozes_in = None
        await self._lock.disable_notifications()

    async def close(self) -> None:
        """End the connection."""
        await self._listening.close()
