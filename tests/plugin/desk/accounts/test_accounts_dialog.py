"""Accounts in their window: listed, made, changed and revoked by a supervisor, and tokens shown once."""

from __future__ import annotations

import threading

import pytest
from fleet_supervisor.plugin.desk.accounts.account_model import day_and_time
from fleet_supervisor.robot_bridge.messages import Role, TokenState
from qgis.core import QgsApplication, QgsSettings
from qgis.PyQt import sip
from qgis.PyQt.QtCore import QCoreApplication, QEvent, Qt
from qgis.PyQt.QtTest import QTest
from qgis.PyQt.QtWidgets import (
    QAction,
    QApplication,
    QComboBox,
    QDialog,
    QLabel,
    QLineEdit,
    QPushButton,
    QToolButton,
)

MADE_AT = 1_790_000_000.0
CHANGES = ("fleet_account_set_role", "fleet_account_rotate", "fleet_account_revoke")
BUTTONS = ("fleet_account_add", *CHANGES, "fleet_accounts_refresh")


class Desk:
    """What an operator sees and presses."""

    def __init__(self, plugin, iface, gateway, wait):
        self._plugin, self._iface, self._gateway, self.wait = plugin, iface, gateway, wait
        self.said = self.window().said

    def connect(self) -> None:
        panel = self._plugin.window.dock.connection_panel
        panel.findChild(QLineEdit, "fleet_url").setText(self._gateway.url)
        panel.findChild(QLineEdit, "fleet_operator").setText("Ada")
        self._plugin.window.actions.connect.trigger()
        desk = self._plugin.window.desk
        self.wait(lambda: desk.link.phase.value == "connected" and desk.site is not None, what="the link")

    def open(self) -> None:
        self._iface.findChild(QAction, "fleet_accounts").trigger()

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
        assert button.isEnabled(), f"{name}: {self.said.text()}"
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

    def told(self, text: str) -> None:
        self.wait(lambda: text in self.said.text(), what=f"{text!r} in place of {self.said.text()!r}")


@pytest.fixture
def operator(plugin, iface, gateway, wait):
    return Desk(plugin, iface, gateway, wait)


@pytest.fixture
def at_accounts(operator, book):
    """Connected, with the window open and both accounts listed."""
    operator.connect()
    operator.open()
    operator.listed("Ada", "Ben")
    return operator


def confirm(question: QDialog) -> None:
    QTest.mouseClick(
        question.findChild(QPushButton, f"{question.objectName()}_confirm"), Qt.MouseButton.LeftButton
    )


def is_closed(dialog: QDialog) -> bool:
    return sip.isdeleted(dialog) or not dialog.isVisible()


def let_deleted_go() -> None:
    QCoreApplication.sendPostedEvents(None, QEvent.Type.DeferredDelete)
    QApplication.processEvents()


# --- the list ---


def test_every_account_is_listed_with_its_role_times_and_token(at_accounts, book):
    book.put("Cleo", Role.OPERATOR, token=TokenState.REVOKED, revoked_at=MADE_AT + 30)
    book.put("Dan", Role.OPERATOR, token=TokenState.EXPIRED, expires_at=MADE_AT + 40)
    book.put("Eve", Role.OPERATOR, token=TokenState.NONE)
    at_accounts.press("fleet_accounts_refresh")
    at_accounts.listed("Ada", "Ben", "Cleo", "Dan", "Eve")
    since, seen = day_and_time(MADE_AT), day_and_time(MADE_AT + 60)
    assert at_accounts.rows() == [
        ("Ada (you)", "supervisor", since, "connected now", "holds"),
        ("Ben", "viewer", since, seen, f"holds until {day_and_time(MADE_AT + 86_400)}"),
        ("Cleo", "operator", since, "–", f"revoked {day_and_time(MADE_AT + 30)}"),
        ("Dan", "operator", since, "–", f"expired {day_and_time(MADE_AT + 40)}"),
        ("Eve", "operator", since, "–", "none"),
    ]
    at_accounts.told("5 accounts")


def test_it_is_in_the_menu_of_the_connections_too(at_accounts, plugin):
    at_accounts.window().close()
    button = plugin.window.dock.findChild(QToolButton, "fleet_connections_button")
    assert button.isEnabled()
    button.menu().aboutToShow.emit()
    button.menu().aboutToShow.emit()
    found = [one for one in button.menu().actions() if one.objectName() == "fleet_accounts"]
    assert len(found) == 1
    found[0].trigger()
    assert at_accounts.window().isVisible()


def test_while_connected_no_other_connection_can_be_picked(at_accounts, plugin):
    from fleet_supervisor.plugin.settings.connections import Connections
    from fleet_supervisor.plugin.settings.gateway_connection import GatewayConnection

    Connections().put(GatewayConnection("Track", "ws://127.0.0.1:1/desk"))
    menu = plugin.window.dock.connection_panel.menu.menu
    menu.aboutToShow.emit()
    for name in ("fleet_connection_Track", "fleet_keep_connection"):
        assert not menu.findChild(QAction, name).isEnabled()
    plugin.window.actions.connect.trigger()
    menu.aboutToShow.emit()
    assert menu.findChild(QAction, "fleet_connection_Track").isEnabled()


def test_the_selection_stays_with_its_account_when_others_come(at_accounts, book):
    at_accounts.choose("Ben")
    book.accounts = {"Abe": book.accounts["Ben"], **book.accounts}
    book.put("Abe", Role.VIEWER)
    at_accounts.press("fleet_accounts_refresh")
    at_accounts.listed("Abe", "Ada", "Ben")
    assert at_accounts.window().selected().name == "Ben"
    assert at_accounts.button("fleet_account_revoke").isEnabled()
    del book.accounts["Ben"]
    at_accounts.press("fleet_accounts_refresh")
    at_accounts.listed("Abe", "Ada")
    assert not any(at_accounts.button(name).isEnabled() for name in CHANGES)


def test_a_list_that_is_refused_says_why(at_accounts, gateway):
    gateway.refuse["get_operators"] = "the database is away; ask again"
    at_accounts.press("fleet_accounts_refresh")
    at_accounts.told("Accounts: the database is away; ask again")


# --- where it cannot be used ---


def assert_closed(operator, gateway, why):
    operator.told(why)
    assert not any(operator.button(name).isEnabled() for name in BUTTONS)
    assert operator.rows() == []
    assert gateway.asked("get_operators") == []


@pytest.mark.parametrize(
    ("who", "why"),
    [
        ({"operator": "Ben", "role": "viewer"}, "takes a supervisor, and Ben is viewer here"),
        ({"operator": "Ben", "role": "operator"}, "takes a supervisor, and Ben is operator here"),
        ({}, "says nothing of roles"),
    ],
)
def test_who_is_no_supervisor_reads_why_and_nothing_is_asked(operator, book, gateway, who, why):
    gateway.who = who
    operator.connect()
    operator.open()
    assert_closed(operator, gateway, why)


def test_without_a_link_it_says_so_and_fills_when_there_is_one(operator, book, gateway):
    operator.open()
    assert_closed(operator, gateway, "not connected")
    operator.connect()
    operator.listed("Ada", "Ben")
    operator.told("2 accounts")


# --- a new account, and its token ---


def test_an_account_is_made_by_keys_alone_and_its_token_shown(at_accounts, gateway, wait):
    QTest.keyClick(at_accounts.window(), Qt.Key.Key_A, Qt.KeyboardModifier.AltModifier)
    question = at_accounts.question("fleet_new_account")
    assert not question.findChild(QPushButton, "fleet_new_account_confirm").isEnabled()
    name = question.findChild(QLineEdit, "fleet_account_name")
    wait(lambda: question.focusWidget() is name)
    QTest.keyClicks(name, " Cleo ")
    QTest.keyClick(name, Qt.Key.Key_Tab)
    role = question.focusWidget()
    assert role.currentText() == "viewer"
    QTest.keyClick(role, Qt.Key.Key_Down)
    QTest.keyClick(role, Qt.Key.Key_Tab)
    QTest.keyClick(question.focusWidget(), Qt.Key.Key_Down)
    QTest.keyClick(question.focusWidget(), Qt.Key.Key_Return)
    token = at_accounts.token()
    assert gateway.asked("add_operator") == [{"operator": "Cleo", "role": "operator", "expires_in": 86_400.0}]
    field = token.findChild(QLineEdit, "fleet_new_token")
    assert field.isReadOnly()
    assert field.text() == f"fleet_op_{0:043d}"
    words = " ".join(label.text() for label in token.findChildren(QLabel))
    assert "Cleo, operator" in words and "shown now and never again" in words
    assert day_and_time(MADE_AT + 86_400) in words
    assert "cut off" not in words
    at_accounts.listed("Ada", "Ben", "Cleo")


def make_account(operator, name):
    operator.press("fleet_account_add")
    question = operator.question("fleet_new_account")
    question.findChild(QLineEdit, "fleet_account_name").setText(name)
    confirm(question)


def everything_said() -> str:
    """What any widget shows."""
    texts = [part.text() for part in QApplication.allWidgets() if isinstance(part, (QLabel, QLineEdit))]
    return "\n".join(texts)


def test_a_token_is_copied_by_enter_and_gone_when_its_window_closes(at_accounts, book):
    logged = []
    QgsApplication.messageLog().messageReceived.connect(lambda *told: logged.append(str(told)))
    make_account(at_accounts, "Cleo")
    shown = at_accounts.token()
    (token,) = book.made
    field = shown.findChild(QLineEdit, "fleet_new_token")
    QTest.keyClick(field, Qt.Key.Key_Return)
    assert QApplication.clipboard().text() == token
    assert "stays in the clipboard" in shown.findChild(QLabel, "fleet_token_copied").text()
    assert everything_said().count(token) == 1
    QTest.keyClick(field, Qt.Key.Key_Escape)
    assert field.text() == ""
    field.setReadOnly(False)
    field.undo()
    assert field.text() == ""
    let_deleted_go()
    assert sip.isdeleted(shown)
    QApplication.clipboard().clear()
    settings = QgsSettings()
    kept = [str(settings.value(key)) for key in settings.allKeys()]
    assert token not in everything_said() + "".join(logged + kept)


def test_a_name_that_is_taken_is_refused_in_the_gateways_words(at_accounts, gateway):
    gateway.refuse["add_operator"] = "operator 'Ben' is there already"
    make_account(at_accounts, "ben")
    at_accounts.told("New account ben: operator 'Ben' is there already")
    assert at_accounts.tokens() == []


def test_the_first_account_is_a_supervisors_and_says_that_it_ends_the_link(operator, book, gateway):
    book.accounts.clear()
    operator.connect()
    operator.open()
    operator.told("has no accounts")
    operator.press("fleet_account_add")
    question = operator.question("fleet_new_account")
    assert question.findChild(QComboBox, "fleet_account_role").currentText() == "supervisor"
    assert any("ends that for good" in label.text() for label in question.findChildren(QLabel))
    question.findChild(QLineEdit, "fleet_account_name").setText("Ada")
    confirm(question)
    shown = operator.token()
    assert any("is cut off" in label.text() for label in shown.findChildren(QLabel))
    assert gateway.asked("add_operator") == [{"operator": "Ada", "role": "supervisor"}]


def test_a_token_that_comes_when_the_window_is_closed_is_shown_all_the_same(at_accounts, gateway, book):
    may_answer = threading.Event()
    answer = gateway.answers["add_operator"]
    gateway.answers["add_operator"] = lambda params: may_answer.wait(60) and answer(params)
    make_account(at_accounts, "Cleo")
    at_accounts.window().close()
    assert at_accounts.tokens() == []
    may_answer.set()
    shown = at_accounts.token()
    assert shown.findChild(QLineEdit, "fleet_new_token").text() == book.made[0]


def test_a_refusal_that_comes_when_the_window_is_closed_is_in_the_message_bar(
    at_accounts, gateway, iface, wait
):
    may_answer = threading.Event()
    why = {"error": {"code": -32000, "message": "operator 'Ben' is there already"}}
    gateway.answers["add_operator"] = lambda params: may_answer.wait(60) and why
    make_account(at_accounts, "Ben")
    at_accounts.window().close()
    may_answer.set()
    wait(lambda: any("New account Ben: operator 'Ben' is there" in text for text in iface.texts()))


def test_an_answer_that_cannot_be_read_says_so_and_shows_nothing_of_it(at_accounts, gateway):
    token = f"fleet_op_{7:043d}"
    gateway.answers["add_operator"] = lambda params: {"result": {"role": "viewer", "token": token}}
    make_account(at_accounts, "Cleo")
    at_accounts.told("New account Cleo: the gateway's answer cannot be read (TypeError)")
    assert token not in everything_said()


# --- changes ---


def test_another_role_is_chosen_and_asked_for(at_accounts, gateway):
    at_accounts.choose("Ben")
    at_accounts.press("fleet_account_set_role")
    question = at_accounts.question("fleet_another_role")
    assert not any("your own" in label.text() for label in question.findChildren(QLabel))
    question.findChild(QComboBox, "fleet_account_role").setCurrentText("operator")
    confirm(question)
    at_accounts.told("Ben is operator now.")
    assert gateway.asked("set_role") == [{"operator": "Ben", "role": "operator"}]
    at_accounts.wait(lambda: at_accounts.rows()[1][1] == "operator")
    assert at_accounts.said.text() == "Ben is operator now."


def test_a_new_token_takes_the_old_ones_place(at_accounts, gateway, book):
    at_accounts.choose("Ben")
    at_accounts.press("fleet_account_rotate")
    question = at_accounts.question("fleet_another_token")
    question.findChild(QComboBox, "fleet_account_validity").setCurrentIndex(3)
    confirm(question)
    shown = at_accounts.token()
    assert gateway.asked("rotate_token") == [{"operator": "Ben", "expires_in": 30 * 86_400.0}]
    assert shown.findChild(QLineEdit, "fleet_new_token").text() == book.made[0]
    assert not any("is cut off" in label.text() for label in shown.findChildren(QLabel))


@pytest.mark.parametrize(
    ("button", "question", "method"),
    [
        ("fleet_account_revoke", "fleet_revocation", "revoke_token"),
        ("fleet_account_rotate", "fleet_another_token", "rotate_token"),
    ],
)
def test_what_cuts_somebody_off_is_not_behind_enter(at_accounts, gateway, button, question, method):
    at_accounts.choose("Ben")
    at_accounts.press(button)
    asked = at_accounts.question(question)
    QTest.keyClick(asked, Qt.Key.Key_Return)
    assert is_closed(asked)
    at_accounts.press("fleet_accounts_refresh")
    at_accounts.told("2 accounts")
    assert gateway.asked(method) == []


def test_a_token_is_revoked_when_that_is_confirmed(at_accounts, gateway):
    at_accounts.choose("Ben")
    at_accounts.press("fleet_account_revoke")
    question = at_accounts.question("fleet_revocation")
    assert not any("your own" in label.text() for label in question.findChildren(QLabel))
    confirm(question)
    at_accounts.told("The token of Ben is revoked.")
    assert gateway.asked("revoke_token") == [{"operator": "Ben"}]
    at_accounts.wait(lambda: at_accounts.rows()[1][4].startswith("revoked"))


@pytest.mark.parametrize(
    ("button", "question", "says"),
    [
        ("fleet_account_revoke", "fleet_revocation", "does not come back by itself"),
        ("fleet_account_rotate", "fleet_another_token", "until you enter the new token"),
        ("fleet_account_set_role", "fleet_another_role", "you cannot undo it"),
    ],
)
def test_ones_own_account_is_said_to_be_that_and_enter_leaves_it(
    at_accounts, gateway, button, question, says
):
    at_accounts.choose("Ada")
    at_accounts.press(button)
    asked = at_accounts.question(question)
    assert any(says in label.text() for label in asked.findChildren(QLabel))
    QTest.keyClick(asked, Qt.Key.Key_Return)
    assert is_closed(asked)
    assert gateway.asked("revoke_token") + gateway.asked("rotate_token") + gateway.asked("set_role") == []


def test_the_last_supervisor_stays_and_the_gateway_says_why(at_accounts, gateway):
    gateway.refuse["revoke_token"] = "that would leave no supervisor with a token that holds"
    at_accounts.choose("Ada")
    at_accounts.press("fleet_account_revoke")
    confirm(at_accounts.question("fleet_revocation"))
    at_accounts.told("Revoke Ada: that would leave no supervisor")
    assert at_accounts.rows()[0][4] == "holds"


# --- the link goes ---


def test_ones_own_new_token_outlives_the_link_that_it_ends(at_accounts, gateway, book, plugin, wait):
    at_accounts.choose("Ada")
    at_accounts.press("fleet_account_rotate")
    confirm(at_accounts.question("fleet_another_token"))
    shown = at_accounts.token()
    gateway.stop()
    at_accounts.told("not connected")
    assert shown.isVisible()
    assert shown.findChild(QLineEdit, "fleet_new_token").text() == book.made[0]
    assert any("is cut off" in label.text() for label in shown.findChildren(QLabel))


def test_what_was_asked_when_the_link_went_is_not_waited_for(at_accounts, gateway, plugin):
    gateway.mute.add("revoke_token")
    at_accounts.choose("Ben")
    at_accounts.press("fleet_account_revoke")
    confirm(at_accounts.question("fleet_revocation"))
    at_accounts.wait(lambda: gateway.asked("revoke_token"))
    gateway.stop()
    at_accounts.told("not connected")
    assert at_accounts.rows() == []
    assert not any(at_accounts.button(name).isEnabled() for name in BUTTONS)
    plugin.window.actions.connect.trigger()
    at_accounts.told("Revoke Ben: The link was closed before the gateway answered")


def test_a_question_about_one_gateways_account_is_not_answered_for_another(at_accounts, gateway):
    at_accounts.choose("Ben")
    at_accounts.press("fleet_account_revoke")
    question = at_accounts.question("fleet_revocation")
    gateway.stop()
    at_accounts.told("not connected")
    assert is_closed(question)


def test_a_closed_window_forgets_the_accounts_of_a_link_that_ends(at_accounts, plugin, wait):
    at_accounts.window().close()
    plugin.window.actions.connect.trigger()
    wait(lambda: at_accounts.rows() == [])


# --- beside the rest ---


def test_robots_can_be_stopped_whatever_is_open(at_accounts, gateway, wait):
    make_account(at_accounts, "Cleo")
    shown = at_accounts.token()
    at_accounts.choose("Ben")
    at_accounts.press("fleet_account_revoke")
    for number, window in enumerate((shown, at_accounts.window(), at_accounts.question("fleet_revocation"))):
        window.activateWindow()
        QTest.keyClick(window, Qt.Key.Key_F10)
        wait(lambda number=number: len(gateway.asked("emergency_stop")) == number + 1, what="the stop")


def test_only_one_question_is_open(at_accounts):
    at_accounts.choose("Ben")
    at_accounts.press("fleet_account_revoke")
    revocation = at_accounts.question("fleet_revocation")
    at_accounts.press("fleet_account_add")
    assert is_closed(revocation)
    new_account = at_accounts.question("fleet_new_account")
    at_accounts.window().close()
    assert is_closed(new_account)


def test_unloading_closes_all_of_it(at_accounts, plugin, iface):
    make_account(at_accounts, "Cleo")
    shown = at_accounts.token()
    field = shown.findChild(QLineEdit, "fleet_new_token")
    at_accounts.choose("Ben")
    at_accounts.press("fleet_account_revoke")
    plugin.unload()
    assert field.text() == ""
    let_deleted_go()
    assert sip.isdeleted(shown)
    for name in ("fleet_accounts_dialog", "fleet_token_dialog", "fleet_revocation"):
        assert iface.findChild(QDialog, name) is None
    assert iface.findChild(QAction, "fleet_accounts") is None
