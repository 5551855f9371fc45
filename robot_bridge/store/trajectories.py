"""Where robots have been: written in batches, read in pages by robot, time and area, deleted in pieces."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

from sqlalchemy import ColumnElement, Connection, and_, delete, insert, or_, select

from ..messages import SendPos
from .schema import trajectories


class Fix(NamedTuple):
    """A pose of a robot at the gateway's time ``received_at``."""

    robot: str
    received_at: float
    pose: SendPos


class Place(NamedTuple):
    """A stored position: times are seconds since 1970-01-01 UTC, x and y metres in the site frame."""

    id: int
    robot: str
    received_at: float
    x: float
    y: float
    theta: float
    v: float
    device_time: float | None
    fix_time: float | None


class Mark(NamedTuple):
    """Where a page ended: the next begins behind it."""

    received_at: float
    id: int


@dataclass(frozen=True)
class Wanted:
    """Which positions: of ``robots`` (empty for all), from ``since`` up to ``until``, inside ``bounds``.

    Times are the gateway's; ``bounds`` is x_min, y_min, x_max, y_max in the site frame, its edges included.
    """

    robots: tuple[str, ...] = ()
    since: float | None = None
    until: float | None = None
    bounds: tuple[float, float, float, float] | None = None


def add(connection: Connection, fixes: Sequence[Fix]) -> None:
    """Store positions."""
    if not fixes:
        return
    # Thousands a second: the driver takes the rows as they are, and nothing is looked up for each.
    statement = insert(trajectories).inline().values(dict.fromkeys(_row(fixes[0])))
    compiled = statement.compile(dialect=connection.dialect)
    rows: list[Any] = [_row(fix) for fix in fixes]
    if compiled.positional:
        rows = [tuple(row.values()) for row in rows]
    connection.exec_driver_sql(str(compiled), rows)


def read(connection: Connection, wanted: Wanted, limit: int, after: Mark | None = None) -> list[Place]:
    """Return at most ``limit`` positions behind ``after``, oldest first."""
    at, id = trajectories.c.received_at, trajectories.c.id
    names = ("id", "robot", "received_at", "x", "y", "theta", "v", "device_time", "fix_time")
    query = select(*(trajectories.c[name] for name in names)).where(*_conditions(wanted))
    if after is not None:
        # The first half alone lets the database begin at the right place of its index.
        query = query.where(
            at >= after.received_at, or_(at > after.received_at, and_(at == after.received_at, id > after.id))
        )
    return [Place(*row) for row in connection.execute(query.order_by(at, id).limit(limit))]


def older_than(connection: Connection, time: float, limit: int) -> list[int]:
    """Return the ids of at most ``limit`` positions stored before ``time``."""
    at = trajectories.c.received_at
    return list(connection.scalars(select(trajectories.c.id).where(at < time).order_by(at).limit(limit)))


def remove(connection: Connection, ids: Sequence[int]) -> None:
    """Delete positions."""
    connection.execute(delete(trajectories).where(trajectories.c.id.in_(ids)))


def _conditions(wanted: Wanted) -> Iterator[ColumnElement[bool]]:
    columns = trajectories.c
    if wanted.robots:
        yield columns.robot.in_(wanted.robots)
    if wanted.since is not None:
        yield columns.received_at >= wanted.since
    if wanted.until is not None:
        yield columns.received_at <= wanted.until
    if wanted.bounds is not None:
        x_min, y_min, x_max, y_max = wanted.bounds
        yield columns.x.between(x_min, x_max)
        yield columns.y.between(y_min, y_max)


def _row(fix: Fix) -> dict[str, Any]:
    pose = fix.pose
    return {
        "robot": fix.robot,
        "received_at": fix.received_at,
        "x": pose.x,
        "y": pose.y,
        "theta": pose.theta,
        "v": pose.v,
        "device_time": pose.t,
        "fix_time": pose.fix_t,
    }
