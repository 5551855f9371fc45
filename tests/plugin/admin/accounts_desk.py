"""What an operator sees and does at the window over accounts."""

from __future__ import annotations

from qgis.PyQt import sip
from qgis.PyQt.QtCore import QCoreApplication, QEvent, Qt
from qgis.PyQt.QtTest import QTest
from qgis.PyQt.QtWidgets import QAction, QApplication, QDialog, QLineEdit, QPushButton

MADE_AT = 1_790_000_000.0
CHANGES = ("fleet_account_set_role", "fleet_account_rotate", "fleet_account_revoke")
BUTTONS = ("fleet_account_add", *CHANGES, "fleet_accounts_refresh")


class AccountsDesk:
    """What an operator sees and presses."""

    def __init__(self, plugin, iface, gateway, wait):
        self._plugin, self._iface, self._gateway, self.wait = plugin, iface, gateway, wait

    def connect(self) -> None:
        panel = self._plugin.window.dock.connection_panel
        panel.findChild(QLineEdit, "fleet_url").setText(self._gateway.url)
        panel.findChild(QLineEdit, "fleet_operator").setText("Ada")
        self._plugin.window.actions.connect.trigger()
        desk = self._plugin.window.desk
        self.wait(
            lambda: desk.state.link.phase.value == "connected" and desk.state.site is not None,
            what="the link",
        )

    def open(self) -> None:
        self._iface.findChild(QAction, "fleet_accounts").trigger()

    @property
    def status(self):
        return self.window().status

    def window(self):
        return self._iface.findChild(QDialog, "fleet_accounts_dialog")

    def rows(self) -> list[tuple]:
        model = self.window().model
        return [
            tuple(model.data(model.index(row, column)) for column in range(model.columnCount()))
            for row in range(model.rowCount())
        ]

    def listed(self, *names: str) -> None:
        """Wait until the accounts of these operators are listed."""
        self.wait(lambda: tuple(row[0].split()[0] for row in self.rows()) == names, what=str(names))

    def choose(self, name: str) -> None:
        model = self.window().model
        at = next(row for row, account in enumerate(model.rows) if account.name == name)
        view = self.window().view
        place = view.visualRect(model.index(at, 0)).center()
        QTest.mouseClick(view.viewport(), Qt.MouseButton.LeftButton, pos=place)

    def button(self, name: str) -> QPushButton:
        return self.window().findChild(QPushButton, name)

    def press(self, name: str) -> None:
        button = self.button(name)
        assert button.isEnabled(), f"{name}: {self.status.text()}"
        QTest.mouseClick(button, Qt.MouseButton.LeftButton)

    def question(self, name: str) -> QDialog:
        """Wait for a question: a letter presses its button a moment later."""

        def shown():
            return [one for one in self.window().findChildren(QDialog, name) if one.isVisible()]

        self.wait(shown, what=name)
        return shown()[0]

    def tokens(self) -> list[QDialog]:
        shown = self._iface.findChildren(QDialog, "fleet_token_dialog")
        return [one for one in shown if one.isVisible()]

    def token(self) -> QDialog:
        """Wait for the one token that is shown."""
        self.wait(lambda: len(self.tokens()) == 1, what="the token")
        return self.tokens()[0]

    def wait_for_status(self, text: str) -> None:
        self.wait(lambda: text in self.status.text(), what=f"{text!r} in place of {self.status.text()!r}")


def confirm(question: QDialog) -> None:
    QTest.mouseClick(
        question.findChild(QPushButton, f"{question.objectName()}_confirm"), Qt.MouseButton.LeftButton
    )


def is_closed(dialog: QDialog) -> bool:
    return sip.isdeleted(dialog) or not dialog.isVisible()


def let_deleted_go() -> None:
    QCoreApplication.sendPostedEvents(None, QEvent.Type.DeferredDelete)
    QApplication.processEvents()


def make_account(operator, name):
    operator.press("fleet_account_add")
    question = operator.question("fleet_new_account")
    question.findChild(QLineEdit, "fleet_account_name").setText(name)
    confirm(question)
