"""The database's thread: one connection, and the pieces of work that wait for it, together where they can."""

from __future__ import annotations

import asyncio
import contextlib
import logging
import threading
import time
from collections.abc import Callable, Sequence
from queue import Empty, SimpleQueue
from typing import Any, NamedTuple

from sqlalchemy import Connection, Engine
from sqlalchemy.exc import DBAPIError, SQLAlchemyError

from ..errors import DataRefusedError, StoreError, UncertainError
from .accounts.offences import Offences
from .accounts.stuck import BLOCKING_S, end_stuck
from .accounts.suspension import blocking_robots
from .engines.dialect import Dialect, Mode

log = logging.getLogger(__name__)

LARGEST_GROUP = 64
"""Pieces of work in one transaction: a commit waits for the disk, and they may as well wait together."""
ATTEMPTS = 5
WRONG_AT_ONCE_S = 1.0


class Job(NamedTuple):
    """A piece of work and who waits for it; ``alone`` keeps it out of any transaction."""

    work: Callable[..., Any]
    arguments: tuple[Any, ...]
    loop: asyncio.AbstractEventLoop
    future: asyncio.Future[Any]
    mode: Mode = Mode.WRITE
    alone: bool = False


Outcome = tuple[Job, Any, BaseException | None]


class Worker:
    """Does jobs in the order they came. What waits together is committed together, and fails by itself.

    A transaction that the database gave up, or whose connection turned out to be dead before its commit, is
    done again: work changes nothing but the database.
    """

    def __init__(
        self, engine: Engine, dialect: Dialect, where: str, patience: float | None, offences: Offences
    ) -> None:
        self._engine = engine
        self._dialect = dialect
        self._where = where
        self._patience = patience
        self._offences = offences
        self._jobs: SimpleQueue[Job | None] = SimpleQueue()
        self._connection: Connection | None = None
        self._since: float | None = None
        self._lock = threading.Lock()
        self._thread: threading.Thread | None = None
        self.backend: int | None = None
        self.session = 0
        """how many connections there have been, the present one included."""

    def submit(self, job: Job) -> None:
        """Have ``job`` done; its future tells when."""
        if self._thread is None:
            self._thread = threading.Thread(target=self._serve, name="database", daemon=True)
            self._thread.start()
        self._jobs.put(job)

    @property
    def waiting(self) -> int:
        """Return how many jobs wait."""
        return self._jobs.qsize()

    def close(self, timeout: float) -> None:
        """Close the connection when all is done that was submitted, and end the thread."""
        if self._thread is not None:
            self._jobs.put(None)
            self._thread.join(timeout)
        self._engine.dispose()

    def interrupt_if_stuck(self) -> None:
        """Cut the connection when the database has not answered for longer than a server's own limit."""
        with self._lock:
            if self._since is None or self._connection is None or self._patience is None:
                return
            if time.monotonic() - self._since > self._patience + 1:
                self._dialect.interrupt(self._connection.connection.driver_connection)

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

    def _do_in_order(self, group: list[Job]) -> None:
        group = [job for job in group if not job.future.cancelled()]
        last = group.pop() if group and group[-1].alone else None
        for jobs in (group, [last] if last else []):
            if jobs:
                _tell(self._do(jobs))

    def _do(self, jobs: list[Job]) -> list[Outcome]:
        began = time.monotonic()
        try:
            results = self._insist(jobs)
            return [(job, result, None) for job, result in zip(jobs, results, strict=True)]
        except StoreError as error:
            # One piece of work may be at fault; but not each of them is to wait for the database as long.
            one_is_wrong = self._connection is not None and time.monotonic() - began < WRONG_AT_ONCE_S
            if len(jobs) == 1 or not (one_is_wrong or isinstance(error, DataRefusedError)):
                return [(job, None, error) for job in jobs]
        except BaseException as error:
            if len(jobs) == 1:
                return [(jobs[0], None, error)]
        return [outcome for job in jobs for outcome in self._do([job])]

    def _insist(self, jobs: Sequence[Job]) -> list[Any]:
        """Do ``jobs`` in one transaction, again where that helps; raises StoreError and what they raise."""
        for attempt in range(1, ATTEMPTS + 1):
            fresh = self._connection is None
            began = time.monotonic()
            try:
                return self._attempt(jobs)
            except (UnicodeEncodeError, OverflowError) as error:
                # What a driver raises for a text or a number that it cannot even send.
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
            return self._make_way()
        # The server was restarted since this connection was last used; on a new one it may well go on.
        patience = self._patience or took
        return error.connection_invalidated and not fresh and took < patience

    def _make_way(self) -> bool:
        """End robots' transactions that may hold what the gateway waits for; tell whether that was done."""
        try:
            with self._connected().begin():
                self._offences.add_blocking(blocking_robots(self._connected(), BLOCKING_S))
                end_stuck(self._connected(), BLOCKING_S)
        except SQLAlchemyError as error:
            log.warning("database %s: %s", self._where, self._dialect.cause(error))
            return False
        finally:
            self._rest()
        return True

    def _attempt(self, jobs: Sequence[Job]) -> list[Any]:
        connection = self._connected()
        try:
            if jobs[0].alone:
                found = [job.work(connection, *job.arguments) for job in jobs]
                self._rest()
                return found
            transaction = self._dialect.begin(connection, max(job.mode for job in jobs))
            results = [job.work(connection, *job.arguments) for job in jobs]
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
        return results

    def _connected(self) -> Connection:
        if self._connection is None:
            connection = self._engine.connect()
            with self._lock:
                self._connection = connection
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
        """Let go of the connection, whatever state it is in."""
        with self._lock:
            connection, self._connection = self._connection, None
            self._since = None
        if connection is not None:
            with contextlib.suppress(SQLAlchemyError):
                connection.close()

    def _explain(self, error: SQLAlchemyError) -> StoreError:
        if self._dialect.refuses_data(error):
            return DataRefusedError(f"database {self._where} refuses a value: {self._dialect.cause(error)}")
        return StoreError(self._text(error))

    def _text(self, error: SQLAlchemyError) -> str:
        return f"database {self._where}: {self._dialect.cause(error)}; {self._dialect.advice}"


def _tell(outcomes: list[Outcome]) -> None:
    loops = {outcome[0].loop for outcome in outcomes}
    for loop in loops:
        # A loop that was closed has nobody left who waits.
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
