"""A cone that a robot put down stays on the map."""

from __future__ import annotations

from fleet_supervisor.robot_bridge.core.messages.base import to_json
from fleet_supervisor.robot_bridge.core.messages.commands import CommandState
from fleet_supervisor.robot_bridge.core.messages.records import PlacementReport
from qgis.core import QgsProject

E, N = 488000.0, 5190000.0


def cones():
    """Return where cones stand on the map, metres from the site's origin, and who put them there."""
    found = QgsProject.instance().mapLayersByName("Cones put down")
    places = [(f.geometry().asPoint(), f["robot"]) for layer in found for f in layer.getFeatures()]
    return sorted((round(p.x() - E, 2), round(p.y() - N, 2), robot) for p, robot in places)


def reach(gateway, command, x, y, cone=True, along=None):
    end = ("SetPath", {"points": [*along, (x, y)]}) if along else ("SetPosEnd", {"x": x, "y": y})
    gateway._queue(command, "r1", end[0], {**end[1], "cone": cone})
    for state in (CommandState.DELIVERED, CommandState.ACKNOWLEDGED, CommandState.REACHED):
        gateway.step(command, state, "r1", deviation=0.1)


def placement(number, command, **more):
    return PlacementReport(
        placement=number, task="t", robot="r2", planned_x=30.0, planned_y=30.0, x=30.1, y=30.2, theta=0.0,
        deviation=0.2, placed_at=1_700_000_000.0, command=command, **more,
    )  # fmt: skip


def test_a_cone_target_that_was_reached_stays_and_a_plain_target_does_not(at_desk, gateway, wait):
    reach(gateway, "plain", 20.0, 20.0, cone=False)
    reach(gateway, "cone", 70.0, 55.0)
    wait(lambda: cones() == [(70.0, 55.0, "r1")], what="the cone")


def test_a_cone_at_the_end_of_a_path_stays_too_and_the_end_of_a_plain_path_does_not(at_desk, gateway, wait):
    reach(gateway, "plain", 20.0, 20.0, cone=False, along=[(10.0, 20.0)])
    reach(gateway, "collected", 25.0, 20.0, cone=None, along=[(10.0, 20.0)])
    reach(gateway, "cone", 70.0, 55.0, along=[(60.0, 55.0), (65.0, 55.0)])
    wait(lambda: cones() == [(70.0, 55.0, "r1")], what="the cone")


def test_a_cone_of_a_task_stands_where_it_was_put_until_it_is_collected(at_desk, gateway, wait):
    reach(gateway, "task-1", 30.0, 30.0)
    gateway.tell("placement", to_json(placement(1, "task-1")))
    wait(lambda: cones() == [(30.1, 30.2, "r2")], what="the cone where it stands")
    gateway.tell(
        "placement", to_json(placement(1, "task-1", collected_at=1_700_000_100.0, collected_by="r1"))
    )
    wait(lambda: cones() == [], what="the cone being gone")


def test_the_layer_goes_with_the_plugin(plugin, at_desk, gateway, wait):
    reach(gateway, "cone", 70.0, 55.0)
    wait(lambda: len(cones()) == 1, what="the cone")
    plugin.unload()
    assert QgsProject.instance().mapLayersByName("Cones put down") == []
