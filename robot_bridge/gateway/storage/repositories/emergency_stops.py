"""Emergency stops: who stopped the fleet, when and why, and who cleared the stop."""

from __future__ import annotations

from collections.abc import Collection
from typing import Any, NamedTuple

from sqlalchemy import Connection, insert, or_, select, update
from sqlalchemy.dialects import postgresql

from ..rows import delete_oldest
from ..schema import emergency_stops


class StopRow(NamedTuple):
    """An emergency stop; in force as long as ``cleared_at`` is None."""

    id: str
    at: float
    by: str
    reason: str | None = None
    cleared_at: float | None = None
    cleared_by: str | None = None
    clear_reason: str | None = None


def add(connection: Connection, stop: StopRow) -> bool:
    """Write a new emergency stop, and return true; a stored one stays as it is.

    Several gateways may write the same one at the same time.
    """
    if connection.dialect.name == "postgresql":
        write = postgresql.insert(emergency_stops).on_conflict_do_nothing().values(stop._asdict())
        return connection.execute(write).rowcount > 0
    if find(connection, stop.id) is not None:
        return False
    connection.execute(insert(emergency_stops), stop._asdict())
    return True


def find(connection: Connection, id: str) -> StopRow | None:
    """Return an emergency stop by its id."""
    row = connection.execute(select(*_COLUMNS).where(emergency_stops.c.id == id)).first()
    return None if row is None else StopRow(*row)


def newest(connection: Connection) -> StopRow | None:
    """Return the newest stop that is in force; if none is, the last cleared one."""
    c = emergency_stops.c
    in_force = select(*_COLUMNS).where(c.cleared_at.is_(None)).order_by(c.at.desc()).limit(1)
    cleared = select(*_COLUMNS).order_by(c.cleared_at.desc(), c.at.desc()).limit(1)
    row = connection.execute(in_force).first() or connection.execute(cleared).first()
    return None if row is None else StopRow(*row)


def in_force(connection: Connection) -> list[StopRow]:
    """Return the stops that are in force, the newest first."""
    c = emergency_stops.c
    query = select(*_COLUMNS).where(c.cleared_at.is_(None)).order_by(c.at.desc())
    return [StopRow(*row) for row in connection.execute(query)]


def changed(connection: Connection, ids: Collection[str], after: float) -> list[StopRow]:
    """Return the stops in force, those cleared after a time, and those with ``ids``, the oldest first."""
    c = emergency_stops.c
    found = or_(c.cleared_at.is_(None), c.cleared_at > after, c.id.in_(ids))
    return [StopRow(*row) for row in connection.execute(select(*_COLUMNS).where(found).order_by(c.at))]


def ids(connection: Connection, most: int = 100_000) -> set[str]:
    """Return the ids of the newest stops."""
    query = select(emergency_stops.c.id).order_by(emergency_stops.c.at.desc()).limit(most)
    return set(connection.scalars(query))


def clear(
    connection: Connection, at: float, by: str, reason: str | None, known: Collection[str]
) -> StopRow | None:
    """End every stop in force; none if one of them is not ``known`` to the caller, which is returned.

    One that another gateway stores at the same time stays in force.
    """
    found = in_force(connection)
    if unknown := next((stop for stop in found if stop.id not in known), None):
        return unknown
    values = {"cleared_at": at, "cleared_by": by, "clear_reason": reason}
    ids_of = emergency_stops.c.id.in_([stop.id for stop in found])
    connection.execute(update(emergency_stops).where(ids_of).values(values))
    return None


def forget(connection: Connection, before: float, limit: int) -> int:
    """Delete at most ``limit`` stops that were cleared before a time; return how many."""
    return len(delete_oldest(connection, emergency_stops.c.id, emergency_stops.c.cleared_at, before, limit))


_COLUMNS: list[Any] = [emergency_stops.c[name] for name in StopRow._fields]
