"""Audit log and operators' sessions in the database, written in the background."""

from __future__ import annotations

import asyncio
import logging
from collections import deque
from collections.abc import Callable, Collection, Sequence
from dataclasses import asdict, dataclass
from typing import Any

from sqlalchemy import Connection, bindparam, insert, select, update

from ...core.clock import SYSTEM_CLOCK, Clock
from ...core.errors import AccessError, DataRefusedError, StoreError
from ...core.logs import TroubleNews
from ..storage.database import Database
from ..storage.rows import delete_oldest
from ..storage.schema import audit, sessions
from . import accounts

# --- The audit log: who did what, from where, and whether it was done ---

LONGEST_DETAIL = 2000


@dataclass(frozen=True)
class AuditEntry:
    """One action, done or tried: ``at`` is seconds since 1970, ``done`` is false when refused."""

    at: float
    who: str
    action: str
    done: bool
    role: str | None = None
    address: str | None = None
    subject: str | None = None
    detail: str | None = None
    id: int | None = None


def add_entries(connection: Connection, entries: Sequence[AuditEntry]) -> None:
    """Write entries; texts longer than their column are cut."""
    if entries:
        connection.execute(insert(audit), [_row(entry) for entry in entries])


def newest_entries(
    connection: Connection,
    limit: int,
    *,
    since: float | None = None,
    who: str | None = None,
    before: int | None = None,
) -> list[AuditEntry]:
    """Return the newest entries first: at or after ``since``, of ``who``, with an id below ``before``."""
    query = select(audit).order_by(audit.c.id.desc()).limit(limit)
    if since is not None:
        query = query.where(audit.c.at >= since)
    if who is not None:
        query = query.where(audit.c.who == who)
    if before is not None:
        query = query.where(audit.c.id < before)
    return [_entry(row) for row in connection.execute(query).mappings()]


def accounts_in_log(connection: Connection) -> list[str]:
    """Return the accounts in the log, sorted."""
    return sorted(connection.scalars(select(audit.c.who).distinct()))


def forget_entries(connection: Connection, before: float, limit: int) -> int:
    """Delete at most ``limit`` entries from before a time; return how many."""
    return len(delete_oldest(connection, audit.c.id, audit.c.at, before, limit))


def _row(entry: AuditEntry) -> dict[str, Any]:
    row = asdict(entry)
    del row["id"]
    for name, column in audit.c.items():
        longest = LONGEST_DETAIL if name == "detail" else getattr(column.type, "length", None)
        if longest is not None and isinstance(row.get(name), str):
            row[name] = _plain(row[name])[:longest]
    return {**row, "done": int(entry.done)}


def _plain(text: str) -> str:
    """Return ``text`` without characters that databases refuse: lone surrogates and NUL."""
    return text.encode("utf-8", "replace").decode("utf-8").replace("\0", "�")


def _entry(row: Any) -> AuditEntry:
    return AuditEntry(**{**row, "done": bool(row["done"])})


# --- The operators' sessions as stored in the database ---

SESSIONS_AT_ONCE = 500
"""sessions read in one statement."""
GATEWAY_ENDED = "the gateway ended"
"""End reason of sessions that a gateway left open; no user gives this reason."""


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


def begin_session(connection: Connection, session: SessionRow) -> None:
    """Write a new session."""
    connection.execute(insert(sessions).values(**asdict(session)))


def rename_session(connection: Connection, id: str, operator: str) -> None:
    """Record the name that a session gives."""
    connection.execute(update(sessions).where(sessions.c.id == id).values(operator=operator))


def end_session(connection: Connection, id: str, at: float, reason: str) -> SessionRow:
    """Record the end of a session; its gateway closes it. Raises AccessError when none is open.

    The session may also be named by the first digits of its id.
    """
    reason = f"{reason} (by hand)" if reason == GATEWAY_ENDED else reason
    query = select(sessions).where(
        sessions.c.ended_at.is_(None), sessions.c.id.startswith(id, autoescape=True)
    )
    found = connection.execute(query.limit(2)).mappings().all()
    if len(found) != 1 or not id:
        what = "is the beginning of several" if found and id else "is not open"
        raise AccessError(f"session {id!r} {what}; 'robot-bridge sessions list' shows those that are")
    note_session_end(connection, found[0]["id"], at, reason)
    return SessionRow(**found[0])


def note_session_end(connection: Connection, id: str, at: float, reason: str) -> None:
    """Record the end of a session, unless it was ended before."""
    open_one = (sessions.c.id == id) & sessions.c.ended_at.is_(None)
    connection.execute(update(sessions).where(open_one).values(ended_at=at, reason=reason))


def end_all_sessions(connection: Connection, at: float) -> None:
    """Record the end of sessions that an earlier gateway left open.

    Other gateways of a fleet still have theirs open, and record that: :func:`reopen_sessions`.
    """
    query = update(sessions).where(sessions.c.ended_at.is_(None))
    connection.execute(query.values(ended_at=at, reason=GATEWAY_ENDED))


def reopen_sessions(connection: Connection, open_here: Collection[str]) -> None:
    """Record that these sessions have not ended with another gateway."""
    ended = sessions.c.id.in_(sorted(open_here)) & (sessions.c.reason == GATEWAY_ENDED)
    connection.execute(update(sessions).where(ended).values(ended_at=None, reason=None))


def forget_ended_sessions(connection: Connection, before: float, limit: int) -> int:
    """Delete at most ``limit`` sessions that ended before a time; return how many."""
    return len(delete_oldest(connection, sessions.c.id, sessions.c.ended_at, before, limit))


# Built once: it runs several times a second, and each statement with a list is a reference cycle, freed only
# by Python's garbage collection. That is rare here.
_ENDED_OF = select(sessions.c.id, sessions.c.reason).where(
    sessions.c.id.in_(bindparam("ids", expanding=True)), sessions.c.ended_at.is_not(None)
)


def ended_sessions(connection: Connection, open_here: Collection[str]) -> dict[str, str]:
    """Return those of a gateway's open sessions that were ended, each with the reason."""
    found: dict[str, str] = {}
    still_open = sorted(open_here)
    for begin in range(0, len(still_open), SESSIONS_AT_ONCE):
        some = {"ids": still_open[begin : begin + SESSIONS_AT_ONCE]}
        found.update({id: reason or "" for id, reason in connection.execute(_ENDED_OF, some)})
    return found


def list_sessions(connection: Connection, *, everything: bool, limit: int) -> list[SessionRow]:
    """Return the sessions that are open, or ``everything``, newest first."""
    query = select(sessions).order_by(sessions.c.began_at.desc(), sessions.c.id).limit(limit)
    if not everything:
        query = query.where(sessions.c.ended_at.is_(None))
    return [SessionRow(**row) for row in connection.execute(query).mappings()]


# --- Audit entries written in the background ---

log = logging.getLogger(__name__)

Work = Callable[[Connection], None]

LARGEST_BACKLOG = 20_000
BATCH = 500
RETRY_AFTER = 1.0


class AuditJournal:
    """The audit log and the sessions of a running gateway.

    Entries are written within milliseconds, in their order. While the database is away they wait here, up to
    :data:`LARGEST_BACKLOG`; beyond that the oldest are lost, and their number is logged.
    """

    def __init__(self, database: Database, clock: Clock = SYSTEM_CLOCK) -> None:
        self._database = database
        self._clock = clock
        self._waiting: deque[Work] = deque()
        self._event = asyncio.Event()
        self._dropped = 0
        self._batch = BATCH
        self._news = TroubleNews()
        self._writing = asyncio.Lock()

    def note(
        self,
        who: str,
        action: str,
        *,
        done: bool = True,
        role: str | None = None,
        address: str | None = None,
        subject: str | None = None,
        detail: str | None = None,
    ) -> None:
        """Record that ``who`` did ``action``, or tried to."""
        entry = AuditEntry(self._clock.time(), who, action, done, role, address, subject, detail)
        self._put(lambda connection: add_entries(connection, [entry]))

    def began(self, session: SessionRow) -> None:
        """Record a session's beginning."""
        self._put(lambda connection: begin_session(connection, session))

    def renamed(self, id: str, operator: str) -> None:
        """Record the name that a session gives."""
        self._put(lambda connection: rename_session(connection, id, operator))

    def ended(self, id: str, reason: str) -> None:
        """Record a session's end."""
        at = self._clock.time()
        self._put(lambda connection: note_session_end(connection, id, at, reason))

    def used(self, token: str) -> None:
        """Record that a token opened a connection."""
        at = self._clock.time()
        self._put(lambda connection: accounts.note_use(connection, [(token, at)]))

    async def run(self) -> None:
        """Write entries until cancelled."""
        while True:
            try:
                await self._event.wait()
                self._event.clear()
                await self.flush()
                self._news.is_over("audit log")
            except StoreError as error:
                if self._news.has("audit log", str(error)):
                    log.error("%s; the audit log is written later", error)
                await asyncio.sleep(RETRY_AFTER)
                self._event.set()

    async def flush(self) -> None:
        """Write all waiting entries; raises StoreError when the database is away."""
        async with self._writing:
            while self._waiting:
                await self._write(min(self._batch, len(self._waiting)))
            if self._dropped:
                log.error("%d pieces of the audit log were lost", self._dropped)
                self._dropped = 0

    async def _write(self, count: int) -> None:
        batch = [self._waiting.popleft() for _ in range(count)]
        try:
            await self._database.run(_do_all, batch)
        except StoreError as error:
            if count == 1 and (await self._succeeds(batch) or await self._is_given_up(error)):
                return
            self._waiting.extendleft(reversed(batch))
            self._batch = max(1, count // 2)
            raise
        self._batch = min(BATCH, 2 * self._batch)

    async def _is_given_up(self, error: StoreError) -> bool:
        """Drop a refused entry, which must not block the later ones; record that it is missing.

        On a full disk it waits, though there may be room for a smaller one.
        """
        if not isinstance(error, DataRefusedError):
            return False
        gap = AuditEntry(
            self._clock.time(), "gateway", "audit", False, detail=f"an entry is missing here: {error}"
        )
        lost = await self._succeeds([lambda connection: add_entries(connection, [gap])])
        self._dropped += lost
        return lost

    async def _succeeds(self, batch: list[Work]) -> bool:
        try:
            await self._database.run(_do_all, batch)
        except StoreError:
            return False
        return True

    def _put(self, work: Work) -> None:
        self._waiting.append(work)
        if len(self._waiting) > LARGEST_BACKLOG:
            self._waiting.popleft()
            self._dropped += 1
        self._event.set()


def _do_all(connection: Connection, batch: list[Work]) -> None:
    for work in batch:
        work(connection)
