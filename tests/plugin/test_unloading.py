"""Nothing is left when the plugin goes, and all of it has a name while it is there."""

from __future__ import annotations

import threading
import time

import pytest
from fleet_supervisor.plugin.control.fleet_controller import FleetController
from fleet_supervisor.plugin.gateway_client.connection_status import ConnectionPhase
from fleet_supervisor.plugin.plugin import FleetPlugin
from qgis.core import Qgis, QgsApplication, QgsProject, QgsVectorLayer
from qgis.PyQt.QtCore import QEvent
from qgis.PyQt.QtWidgets import QAction, QApplication, QDialog, QLineEdit, QPushButton

from tests.support.left_behind import connected_to, left_behind

PANELS = ("fleet_plan_panel", "fleet_observations", "fleet_replay")


@pytest.fixture(scope="module")
def registered_provider():
    """None: each plugin here registers its own."""


def connected(iface, gateway, wait):
    """Return the plugin, loaded and with one robot seen."""
    plugin = FleetPlugin(iface)
    plugin.initGui()
    plugin.window.dock.findChild(QLineEdit, "fleet_url").setText(gateway.url)
    plugin.window.actions.connect.trigger()
    wait(lambda: len(plugin.window.desk.state.robots) == 1)
    return plugin


def test_unloading_leaves_nothing_twice(iface, gateway, make_robot, wait):
    gateway.show(make_robot("r1"))
    before = left_behind(iface)
    before_tool = iface.canvas.mapTool()
    for _ in range(2):
        plugin = connected(iface, gateway, wait)
        window = plugin.window
        window.desk.selection.select("r1")
        window.actions.cone.trigger()
        iface.click(60, 50)
        window.desk.abort_all()
        window.notices.error("Something")
        wait(lambda window=window: window.view.layer.layer.featureCount() == 1, 3)
        during = left_behind(iface)
        assert [kind for kind in before if during[kind] <= before[kind]] == []
        began = time.monotonic()
        plugin.unload()
        assert time.monotonic() - began < 20
        assert plugin.window is None
        assert left_behind(iface) == before
    assert iface.canvas.mapTool() is before_tool


@pytest.mark.parametrize("part", ["checks.stop", "_rules.remove"])
def test_a_part_of_the_desk_that_fails_at_its_end_keeps_no_other_from_ending(iface, gateway, wait, part):
    desk = FleetController(iface.canvas, QgsProject.instance())
    desk.open_link(gateway.url, "anna")
    wait(lambda: desk.state.link.phase is ConnectionPhase.CONNECTED, what="the link")
    owner, name = part.split(".")
    end = getattr(getattr(desk, owner), name)

    def fail():
        end()
        raise RuntimeError("stands in the way")

    setattr(getattr(desk, owner), name, fail)
    with pytest.raises(RuntimeError, match="stands in the way"):
        desk.shut_down()
    assert not desk.connection.is_open and not desk.connection.is_ending


def test_no_dialog_outlives_the_plugin(iface, gateway, make_robot, wait):
    """Each asks about what nobody would do any more."""
    gateway.show(make_robot("r1"))
    plugin = connected(iface, gateway, wait)
    window = plugin.window
    window.desk.emergency_stop()
    wait(lambda: window.desk.state.emergency.in_force, what="the stop")
    window.actions.clear_emergency.trigger()
    window.actions.closures.trigger()
    iface.click(60, 50)
    window.actions.route_preferences.trigger()
    menu = window.dock.connection_panel.menu
    menu.fill()
    for name in ("fleet_keep_connection", "fleet_manage_connections"):
        menu.menu.findChild(QAction, name).trigger()
    window.dock.findChild(QPushButton, "fleet_alarm_limits").click()
    opened = [one for one in iface.findChildren(QDialog) if one.isVisible()]
    assert len(opened) == 6
    ended = []
    for dialog in opened:
        dialog.finished.connect(lambda _, dialog=dialog: ended.append(dialog))
    # It has ended, and is deleted later.
    opened[0].reject()
    plugin.unload()
    assert len(ended) == len(opened) and all(one in ended for one in opened)
    assert [one.objectName() for one in opened if one.isVisible()] == []
    QApplication.sendPostedEvents(None, QEvent.Type.DeferredDelete)
    assert iface.findChildren(QDialog) == []
    assert gateway.requests_of("close_road") == gateway.requests_of("clear_emergency_stop") == []


def test_what_is_not_answered_when_the_plugin_goes_stands_in_qgis_log(iface, gateway, make_robot, wait):
    gateway.show(make_robot("r1"))
    gateway.mute.add("abort_all")
    plugin = connected(iface, gateway, wait)
    plugin.window.desk.abort_all()
    wait(lambda: gateway.requests_of("abort_all"), 3)
    logged = []
    log = QgsApplication.messageLog().messageReceived[str, str, Qgis.MessageLevel]
    log.connect(note := lambda text, *_: logged.append(text))
    plugin.unload()
    log.disconnect(note)
    assert "Closed before the gateway answered, so it may be done or not: ABORT ALL" in logged


def test_qgis_keeps_no_connection_to_what_was_unloaded(iface, gateway, make_robot, wait):
    """Each reload would leave some more, for as long as QGIS runs."""
    lasting = (
        iface,
        iface.canvas,
        iface.bar,
        iface.locator,
        QgsProject.instance(),
        QgsApplication.instance(),
    )
    gateway.show(make_robot("r1"))
    after = []
    # Qt and QGIS connect some of their own for the first time.
    for _ in range(2):
        plugin = connected(iface, gateway, wait)
        for action in iface.plugins.actions():
            if action.objectName() in PANELS:
                action.trigger()
        during = connected_to(*lasting)
        plugin.unload()
        after.append(connected_to(*lasting))
    assert during["QgsProject.readProject"] > after[0]["QgsProject.readProject"]
    assert after[1] - after[0] == {}


def test_unloading_while_a_gateway_hangs_does_not_hang(iface, gateway, wait):
    plugin = FleetPlugin(iface)
    plugin.initGui()
    plugin.window.dock.findChild(QLineEdit, "fleet_url").setText(gateway.url)
    plugin.window.actions.connect.trigger()
    wait(lambda: plugin.window.desk.state.site is not None)
    release = threading.Event()
    gateway._loop.call_soon_threadsafe(release.wait)
    began = time.monotonic()
    plugin.unload()
    took = time.monotonic() - began
    release.set()
    assert took < 20


def test_a_group_with_layers_of_the_users_own_is_left_to_the_user(iface, plugin, gateway, wait):
    window = plugin.window
    window.dock.findChild(QLineEdit, "fleet_url").setText(gateway.url)
    window.actions.connect.trigger()
    wait(lambda: window.view.layer.layer is not None)
    own = QgsVectorLayer("Point?crs=EPSG:32633", "mine", "memory")
    QgsProject.instance().addMapLayer(own, False)
    QgsProject.instance().layerTreeRoot().findGroup("Fleet").addLayer(own)
    plugin.unload()
    assert [layer.name() for layer in QgsProject.instance().mapLayers().values()] == ["mine"]
    assert QgsProject.instance().layerTreeRoot().findGroup("Fleet") is not None


def test_unloading_twice_or_before_loading_does_no_harm(iface):
    plugin = FleetPlugin(iface)
    plugin.unload()
    plugin.initGui()
    plugin.unload()
    plugin.unload()


def test_without_a_window_only_processing_is_loaded():
    before = len(QgsApplication.processingRegistry().providers())
    plugin = FleetPlugin(None)
    plugin.initGui()
    assert plugin.window is None
    assert len(QgsApplication.processingRegistry().providers()) == before + 1
    plugin.unload()
    assert len(QgsApplication.processingRegistry().providers()) == before


def test_scripts_find_every_action_and_button_by_its_name(plugin, iface):
    names = [
        "connect",
        "cone_target",
        "draw_route",
        "send",
        "cancel",
        "select",
        "follow",
        "abort",
        "abort_all",
        "panel",
    ]
    assert all(iface.findChild(QAction, f"fleet_{name}") is not None for name in names)
