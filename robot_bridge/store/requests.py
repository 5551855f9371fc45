"""Table RR: robots insert, the gateway reads and deletes."""

from __future__ import annotations

import json
from collections.abc import Callable, Sequence
from typing import NamedTuple

from sqlalchemy import Connection, LargeBinary, Text, cast, func, select

from .rows import add_messages, delete_messages
from .schema import rr

AT_ONCE = 500

# SQLite keeps bytes in a text column as bytes, and one row of them must not hold up the others.
_ROW = (rr.c.id, *(cast(column, Text) for column in (rr.c.robot, rr.c.op, rr.c.params)))
# Built once: SQLAlchemy takes longer to build a statement than the database to do it.
_READ = select(*_ROW).order_by(rr.c.id).limit(AT_ONCE)
_ACKS = select(cast(rr.c.robot, Text), cast(rr.c.params, Text)).where(rr.c.op == "OpAck")


class RequestRow(NamedTuple):
    """A row of RR as it was written, not yet understood."""

    id: int
    robot: str
    op: str
    params: str | None


def read(connection: Connection) -> list[RequestRow]:
    """Return the oldest requests, :data:`AT_ONCE` at most."""
    return [RequestRow(*row) for row in connection.execute(_READ)]


def backlog(connection: Connection) -> tuple[int, list[tuple[str, int]]]:
    """Return the id of the newest request, 0 without one, and which messages are acknowledged by which robot.

    Of acknowledgements those that cannot be understood are left out.
    """
    newest = connection.scalar(select(func.max(rr.c.id))) or 0
    return newest, acknowledgements(connection, newest)


def acknowledgements(connection: Connection, newest: int | None = None) -> list[tuple[str, int]]:
    """Return robots with the messages whose OpAcks wait to be read, up to request ``newest`` if given."""
    wanted = _ACKS if newest is None else _ACKS.where(rr.c.id <= newest)
    waiting = connection.execute(wanted)
    return [(robot, id) for robot, params in waiting if (id := _acknowledged(params)) is not None]


def _acknowledged(params: str | None) -> int | None:
    try:
        id = json.loads(params or "{}").get("id")
    except (ValueError, AttributeError):
        return None
    return id if isinstance(id, int) else None


def payload(connection: Connection, id: int, check_size: Callable[[int], None]) -> bytes | None:
    """Return the payload of a request, if it has one; ``check_size`` may refuse it before it is read."""
    size = connection.scalar(select(func.length(rr.c.payload)).where(rr.c.id == id))
    if size is None:
        return None
    check_size(size)
    # SQLite gives text that somebody wrote into it back as text.
    return bytes(
        connection.execute(select(cast(rr.c.payload, LargeBinary)).where(rr.c.id == id)).scalar_one()
    )


def remove(connection: Connection, ids: Sequence[int]) -> None:
    """Delete requests that have been dealt with."""
    delete_messages(connection, rr, ids)


def add_all(connection: Connection, rows: Sequence[tuple[str, str, str, bytes | None]]) -> None:
    """Write requests (robot, op, params, payload), as a robot does: it may not read what it inserted."""
    add_messages(connection, rr, ("robot", "op", "params", "payload"), rows)
