"""A real robot in a keepout and at an obstacle, stopped by a real gateway, on a real window."""

from __future__ import annotations

import shutil

import pytest
from fleet_supervisor.robot_bridge.core.messages.commands import CommandState, Send
from qgis.PyQt.QtWidgets import QLabel, QTableView

OVERRIDE = "the path enters the keepout; because: this is what is tried out"


@pytest.fixture
def fenced(start_loop, root, tmp_path):
    """A gateway that pauses robots in keepouts and aborts them at obstacles."""
    site = tmp_path / "site"
    shutil.copytree(root / "resources" / "sample_site", site, ignore=lambda *_: ["drawing", "__pycache__"])
    with (site / "site.toml").open("a") as file:
        file.write('\n[geofence]\nin_keepout = "pause"\nat_obstacle = "abort"\n')
    return start_loop(site)


def texts(operator):
    model = operator._window.findChild(QTableView, "fleet_alarms").model()
    return {model.index(row, 1).data(): model.index(row, 2).data() for row in range(model.rowCount())}


def drive(operator, robot, points):
    command = f"command-{robot}-{len(operator.sent_to(robot))}"
    path = {"points": [list(point) for point in points]}
    operator.desk.orders.ask(Send(command, robot, "SetPath", path, override=OVERRIDE), "a path")


def test_it_is_told_by_name_while_it_happens_and_gone_when_it_ends(fenced, operator):
    fenced.start_robot("r1", (66, 27, 1.57))
    fenced.start_robot("r2", (119, 70, 0))
    operator.connect_to(fenced, ["r1", "r2"])
    drive(operator, "r1", [(66, 27), (66, 38)])
    drive(operator, "r2", [(119, 70), (133, 70)])
    basin = "r1 is in the keepout Water basin: the gateway has paused it"
    tower = "r2 is at the obstacle Control tower: the gateway has aborted its task"
    operator.wait("both alarms", lambda: texts(operator) == {basin: "new", tower: "new"}, 20)
    (bar,) = operator.canvas.findChildren(QLabel, "fleet_alarm_text")
    operator.wait("the message", lambda: "2 alarms" in bar.text() and basin in bar.text(), 5)
    operator.wait_for_state("r1", "SetPath", CommandState.ABORTED)
    operator.wait_for_state("r2", "SetPath", CommandState.ABORTED)
    # Driven back out by an order of the operator's it is not stopped again.
    here = operator.report("r1")
    drive(operator, "r1", [(here.x, here.y), (66, 27)])
    operator.wait_for_state("r1", "SetPath", CommandState.REACHED)
    operator.wait("its end", lambda: texts(operator) == {basin: "over", tower: "new"}, 10)
