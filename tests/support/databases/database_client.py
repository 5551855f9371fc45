"""Any other program that is connected to the same database, through the plain driver."""

from __future__ import annotations

import contextlib
import sqlite3
from typing import Any

from sqlalchemy import make_url


class DatabaseClient:
    """Runs single statements, each committed at once; ``?`` stands for a value on every kind of database."""

    def __init__(self, url: str):
        self.url = make_url(url)
        self.kind = self.url.drivername
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
            return sqlite3.connect(self.url.database, timeout=5, isolation_level=None)
        where = {"host": self.url.host, "port": self.url.port, "user": self.url.username}
        if self.kind == "postgresql":
            import psycopg

            return psycopg.connect(
                **where, password=self.url.password, dbname=self.url.database, autocommit=True
            )
        import pymysql

        return pymysql.connect(
            **where, password=self.url.password, database=self.url.database, autocommit=True
        )
