"""The panels of cone plans, observations and replay have their parts only once they are needed."""

from __future__ import annotations

import time

import pytest
from fleet_supervisor.plugin.plugin import FleetPlugin
from qgis.core import QgsProject
from qgis.PyQt.QtWidgets import QAction, QApplication, QDialog, QDockWidget

from tests.plugin.conftest import let_deleted_go
from tests.plugin.planning.panel_parts import (
    ABOARD,
    LOST_R1,
    GatewayPlans,
    hung,
    put_cones,
    submitted,
    write,
)

PANELS = {
    "fleet_plan_panel": "fleet_plan_dock",
    "fleet_observations": "fleet_observation_dock",
    "fleet_replay": "fleet_replay_dock",
}
NAMES = list(PANELS.values())
WINDOWS = {
    "fleet_accounts": "fleet_accounts_dialog",
    "fleet_site_choice": "fleet_sites_dialog",
    "fleet_recordings": "fleet_recordings_dialog",
}
"""By the actions that open them."""


def dock_of(iface, name):
    return iface.findChild(QDockWidget, name)


def layers():
    return {layer.name() for layer in QgsProject.instance().mapLayers().values()}


def test_at_the_start_and_connected_none_has_its_parts(at_desk, iface):
    assert [dock_of(iface, name).widget() for name in NAMES] == [None, None, None]
    # QGIS lists them for its menu of panels all the same.
    titles = [dock_of(iface, name).toggleViewAction().text() for name in NAMES]
    assert titles == ["Cone plan", "Observations", "Replay"]


def test_at_the_start_and_connected_no_window_of_supervisors_is_made(at_desk, iface):
    for action, window in WINDOWS.items():
        assert iface.findChild(QDialog, window) is None
        iface.findChild(QAction, action).trigger()
        assert iface.findChild(QDialog, window).isVisible()


@pytest.mark.parametrize(("action", "name"), PANELS.items())
def test_a_panel_that_was_open_in_the_last_session_is_there_again(iface, action, name):
    first = FleetPlugin(iface)
    first.initGui()
    iface.findChild(QAction, action).trigger()
    QApplication.processEvents()
    arrangement = iface.saveState()
    first.unload()
    let_deleted_go()
    again = FleetPlugin(iface)
    again.initGui()
    try:
        assert dock_of(iface, name).widget() is None
        # As QGIS does when it has loaded its plugins.
        assert iface.restoreState(arrangement)
        assert [one for one in NAMES if dock_of(iface, one).isVisible()] == [name]
        assert [one for one in NAMES if dock_of(iface, one).widget() is not None] == [name]
        assert iface.findChild(QAction, action).isChecked()
    finally:
        again.unload()


def test_qgis_menu_of_panels_opens_one_with_its_parts(plugin, iface):
    dock = dock_of(iface, "fleet_replay_dock")
    dock.toggleViewAction().trigger()
    assert dock.isVisible()
    assert dock.widget().isVisible()


def test_what_is_observed_before_the_panel_was_open_is_on_the_map_in_its_title_and_in_it(
    at_desk, gateway, iface, wait
):
    dock = dock_of(iface, "fleet_observation_dock")
    assert gateway.requests_of("get_observations")
    where = {"robot": "r1", "op": "SetObject", "object": "bin", "x": 60.0, "y": 50.0}
    seen = {"observation": 7, "state": "pending", "received_at": time.time(), **where}
    gateway.tell("observation", seen)
    wait(lambda: dock.windowTitle() == "Observations (1)", what="the number in the title")
    wait(lambda: "Observations" in layers(), what="the layer")
    assert dock.isHidden()
    iface.findChild(QAction, "fleet_observations").trigger()
    assert dock.model.rowCount() == 1


def test_a_plan_that_is_driven_is_on_the_map_and_says_what_is_wrong_before_the_panel_was_open(
    at_desk, plugin, gateway, iface, wait
):
    plans = GatewayPlans(gateway)
    put_cones((40, 40), (75, 60))
    iface.findChild(QAction, "fleet_plan_panel").trigger()
    panel = dock_of(iface, "fleet_plan_dock")
    wait(lambda: panel.robots.model().rowCount() == 2, what="the robots in the panel")
    for row in range(2):
        write(panel, row, ABOARD, "8")
    submitted(panel, plans, wait)
    on_the_map = layers()
    plugin.unload()
    let_deleted_go()
    assert layers() == {"Cones"}

    plans.newest["problems"] = LOST_R1
    again = FleetPlugin(iface)
    again.initGui()
    try:
        again.window.dock.connection_panel._url.setText(gateway.url)
        again.window.actions.connect.trigger()
        wait(lambda: layers() == on_the_map, what="the layers of the plan")
        assert len(hung(iface, "The cone plan cannot go on as it is")) == 1
        assert dock_of(iface, "fleet_plan_dock").isHidden()
    finally:
        again.unload()
