"""Keys of the plugin's actions, in QGIS's own list of shortcuts; Tab in its order."""

from __future__ import annotations

from fleet_supervisor.plugin.plugin import FleetPlugin
from fleet_supervisor.plugin.ui.actions import KEYS
from qgis.gui import QgsGui
from qgis.PyQt.QtCore import Qt
from qgis.PyQt.QtTest import QTest
from qgis.PyQt.QtWidgets import QApplication, QLineEdit


def test_keys_are_in_qgis_list_and_no_two_are_the_same(plugin):
    manager = QgsGui.shortcutsManager()
    for action in plugin.window.actions.all():
        if action.objectName() in KEYS:
            assert manager.defaultKeySequence(action) == KEYS[action.objectName()]
            assert action.shortcut().toString() == KEYS[action.objectName()]
    keys = [key.toString() for action in plugin.window.actions.all() for key in action.shortcuts()]
    assert len(keys) == len(set(keys))
    assert {"F10", "Pause"} <= set(keys)


def test_a_key_that_something_else_has_stays_with_it(iface):
    from qgis.PyQt.QtWidgets import QAction

    other = QAction("Something else", iface)
    QgsGui.shortcutsManager().registerAction(other, "F8")
    plugin = FleetPlugin(iface)
    plugin.initGui()
    try:
        assert plugin.window.actions.cone.shortcut().isEmpty()
        assert other.shortcut().toString() == "F8"
    finally:
        plugin.unload()
        QgsGui.shortcutsManager().unregisterAction(other)


def test_f8_takes_the_cone_tool_and_f9_hides_the_panel(plugin, iface):
    QTest.keyClick(iface, Qt.Key.Key_F8)
    assert plugin.window.actions.cone.isChecked()
    was_shown = not plugin.window.dock.isHidden()
    QTest.keyClick(iface, Qt.Key.Key_F9)
    assert (not plugin.window.dock.isHidden()) is not was_shown


def test_f9_opens_the_panel_with_the_keyboard_in_its_robots(plugin, iface, wait):
    dock = plugin.window.dock
    dock.hide()
    iface.activateWindow()
    QTest.keyClick(iface, Qt.Key.Key_F9)
    wait(lambda: not dock.isHidden() and dock.table.hasFocus(), what="the keyboard in the table of robots")


def test_tab_leads_through_the_connection_in_its_order(plugin, iface):
    panel = plugin.window.dock.connection_panel
    plugin.window.dock.show()
    iface.activateWindow()
    panel.findChild(QLineEdit, "fleet_url").setFocus()
    names = []
    for _ in range(4):
        QTest.keyClick(QApplication.focusWidget(), Qt.Key.Key_Tab)
        names.append(QApplication.focusWidget().objectName())
    order = ["access_button", "operator", "connect_button", "connections_button"]
    assert names == [f"fleet_{name}" for name in order]
