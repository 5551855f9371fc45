"""Database access: address, connections, transactions and retries."""

from __future__ import annotations

import asyncio
import contextlib
import logging
import threading
import time
from collections.abc import Callable, Coroutine, Sequence
from pathlib import Path
from queue import Empty, SimpleQueue
from typing import Any, NamedTuple, TypeVar

import sqlalchemy
from sqlalchemy import URL, Connection, Engine
from sqlalchemy.exc import ArgumentError, DBAPIError, NoSuchModuleError, SQLAlchemyError

from ...core.errors import DataRefusedError, LockedError, StoreError, UncertainError
from ...core.logs import log_and_continue
from ..monitoring import until_tick
from . import revisions
from .dialects import PATIENCE_S, Dialect, Durability, MariaDB, PostgreSQL, SQLite
from .roles.blocking_sessions import BLOCKING_S, Offences, blocking_robots, end_blocking_sessions
from .rows import WorkDone, do_together
from .wakeups import GATEWAY_CHANNEL, AdaptiveWakeup, LogWakeup, NotifiedWakeup, PollingWakeup, Wakeup

# --- Database URLs: read, and shown without a password ---

FORMS = "sqlite:////path/fleet.db, postgresql://account@host/database or mariadb://account@host/database"
_OTHERS = 0o007


def read_address(text: str, password_file: Path | None = None) -> URL:
    """Return the URL in ``text``, with the password in ``password_file``; raises StoreError."""
    try:
        url = sqlalchemy.make_url(text)
    except (ArgumentError, ValueError):
        # Anything before an @ may be a password.
        raise StoreError(
            f"database URL {text.rpartition('@')[2]!r} cannot be read; write it like {FORMS}"
        ) from None
    if isinstance(_dialect(url), SQLite) and url.database in (None, "", ":memory:"):
        # SQLite would keep it in memory: commands reported as queued would be lost with the process.
        raise StoreError(f"database {shown(url)}: no file is named; write it like sqlite:////path/fleet.db")
    secret = sorted({"password", "passwd", "passfile"} & {key.lower() for key in url.query})
    if secret:
        raise StoreError(
            f"database {shown(url)}: {secret[0]} does not belong into the URL; write the password into a "
            "file and name it with --database-password-file"
        )
    return url if password_file is None else url.set(password=read_password(password_file))


def shown(url: URL) -> str:
    """Return ``url`` for printing: without its password and driver options."""
    if url.get_backend_name() != "sqlite":
        url = url.set(query={})
    return url.render_as_string(hide_password=True)


def open_engine(url: URL, patience: float | None = PATIENCE_S) -> tuple[Engine, Dialect]:
    """Return an engine on ``url`` and the dialect of its database; raises StoreError."""
    dialect = _dialect(url)
    try:
        return dialect.engine(url, patience), dialect
    except (ModuleNotFoundError, NoSuchModuleError) as error:
        raise StoreError(
            f"database {shown(url)}: its driver is missing ({error}); install it with: "
            f"pip install 'fleet-supervisor-robot-bridge[{dialect.name}]'"
        ) from None
    except (ArgumentError, TypeError, ValueError) as error:
        raise StoreError(f"database {shown(url)}: {error}; write the URL like {FORMS}") from None


def _dialect(url: URL) -> Dialect:
    for kind in (SQLite, PostgreSQL, MariaDB):
        if url.drivername == kind.name:
            return kind()
    raise StoreError(f"database {shown(url)}: {url.drivername} is not supported; write {FORMS}")


def read_password(file: Path) -> str:
    """Return the first line of a file that other accounts cannot read; raises StoreError."""
    try:
        open_to_others = file.stat().st_mode & _OTHERS
        lines = file.read_text(encoding="utf-8").splitlines()
    except (OSError, UnicodeDecodeError) as error:
        reason = getattr(error, "strerror", None) or "it is no text"
        raise StoreError(f"password file {file}: {reason}; write the password into its first line") from None
    if open_to_others:
        raise StoreError(f"password file {file} can be read by every account here; run: chmod 600 {file}")
    if not lines or not lines[0]:
        raise StoreError(f"password file {file} is empty; write the password into its first line")
    return lines[0]


# --- The database thread: one connection, and the queued jobs, grouped into transactions where possible

log = logging.getLogger(__name__)

LARGEST_GROUP = 64
"""Jobs in one transaction: a commit waits for the disk, so that jobs share the wait."""
ATTEMPTS = 5
WRONG_AT_ONCE_S = 1.0
LOCKED_FOR_S = 5.0
"""Seconds after a failed wait for a lock in which other work waits only briefly: a session that the gateway
cannot end, such as an administrator's, may lock a table for minutes, and most work needs other tables."""
LOCKED_TOGETHER_S = 2.0
"""Seconds in which batched work may wait for locks, one after the other; then once for each kind."""


class DatabaseJob(NamedTuple):
    """A piece of work with its future; ``alone`` keeps it out of any transaction."""

    work: Callable[..., Any]
    arguments: tuple[Any, ...]
    loop: asyncio.AbstractEventLoop
    future: asyncio.Future[Any]
    mode: Durability = Durability.WRITE
    alone: bool = False


Outcome = tuple[DatabaseJob, Any, BaseException | None]


class DatabaseWorker:
    """Runs jobs in their order of arrival, batched work with the first of its kind.

    What waits together is committed together, reported in the order in which it was done, and fails by
    itself: it is done again by halves.
    A transaction that the database gave up, or whose connection turned out to be dead before its commit, is
    done again: work changes nothing but the database. What needs something that somebody else has locked
    fails, and holds up nothing else for longer than two seconds.
    """

    def __init__(
        self, engine: Engine, dialect: Dialect, where: str, patience: float | None, offences: Offences
    ) -> None:
        self._engine = engine
        self._dialect = dialect
        self._where = where
        self._patience = patience
        self._offences = offences
        self._jobs: SimpleQueue[DatabaseJob | None] = SimpleQueue()
        self._connection: Connection | None = None
        self._driver: Any = None
        """the driver's own connection: another thread must not ask SQLAlchemy's, which may connect again."""
        self._since: float | None = None
        self._locked_until = 0.0
        self._lock = threading.Lock()
        self._thread: threading.Thread | None = None
        self.backend: int | None = None
        self.session = 0
        """number of connections so far, the present one included."""

    def submit(self, job: DatabaseJob) -> None:
        """Queue ``job``; its future resolves when it is done."""
        if self._thread is None:
            self._thread = threading.Thread(target=self._serve, name="database", daemon=True)
            self._thread.start()
        self._jobs.put(job)

    @property
    def waiting(self) -> int:
        """Return the number of waiting jobs."""
        return self._jobs.qsize()

    def close(self, timeout: float) -> None:
        """Close the connection once all submitted jobs are done, and end the thread."""
        if self._thread is not None:
            self._jobs.put(None)
            self._thread.join(timeout)
        self._engine.dispose()

    def interrupt_if_stuck(self) -> None:
        """Cut the connection when the database has not answered for longer than a server's own limit."""
        with self._lock:
            if self._since is None or self._driver is None or self._patience is None:
                return
            if time.monotonic() - self._since > self._patience + 1:
                self._dialect.interrupt(self._driver)

    def _serve(self) -> None:
        while (job := self._jobs.get()) is not None:
            group = [job]
            while not group[-1].alone and len(group) < LARGEST_GROUP:
                try:
                    following = self._jobs.get_nowait()
                except Empty:
                    break
                if following is None:
                    self._jobs.put(None)
                    break
                group.append(following)
            self._do_in_order(group)
        self._drop()

    def _do_in_order(self, group: list[DatabaseJob]) -> None:
        group = [job for job in group if not job.future.cancelled()]
        last = group.pop() if group and group[-1].alone else None
        for jobs in (group, [last] if last else []):
            if jobs:
                _report(self._do(jobs))

    def _do(self, jobs: list[DatabaseJob]) -> list[Outcome]:
        began = time.monotonic()
        try:
            return [(jobs[done.number], done.result, None) for done in self._run_with_retry(jobs)]
        except StoreError as error:
            if len(jobs) > 1 and isinstance(error, LockedError):
                return self._one_by_one(jobs)
            # One piece of work may be at fault; but not each of them is to wait for the database as long.
            at_once = time.monotonic() - began < WRONG_AT_ONCE_S
            one_is_wrong = _is_of_work(error) or (at_once and self._connection is not None)
            if len(jobs) == 1 or not one_is_wrong:
                # A full disk refuses commits but can be read.
                reads = [job for job in jobs if job.mode is Durability.READ] if at_once else []
                others = [job for job in jobs if job not in reads]
                if not (reads and others):
                    return [(job, None, error) for job in jobs]
                return [*((job, None, error) for job in others), *self._do(reads)]
        except BaseException as error:
            if len(jobs) == 1:
                return [(jobs[0], None, error)]
        half = len(jobs) // 2
        return [*self._do(jobs[:half]), *self._do(jobs[half:])]

    def _one_by_one(self, jobs: list[DatabaseJob]) -> list[Outcome]:
        """Do jobs of which some need what somebody has locked: only those fail."""
        began = time.monotonic()
        outcomes: list[Outcome] = []
        locked: dict[tuple[Any, ...], BaseException] = {}
        for job in jobs:
            kind = (job.work, *(one for one in job.arguments if callable(one)))
            if kind in locked and time.monotonic() - began > LOCKED_TOGETHER_S:
                outcomes.append((job, None, locked[kind]))
                continue
            outcomes += self._do([job])
            error = outcomes[-1][2]
            if isinstance(error, LockedError):
                locked[kind] = error
        return outcomes

    def _run_with_retry(self, jobs: Sequence[DatabaseJob]) -> list[WorkDone]:
        """Run ``jobs`` in one transaction, with retries; raises StoreError and what they raise."""
        for attempt in range(1, ATTEMPTS + 1):
            fresh = self._connection is None
            began = time.monotonic()
            try:
                return self._attempt(jobs)
            except (UnicodeEncodeError, OverflowError) as error:
                # Raised by a driver for a text or number that it cannot even send.
                raise DataRefusedError(f"database {self._where} refuses a value: {error}") from error
            except SQLAlchemyError as error:
                if not self._worth_repeating(error, attempt, fresh, time.monotonic() - began):
                    raise self._explain(error) from error
        raise AssertionError("the last attempt ended the loop")

    def _worth_repeating(self, error: SQLAlchemyError, attempt: int, fresh: bool, took: float) -> bool:
        if not isinstance(error, DBAPIError) or attempt == ATTEMPTS:
            return False
        if self._dialect.deadlocked(error):
            return True
        if self._dialect.kept_waiting(error):
            # Who is no robot is not ended, and may keep what is locked for minutes.
            return self._end_blockers() or (attempt == 1 and not self._waits_briefly)
        # The server was restarted since this connection was last used; on a new one it may well go on.
        patience = self._patience or took
        return error.connection_invalidated and not fresh and took < patience

    @property
    def _waits_briefly(self) -> bool:
        return time.monotonic() < self._locked_until

    def _end_blockers(self) -> bool:
        """End robots' transactions that may hold what the gateway waits for; tell whether there were any."""
        try:
            with self._connected().begin():
                robots = blocking_robots(self._connected(), BLOCKING_S)
                self._offences.add_blocking(robots)
                ended = end_blocking_sessions(self._connected(), BLOCKING_S)
        except SQLAlchemyError as error:
            log.warning("database %s: %s", self._where, self._dialect.cause(error))
            return False
        finally:
            self._rest()
        return ended or bool(robots)

    def _attempt(self, jobs: Sequence[DatabaseJob]) -> list[WorkDone]:
        connection = self._connected()
        asked = [(job.work, job.arguments) for job in jobs]
        self._dialect.wait_for_locks(connection, briefly=self._waits_briefly)
        try:
            if jobs[0].alone:
                done = do_together(connection, asked)
                self._rest()
                return done
            transaction = self._dialect.begin(connection, max(job.mode for job in jobs))
            done = do_together(connection, asked)
        except BaseException:
            self._roll_back(connection)
            raise
        try:
            transaction.commit()
        except DBAPIError as error:
            self._drop()
            if error.connection_invalidated:
                raise UncertainError(self._text(error)) from error
            raise
        finally:
            self._rest()
        return done

    def _connected(self) -> Connection:
        if self._connection is not None and self._connection.invalidated:
            # It would connect again by itself, as a connection that nobody watches.
            self._drop()
        if self._connection is None:
            connection = self._engine.connect()
            with self._lock:
                self._connection, self._driver = connection, connection.connection.driver_connection
            self.session += 1
            self.backend = self._dialect.backend(connection)
        self._since = time.monotonic()
        return self._connection

    def _rest(self) -> None:
        with self._lock:
            self._since = None

    def _roll_back(self, connection: Connection) -> None:
        try:
            if connection.in_transaction():
                connection.get_transaction().rollback()  # type: ignore[union-attr]
            if connection.invalidated:
                self._drop()
        except SQLAlchemyError:
            self._drop()
        finally:
            self._rest()

    def _drop(self) -> None:
        """Discard the connection, whatever state it is in."""
        with self._lock:
            connection, self._connection = self._connection, None
            self._driver = self._since = None
        if connection is not None:
            with contextlib.suppress(SQLAlchemyError):
                connection.close()

    def _explain(self, error: SQLAlchemyError) -> StoreError:
        if self._dialect.refuses_data(error):
            return DataRefusedError(f"database {self._where} refuses a value: {self._dialect.cause(error)}")
        if isinstance(error, DBAPIError) and self._dialect.kept_waiting(error):
            if not self._waits_briefly:
                # Not prolonged by what waited briefly: once in so many seconds a lock has its time to end.
                self._locked_until = time.monotonic() + LOCKED_FOR_S
            return LockedError(self._text(error))
        return StoreError(self._text(error))

    def _text(self, error: SQLAlchemyError) -> str:
        return f"database {self._where}: {self._dialect.cause(error)}; {self._dialect.advice_on(error)}"


def _is_of_work(error: StoreError) -> bool:
    """Return whether the work or a value in it is at fault, not the database."""
    return isinstance(error, DataRefusedError) or not isinstance(error.__cause__, SQLAlchemyError)


def _report(outcomes: list[Outcome]) -> None:
    loops = {outcome[0].loop for outcome in outcomes}
    for loop in loops:
        # On a closed loop nobody waits any more.
        with contextlib.suppress(RuntimeError):
            loop.call_soon_threadsafe(_settle, [outcome for outcome in outcomes if outcome[0].loop is loop])


def _settle(outcomes: list[Outcome]) -> None:
    for job, result, error in outcomes:
        if job.future.done():
            continue
        if error is None:
            job.future.set_result(result)
        else:
            job.future.set_exception(error)


# --- The database: one connection in a thread of its own, so that the event loop never waits for a disk.
# A second one, opened on first use, ends whatever blocks the first one.

T = TypeVar("T")
WATCH_INTERVAL_S = 1.0


class Database:
    """Runs pieces of work, each in a transaction: ``await database.run(work, *arguments)``.

    ``work`` is called as ``work(connection, *arguments)`` in the database's thread. Its transaction is
    committed when ``run`` returns and rolled back when it raises. It must do nothing but use the database: a
    repeated transaction calls it again. Work that waits together shares a transaction, and a
    :class:`.BatchedWork` its statements too.

    ``patience`` is the limit of one statement in seconds; None is for long work.
    """

    def __init__(self, address: str | URL, patience: float | None = PATIENCE_S) -> None:
        self.url = read_address(address) if isinstance(address, str) else address
        self._engine, self.dialect = open_engine(self.url, patience)
        self.offences = Offences()
        """Offences of robots' accounts against others."""
        self._worker, self._aside = (
            DatabaseWorker(self._engine, self.dialect, shown(self.url), patience, self.offences)
            for _ in range(2)
        )
        self._watch: asyncio.Task[None] | None = None
        self._observers: list[Callable[[float], None]] = []

    @property
    def where(self) -> str:
        """The database's URL without its password."""
        return shown(self.url)

    def add_observer(self, observe: Callable[[float], None]) -> None:
        """Call ``observe`` with the duration of each piece of work in seconds, waiting included."""
        self._observers.append(observe)

    async def open(self) -> None:
        """Check that the tables match this version; on SQLite, create missing ones.

        :raises StoreError: when the database cannot be used, or must be created or upgraded first.
        """
        create = await self.run(revisions.must_create, self.where, self.dialect.made_by_serve)
        if create:
            await self.run(revisions.create)

    async def run(self, work: Callable[..., T], *arguments: Any) -> T:
        """Run ``work`` in a transaction.

        :raises DataRefusedError: when the database refuses a value, whoever gave it.
        :raises LockedError: when somebody else has something locked that it needs.
        :raises UncertainError: when the connection was lost during the commit.
        :raises StoreError: when the database cannot be used; the transaction was not done.
        """
        return await self._timed(work, arguments, Durability.WRITE)

    async def write_relaxed(self, work: Callable[..., T], *arguments: Any) -> T:
        """As :meth:`run`, but a power cut may undo it, though never before earlier work."""
        return await self._timed(work, arguments, Durability.RELAXED)

    async def read(self, work: Callable[..., T], *arguments: Any) -> T:
        """As :meth:`run`, for work that changes nothing; its statements may each see a newer state."""
        return await self._timed(work, arguments, Durability.READ)

    async def version(self) -> int | None:
        """Return a number that changes when another connection wrote, or None without such a number."""
        if not self.dialect.has_version:
            return None
        result: int | None = await self._submit(self.dialect.version, (), Durability.READ, alone=True)
        return result

    async def run_aside(self, work: Callable[..., T], *arguments: Any) -> T:
        """As :meth:`run`, on a second connection: a blocked first one does not delay it."""
        result: T = await self._submit(work, arguments, Durability.WRITE, worker=self._aside)
        return result

    async def end_stuck(self) -> None:
        """End robots' transactions that take too long; raises StoreError."""
        await self.run_aside(end_blocking_sessions)

    def wakeup(self, channel: str) -> Wakeup:
        """Return a waiter for new rows; ``channel`` is one that the triggers notify."""
        if not self.dialect.listens:
            log = self.dialect.log_of(self.url)
            return PollingWakeup() if log is None else LogWakeup(log)
        listening = NotifiedWakeup(self._engine, channel, self._worker, self.offences)
        if channel != GATEWAY_CHANNEL:
            return listening
        return AdaptiveWakeup(listening, self)

    async def enable_notifications(self) -> bool:
        """Have writers notify of new rows; return false while a writer does not yet. Raises StoreError."""
        return await self.read(self.dialect.enable_notifications)

    async def disable_notifications(self) -> None:
        """Have writers stop notifying; raises StoreError."""
        await self.read(self.dialect.disable_notifications)

    @property
    def session(self) -> int:
        """Return a number that changes with every new connection."""
        return self._worker.session

    @property
    def waiting(self) -> int:
        """Return the number of pieces of work that wait for the database."""
        return self._worker.waiting

    async def close(self, within: float = 2 * PATIENCE_S) -> None:
        """Close the connection and end the thread; one that takes longer than ``within`` seconds is left."""
        if self._watch is not None:
            self._watch.cancel()
        until = time.monotonic() + within
        for worker in (self._worker, self._aside):
            await asyncio.to_thread(worker.close, max(until - time.monotonic(), 0.0))

    async def _timed(self, work: Callable[..., T], arguments: tuple[Any, ...], mode: Durability) -> T:
        began = time.perf_counter()
        try:
            result: T = await self._submit(work, arguments, mode)
        finally:
            seconds = time.perf_counter() - began
            for observe in self._observers:
                observe(seconds)
        return result

    async def _submit(
        self,
        work: Callable[..., Any],
        arguments: tuple[Any, ...],
        mode: Durability,
        *,
        alone: bool = False,
        worker: DatabaseWorker | None = None,
    ) -> Any:
        loop = asyncio.get_running_loop()
        if self._watch is None:
            self._watch = loop.create_task(self._watch_over())
        future: asyncio.Future[Any] = loop.create_future()
        (worker or self._worker).submit(DatabaseJob(work, arguments, loop, future, mode, alone))
        return await future

    async def _watch_over(self) -> None:
        """Cut the connection to a server that does not answer: a frozen one enforces no limits of its own."""
        while True:
            await asyncio.sleep(until_tick(WATCH_INTERVAL_S))
            for worker in (self._worker, self._aside):
                with log_and_continue(log, "cutting the connection to a database that does not answer"):
                    worker.interrupt_if_stuck()


def start_task(work: Coroutine[Any, Any, T]) -> asyncio.Task[T]:
    """Start ``work`` as a task whose error is not logged by asyncio where nobody awaits it any more."""
    task = asyncio.create_task(work)
    task.add_done_callback(lambda done: done.cancelled() or done.exception())
    return task


async def to_its_end(work: Coroutine[Any, Any, T]) -> T:
    """Await ``work``, which continues when the wait is cancelled: the gateway must know what is stored."""
    return await asyncio.shield(start_task(work))


def run_once(address: str | URL, work: Callable[..., T], *arguments: Any) -> T:
    """Run ``work`` in a transaction on its own connection, for programs that end afterwards."""

    async def once() -> T:
        async with contextlib.AsyncExitStack() as stack:
            database = Database(address, patience=None)
            stack.push_async_callback(database.close)
            return await database.run(work, *arguments)

    return asyncio.run(once())
