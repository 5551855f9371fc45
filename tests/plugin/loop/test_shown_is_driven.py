"""The way that is shown to a clicked cone is the one that is sent and driven, and leads through no keepout.

The sample site's keepout *Water basin* lies between (60, 22) and (70.26, 42.57).
"""

from __future__ import annotations

import math
import shutil
import signal

import pytest
from fleet_supervisor.plugin.control.pending_command import ApproachKind
from fleet_supervisor.robot_bridge.core.geometry import Polyline
from fleet_supervisor.robot_bridge.core.messages.commands import CommandState
from qgis.core import QgsProject
from qgis.PyQt.QtCore import QEvent
from qgis.PyQt.QtWidgets import QApplication, QLabel
from shapely.geometry import Point, Polygon

from tests.support.operators import ask
from tests.support.processes import freeze

POSE, GOAL = (60, 22, 0), (70.26, 42.57)
ANGLES = [math.tau * k / 48 for k in range(48)]
BASIN = Polygon([(66 + 9.0 * math.cos(a), 32.2 + 2.6 * math.sin(a)) for a in ANGLES])
"""Somewhat smaller than the keepout."""
CORRIDOR, TOLERANCE, MILLIMETRE = 0.6, 0.2, 0.001


@pytest.fixture
def on_site(loop, operator, root, iface):
    """A robot south of the basin, started as README does, and the site's project."""
    project = QgsProject.instance()
    assert project.read(str(root / "resources" / "sample_site" / "sample_site.qgz"))
    iface.canvas.setLayers([one for one in project.layerTreeRoot().layerOrder() if one.isSpatial()])

    def start(*more):
        loop.start_robot("r3", POSE, speed=6, more=more)
        operator.connect_to(loop, ["r3"], declare_paths="--no-path-cones" not in more)
        operator.wait("where r3 is", lambda: operator.report("r3").x is not None, 10)
        operator.select("r3")
        operator.choose("fleet_cone_target")
        operator.click_site(*GOAL)
        operator.wait("the way to the target", lambda: draft(operator).is_checked and knows_way(operator), 20)

    return start


def draft(operator):
    return operator.desk.drafts.draft


def knows_way(operator):
    return draft(operator).way.kind is not ApproachKind.SOUGHT


def told(operator):
    return operator.desk and operator.find(QLabel, "fleet_draft_text").text()


def standing_cones():
    return sum(layer.featureCount() for layer in QgsProject.instance().mapLayersByName("Cones put down"))


def watch(operator, robot):
    """Return every place at which the desk saw the robot until it had come to its end."""
    seen = []

    def ended():
        report = operator.report(robot)
        seen.append((report.x, report.y))
        states = [command.state for command in operator.sent_to(robot)]
        return states and states[-1] not in (
            CommandState.QUEUED,
            CommandState.DELIVERED,
            CommandState.ACKNOWLEDGED,
        )

    operator.wait(f"the end of what {robot} was sent", ended, 120)
    return seen


def test_a_clicked_cone_is_driven_to_by_the_way_that_was_shown(on_site, operator):
    on_site()
    drawn = draft(operator).outline
    assert len(drawn) > 50 and math.dist(drawn[0], POSE[:2]) < 0.1
    assert "along the roads" in told(operator)
    to_mouse = operator.canvas.mapTool()._way
    operator.wait("the way to the mouse", lambda: to_mouse.line, 10)
    QApplication.sendEvent(operator.canvas.viewport(), QEvent(QEvent.Type.Leave))
    assert to_mouse.line == []
    operator.press("fleet_send")
    seen = watch(operator, "r3")
    (command,) = operator.sent_to("r3")
    assert (command.op, command.params["cone"]) == ("SetPath", True)
    sent = [tuple(point) for point in command.params["points"]]
    assert len(sent) == len(drawn)
    assert max(map(math.dist, sent, drawn)) < MILLIMETRE
    line = Polyline(sent)
    assert max(line.feet(*place)[1].min() for place in seen) < CORRIDOR
    assert not any(BASIN.contains(Point(*place)) for place in seen)
    assert len(seen) > 20
    assert to_mouse.line == []
    assert command.state is CommandState.REACHED
    assert command.deviation <= TOLERANCE
    assert math.dist(seen[-1], sent[-1]) <= TOLERANCE + 0.05
    operator.wait("the cone staying on the map", lambda: standing_cones() == 1, 20)


def test_one_that_neither_asks_nor_takes_cones_with_a_path_is_shown_and_refused_straight(on_site, operator):
    # As any robot of the paper, which declares nothing.
    on_site("--no-ask-path", "--no-path-cones")
    way = draft(operator).way
    assert way.kind is ApproachKind.STRAIGHT
    assert math.dist(way.line[0], POSE[:2]) < 0.1 and math.dist(way.line[-1], GOAL) < 0.5
    assert "keepout Water basin" in told(operator)
    assert "drives straight" in " ".join(draft(operator).findings.warnings)
    operator.press("fleet_send")
    operator.pause(0.5)
    assert operator.sent_to("r3") == []


def test_a_target_that_was_not_answered_is_not_driven_to_at_a_gateway_of_another_frame(
    start_loop, operator, root, tmp_path
):
    sample, site = root / "resources" / "sample_site", tmp_path / "site"
    site.mkdir()
    for name in ("site.gpkg", "site.toml"):
        shutil.copy(sample / name, site)
    loop = start_loop(site)
    loop.start_robot("r3", POSE, speed=6)
    operator.connect_to(loop, ["r3"])
    operator.wait("where r3 is", lambda: operator.report("r3").x is not None, 10)
    operator.select("r3")
    operator.choose("fleet_cone_target")
    operator.click_site(*GOAL)
    operator.wait_for_draft("the target")
    operator.wait("the way to it", lambda: knows_way(operator) and draft(operator).is_checked, 20)
    freeze(loop.gateway.pid)
    asked = len(operator.desk.orders)
    operator.desk.sending.send()
    operator.wait("the order on its way", lambda: len(operator.desk.orders) == asked + 1, 10)
    loop.gateway.send_signal(signal.SIGKILL)
    loop.gateway.wait()
    settings = site / "site.toml"
    settings.write_text(settings.read_text().replace("640420.0", "640410.0"))
    loop.start_on_empty_database()
    operator.wait("the other frame", lambda: operator.desk.state.site.origin[0] == 640410.0, 30)
    operator.wait("r3 there", lambda: "r3" in operator.states(), 30)
    operator.wait("word of it", lambda: len(operator.desk.orders) == 0, 30)
    # What is asked now comes after all that was repeated on the new link.
    ask(loop.address, ("abort", {"command": "asked-afterwards", "robot": "r3"}))
    commands = ask(loop.address, ("get_commands", {}))[0]["commands"]
    assert {one["op"] for one in commands} == {"Abort"}
    assert draft(operator) is None
