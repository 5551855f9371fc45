"""Table SA: the gateway inserts; a robot reads and deletes its own rows. The outbox of every robot."""

from __future__ import annotations

import json
from collections.abc import Sequence
from typing import NamedTuple

from sqlalchemy import Connection, and_, bindparam, delete, func, insert, or_, select, update

from ..messages import COMMANDS, Abort, Answer, SetMap, to_json
from .rows import TOGETHER, Row, add_messages, delete_messages
from .schema import sa

ORDERS = tuple(op for op in COMMANDS if op != Abort.__name__)
"""What sets a robot in motion, or tells it where it is: it has to know the map before."""

# Built once: SQLAlchemy takes longer to build a statement than the database to do it.
_LATER = or_(
    and_(sa.c.urgent == 0, sa.c.id > bindparam("after")),
    and_(sa.c.urgent > 0, sa.c.id > bindparam("after_urgent")),
)
_READ = (
    select(sa.c.id, sa.c.op, sa.c.params, sa.c.payload, sa.c.urgent)
    .where(sa.c.robot == bindparam("of"), _LATER)
    .order_by(sa.c.urgent.desc(), sa.c.id)
)
_UNFILLED_MAPS = select(sa.c.id).where(
    sa.c.robot == bindparam("of"), sa.c.op == SetMap.__name__, sa.c.payload.is_(None)
)
_FILL = update(sa).where(sa.c.id == bindparam("one")).values(payload=bindparam("content"))
_NAMES = ("robot", "op", "params", "payload", "urgent")
_REMOVE_OWN = delete(sa).where(sa.c.robot == bindparam("of"), sa.c.id == bindparam("one"))
_REMOVE_ONE = delete(sa).where(sa.c.id == bindparam("one"))
_WAITING = select(sa.c.id).where(sa.c.id.in_(bindparam("ids", expanding=True)))
# Found first, and then deleted by their ids: a deletion that looks for its rows waits at those of others.
_KINDS = select(sa.c.id).where(sa.c.op.in_(bindparam("ops", expanding=True)))
_LAST_ORDER = select(func.max(sa.c.id)).where(sa.c.robot == bindparam("of"), sa.c.op.in_(ORDERS))
_MAPS_BEHIND_ORDERS = select(sa.c.id).where(
    sa.c.robot == bindparam("of"),
    sa.c.op == SetMap.__name__,
    sa.c.id > func.coalesce(_LAST_ORDER.scalar_subquery(), 0),
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


def add_all(connection: Connection, rows: Sequence[tuple[str, Answer]]) -> None:
    """Write many answers, each with its robot."""
    add_messages(connection, sa, _NAMES, [_row(robot, answer) for robot, answer in rows])


def add_numbered(connection: Connection, rows: Sequence[tuple[str, Answer]]) -> list[int]:
    """Write many answers, each with its robot; return their ids in the same order."""
    if not rows:
        return []
    ids = insert(sa).returning(sa.c.id, sort_by_parameter_order=True)
    return list(connection.scalars(ids, [_named(robot, answer) for robot, answer in rows]))


def _named(robot: str, answer: Answer) -> dict[str, object]:
    return dict(zip(_NAMES, _row(robot, answer), strict=True))


def _row(robot: str, answer: Answer) -> Row:
    payload = (answer.map or None) if isinstance(answer, SetMap) else None
    urgent = int(isinstance(answer, Abort) and answer.emergency)
    return robot, type(answer).__name__, json.dumps(to_json(answer)), payload, urgent


def read(connection: Connection, robot: str, after: int = 0, after_urgent: int = 0) -> list[AnswerRow]:
    """Return the robot's answers, the urgent ones first, then the oldest first.

    Of the urgent ones those with an id above ``after_urgent``, of the others those above ``after``: an urgent
    one overtakes others that are older.
    """
    found = connection.execute(_READ, {"of": robot, "after": after, "after_urgent": after_urgent})
    return [AnswerRow(*row[:4], urgent=bool(row[4])) for row in found]


def remove(connection: Connection, ids: Sequence[int]) -> None:
    """Delete answers that were delivered, or that are void."""
    delete_messages(connection, sa, ids)


def remove_own(connection: Connection, robot: str, id: int) -> None:
    """Delete answer ``id`` if it is the robot's own."""
    connection.execute(_REMOVE_OWN, {"of": robot, "one": id})


def take_back(connection: Connection, ids: Sequence[int]) -> set[int]:
    """Delete those of some answers that nobody has read and deleted before; return their ids.

    One by one: only of a single deletion does every server tell whether it found its row, after waiting for
    a robot that is about to commit.
    """
    return {id for id in ids if connection.execute(_REMOVE_ONE, {"one": id}).rowcount}


def remove_kinds(connection: Connection, robot: str, ops: Sequence[str]) -> None:
    """Delete the robot's answers of the kinds ``ops``."""
    remove(connection, list(connection.scalars(_KINDS.where(sa.c.robot == robot), {"ops": ops})))


def remove_maps(connection: Connection, robot: str) -> None:
    """Delete the robot's maps, but for those that something waits behind which needs a map first."""
    remove(connection, list(connection.scalars(_MAPS_BEHIND_ORDERS, {"of": robot})))


def fill_maps(connection: Connection, robot: str, content: bytes) -> None:
    """Write ``content`` into those of the robot's maps that only say that they are of the whole site."""
    for id in list(connection.scalars(_UNFILLED_MAPS, {"of": robot})):
        connection.execute(_FILL, {"one": id, "content": content})


def remove_unlocked(connection: Connection, robots: Sequence[str], ops: Sequence[str]) -> None:
    """Delete the answers of the kinds ``ops`` for ``robots`` but for those that a robot is just reading."""
    for begin in range(0, len(robots), TOGETHER):
        some = sa.c.robot.in_(robots[begin : begin + TOGETHER])
        found = connection.scalars(_KINDS.where(some).with_for_update(skip_locked=True), {"ops": ops})
        remove(connection, list(found))


def remove_everywhere(connection: Connection, ops: Sequence[str]) -> None:
    """Delete the answers of the kinds ``ops``, whoever they are for."""
    remove(connection, list(connection.scalars(_KINDS, {"ops": ops})))


def waiting(connection: Connection, ids: Sequence[int]) -> set[int]:
    """Return those of ``ids`` that still wait to be read."""
    if not ids:
        return set()
    return set(connection.scalars(_WAITING, {"ids": ids}))
