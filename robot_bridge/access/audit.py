"""The audit log: who did what, from where, and whether it was done."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, dataclass
from typing import Any

from sqlalchemy import Connection, insert, select

from ..store.ageing import delete_oldest
from ..store.schema import audit

LONGEST_DETAIL = 2000


@dataclass(frozen=True)
class Entry:
    """One thing that somebody did or tried: ``at`` is seconds since 1970, ``done`` false when refused."""

    at: float
    who: str
    action: str
    done: bool
    role: str | None = None
    address: str | None = None
    subject: str | None = None
    detail: str | None = None
    id: int | None = None


def add(connection: Connection, entries: Sequence[Entry]) -> None:
    """Write entries; what is longer than its column is cut."""
    if entries:
        connection.execute(insert(audit), [_row(entry) for entry in entries])


def newest(
    connection: Connection,
    limit: int,
    *,
    since: float | None = None,
    who: str | None = None,
    before: int | None = None,
) -> list[Entry]:
    """Return the newest entries first: at or after ``since``, of ``who``, with an id below ``before``."""
    query = select(audit).order_by(audit.c.id.desc()).limit(limit)
    if since is not None:
        query = query.where(audit.c.at >= since)
    if who is not None:
        query = query.where(audit.c.who == who)
    if before is not None:
        query = query.where(audit.c.id < before)
    return [_entry(row) for row in connection.execute(query).mappings()]


def accounts(connection: Connection) -> list[str]:
    """Return who stands in the log, sorted."""
    return sorted(connection.scalars(select(audit.c.who).distinct()))


def forget(connection: Connection, before: float, limit: int) -> int:
    """Delete at most ``limit`` entries from before a time; return how many."""
    return len(delete_oldest(connection, audit.c.id, audit.c.at, before, limit))


def _row(entry: Entry) -> dict[str, Any]:
    row = asdict(entry)
    del row["id"]
    for name, column in audit.c.items():
        longest = LONGEST_DETAIL if name == "detail" else getattr(column.type, "length", None)
        if longest is not None and isinstance(row.get(name), str):
            row[name] = _plain(row[name])[:longest]
    return {**row, "done": int(entry.done)}


def _plain(text: str) -> str:
    """Return ``text`` without what a database would refuse: lone surrogates and NUL."""
    return text.encode("utf-8", "replace").decode("utf-8").replace("\0", "�")


def _entry(row: Any) -> Entry:
    return Entry(**{**row, "done": bool(row["done"])})
