"""The database: one connection in one thread of its own, so that the event loop never waits for a disk."""

from __future__ import annotations

import asyncio
import contextlib
import time
from collections.abc import Callable, Coroutine
from typing import Any, TypeVar

from sqlalchemy import URL, Connection

from . import revisions
from .accounts.offences import Offences
from .accounts.stuck import end_stuck
from .address import open_engine, read_address, shown
from .engines.dialect import PATIENCE_S, Mode
from .wakeups import GATEWAY_CHANNEL, Dozing, Listening, Polling, Wakeup
from .worker import Job, Worker

T = TypeVar("T")
WATCH_INTERVAL_S = 1.0


class Database:
    """Runs pieces of work, each in a transaction: ``await database.run(work, *arguments)``.

    ``work`` is called as ``work(connection, *arguments)`` in the database's thread. Its transaction is
    committed when ``run`` returns and rolled back when it raises. It must do nothing but use the database:
    where a transaction has to be done again, it is called again; work that waits together shares one.

    ``patience`` is how many seconds a statement may take; None is for work that takes long.
    """

    def __init__(self, address: str | URL, patience: float | None = PATIENCE_S) -> None:
        self.url = read_address(address) if isinstance(address, str) else address
        self._engine, self.dialect = open_engine(self.url, patience)
        self.offences = Offences()
        """What robots' accounts do to others."""
        self._worker = Worker(self._engine, self.dialect, shown(self.url), patience, self.offences)
        self._watch: asyncio.Task[None] | None = None
        self.observe: Callable[[float], None] = _pass_over
        """Called with the seconds that each piece of work took, waiting included."""

    @property
    def where(self) -> str:
        """The database's URL without its password."""
        return shown(self.url)

    async def open(self) -> None:
        """Check that the tables are those of this version; SQLite's are made where there are none.

        :raises StoreError: when the database cannot be used, or has to be created or upgraded first.
        """
        create = await self.run(revisions.must_create, self.where, self.dialect.made_by_serve)
        if create:
            await self.run(revisions.create)

    async def run(self, work: Callable[..., T], *arguments: Any) -> T:
        """Run ``work`` in a transaction.

        :raises DataRefusedError: when the database refuses a value, whoever gave it.
        :raises UncertainError: when the connection was lost during the commit.
        :raises StoreError: when the database cannot be used; the transaction was not done.
        """
        return await self._timed(work, arguments, Mode.WRITE)

    async def jot(self, work: Callable[..., T], *arguments: Any) -> T:
        """As :meth:`run`, but a power cut may undo it, though never before what was done earlier."""
        return await self._timed(work, arguments, Mode.JOT)

    async def read(self, work: Callable[..., T], *arguments: Any) -> T:
        """As :meth:`run`, for work that changes nothing; its statements may each see a newer state."""
        return await self._timed(work, arguments, Mode.READ)

    async def version(self) -> int | None:
        """Return a number that changes when another connection wrote, or None where there is none."""
        if not self.dialect.has_version:
            return None
        result: int | None = await self._submit(self.dialect.version, (), Mode.READ, alone=True)
        return result

    async def run_alone(self, work: Callable[..., T], *arguments: Any) -> T:
        """Run ``work`` outside of any transaction: it begins and ends its own; raises StoreError."""
        result: T = await self._submit(work, arguments, Mode.READ, alone=True)
        return result

    async def end_stuck(self) -> None:
        """End robots' transactions that take too long; raises StoreError."""
        await self._submit(_end_stuck, (), Mode.READ, alone=True)

    def wakeup(self, channel: str) -> Wakeup:
        """Return what tells when it is time to look for new rows; ``channel`` is one of the triggers'."""
        if not self.dialect.listens:
            return Polling()
        listening = Listening(self._engine, channel, lambda: self._worker.backend, self.offences)
        if channel != GATEWAY_CHANNEL:
            return listening
        return Dozing(listening, lambda: self.read(self.dialect.doze), lambda: self.read(self.dialect.rouse))

    @property
    def session(self) -> int:
        """Return a number that changes whenever the connection is a new one."""
        return self._worker.session

    @property
    def waiting(self) -> int:
        """Return how many pieces of work wait for the database."""
        return self._worker.waiting

    async def close(self, within: float = 2 * PATIENCE_S) -> None:
        """Close the connection and end the thread; one that takes longer than ``within`` seconds is left."""
        if self._watch is not None:
            self._watch.cancel()
        await asyncio.to_thread(self._worker.close, within)

    async def _timed(self, work: Callable[..., T], arguments: tuple[Any, ...], mode: Mode) -> T:
        began = time.perf_counter()
        try:
            result: T = await self._submit(work, arguments, mode)
        finally:
            self.observe(time.perf_counter() - began)
        return result

    async def _submit(
        self, work: Callable[..., Any], arguments: tuple[Any, ...], mode: Mode, *, alone: bool = False
    ) -> Any:
        loop = asyncio.get_running_loop()
        if self._watch is None:
            self._watch = loop.create_task(self._watch_over())
        future: asyncio.Future[Any] = loop.create_future()
        self._worker.submit(Job(work, arguments, loop, future, mode, alone))
        return await future

    async def _watch_over(self) -> None:
        """Cut the connection to a server that does not answer: a frozen one keeps no limits of its own."""
        while True:
            await asyncio.sleep(WATCH_INTERVAL_S)
            self._worker.interrupt_if_stuck()


async def to_its_end(work: Coroutine[Any, Any, T]) -> T:
    """Await ``work``, which goes on when the waiting is cancelled: what is stored must be known here, too."""
    task = asyncio.ensure_future(work)
    task.add_done_callback(lambda done: done.cancelled() or done.exception())
    return await asyncio.shield(task)


def _pass_over(_seconds: float) -> None:
    """Take no note."""


def _end_stuck(connection: Connection) -> None:
    with connection.begin():
        end_stuck(connection)


def run_once(address: str | URL, work: Callable[..., T], *arguments: Any) -> T:
    """Run ``work`` in a transaction of a connection of its own, for programs that end after it."""

    async def once() -> T:
        async with contextlib.AsyncExitStack() as stack:
            database = Database(address, patience=None)
            stack.push_async_callback(database.close)
            return await database.run(work, *arguments)

    return asyncio.run(once())
