"""What supervisors ask about the other operators: who is connected, and who did what."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from .checks import MessageError, check_finite

LONGEST_REASON = 200
MOST_ENTRIES = 10_000


@dataclass(frozen=True)
class GetSessions:
    """Ask for the operators' open connections, newest first; with ``ended`` also for those that were."""

    method: ClassVar[str] = "get_sessions"
    ended: bool = False
    limit: int = 200

    def __post_init__(self) -> None:
        _check_limit(self.limit)


@dataclass(frozen=True)
class EndSession:
    """End an operator's connection, by its id or how that begins; the operator is told ``reason``."""

    method: ClassVar[str] = "end_session"
    session: str
    reason: str = "ended by a supervisor"

    def __post_init__(self) -> None:
        if len(self.reason) > LONGEST_REASON:
            raise MessageError(f"reason has {len(self.reason)} characters; give at most {LONGEST_REASON}")


@dataclass(frozen=True)
class GetAudit:
    """Ask who did what, newest first: since a time, by one account, before an entry's id."""

    method: ClassVar[str] = "get_audit"
    since: float | None = None
    who: str | None = None
    before: int | None = None
    limit: int = 200

    def __post_init__(self) -> None:
        check_finite(since=self.since)
        _check_limit(self.limit)
        if self.before is not None and not 0 <= self.before < 2**63:
            raise MessageError(f"before is {self.before}; give the id of an entry")


@dataclass(frozen=True)
class SessionReport:
    """One connection of an operator; ``address`` is where it comes from, times are seconds since 1970."""

    session: str
    operator: str
    role: str
    address: str
    began_at: float
    ended_at: float | None = None
    reason: str | None = None


@dataclass(frozen=True)
class AuditReport:
    """One thing that somebody did, or was refused (``done`` is false)."""

    id: int
    at: float
    who: str
    action: str
    done: bool
    role: str | None = None
    address: str | None = None
    subject: str | None = None
    detail: str | None = None


def _check_limit(limit: int) -> None:
    if not 1 <= limit <= MOST_ENTRIES:
        raise MessageError(f"limit is {limit}; give a number from 1 to {MOST_ENTRIES}")
