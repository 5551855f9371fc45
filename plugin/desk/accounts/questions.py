"""What is asked before an account is made or changed. None of these does anything by itself."""

from __future__ import annotations

from collections.abc import Callable

from qgis.PyQt.QtCore import Qt, pyqtSignal
from qgis.PyQt.QtWidgets import (
    QComboBox,
    QDialog,
    QDialogButtonBox,
    QFormLayout,
    QLabel,
    QLineEdit,
    QMessageBox,
    QPushButton,
    QWidget,
)

from ....robot_bridge.messages import Role
from ...language import tr
from ..role_words import ROLES
from ..safe_question import safe_question
from ..whole_text import WholeText
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
WIDTH = 460


class AccountQuestion(QDialog):
    """A text, a warning where there is one, fields, and two buttons.

    With ``is_safe`` Enter leaves everything as it is.
    """

    def __init__(
        self,
        name: str,
        title: str,
        text: str,
        confirm: str,
        *,
        warning: str = "",
        is_safe: bool,
        parent: QWidget,
    ):
        super().__init__(parent)
        self.setObjectName(name)
        self.setWindowTitle(title)
        self.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        self.setMinimumWidth(WIDTH)
        self.confirm, cancel = QPushButton(confirm), QPushButton(tr("Cancel"))
        self.confirm.setObjectName(f"{name}_confirm")
        cancel.setObjectName(f"{name}_cancel")
        self._foot = QDialogButtonBox()
        self._foot.addButton(self.confirm, QDialogButtonBox.ButtonRole.AcceptRole)
        self._foot.addButton(cancel, QDialogButtonBox.ButtonRole.RejectRole)
        for button in (self.confirm, cancel):
            button.setAutoDefault(False)
        (cancel if is_safe else self.confirm).setDefault(True)
        self._foot.accepted.connect(self.accept)
        self._foot.rejected.connect(self.reject)
        self._form = QFormLayout(self)
        for told in filter(None, (text, warning)):
            self._form.addRow(WholeText(told))

    def add_field(self, text: str, field: QWidget, name: str) -> None:
        """Put a field beneath those that are there; ``text`` has its letter."""
        field.setObjectName(name)
        label = QLabel(text)
        label.setBuddy(field)
        self._form.addRow(label, field)

    def lay_out(self) -> None:
        """Put the buttons beneath all fields."""
        self._form.addRow(self._foot)


class NewAccount(AccountQuestion):
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
            "fleet_new_account", tr("New account"), text, tr("Make account"), is_safe=False, parent=parent
        )
        self._name = QLineEdit()
        self._name.setMaxLength(LONGEST_NAME)
        self._role = _roles(Role.SUPERVISOR if is_first else Role.VIEWER)
        self._validity = _validities()
        self.add_field(tr("&Name"), self._name, "fleet_account_name")
        self.add_field(tr("&Role"), self._role, "fleet_account_role")
        self.add_field(tr("&Token holds"), self._validity, "fleet_account_validity")
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


class AnotherRole(AccountQuestion):
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
            text,
            tr("Change role"),
            warning=warning if account.is_own else "",
            is_safe=account.is_own,
            parent=parent,
        )
        self._role = _roles(account.report.role)
        self.add_field(tr("&Role"), self._role, "fleet_account_role")
        self.lay_out()
        self.accepted.connect(lambda: self.confirmed.emit(_chosen(self._role)))


class AnotherToken(AccountQuestion):
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
            text,
            tr("Make token"),
            warning=warning if account.is_own else "",
            is_safe=True,
            parent=parent,
        )
        self._validity = _validities()
        self.add_field(tr("&Token holds"), self._validity, "fleet_account_validity")
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


def _roles(chosen: Role) -> QComboBox:
    box = QComboBox()
    for role, words in ROLES.items():
        box.addItem(words, role)
    box.setCurrentText(ROLES[chosen])
    return box


def _chosen(roles: QComboBox) -> Role:
    # Qt keeps text that is an enum, too, as mere text.
    return Role(roles.currentData())


def _validities() -> QComboBox:
    box = QComboBox()
    for words, seconds in VALIDITIES:
        box.addItem(words, seconds)
    return box
