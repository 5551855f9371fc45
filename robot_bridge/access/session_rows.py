"""The operators' sessions as the database keeps them."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import asdict, dataclass

from sqlalchemy import Connection, insert, select, update

from ..store.ageing import delete_oldest
from ..store.schema import sessions
from .errors import AccessError

AT_ONCE = 500
"""sessions that are asked about in one statement."""


@dataclass(frozen=True)
class SessionRow:
    """One connection of an operator: who, with which token, from where, from when to when, why it ended."""

    id: str
    operator: str
    token: str | None
    role: str
    address: str
    began_at: float
    ended_at: float | None = None
    reason: str | None = None


def begin(connection: Connection, session: SessionRow) -> None:
    """Write a new session."""
    connection.execute(insert(sessions).values(**asdict(session)))


def rename(connection: Connection, id: str, operator: str) -> None:
    """Note who a session says it is."""
    connection.execute(update(sessions).where(sessions.c.id == id).values(operator=operator))


def end(connection: Connection, id: str, at: float, reason: str) -> SessionRow:
    """Note the end of a session; a gateway that has it open closes it. Raises AccessError when none is open.

    The session may also be named by the first digits of its id.
    """
    query = select(sessions).where(
        sessions.c.ended_at.is_(None), sessions.c.id.startswith(id, autoescape=True)
    )
    found = connection.execute(query.limit(2)).mappings().all()
    if len(found) != 1 or not id:
        what = "is the beginning of several" if found and id else "is not open"
        raise AccessError(f"session {id!r} {what}; 'robot-bridge sessions list' shows those that are")
    note_end(connection, found[0]["id"], at, reason)
    return SessionRow(**found[0])


def note_end(connection: Connection, id: str, at: float, reason: str) -> None:
    """Note the end of a session that has not been ended before."""
    open_one = (sessions.c.id == id) & sessions.c.ended_at.is_(None)
    connection.execute(update(sessions).where(open_one).values(ended_at=at, reason=reason))


def end_all(connection: Connection, at: float, reason: str) -> None:
    """Note the end of what an earlier gateway left open."""
    query = update(sessions).where(sessions.c.ended_at.is_(None))
    connection.execute(query.values(ended_at=at, reason=reason))


def forget_ended(connection: Connection, before: float, limit: int) -> int:
    """Delete at most ``limit`` sessions that ended before a time; return how many."""
    return len(delete_oldest(connection, sessions.c.id, sessions.c.ended_at, before, limit))


def ended_among(connection: Connection, open_here: Collection[str]) -> dict[str, str]:
    """Return which of the sessions that a gateway holds open somebody has ended, each with the reason."""
    found: dict[str, str] = {}
    wanted = sorted(open_here)
    for begin in range(0, len(wanted), AT_ONCE):
        some = sessions.c.id.in_(wanted[begin : begin + AT_ONCE])
        query = select(sessions.c.id, sessions.c.reason).where(some, sessions.c.ended_at.is_not(None))
        found.update({id: reason or "" for id, reason in connection.execute(query)})
    return found


def listed(connection: Connection, *, everything: bool, limit: int) -> list[SessionRow]:
    """Return the sessions that are open, or ``everything``, newest first."""
    query = select(sessions).order_by(sessions.c.began_at.desc(), sessions.c.id).limit(limit)
    if not everything:
        query = query.where(sessions.c.ended_at.is_(None))
    return [SessionRow(**row) for row in connection.execute(query).mappings()]
