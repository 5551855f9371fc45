"""Tables RR and SA as one robot sees them, through the plain driver of each kind of database."""

from __future__ import annotations

import contextlib
import sqlite3
from abc import ABC, abstractmethod
from collections.abc import Sequence
from typing import Any
from urllib.parse import unquote, urlsplit

PATIENCE_S = 15.0
READ = "select id, op, params from sa where robot = {mark} order by urgent desc, id"
DELETE = "delete from sa where robot = {mark} and id = {mark}"
INSERT = "insert into rr (robot, op, params, payload) values ({mark}, {mark}, {mark}, {mark})"
LEVEL = "set session transaction isolation level read committed"


class Tables(ABC):
    """One robot's connection, made when it is first used. What goes wrong comes as one of ``errors``."""

    mark = "%s"
    errors: tuple[type[Exception], ...] = ()

    def __init__(self, robot: str, url: str) -> None:
        self._robot = robot
        self._url = urlsplit(url)
        self._made: Any = None

    def read(self) -> list[tuple[int, str, str | None]]:
        """Return what waits for the robot: id, operation, parameters."""
        return self._run(READ, self._robot)

    def write(self, deleted: Sequence[int], said: Sequence[tuple[str, str, bytes | None]]) -> None:
        """Delete rows of SA and insert requests (op, params, payload), in one transaction."""
        self._run("begin")
        for id in deleted:
            self._run(DELETE, self._robot, id)
        for op, params, payload in said:
            self._run(INSERT, self._robot, op, params, payload)
        self._run("commit")

    def close(self) -> None:
        """End the connection; what was not committed was not said."""
        if self._made is not None:
            with contextlib.suppress(Exception):
                self._made.close()

    def _run(self, text: str, *values: Any) -> list[Any]:
        if self._made is None:
            self._made = self._connect()
        with contextlib.closing(self._made.cursor()) as cursor:
            cursor.execute(text.format(mark=self.mark), values)
            return [] if cursor.description is None else list(cursor.fetchall())

    @property
    def _where(self) -> dict[str, Any]:
        return {
            "host": self._url.hostname,
            "port": self._url.port,
            "user": unquote(self._url.username or ""),
            "password": unquote(self._url.password or ""),
        }

    @abstractmethod
    def _connect(self) -> Any: ...


class SQLiteTables(Tables):
    """The file itself."""

    mark = "?"
    errors = (sqlite3.Error,)

    def _connect(self) -> Any:
        return sqlite3.connect(self._url.path[1:], timeout=PATIENCE_S, isolation_level=None)


class PostgreSQLTables(Tables):
    """With the rights of the robot's account."""

    def __init__(self, robot: str, url: str) -> None:
        import psycopg

        super().__init__(robot, url)
        self.errors = (psycopg.Error, OSError)

    def _connect(self) -> Any:
        import psycopg

        return psycopg.connect(**self._where, dbname=self._url.path[1:], autocommit=True, connect_timeout=5)


class MariaDBTables(Tables):
    """With the rights of the robot's account."""

    def __init__(self, robot: str, url: str) -> None:
        import pymysql

        super().__init__(robot, url)
        self.errors = (pymysql.Error, OSError)

    def _connect(self) -> Any:
        import pymysql

        where = {**self._where, "database": self._url.path[1:], "autocommit": True}
        limits = {"connect_timeout": 5, "read_timeout": PATIENCE_S, "write_timeout": PATIENCE_S}
        return pymysql.connect(**where, **limits, init_command=LEVEL)


KINDS = {"sqlite": SQLiteTables, "postgresql": PostgreSQLTables, "mariadb": MariaDBTables}


def open_tables(robot: str, url: str) -> Tables:
    """Return the tables at ``url`` as ``robot`` may use them."""
    return KINDS[urlsplit(url).scheme](robot, url)
