"""Backup and restoration of the database; servers use their own dump tools."""

from __future__ import annotations

import asyncio
import contextlib
import gzip
import json
import os
import shutil
import sqlite3
import subprocess
import tempfile
import time
import uuid
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import IO, Any, Protocol

from sqlalchemy import URL, Connection, create_engine, func, inspect, select
from sqlalchemy.pool import NullPool

from ...core.errors import BridgeError, StoreError, counted, in_one_line
from ...core.files import replacement
from ...core.json_decoder import SHORT, decode_json
from . import revisions
from .database import run_once, shown
from .dialects import make_sqlite_file, sqlite_path_in
from .repositories import metadata as sqlite_file_metadata
from .repositories.metadata import ID
from .schema import bridge, metadata
from .singleton_lock import no_gateway

# --- Backups of PostgreSQL and MariaDB: rows as SQL, written and read by the server's own programs
# A dump holds rows only: ``robot-bridge database create`` makes the tables; accounts and rights belong to the
# server. Two tables are left out: ``bridge``, whose facts are about one database, and ``rr``: its requests
# are old by the time of a restore, and robots repeat those not acknowledged.

MARK = b"-- robot-bridge backup "
LEFT_OUT = frozenset({"rr", "bridge", "gateways", "robot_owners", "relayed_requests"})
NUMBERED = frozenset(
    name for name, table in metadata.tables.items() if "id" in table.c and table.c.id.type.python_type is int
)
_GZIP = b"\x1f\x8b"
_PIECE = 1 << 20


class ServerBackups:
    """Backups shared by PostgreSQL and MariaDB: one program writes SQL, another reads it."""

    kind: str
    writer: str
    reader: str
    package: str
    schema: str = ""

    def __init__(self, url: URL) -> None:
        self._url = url

    def recognises(self, head: bytes) -> bool:
        """Return whether a file with this head may be a backup of this kind; :meth:`check` reads it."""
        return head.startswith(_GZIP)

    def write(self, partial: Path, revision: str) -> None:
        """Write the rows into ``partial``, after a header line."""
        about = {"kind": self.kind, "revision": revision, "made_at": round(time.time())}
        program = self._program(self.writer)
        with gzip.open(partial, "wb", compresslevel=3) as target:
            target.write(MARK + json.dumps(about).encode() + b"\n")
            self._run([program, *self._writer_options(self._tables())], None, target)

    def check(self, file: Path) -> str:
        """Return the revision of the tables in ``file``; raises StoreError unless it is a whole backup."""
        about = self._about(file)
        if about.get("kind") != self.kind:
            raise StoreError(
                f"backup {file} is of {about.get('kind', 'another program')}, and database "
                f"{shown(self._url)} is {self.kind}; restore it into a database of its kind"
            )
        return str(about.get("revision"))

    def load(self, file: Path) -> None:
        """Replace the rows by those in ``file`` and give the database a new id, in one transaction."""
        program, script = self._program(self.reader), self._script(file, self._tables())
        self._run([program, *self._reader_options()], script, None)

    def _tables(self) -> list[str]:
        """Return the tables that exist: an older version had fewer."""
        return run_once(self._url, _present)

    def _about(self, file: Path) -> dict[str, Any]:
        try:
            with gzip.open(file, "rb") as source:
                first = source.readline(4096)
                if not first.startswith(MARK):
                    return {}
                while source.read(_PIECE):
                    pass  # to its end, where its checksum stands
            about = decode_json(first.removeprefix(MARK), SHORT)
        except (OSError, EOFError, ValueError) as error:
            raise StoreError(f"backup {file} is damaged: {error}") from error
        return about if isinstance(about, dict) else {}

    def _script(self, file: Path, tables: Collection[str]) -> Iterator[bytes]:
        yield "\n".join(self._before(tables)).encode() + b"\n"
        with gzip.open(file, "rb") as source:
            while piece := source.read(_PIECE):
                yield piece
        new_id, greeting = _new_id(self.schema) if run_once(self._url, _has_id) else ([], [])
        yield b"\n" + "\n".join([*new_id, *self._after(tables, greeting)]).encode() + b"\n"

    def _run(
        self, command: Sequence[str], script: Iterable[bytes] | None, output: gzip.GzipFile | None
    ) -> None:
        with tempfile.TemporaryFile() as errors:
            process = subprocess.Popen(  # nosec B603 # our own words, no shell
                command,
                stdin=subprocess.DEVNULL if script is None else subprocess.PIPE,
                stdout=subprocess.DEVNULL if output is None else subprocess.PIPE,
                stderr=errors,
                env={**os.environ, **self._secrets()},
            )
            try:
                if output is not None and process.stdout is not None:
                    shutil.copyfileobj(process.stdout, output, _PIECE)
                if script is not None and process.stdin is not None:
                    _feed(process.stdin, script)
                status = process.wait()
            except BaseException:
                process.kill()
                process.wait()
                raise
            errors.seek(0)
            stderr = errors.read(4096).decode(errors="replace")
        if status:
            reason = in_one_line(stderr)[:600] or f"status {status}"
            raise StoreError(f"database {shown(self._url)}: {Path(command[0]).name} failed: {reason}")

    def _program(self, name: str) -> str:
        found = shutil.which(name)
        if found is None:
            raise StoreError(
                f"{name} is not installed, which backs up and restores {self.kind}; install the package "
                f"{self.package}"
            )
        return found

    def _writer_options(self, tables: Collection[str]) -> list[str]:
        raise NotImplementedError

    def _reader_options(self) -> list[str]:
        raise NotImplementedError

    def _before(self, tables: Collection[str]) -> list[str]:
        raise NotImplementedError

    def _after(self, tables: Collection[str], greeting: Sequence[str]) -> list[str]:
        raise NotImplementedError

    def _secrets(self) -> Mapping[str, str]:
        raise NotImplementedError


_PARTITIONS = ("trajectories_" + 8 * "[0-9]", "trajectories_other", "trajectories_before")
"""The partitions of positions, as patterns that pg_dump matches against its snapshot."""
_BY_DAY = """
do $$ begin
    if to_regproc('public.make_trajectory_days') is not null then
        perform public.make_trajectory_days(array(
            select distinct floor(received_at / 86400)::integer from only public.trajectories_other
        ), 1000000000);
    end if;
end $$;"""
"""Partitions for the days of the backup; an older version has none."""


class PostgreSqlBackups(ServerBackups):
    """pg_dump and psql. Inserts and not COPY: the rights of rows, where robots have accounts, forbid that."""

    kind = "postgresql"
    writer, reader, package, schema = "pg_dump", "psql", "postgresql-client", "public."

    def _writer_options(self, tables: Collection[str]) -> list[str]:
        form = [
            "--data-only",
            "--rows-per-insert=500",
            "--enable-row-security",
            "--no-owner",
            "--no-privileges",
            "--load-via-partition-root",
        ]
        return [
            *form,
            *(f"--table=public.{name}" for name in (*tables, *_PARTITIONS)),
            "--exclude-table=*_seq",
        ]

    def _reader_options(self) -> list[str]:
        return ["--no-psqlrc", "--quiet", "--single-transaction", "--set=ON_ERROR_STOP=1", "--file=-"]

    def _before(self, tables: Collection[str]) -> list[str]:
        return [f"delete from public.{name};" for name in (*tables, "rr")]  # nosec B608 # our tables

    def _after(self, tables: Collection[str], greeting: Sequence[str]) -> list[str]:
        numbers = [
            f"select setval(pg_get_serial_sequence('public.{name}', 'id'), {_highest(f'public.{name}')});"
            for name in tables
            if name in NUMBERED
        ]
        return [*numbers, *greeting, _BY_DAY]

    def _secrets(self) -> Mapping[str, str]:
        url = self._url
        given = {
            "PGHOST": url.host,
            "PGPORT": url.port and str(url.port),
            "PGUSER": url.username,
            "PGPASSWORD": url.password and str(url.password),
            "PGDATABASE": url.database,
            **{f"PG{key.upper()}": value for key, value in url.query.items() if key.startswith("ssl")},
        }
        return {key: str(value) for key, value in given.items() if value}


class MariaDbBackups(ServerBackups):
    """mariadb-dump and mariadb, without any statement that would end the one transaction."""

    kind = "mariadb"
    writer, reader, package = "mariadb-dump", "mariadb", "mariadb-client"

    def _writer_options(self, tables: Collection[str]) -> list[str]:
        form = [
            "--single-transaction",
            "--no-create-info",
            "--skip-triggers",
            "--hex-blob",
            "--complete-insert",
        ]
        form += [
            "--skip-add-locks",
            "--skip-disable-keys",
            "--skip-lock-tables",
            "--no-tablespaces",
            "--skip-comments",
        ]
        return ["--no-defaults", *form, *self._where(), str(self._url.database), *tables]

    def _reader_options(self) -> list[str]:
        return ["--no-defaults", "--batch", "--binary-mode", *self._where(), str(self._url.database)]

    def _before(self, tables: Collection[str]) -> list[str]:
        return ["set autocommit = 0;", *(f"delete from `{name}`;" for name in (*tables, "rr"))]  # nosec B608 # names of ours

    def _after(self, tables: Collection[str], greeting: Sequence[str]) -> list[str]:
        # Inserts advanced the ids of other tables; ids of sa may be known to robots though their rows are
        # gone.
        return [
            *greeting,
            "commit;",
            f"set @next = {_highest('sa')} + 1;",
            "execute immediate concat('alter table sa auto_increment = ', @next);",
        ]

    def _where(self) -> list[str]:
        url = self._url
        where = [
            f"--host={url.host or '127.0.0.1'}",
            f"--port={url.port or 3306}",
            f"--user={url.username or ''}",
        ]
        ssl = [
            f"--{key.replace('_', '-')}={value}" for key, value in url.query.items() if key.startswith("ssl_")
        ]
        return ["--protocol=tcp", *where, *ssl, "--default-character-set=utf8mb4", "--max-allowed-packet=64M"]

    def _secrets(self) -> Mapping[str, str]:
        return {"MYSQL_PWD": str(self._url.password)} if self._url.password else {}


def _present(connection: Connection) -> list[str]:
    names = set(inspect(connection).get_table_names())
    return sorted(names & metadata.tables.keys() - LEFT_OUT)


def _has_id(connection: Connection) -> bool:
    """Return whether the database has an id: one of version 0.1.0 gets its id in the upgrade."""
    return bridge.name in inspect(connection).get_table_names()


def _new_id(schema: str) -> tuple[list[str], list[str]]:
    """Return SQL that gives the database a new id: message numbers known to robots will be reused.

    Also return SQL that notifies robots on SQL, which do not connect; to run when ids are given out again.
    """
    table, id = schema + bridge.name, str(uuid.uuid4())
    start = sqlite_file_metadata.GREETING.format(schema=schema).replace(
        ":params", f"'{json.dumps({'database': id})}'"
    )
    return [
        f"delete from {table} where name = '{ID}';",  # nosec B608 # our tables
        f"insert into {table} (name, value) values ('{ID}', '{id}');",  # nosec B608 # our tables
    ], [f"{start};"]


def _highest(table: str) -> str:
    """Return SQL for the highest id given out, as far as the rows show."""
    own = f"(select coalesce(max(id), 0) + 1 from {table})"  # nosec B608 # our tables
    if not table.endswith("sa"):
        return own
    commands = table.removesuffix("sa") + "commands"
    return f"greatest({own}, (select coalesce(max(sa_id), 0) + 1 from {commands}))"  # nosec B608 # our tables


def _feed(target: IO[bytes], script: Iterable[bytes]) -> None:
    try:
        with target:
            for piece in script:
                target.write(piece)
    except BrokenPipeError:
        pass  # it ended early, and reports why


# --- Backups of SQLite: a database file, copied while it is in use ---

_MAGIC = b"SQLite format 3\x00"


class SqliteBackups:
    """Copies by SQLite's backup API, which includes pages still in the write-ahead log."""

    kind = "sqlite"

    def __init__(self, url: URL) -> None:
        self._url = url

    def recognises(self, head: bytes) -> bool:
        """Return whether a file with this head is a backup of this kind."""
        return head.startswith(_MAGIC)

    def write(self, partial: Path, revision: str) -> None:
        """Copy the database into ``partial``."""
        with _connected(self._file()) as source, _connected(partial) as target:
            # All pages in one step: a copy in several steps restarts after every write, and a gateway always
            # writes. In WAL mode SQLite lets others write meanwhile.
            source.backup(target)
            # One file only: a log beside it could be left behind.
            target.execute("PRAGMA journal_mode = DELETE")

    def check(self, file: Path) -> str:
        """Return the revision of the tables in ``file``; raises StoreError unless it is a whole backup."""
        with _connected(file) as source:
            found = source.execute("PRAGMA quick_check(1)").fetchone()[0]
        if found != "ok":
            raise StoreError(f"backup {file} is damaged: {found}")
        # Not opened as the bridge opens a database: that would switch the backup to WAL mode.
        engine = create_engine(URL.create("sqlite", database=str(file)), poolclass=NullPool)
        with engine.connect() as connection:
            revision = revisions.current(connection)
        if revision is None:
            raise StoreError(f"file {file} is no backup: it has no tables of the bridge")
        return revision

    def load(self, file: Path) -> None:
        """Replace the database by ``file`` and give it a new id, in one transaction."""
        database = self._file()
        with tempfile.TemporaryDirectory(prefix=".restoring-", dir=database.parent) as folder:
            # The id is renewed before the replacement: in between, robots would see the old id.
            renewed = Path(folder) / "backup"
            for made in (renewed, database):
                make_sqlite_file(made)
            with _connected(file) as source, _connected(renewed) as target:
                source.backup(target)
            run_once(URL.create("sqlite", database=str(renewed)), _renew)
            with _connected(renewed) as source, _connected(database) as target:
                source.backup(target)
                target.execute("PRAGMA journal_mode = WAL")

    def _file(self) -> Path:
        path = sqlite_path_in(self._url)
        if path is None:
            raise StoreError(
                f"database {self._url}: only a file named by its path can be backed up or restored"
            )
        return path


def _renew(connection: Connection) -> None:
    if bridge.name not in inspect(connection).get_table_names():
        return  # a database of version 0.1.0 gets its id in the upgrade
    sqlite_file_metadata.renew_id(connection, sqlite_file_metadata.database_id(connection))


@contextlib.contextmanager
def _connected(file: Path) -> Iterator[sqlite3.Connection]:
    try:
        with contextlib.closing(sqlite3.connect(file, timeout=30, isolation_level=None)) as connection:
            yield connection
    except sqlite3.Error as error:
        raise StoreError(
            f"{file}: {error}; check that it is whole, and its folder's rights and room"
        ) from error


# --- Backing a database up into one file, and restoring it ---


class Backups(Protocol):
    """Backup and restore of one kind of database; every method raises StoreError on failure."""

    kind: str

    def recognises(self, head: bytes) -> bool:
        """Return whether a file with this head may be a backup of this kind."""

    def write(self, partial: Path, revision: str) -> None:
        """Write a backup into ``partial``."""

    def check(self, file: Path) -> str:
        """Return the revision of the tables in ``file``; raises StoreError unless it is a whole backup."""

    def load(self, file: Path) -> None:
        """Replace the contents by those of ``file`` and give the database a new id, in one transaction."""


KINDS: dict[str, Callable[[URL], Backups]] = {
    "sqlite": SqliteBackups,
    "postgresql": PostgreSqlBackups,
    "mariadb": MariaDbBackups,
}


def back_up(url: URL, file: Path, *, replace: bool = False) -> int:
    """Write a backup of the database into ``file``, whole or not at all; return its size in bytes.

    The gateway may run. Raises BridgeError and StoreError.
    """
    _refuse_itself(url, file)
    if file.exists() and not replace:
        raise BridgeError(f"{file} is there already; choose another name, or give --replace")
    revision = run_once(url, _revision, shown(url))
    try:
        with replacement(file) as partial:
            # It is as confidential as the database itself.
            os.close(os.open(partial, os.O_CREAT | os.O_WRONLY, 0o600))
            kind = KINDS[url.get_backend_name()](url)
            kind.write(partial, revision)
            kind.check(partial)
    except OSError as error:
        raise BridgeError(f"{file} cannot be written: {error.strerror or error}; check its folder") from error
    return file.stat().st_size


def revision_in(url: URL, file: Path) -> str:
    """Return the revision of a backup for the database at ``url``; raises BridgeError and StoreError."""
    _refuse_itself(url, file)
    _check_kind(url, file)
    revision = KINDS[url.get_backend_name()](url).check(file)
    if revision > revisions.NEEDED:
        raise StoreError(
            f"backup {file} holds tables of revision {revision}, and this version of robot-bridge knows "
            f"those up to {revisions.NEEDED}; install the robot-bridge that wrote it"
        )
    return revision


async def restore(url: URL, file: Path, *, replace: bool = False) -> str:
    """Replace the database by the backup in ``file``; return the revision of its tables.

    The database gets a new id, so that robots forget message ids that may be reused. Refused while a gateway
    runs on it, and, unless ``replace``, where it holds any data. Raises BridgeError and StoreError.
    """
    revision = revision_in(url, file)
    async with no_gateway(url, "robot-bridge database restore"):
        await asyncio.to_thread(_restore, url, file, revision, replace)
    return revision


def _restore(url: URL, file: Path, revision: str, replace: bool) -> None:
    if url.get_backend_name() != "sqlite":
        _check_fits(url, file, revision, run_once(url, _revision, shown(url)))
    held = run_once(url, _held)
    if held is not None and not replace:
        raise BridgeError(
            f"database {shown(url)} is not empty: it has {held}; back it up, then give --replace to have it "
            "replaced"
        )
    KINDS[url.get_backend_name()](url).load(file)


def _check_fits(url: URL, file: Path, revision: str, found: str) -> None:
    """Raise StoreError unless the tables found match those of the backup."""
    if found == revision:
        return
    advice = (
        "run first: robot-bridge database upgrade"
        if found < revision
        else "restore it into another, empty database, whose tables are made by 'robot-bridge database "
        f"create --for-backup {file}'; after that run 'robot-bridge database upgrade' there"
    )
    raise StoreError(
        f"backup {file} holds tables of revision {revision}, and those of database {shown(url)} are {found}; "
        f"{advice}"
    )


def _revision(connection: Connection, where: str) -> str:
    found = revisions.current(connection)
    if found is None:
        raise StoreError(
            f"database {where} has no tables of the bridge; make them with: robot-bridge database create"
        )
    return found


def _held(connection: Connection) -> str | None:
    """Return a count of what the database holds, None if empty; its creation is in its audit log."""
    present = set(inspect(connection).get_table_names())
    for name in ("commands", "trajectories", "robots", "operators", "observations"):
        if name not in present:
            continue
        table = metadata.tables[name]
        count = connection.scalar(select(func.count()).select_from(table)) or 0
        if count:
            return f"{counted(count, 'row')} in {name}"
    return None


def _refuse_itself(url: URL, file: Path) -> None:
    """Raise BridgeError for the database's own file: replacing it would take it from a running gateway."""
    database = Path(url.database or "") if url.get_backend_name() == "sqlite" else None
    if database is not None and database.is_file() and file.exists() and file.samefile(database):
        raise BridgeError(f"{file} is the database itself; name another file for the backup")


def _check_kind(url: URL, file: Path) -> None:
    try:
        with file.open("rb") as source:
            head = source.read(64)
    except OSError as error:
        raise BridgeError(f"backup {file} cannot be read: {error.strerror}") from error
    kind_expected = url.get_backend_name()
    if KINDS[kind_expected](url).recognises(head):
        return
    of = next((name for name in KINDS if KINDS[name](url).recognises(head)), None)
    what = f"is of {of}" if of == "sqlite" else "is of a database server" if of else "is no backup"
    raise StoreError(
        f"file {file} {what}, and database {shown(url)} is {kind_expected}; give a backup of {kind_expected}"
    )
