"""Ways of a plan that is cancelled end where they are, and are found whole when they are wanted again."""

from __future__ import annotations

import pytest
from fleet_supervisor.plugin.layers.roles import ROAD_CENTRELINE, set_role
from fleet_supervisor.plugin.planning import proposal as plan_ways
from fleet_supervisor.plugin.planning.plan_settings import PlanSettings
from fleet_supervisor.plugin.planning.proposal import PlanTravel
from fleet_supervisor.robot_bridge.core.assignment.job import STAY, AssignmentJob, ConeTarget, PlanRobot
from fleet_supervisor.robot_bridge.core.errors import AssignmentCancelledError
from fleet_supervisor.robot_bridge.core.sites.frame import SiteFrame
from qgis.core import QgsProject

E, N = 640000.0, 5193000.0
PHASES = {
    "roads": "read_centrelines",
    "network": "build_network",
    "router": "Router",
    "distances": "RoadTravel",
}
"""What comes one after the other, and who does it."""


@pytest.fixture
def ways(qgis_app, make_layer):
    """The ways of a plan along one road that goes round three sides of a square."""
    line = ", ".join(f"{E + x} {N + y}" for x, y in [(0, 0), (0, 100), (100, 100), (100, 0)])
    roads = make_layer("roads", "LineString", "", [(f"LINESTRING({line})",)], "EPSG:32633")
    project = QgsProject()
    project.addMapLayer(roads)
    set_role(roads, ROAD_CENTRELINE)
    return PlanTravel(project, SiteFrame("EPSG:32633", (E, N)), PlanSettings(on_roads=True, direct_m=5.0))


JOB = AssignmentJob((ConeTarget("far", 100.0, 0.0),), (PlanRobot("r", 0.0, 0.0, 1, aboard=1),), (), STAY)


@pytest.mark.parametrize("phase", PHASES)
def test_a_cancel_in_one_phase_lets_none_come_after_it(ways, monkeypatch, phase):
    entered = []

    def noted(name, work):
        def do(*given, **named):
            entered.append(name)
            return work(*given, **named)

        return do

    with monkeypatch.context() as patch:
        for name, function in PHASES.items():
            patch.setattr(plan_ways, function, noted(name, getattr(plan_ways, function)))
        with pytest.raises(AssignmentCancelledError):
            ways.travel_of(JOB, lambda: phase not in entered)
    names = list(PHASES)
    assert entered == names[: names.index(phase) + 1]
    # Whoever asks again gets the roads, and no straight lines for want of them.
    assert ways.travel_of(JOB, lambda: True).metres[0, 1] == pytest.approx(300.0)


def test_a_cancel_lets_no_more_paths_be_found(ways):
    wanted = [True]
    travel = ways.travel_of(JOB, lambda: wanted[0])
    assert travel.path(0, 1)[-1] == pytest.approx((100.0, 0.0))
    wanted[0] = False
    with pytest.raises(AssignmentCancelledError):
        travel.path(0, 1)
