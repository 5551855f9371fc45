"""Many rows into a table at once: thousands come every second, and the driver takes them as they are."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import lru_cache
from typing import Any

from sqlalchemy import Connection, Table

TOGETHER = 100
"""rows in one statement: what the driver and the interpreter do for each is then done for all of them."""

Row = tuple[Any, ...]


def add_rows(connection: Connection, table: Table, names: Sequence[str], rows: Sequence[Row]) -> None:
    """Insert ``rows``; each holds the values of the columns ``names``.

    All other columns keep their default in the database.
    """
    for some in _pieces(rows):
        text = _insert(table.name, tuple(names), len(some), _mark(connection))
        connection.exec_driver_sql(text, tuple(value for row in some for value in row))


def put_rows(connection: Connection, table: Table, names: Sequence[str], rows: Sequence[Row]) -> None:
    """Insert ``rows`` in place of those with the same value in the first of the columns ``names``."""
    for some in _pieces(rows):
        mark = _mark(connection)
        text = f"DELETE FROM {table.name} WHERE {names[0]} IN ({_marks(mark, len(some))})"
        connection.exec_driver_sql(text, tuple(row[0] for row in some))
    add_rows(connection, table, names, rows)


def _pieces(rows: Sequence[Row]) -> Iterator[Sequence[Row]]:
    return (rows[begin : begin + TOGETHER] for begin in range(0, len(rows), TOGETHER))


@lru_cache
def _insert(table: str, names: tuple[str, ...], rows: int, mark: str) -> str:
    row = f"({_marks(mark, len(names))})"
    return f"INSERT INTO {table} ({', '.join(names)}) VALUES {', '.join([row] * rows)}"


def _mark(connection: Connection) -> str:
    return "?" if connection.dialect.paramstyle == "qmark" else "%s"


def _marks(mark: str, number: int) -> str:
    return ", ".join([mark] * number)
