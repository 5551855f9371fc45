"""Roles are changed, tokens renewed and revoked, and what cuts somebody off is confirmed."""

from __future__ import annotations

import pytest
from qgis.PyQt.QtCore import Qt
from qgis.PyQt.QtTest import QTest
from qgis.PyQt.QtWidgets import QComboBox, QLabel, QLineEdit

from tests.plugin.admin.accounts_desk import confirm, is_closed


def test_another_role_is_chosen_and_asked_for(at_accounts, gateway):
    at_accounts.choose("Ben")
    at_accounts.press("fleet_account_set_role")
    question = at_accounts.question("fleet_another_role")
    assert not any("your own" in label.text() for label in question.findChildren(QLabel))
    question.findChild(QComboBox, "fleet_account_role").setCurrentText("operator")
    confirm(question)
    at_accounts.wait_for_status("Ben is operator now.")
    assert gateway.requests_of("set_role") == [{"operator": "Ben", "role": "operator"}]
    at_accounts.wait(lambda: at_accounts.rows()[1][1] == "operator")
    assert at_accounts.status.text() == "Ben is operator now."


def test_a_new_token_takes_the_old_ones_place(at_accounts, gateway, book):
    at_accounts.choose("Ben")
    at_accounts.press("fleet_account_rotate")
    question = at_accounts.question("fleet_another_token")
    question.findChild(QComboBox, "fleet_account_validity").setCurrentIndex(3)
    confirm(question)
    shown = at_accounts.token()
    assert gateway.requests_of("rotate_token") == [{"operator": "Ben", "expires_in": 30 * 86_400.0}]
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
    at_accounts.wait_for_status("2 accounts")
    assert gateway.requests_of(method) == []


def test_a_token_is_revoked_when_that_is_confirmed(at_accounts, gateway):
    at_accounts.choose("Ben")
    at_accounts.press("fleet_account_revoke")
    question = at_accounts.question("fleet_revocation")
    assert not any("your own" in label.text() for label in question.findChildren(QLabel))
    confirm(question)
    at_accounts.wait_for_status("The token of Ben is revoked.")
    assert gateway.requests_of("revoke_token") == [{"operator": "Ben"}]
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
    assert (
        gateway.requests_of("revoke_token")
        + gateway.requests_of("rotate_token")
        + gateway.requests_of("set_role")
        == []
    )


def test_the_last_supervisor_stays_and_the_gateway_says_why(at_accounts, gateway):
    gateway.refuse["revoke_token"] = "that would leave no supervisor with a token that holds"
    at_accounts.choose("Ada")
    at_accounts.press("fleet_account_revoke")
    confirm(at_accounts.question("fleet_revocation"))
    at_accounts.wait_for_status("Revoke Ada: that would leave no supervisor")
    assert at_accounts.rows()[0][4] == "holds"
