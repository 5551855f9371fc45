"""What is asked before an account is made or changed. None of these does anything by itself."""

from __future__ import annotations

from collections.abc import Callable

from qgis.PyQt.QtCore import Qt, pyqtSignal
from qgis.PyQt.QtWidgets import QComboBox, QLineEdit, QMessageBox, QWidget

from ....robot_bridge.messages import Role
from ...language import tr
from ...wire.role_words import ROLES
from ..question_dialog import QuestionDialog
from ..safe_question import safe_question
from .account_model import Account

DAY = 86_400.0
VALIDITIES = (
    (tr("until it is revoked"), None),
    (tr("for 1 day"), DAY),
    (tr("for 7 days"), 7 * DAY),
    (tr("for 30 days"), 30 * DAY),
    (tr("for 90 days"), 90 * DAY),
    (tr("for 1 year"), 365 * DAY),
)
"""How long a token may hold; seconds, None for no end."""
LONGEST_NAME = 128
"""Characters of an operator's name that gateways take."""


class NewAccount(QuestionDialog):
    """``confirmed`` has the name, the role and for how many seconds the token holds, None for no end."""

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


class AnotherRole(QuestionDialog):
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


class AnotherToken(QuestionDialog):
    """``confirmed`` has for how many seconds the new token holds, None for no end."""

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


def revocation(account: Account, parent: QWidget, then: Callable[[], object]) -> QMessageBox:
    """Ask whether an operator's token is to be taken away; ``then`` is done when it is."""
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
    box = safe_question(parent, "fleet_revocation", "\n\n".join(texts), yes, tr("Cancel"), then)
    box.setWindowTitle(tr("Revoke the token of {operator}?", operator=account.name))
    box.setTextFormat(Qt.TextFormat.PlainText)
    return box


def _add_role(question: QuestionDialog, chosen: Role) -> QComboBox:
    choices = ((words, role) for role, words in ROLES.items())
    box = question.add_choice(tr("&Role"), choices, "fleet_account_role")
    box.setCurrentText(ROLES[chosen])
    return box


def _chosen(roles: QComboBox) -> Role:
    # Qt keeps text that is an enum, too, as mere text.
    return Role(roles.currentData())


def _add_validity(question: QuestionDialog) -> QComboBox:
    return question.add_choice(tr("&Token holds"), VALIDITIES, "fleet_account_validity")
