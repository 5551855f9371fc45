"""Table RR: robots insert, the gateway reads and deletes."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Sequence
from typing import NamedTuple

from sqlalchemy import Connection, LargeBinary, Text, bindparam, case, cast, func, select

from ..core.decoding import SHORT, DecodingError, decode_json
from ..messages.bounds import LARGEST_MESSAGE
from .rows import add_messages, delete_messages
from .schema import rr

AT_ONCE = 500
LONGEST_ACK = SHORT.length
"""characters; of what is longer no stop is to wait until it is decoded."""
MOST_ACKS = 1000
"""OpAcks of one robot that are looked at for a stop; a robot that works has a few."""
_LONGEST_NAME = 64
"""characters of a robot's name and of an operation that are read; every right one is shorter."""

# SQLite keeps bytes in a text column as bytes, and one row of them must not hold up the others.
# SQLite holds no column to its length: what is longer than may be is cut, or left out, before it is fetched.
_PARAMS = cast(rr.c.params, Text)
_SIZE = func.length(_PARAMS)
_ROW = (
    rr.c.id,
    func.substr(cast(rr.c.robot, Text), 1, _LONGEST_NAME),
    func.substr(cast(rr.c.op, Text), 1, _LONGEST_NAME),
    case((_SIZE <= LARGEST_MESSAGE, _PARAMS)),
    _SIZE,
)
# Built once: SQLAlchemy takes longer to build a statement than the database to do it.
_READ = select(*_ROW).order_by(rr.c.id).limit(AT_ONCE)
_ACKS = select(cast(rr.c.robot, Text), _PARAMS).where(
    rr.c.robot.in_(bindparam("robots", expanding=True)),
    rr.c.op == "OpAck",
    rr.c.id <= bindparam("newest"),
    _SIZE <= LONGEST_ACK,
)
_ANY = 2**63 - 1


class RequestRow(NamedTuple):
    """A row of RR as it was written, not yet understood."""

    id: int
    robot: str
    op: str
    params: str | None
    size: int | None = None
    """characters of ``params``, which is None where they are too many."""


def read(connection: Connection) -> list[RequestRow]:
    """Return the oldest requests, :data:`AT_ONCE` at most."""
    return [RequestRow(*row) for row in connection.execute(_READ)]


def backlog(connection: Connection, robots: Sequence[str]) -> tuple[int, dict[str, set[int]]]:
    """Return the id of the newest request, 0 without one, and :func:`acknowledged` of ``robots`` up to it."""
    newest = connection.scalar(select(func.max(rr.c.id))) or 0
    return newest, acknowledged(connection, robots, newest)


def acknowledged(connection: Connection, robots: Sequence[str], newest: int = _ANY) -> dict[str, set[int]]:
    """Return of each of ``robots`` the messages whose OpAcks wait to be read, up to request ``newest``.

    Nothing is read of any other robot. An OpAck that cannot be understood, or is so long that it is none, is
    left out, and so is what a robot has beyond :data:`MOST_ACKS`: emergency stops wait for this.
    """
    found: dict[str, set[int]] = {robot: set() for robot in robots}
    seen: Counter[str] = Counter()
    for begin in range(0, len(robots), AT_ONCE):
        some = {"robots": robots[begin : begin + AT_ONCE], "newest": newest}
        for robot, params in connection.execute(_ACKS, some):
            # MariaDB takes names for the same that differ in capitals.
            if robot not in found or seen[robot] >= MOST_ACKS:
                continue
            seen[robot] += 1
            if (id := _message_id(params)) is not None:
                found[robot].add(id)
    return found


def _message_id(params: str | None) -> int | None:
    try:
        acknowledgement = decode_json(params or "{}", SHORT)
    except DecodingError:
        return None
    id = acknowledgement.get("id") if isinstance(acknowledgement, dict) else None
    # For Python true is a whole number as well, and would be message 1.
    return id if type(id) is int else None


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
