"""The operators' accounts of the gateway: who has one, made and changed by a supervisor."""

from __future__ import annotations

from typing import Any

from qgis.PyQt.QtWidgets import QWidget

from ....robot_bridge.messages import (
    AddOperator,
    GetOperators,
    GetSessions,
    Operators,
    RevokeToken,
    Role,
    RotateToken,
    SessionReport,
    SetRole,
    new_token,
    open_session,
    operators_report,
)
from ...help.topics import ACCOUNTS
from ...language import tr, tr_count
from ...wire.role_words import ROLES
from ..desk import Desk
from ..supervisor_dialog import SupervisorDialog, fit_columns
from .account_model import Account, AccountModel, accounts_of
from .questions import AnotherRole, AnotherToken, NewAccount, revocation
from .token_dialog import TokenDialog

LIST = tr("Accounts")
WIDEST = (
    tr("{operator} (you)", operator="00000000000"),
    max(ROLES.values(), key=len),
    "2026-00-00 00:00",
    "2026-00-00 00:00",
    tr("holds until {time}", time="2026-00-00 00:00"),
)


class AccountsDialog(SupervisorDialog):
    """A row for each account. A token that the gateway makes is shown even when this is closed by then."""

    def __init__(self, desk: Desk, parent: QWidget):
        super().__init__(desk, AccountModel(), "fleet_accounts_dialog", tr("Accounts"), ACCOUNTS, parent)
        self._sessions: list[SessionReport] = []
        self._tokens: list[TokenDialog] = []
        self._has_none = False
        for name, text, press, for_row in (
            ("fleet_account_add", tr("&Add…"), self._add, False),
            ("fleet_account_set_role", tr("Change &role…"), self._change_role, True),
            ("fleet_account_rotate", tr("New &token…"), self._make_token, True),
            ("fleet_account_revoke", tr("Re&voke…"), self._revoke, True),
            ("fleet_accounts_refresh", tr("Re&fresh"), self.refresh, False),
        ):
            self._button(name, text, press, for_row=for_row)
        fit_columns(self.view, WIDEST)
        self._lay_out()

    def close_tokens(self) -> None:
        """Close what shows tokens: nobody will be there to do it."""
        for shown in list(self._tokens):
            shown.reject()

    # --- the list ---

    def _ask_rows(self) -> None:
        self._has_none = False
        # First: the accounts are shown with who is connected.
        self._listing.ask(GetSessions(), LIST, self._take_sessions)
        self._listing.ask(GetOperators(), LIST, self._take_operators)

    def _key(self, row: Account) -> str:
        return row.name

    def _take_sessions(self, result: dict[str, Any]) -> None:
        self._sessions = [open_session(one) for one in result["sessions"]]

    def _take_operators(self, result: dict[str, Any]) -> None:
        self._show(operators_report(result))

    def _show(self, found: Operators) -> None:
        self._show_rows(accounts_of(found.operators, self._sessions, self._desk.link.operator))
        self._has_none = not found.operators
        if found.operators:
            self._say_once_known(tr_count(len(found.operators), "1 account", "%n accounts"))
        else:
            self._say_once_known(
                tr(
                    "This gateway has no accounts: everybody on its computer may do everything. The first "
                    "account, a supervisor's, ends that."
                )
            )

    # --- what a supervisor does ---

    def _add(self) -> None:
        is_first = self._has_none
        question = NewAccount(is_first, self)
        question.confirmed.connect(
            lambda name, role, seconds: self._ask_for_token(
                AddOperator(name, role, seconds), tr("New account {operator}", operator=name), is_first
            )
        )
        self._open(question)

    def _make_token(self) -> None:
        account = self.selected()
        question = AnotherToken(account, self)
        question.confirmed.connect(
            lambda seconds: self._ask_for_token(
                RotateToken(account.name, seconds),
                tr("New token for {operator}", operator=account.name),
                account.is_own,
            )
        )
        self._open(question)

    def _change_role(self) -> None:
        account = self.selected()
        question = AnotherRole(account, self)
        question.confirmed.connect(lambda role: self._ask_for_role(account, role))
        self._open(question)

    def _revoke(self) -> None:
        account = self.selected()
        self._open(revocation(account, self, lambda: self._ask_for_revocation(account)))

    def _ask_for_revocation(self, account: Account) -> None:
        self._ask_for_change(
            RevokeToken(account.name),
            tr("Revoke {operator}", operator=account.name),
            tr("The token of {operator} is revoked.", operator=account.name),
        )

    def _ask_for_role(self, account: Account, role: Role) -> None:
        self._ask_for_change(
            SetRole(account.name, role),
            tr("Role of {operator}", operator=account.name),
            tr("{operator} is {role} now.", operator=account.name, role=ROLES[role]),
        )

    def _ask_for_change(self, request: Any, words: str, done: str) -> None:
        self._ask(request, words, lambda _result: self._changed(done))

    def _ask_for_token(self, request: AddOperator | RotateToken, words: str, ends_link: bool) -> None:
        self._ask(request, words, lambda result: self._show_token(result, ends_link))

    def _show_token(self, result: dict[str, Any], ends_link: bool) -> None:
        # Beside the QGIS window and not this one: it must not go when this is closed.
        dialog = TokenDialog(new_token(result), ends_link=ends_link, parent=self.parentWidget())
        self._tokens.append(dialog)
        dialog.finished.connect(lambda: self._tokens.remove(dialog))
        dialog.show()
        dialog.raise_()
        self._changed(tr("The token of {operator} is made.", operator=result["operator"]))
