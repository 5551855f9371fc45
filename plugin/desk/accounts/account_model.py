"""Operators' accounts as rows of a table."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from datetime import datetime

from qgis.PyQt.QtCore import QObject

from ....robot_bridge.messages import OperatorReport, SessionReport, TokenState
from ...language import tr
from ...wire.role_words import ROLES
from ..row_model import TextModel

COLUMNS = (tr("Operator"), tr("Role"), tr("Since"), tr("Last connected"), tr("Token"))
NOW = tr("connected now")


@dataclass(frozen=True)
class Account:
    """An account; ``is_own`` when this desk is connected with it, ``is_connected`` when any desk is."""

    report: OperatorReport
    is_own: bool = False
    is_connected: bool = False

    @property
    def name(self) -> str:
        return self.report.operator


def accounts_of(
    operators: Iterable[OperatorReport], sessions: Iterable[SessionReport], own: str
) -> list[Account]:
    """Return the accounts in the order in which they are given; ``own`` is this desk's."""
    connected = {session.operator for session in sessions}
    return [Account(one, one.operator == own, one.operator in connected) for one in operators]


class AccountModel(TextModel):
    """One row for each account."""

    def __init__(self, parent: QObject | None = None):
        super().__init__(COLUMNS, cells, parent)


def cells(account: Account) -> tuple[str, ...]:
    """Return what the columns show of an account."""
    report = account.report
    name = tr("{operator} (you)", operator=report.operator) if account.is_own else report.operator
    seen = NOW if account.is_connected else day_and_time(report.used_at)
    return name, ROLES[report.role], day_and_time(report.created_at), seen, token_in_words(report)


def token_in_words(report: OperatorReport) -> str:
    """Return how an account's newest token stands."""
    if report.token is TokenState.REVOKED:
        return tr("revoked {time}", time=day_and_time(report.revoked_at))
    if report.token is TokenState.EXPIRED:
        return tr("expired {time}", time=day_and_time(report.expires_at))
    if report.token is TokenState.NONE:
        return tr("none")
    return until_in_words(report.expires_at)


def until_in_words(expires_at: float | None) -> str:
    """Return how long a token holds."""
    if expires_at is None:
        return tr("holds")
    return tr("holds until {time}", time=day_and_time(expires_at))


def day_and_time(at: float | None) -> str:
    """Return a time since 1970 in the computer's time zone, to the minute; a dash for none."""
    return "–" if at is None else datetime.fromtimestamp(at).strftime("%Y-%m-%d %H:%M")
