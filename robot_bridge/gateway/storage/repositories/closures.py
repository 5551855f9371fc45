"""Closed roads, and robots that wait for others to pass."""

from __future__ import annotations

import json
from typing import Any, NamedTuple

from sqlalchemy import Connection, delete, insert, select, update

from ....core.json_decoder import decode_json
from ....core.messages.base import to_json
from ....core.messages.robots import SetPath
from ..rows import delete_oldest, readable
from ..schema import closures, holds


class ClosureRow(NamedTuple):
    """A stretch of road, (x, y) in metres in the site frame; in force as long as ``opened_at`` is None."""

    id: str
    line: list[tuple[float, float]]
    level: int
    closed_at: float
    closed_by: str
    reason: str | None = None
    until: float | None = None
    opened_at: float | None = None
    opened_by: str | None = None


class HoldRow(NamedTuple):
    """A robot that waits at the end of ``command``; ``rest`` are the parameters of the next message.

    ``task`` is the task of its queue that continues then, None if it was sent there beside its queue.
    """

    robot: str
    other: str
    command: str
    rest: dict[str, Any]
    until: float
    by: str
    task: str | None = None


def add(connection: Connection, closure: ClosureRow) -> None:
    """Write a closure."""
    values = {**closure._asdict(), "line": json.dumps(closure.line)}
    connection.execute(insert(closures), values)


def find(connection: Connection, id: str) -> ClosureRow | None:
    """Return a closure by its id."""
    row = connection.execute(select(*_COLUMNS).where(closures.c.id == id)).first()
    return None if row is None else _row(row)


def in_force(connection: Connection) -> list[ClosureRow]:
    """Return the closures that are in force, oldest first."""
    query = select(*_COLUMNS).where(closures.c.opened_at.is_(None)).order_by(closures.c.closed_at)
    return list(readable(connection.execute(query), _row, lambda row: f"closed road {row.id}"))


def end(connection: Connection, id: str, at: float, by: str) -> None:
    """Record that a road is open again."""
    values = {"opened_at": at, "opened_by": by}
    connection.execute(update(closures).where(closures.c.id == id).values(values))


def forget(connection: Connection, before: float, limit: int) -> int:
    """Delete at most ``limit`` closures that were ended before a time; return how many."""
    return len(delete_oldest(connection, closures.c.id, closures.c.opened_at, before, limit))


def hold(connection: Connection, row: HoldRow) -> None:
    """Record that a robot waits, replacing its earlier record."""
    release(connection, row.robot)
    connection.execute(insert(holds), {**row._asdict(), "rest": json.dumps(row.rest)})


def release(connection: Connection, robot: str) -> None:
    """Record that a robot no longer waits."""
    connection.execute(delete(holds).where(holds.c.robot == robot))


def held(connection: Connection) -> list[HoldRow]:
    """Return the waiting robots."""
    query = select(*(holds.c[name] for name in HoldRow._fields)).order_by(holds.c.robot)
    return list(readable(connection.execute(query), _hold, lambda row: f"how robot {row.robot} waits"))


def _hold(found: Any) -> HoldRow:
    row = HoldRow(*found)
    rest = decode_json(found.rest)
    # Decoded now: when it is sent later, an error could not be reported to anybody.
    return row._replace(
        rest=to_json(SetPath([(float(x), float(y)) for x, y in rest["points"]], rest.get("theta")))
    )


_COLUMNS: list[Any] = [closures.c[name] for name in ClosureRow._fields]


def _row(found: Any) -> ClosureRow:
    row = ClosureRow(*found)
    return row._replace(line=[(float(x), float(y)) for x, y in decode_json(found.line)])
