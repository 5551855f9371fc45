"""Dialog of operators' accounts, its model and its forms."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import Any

from qgis.gui import QgisInterface
from qgis.PyQt.QtCore import QObject, Qt, pyqtSignal
from qgis.PyQt.QtWidgets import QComboBox, QLineEdit, QMessageBox, QWidget

from ...robot_bridge.core.messages import administration
from ...robot_bridge.core.messages.administration import new_token, open_session, operators_report
from ...robot_bridge.core.messages.base import Role
from ..control.fleet_controller import FleetController
from ..gateway_client.connection_status import ROLES
from ..help import ACCOUNTS
from ..panel.connection_panel import ConnectionMenu
from ..ui.dialogs import QuestionDialog, confirm
from ..ui.language import tr, tr_count
from ..ui.tables import TextModel
from .supervisor_dialog import DialogAction, SupervisorDialog, fit_columns
from .token_dialog import TokenDialog, day_and_time, until_in_words

COLUMNS = (tr("Operator"), tr("Role"), tr("Since"), tr("Last connected"), tr("Token"))
NOW = tr("connected now")


@dataclass(frozen=True)
class Account:
    """An account; ``is_own`` when this desk is connected with it, ``is_connected`` when any desk is."""

    report: administration.OperatorReport
    is_own: bool = False
    is_connected: bool = False

    @property
    def name(self) -> str:
        return self.report.operator


def read_accounts(
    operators: Iterable[administration.OperatorReport],
    sessions: Iterable[administration.SessionReport],
    own: str,
) -> list[Account]:
    """Return the accounts in the order given; ``own`` is this desk's."""
    connected = {session.operator for session in sessions}
    return [Account(one, one.operator == own, one.operator in connected) for one in operators]


class AccountModel(TextModel):
    """One row for each account."""

    def __init__(self, parent: QObject | None = None):
        super().__init__(COLUMNS, account_cells, parent)


def account_cells(account: Account) -> tuple[str, ...]:
    """Return the texts of an account in the columns."""
    report = account.report
    name = tr("{operator} (you)", operator=report.operator) if account.is_own else report.operator
    seen = NOW if account.is_connected else day_and_time(report.used_at)
    return name, ROLES[report.role], day_and_time(report.created_at), seen, token_in_words(report)


def token_in_words(report: administration.OperatorReport) -> str:
    """Return the state of an account's newest token."""
    if report.token is administration.TokenState.REVOKED:
        return tr("revoked {time}", time=day_and_time(report.revoked_at))
    if report.token is administration.TokenState.EXPIRED:
        return tr("expired {time}", time=day_and_time(report.expires_at))
    if report.token is administration.TokenState.NONE:
        return tr("none")
    return until_in_words(report.expires_at)


DAY = 86_400.0
VALIDITIES = (
    (tr("until it is revoked"), None),
    (tr("for 1 day"), DAY),
    (tr("for 7 days"), 7 * DAY),
    (tr("for 30 days"), 30 * DAY),
    (tr("for 90 days"), 90 * DAY),
    (tr("for 1 year"), 365 * DAY),
)
"""Validity of a token; seconds, None for no end."""
LONGEST_NAME = 128
"""Characters of an operator's name that gateways accept."""


class NewAccountDialog(QuestionDialog):
    """``confirmed`` has the name, the role and the validity of the token in seconds, None for no end."""

    confirmed = pyqtSignal(str, object, object)

    def __init__(self, is_first: bool, parent: QWidget):
        text = tr("The gateway makes a token for the account. It is shown once, to be handed over.")
        if is_first:
            text = tr(
                "This gateway has no accounts yet: everybody on its computer may do everything. The first "
                "account ends that for good, and this connection too: connect again with its token. It "
                "has to be a supervisor's."
            )
        super().__init__(
            "fleet_new_account",
            tr("New account"),
            ("fleet_new_account_confirm", tr("Make account")),
            is_safe=False,
            parent=parent,
        )
        self.add_text(text)
        self._name = QLineEdit()
        self._name.setMaxLength(LONGEST_NAME)
        self.add_field(tr("&Name"), self._name, "fleet_account_name")
        self._role = _add_role(self, Role.SUPERVISOR if is_first else Role.VIEWER)
        self._validity = _add_validity(self)
        self.lay_out()
        self._name.textChanged.connect(self._named)
        self._named()
        self.accepted.connect(
            lambda: self.confirmed.emit(
                self._name.text().strip(), _chosen(self._role), self._validity.currentData()
            )
        )

    def _named(self) -> None:
        self.confirm.setEnabled(bool(self._name.text().strip()))


class ChangeRoleDialog(QuestionDialog):
    """``confirmed`` has the role that was chosen."""

    confirmed = pyqtSignal(object)

    def __init__(self, account: Account, parent: QWidget):
        text = tr(
            "{operator} is {role}. Another role holds from the next thing on that is asked for, also over "
            "connections that are open.",
            operator=account.name,
            role=ROLES[account.report.role],
        )
        warning = tr("This is your own account: without being a supervisor you cannot undo it.")
        super().__init__(
            "fleet_another_role",
            tr("Role of {operator}", operator=account.name),
            ("fleet_another_role_confirm", tr("Change role")),
            is_safe=account.is_own,
            parent=parent,
        )
        self.add_text(text)
        self.add_text(warning if account.is_own else "")
        self._role = _add_role(self, account.report.role)
        self.lay_out()
        self.accepted.connect(lambda: self.confirmed.emit(_chosen(self._role)))


class RenewTokenDialog(QuestionDialog):
    """``confirmed`` has the validity of the new token in seconds, None for no end."""

    confirmed = pyqtSignal(object)

    def __init__(self, account: Account, parent: QWidget):
        text = tr(
            "{operator} gets a new token. The one before ends at once, with every connection that it opened.",
            operator=account.name,
        )
        warning = tr("This is your own account: this desk is cut off until you enter the new token.")
        super().__init__(
            "fleet_another_token",
            tr("New token for {operator}", operator=account.name),
            ("fleet_another_token_confirm", tr("Make token")),
            is_safe=True,
            parent=parent,
        )
        self.add_text(text)
        self.add_text(warning if account.is_own else "")
        self._validity = _add_validity(self)
        self.lay_out()
        self.accepted.connect(lambda: self.confirmed.emit(self._validity.currentData()))


def confirm_revocation(account: Account, parent: QWidget, then: Callable[[], object]) -> QMessageBox:
    """Ask whether to revoke an operator's token; ``then`` is called when confirmed."""
    texts = [
        tr(
            "The token of {operator} ends at once, with every connection that it opened. The account "
            "stays, and a new token can be made for it. Robots go on with what they were told.",
            operator=account.name,
        )
    ]
    if account.is_own:
        texts.append(tr("This is your own account: this desk is cut off and does not come back by itself."))
    yes = ("fleet_revocation_confirm", tr("Revoke"))
    box = confirm(parent, "fleet_revocation", "\n\n".join(texts), yes, tr("Cancel"), then)
    box.setWindowTitle(tr("Revoke the token of {operator}?", operator=account.name))
    box.setTextFormat(Qt.TextFormat.PlainText)
    return box


def _add_role(question: QuestionDialog, chosen: Role) -> QComboBox:
    choices = ((words, role) for role, words in ROLES.items())
    box = question.add_choice(tr("&Role"), choices, "fleet_account_role")
    box.setCurrentText(ROLES[chosen])
    return box


def _chosen(roles: QComboBox) -> Role:
    # Qt keeps text that is an enum, too, as plain text.
    return Role(roles.currentData())


def _add_validity(question: QuestionDialog) -> QComboBox:
    return question.add_choice(tr("&Token holds"), VALIDITIES, "fleet_account_validity")


LIST = tr("Accounts")
WIDEST = (
    tr("{operator} (you)", operator="00000000000"),
    max(ROLES.values(), key=len),
    "2026-00-00 00:00",
    "2026-00-00 00:00",
    tr("holds until {time}", time="2026-00-00 00:00"),
)


class AccountsDialog(SupervisorDialog):
    """A row for each account. A token made by the gateway is shown even when this is closed by then."""

    def __init__(self, desk: FleetController, parent: QWidget):
        super().__init__(desk, AccountModel(), "fleet_accounts_dialog", tr("Accounts"), ACCOUNTS, parent)
        self._sessions: list[administration.SessionReport] = []
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
        """Close the windows that show tokens: nobody will be there to do it."""
        for shown in list(self._tokens):
            shown.reject()

    # --- List ---

    def _ask_rows(self) -> None:
        self._has_none = False
        # First: the accounts are shown with who is connected.
        self._listing.ask(administration.GetSessions(), LIST, self._receive_sessions)
        self._listing.ask(administration.GetOperators(), LIST, self._receive_operators)

    def _key(self, row: Account) -> str:
        return row.name

    def _receive_sessions(self, result: dict[str, Any]) -> None:
        self._sessions = [open_session(one) for one in result["sessions"]]

    def _receive_operators(self, result: dict[str, Any]) -> None:
        self._show(operators_report(result))

    def _show(self, found: administration.Operators) -> None:
        self._show_rows(read_accounts(found.operators, self._sessions, self._desk.state.link.operator))
        self._has_none = not found.operators
        if found.operators:
            self._show_once_known(tr_count(len(found.operators), "1 account", "%n accounts"))
        else:
            self._show_once_known(
                tr(
                    "This gateway has no accounts: everybody on its computer may do everything. The first "
                    "account, a supervisor's, ends that."
                )
            )

    # --- Actions of a supervisor ---

    def _add(self) -> None:
        is_first = self._has_none
        question = NewAccountDialog(is_first, self)
        question.confirmed.connect(
            lambda name, role, seconds: self._ask_for_token(
                administration.AddOperator(name, role, seconds),
                tr("New account {operator}", operator=name),
                is_first,
            )
        )
        self._open(question)

    def _make_token(self) -> None:
        account = self.selected()
        question = RenewTokenDialog(account, self)
        question.confirmed.connect(
            lambda seconds: self._ask_for_token(
                administration.RotateToken(account.name, seconds),
                tr("New token for {operator}", operator=account.name),
                account.is_own,
            )
        )
        self._open(question)

    def _change_role(self) -> None:
        account = self.selected()
        question = ChangeRoleDialog(account, self)
        question.confirmed.connect(lambda role: self._ask_for_role(account, role))
        self._open(question)

    def _revoke(self) -> None:
        account = self.selected()
        self._open(confirm_revocation(account, self, lambda: self._ask_for_revocation(account)))

    def _ask_for_revocation(self, account: Account) -> None:
        self._ask_for_change(
            administration.RevokeToken(account.name),
            tr("Revoke {operator}", operator=account.name),
            tr("The token of {operator} is revoked.", operator=account.name),
        )

    def _ask_for_role(self, account: Account, role: Role) -> None:
        self._ask_for_change(
            administration.SetRole(account.name, role),
            tr("Role of {operator}", operator=account.name),
            tr("{operator} is {role} now.", operator=account.name, role=ROLES[role]),
        )

    def _ask_for_change(self, request: Any, words: str, done: str) -> None:
        self._ask(request, words, lambda _result: self._changed(done))

    def _ask_for_token(
        self, request: administration.AddOperator | administration.RotateToken, words: str, ends_link: bool
    ) -> None:
        self._ask(request, words, lambda result: self._show_token(result, ends_link))

    def _show_token(self, result: dict[str, Any], ends_link: bool) -> None:
        # With the QGIS window as parent and not this one: it must not close when this is closed.
        made, parent = new_token(result), self.parentWidget()
        dialog = TokenDialog(made, self._desk.state.url, ends_link=ends_link, parent=parent)
        self._tokens.append(dialog)
        dialog.finished.connect(lambda: self._tokens.remove(dialog))
        dialog.show()
        dialog.raise_()
        self._changed(tr("The token of {operator} is made.", operator=result["operator"]))


class AccountsAction(DialogAction):
    """The menu entry and its window."""

    def __init__(self, iface: QgisInterface, menu: str, connections: ConnectionMenu, desk: FleetController):
        super().__init__(
            iface,
            menu,
            connections,
            lambda: AccountsDialog(desk, iface.mainWindow()),
            icon="accounts.svg",
            text=tr("Accounts…"),
            name="fleet_accounts",
            tip=tr("Who may connect to the gateway and do what; takes a supervisor"),
        )

    def remove(self) -> None:
        if self.dialog is not None:
            self.dialog.close_tokens()
        super().remove()
