"""The window over accounts when the link goes, in an emergency, and at the end."""

from __future__ import annotations

from qgis.PyQt import sip
from qgis.PyQt.QtCore import Qt
from qgis.PyQt.QtTest import QTest
from qgis.PyQt.QtWidgets import QAction, QDialog, QLabel, QLineEdit

from tests.plugin.admin.accounts_desk import BUTTONS, confirm, is_closed, let_deleted_go, make_account


def test_ones_own_new_token_outlives_the_link_that_it_ends(at_accounts, gateway, book, plugin, wait):
    at_accounts.choose("Ada")
    at_accounts.press("fleet_account_rotate")
    confirm(at_accounts.question("fleet_another_token"))
    shown = at_accounts.token()
    gateway.stop()
    at_accounts.wait_for_status("not connected")
    assert shown.isVisible()
    assert shown.findChild(QLineEdit, "fleet_new_token").text() == book.made[0]
    assert any("is cut off" in label.text() for label in shown.findChildren(QLabel))


def test_what_was_asked_when_the_link_went_is_not_waited_for(at_accounts, gateway, plugin):
    gateway.mute.add("revoke_token")
    at_accounts.choose("Ben")
    at_accounts.press("fleet_account_revoke")
    confirm(at_accounts.question("fleet_revocation"))
    at_accounts.wait(lambda: gateway.requests_of("revoke_token"))
    gateway.stop()
    at_accounts.wait_for_status("not connected")
    assert at_accounts.rows() == []
    assert not any(at_accounts.button(name).isEnabled() for name in BUTTONS)
    plugin.window.actions.connect.trigger()
    at_accounts.wait_for_status("Revoke Ben: The link was closed before the gateway answered")


def test_a_question_about_one_gateways_account_is_not_answered_for_another(at_accounts, gateway):
    at_accounts.choose("Ben")
    at_accounts.press("fleet_account_revoke")
    question = at_accounts.question("fleet_revocation")
    gateway.stop()
    at_accounts.wait_for_status("not connected")
    assert is_closed(question)


def test_a_closed_window_forgets_the_accounts_of_a_link_that_ends(at_accounts, plugin, wait):
    at_accounts.window().close()
    plugin.window.actions.connect.trigger()
    wait(lambda: at_accounts.rows() == [])


def test_robots_can_be_stopped_whatever_is_open(at_accounts, gateway, wait):
    make_account(at_accounts, "Cleo")
    shown = at_accounts.token()
    at_accounts.choose("Ben")
    at_accounts.press("fleet_account_revoke")
    for number, window in enumerate((shown, at_accounts.window(), at_accounts.question("fleet_revocation"))):
        window.activateWindow()
        QTest.keyClick(window, Qt.Key.Key_F10)
        wait(lambda number=number: len(gateway.requests_of("emergency_stop")) == number + 1, what="the stop")


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
