"""Table RR: robots insert, the gateway reads and deletes."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

from sqlalchemy import Connection, Text, cast, delete, insert, select

from .schema import rr


class RequestRow(NamedTuple):
    """A row of RR as it was written, not yet understood."""

    id: int
    robot: str
    op: str
    params: str | None


def read(connection: Connection, limit: int = 500) -> list[RequestRow]:
    """Return the oldest requests."""
    # SQLite keeps bytes in a text column as bytes, and one row of them must not hold up the others.
    robot, op, params = (cast(column, Text) for column in (rr.c.robot, rr.c.op, rr.c.params))
    query = select(rr.c.id, robot, op, params).order_by(rr.c.id).limit(limit)
    return [RequestRow(*row) for row in connection.execute(query)]


def remove(connection: Connection, ids: Sequence[int]) -> None:
    """Delete requests that have been dealt with."""
    if ids:
        connection.execute(delete(rr).where(rr.c.id.in_(ids)))


def add_all(connection: Connection, rows: Sequence[tuple[str, str, str]]) -> None:
    """Write requests (robot, op, params), as a robot does: it may insert and not read what it inserted."""
    if rows:
        values = [{"robot": robot, "op": op, "params": params} for robot, op, params in rows]
        connection.execute(insert(rr).inline(), values)
