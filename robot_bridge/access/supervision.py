"""Answers what supervisors ask about the other operators."""

from __future__ import annotations

import time
from typing import Any

from ..messages import AuditReport, EndSession, GetAudit, GetSessions, SessionReport, to_json
from ..store.database import Database
from . import audit, session_rows
from .session_rows import SessionRow


async def get_sessions(database: Database, request: GetSessions) -> dict[str, Any]:
    """Return the operators' connections."""
    found = await database.run(_listed, request.ended, request.limit)
    return {"sessions": [to_json(_report(session)) for session in found]}


async def end_session(database: Database, request: EndSession, operator: str) -> dict[str, Any]:
    """End a connection and return what was known of it; raises AccessError when it is not open."""
    now, reason = time.time(), f"{request.reason} ({operator})"
    ended = await database.run(session_rows.end, request.session, now, reason)
    return to_json(_report(ended))


async def get_audit(database: Database, request: GetAudit) -> dict[str, Any]:
    """Return who did what."""
    found = await database.run(_entries, request)
    return {"entries": [to_json(AuditReport(**vars(entry))) for entry in found]}


def _listed(connection: Any, ended: bool, limit: int) -> list[SessionRow]:
    return session_rows.listed(connection, everything=ended, limit=limit)


def _entries(connection: Any, request: GetAudit) -> list[audit.Entry]:
    return audit.newest(
        connection, request.limit, since=request.since, who=request.who, before=request.before
    )


def _report(row: SessionRow) -> SessionReport:
    return SessionReport(row.id, row.operator, row.role, row.address, row.began_at, row.ended_at, row.reason)
