"""Any other program that is connected to the same database, through the plain driver."""

from __future__ import annotations

import contextlib
import importlib
import sqlite3
from collections.abc import Iterator
from typing import Any

from sqlalchemy import make_url

PATIENCE_S = 15
"""seconds that a statement waits for others that hold its table, or for a server that says nothing."""
DRIVERS = {"sqlite": "sqlite3", "postgresql": "psycopg", "mariadb": "pymysql"}
LEVEL = "set session transaction isolation level read committed"
"""At the level that MariaDB begins with, many robots' inserts lock each other out."""


class DatabaseClient:
    """Runs single statements, each committed at once; ``?`` stands for a value on every kind of database."""

    def __init__(self, url: str):
        self.url = make_url(url)
        self.kind = self.url.drivername
        self.driver = importlib.import_module(DRIVERS[self.kind])
        self._connection: Any = None

    def sql(self, text: str, *values: Any) -> list[tuple[Any, ...]]:
        """Run one statement and return its rows."""
        if self.kind != "sqlite":
            text = text.replace("%", "%%").replace("?", "%s")
        if self._connection is None:
            self._connection = self._connect()
        with contextlib.closing(self._connection.cursor()) as cursor:
            cursor.execute(text, values)
            return [] if cursor.description is None else [tuple(row) for row in cursor.fetchall()]

    def close(self) -> None:
        """Close the connection; the next statement makes another."""
        if self._connection is not None:
            with contextlib.suppress(Exception):
                self._connection.close()
        self._connection = None

    def break_table(self, name: str) -> None:
        """Let every statement on a table fail until it is mended."""
        self.sql(f"alter table {name} rename to {name}_away")

    def mend_table(self, name: str) -> None:
        """Put a broken table back."""
        self.sql(f"alter table {name}_away rename to {name}")

    def _connect(self) -> Any:
        if self.kind == "sqlite":
            return sqlite3.connect(self.url.database, timeout=PATIENCE_S, isolation_level=None)
        where = {"host": self.url.host, "port": self.url.port, "user": self.url.username}
        where |= {"password": self.url.password, "autocommit": True, "connect_timeout": 5}
        if self.kind == "postgresql":
            return self.driver.connect(**where, dbname=self.url.database)
        limits = {"read_timeout": PATIENCE_S, "write_timeout": PATIENCE_S, "init_command": LEVEL}
        return self.driver.connect(**where, **limits, database=self.url.database)


LOCKS = {
    "postgresql": ("begin", "lock table {} in access exclusive mode", "rollback"),
    "mariadb": ("lock tables {} write", "unlock tables"),
}


@contextlib.contextmanager
def tables_locked(url: str, *tables: str) -> Iterator[None]:
    """Hold tables as an administrator's session does that adds a column, or was left in a transaction.

    They are released by a statement: a server ends a session some time after its connection.
    """
    with contextlib.closing(DatabaseClient(url)) as administrator:
        joined = ", ".join(tables) if administrator.kind == "postgresql" else " write, ".join(tables)
        *begin, end = LOCKS[administrator.kind]
        for statement in begin:
            administrator.sql(statement.format(joined))
        yield
        administrator.sql(end)
