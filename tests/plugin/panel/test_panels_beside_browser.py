"""The panels of cone plans, observations and replay: where they open, and that keys go on in them."""

from __future__ import annotations

import pytest
from fleet_supervisor.plugin.plugin import FleetPlugin
from qgis.core import QgsSettings
from qgis.PyQt.QtCore import QSize, Qt
from qgis.PyQt.QtTest import QTest
from qgis.PyQt.QtWidgets import QApplication, QDockWidget, QWidget

CTRL, SHIFT, ALT = (
    Qt.KeyboardModifier.ControlModifier,
    Qt.KeyboardModifier.ShiftModifier,
    Qt.KeyboardModifier.AltModifier,
)
PANELS = [
    ("fleet_plan_dock", ALT, "fleet_plan_cones"),
    ("fleet_observation_dock", CTRL | SHIFT, "fleet_observation_list"),
    ("fleet_replay_dock", ALT | SHIFT, "fleet_replay_last"),
]


@pytest.fixture
def browser(iface):
    """QGIS's panel of files and services, at the left."""
    panel = QDockWidget("Browser", iface)
    panel.setObjectName("Browser")
    panel.setWidget(QWidget())
    iface.addDockWidget(Qt.DockWidgetArea.LeftDockWidgetArea, panel)
    iface.show()
    iface.activateWindow()
    return panel


@pytest.fixture
def loaded(browser, iface):
    """The plugin in a window that has a browser."""
    plugin = FleetPlugin(iface)
    plugin.initGui()
    yield plugin
    plugin.unload()
    QgsSettings().remove("UI/state")


@pytest.mark.parametrize(("name", "held", "first"), PANELS)
def test_its_key_opens_it_in_the_room_of_the_browser_and_keys_go_on_in_it(
    loaded, browser, iface, name, held, first
):
    dock = iface.findChild(QDockWidget, name)
    assert dock.isHidden()
    QTest.keyClick(iface, Qt.Key.Key_F12, held)
    QApplication.processEvents()
    assert dock in iface.tabifiedDockWidgets(browser)
    assert dock.isUserVisible()
    assert QApplication.focusWidget().objectName() == first
    QTest.keyClick(iface, Qt.Key.Key_F12, held)
    assert dock.isHidden()
    assert not browser.isHidden()


class LayerTree(QWidget):
    """As high as the layers of a project are many."""

    def sizeHint(self):
        return QSize(256, 2000)


@pytest.mark.parametrize(("name", "held", "first"), PANELS)
def test_above_the_layers_it_has_room_and_the_next_time_what_the_user_left_it(
    loaded, browser, iface, name, held, first
):
    layers = QDockWidget("Layers", iface)
    layers.setWidget(LayerTree())
    iface.addDockWidget(Qt.DockWidgetArea.LeftDockWidgetArea, layers)
    iface.resize(1280, 800)
    QApplication.processEvents()
    dock = iface.findChild(QDockWidget, name)
    QTest.keyClick(iface, Qt.Key.Key_F12, held)
    QApplication.processEvents()
    assert dock.height() > min(0.4 * iface.height(), dock.sizeHint().height() - 1)
    iface.resizeDocks([dock], [200], Qt.Orientation.Vertical)
    QApplication.processEvents()
    made = dock.height()
    for _ in ("closed", "opened again"):
        QTest.keyClick(iface, Qt.Key.Key_F12, held)
        QApplication.processEvents()
    assert dock.height() == made


def test_a_panel_that_qgis_has_put_where_it_was_stays_there(loaded, browser, iface):
    QgsSettings().setValue("UI/state", iface.saveState())
    QTest.keyClick(iface, Qt.Key.Key_F12, ALT)
    assert iface.tabifiedDockWidgets(browser) == []


def test_a_panel_that_was_dragged_away_is_not_fetched_back(loaded, browser, iface):
    dock = iface.findChild(QDockWidget, "fleet_plan_dock")
    QTest.keyClick(iface, Qt.Key.Key_F12, ALT)
    iface.addDockWidget(Qt.DockWidgetArea.RightDockWidgetArea, dock)
    for _ in ("closed", "opened again"):
        QTest.keyClick(iface, Qt.Key.Key_F12, ALT)
    assert dock.isUserVisible()
    assert iface.tabifiedDockWidgets(browser) == []


def test_a_browser_that_the_user_put_elsewhere_stays_alone(browser, iface):
    iface.addDockWidget(Qt.DockWidgetArea.RightDockWidgetArea, browser)
    plugin = FleetPlugin(iface)
    plugin.initGui()
    try:
        QTest.keyClick(iface, Qt.Key.Key_F12, ALT)
        assert iface.tabifiedDockWidgets(browser) == []
        dock = iface.findChild(QDockWidget, "fleet_plan_dock")
        assert iface.dockWidgetArea(dock) == Qt.DockWidgetArea.LeftDockWidgetArea
    finally:
        plugin.unload()
