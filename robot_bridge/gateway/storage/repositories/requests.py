"""Rows of robots' requests and of the answers to them."""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Callable, Collection, Mapping, Sequence
from typing import NamedTuple

from sqlalchemy import (
    Connection,
    LargeBinary,
    Text,
    and_,
    bindparam,
    case,
    cast,
    delete,
    func,
    insert,
    or_,
    select,
    update,
)

from ....core.json_decoder import SHORT, DecodingError, decode_json
from ....core.messages.base import LARGEST_MESSAGE, to_json
from ....core.messages.robots import COMMANDS, Abort, Answer, OpAck, SetMap
from ..rows import BatchedWork, Row, add_messages, delete_messages, padded_pieces
from ..schema import rr, sa

# --- Table RR: robots insert, the gateway reads and deletes ---

AT_ONCE = 500
LONGEST_ACK = SHORT.length
"""characters of an OpAck; a stop must not wait for the decoding of longer ones."""
MOST_ACKS = 1000
"""OpAcks of one robot that are checked for a stop; a working robot has a few."""
_LONGEST_NAME = 64
"""characters read of a robot's name and of an operation; every valid one is shorter."""

# SQLite keeps bytes in a text column as bytes, and one row of them must not hold up the others.
# SQLite does not enforce column lengths: longer values are cut, or left out, before they are fetched.
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
_READ_REQUESTS = select(*_ROW).order_by(rr.c.id).limit(AT_ONCE)
_ACKS = select(cast(rr.c.robot, Text), _PARAMS).where(
    rr.c.robot.in_(bindparam("robots", expanding=True)),
    rr.c.op == "OpAck",
    rr.c.id <= bindparam("newest"),
    _SIZE <= LONGEST_ACK,
)
_ANY = 2**63 - 1


class RequestRow(NamedTuple):
    """A row of RR as written, not yet decoded."""

    id: int
    robot: str
    op: str
    params: str | None
    size: int | None = None
    """characters of ``params``, which is None if they are too many."""


def read_requests(connection: Connection) -> list[RequestRow]:
    """Return the oldest requests, :data:`AT_ONCE` at most."""
    return [RequestRow(*row) for row in connection.execute(_READ_REQUESTS)]


def backlog(connection: Connection, robots: Sequence[str]) -> tuple[int, dict[str, set[int]]]:
    """Return the id of the newest request, 0 without one, and :func:`acknowledged` of ``robots`` up to it."""
    newest = connection.scalar(select(func.max(rr.c.id))) or 0
    return newest, acknowledged(connection, robots, newest)


def acknowledged(connection: Connection, robots: Sequence[str], newest: int = _ANY) -> dict[str, set[int]]:
    """Return for each of ``robots`` the messages whose OpAcks wait to be read, up to request ``newest``.

    No other robot's rows are read. OpAcks that are invalid or too long are left out, and so are those of a
    robot beyond :data:`MOST_ACKS`: emergency stops wait for this.
    """
    found: dict[str, set[int]] = {robot: set() for robot in robots}
    seen: Counter[str] = Counter()
    for begin in range(0, len(robots), AT_ONCE):
        some = {"robots": robots[begin : begin + AT_ONCE], "newest": newest}
        for robot, params in connection.execute(_ACKS, some):
            # MariaDB compares names without regard to case.
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
    # In Python true is an integer as well, and would be message 1.
    return id if type(id) is int else None


def payload(connection: Connection, id: int, check_size: Callable[[int], None]) -> bytes | None:
    """Return the payload of a request, if it has one; ``check_size`` may refuse it before it is read."""
    size = connection.scalar(select(func.length(rr.c.payload)).where(rr.c.id == id))
    if size is None:
        return None
    check_size(size)
    # SQLite returns text written into the column as text.
    return bytes(
        connection.execute(select(cast(rr.c.payload, LargeBinary)).where(rr.c.id == id)).scalar_one()
    )


def remove_requests(connection: Connection, ids: Sequence[int]) -> None:
    """Delete processed requests."""
    delete_messages(connection, rr, ids)


def add_requests(connection: Connection, rows: Sequence[tuple[str, str, str, bytes | None]]) -> None:
    """Write requests (robot, op, params, payload), as a robot does: it may not read what it inserted."""
    add_messages(connection, rr, ("robot", "op", "params", "payload"), rows)


# --- Table SA: the gateway inserts; a robot reads and deletes its own rows. The outbox of every robot ---

ORDERS = tuple(op for op in COMMANDS if op != Abort.__name__)
"""Messages that move a robot, or set its position: it must know the map before."""

MOST_UNREAD_ACKS = 300
"""OpAcks of one robot that are kept for it: one that deletes none would fill the disk."""

# Built once: SQLAlchemy takes longer to build a statement than the database to do it.
_LATER = or_(
    and_(sa.c.urgent == 0, sa.c.id > bindparam("after")),
    and_(sa.c.urgent > 0, sa.c.id > bindparam("after_urgent")),
)
_ANSWER = select(sa.c.id, sa.c.op, sa.c.params, sa.c.payload, sa.c.urgent)
_READ_ANSWERS = _ANSWER.where(sa.c.robot == bindparam("of"), _LATER).order_by(sa.c.urgent.desc(), sa.c.id)
_ABORTS = select(sa.c.id).where(sa.c.robot == bindparam("of"), sa.c.op == Abort.__name__, _LATER)
_READ_THESE = _ANSWER.add_columns(sa.c.robot).where(sa.c.id.in_(bindparam("ids", expanding=True)))
_OF_THESE = sa.c.robot.in_(bindparam("robots", expanding=True))
_OF_ROBOTS = select(sa.c.id, sa.c.robot, sa.c.urgent).where(_OF_THESE)
_ROBOT_OF = select(sa.c.id, sa.c.robot).where(sa.c.id.in_(bindparam("ids", expanding=True)))
_UNFILLED_MAPS = select(sa.c.id).where(
    sa.c.robot == bindparam("of"), sa.c.op == SetMap.__name__, sa.c.payload.is_(None)
)
_FILL = update(sa).where(sa.c.id == bindparam("one")).values(payload=bindparam("content"))
_NAMES = ("robot", "op", "params", "payload", "urgent")
_ADD_NUMBERED = insert(sa).returning(sa.c.id, sort_by_parameter_order=True)
_REMOVE_OWN = delete(sa).where(sa.c.robot == bindparam("of"), sa.c.id == bindparam("one"))
_REMOVE_ONE = delete(sa).where(sa.c.id == bindparam("one"))
_WAITING = select(sa.c.id).where(sa.c.id.in_(bindparam("ids", expanding=True)))
# Found first, and then deleted by id: a deletion that searches for its rows waits at those of others.
_KINDS = select(sa.c.id).where(sa.c.op.in_(bindparam("ops", expanding=True)))
_UNLOCKED_KINDS = _KINDS.where(_OF_THESE).with_for_update(skip_locked=True)
_KINDS_OF_ROBOTS = _KINDS.add_columns(sa.c.robot, sa.c.op).where(_OF_THESE).order_by(sa.c.id.desc())
_IS_ACK = sa.c.op == OpAck.__name__
_WITH_MANY_ACKS = (
    select(sa.c.robot).where(_IS_ACK).group_by(sa.c.robot).having(func.count() > MOST_UNREAD_ACKS)
)
_ACKS_OF = select(sa.c.id).where(sa.c.robot == bindparam("of"), _IS_ACK)
_NEWEST_SURPLUS_ACK = _ACKS_OF.order_by(sa.c.id.desc()).offset(MOST_UNREAD_ACKS).limit(1)
_SURPLUS_ACKS = (
    _ACKS_OF.where(sa.c.id <= bindparam("newest"))
    .order_by(sa.c.id)
    .limit(bindparam("most"))
    .with_for_update(skip_locked=True)
)


class AnswerRow(NamedTuple):
    """A row of SA. A SetMap without a payload is the map of the whole site, as it is when it is sent."""

    id: int
    op: str
    params: str | None
    payload: bytes | None
    urgent: bool = False


def add(connection: Connection, robot: str, answer: Answer) -> int:
    """Write an answer for ``robot``; return its id."""
    key = connection.execute(insert(sa), _named(robot, answer)).inserted_primary_key
    assert key is not None
    return int(key[0])


def add_answers(connection: Connection, rows: Sequence[tuple[str, Answer]]) -> None:
    """Write many answers, each with its robot."""
    add_messages(connection, sa, _NAMES, [_row(robot, answer) for robot, answer in rows])


def add_numbered(connection: Connection, rows: Sequence[tuple[str, Answer]]) -> list[int]:
    """Write many answers, each with its robot; return their ids in the same order."""
    if not rows:
        return []
    return list(connection.scalars(_ADD_NUMBERED, [_named(robot, answer) for robot, answer in rows]))


def _named(robot: str, answer: Answer) -> dict[str, object]:
    return dict(zip(_NAMES, _row(robot, answer), strict=True))


def _row(robot: str, answer: Answer) -> Row:
    payload = (answer.map or None) if isinstance(answer, SetMap) else None
    urgent = int(isinstance(answer, Abort) and answer.emergency)
    return robot, type(answer).__name__, json.dumps(to_json(answer)), payload, urgent


def read_answers(
    connection: Connection, robot: str, after: int = 0, after_urgent: int = 0
) -> list[AnswerRow]:
    """Return the robot's answers, the urgent ones first, then the oldest first.

    Of the urgent ones those with an id above ``after_urgent``, of the others those above ``after``: an urgent
    one overtakes others that are older.
    """
    found = connection.execute(_READ_ANSWERS, {"of": robot, "after": after, "after_urgent": after_urgent})
    return [AnswerRow(*row[:4], urgent=bool(row[4])) for row in found]


def waiting_aborts(connection: Connection, robot: str, after: int, after_urgent: int) -> set[int]:
    """Return the ids of the Aborts among the robot's answers, as :func:`read_answers` selects them."""
    return set(connection.scalars(_ABORTS, {"of": robot, "after": after, "after_urgent": after_urgent}))


Outbox = tuple[str, int, int]
"""A robot, and the ids of the last sent message and of the last sent urgent one."""


class _ReadOutbox(BatchedWork[list[AnswerRow]]):
    """As :func:`read_answers`."""

    def do_all(self, connection: Connection, asked: Sequence[Outbox]) -> list[list[AnswerRow]]:
        """Return the answers that wait for each."""
        if len(asked) == 1:
            return [read_answers(connection, *asked[0])]
        # Payloads of sent messages, which may be megabytes, must not be read again.
        oldest: dict[str, tuple[int, int]] = {}
        for robot, *last in asked:
            after, after_urgent = oldest.get(robot, last)
            oldest[robot] = min(after, last[0]), min(after_urgent, last[1])
        ids = [
            row.id
            for some in padded_pieces(list(oldest))
            for row in connection.execute(_OF_ROBOTS, {"robots": some})
            if row.robot in oldest and row.id > oldest[row.robot][row.urgent > 0]
        ]
        found: dict[str, list[AnswerRow]] = {robot: [] for robot in oldest}
        for some_ids in padded_pieces(ids):
            for row in connection.execute(_READ_THESE, {"ids": some_ids}):
                id, op, params, payload, urgent, robot = row
                found[robot].append(AnswerRow(id, op, params, payload, bool(urgent)))
        for rows in found.values():
            rows.sort(key=lambda row: (not row.urgent, row.id))
        return [[row for row in found[robot] if row.id > last[row.urgent]] for robot, *last in asked]


read_outbox = _ReadOutbox()


def remove_answers(connection: Connection, ids: Sequence[int]) -> None:
    """Delete delivered or void answers."""
    delete_messages(connection, sa, ids)


def remove_own(connection: Connection, answers: Sequence[tuple[str, int]]) -> None:
    """Delete answers by robot and id, if they are the robot's own."""
    if len(answers) == 1:
        ((robot, id),) = answers
        connection.execute(_REMOVE_OWN, {"of": robot, "one": id})
        return
    # Found first, as the kinds below. A robot may have deleted some by then.
    own = set(answers)
    for some in padded_pieces([id for _, id in answers]):
        found = connection.execute(_ROBOT_OF, {"ids": some})
        remove_answers(connection, [id for id, robot in found if (robot, id) in own])


def withdraw_unread(connection: Connection, ids: Sequence[int]) -> set[int]:
    """Delete those of some answers that were not read and deleted before; return their ids.

    One by one: only for a single deletion does every server report whether it found its row, after waiting
    for a robot that is about to commit.
    """
    return {id for id in ids if connection.execute(_REMOVE_ONE, {"one": id}).rowcount}


def remove_kinds(connection: Connection, robots: Sequence[str], ops: Sequence[str]) -> None:
    """Delete the answers of the kinds ``ops`` for ``robots``."""
    for some in padded_pieces(robots):
        found = connection.scalars(_KINDS_OF_ROBOTS, {"robots": some, "ops": ops})
        remove_answers(connection, list(found))


def remove_void(connection: Connection, void: Mapping[str, Collection[str]]) -> None:
    """Delete the answers of the kinds that are ``void`` for each robot.

    Maps are deleted only if no message that needs one waits behind them.
    """
    ops = sorted({op for kinds in void.values() for op in kinds} | set(ORDERS))
    for some in padded_pieces([robot for robot, kinds in void.items() if kinds]):
        gone, needing = [], set()
        # The newest first.
        for id, robot, op in connection.execute(_KINDS_OF_ROBOTS, {"robots": some, "ops": ops}):
            kinds = void.get(robot, ())
            if op in kinds and not (op == SetMap.__name__ and robot in needing):
                gone.append(id)
            if op in ORDERS:
                needing.add(robot)
        remove_answers(connection, gone)


def fill_maps(connection: Connection, robot: str, content: bytes) -> None:
    """Write ``content`` into those of the robot's maps that are placeholders for the whole site's map."""
    for id in list(connection.scalars(_UNFILLED_MAPS, {"of": robot})):
        connection.execute(_FILL, {"one": id, "content": content})


def remove_unlocked(connection: Connection, robots: Sequence[str], ops: Sequence[str]) -> None:
    """Delete the answers of the kinds ``ops`` for ``robots`` except those that a robot is just reading."""
    for some in padded_pieces(robots):
        found = connection.scalars(_UNLOCKED_KINDS, {"robots": some, "ops": ops})
        remove_answers(connection, list(found))


def surplus_acks(connection: Connection) -> dict[str, int]:
    """Return the robots with more than :data:`MOST_UNREAD_ACKS`, each with its newest OpAck beyond these."""
    robots = list(connection.scalars(_WITH_MANY_ACKS))
    newest = {robot: connection.scalar(_NEWEST_SURPLUS_ACK, {"of": robot}) for robot in robots}
    return {robot: id for robot, id in newest.items() if id is not None}


def remove_acks(connection: Connection, robot: str, newest: int, most: int) -> int:
    """Delete at most ``most`` OpAcks of a robot up to the id ``newest``, oldest first; return their number.

    Those that a robot is just reading are left.
    """
    found = list(connection.scalars(_SURPLUS_ACKS, {"of": robot, "newest": newest, "most": most}))
    remove_answers(connection, found)
    return len(found)


def remove_everywhere(connection: Connection, ops: Sequence[str]) -> None:
    """Delete the answers of the kinds ``ops``, for all robots."""
    remove_answers(connection, list(connection.scalars(_KINDS, {"ops": ops})))


def waiting(connection: Connection, ids: Sequence[int]) -> set[int]:
    """Return those of ``ids`` that still wait to be read."""
    if not ids:
        return set()
    return set(connection.scalars(_WAITING, {"ids": ids}))
