"""From cones to robots: a double lane change, planned, sent, and placed by three robots of which one dies."""

from __future__ import annotations

import itertools
import json
import math
import signal
import sqlite3
from itertools import combinations

import numpy as np
import pytest
from fleet_supervisor.plugin.planning.layouts.layout_layer import MARK
from fleet_supervisor.plugin.planning.plan_settings import participating_robots
from fleet_supervisor.plugin.plugin import FleetPlugin
from fleet_supervisor.robot_bridge.core.layouts.catalogue import LAYOUTS
from fleet_supervisor.robot_bridge.core.messages.plans import PlanState
from fleet_supervisor.robot_bridge.core.messages.queues import TaskState
from qgis.core import QgsFeature, QgsGeometry, QgsPointXY, QgsProject, QgsVectorLayer
from qgis.PyQt.QtCore import Qt
from qgis.PyQt.QtTest import QTest
from qgis.PyQt.QtWidgets import (
    QAction,
    QApplication,
    QDialog,
    QDockWidget,
    QLineEdit,
    QMessageBox,
    QPushButton,
)
from websockets.sync.client import connect

from tests.plugin.conftest import let_deleted_go
from tests.plugin.loop.conftest import Operator

TOLERANCE = 0.20
ROBOT_WIDTH = 0.5
"""Metres; how wide the reference robot is taken to be (site.toml, [routes] robot_width_m)."""
CONE_BASE = 0.285
CLEAR = (ROBOT_WIDTH + CONE_BASE) / 2
"""Metres from its middle to a cone's, in which a robot does not touch it."""
JOINED = 1.0
"""Metres between two stored positions up to which the robot is taken to have driven straight."""
STARTS = {"r1": (24.0, 2.0, 0.0), "r2": (62.0, 2.0, 0.0), "r3": (104.0, 2.0, math.pi)}


class Planner:
    """The operator at the panel of cone plans."""

    def __init__(self, operator, plugin, iface):
        self.operator, self.plugin, self.iface = operator, plugin, iface
        iface.findChild(QAction, "fleet_plan_panel").trigger()
        self.dock = iface.findChild(QDockWidget, "fleet_plan_dock")

    def place_layout(self, name, dimensions, x, y):
        tool = next(part for part in self.plugin._parts if type(part).__name__ == "LayoutAction")
        tool.start_tool(LAYOUTS[name].of(dimensions))
        self.operator.click_site(x, y)
        layers = QgsProject.instance().mapLayers().values()
        return next(layer for layer in layers if layer.customProperty(MARK))

    def set_robots(self, carries, aboard, speed, count=3):
        robots = self.dock.robots.model()
        self.operator.wait("robots in the form", lambda: robots.rowCount() == count, 10)
        for row in range(robots.rowCount()):
            for column, value in enumerate((carries, aboard, speed), 1):
                robots.setData(robots.index(row, column), str(value))

    def press(self, name):
        button = self.dock.findChild(QPushButton, name)
        self.operator.wait(f"{name} being usable", lambda: button.isEnabled() and button.isVisible(), 20)
        QTest.mouseClick(button, Qt.MouseButton.LeftButton)

    def add_points(self, name, fields, rows):
        """Add a layer of points: rows are x and y in the site frame, and the values of ``fields``."""
        e, n = self.operator.desk.state.site.origin
        layer = QgsVectorLayer(f"Point?crs=EPSG:32633{fields}", name, "memory")
        features = []
        for x, y, *values in rows:
            feature = QgsFeature(layer.fields())
            feature.setAttributes(values)
            feature.setGeometry(QgsGeometry.fromPointXY(QgsPointXY(e + x, n + y)))
            features.append(feature)
        layer.dataProvider().addFeatures(features)
        QgsProject.instance().addMapLayer(layer)
        return layer

    def add_store(self, x, y):
        """Add a layer with a store at a place of the site."""
        layer = self.add_points("Stores", "&field=id:string", [(x, y, "depot")])
        stores = self.dock.form.stores
        stores.setCurrentIndex(stores.findData(layer.id()))

    def add_cones(self, rows):
        """Add a layer of cones with their stages, and choose it."""
        layer = self.add_points("Cones", "&field=id:string&field=stage:integer", rows)
        cones = self.dock.form.cones
        cones.setCurrentIndex(cones.findData(layer.id()))

    def solve(self, seconds):
        self.dock.form.seconds.setValue(seconds)
        # On a busy machine a robot may not be heard for a while, and takes no part then.
        self.operator.wait("a robot that takes part", self._has_robots, 10)
        self.press("fleet_plan_solve")
        drafts = self.dock.drafts
        self.operator.wait("the plan", lambda: not drafts.busy and drafts.draft is not None, seconds + 20)
        return self.dock.drafts.draft.plan

    def _has_robots(self):
        desk = self.operator.desk
        robots = desk.state.robots.arrays(desk.clock.steady())
        return participating_robots(robots, self.dock.drafts.settings).any()

    def send(self):
        self.press("fleet_plan_send")
        self.answer("fleet_plan_question_send")

    def answer(self, button):
        box = self.dock.findChild(QMessageBox, "fleet_plan_question")
        QTest.mouseClick(box.findChild(QPushButton, button), Qt.MouseButton.LeftButton)
        QApplication.processEvents()

    def choose_placed(self, text):
        which = self.dock.placed.which
        self.operator.wait(text, lambda: which.findText(text) >= 0, 10)
        which.setCurrentIndex(which.findText(text))

    def tasks_of(self, robot):
        queue = self.operator.desk.state.queues.get(robot)
        return [] if queue is None else queue.tasks

    @property
    def report(self):
        """What the gateway reports of the plan that is shown."""
        known = self.dock.driven.known
        return None if known is None else known.report

    @property
    def offer(self):
        """The plan of what is left, once it is shown."""
        known = self.dock.driven.known
        return known.proposal if known is not None and known.is_whole else None

    @property
    def done(self):
        stops = [] if self.report is None else self.report.stops
        return {one.id for one in stops if one.kind in ("place", "collect") and one.state is TaskState.DONE}


class SecondDesk:
    """Another operator, at a desk of their own."""

    def __init__(self, loop, name):
        self._socket, self._ids = connect(f"{loop.address}/desk", proxy=None), itertools.count(1)
        self.ask("hello", operator=name)

    def ask(self, method, **params):
        number = next(self._ids)
        call = {"jsonrpc": "2.0", "id": number, "method": method, "params": params}
        self._socket.send(json.dumps(call))
        while True:
            answer = json.loads(self._socket.recv(60))
            if answer.get("id") == number:
                return answer["result"]

    def plan(self):
        (plan,) = self.ask("get_plans", ended=1)["plans"]
        return plan

    def close(self):
        self._socket.close()


@pytest.fixture
def planner(operator, plugin, iface):
    return Planner(operator, plugin, iface)


def tracks(database):
    """Return each robot's recorded positions, (n, 3): seconds, x, y."""
    with sqlite3.connect(database) as connection:
        rows = connection.execute(
            "select robot, received_at, x, y from trajectories order by received_at"
        ).fetchall()
    return {
        robot: np.array([row[1:] for row in rows if row[0] == robot]) for robot in {row[0] for row in rows}
    }


def stored_tracks(database, operator):
    """Return the tracks once nothing new is stored of robots that stand."""
    seen = [-1]

    def settled():
        now = sum(len(track) for track in tracks(database).values())
        before, seen[0] = seen[0], now
        QTest.qWait(1200)
        return now == before

    operator.wait("the last positions being stored", settled, 20)
    return tracks(database)


def least_distance_to(track, x, y):
    """Return how near the track comes to a place; positions that are near to one another are joined by lines.

    Of a busy machine few are stored, and the line between two that are far apart cuts the bends of a detour.
    """
    step = np.diff(track[:, 1:], axis=0)
    step[np.hypot(*step.T) > JOINED] = 0.0
    start, length = track[:-1, 1:], np.maximum((step**2).sum(axis=1), 1e-12)
    part = np.clip(((np.array([x, y]) - start) * step).sum(axis=1) / length, 0.0, 1.0)
    return float(np.hypot(*(start + part[:, None] * step - (x, y)).T).min())


def once_away(track, x, y):
    """Return what is left of a track from where the robot has left the place of the cone that it put down."""
    return track[np.maximum.accumulate(np.hypot(track[:, 1] - x, track[:, 2] - y) > CLEAR)]


def least_distance(a, b):
    """Return how near two robots came to one another at the same time; who is silent stands where it was."""
    times = np.arange(max(a[0, 0], b[0, 0]), max(a[-1, 0], b[-1, 0]), 0.05)
    here, there = (
        np.column_stack([np.interp(times, one[:, 0], one[:, axis]) for axis in (1, 2)]) for one in (a, b)
    )
    return float(np.hypot(*(here - there).T).min())


def test_three_robots_place_a_lane_change_and_two_go_on_when_one_is_killed(
    impatient_loop, operator, planner, tmp_path
):
    loop = impatient_loop
    # Who is to die drives slowly: it must not be at its third cone yet, where the others would come near it.
    speeds = {"r1": 2.5, "r2": 8.0, "r3": 8.0}
    robots = {name: loop.start_robot(name, STARTS[name], speed=speeds[name], rate=10) for name in STARTS}
    operator.connect_to(loop, list(STARTS))
    lane = {"vehicle_width": 1.7, "exit_length": 15, "cones_per_row": 2}
    layer = planner.place_layout("iso3888_1", lane, 12.0, 6.2)
    cones = {str(feature["id"]) for feature in layer.getFeatures()}
    assert len(cones) == 12
    planner.set_robots(carries=12, aboard=12, speed=2.5)
    plan = planner.solve(2.0)
    assert {stop.id for _, stop in plan.all_stops()} == cones
    assert not planner.dock.drafts.draft.meetings, planner.dock.bar.trouble.text()
    assert not len(operator.desk.state.queues), "nothing is sent before the operator says so"
    planner.send()
    operator.wait("cones being placed", lambda: len(planner.done) >= 4, 120)
    of_r1 = {stop.id for stop in plan.robot("r1").stops}
    operator.wait("two cones of r1", lambda: len(planner.done & of_r1) >= 2, 120)
    robots["r1"].send_signal(signal.SIGKILL)
    operator.wait("r1 being missed", lambda: [one.robot for one in planner.report.problems] == ["r1"], 20)
    left = of_r1 - planner.done
    assert left
    planner.press("fleet_plan_rest")
    operator.wait("a new plan", lambda: planner.offer is not None, 20)
    taken = {stop.id for _, stop in planner.offer.all_stops()}
    assert left <= taken and planner.offer.robot("r1").lost
    assert not planner.report.meetings, planner.dock.bar.trouble.text()
    assert operator.desk.state.queues.get("r1").tasks, "nothing is taken over before the operator confirms"
    planner.press("fleet_plan_confirm")
    operator.wait("every cone being placed", lambda: planner.done == cones, 240)
    operator.wait("quiet", lambda: not planner.dock.driven.busy, 10)

    planner.dock.tabs.setCurrentWidget(planner.dock.placed)
    report = planner.dock.placed.placements
    assert sorted(one.cone for one in report) == sorted(cones)
    assert max(one.deviation for one in report) < TOLERANCE
    assert {one.robot for one in report if one.cone in left} <= {"r2", "r3"}
    planner.dock.placed.save(str(tmp_path / "report.csv"))
    assert len((tmp_path / "report.csv").read_text().splitlines()) == 1 + len(cones)

    found = stored_tracks(tmp_path / "fleet.db", operator)
    for a, b in combinations(sorted(found), 2):
        assert least_distance(found[a], found[b]) > ROBOT_WIDTH, (a, b)
    last_of = dict.fromkeys(found) | {one.robot: one.cone for one in report}
    for one in report:
        for robot, track in found.items():
            after = track[track[:, 0] > one.placed_at]
            if robot == one.robot:
                after = once_away(after, one.x, one.y)
            if len(after) > 1 and last_of[robot] != one.cone:
                assert least_distance_to(after, one.x, one.y) > CLEAR, (robot, one.cone)


def placed(database):
    """Return the cones that are put down, each as often as it was."""
    with sqlite3.connect(database) as connection:
        return sorted(cone for (cone,) in connection.execute("select cone from placements"))


def pause_and_resume(second, operator, planner):
    """Have another operator pause the plan and let it go on; the panel follows."""
    plan = second.plan()
    assert plan["submitted_by"] == "anna"
    second.ask("pause_plan", plan=plan["plan"], reason="people on the track")
    why = "Paused: r1, r2 (bert: people on the track)"
    operator.wait("the pause", lambda: why in planner.dock.bar.text.text(), 20)
    second.ask("resume_plan", plan=plan["plan"], revision=second.plan()["revision"])
    operator.wait("going on", lambda: planner.report.state is PlanState.DRIVEN, 20)


def test_a_plan_goes_on_without_its_robot_its_desk_and_its_gateway_and_is_collected_again(
    impatient_loop, operator, plugin, iface, tmp_path
):
    loop, database = impatient_loop, tmp_path / "fleet.db"
    starts = {"r1": (24.0, 2.0, 0.0), "r2": (40.0, 2.0, 0.0)}
    # Who is to be killed far from any cone is slow: however late that is done, it stands at none of them.
    speeds = {"r1": 0.2, "r2": 8.0}
    robots = {name: loop.start_robot(name, pose, speed=speeds[name]) for name, pose in starts.items()}
    operator.connect_to(loop, list(starts))
    planner = Planner(operator, plugin, iface)
    lane = {"speed": 5, "approach": 10, "width": 4, "spacing": 12}
    layer = planner.place_layout("braking_lane", lane, 18.0, 8.0)
    cones = sorted(str(feature["id"]) for feature in layer.getFeatures())
    planner.set_robots(carries=9, aboard=9, speed=3.0, count=2)
    planner.solve(1.0)
    assert not planner.dock.bar.by_itself.isChecked()
    planner.dock.bar.by_itself.click()
    planner.send()
    operator.wait("r1 being under way", lambda: planner.tasks_of("r1"), 20)
    second = SecondDesk(loop, "bert")
    pause_and_resume(second, operator, planner)
    # QGIS is closed, as far as the plugin is concerned; then r1 dies, and nobody is asked.
    plugin.unload()
    let_deleted_go()
    robots["r1"].send_signal(signal.SIGKILL)
    operator.wait("r1 being done without", lambda: second.plan()["robots"] == ["r2"], 60)
    second.close()
    operator.wait("a cone of the new plan", lambda: placed(database), 60)
    loop.gateway.send_signal(signal.SIGKILL)
    loop.gateway.wait()
    before = placed(database)
    assert before != cones, "it was killed in the middle"
    loop.start_gateway(loop.port)
    second = SecondDesk(loop, "bert")
    plan = second.plan()
    assert (plan["state"], plan["robots"]) == ("driven", ["r2"])
    # So that the panel is sure to come to a plan in the middle.
    second.ask("pause_plan", plan=plan["plan"])
    second.close()
    assert placed(database) != cones

    again = FleetPlugin(iface)
    again.initGui()
    try:
        operator = Operator(again, iface)
        operator.connect_to(loop, ["r1", "r2"])
        planner = Planner(operator, again, iface)
        operator.wait("the plan", lambda: "Paused: r2 (bert)" in planner.dock.bar.text.text(), 20)
        # A robot that was not heard of yet would stay paused, which the panel would say.
        operator.wait("r2 being heard of", lambda: operator.states()["r2"] == "fresh", 30)
        planner.press("fleet_plan_resume")
        operator.wait("every cone being placed", lambda: len(planner.done) == len(cones), 240)
        assert placed(database) == cones, "none is missing and none stands twice"
        assert planner.dock.bar.text.text().startswith("Done: ")
        collect_again(operator, planner, iface, cones)
    finally:
        again.unload()
        let_deleted_go()


def collect_again(operator, planner, iface, cones):
    planner.press("fleet_plan_clear")
    planner.dock.tabs.setCurrentWidget(planner.dock.placed)
    planner.choose_placed("layout braking_lane")
    planner.press("fleet_placed_collect")
    operator.wait("the want of a store", lambda: any("no store" in text for text in iface.texts()), 20)
    planner.add_store(50.0, 14.0)
    planner.press("fleet_placed_collect")
    operator.wait("a plan", lambda: planner.dock.drafts.draft and not planner.dock.drafts.busy, 20)
    planner.dock.tabs.setCurrentIndex(0)
    stops = [stop for _, stop in planner.dock.drafts.draft.plan.all_stops() if stop.is_target]
    assert {stop.kind for stop in stops} == {"collect"} and len(stops) == len(cones)
    planner.send()
    operator.wait("all of it being collected", lambda: len(planner.done) == len(cones), 240)
    # That a cone was collected is told after that the command was done.
    collected = "every cone noted as collected"
    operator.wait(collected, lambda: all(one.collected_at for one in operator.desk.state.placed_cones), 10)


def test_a_plan_into_a_keepout_is_sent_with_an_override_that_the_audit_log_keeps(
    loop, operator, planner, tmp_path
):
    loop.start_robot("r1", (60.0, 42.0, 0.0), speed=8.0)
    operator.connect_to(loop, ["r1"])
    # In the sample site's water basin.
    planner.add_cones([(66.0, 32.0, "c1", 0)])
    planner.set_robots(carries=1, aboard=1, speed=2.5, count=1)
    planner.solve(1.0)
    planner.send()
    planner.press("fleet_plan_override")
    assert planner.tasks_of("r1") == []
    dialog = planner.dock.findChild(QDialog, "fleet_override")
    QTest.keyClicks(dialog.findChild(QLineEdit, "fleet_override_why"), "the basin is drained")
    confirm = dialog.findChild(QPushButton, "fleet_override_confirm")
    QTest.mouseClick(confirm, Qt.MouseButton.LeftButton)
    operator.wait("the cone being placed", lambda: planner.done == {"c1"}, 120)
    with sqlite3.connect(tmp_path / "fleet.db") as connection:
        asked = connection.execute("select done, detail from audit where action = 'submit_plan' order by id")
        (refused, why_not), (done, why) = asked.fetchall()
    assert (refused, done) == (0, 1)
    assert "lies in the keepout 'Water basin'" in why_not
    assert "lies in the keepout 'Water basin'. because: the basin is drained; " in why


def begun_and_placed(database):
    """Return what the gateway wrote of each cone: its robot, and when it was begun and placed."""
    with sqlite3.connect(database) as connection:
        rows = connection.execute(
            "select placed.cone, placed.robot, task.began_at, placed.placed_at "
            "from placements placed join queue_tasks task on task.id = placed.task"
        ).fetchall()
    return {cone: row for cone, *row in rows}


def test_no_cone_of_a_stage_is_begun_before_all_of_the_stage_before_are_placed(
    loop, operator, planner, tmp_path
):
    # Six seconds of driving and less than one: on a busy machine either is told of later.
    starts = {"r1": ((24.0, 2.0, 0.0), 3.0), "r2": ((62.0, 2.0, 0.0), 8.0)}
    for name, (pose, speed) in starts.items():
        loop.start_robot(name, pose, speed=speed)
    operator.connect_to(loop, list(starts))
    # The robot that is soon done with the first stage has the second one beside it.
    planner.add_cones([(42, 6, "long way", 1), (60, 6, "short way", 1), (65, 6, "next", 2)])
    planner.set_robots(carries=3, aboard=3, speed=4.0, count=2)
    planner.solve(1.0)
    planner.send()
    operator.wait("every cone being placed", lambda: len(planner.done) == 3, 60)

    written = begun_and_placed(tmp_path / "fleet.db")
    long_way, short_way, following = (written[cone] for cone in ("long way", "short way", "next"))
    assert [long_way[0], short_way[0], following[0]] == ["r1", "r2", "r2"]
    assert short_way[2] < long_way[2], "the second stage had to wait for the other robot"
    assert following[1] >= long_way[2]
