"""Requests of supervisors: operators' accounts, sessions and the audit log."""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import Any, TypeVar

from sqlalchemy import Connection

from ...core.messages import (
    AddOperator,
    AuditReport,
    EndSession,
    GetAudit,
    GetSessions,
    NewToken,
    OperatorReport,
    Operators,
    RevokeToken,
    RotateToken,
    SessionReport,
    SetRole,
    TokenState,
    to_json,
)
from ...protocol.credentials import AccessError
from ..storage.database import Database
from . import accounts, audit
from .accounts import Grant, Operator
from .audit import SessionRow

# --- Does what supervisors ask about operators' accounts at the desk, as the command line does it ---
# Nobody can lock everybody out from here: what would leave no supervisor with a token that holds is
# refused.

T = TypeVar("T")


async def get_operators(database: Database) -> dict[str, Any]:
    """Return every account."""
    now = time.time()
    found = await database.read(accounts.all_operators)
    return to_json(Operators([_operator_report(operator, now) for operator in found]))


async def add_operator(database: Database, request: AddOperator) -> dict[str, Any]:
    """Make an account and return its token; raises AccessError for a name that is taken or cannot be one."""
    return await _new_token(database, request, accounts.add_operator, request.role)


async def rotate_token(database: Database, request: RotateToken) -> dict[str, Any]:
    """Return a new token in place of those before; raises AccessError for an operator who is not known."""
    return await _new_token(database, request, accounts.rotate_operator)


async def revoke_token(database: Database, request: RevokeToken) -> dict[str, Any]:
    """Take an operator's token away; raises AccessError when unknown, or the last supervisor."""
    now = time.time()
    return await _changed(database, request.operator, now, accounts.revoke_operator, now)


async def set_role(database: Database, request: SetRole) -> dict[str, Any]:
    """Give an operator another role; raises AccessError when unknown, or the last supervisor."""
    return await _changed(database, request.operator, time.time(), accounts.set_role, request.role)


async def _new_token(
    database: Database, request: AddOperator | RotateToken, make: Callable[..., str], *arguments: Any
) -> dict[str, Any]:
    now = time.time()
    expires_at = None if request.expires_in is None else now + request.expires_in

    def make_it(connection: Connection) -> tuple[str, Operator]:
        token = make(connection, request.operator, *arguments, now, expires_at)
        return token, accounts.find_operator(connection, request.operator)

    token, operator = await database.run(_with_supervisor, now, make_it)
    return to_json(NewToken(operator.name, operator.role, token, expires_at))


async def _changed(
    database: Database, name: str, now: float, change: Callable[..., object], *arguments: Any
) -> dict[str, Any]:
    def change_it(connection: Connection) -> Operator:
        change(connection, name, *arguments)
        return accounts.find_operator(connection, name)

    return to_json(_operator_report(await database.run(_with_supervisor, now, change_it), now))


def _with_supervisor(connection: Connection, now: float, work: Callable[[Connection], T]) -> T:
    """Return what ``work`` does; raises AccessError, and undoes it, when it leaves no supervisor."""
    result = work(connection)
    if not accounts.has_supervisor(connection, now):
        raise AccessError(
            "that would leave no supervisor with a token that holds, and nobody at any desk could change it "
            "again; make another supervisor first, or do it with 'robot-bridge operators' on the gateway's "
            "computer"
        )
    return result


def _operator_report(operator: Operator, now: float) -> OperatorReport:
    token = operator.token
    if token is None:
        return OperatorReport(operator.name, operator.role, operator.created_at, TokenState.NONE)
    return OperatorReport(
        operator.name,
        operator.role,
        operator.created_at,
        _state(token, now),
        expires_at=token.expires_at,
        revoked_at=token.revoked_at,
        used_at=token.used_at,
    )


def _state(token: Grant, now: float) -> TokenState:
    if token.revoked_at is not None:
        return TokenState.REVOKED
    return TokenState.VALID if token.fault(now) is None else TokenState.EXPIRED


# --- Answers what supervisors ask about the other operators ---


async def get_sessions(database: Database, request: GetSessions) -> dict[str, Any]:
    """Return the operators' connections."""
    found = await database.run(_listed, request.ended, request.limit)
    return {"sessions": [to_json(_session_report(session)) for session in found]}


async def end_session(database: Database, request: EndSession, operator: str) -> dict[str, Any]:
    """End a connection and return what was known of it; raises AccessError when it is not open."""
    now, reason = time.time(), f"{request.reason} ({operator})"
    ended = await database.run(audit.end_session, request.session, now, reason)
    return to_json(_session_report(ended))


async def get_audit(database: Database, request: GetAudit) -> dict[str, Any]:
    """Return who did what."""
    found = await database.run(_entries, request)
    return {"entries": [to_json(AuditReport(**vars(entry))) for entry in found]}


def _listed(connection: Any, ended: bool, limit: int) -> list[SessionRow]:
    return audit.list_sessions(connection, everything=ended, limit=limit)


def _entries(connection: Any, request: GetAudit) -> list[audit.AuditEntry]:
    return audit.newest_entries(
        connection, request.limit, since=request.since, who=request.who, before=request.before
    )


def _session_report(row: SessionRow) -> SessionReport:
    return SessionReport(row.id, row.operator, row.role, row.address, row.began_at, row.ended_at, row.reason)
