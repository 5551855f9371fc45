"""The real loop: a gateway process, robots as processes of their own, and the plugin on a QGIS canvas."""

from __future__ import annotations

import math
import signal
import sys
import threading

import pytest
from fleet_supervisor.robot_bridge.messages import CommandState
from inside_qgis.operator_at_desk import OperatorAtDesk
from qgis.core import QgsProject
from qgis.PyQt.QtCore import QRegularExpression, Qt
from qgis.PyQt.QtTest import QTest
from qgis.PyQt.QtWidgets import QAction, QDockWidget, QToolBar
from stage.processes import Processes

CRS = "EPSG:32633"
TOLERANCE = 0.20
LIFE = ["queued", "delivered", "acknowledged", "reached"]


class Loop:
    """One gateway and its robots, and the desk that looks at them."""

    def __init__(self, processes, root, folder):
        self._processes = processes
        self._site = root / "resources" / "sample_site"
        self._database = f"sqlite:///{folder / 'fleet.db'}"
        self.address = ""
        self._runs = 0

    def start_gateway(self, port=0):
        self._runs += 1
        options = ["--site", self._site, "--port", str(port), "--database", self._database]
        self.gateway = self._processes.start(
            f"gateway-{self._runs}", [sys.executable, "-m", "robot_bridge", "serve", *options]
        )
        found = self._processes.wait_for_line(f"gateway-{self._runs}", r"listening on (ws://\S+:(\d+))", 30)
        self.address, self.port = found.group(1), int(found.group(2))

    def start_robot(self, name, pose, *, sql=False):
        way = ["--database", self._database] if sql else ["--url", f"{self.address}/robot"]
        where = ",".join(str(number) for number in pose)
        options = ["--name", name, f"--pose={where}", "--speed", "2.5", "--rate", "10"]
        return self._processes.start(name, [sys.executable, "-m", "robot_bridge", "robot", *way, *options])


@pytest.fixture
def loop(tmp_path, root):
    with Processes(tmp_path / "logs") as processes:
        running = Loop(processes, root, tmp_path)
        running.start_gateway()
        yield running


class Operator(OperatorAtDesk):
    """The demonstration's operator, who also reads what the desk knows to the millimetre."""

    def __init__(self, plugin, iface):
        super().__init__(iface)
        self.desk = plugin.window.desk
        self._reports = {}
        self.desk.commands_changed.connect(self._note)

    def _note(self, reports):
        self._reports.update({report.command: report for report in reports})

    def connect_to(self, loop, robots):
        """Connect, wait for the robots, and look at the whole site."""
        self.connect(f"{loop.address}/desk", "anna")
        self.wait(f"seeing {robots}", lambda: set(self.states()) == set(robots), 15)
        self.show_site()

    def show_site(self, margin=0.0):
        x_min, y_min, x_max, y_max = self.desk.site.bounds
        e, n = self.desk.site.origin
        self.show_map((e + x_min - margin, n + y_min - margin, e + x_max + margin, n + y_max + margin), CRS)

    def report(self, robot):
        return self.desk.picture.view(robot, self.desk.clock()).report

    def states(self):
        return {view.name: view.state.value for view in self.desk.picture.views(self.desk.clock())}

    def click_site(self, x, y):
        e, n = self.desk.site.origin
        self.click_map(e + x, n + y, CRS)

    def set_cone(self, robot, x, y):
        self.select(robot)
        self.choose("fleet_cone_target")
        self.click_site(x, y)
        self.press("fleet_send")

    def sent_to(self, robot):
        return [command for command in self._reports.values() if command.robot == robot]

    def wait_for_state(self, robot, op, state, seconds=40):
        def now():
            return [c for c in self.sent_to(robot) if c.op == op and c.state is state]

        self.wait(f"{op} of {robot} being {state.value}", now, seconds)
        return now()[0]


@pytest.fixture
def operator(plugin, iface):
    return Operator(plugin, iface)


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
        command = operator.wait_for_state(robot, "SetPosEnd", CommandState.REACHED)
        assert [step.state.value for step in command.steps] == LIFE
        assert [step.by for step in command.steps] == ["anna", "gateway", robot, "gateway"]
        assert command.params["cone"] is True
        assert command.deviation <= TOLERANCE
        # The click lands within half a pixel of the place, and the robot within the tolerance of the click.
        pixel = operator.canvas.mapUnitsPerPixel()
        assert off(operator.report(robot), *targets[robot]) <= TOLERANCE + pixel
        goal = command.params["x"], command.params["y"]
        assert off(operator.report(robot), *goal) <= TOLERANCE


def test_abort_stops_a_driving_robot(loop, operator):
    loop.start_robot("r1", (20, 8, 0))
    operator.connect_to(loop, ["r1"])
    operator.set_cone("r1", 110.0, 8.0)
    operator.wait("r1 driving", lambda: (operator.report("r1").v or 0) > 1.0, 20)
    operator.press("fleet_abort")
    ended = operator.wait_for_state("r1", "SetPosEnd", CommandState.ABORTED)
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
        operator.wait_for_state(robot, "SetPosEnd", CommandState.ABORTED)
        operator.wait(f"the desk seeing {robot} stand", lambda r=robot: operator.report(r).v < 0.05, 5)


def test_a_drawn_route_is_driven_to_its_end(loop, operator):
    loop.start_robot("r1", (20, 8, 0))
    operator.connect_to(loop, ["r1"])
    operator.select("r1")
    operator.choose("fleet_draw_route")
    for place in ((24, 8), (30, 10), (36, 8)):
        operator.click_site(*place)
    operator.press("fleet_send")
    command = operator.wait_for_state("r1", "SetPath", CommandState.REACHED)
    assert len(command.params["points"]) == 3
    assert off(operator.report("r1"), *command.params["points"][-1]) <= TOLERANCE


def test_a_killed_gateway_ages_the_robots_and_its_return_repeats_nothing(loop, operator):
    loop.start_robot("r1", (20, 8, 0))
    operator.connect_to(loop, ["r1"])
    operator.set_cone("r1", 60.0, 8.0)
    operator.wait_for_state("r1", "SetPosEnd", CommandState.ACKNOWLEDGED)
    loop.gateway.send_signal(signal.SIGKILL)
    loop.gateway.wait()
    operator.wait("r1 turning stale", lambda: operator.states()["r1"] == "stale", 10)
    operator.wait("r1 turning lost", lambda: operator.states()["r1"] == "lost", 15)
    loop.start_gateway(loop.port)
    operator.wait("r1 coming back", lambda: operator.states()["r1"] == "fresh", 30)
    command = operator.wait_for_state("r1", "SetPosEnd", CommandState.REACHED)
    assert len(operator.sent_to("r1")) == 1
    assert off(operator.report("r1"), command.params["x"], command.params["y"]) <= TOLERANCE


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
    operator.wait_for_state("r1", "SetPosEnd", CommandState.ACKNOWLEDGED)
    items = len(iface.canvas.scene().items())
    plugin.unload()
    QTest.qWait(100)
    for kind in (QDockWidget, QToolBar, QAction):
        assert [part.objectName() for part in iface.findChildren(kind, QRegularExpression("^fleet"))] == []
    assert QgsProject.instance().mapLayers() == {}
    assert QgsProject.instance().layerTreeRoot().findGroup("Fleet") is None
    assert len(iface.canvas.scene().items()) < items
    assert threading.active_count() <= threads
