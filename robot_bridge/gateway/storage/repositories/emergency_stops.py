"""Emergency stops: who stopped the fleet, when and why, and who let it go again."""

from __future__ import annotations

from typing import Any, NamedTuple

from sqlalchemy import Connection, insert, select, update

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


def add(connection: Connection, stop: StopRow) -> None:
    """Write a new emergency stop; one that is stored already stays as it is."""
    if find(connection, stop.id) is None:
        connection.execute(insert(emergency_stops), stop._asdict())


def find(connection: Connection, id: str) -> StopRow | None:
    """Return an emergency stop by its id."""
    row = connection.execute(select(*_COLUMNS).where(emergency_stops.c.id == id)).first()
    return None if row is None else StopRow(*row)


def newest(connection: Connection) -> StopRow | None:
    """Return the newest stop that is in force; if none is, the one that was cleared last."""
    c = emergency_stops.c
    in_force = select(*_COLUMNS).where(c.cleared_at.is_(None)).order_by(c.at.desc()).limit(1)
    cleared = select(*_COLUMNS).order_by(c.cleared_at.desc(), c.at.desc()).limit(1)
    row = connection.execute(in_force).first() or connection.execute(cleared).first()
    return None if row is None else StopRow(*row)


def ids(connection: Connection, most: int = 1000) -> set[str]:
    """Return the ids of the newest stops."""
    query = select(emergency_stops.c.id).order_by(emergency_stops.c.at.desc()).limit(most)
    return set(connection.scalars(query))


def clear(connection: Connection, at: float, by: str, reason: str | None) -> None:
    """End every stop that is in force."""
    values = {"cleared_at": at, "cleared_by": by, "clear_reason": reason}
    in_force = emergency_stops.c.cleared_at.is_(None)
    connection.execute(update(emergency_stops).where(in_force).values(values))


def forget(connection: Connection, before: float, limit: int) -> int:
    """Delete at most ``limit`` stops that were cleared before a time; return how many."""
    return len(delete_oldest(connection, emergency_stops.c.id, emergency_stops.c.cleared_at, before, limit))


_COLUMNS: list[Any] = [emergency_stops.c[name] for name in StopRow._fields]
