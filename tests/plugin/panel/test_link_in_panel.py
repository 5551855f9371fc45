"""Connecting and disconnecting in the panel, and what it says of a link that goes."""

from __future__ import annotations

from qgis.core import QgsSettings
from qgis.PyQt.QtCore import Qt
from qgis.PyQt.QtTest import QTest
from qgis.PyQt.QtWidgets import QLabel, QLineEdit, QToolButton, QWidget

from tests.support.fleet_panel import press, state_line, table


def test_typing_an_address_and_pressing_connect_shows_the_site(plugin, gateway, wait):
    window = plugin.window
    for name, text in (("fleet_url", gateway.url), ("fleet_operator", "anna")):
        field = window.dock.findChild(QLineEdit, name)
        field.selectAll()
        QTest.keyClicks(field, text)
    press(window, QToolButton, "fleet_connect_button")
    wait(lambda: "Yard" in state_line(window), what="the site's name")
    assert gateway.requests_of("hello") == [{"operator": "anna", "protocol": 1}]


def test_enter_in_any_field_of_the_gateway_connects(plugin, gateway, wait):
    panel = plugin.window.dock.connection_panel
    panel.findChild(QLineEdit, "fleet_url").setText(gateway.url)
    panel.findChild(QLineEdit, "fleet_operator").setText("anna")
    for name in ("fleet_url", "fleet_operator", "fleet_token", "fleet_ca_file"):
        found = panel.findChild(QWidget, name)
        QTest.keyClick(found if isinstance(found, QLineEdit) else found.lineEdit(), Qt.Key.Key_Return)
        wait(lambda: "Yard" in state_line(plugin.window), what=f"the site's name, by {name}")
        plugin.window.actions.connect.trigger()
        wait(lambda: "Yard" not in state_line(plugin.window), what="the end of the link")


def test_while_there_is_a_link_the_fields_make_room_for_the_robots(plugin, gateway, wait):
    dock = plugin.window.dock
    url, operator = (dock.findChild(QLineEdit, name) for name in ("fleet_url", "fleet_operator"))
    dock.show()
    dock.activateWindow()
    url.setText(gateway.url)
    operator.setText("anna")
    url.setFocus()
    wait(url.hasFocus, what="the keyboard in the field")
    QTest.keyClick(url, Qt.Key.Key_Return)
    wait(lambda: "Yard" in state_line(plugin.window), what="the site's name")
    assert not url.isVisible() and not operator.isVisible()
    # A space in a button that has the keyboard would press it, and end the link.
    button = dock.findChild(QToolButton, "fleet_connect_button")
    assert button.isVisible() and not button.hasFocus()
    state = dock.findChild(QLabel, "fleet_link_state")
    assert state.toolTip().splitlines() == [gateway.url, "Yard", "EPSG:32633"]
    gateway.stop()
    wait(lambda: "Retrying" in state_line(plugin.window), 10)
    assert not url.isVisible()
    button.click()
    wait(url.isVisible, what="the fields of a link that was ended")
    assert url.text() == gateway.url


def test_url_and_operator_are_remembered(at_desk, gateway):
    assert QgsSettings().value("fleet_supervisor/url") == gateway.url
    assert QgsSettings().value("fleet_supervisor/operator") == "anna"


def test_the_default_is_a_gateway_on_this_computer(plugin):
    assert plugin.window.dock.connection_panel.url() == "ws://127.0.0.1:8765/desk"


def test_a_wrong_url_is_refused_in_words_and_the_button_comes_out_again(plugin, iface):
    window = plugin.window
    window.dock.findChild(QLineEdit, "fleet_url").setText("http://example.org")
    press(window, QToolButton, "fleet_connect_button")
    assert any("begins with http" in text for text in iface.texts())
    assert not window.actions.connect.isChecked()


def test_no_operator_is_refused_in_words(plugin, iface):
    window = plugin.window
    window.dock.findChild(QLineEdit, "fleet_operator").clear()
    press(window, QToolButton, "fleet_connect_button")
    assert any("operator's name is empty" in text for text in iface.texts())


def test_a_gateway_that_is_not_there_is_told_once_in_the_bar_and_always_in_the_panel(plugin, iface, wait):
    window = plugin.window
    window.dock.findChild(QLineEdit, "fleet_url").setText("ws://127.0.0.1:9/desk")
    window.actions.connect.trigger()
    wait(lambda: "Retrying" in state_line(window))
    assert "Nothing listens at 127.0.0.1:9" in state_line(window)
    QTest.qWait(2500)
    assert len([text for text in iface.texts() if "Nothing listens" in text]) == 1


def test_disconnecting_shows_it_and_the_robots_stay_and_age(at_desk, wait):
    press(at_desk, QToolButton, "fleet_connect_button")
    wait(lambda: "Not connected" in state_line(at_desk))
    assert len(table(at_desk)[1]) == 2
    first = at_desk.desk.state.robots.view("r1", at_desk.desk.clock.steady()).age
    QTest.qWait(200)
    assert at_desk.desk.state.robots.view("r1", at_desk.desk.clock.steady()).age > first + 0.15


def test_a_gateway_gone_in_mid_session_lets_robots_turn_stale_then_lost_and_comes_back(
    plugin, gateway, site, make_robot, wait
):
    import dataclasses

    gateway.site = dataclasses.replace(site, stale_after=0.5, lost_after=1.5)
    gateway.show(make_robot("r1"), make_robot("r2", stopped=True))
    window = plugin.window
    window.dock.findChild(QLineEdit, "fleet_url").setText(gateway.url)
    window.actions.connect.trigger()
    wait(lambda: len(window.desk.state.robots) == 2)
    gateway.stop()

    def states():
        return [row["State"] for row in table(window)[1]]

    wait(lambda: states() == ["stale", "stale"], 3, "stale")
    wait(lambda: states() == ["lost", "lost"], 3, "lost")
    layer = window.view.layer.layer
    wait(lambda: [f["state"] for f in layer.getFeatures()] == ["lost", "lost"], 3, "the layer")
    gateway.start()

    def fresh_again():
        gateway.show(make_robot("r1"))
        return states()[0] == "fresh"

    wait(fresh_again, 15, "the new link")
    assert "Connected" in state_line(window)
