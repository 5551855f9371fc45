"""Backups of PostgreSQL and MariaDB: the rows as SQL, written and read by the server's own programs.

A dump holds rows only: the tables are made by ``robot-bridge database create``, and accounts and rights are
the server's. Two tables are left out: ``bridge``, whose facts are about one database, and ``rr``: what waited
there is old by the time of a restore, and robots repeat what was not acknowledged.
"""

from __future__ import annotations

import gzip
import json
import os
import shutil
import subprocess
import tempfile
import time
import uuid
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import IO, Any

from sqlalchemy import URL, Connection, inspect

from ...core.decoding import SHORT, decode_json
from ...errors import StoreError
from ..address import shown
from ..database import run_once
from ..facts import ID
from ..schema import bridge, metadata

MARK = b"-- robot-bridge backup "
LEFT_OUT = frozenset({"rr", "bridge"})
NUMBERED = frozenset(
    name for name, table in metadata.tables.items() if "id" in table.c and table.c.id.type.python_type is int
)
_GZIP = b"\x1f\x8b"
_PIECE = 1 << 20


class ServerBackups:
    """What PostgreSQL and MariaDB have in common: a program that writes SQL, and one that reads it."""

    kind: str
    writer: str
    reader: str
    package: str
    schema: str = ""

    def __init__(self, url: URL) -> None:
        self._url = url

    def recognises(self, head: bytes) -> bool:
        """Tell whether a file that begins so may be a backup of this kind; :meth:`check` looks inside."""
        return head.startswith(_GZIP)

    def write(self, partial: Path, revision: str) -> None:
        """Write the rows into ``partial``, a line about them first."""
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
        """Put what ``file`` holds in the place of the rows there, under a new id, in one transaction."""
        program, script = self._program(self.reader), self._script(file, self._tables())
        self._run([program, *self._reader_options()], script, None)

    def _tables(self) -> list[str]:
        """Return those tables that are there: an older version had fewer of them."""
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
        new_id = _new_id(self.schema + bridge.name) if run_once(self._url, _has_id) else []
        yield b"\n" + "\n".join([*new_id, *self._after(tables)]).encode() + b"\n"

    def _run(
        self, command: Sequence[str], script: Iterable[bytes] | None, output: gzip.GzipFile | None
    ) -> None:
        with tempfile.TemporaryFile() as errors:
            process = subprocess.Popen(
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
            said = errors.read(4096).decode(errors="replace")
        if status:
            reason = " ".join(said.split())[:600] or f"status {status}"
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

    def _after(self, tables: Collection[str]) -> list[str]:
        raise NotImplementedError

    def _secrets(self) -> Mapping[str, str]:
        raise NotImplementedError


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
        ]
        return [*form, *(f"--table=public.{name}" for name in tables), "--exclude-table=*_seq"]

    def _reader_options(self) -> list[str]:
        return ["--no-psqlrc", "--quiet", "--single-transaction", "--set=ON_ERROR_STOP=1", "--file=-"]

    def _before(self, tables: Collection[str]) -> list[str]:
        return [f"delete from public.{name};" for name in (*tables, "rr")]

    def _after(self, tables: Collection[str]) -> list[str]:
        return [
            f"select setval(pg_get_serial_sequence('public.{name}', 'id'), {_highest(f'public.{name}')});"
            for name in tables
            if name in NUMBERED
        ]

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
        return ["set autocommit = 0;", *(f"delete from `{name}`;" for name in (*tables, "rr"))]

    def _after(self, tables: Collection[str]) -> list[str]:
        # Inserting moved the numbers of the others on; those of sa may be known to robots and gone from it.
        return [
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
    """Tell whether the database has an id: one of version 0.1.0 gets it when it is upgraded."""
    return bridge.name in inspect(connection).get_table_names()


def _new_id(table: str) -> list[str]:
    """Return SQL that gives the database another id: messages come again under numbers that robots know."""
    return [
        f"delete from {table} where name = '{ID}';",
        f"insert into {table} (name, value) values ('{ID}', '{uuid.uuid4()}');",
    ]


def _highest(table: str) -> str:
    """Return SQL for the highest id that was given out, as far as the rows know."""
    own = f"(select coalesce(max(id), 0) + 1 from {table})"
    if not table.endswith("sa"):
        return own
    commands = table.removesuffix("sa") + "commands"
    return f"greatest({own}, (select coalesce(max(sa_id), 0) + 1 from {commands}))"


def _feed(target: IO[bytes], script: Iterable[bytes]) -> None:
    try:
        with target:
            for piece in script:
                target.write(piece)
    except BrokenPipeError:
        pass  # it ended early, and says why
