"""SQL dialects: SQLite, PostgreSQL and MariaDB; the address of a database."""

from __future__ import annotations

import contextlib
import logging
import os
import socket
import sqlite3
import stat
import time
from enum import IntEnum
from pathlib import Path
from typing import Any, ClassVar, NamedTuple

import sqlalchemy
from sqlalchemy import URL, Connection, Engine, Transaction, event
from sqlalchemy.exc import (
    DataError,
    DBAPIError,
    IntegrityError,
    OperationalError,
    SQLAlchemyError,
    StatementError,
)
from sqlalchemy.pool import NullPool

from ...core.errors import in_one_line

# --- Interface to one kind of database; the defaults are for one that needs nothing special ---

CONNECT_TIMEOUT_S = 5
LOCK_TIMEOUT_S = 1
"""How long the gateway waits for a lock before it makes way (see :mod:`.roles.blocking_sessions`)."""
BRIEF_LOCK_TIMEOUT_S = 0.02
"""How long it waits while somebody is known to keep something locked: as long as another program's commit."""
LOCKED = "somebody else has it locked: that goes on as soon as their transaction ends;"
PATIENCE_S = 10
"""Longest time of one statement: a dead or frozen server must not block the gateway for ever."""


class Durability(IntEnum):
    """Durability of a transaction; the highest counts where several are done together."""

    READ = 1
    """Read only."""
    RELAXED = 2
    """Changes may be lost in a power cut, though never before earlier changes."""
    WRITE = 3
    """Changes survive a power cut."""


class Dialect:
    """One kind of database. ``patience`` is the limit of a statement in seconds, or None for long ones."""

    name: ClassVar[str]
    advice: ClassVar[str] = "check that the server runs and that this account may use the database"
    made_by_serve: ClassVar[bool] = False
    """Whether the gateway creates a missing database."""
    has_version: ClassVar[bool] = False
    """Whether it is cheap to ask if another connection wrote (see :meth:`version`)."""
    listens: ClassVar[bool] = False
    """Whether the database notifies its readers of new rows (see :mod:`.wakeups`)."""
    partitions_days: ClassVar[bool] = False
    """Whether positions are kept in daily partitions, which must exist before the day begins."""

    def engine(self, url: URL, patience: float | None) -> Engine:
        """Return an engine on ``url``; raises ModuleNotFoundError when its driver is not installed."""
        raise NotImplementedError

    def begin(self, connection: Connection, mode: Durability) -> Transaction:
        """Begin a transaction."""
        return connection.begin()

    def version(self, connection: Connection) -> int | None:
        """Return a number that changes when another connection wrote, or None without such a number."""
        return None

    def log_of(self, url: URL) -> Path | None:
        """Return the local file that every write to the database changes, or None."""
        return None

    def backend(self, connection: Connection) -> int | None:
        """Return the backend number in notifications of this connection, or None."""
        return None

    def enable_notifications(self, connection: Connection) -> bool:
        """Have writers into RR notify from now on; return false while one writes without."""
        return False

    def disable_notifications(self, connection: Connection) -> None:
        """Have writers into RR stop notifying."""

    def interrupt(self, driver_connection: Any) -> None:
        """End the wait of another thread for a server that does not answer."""

    def deadlocked(self, error: DBAPIError) -> bool:
        """Return whether the database aborted this transaction in favour of another: it may be repeated."""
        return False

    def kept_waiting(self, error: DBAPIError) -> bool:
        """Return whether another session held a lock for too long."""
        return False

    def wait_for_locks(self, connection: Connection, *, briefly: bool) -> None:
        """Have what comes next on ``connection`` wait for locks as usual, or only briefly.

        Nothing where the kind of database has no such limit.
        """

    def refuses_data(self, error: SQLAlchemyError) -> bool:
        """Return whether the values were at fault, not the database."""
        if isinstance(error, (DataError, IntegrityError)):
            return True
        return isinstance(error, StatementError) and not isinstance(error, DBAPIError)

    def cause(self, error: SQLAlchemyError) -> str:
        """Return the database's error text in one line."""
        return in_one_line(getattr(error, "orig", None) or error)

    def advice_on(self, error: SQLAlchemyError) -> str:
        """Return advice on an error."""
        return self.advice


# --- MariaDB 10.11 or newer, through PyMySQL ---

_DEADLOCK = 1213
_MARIADB_LOCK_TIMEOUT = 1205
_RECORD_CHANGED = 1020
_REFUSALS = (1153, 1366, 1644, 4025)
"""Packet too large, invalid text, refused by a trigger, a violated constraint: the driver classes these as
other errors."""
_NO_CONNECTION_LEFT = (1040, 1203, 1226)
"""Too many connections of all accounts, of this one, and by this account's own limit."""
_LARGEST_PACKET = 64 << 20


class MariaDB(Dialect):
    """READ COMMITTED: the default level locks gaps, in which inserts and deletes of others collide."""

    name = "mariadb"

    def engine(self, url: URL, patience: float | None) -> Engine:
        engine = sqlalchemy.create_engine(
            url.set(drivername="mariadb+pymysql"),
            connect_args={
                "connect_timeout": CONNECT_TIMEOUT_S,
                # The server's own limit is shorter; this one is for a server that does not answer at all.
                "read_timeout": None if patience is None else round(patience) + 1,
                "write_timeout": None if patience is None else round(patience) + 1,
                "charset": "utf8mb4",
                "max_allowed_packet": _LARGEST_PACKET,
            },
            isolation_level="READ COMMITTED",
            poolclass=NullPool,
            hide_parameters=True,
        )
        if patience is not None:
            event.listen(engine, "connect", _mariadb_limits(patience))
        return engine

    def interrupt(self, driver_connection: Any) -> None:
        with contextlib.suppress(OSError, AttributeError):
            driver_connection._sock.shutdown(socket.SHUT_RDWR)

    def deadlocked(self, error: DBAPIError) -> bool:
        return _code(error) in (_DEADLOCK, _RECORD_CHANGED)

    def kept_waiting(self, error: DBAPIError) -> bool:
        return _code(error) == _MARIADB_LOCK_TIMEOUT

    def wait_for_locks(self, connection: Connection, *, briefly: bool) -> None:
        if connection.info.get("briefly", False) == briefly:
            return
        seconds = 0 if briefly else LOCK_TIMEOUT_S
        driver: Any = connection.connection.driver_connection
        # The first statement reports a lost connection.
        with contextlib.suppress(connection.dialect.loaded_dbapi.Error), driver.cursor() as cursor:
            # Row locks keep their timeout: without any, MariaDB refuses even what skips locked rows.
            cursor.execute(f"set session lock_wait_timeout = {seconds}")
            connection.info["briefly"] = briefly

    def advice_on(self, error: SQLAlchemyError) -> str:
        if isinstance(error, DBAPIError) and self.kept_waiting(error):
            return f"{LOCKED} show full processlist and information_schema.innodb_trx name who it is"
        if _code(error) in _NO_CONNECTION_LEFT:
            return "raise max_connections, or the limit of this account: allow ten for a gateway"
        return self.advice

    def refuses_data(self, error: SQLAlchemyError) -> bool:
        return super().refuses_data(error) or _code(error) in _REFUSALS

    def cause(self, error: SQLAlchemyError) -> str:
        arguments: tuple[Any, ...] = getattr(getattr(error, "orig", None), "args", ())
        return in_one_line(arguments[1]) if len(arguments) > 1 else super().cause(error)


def _code(error: SQLAlchemyError) -> int | None:
    arguments: tuple[Any, ...] = getattr(getattr(error, "orig", None), "args", ())
    return arguments[0] if arguments and isinstance(arguments[0], int) else None


def _mariadb_limits(patience: float) -> Any:
    def limit(connection: Any, _record: Any) -> None:
        with connection.cursor() as cursor:
            cursor.execute(f"set session max_statement_time = {patience}")
            cursor.execute(f"set session innodb_lock_wait_timeout = {LOCK_TIMEOUT_S}")
            cursor.execute(f"set session lock_wait_timeout = {LOCK_TIMEOUT_S}")

    return limit


# --- PostgreSQL 15 or newer, through psycopg 3 ---

CONNECT_ARGUMENTS: dict[str, Any] = {
    "connect_timeout": CONNECT_TIMEOUT_S,
    "application_name": "robot-bridge",
    "client_encoding": "utf8",
    # A pulled cable is noticed within seconds, not after the system's two hours.
    "keepalives_idle": 5,
    "keepalives_interval": 2,
    "keepalives_count": 3,
}
ENDLESS = (
    "select set_config(name, '0', false) from pg_settings "
    "where name in ('idle_session_timeout', 'transaction_timeout')"
)
"""Switches off limits that an administrator may have set for short sessions: they would end the connections
that a gateway keeps. Older servers have not both of them."""
NOTIFICATIONS_LOCK = 0x666C656574
"""The number of the lock that a gateway holds while it wants notifications of new rows ('fleet')."""
_REPEATABLE = ("40001", "40P01")
_RAISED = "P0"
"""Beginning of the codes of errors that a trigger raises: the driver classes these as faulty statements."""
_READ_ONLY = "25006"
_POSTGRESQL_LOCK_TIMEOUT = "55P03"


class PostgreSQL(Dialect):
    """The server ends statements that take too long; the connection to a frozen server is cut."""

    name = "postgresql"
    listens = True
    partitions_days = True

    def engine(self, url: URL, patience: float | None) -> Engine:
        engine = sqlalchemy.create_engine(
            url.set(drivername="postgresql+psycopg"),
            connect_args=CONNECT_ARGUMENTS,
            isolation_level="READ COMMITTED",
            poolclass=NullPool,
            hide_parameters=True,
        )
        # Many rows in one statement instead of one statement each.
        engine.dialect.use_insertmanyvalues_wo_returning = True
        if patience is not None:
            event.listen(engine, "connect", _postgresql_limits(patience))
        return engine

    def begin(self, connection: Connection, mode: Durability) -> Transaction:
        driver = connection.connection.driver_connection
        assert driver is not None
        # The first statement reports a lost connection.
        with contextlib.suppress(driver_error()):
            # Saves a reader two of three round trips to the server.
            driver.autocommit = mode is Durability.READ
        transaction = connection.begin()
        if mode is Durability.RELAXED:
            connection.exec_driver_sql("set local synchronous_commit = off")
        return transaction

    def backend(self, connection: Connection) -> int | None:
        driver = connection.connection.driver_connection
        assert driver is not None
        return int(driver.info.backend_pid)

    def enable_notifications(self, connection: Connection) -> bool:
        # A lock taken twice would have to be released twice.
        if not connection.info.get("notified"):
            text = f"select pg_try_advisory_lock({NOTIFICATIONS_LOCK})"
            connection.info["notified"] = connection.exec_driver_sql(text).scalar_one()
        return bool(connection.info["notified"])

    def disable_notifications(self, connection: Connection) -> None:
        if connection.info.pop("notified", False):
            connection.exec_driver_sql(f"select pg_advisory_unlock({NOTIFICATIONS_LOCK})")

    def interrupt(self, driver_connection: Any) -> None:
        # A connection lost meanwhile has no descriptor, which is the driver's error.
        with contextlib.suppress(OSError, driver_error()):
            # A second descriptor of the socket: it may be closed while the other thread uses its own.
            twin = socket.socket(fileno=os.dup(driver_connection.fileno()))
            with twin:
                twin.shutdown(socket.SHUT_RDWR)

    def deadlocked(self, error: DBAPIError) -> bool:
        return getattr(error.orig, "sqlstate", None) in _REPEATABLE

    def kept_waiting(self, error: DBAPIError) -> bool:
        return getattr(error.orig, "sqlstate", None) == _POSTGRESQL_LOCK_TIMEOUT

    def refuses_data(self, error: SQLAlchemyError) -> bool:
        code = getattr(getattr(error, "orig", None), "sqlstate", None) or ""
        return super().refuses_data(error) or code.startswith(_RAISED)

    def cause(self, error: SQLAlchemyError) -> str:
        # The refused row differs each time: by it a lasting trouble would look like a new one.
        detail = getattr(getattr(getattr(error, "orig", None), "diag", None), "message_detail", None)
        return super().cause(error).replace(f"DETAIL: {in_one_line(detail)}", "").strip()

    def wait_for_locks(self, connection: Connection, *, briefly: bool) -> None:
        if connection.info.get("briefly", False) == briefly:
            return
        seconds = BRIEF_LOCK_TIMEOUT_S if briefly else LOCK_TIMEOUT_S
        driver: Any = connection.connection.driver_connection
        # The first statement reports a lost connection.
        with contextlib.suppress(driver_error()):
            # Outside of a transaction, which would undo it on failure.
            driver.autocommit = True
            driver.execute(f"set lock_timeout = {round(seconds * 1000)}")
            connection.info["briefly"] = briefly

    def advice_on(self, error: SQLAlchemyError) -> str:
        if isinstance(error, DBAPIError) and self.kept_waiting(error):
            return f"{LOCKED} pg_blocking_pids and pg_stat_activity name who it is"
        if getattr(getattr(error, "orig", None), "sqlstate", None) == _READ_ONLY:
            return (
                "the server answers and takes no writes: have default_transaction_read_only off there, or "
                "name the primary where this one is a standby"
            )
        # A refused connection has no error code.
        if "no password supplied" in self.cause(error):
            return "give the file with the account's password: --database-password-file"
        if "too many" in self.cause(error) or "remaining connection slots" in self.cause(error):
            return "raise max_connections, or the limit of this database or account: allow ten for a gateway"
        return self.advice


def driver_error() -> type[Exception]:
    """Return the driver's base error; the driver is imported where used, since it may be missing."""
    import psycopg

    return psycopg.Error


def _postgresql_limits(patience: float) -> Any:
    def limit(connection: Any, _record: Any) -> None:
        with connection.cursor() as cursor:
            cursor.execute(f"set statement_timeout = {round(patience * 1000)}")
            cursor.execute(f"set lock_timeout = {LOCK_TIMEOUT_S * 1000}")
            cursor.execute(f"set idle_in_transaction_session_timeout = {round(patience * 1000)}")
            cursor.execute(ENDLESS)
        connection.commit()

    return limit


# --- SQLite: one file on this computer, with a write-ahead log; no server ---

log = logging.getLogger(__name__)

LOCK_PAUSE_S = 0.0005
_DESCRIPTORS = Path("/proc/self/fd")
"""The open files of this process, where the system lists them."""
_BESIDE = ("", "-wal", "-shm")
"""Suffixes of the database file, of its log and of the log's index."""
GONE = "was taken away or replaced while it was in use: put it back, or end whatever uses it"
"""Message about an SQLite file that was replaced or removed."""


class SQLite(Dialect):
    """SQLite; waits for a lock as long as its patience lasts."""

    name = "sqlite"
    advice = "check that it exists, that it may be written and that its disk has room"
    made_by_serve = True
    has_version = True
    _keeper: tuple[_Opened, sqlite3.Connection] | None = None

    def engine(self, url: URL, patience: float | None) -> Engine:
        self._timeout = PATIENCE_S if patience is None else patience
        engine = sqlalchemy.create_engine(
            url,
            connect_args={"timeout": self._timeout, "check_same_thread": False},
            poolclass=NullPool,
            hide_parameters=True,
        )
        event.listen(engine, "do_connect", self._make_file)
        event.listen(engine, "connect", _prepare)
        event.listen(engine, "connect", self._keep_open)
        event.listen(engine, "connect", self._close_to_others)
        event.listen(engine, "engine_disposed", self._release)
        event.listen(engine, "begin", self._begin)
        return engine

    def begin(self, connection: Connection, mode: Durability) -> Transaction:
        connection.info["mode"] = mode
        return connection.begin()

    def version(self, connection: Connection) -> int | None:
        # Through the driver: SQLAlchemy would begin a transaction and take the write lock for it.
        driver = connection.connection.driver_connection
        assert driver is not None
        return int(driver.execute("PRAGMA data_version").fetchone()[0])

    def log_of(self, url: URL) -> Path | None:
        return Path(f"{url.database}-wal") if url.database else None

    def _begin(self, connection: Connection) -> None:
        opened: _Opened | None = connection.info.get("opened")
        if opened is not None and (gone := opened.missing()) is not None:
            raise OperationalError("BEGIN", None, sqlite3.OperationalError(f"{gone} {GONE}"))
        mode = connection.info.get("mode", Durability.WRITE)
        # By the driver, here and below: by SQLAlchemy each call takes several times as long.
        driver = connection.connection.driver_connection
        assert driver is not None
        if mode is Durability.READ:
            # Readers block nobody, and nobody blocks them.
            try:
                driver.execute("BEGIN")
            except sqlite3.OperationalError as error:
                raise OperationalError("BEGIN", None, error) from error
            return
        # A command reported to an operator as queued must survive a power cut, not only a crash.
        synchronous = "FULL" if mode is Durability.WRITE else "NORMAL"
        if connection.info.get("synchronous") != synchronous:
            connection.exec_driver_sql(f"PRAGMA synchronous = {synchronous}")
            connection.info["synchronous"] = synchronous
        self._lock(connection)

    @staticmethod
    def _make_file(_dialect: Any, _record: Any, arguments: list[Any], _options: Any) -> None:
        path = str(arguments[0])
        if path != ":memory:" and not path.startswith("file:"):
            make_sqlite_file(Path(path))

    def _keep_open(self, _connection: Any, record: Any) -> None:
        """Keep an idle connection open beside the others, and allocate SQLite's index on the disk.

        SQLite removes its index with the last connection. After a failed commit the connection is a new one,
        and on a full disk the new index is allocated in part only: a process that writes there ends by
        SIGBUS.
        """
        opened: _Opened | None = record.info.get("opened")
        if opened is None or (self._keeper is not None and self._keeper[0] == opened):
            return
        self._release()
        keeper = sqlite3.connect(opened.path, timeout=self._timeout, check_same_thread=False)
        keeper.execute("PRAGMA schema_version").fetchone()
        self._keeper = opened, keeper
        _hold_room_of_index(Path(f"{opened.path}-shm"))

    def _release(self, _engine: Any = None) -> None:
        keeper, self._keeper = self._keeper, None
        if keeper is not None:
            keeper[1].close()

    @staticmethod
    def _close_to_others(_connection: Any, record: Any) -> None:
        """Deny the file, its log and index to accounts outside its group."""
        opened: _Opened | None = record.info.get("opened")
        if opened is None:
            return
        for path in [Path(f"{opened.path}{end}") for end in ("", "-wal", "-shm", "-journal")]:
            try:
                rights = stat.S_IMODE(path.stat().st_mode)
            except OSError:
                continue
            if not rights & stat.S_IRWXO:
                continue
            try:
                path.chmod(rights & ~stat.S_IRWXO)
            except OSError as error:
                text = "every account of this computer may open %s (%s); run: chmod o-rwx on it"
                log.warning(text, path, error.strerror)
                continue
            log.warning("every account of this computer could open %s; now its owner and group may", path)

    def _lock(self, connection: Connection) -> None:
        """Take the write lock as soon as it is free; SQLite itself would sleep up to 0.1 s."""
        until = time.monotonic() + self._timeout
        driver = connection.connection.driver_connection
        assert driver is not None
        driver.execute("PRAGMA busy_timeout = 0")
        try:
            while True:
                try:
                    driver.execute("BEGIN IMMEDIATE")
                    return
                except sqlite3.OperationalError as error:
                    if "locked" not in str(error) or time.monotonic() > until:
                        raise OperationalError("BEGIN IMMEDIATE", None, error) from error
                time.sleep(LOCK_PAUSE_S)
        finally:
            driver.execute(f"PRAGMA busy_timeout = {round(self._timeout * 1000)}")


class _Opened(NamedTuple):
    """The database file that a connection has open, with its log and index, as found at their paths.

    Writes to a log that was removed are seen by those who have it open, and by nobody later: neither by the
    next gateway nor by a robot that opens the file then.
    """

    path: Path
    found: tuple[tuple[Path, tuple[int, int] | None], ...]
    """The path of each, and its device and inode; None if it is missing."""

    @classmethod
    def by(cls, connection: sqlite3.Connection) -> _Opened | None:
        """Return the files of a connection, None for a database in memory."""
        rows = connection.execute("PRAGMA database_list").fetchall()
        file = next((file for _number, name, file in rows if name == "main"), "")
        if not file:
            return None
        # The first reader creates the log and its index.
        connection.execute("PRAGMA schema_version").fetchone()
        paths = [Path(f"{file}{end}") for end in _BESIDE]
        return cls(paths[0], tuple((path, _inode(path)) for path in paths))

    def missing(self) -> Path | None:
        """Return a path whose file was replaced or removed: further writes would be lost."""
        for path, inode in self.found:
            if inode is not None and _inode(path) != inode:
                return path
        return None


def _inode(path: Path) -> tuple[int, int] | None:
    try:
        status = path.stat()
    except OSError:
        return None
    return status.st_dev, status.st_ino


def _prepare(connection: Any, record: Any) -> None:
    # The driver would begin transactions too late: a reader can then no longer become a writer.
    connection.isolation_level = None
    # Robots may write anything into RR: invalid UTF-8 is refused row by row, not by the driver.
    connection.text_factory = _decode_leniently
    cursor = connection.cursor()
    cursor.execute("PRAGMA journal_mode = WAL")
    # Some distributions have SQLite overwrite deleted data with zeros: the map of a city, page by page, while
    # everybody else waits.
    cursor.execute("PRAGMA secure_delete = FAST")
    cursor.close()
    record.info["opened"] = _Opened.by(connection)


def _hold_room_of_index(path: Path) -> None:
    """Allocate all of SQLite's memory-mapped index at ``path`` on the disk.

    Otherwise the process is killed when it writes there and the disk is full. SQLite writes one byte per 4
    kB, which allocates one block only where blocks are smaller. SQLite's own descriptor is used: closing
    another one would release its locks.
    """
    for name in _DESCRIPTORS.iterdir() if _DESCRIPTORS.is_dir() else ():
        with contextlib.suppress(OSError):
            if name.readlink() == path:
                descriptor = int(name.name)
                os.posix_fallocate(descriptor, 0, os.fstat(descriptor).st_size)


def make_sqlite_file(path: Path) -> None:
    """Create a database file for its owner alone, whatever the umask: who may write it, commands robots."""
    with contextlib.suppress(OSError):
        os.close(os.open(path, os.O_RDWR | os.O_CREAT | os.O_EXCL | os.O_CLOEXEC, 0o600))


def _decode_leniently(text: bytes) -> str:
    return text.decode(errors="replace")


def sqlite_path_in(url: URL) -> Path | None:
    """Return the path in an SQLite address; None for one in memory and for other databases.

    Opens nothing, whereas :func:`sqlite_file_of` would create the file.
    """
    database = url.database if url.get_backend_name() == SQLite.name else None
    if not database or database == ":memory:" or database.startswith("file:"):
        return None
    return Path(database)


def sqlite_file_of(url: URL) -> Path | None:
    """Return the file of a SQLite database, None for one in memory; raises SQLAlchemyError."""
    engine = SQLite().engine(url, None)
    with engine.connect() as connection:
        driver = connection.connection.driver_connection
        assert driver is not None
        found = driver.execute("PRAGMA database_list").fetchall()
    engine.dispose()
    file = next((row[2] for row in found if row[1] == "main"), "")
    return Path(file).resolve() if file else None
