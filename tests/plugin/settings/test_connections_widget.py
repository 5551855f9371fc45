"""Connections under names: made, tested, picked, exported and imported with mouse and keys."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from fleet_supervisor.plugin.settings.connections_widget import ConnectionDialog, ConnectionsWidget
from fleet_supervisor.plugin.settings.profile import TITLE, Connections, GatewayConnection, TokenStore
from qgis.core import QgsApplication, QgsAuthMethodConfig, QgsSettings
from qgis.PyQt.QtCore import Qt
from qgis.PyQt.QtTest import QTest
from qgis.PyQt.QtWidgets import (
    QAction,
    QApplication,
    QDialogButtonBox,
    QLabel,
    QLineEdit,
    QPushButton,
    QToolButton,
    QTreeWidget,
)

LEFT = Qt.MouseButton.LeftButton
SECRET = "fleet_op_0123456789abcdefghijklmnopqrstuvwxyzABCDEFG"


@pytest.fixture
def master_password():
    manager = QgsApplication.authManager()
    if manager.isDisabled():
        pytest.skip("this QGIS has no authentication manager (QCA is missing)")
    assert manager.setMasterPassword("a password for tests", False)
    yield manager
    for key in list(manager.availableAuthMethodConfigs()):
        manager.removeAuthenticationConfig(key)


@pytest.fixture
def widget(iface):
    made = ConnectionsWidget(iface)
    made.show()
    yield made
    made.end()
    made.deleteLater()


def fill(dialog, **texts):
    for name, text in texts.items():
        field = dialog.findChild(QLineEdit, f"fleet_connection_{name}")
        field.clear()
        QTest.keyClicks(field, text)


def press(parent, name):
    QTest.mouseClick(parent.findChild(QPushButton, name), LEFT)


def ok(dialog):
    box = dialog.findChild(QDialogButtonBox)
    QTest.mouseClick(box.button(QDialogButtonBox.StandardButton.Ok), LEFT)


def verdict(parent):
    return parent.findChild(QLabel, "fleet_verdict").text()


def listed(widget):
    tree = widget.findChild(QTreeWidget, "fleet_connections")
    return [tree.topLevelItem(row).text(0) for row in range(tree.topLevelItemCount())]


def take(widget, name):
    tree = widget.findChild(QTreeWidget, "fleet_connections")
    tree.clearSelection()
    tree.setCurrentItem(tree.findItems(name, Qt.MatchFlag.MatchExactly)[0])


def test_a_new_connection_is_tested_and_kept(widget, gateway, wait):
    gateway.who = {"operator": "Anna Nagy", "role": "viewer"}
    press(widget, "fleet_connections_new")
    dialog = widget.findChild(ConnectionDialog)
    fill(dialog, name="Yard", url=gateway.url, operator="anna")
    press(dialog, "fleet_connection_test")
    wait(lambda: verdict(dialog).startswith("✔"), 8)
    assert "Yard (EPSG:32633) answers, as Anna Nagy, viewer." in verdict(dialog)
    assert gateway.requests_of("hello")[0]["operator"] == "anna"
    assert Connections().names() == []
    ok(dialog)
    assert Connections().get("Yard") == GatewayConnection("Yard", gateway.url, "anna")
    assert listed(widget) == ["Yard"]


def test_an_empty_list_says_how_it_is_filled(widget):
    hint = widget.findChild(QLabel, "fleet_connections_hint")
    assert hint.isVisible()
    Connections().store(GatewayConnection("Yard", "ws://127.0.0.1:9/desk"))
    widget.show_all("Yard")
    assert not hint.isVisible()
    press(widget, "fleet_connections_remove")
    assert hint.isVisible()


def test_a_gateway_that_is_not_there_is_told_with_what_to_do(widget, wait):
    Connections().store(GatewayConnection("Yard", "ws://127.0.0.1:9/desk"))
    widget.show_all("Yard")
    press(widget, "fleet_connections_test")
    wait(lambda: verdict(widget).startswith("✘"), 8)
    assert "Nothing listens at 127.0.0.1:9" in verdict(widget)


@pytest.mark.parametrize(
    ("texts", "says"),
    [
        ({"name": ""}, "has no name"),
        ({"url": "http://a"}, "begins with http"),
        ({"name": "Other"}, "There is a connection Other already"),
        ({"token": "two words"}, "it is one word"),
    ],
)
def test_what_cannot_be_is_refused_and_the_dialog_stays(widget, texts, says):
    for name in ("Other", "Yard"):
        Connections().store(GatewayConnection(name, "ws://127.0.0.1:8765/desk"))
    widget.show_all("Yard")
    press(widget, "fleet_connections_edit")
    dialog = widget.findChild(ConnectionDialog)
    fill(dialog, **texts)
    ok(dialog)
    assert says in verdict(dialog)
    assert dialog.isVisible()
    assert Connections().names() == ["Other", "Yard"]
    assert Connections().get("Yard").url == "ws://127.0.0.1:8765/desk"


def test_a_token_is_kept_encrypted_and_named_by_its_id_alone(widget, gateway, master_password):
    press(widget, "fleet_connections_new")
    dialog = widget.findChild(ConnectionDialog)
    fill(dialog, name="Yard", url=gateway.url, operator="anna", token=SECRET)
    ok(dialog)
    kept = Connections().get("Yard")
    config = master_password.availableAuthMethodConfigs()[kept.auth]
    assert (config.name(), config.method(), config.uri()) == (f"{TITLE}: Yard", "Basic", gateway.url)
    assert TokenStore().token_in(kept.auth) == SECRET
    assert not [key for key in QgsSettings().allKeys() if SECRET in str(QgsSettings().value(key))]
    assert SECRET.encode() not in Path(master_password.authenticationDatabasePath()).read_bytes()


def test_two_operators_of_one_gateway_have_their_own_tokens(widget, gateway, master_password):
    for name in ("Anna", "Bob"):
        press(widget, "fleet_connections_new")
        dialog = widget.findChildren(ConnectionDialog)[-1]
        fill(dialog, name=name, url=gateway.url, operator=name, token=f"{SECRET}{name}")
        ok(dialog)
    tokens = [TokenStore().token_in(Connections().get(name).auth) for name in ("Anna", "Bob")]
    assert tokens == [f"{SECRET}Anna", f"{SECRET}Bob"]


def test_an_authentication_of_another_kind_says_which_is_wanted(plugin, gateway, iface, master_password):
    config = QgsAuthMethodConfig("EsriToken")
    config.setName("maps")
    config.setConfig("token", "x")
    _, config = master_password.storeAuthenticationConfig(config)
    panel = plugin.window.dock.connection_panel
    panel.use(GatewayConnection("Yard", gateway.url, "anna", auth=config.id()))
    plugin.window.actions.connect.trigger()
    assert any("of the method EsriToken" in text and "Basic" in text for text in iface.texts())
    assert not plugin.window.actions.connect.isChecked()


def test_an_authentication_that_is_gone_is_told(plugin, gateway, iface, master_password):
    plugin.window.dock.connection_panel.use(GatewayConnection("Yard", gateway.url, "anna", auth="gone123"))
    plugin.window.actions.connect.trigger()
    assert any("gone123" in text and "Edit the connection" in text for text in iface.texts())


def menu_of(panel):
    button = panel.findChild(QToolButton, "fleet_connections_button")
    button.menu().aboutToShow.emit()
    return button.menu()


def test_a_connection_is_picked_in_the_panel_and_is_there_next_time(plugin, gateway, wait):
    from fleet_supervisor.plugin.panel.connection_panel import ConnectionPanel
    from fleet_supervisor.plugin.ui.actions import Actions

    for name, who in (("Yard", "anna"), ("Track", "bob")):
        Connections().store(GatewayConnection(name, gateway.url, who, f"/{name}.pem"))
    panel = plugin.window.dock.connection_panel
    menu_of(panel).findChild(QAction, "fleet_connection_Track").trigger()
    assert (panel.url(), panel.operator(), panel.credentials().ca_file) == (gateway.url, "bob", "/Track.pem")
    marked = [action.text() for action in menu_of(panel).actions() if action.isChecked()]
    assert marked == ["Track"]
    plugin.window.actions.connect.trigger()
    wait(lambda: gateway.requests_of("hello"))
    assert gateway.requests_of("hello")[0]["operator"] == "bob"
    again = ConnectionPanel(Actions(panel).connect)
    assert again.operator() == "bob"
    assert [action.text() for action in menu_of(again).actions() if action.isChecked()] == ["Track"]


def test_another_url_is_not_sent_the_connections_token(plugin, gateway, master_password):
    auth = TokenStore().write("", f"{TITLE}: Yard", gateway.url, SECRET, "anna")
    panel = plugin.window.dock.connection_panel
    panel.use(GatewayConnection("Yard", gateway.url, "anna", auth=auth))
    assert panel.credentials().token == SECRET
    QTest.keyClicks(panel.findChild(QLineEdit, "fleet_url"), "x")
    assert panel.credentials().token == ""


def test_what_stands_in_the_fields_is_kept_under_a_name(plugin, gateway, iface):
    panel = plugin.window.dock.connection_panel
    panel.findChild(QLineEdit, "fleet_url").setText(gateway.url)
    panel.findChild(QLineEdit, "fleet_operator").setText("anna")
    menu_of(panel).findChild(QAction, "fleet_keep_connection").trigger()
    dialog = iface.findChild(ConnectionDialog)
    fill(dialog, name="Yard")
    ok(dialog)
    assert Connections().get("Yard") == GatewayConnection("Yard", gateway.url, "anna")
    assert [action.text() for action in menu_of(panel).actions() if action.isChecked()] == ["Yard"]


def test_export_and_import_hand_connections_on_without_tokens(widget, tmp_path, gateway):
    file = tmp_path / "gateways.json"
    kept = GatewayConnection("Yard", gateway.url, "anna", "/ca.pem", "abc1234")
    Connections().store(kept)
    Connections().store(GatewayConnection("Track", gateway.url))
    widget.show_all()
    widget.write_file(str(file))
    assert [one["name"] for one in json.loads(file.read_text())["connections"]] == ["Track", "Yard"]
    assert "abc1234" not in file.read_text()
    Connections().remove("Track")
    widget.read_file(str(file))
    assert listed(widget) == ["Track", "Yard"]
    assert "2 connections" in verdict(widget) and "Replaced: 1." in verdict(widget)
    assert Connections().get("Yard") == kept


def test_one_connection_is_told_as_one(widget, tmp_path):
    Connections().store(GatewayConnection("Yard", "ws://127.0.0.1:8765/desk"))
    widget.show_all()
    for work in (widget.write_file, widget.read_file):
        work(str(tmp_path / "one.json"))
        assert "1 connection " in verdict(widget)


def test_only_what_is_selected_is_exported(widget, tmp_path):
    for name in ("Track", "Yard"):
        Connections().store(GatewayConnection(name, "ws://127.0.0.1:8765/desk"))
    widget.show_all("Yard")
    widget.write_file(str(tmp_path / "one.json"))
    assert [one["name"] for one in json.loads((tmp_path / "one.json").read_text())["connections"]] == ["Yard"]


def test_a_file_that_is_none_changes_nothing_and_says_so(widget, tmp_path):
    Connections().store(GatewayConnection("Yard", "ws://127.0.0.1:8765/desk"))
    (tmp_path / "other.json").write_text("{}")
    for file, says in (("other.json", "holds no connections"), ("none.json", "cannot be read")):
        widget.read_file(str(tmp_path / file))
        assert says in verdict(widget)
    assert Connections().names() == ["Yard"]


def test_removing_takes_what_is_selected_and_leaves_the_rest(widget):
    for name in ("Track", "Yard"):
        Connections().store(GatewayConnection(name, "ws://127.0.0.1:8765/desk"))
    widget.show_all()
    assert not widget.findChild(QPushButton, "fleet_connections_remove").isEnabled()
    take(widget, "Track")
    press(widget, "fleet_connections_remove")
    assert listed(widget) == ["Yard"]
    assert Connections().names() == ["Yard"]


def test_closing_while_a_test_hangs_leaves_no_thread(iface, gateway, wait):
    gateway.mute.add("hello")
    dialog = ConnectionDialog(GatewayConnection("Yard", gateway.url, "anna"), Connections(), iface)
    dialog.open()
    press(dialog, "fleet_connection_test")
    wait(lambda: gateway.requests_of("hello"))
    trial = dialog._trial._connection
    dialog.reject()
    assert not trial.is_open and not trial.is_ending
    QApplication.processEvents()
