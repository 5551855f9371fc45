"""One gateway at a time on a database: a lock that ends with the process that holds it.

SQLite: a lock on a file beside the database. PostgreSQL: a lock on table ``bridge``; MariaDB: a lock on a row
of it; each in a transaction that stays open and changes nothing, so that it blocks nobody. Advisory
locks would do as well if robots' accounts could not take them.
"""

from __future__ import annotations

import asyncio
import contextlib
import hashlib
import json
import logging
import os
import random
import socket
import time
import uuid
from collections.abc import AsyncIterator
from pathlib import Path
from typing import Any, ClassVar, Protocol

from sqlalchemy import URL, Connection, Engine, inspect, select, text, update
from sqlalchemy.exc import DBAPIError, SQLAlchemyError

from ...core.errors import BridgeError, FatalError, StoreError, listed_names
from ...core.files import write_state
from ...core.json_decoder import SHORT, DecodingError, decode_json
from ...core.logs import TroubleNews
from ..monitoring import until_tick
from .database import Database, open_engine, shown
from .dialects import Dialect, SQLite, sqlite_file_of
from .repositories import gateways as stored_gateways
from .repositories.metadata import database_id, fact, message_count, renew_id
from .schema import bridge, gateways

log = logging.getLogger(__name__)

PING_INTERVAL = 2.0
GHOST_S = 15
"""seconds after which a server takes the lock from a gateway that it no longer hears from."""
PATIENCE_AT_START = 2.0
"""seconds for a server to notice that the previous gateway was killed."""
GATEWAY = "gateway"
"""The purpose that a gateway states."""
RUN, ROW = "gateway", "gateway_lock"
"""The rows of ``bridge`` with the running gateway, and with the lock."""

_TAKEN = {"55P03", 1205}
"""Error codes of PostgreSQL and MariaDB when the lock is held elsewhere."""


class GatewayLock(Protocol):
    """A lock on one kind of database; all methods block, so they are called in a thread."""

    may_be_lost: ClassVar[bool]
    """Whether it can be lost while the process lives: it is pinged then."""

    def acquire(self) -> bool:
        """Take the lock; return false when it is held elsewhere."""

    def ping(self) -> None:
        """Raise StoreError when the lock is not held any more."""

    def write(self, run: dict[str, Any]) -> None:
        """Store which gateway runs."""

    def read(self) -> dict[str, Any]:
        """Return the gateway that was stored last."""

    def fleet(self) -> list[str]:
        """Return the gateways that serve the database together, without this lock."""

    def release(self) -> None:
        """Release the lock."""


class SingletonLock:
    """Ensures that this is the only gateway on its database.

    ``does`` names any other holder: work during which no gateway may run.
    """

    def __init__(self, url: URL, does: str = GATEWAY) -> None:
        self._where = shown(url)
        self._lock: GatewayLock = FileLock(url) if url.get_backend_name() == "sqlite" else ServerLock(url)
        self._does = does
        self._news = TroubleNews()
        self._run = {
            "run": uuid.uuid4().hex,
            "does": does,
            "host": socket.gethostname(),
            "process": os.getpid(),
            "since": round(time.time()),
        }

    async def acquire(self) -> None:
        """Take the database; raises BridgeError when another gateway runs on it."""
        until = time.monotonic() + PATIENCE_AT_START
        while not await asyncio.to_thread(self._lock.acquire):
            if time.monotonic() > until:
                other = await asyncio.to_thread(self._lock.read)
                raise BridgeError(f"database {self._where}: {_taken(self._does, other)}")
            await asyncio.sleep(0.1)
        # After the lock: a gateway of a fleet registers first, and checks the lock then.
        if fleet := await asyncio.to_thread(self._lock.fleet):
            await self.release()
            raise BridgeError(f"database {self._where}: {_serve_together(self._does, fleet)}")
        await asyncio.to_thread(self._lock.write, self._run)

    async def hold(self) -> None:
        """Keep the database until cancelled.

        :raises FatalError: when another gateway has taken it over while this one was cut off from it.
        """
        while True:
            await asyncio.sleep(until_tick(PING_INTERVAL))
            if not self._lock.may_be_lost:
                continue
            try:
                await asyncio.to_thread(self._lock.ping)
            except StoreError as error:
                if self._news.has("lock", str(error)):
                    log.error("%s; its lock is taken anew as soon as it is back", error)
                await self._reacquire()

    async def release(self) -> None:
        """Release the database."""
        await asyncio.to_thread(self._lock.release)

    async def _reacquire(self) -> None:
        while True:
            try:
                taken = await asyncio.to_thread(self._lock.acquire)
                other = await asyncio.to_thread(self._lock.read)
            except StoreError:
                await asyncio.sleep(until_tick(PING_INTERVAL))
                continue
            if other.get("run") != self._run["run"]:
                raise FatalError(
                    f"database {self._where}: another gateway{_named(other)} took it over while this one was "
                    "cut off from it; this one ends"
                )
            if taken:
                return
            # The server has not noticed yet that the previous connection is gone.
            await asyncio.sleep(until_tick(PING_INTERVAL))


@contextlib.asynccontextmanager
async def no_gateway(url: URL, does: str) -> AsyncIterator[None]:
    """Keep gateways off a database while a command ``does`` its work there.

    The work must not alter table ``bridge`` itself, which is locked.

    :raises BridgeError: when a gateway runs on it; StoreError when the database cannot be used.
    """
    if not await asyncio.to_thread(_has_lock, url):
        yield
        return
    sole = SingletonLock(url, does)
    await sole.acquire()
    try:
        yield
    finally:
        await sole.release()


class FileLock:
    """A lock on a file beside an SQLite database; the system releases it with the process."""

    may_be_lost: ClassVar[bool] = False

    def __init__(self, url: URL) -> None:
        self._url = url
        self._file: int | None = None

    def acquire(self) -> bool:
        """Take the lock; a database in memory has none, as nobody else can open it."""
        import fcntl

        path = self._path()
        if path is None:
            return True
        try:
            file = os.open(path, os.O_RDWR | os.O_CREAT | os.O_CLOEXEC, 0o600)
        except OSError as error:
            raise StoreError(
                f"the lock {path} cannot be written: {error.strerror}; check the folder's rights"
            ) from error
        try:
            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except OSError:
            os.close(file)
            return False
        self._file = file
        return True

    def ping(self) -> None:
        """Do nothing: the lock is held as long as the process lives."""

    def write(self, run: dict[str, Any]) -> None:
        """Store which gateway runs."""
        if self._file is not None:
            os.ftruncate(self._file, 0)
            os.pwrite(self._file, json.dumps(run).encode(), 0)

    def read(self) -> dict[str, Any]:
        """Return the gateway that was stored last."""
        path = self._path()
        with contextlib.suppress(OSError):
            return _run_in(path.read_text(encoding="utf-8") if path else None)
        return {}

    def fleet(self) -> list[str]:
        """Return none: one gateway serves a file."""
        return []

    def release(self) -> None:
        """Give the lock back; its file stays, since another process may wait for it already."""
        if self._file is not None:
            os.close(self._file)
            self._file = None

    def _path(self) -> Path | None:
        with _explained(self._url, SQLite()):
            file = sqlite_file_of(self._url)
        return None if file is None else Path(f"{file}.gateway")


class ServerLock:
    """A lock in a transaction of its own connection, which the server ends when the connection is silent."""

    may_be_lost: ClassVar[bool] = True

    def __init__(self, url: URL) -> None:
        self._url = url
        self._engine, self._dialect = open_engine(url)
        self._statements = _LOCKING[self._dialect.name]
        self._connection: Connection | None = None

    def acquire(self) -> bool:
        """Take the lock."""
        self.release()
        with _explained(self._url, self._dialect):
            _make_row(self._engine)
            connection = self._engine.connect()
            try:
                for statement in self._statements:
                    connection.execute(text(statement))
            except DBAPIError as error:
                connection.close()
                if _codes(error) & _TAKEN:
                    return False
                raise
        self._connection = connection
        return True

    def ping(self) -> None:
        """Use the connection, so that the server knows that it is alive."""
        with _explained(self._url, self._dialect):
            assert self._connection is not None
            self._connection.execute(text("select 1"))

    def write(self, run: dict[str, Any]) -> None:
        """Store which gateway runs."""
        with _explained(self._url, self._dialect), self._engine.begin() as connection:
            connection.execute(update(bridge).where(bridge.c.name == RUN).values(value=json.dumps(run)))

    def read(self) -> dict[str, Any]:
        """Return the gateway that was stored last."""
        with _explained(self._url, self._dialect), self._engine.connect() as connection:
            return _run_in(connection.scalar(select(bridge.c.value).where(bridge.c.name == RUN)))

    def fleet(self) -> list[str]:
        """Return the gateways that serve the database together; an older version had no table of them."""
        if self._dialect.name != "postgresql":
            return []
        with _explained(self._url, self._dialect), self._engine.connect() as connection:
            if not inspect(connection).has_table(gateways.name):
                return []
            return sorted(member.gw for member in stored_gateways.members(connection) if member.alive)

    def is_free(self) -> bool:
        """Return whether the lock is free; it is held only during the check."""
        try:
            return self.acquire()
        finally:
            self.release()

    def release(self) -> None:
        """Release the lock."""
        connection, self._connection = self._connection, None
        if connection is not None:
            with contextlib.suppress(SQLAlchemyError):
                connection.close()


def check_no_sole_gateway(url: URL) -> None:
    """Raise BridgeError if a sole gateway, or a command that excludes gateways, holds the database.

    Called by a gateway that has registered among those that serve it together. Blocks.
    """
    lock, until = ServerLock(url), time.monotonic() + PATIENCE_AT_START
    # Another gateway that checks holds it for a moment, too.
    while not lock.is_free():
        if time.monotonic() > until:
            found = _taken(GATEWAY, lock.read())
            raise BridgeError(
                f"database {shown(url)}: {found}; or start that one with --gateway-name as well"
            )
        time.sleep(random.uniform(0.02, 0.2))  # nosec B311 # no secret


_LOCKING = {
    "postgresql": (
        f"set idle_in_transaction_session_timeout = {GHOST_S * 1000}",
        # Conflicts with itself and with changes of the table; neither with readers nor with writers.
        "lock table bridge in share update exclusive mode nowait",
    ),
    "mariadb": (
        f"set session wait_timeout = {GHOST_S}",
        # An administrator's limit for transactions would end this one, which never does anything.
        "set session idle_transaction_timeout = 0",
        "set session idle_readonly_transaction_timeout = 0",
        "set session idle_write_transaction_timeout = 0",
        f"select name from bridge where name = '{ROW}' for update nowait",  # nosec B608 # a name of ours
    ),
}


def _has_lock(url: URL) -> bool:
    """Return whether gateways lock this database; those of version 0.1.0 did not."""
    if url.get_backend_name() == "sqlite":
        return True
    engine, dialect = open_engine(url)
    with _explained(url, dialect), engine.connect() as connection:
        return inspect(connection).has_table(bridge.name)


def _make_row(engine: Engine) -> None:
    # Gateways of a fleet may start on a new database at the same moment.
    with engine.begin() as connection:
        for name in (RUN, ROW):
            fact(connection, name, "{}")


def _codes(error: DBAPIError) -> set[object]:
    return {getattr(error.orig, "sqlstate", None), *getattr(error.orig, "args", ())[:1]}


@contextlib.contextmanager
def _explained(url: URL, dialect: Dialect) -> Any:
    try:
        yield
    except SQLAlchemyError as error:
        text = f"{dialect.cause(error)}; {dialect.advice_on(error)}"
        raise StoreError(f"database {shown(url)}: {text}") from error


def _run_in(text: str | None) -> dict[str, Any]:
    try:
        run = decode_json(text or "{}", SHORT)
    except DecodingError:
        return {}
    return run if isinstance(run, dict) else {}


def _taken(does: str, other: dict[str, Any]) -> str:
    """Return a message on who has the database, and what to do first, for a user who ``does`` something."""
    found = other.get("does", GATEWAY)
    if found != GATEWAY:
        return f"'{found}' is under way on it{_named(other)}; wait for its end, then try again"
    cut_off = f"(where that one's computer was cut off, wait {GHOST_S} s)"
    if does == GATEWAY:
        return (
            f"another gateway runs on it{_named(other)}; end that one first, or give this one a database of "
            f"its own {cut_off}"
        )
    return (
        f"a gateway runs on it{_named(other)}; end it there, as a service with 'systemctl stop "
        f"robot-bridge', then run '{does}' again {cut_off}"
    )


def _serve_together(does: str, fleet: list[str]) -> str:
    """Return a message that gateways serve the database together, for a user who ``does`` something there."""
    names = f"{'gateway' if len(fleet) == 1 else 'gateways'} {listed_names(fleet)}"
    if does == GATEWAY:
        return (
            f"{names} serve it together with others; start this one with --gateway-name NAME to be one of "
            "them, or give it a database of its own"
        )
    return f"{names} serve it; end all of them, then run '{does}' again"


def _named(run: dict[str, Any]) -> str:
    if not {"host", "process", "since"} <= run.keys():
        return ""
    with contextlib.suppress(ValueError, TypeError, OverflowError):
        since = time.strftime("%Y-%m-%d %H:%M:%S UTC", time.gmtime(run["since"]))
        return f": process {run['process']} on {run['host']}, since {since}"
    return ""


# --- Detection of an older database state, restored by other means than ``database restore``


class MessageNote:
    """The newest message id of a database, recorded in a local file under the database's id.

    A database that has given out fewer was put back to an older state, and its next messages have ids that
    robots know. A robot acknowledges such a message and does nothing, even for an Abort. So the database gets
    a new id, and robots forget the old ids.

    That also holds if other gateways serve it: otherwise their robots would stay in that danger. They find
    the new id within :data:`PING_INTERVAL`, and end to be restarted with it; meanwhile their robots can
    connect to this one. ``folder`` is None for a database in memory, for which nothing is recorded.
    """

    def __init__(self, database: Database, folder: Path | None, gateway: str | None = None) -> None:
        self._database = database
        self._folder, self._gateway = folder, gateway
        self._id = ""
        self._newest = self._written = 0
        self._news = TroubleNews()

    async def check(self) -> None:
        """Give a new id to a database that is older than its record; raises StoreError."""
        self._id = await self._database.run(database_id)
        if (count := await self._database.run(message_count)) is None:
            return
        newest, noted = count[1], await asyncio.to_thread(self._read)
        if noted is None and newest:
            log.info("nothing is noted in %s of the messages that this database gave out", self._folder)
        if noted is not None and noted > newest:
            await self._renew(noted, newest)
        await self._write(newest)

    async def hold(self) -> None:
        """Record the newest message until cancelled.

        :raises FatalError: when the database was put back to an older state. The commands and robots known
        here are not of that state; a restart puts it right.
        """
        while True:
            await asyncio.sleep(until_tick(PING_INTERVAL))
            count = None
            # The users of the database report that it is away; meanwhile it gives out no messages.
            with contextlib.suppress(StoreError):
                count = await self._database.read(message_count)
            if count is None:
                continue
            id, newest = count
            if id != self._id or newest < self._newest:
                raise FatalError(
                    f"database {self._database.where} was put back to an older state while this gateway "
                    "served it, or counts as another one since that; this one ends, to be started again"
                )
            await self._write(newest)

    async def close(self, timeout: float) -> None:
        """Record the newest message once more, if the database answers in time."""
        with contextlib.suppress(StoreError, TimeoutError):
            async with asyncio.timeout(timeout):
                count = await self._database.read(message_count)
                if count is not None and count[0] == self._id:
                    await self._write(count[1])

    async def _renew(self, noted: int, newest: int) -> None:
        is_new, members = await self._database.run(_renewed, self._id)
        self._id = await self._database.run(database_id)
        if not is_new:
            return
        others = [name for name in members if name != self._gateway]
        log.warning(
            "database %s is older than what robots were sent out of it: the newest message that it knows is "
            "%d, and %d was given out. It counts as another one from now on, as after 'robot-bridge database "
            "restore': robots forget the ids of the messages that they know%s",
            self._database.where,
            newest,
            noted,
            f". Served by {listed_names(others)}, too: see that each ends and starts again" if others else "",
        )

    async def _write(self, newest: int) -> None:
        self._newest = max(self._newest, newest)
        if newest <= self._written or self._folder is None:
            return
        content = json.dumps({"database": self._id, "newest_message": newest}).encode()
        file = self._folder / f"{self._stem()}{'' if self._gateway is None else f'-{self._gateway}'}.json"
        try:
            await asyncio.to_thread(write_state, file, content, 0o600)
            self._written = newest
        except OSError as error:
            # A failed record must not disturb the gateway.
            if self._news.has("note", str(error)):
                log.warning(
                    "%s cannot be written: %s; an older state of the database that is put back may not be "
                    "noticed at the next start",
                    file,
                    error.strerror,
                )

    def _read(self) -> int | None:
        """Return the newest message recorded on this computer, None without a record."""
        found = []
        for file in [] if self._folder is None else self._folder.glob(f"{self._stem()}*.json"):
            try:
                note = _run_in(file.read_text(encoding="utf-8"))
            except (OSError, UnicodeDecodeError) as error:
                log.warning("%s cannot be read: %s", file, error)
                continue
            if note.get("database") == self._id and type(newest := note.get("newest_message")) is int:
                found.append(newest)
        return max(found, default=None)

    def _stem(self) -> str:
        return f"newest-message-{hashlib.sha256(self._id.encode()).hexdigest()[:12]}"


def _renewed(connection: Connection, before: str) -> tuple[bool, list[str]]:
    """Give the database a new id; return whether it was not yet renewed, and the gateways that serve it."""
    is_shared = connection.dialect.name == "postgresql"
    members = stored_gateways.members(connection) if is_shared else []
    return renew_id(connection, before), sorted(member.gw for member in members if member.alive)
