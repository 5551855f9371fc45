"""Trajectories: written in batches, read in pages by robot, time and area, deleted in pieces.

On PostgreSQL each day is a partition, which is dropped whole. The functions that make and drop partitions are
in migration 0011: they run as the owner of the tables, and give up waiting for a lock held for long.
"""

from __future__ import annotations

import math
import struct
from collections.abc import Collection, Iterable, Iterator, Sequence
from dataclasses import dataclass
from operator import itemgetter
from typing import NamedTuple

from sqlalchemy import ColumnElement, Connection, and_, delete, func, or_, select

from ....core.messages.robots import SendPos
from ..rows import add_rows, copy_rows, delete_oldest
from ..schema import trajectories


class Fix(NamedTuple):
    """A pose of a robot at the gateway's time ``received_at``."""

    robot: str
    received_at: float
    pose: SendPos


PackedFix = tuple[str, bytes]
"""A robot and one of its fixes for storage, in a third of the memory of a :class:`Fix`. It contains no
objects tracked by Python's garbage collector: hundreds of thousands may wait."""

_STORED = struct.Struct("<7d")
"""received_at, x, y, theta, v, device_time and fix_time; NaN for a missing time."""


_NAMES = ("robot", "received_at", "x", "y", "theta", "v", "device_time", "fix_time")
# PostgreSQL's COPY has the length before each value, for null -1 and no value.
_COPIED_HEAD = struct.Struct(">hi")
_COPIED = struct.Struct(">" + "id" * 5)
_COPIED_TIME = struct.Struct(">id")
_NULL = struct.pack(">i", -1)

DAY = 86_400.0
"""seconds of a day, which begins at midnight UTC. The number of a day is a time divided by this."""
MOST_MOVED = 50_000
"""positions stored before the partition of their day that are moved to it; with more of them no partition is
made, since others would wait too long."""


class StoredPosition(NamedTuple):
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


class PageMark(NamedTuple):
    """End of a page: the next one begins behind it."""

    received_at: float
    id: int


@dataclass(frozen=True)
class TrajectoryQuery:
    """Which positions: of ``robots`` (empty for all), from ``since`` up to ``until``, inside ``bounds``.

    Times are the gateway's; ``bounds`` is x_min, y_min, x_max, y_max in the site frame, its edges included.
    """

    robots: tuple[str, ...] = ()
    since: float | None = None
    until: float | None = None
    bounds: tuple[float, float, float, float] | None = None


def pack(fix: Fix) -> PackedFix:
    """Return ``fix`` packed for storage."""
    robot, at, p = fix
    device_time = math.nan if p.t is None else p.t
    fix_time = math.nan if p.fix_t is None else p.fix_t
    return robot, _STORED.pack(at, p.x, p.y, p.theta, p.v, device_time, fix_time)


def add(connection: Connection, fixes: Sequence[PackedFix]) -> None:
    """Store positions.

    They are grouped by robot, in order: each page of an index on robots is then written once, which takes
    half as long with a thousand robots in a table of some hundred thousand rows.
    """
    fixes = sorted(fixes, key=itemgetter(0))
    if not fixes:
        return
    if connection.dialect.name == "postgresql":
        copy_rows(connection, trajectories, _NAMES, [_copied(robot, stored) for robot, stored in fixes])
    else:
        add_rows(connection, trajectories, _NAMES, [_row(robot, stored) for robot, stored in fixes])


def _copied(robot: str, stored: bytes) -> bytes:
    """Return a row in the binary format of PostgreSQL's COPY."""
    name = robot.encode()
    at, x, y, theta, v, device_time, fix_time = _STORED.unpack(stored)
    head = _COPIED_HEAD.pack(len(_NAMES), len(name))
    numbers = _COPIED.pack(8, at, 8, x, 8, y, 8, theta, 8, v)
    return b"".join((head, name, numbers, _copied_time(device_time), _copied_time(fix_time)))


def _copied_time(time: float) -> bytes:
    return _NULL if math.isnan(time) else _COPIED_TIME.pack(8, time)


def _row(robot: str, stored: bytes) -> tuple[object, ...]:
    *where, device_time, fix_time = _STORED.unpack(stored)
    return robot, *where, _time_value(device_time), _time_value(fix_time)


def _time_value(time: float) -> float | None:
    return None if math.isnan(time) else time


def read(
    connection: Connection, request: TrajectoryQuery, limit: int, after: PageMark | None = None
) -> list[StoredPosition]:
    """Return at most ``limit`` positions behind ``after``, oldest first."""
    at, id = trajectories.c.received_at, trajectories.c.id
    query = select(*(trajectories.c[name] for name in ("id", *_NAMES))).where(*_conditions(request))
    if after is not None:
        # The first condition alone lets the database start at the right place of its index.
        query = query.where(
            at >= after.received_at, or_(at > after.received_at, and_(at == after.received_at, id > after.id))
        )
    return [StoredPosition(*row) for row in connection.execute(query.order_by(at, id).limit(limit))]


def next_time(connection: Connection, since: float) -> float | None:
    """Return when the oldest position from a time on was received, seconds since 1970; or None."""
    at = trajectories.c.received_at
    found: float | None = connection.scalar(select(func.min(at)).where(at >= since))
    return found


def never_seen(connection: Connection, robots: Sequence[str]) -> list[str]:
    """Return those of ``robots`` without a stored position."""
    column = trajectories.c.robot
    return [
        robot
        for robot in robots
        if connection.scalar(select(trajectories.c.id).where(column == robot).limit(1)) is None
    ]


def days_of(fixes: Iterable[PackedFix]) -> list[int]:
    """Return the day numbers of positions."""
    return sorted({int(_STORED.unpack(stored)[0] // DAY) for _, stored in fixes})


def make_days(connection: Connection, days: Collection[int], most: int = MOST_MOVED) -> int:
    """Create missing partitions of ``days``; return how many are still missing.

    Stored positions of such a day are moved to it. A day still missing, with more than ``most`` positions or
    because of a long read of the table, keeps its positions in the default partition.
    """
    return connection.scalar(select(func.public.make_trajectory_days(list(days), most))) or 0


def drop_day(connection: Connection, before: float, _limit: int) -> int:
    """Drop the oldest partition that ended before a time; return how many were dropped.

    None is dropped without partitions, and during a long read of the table.
    """
    if connection.dialect.name != "postgresql":
        return 0
    return connection.scalar(select(func.public.drop_trajectory_day(before))) or 0


def forget(connection: Connection, before: float, limit: int) -> int:
    """Delete at most ``limit`` positions from before a time; return how many.

    Positions in a day's partition stay until it is dropped.
    """
    if connection.dialect.name == "postgresql":
        return connection.scalar(select(func.public.delete_old_positions(before, limit))) or 0
    return len(delete_oldest(connection, trajectories.c.id, trajectories.c.received_at, before, limit))


def is_known_within(connection: Connection, robot: str, since: float, until: float) -> bool:
    """Return whether a position of ``robot`` is stored from ``since`` up to ``until``."""
    query = select(trajectories.c.id).where(*_conditions(TrajectoryQuery((robot,), since, until))).limit(1)
    return connection.scalar(query) is not None


def forget_within(connection: Connection, robot: str, since: float, until: float, limit: int) -> int:
    """Delete at most ``limit`` positions of ``robot`` from ``since`` up to ``until``; return how many."""
    key = trajectories.c.id
    # With the ids alone PostgreSQL would search every partition.
    within = list(_conditions(TrajectoryQuery((robot,), since, until)))
    found = list(connection.scalars(select(key).where(*within).limit(limit)))
    if found:
        connection.execute(delete(trajectories).where(*within, key.in_(found)))
    return len(found)


def _conditions(request: TrajectoryQuery) -> Iterator[ColumnElement[bool]]:
    columns = trajectories.c
    if request.robots:
        yield columns.robot.in_(request.robots)
    if request.since is not None:
        yield columns.received_at >= request.since
    if request.until is not None:
        yield columns.received_at <= request.until
    if request.bounds is not None:
        x_min, y_min, x_max, y_max = request.bounds
        yield columns.x.between(x_min, x_max)
        yield columns.y.between(y_min, y_max)
