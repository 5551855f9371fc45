"""Deleting what is old: a few rows at a time, so that nobody waits for the database."""

from __future__ import annotations

from typing import Any

from sqlalchemy import Column, ColumnElement, Connection, delete, select


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
    """Return a text column for a condition beside that on the time, which the database is to go by.

    By the index of a state it would have to read nearly every row to see how old that is.
    """
    return column.concat("")
