"""What an operator does on the sample site, and what becomes of it."""

from __future__ import annotations

import math
import signal
import threading
from functools import partial

from fleet_supervisor.robot_bridge.core.messages.commands import CommandState
from qgis.core import QgsProject
from qgis.PyQt.QtCore import QRegularExpression, Qt
from qgis.PyQt.QtTest import QTest
from qgis.PyQt.QtWidgets import QAction, QDockWidget, QToolBar

TOLERANCE = 0.20
LIFE = ["queued", "delivered", "acknowledged", "reached"]


def off(report, x, y):
    return math.hypot(report.x - x, report.y - y)


def test_clicked_cone_targets_are_reached_over_websocket_and_over_sql(loop, operator):
    loop.start_robot("r1", (20, 8, 0))
    loop.start_robot("r2", (20, 84, 0), sql=True)
    operator.connect_to(loop, ["r1", "r2"])
    targets = {"r1": (32.0, 10.0), "r2": (30.0, 84.0)}
    for robot, place in targets.items():
        operator.set_cone(robot, *place)
    for robot in targets:
        command = operator.wait_for_state(robot, "SetPath", CommandState.REACHED)
        assert [step.state.value for step in command.steps] == LIFE
        assert [step.by for step in command.steps] == ["anna", "gateway", robot, "gateway"]
        assert command.params["cone"] is True
        assert command.deviation <= TOLERANCE
        # The click lands within half a pixel of the place, and the robot within the tolerance of the click.
        pixel = operator.canvas.mapUnitsPerPixel()
        goal = command.params["points"][-1]
        assert math.dist(goal, targets[robot]) <= pixel

        # Positions come at the next tick of the desk, after the step.
        def is_there(robot=robot, goal=goal):
            return off(operator.report(robot), *goal) <= TOLERANCE

        operator.wait(f"{robot} at its cone", is_there, 10)


def test_abort_stops_a_driving_robot(loop, operator):
    loop.start_robot("r1", (20, 8, 0))
    operator.connect_to(loop, ["r1"])
    operator.set_cone("r1", 110.0, 8.0)
    operator.wait("r1 driving", lambda: (operator.report("r1").v or 0) > 1.0, 20)
    operator.press("fleet_abort")
    ended = operator.wait_for_state("r1", "SetPath", CommandState.ABORTED)
    operator.wait_for_state("r1", "Abort", CommandState.REACHED)
    assert ended.steps[-1].by == "anna"
    operator.wait("the desk seeing r1 stand", lambda: operator.report("r1").v < 0.05, 5)
    stood = operator.report("r1")
    assert stood.x < 100
    QTest.qWait(1500)
    assert off(operator.report("r1"), stood.x, stood.y) < 0.1


def test_abort_all_stops_every_robot(loop, operator):
    loop.start_robot("r1", (20, 8, 0))
    loop.start_robot("r2", (20, 84, 0), sql=True)
    operator.connect_to(loop, ["r1", "r2"])
    operator.set_cone("r1", 110.0, 8.0)
    operator.set_cone("r2", 110.0, 84.0)
    for robot in ("r1", "r2"):
        operator.wait(f"{robot} driving", lambda robot=robot: (operator.report(robot).v or 0) > 1.0, 20)
    operator.press("fleet_abort_all")
    for robot in ("r1", "r2"):
        operator.wait_for_state(robot, "Abort", CommandState.REACHED)
        operator.wait_for_state(robot, "SetPath", CommandState.ABORTED)
        operator.wait(f"the desk seeing {robot} stand", lambda r=robot: operator.report(r).v < 0.05, 5)


def test_a_drawn_route_is_driven_to_its_end(loop, operator):
    loop.start_robot("r1", (20, 8, 0), speed=5)
    operator.connect_to(loop, ["r1"])
    operator.select("r1")
    operator.choose("fleet_draw_route")
    for place in ((24, 8), (30, 10), (36, 8)):
        operator.click_site(*place)
    operator.press("fleet_send")
    command = operator.wait_for_state("r1", "SetPath", CommandState.REACHED)
    assert len(command.params["points"]) == 3
    assert off(operator.report("r1"), *command.params["points"][-1]) <= TOLERANCE


def test_a_killed_gateway_ages_the_robots_and_its_return_repeats_nothing(impatient_loop, operator):
    loop = impatient_loop
    loop.start_robot("r1", (20, 8, 0), speed=5)
    operator.connect_to(loop, ["r1"])
    operator.set_cone("r1", 60.0, 8.0)
    operator.wait_for_state("r1", "SetPath", CommandState.ACKNOWLEDGED)
    loop.gateway.send_signal(signal.SIGKILL)
    loop.gateway.wait()
    operator.wait("r1 turning stale", lambda: operator.states()["r1"] == "stale", 10)
    operator.wait("r1 turning lost", lambda: operator.states()["r1"] == "lost", 15)
    loop.start_gateway(loop.port)
    operator.wait("r1 coming back", lambda: operator.states()["r1"] == "fresh", 30)
    command = operator.wait_for_state("r1", "SetPath", CommandState.REACHED)
    assert len(operator.sent_to("r1")) == 1
    # The gateway tells first where r1 was before it was killed.
    goal = command.params["points"][-1]
    at = partial(operator.report, "r1")
    operator.wait("r1 at its goal", lambda: at().x is not None and off(at(), *goal) <= TOLERANCE, 10)


def test_a_target_outside_the_site_sends_nothing(loop, operator):
    loop.start_robot("r1", (20, 8, 0))
    operator.connect_to(loop, ["r1"])
    operator.show_site(margin=100)
    operator.select("r1")
    operator.choose("fleet_cone_target")
    operator.click_site(-40.0, 8.0)
    QTest.keyClick(operator.canvas, Qt.Key.Key_Return)
    QTest.qWait(500)
    assert operator.sent_to("r1") == []


def test_unload_takes_everything_out_while_robots_drive(loop, operator, plugin, iface):
    threads = threading.active_count()
    loop.start_robot("r1", (20, 8, 0))
    operator.connect_to(loop, ["r1"])
    operator.set_cone("r1", 60.0, 8.0)
    operator.wait_for_state("r1", "SetPath", CommandState.ACKNOWLEDGED)
    items = len(iface.canvas.scene().items())
    plugin.unload()
    QTest.qWait(100)
    for kind in (QDockWidget, QToolBar, QAction):
        assert [part.objectName() for part in iface.findChildren(kind, QRegularExpression("^fleet"))] == []
    assert QgsProject.instance().mapLayers() == {}
    assert QgsProject.instance().layerTreeRoot().findGroup("Fleet") is None
    assert len(iface.canvas.scene().items()) < items
    assert threading.active_count() <= threads
