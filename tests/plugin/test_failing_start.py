"""A plugin that does not start leaves QGIS as it was, and starts the next time."""

from __future__ import annotations

import pytest
from fleet_supervisor.plugin.control.fleet_controller import FleetController
from fleet_supervisor.plugin.locator import RobotLocator
from fleet_supervisor.plugin.map.overlay.fleet_overlay import HoverTracker
from fleet_supervisor.plugin.map.overlay.task_painter import QueueMarks
from fleet_supervisor.plugin.map.tools.drawing_tools import ConeTool
from fleet_supervisor.plugin.panel.queue import PauseActions
from fleet_supervisor.plugin.panel.window import WindowAlarms
from fleet_supervisor.plugin.plugin import FleetPlugin
from fleet_supervisor.plugin.tour.tour_panel import TourAction
from fleet_supervisor.plugin.ui.actions import MenuLetters
from qgis.core import QgsExpression

from tests.support.left_behind import left_behind


def state_of(iface):
    return {**left_behind(iface), "functions": len(QgsExpression.Functions())}


@pytest.mark.parametrize(
    "part", [FleetController, HoverTracker, PauseActions, WindowAlarms, RobotLocator, TourAction, MenuLetters]
)
def test_what_was_there_before_it_failed_is_taken_out(iface, monkeypatch, part):
    def fail(*_):
        raise RuntimeError("no such thing")

    before = state_of(iface)
    plugin = FleetPlugin(iface)
    with monkeypatch.context() as broken:
        broken.setattr(part, "__init__", fail)
        with pytest.raises(RuntimeError, match="no such thing"):
            plugin.initGui()
    assert plugin.window is None
    assert state_of(iface) == before
    plugin.initGui()
    assert plugin.window is not None
    plugin.unload()
    assert state_of(iface) == before


@pytest.mark.parametrize(
    ("part", "name"),
    [
        (RobotLocator, "remove"),
        (QueueMarks, "remove"),
        (FleetController, "shut_down"),
        (ConeTool, "deleteLater"),
    ],
)
def test_all_the_others_are_taken_out_where_one_part_fails_to_go(iface, monkeypatch, part, name):
    go = getattr(part, name)

    def fail(self):
        go(self)
        raise RuntimeError("it will not go")

    before = state_of(iface)
    plugin = FleetPlugin(iface)
    plugin.initGui()
    monkeypatch.setattr(part, name, fail)
    with pytest.raises(RuntimeError, match="it will not go"):
        plugin.unload()
    assert plugin.window is None
    assert state_of(iface) == before
