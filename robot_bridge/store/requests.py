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
    connection.execute(delete(rr).where(rr.c.id.in_(ids)))


def add(connection: Connection, robot: str, op: str, params: str) -> int:
    """Write a request, as a robot does; return its id."""
    key = connection.execute(insert(rr).values(robot=robot, op=op, params=params)).inserted_primary_key
    assert key is not None
    return int(key[0])
