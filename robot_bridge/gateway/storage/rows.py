"""Rows in bulk: written or read by thousands, batched for several callers, deleted in pieces when old."""

from __future__ import annotations

import itertools
import json
import logging
from abc import ABC, abstractmethod
from collections.abc import Callable, Collection, Iterable, Iterator, Sequence
from functools import lru_cache
from typing import Any, Generic, NamedTuple, TypeVar

import msgspec
import numpy as np
from msgspec import ValidationError
from sqlalchemy import (
    ARRAY,
    Column,
    ColumnElement,
    Connection,
    Dialect,
    String,
    Table,
    Text,
    any_,
    cast,
    delete,
    literal,
    select,
)
from sqlalchemy.exc import DBAPIError

from ...core.errors import DataRefusedError

# --- Many rows into or out of a table at once: thousands come per second, passed to the driver unchanged

log = logging.getLogger(__name__)

TOGETHER = 100
"""rows in one statement: the driver's and interpreter's cost per statement is shared by all of them."""

_DELETE_BY_KEY = (
    "DELETE {table} FROM JSON_TABLE(%s, '$[*]' COLUMNS (id BIGINT PATH '$')) AS gone "
    "STRAIGHT_JOIN {table} ON {table}.id = gone.id"
)

Row = tuple[Any, ...]
T = TypeVar("T")
R = TypeVar("R")


class BatchedWork(ABC, Generic[T]):
    """Work that shares its statements among all waiting callers; a direct call does it for one."""

    @abstractmethod
    def do_all(self, connection: Connection, asked: Sequence[Any]) -> Sequence[T]:
        """Do it for several callers; ``asked`` has the arguments of each. Return a result for each.

        If it raises, nothing was done for any caller: it is called again for fewer.
        """

    def __call__(self, connection: Connection, *arguments: Any) -> T:
        """Do it for one."""
        (result,) = self.do_all(connection, [arguments])
        return result


class WorkDone(NamedTuple):
    """Outcome of a piece of work, by its number."""

    number: int
    result: Any


def do_together(
    connection: Connection, asked: Sequence[tuple[Callable[..., Any], tuple[Any, ...]]]
) -> list[WorkDone]:
    """Do pieces of work in order, all of one batched work at the place of its first.

    Return their outcomes in the order in which they were done.
    """
    together: dict[BatchedWork[Any], list[int]] = {}
    for number, (work, _) in enumerate(asked):
        if isinstance(work, BatchedWork):
            together.setdefault(work, []).append(number)
    done: list[WorkDone] = []
    for number, (work, arguments) in enumerate(asked):
        if not isinstance(work, BatchedWork):
            done.append(WorkDone(number, work(connection, *arguments)))
        elif numbers := together.pop(work, None):
            results = work.do_all(connection, [asked[one][1] for one in numbers])
            done += [WorkDone(*one) for one in zip(numbers, results, strict=True)]
    return done


def readable(rows: Iterable[R], read: Callable[[R], T], name: Callable[[R], str]) -> Iterator[T]:
    """Yield ``read(row)`` of each row; a row that it cannot read is logged by its ``name`` and skipped.

    A damaged row must not keep the gateway from the others, nor from starting.
    """
    for row in rows:
        try:
            yield read(row)
        except (ValueError, TypeError, LookupError, ArithmeticError, ValidationError) as error:
            log.error("%s cannot be read in the database and is left out: %s", name(row), error)


def add_rows(connection: Connection, table: Table, names: Sequence[str], rows: Sequence[Row]) -> None:
    """Insert ``rows`` in their order; each has the values of the columns ``names``, without bytes if several.

    All other columns get their database default.
    """
    if len(rows) > 1 and _takes_json(connection):
        for text in _as_json(rows):
            connection.exec_driver_sql(_insert_json(table, tuple(names), connection.dialect), (text,))
        return
    for some in _pieces(connection, rows):
        statement = _insert(table, tuple(names), len(some), connection.dialect)
        connection.exec_driver_sql(statement, tuple(value for row in some for value in row))


_COPY_HEAD = b"PGCOPY\n\xff\r\n\x00" + bytes(8)
_COPY_END = b"\xff\xff"


def copy_rows(connection: Connection, table: Table, names: Sequence[str], rows: Iterable[bytes]) -> None:
    """Insert ``rows`` on PostgreSQL; each is a row of its binary format of COPY with the columns ``names``.

    The driver is called directly; its errors are converted to those of SQLAlchemy.
    """
    driver: Any = connection.connection.driver_connection
    dialect = connection.dialect
    text = f"COPY {table.name} ({', '.join(names)}) FROM STDIN (FORMAT BINARY)"
    try:
        with driver.cursor() as cursor, cursor.copy(text) as copy:
            copy.write(b"".join((_COPY_HEAD, *rows, _COPY_END)))
    except dialect.loaded_dbapi.Error as error:
        lost = dialect.is_disconnect(error, driver, None)
        if lost:
            connection.invalidate(error)
        raise DBAPIError.instance(
            text, None, error, dialect.loaded_dbapi.Error, True, lost, dialect=dialect
        ) from error


def add_messages(connection: Connection, table: Table, names: Sequence[str], rows: Sequence[Row]) -> None:
    """Insert ``rows`` in their order; those with a ``payload`` one by one.

    A server limits the size of a statement, and a map may have megabytes.
    """
    payload = names.index("payload")
    for large, some in itertools.groupby(rows, lambda row: row[payload] is not None):
        for together in ([row] for row in some) if large else [list(some)]:
            add_rows(connection, table, names, together)


def upsert_rows(connection: Connection, table: Table, names: Sequence[str], rows: Sequence[Row]) -> None:
    """Insert ``rows``, replacing those with the same first of ``names``, which are all columns."""
    if _takes_json(connection):
        for text in _as_json(_last_of_each(rows)):
            connection.exec_driver_sql(_upsert_json(table, tuple(names), connection.dialect), (text,))
        return
    _delete_rows(connection, table, names[0], [row[0] for row in rows])
    add_rows(connection, table, names, rows)


def change_rows(connection: Connection, table: Table, names: Sequence[str], rows: Sequence[Row]) -> None:
    """Update the rows with the same value in the first of ``names``; missing ones are not inserted."""
    # For a few, PostgreSQL would read the whole table: it expects a hundred rows in any text.
    if len(rows) >= FEW and _takes_json(connection):
        for text in _as_json(_last_of_each(rows)):
            connection.exec_driver_sql(_update_json(table, tuple(names), connection.dialect), (text,))
    elif rows:
        statement = _update(table, tuple(names), connection.dialect)
        connection.exec_driver_sql(statement, [(*values, key) for key, *values in rows])


def delete_messages(connection: Connection, table: Table, ids: Sequence[int]) -> None:
    """Delete the rows of RR or SA with one of ``ids``, without waiting for any other row.

    For ``id in (...)`` MariaDB scans a small table and waits at every row that a robot has not committed.
    With a join that begins with the ids it finds each by the primary key.
    """
    if connection.dialect.name != "mariadb":
        _delete_rows(connection, table, "id", ids)
    elif ids:
        connection.exec_driver_sql(_DELETE_BY_KEY.format(table=table.name), (json.dumps(list(ids)),))


def is_one_of(
    connection: Connection, column: ColumnElement[str], values: Collection[str]
) -> ColumnElement[bool]:
    """Return the condition that ``column`` is one of ``values``, of any number.

    PostgreSQL takes 65535 values in a statement; a list counts as one.
    """
    if connection.dialect.name == "postgresql":
        return column == any_(cast(literal(list(values), ARRAY(Text)), ARRAY(Text)))
    return column.in_(values)


def padded_pieces(values: Sequence[T]) -> Iterator[list[T]]:
    """Yield pieces of ``values`` for an IN, the last one of each repeated until they are 1, 2, 4, 8 … .

    Drivers and servers cache one statement per number of values, and limit that number.
    """
    for begin in range(0, len(values), TOGETHER):
        some = values[begin : begin + TOGETHER]
        yield [*some, *itertools.repeat(some[-1], (1 << (len(some) - 1).bit_length()) - len(some))]


def _delete_rows(connection: Connection, table: Table, name: str, values: Sequence[Any]) -> None:
    for some in _pieces(connection, values):
        connection.exec_driver_sql(_delete(table, name, len(some), connection.dialect), tuple(some))


def _pieces(connection: Connection, rows: Sequence[T]) -> Iterator[Sequence[T]]:
    """Yield ``rows`` in pieces of at most ``TOGETHER``, on SQLite of 1, 2, 4, 8 … rows.

    Python caches 128 statements of SQLite: one for every number of rows takes megabytes, and an hour to fill.
    On a server each further piece costs a round trip.
    """
    few_kinds = connection.dialect.name == "sqlite"
    begin = 0
    while left := min(len(rows) - begin, TOGETHER):
        size = 1 << (left.bit_length() - 1) if few_kinds else left
        yield rows[begin : begin + size]
        begin += size


# Statement texts, cached by table and column names.


@lru_cache
def _insert(table: Table, names: tuple[str, ...], rows: int, dialect: Dialect) -> str:
    row = f"({_marks(dialect, len(names))})"
    return f"{_into(table, names, dialect)} VALUES {', '.join([row] * rows)}"  # nosec B608 # names of ours


@lru_cache
def _update(table: Table, names: tuple[str, ...], dialect: Dialect) -> str:
    key, *others = _quoted(names, dialect)
    mark = _marks(dialect, 1)
    values = ", ".join(f"{name} = {mark}" for name in others)
    return f"UPDATE {table.name} SET {values} WHERE {key} = {mark}"  # nosec B608 # names of ours


@lru_cache
def _delete(table: Table, name: str, rows: int, dialect: Dialect) -> str:
    return f"DELETE FROM {table.name} WHERE {name} IN ({_marks(dialect, rows)})"  # nosec B608 # names of ours


def _marks(dialect: Dialect, number: int) -> str:
    return ", ".join(["?" if dialect.paramstyle == "qmark" else "%s"] * number)


def _into(table: Table, names: Sequence[str], dialect: Dialect) -> str:
    return f"INSERT INTO {table.name} ({', '.join(_quoted(names, dialect))})"


def _quoted(names: Iterable[str], dialect: Dialect) -> list[str]:
    return [dialect.identifier_preparer.quote(name) for name in names]


# --- Rows as one JSON text, for PostgreSQL: its driver takes ten times as long for single values ---

FEW = 16
MOST_IN_TEXT = 5000
"""rows in one statement: a few megabytes."""


def _takes_json(connection: Connection) -> bool:
    return connection.dialect.name == "postgresql"


def _last_of_each(rows: Sequence[Row]) -> list[Row]:
    """Return the last of the rows with the same first value: one statement writes each row once."""
    return list({row[0]: row for row in rows}.values())


def _as_json(rows: Sequence[Row]) -> Iterator[str]:
    for begin in range(0, len(rows), MOST_IN_TEXT):
        yield msgspec.json.encode(rows[begin : begin + MOST_IN_TEXT], enc_hook=_number).decode()


def _number(value: object) -> object:
    """Return a number of NumPy as one of Python."""
    if isinstance(value, np.generic):
        return value.item()
    raise DataRefusedError(f"{type(value).__name__} cannot be stored")


@lru_cache
def _insert_json(table: Table, names: tuple[str, ...], dialect: Dialect) -> str:
    return f"{_into(table, names, dialect)} SELECT {_values(table, names, dialect)} FROM {_ELEMENTS}"  # nosec B608 # names of ours


@lru_cache
def _upsert_json(table: Table, names: tuple[str, ...], dialect: Dialect) -> str:
    key, *others = _quoted(names, dialect)
    new = ", ".join(f"{name} = excluded.{name}" for name in others)
    return f"{_insert_json(table, names, dialect)} ON CONFLICT ({key}) DO UPDATE SET {new}"  # nosec B608 # names of ours


@lru_cache
def _update_json(table: Table, names: tuple[str, ...], dialect: Dialect) -> str:
    key, *others = _quoted(names, dialect)
    new = ", ".join(f"{name} = v.{name}" for name in others)
    values = f"SELECT {_values(table, names, dialect)} FROM {_ELEMENTS}"  # nosec B608 # names of ours
    columns = ", ".join((key, *others))
    return f"UPDATE {table.name} t SET {new} FROM ({values}) AS v ({columns}) WHERE t.{key} = v.{key}"  # nosec B608 # names of ours


_ELEMENTS = "json_array_elements(cast(%s AS json)) WITH ORDINALITY AS e (r, n) ORDER BY n"


def _values(table: Table, names: Sequence[str], dialect: Dialect) -> str:
    """Return the values of a row that is a JSON array.

    Texts have no length limit here: a cast to a shorter type would truncate them, whereas an insertion
    refuses them.
    """
    kinds = [table.columns[name].type for name in names]
    texts = ["text" if isinstance(kind, String) else kind.compile(dialect) for kind in kinds]
    return ", ".join(f"cast(r ->> {number} AS {text})" for number, text in enumerate(texts))


# --- Deletion of old rows: a few at a time, so that nobody waits for the database ---


def delete_oldest(
    connection: Connection,
    key: Column[Any],
    at: Column[Any],
    before: float,
    limit: int,
    *only: ColumnElement[bool],
) -> list[Any]:
    """Delete at most ``limit`` rows whose time ``at`` is before ``before``, oldest first; return their keys.

    ``only`` are further conditions; see :func:`beside_the_time` for those on columns with an index. Two
    statements: MariaDB deletes by no limited selection.
    """
    query = select(key).where(at < before, *only).order_by(at).limit(limit)
    found = list(connection.scalars(query))
    if found:
        connection.execute(delete(key.table).where(key.in_(found)))
    return found


def beside_the_time(column: Column[str]) -> ColumnElement[str]:
    """Return a text column for a condition beside that on the time, whose index the database should use.

    By an index on a state it would have to read nearly every row to see its age.
    """
    return column.concat("")
