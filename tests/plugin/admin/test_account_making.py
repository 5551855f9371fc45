"""Accounts are made, and their tokens shown once."""

from __future__ import annotations

import threading

import numpy as np
import zxingcpp
from fleet_supervisor.plugin.admin.token_dialog import TokenDialog, day_and_time
from fleet_supervisor.robot_bridge.core.messages.administration import NewToken
from fleet_supervisor.robot_bridge.core.messages.base import Role
from qgis.core import QgsApplication, QgsSettings
from qgis.PyQt import sip
from qgis.PyQt.QtCore import Qt
from qgis.PyQt.QtGui import QImage
from qgis.PyQt.QtTest import QTest
from qgis.PyQt.QtWidgets import QApplication, QComboBox, QLabel, QLineEdit, QPushButton

from tests.plugin.admin.accounts_desk import MADE_AT, confirm, let_deleted_go, make_account
from tests.plugin.admin.conftest import secret


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
    assert gateway.requests_of("add_operator") == [
        {"operator": "Cleo", "role": "operator", "expires_in": 86_400.0}
    ]
    field = token.findChild(QLineEdit, "fleet_new_token")
    assert field.isReadOnly()
    assert field.text() == f"fleet_op_{0:043d}"
    words = " ".join(label.text() for label in token.findChildren(QLabel))
    assert "Cleo, operator" in words and "shown now and never again" in words
    assert day_and_time(MADE_AT + 86_400) in words
    assert "cut off" not in words
    at_accounts.listed("Ada", "Ben", "Cleo")


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
    at_accounts.wait_for_status("New account ben: operator 'Ben' is there already")
    assert at_accounts.tokens() == []


def test_the_first_account_is_a_supervisors_and_says_that_it_ends_the_link(operator, book, gateway):
    book.accounts.clear()
    operator.connect()
    operator.open()
    operator.wait_for_status("has no accounts")
    operator.press("fleet_account_add")
    question = operator.question("fleet_new_account")
    assert question.findChild(QComboBox, "fleet_account_role").currentText() == "supervisor"
    assert any("ends that for good" in label.text() for label in question.findChildren(QLabel))
    question.findChild(QLineEdit, "fleet_account_name").setText("Ada")
    confirm(question)
    shown = operator.token()
    assert any("is cut off" in label.text() for label in shown.findChildren(QLabel))
    assert gateway.requests_of("add_operator") == [{"operator": "Ada", "role": "supervisor"}]


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
    at_accounts.wait_for_status("New account Cleo: the gateway's answer cannot be read (TypeError)")
    assert token not in everything_said()


def everything_said() -> str:
    """What any widget shows."""
    texts = [part.text() for part in QApplication.allWidgets() if isinstance(part, (QLabel, QLineEdit))]
    return "\n".join(texts)


def test_a_phone_reads_from_the_code_what_opens_the_field_page(plugin, iface, wait):
    made, gateway = NewToken("Ada", Role.OPERATOR, secret(7), MADE_AT), "wss://fleet.example.org:8765/desk"
    dialog = TokenDialog(made, gateway, ends_link=False, parent=iface.mainWindow())
    dialog.show()
    code = dialog.findChild(QLabel, "fleet_token_code")
    wait(lambda: dialog.rect().contains(code.geometry()))
    picture = dialog.grab().toImage().convertToFormat(QImage.Format.Format_Grayscale8)
    rows = np.frombuffer(picture.bits().asstring(picture.sizeInBytes()), np.uint8)
    rows = rows.reshape(picture.height(), picture.bytesPerLine())[:, : picture.width()]
    (found,) = zxingcpp.read_barcodes(np.ascontiguousarray(rows))
    assert found.text == f"https://fleet.example.org:8765/field#token={secret(7)}"
    QTest.keyClick(dialog, Qt.Key.Key_Escape)
    assert code.pixmap() is None or code.pixmap().isNull()
    let_deleted_go()


def test_a_code_that_no_phone_could_use_is_not_shown(at_accounts):
    make_account(at_accounts, "Cleo")
    shown = at_accounts.token()
    assert not shown.findChild(QLabel, "fleet_token_code").isVisible()
    words = " ".join(label.text() for label in shown.findChildren(QLabel))
    assert "not by 127.0.0.1" in words
