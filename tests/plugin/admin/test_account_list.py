"""The accounts in their window, and who may see them."""

from __future__ import annotations

import pytest
from fleet_supervisor.plugin.admin.token_dialog import day_and_time
from fleet_supervisor.robot_bridge.core.messages.administration import TokenState
from fleet_supervisor.robot_bridge.core.messages.base import Role
from qgis.PyQt.QtWidgets import QAction, QToolButton

from tests.plugin.admin.accounts_desk import BUTTONS, CHANGES, MADE_AT


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
    at_accounts.wait_for_status("5 accounts")


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
    from fleet_supervisor.plugin.settings.profile import Connections, GatewayConnection

    Connections().store(GatewayConnection("Track", "ws://127.0.0.1:1/desk"))
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
    at_accounts.wait_for_status("Accounts: the database is away; ask again")


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
    operator.wait_for_status("2 accounts")


def assert_closed(operator, gateway, why):
    operator.wait_for_status(why)
    assert not any(operator.button(name).isEnabled() for name in BUTTONS)
    assert operator.rows() == []
    assert gateway.requests_of("get_operators") == []
