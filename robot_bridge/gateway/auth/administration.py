"""Requests of supervisors: operators' accounts, sessions and the audit log."""

from __future__ import annotations

import time
from collections.abc import Callable
from contextlib import suppress
from typing import Any, TypeVar

from sqlalchemy import Connection

from ...core.errors import AccessError, StoreError
from ...core.messages import administration
from ..model.events import handles
from ..storage.database import Database
from . import accounts, audit
from .accounts import Grant, Operator
from .audit import AuditJournal, SessionRow

# --- Supervisors' requests on operators' accounts at the desk, handled as on the command line ---
# Nobody can lock everybody out: requests that would leave no supervisor with a valid token are refused.

T = TypeVar("T")


class AccountAdministration:
    """Operators' accounts, sessions and the audit log, read and changed by supervisors."""

    def __init__(self, database: Database, journal: AuditJournal) -> None:
        self._database = database
        self._journal = journal

    @handles(administration.GetOperators)
    async def operators(self) -> administration.Operators:
        """Return every account."""
        now = time.time()
        found = await self._database.read(accounts.all_operators)
        return administration.Operators([_operator_report(operator, now) for operator in found])

    @handles(administration.AddOperator)
    async def add(self, request: administration.AddOperator) -> administration.NewToken:
        """Create an account and return its token; raises AccessError for a taken or invalid name."""
        return await self._new_token(request, accounts.add_operator, request.role)

    @handles(administration.RotateToken)
    async def rotate(self, request: administration.RotateToken) -> administration.NewToken:
        """Return a new token that replaces the old ones; raises AccessError for an unknown operator."""
        return await self._new_token(request, accounts.rotate_operator)

    @handles(administration.RevokeToken)
    async def revoke(self, request: administration.RevokeToken) -> administration.OperatorReport:
        """Revoke an operator's token; raises AccessError when unknown, or the last supervisor."""
        now = time.time()
        return await self._changed(request.operator, now, accounts.revoke_operator, now)

    @handles(administration.SetRole)
    async def set_role(self, request: administration.SetRole) -> administration.OperatorReport:
        """Give an operator another role; raises AccessError when unknown, or the last supervisor."""
        return await self._changed(request.operator, time.time(), accounts.set_role, request.role)

    @handles(administration.GetSessions)
    async def sessions(self, request: administration.GetSessions) -> administration.Sessions:
        """Return the operators' connections."""
        await self._write_noted()
        found = await self._database.run(_listed, request.ended, request.limit)
        return administration.Sessions([_session_report(session) for session in found])

    @handles(administration.EndSession)
    async def end_session(
        self, request: administration.EndSession, operator: str
    ) -> administration.SessionReport:
        """End a connection and return its data; raises AccessError when it is not open."""
        now, reason = time.time(), f"{request.reason} ({operator})"
        return _session_report(await self._database.run(audit.end_session, request.session, now, reason))

    @handles(administration.GetAudit)
    async def audit_log(self, request: administration.GetAudit) -> administration.Audit:
        """Return the audit log up to now."""
        await self._write_noted()
        found = await self._database.run(_entries, request)
        return administration.Audit([administration.AuditReport(**vars(entry)) for entry in found])

    async def _write_noted(self) -> None:
        # Entries not written yet must not prevent reading the others.
        with suppress(StoreError):
            await self._journal.flush()

    async def _new_token(
        self,
        request: administration.AddOperator | administration.RotateToken,
        make: Callable[..., str],
        *arguments: Any,
    ) -> administration.NewToken:
        now = time.time()
        expires_at = None if request.expires_in is None else now + request.expires_in

        def make_it(connection: Connection) -> tuple[str, Operator]:
            token = make(connection, request.operator, *arguments, now, expires_at)
            return token, accounts.find_operator(connection, request.operator)

        token, operator = await self._database.run(_with_supervisor, now, make_it)
        return administration.NewToken(operator.name, operator.role, token, expires_at)

    async def _changed(
        self, name: str, now: float, change: Callable[..., object], *arguments: Any
    ) -> administration.OperatorReport:
        def change_it(connection: Connection) -> Operator:
            change(connection, name, *arguments)
            return accounts.find_operator(connection, name)

        return _operator_report(await self._database.run(_with_supervisor, now, change_it), now)


def _with_supervisor(connection: Connection, now: float, work: Callable[[Connection], T]) -> T:
    """Return the result of ``work``; undoes it and raises AccessError when it leaves no supervisor."""
    result = work(connection)
    if not accounts.has_supervisor(connection, now):
        raise AccessError(
            "that would leave no supervisor with a token that holds, and nobody at any desk could change it "
            "again; make another supervisor first, or do it with 'robot-bridge operators' on the gateway's "
            "computer"
        )
    return result


def _operator_report(operator: Operator, now: float) -> administration.OperatorReport:
    token = operator.token
    if token is None:
        return administration.OperatorReport(
            operator.name, operator.role, operator.created_at, administration.TokenState.NONE
        )
    return administration.OperatorReport(
        operator.name,
        operator.role,
        operator.created_at,
        _state(token, now),
        expires_at=token.expires_at,
        revoked_at=token.revoked_at,
        used_at=token.used_at,
    )


def _state(token: Grant, now: float) -> administration.TokenState:
    if token.revoked_at is not None:
        return administration.TokenState.REVOKED
    return administration.TokenState.VALID if token.fault(now) is None else administration.TokenState.EXPIRED


def _listed(connection: Any, ended: bool, limit: int) -> list[SessionRow]:
    return audit.list_sessions(connection, everything=ended, limit=limit)


def _entries(connection: Any, request: administration.GetAudit) -> list[audit.AuditEntry]:
    return audit.newest_entries(
        connection, request.limit, since=request.since, who=request.who, before=request.before
    )


def _session_report(row: SessionRow) -> administration.SessionReport:
    return administration.SessionReport(
        row.id, row.operator, row.role, row.address, row.began_at, row.ended_at, row.reason
    )
