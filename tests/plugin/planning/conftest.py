"""The panel of cone plans on a real window, against a gateway on a socket."""

from __future__ import annotations

import itertools
import time
from dataclasses import replace

import pytest
from fleet_supervisor.robot_bridge.core.assignment import solver
from qgis.PyQt.QtWidgets import QAction, QDockWidget

from tests.plugin.planning.panel_parts import GatewayPlans, put_cones, put_road, queue, submitted


@pytest.fixture
def plans(gateway):
    return GatewayPlans(gateway)


@pytest.fixture
def panel(plans, at_desk, iface, wait):
    put_cones((40, 40), (45, 40), (50, 44), (75, 60), (80, 64), (85, 60))
    iface.findChild(QAction, "fleet_plan_panel").trigger()
    dock = iface.findChild(QDockWidget, "fleet_plan_dock")
    for robot in ("r1", "r2"):
        dock.drafts.settings = dock.drafts.settings.with_robot(
            robot, dock.drafts.settings.of_robot(robot).__class__(True, 8, 8, 1.0)
        )
    wait(lambda: dock.robots.model().rowCount() == 2, 5, "the robots in the panel")
    yield dock


@pytest.fixture
def endless(monkeypatch):
    """Called, it lets no stage be solved any more: six cones would be, before anybody can give up."""

    def stage(days, targets, start, aim, effort):
        for step in itertools.count(1):
            effort.progress.report(min(step / 1000, 1.0))
            time.sleep(0.01)

    return lambda: monkeypatch.setattr(solver, "solved_stage", stage)


@pytest.fixture
def under_way(panel, plans, gateway, wait):
    """A plan that both robots drive; each is at its first cone."""
    submitted(panel, plans, wait)
    for robot in ("r1", "r2"):
        gateway.tell("queue", queue(panel, robot, ["current", "waiting", "waiting"]))
    wait(lambda: len(panel._desk.state.queues) == 2, 5)
    return panel


@pytest.fixture
def far_cones(panel, gateway, wait):
    """Two roads lead from r1 to a cone far off: a short one along y = 40, and one round by y = 90."""
    put_road((45, 40), (60, 40))
    put_road((60, 40), (200, 40))
    put_road((45, 40), (45, 90), (200, 90), (200, 40))
    layer = put_cones((200, 41), layout="far")
    layer.selectByExpression("\"layout\" = 'far'")
    panel.form.selected_only.setChecked(True)
    settings = panel.drafts.settings
    panel.drafts.settings = settings.with_robot("r2", replace(settings.of_robot("r2"), used=False))
    return panel
