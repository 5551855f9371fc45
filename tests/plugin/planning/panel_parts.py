"""What an operator does at the panel of cone plans, and what is found there."""

from __future__ import annotations

from fleet_supervisor.plugin.layers.roles import ROAD_CENTRELINE, set_role
from fleet_supervisor.plugin.planning.layouts.layout_layer import LayoutLayer
from fleet_supervisor.robot_bridge.core.layouts.layout import Cone
from qgis.core import (
    QgsCoordinateReferenceSystem,
    QgsFeature,
    QgsGeometry,
    QgsPointXY,
    QgsProject,
    QgsVectorLayer,
)
from qgis.PyQt.QtCore import QMimeData, QPointF, Qt
from qgis.PyQt.QtGui import QDropEvent
from qgis.PyQt.QtTest import QTest
from qgis.PyQt.QtWidgets import QMessageBox, QPushButton

E, N = 488000.0, 5190000.0
CARRIES, ABOARD = 1, 2
SHORT = [[60.0, 40.0], [200.0, 40.0]]


def put_cones(*places, layout="row"):
    cones = [Cone(f"{layout}-{n}", n, E + x, N + y, 0.0, "", "") for n, (x, y) in enumerate(places, 1)]
    return LayoutLayer(QgsProject.instance()).add(cones, layout, QgsCoordinateReferenceSystem("EPSG:32633"))


def press(dock, name):
    button = dock.findChild(QPushButton, name)
    assert button.isEnabled() and button.isVisible(), name
    QTest.mouseClick(button, Qt.MouseButton.LeftButton)


def planned(dock, wait, what="fleet_plan_preview"):
    before = dock.drafts.draft
    press(dock, what)
    wait(lambda: not dock.drafts.busy, 15, "the plan")
    assert dock.drafts.draft is not None and dock.drafts.draft is not before, "no new plan was made"
    return dock.drafts.draft.plan


def cones_of(plan):
    return {one.robot.id: [s.id for s in one.stops if s.is_target] for one in plan.robots}


def child(dock, robot, cone):
    for k in range(dock.tree.topLevelItemCount()):
        top = dock.tree.topLevelItem(k)
        for n in range(top.childCount()):
            if top.text(0) == robot and cone in top.child(n).text(0):
                return top.child(n)
    raise AssertionError(f"{cone} is not under {robot}")


def key(dock, item, which, modifiers=Qt.KeyboardModifier.NoModifier):
    dock.tree.setCurrentItem(item)
    QTest.keyClick(dock.tree, which, modifiers)


def drop(dock, item, onto):
    """Drop ``item`` on ``onto`` as Qt tells the tree of it."""
    dock.tree.setCurrentItem(item)
    dock.tree.scrollToItem(onto)
    place = dock.tree.visualItemRect(onto).center()
    data = QMimeData()
    event = QDropEvent(
        QPointF(place),
        Qt.DropAction.MoveAction,
        data,
        Qt.MouseButton.LeftButton,
        Qt.KeyboardModifier.NoModifier,
    )
    dock.tree.dropEvent(event)


def untick(dock, row):
    robots = dock.robots.model()
    robots.setData(robots.index(row, 0), Qt.CheckState.Unchecked, Qt.ItemDataRole.CheckStateRole)


def write(dock, row, column, text):
    robots = dock.robots.model()
    robots.setData(robots.index(row, column), text, Qt.ItemDataRole.EditRole)


def question(dock):
    press(dock, "fleet_plan_send")
    return dock.findChild(QMessageBox, "fleet_plan_question")


def answer(box, send):
    buttons = {one.text(): one for one in box.findChildren(QPushButton)}
    QTest.mouseClick(buttons["Send" if send else "Do not send"], Qt.MouseButton.LeftButton)


def queue(panel, robot, states, **more):
    """A queue's report with the tasks that were sent to ``robot``, in ``states``."""
    sent = {stop.stop.id: stop for stop in panel.driven.progress.stops.values() if stop.robot == robot}
    tasks = [
        {
            "task": one.task, "robot": robot, "kind": "place", "state": state,
            "x": one.stop.x, "y": one.stop.y, "added_by": "anna", "added_at": 1.0, "cone": cone,
            "plan": panel.driven.progress.name,
        }
        for (cone, one), state in zip(sent.items(), states, strict=True)
    ]  # fmt: skip
    values = {"robot": robot, "revision": 3, "state": "running", "robot_state": "fresh", "ended": []}
    return {**values, "tasks": tasks, **more}


def lose_r1(panel, gateway, wait):
    gateway.tell("queue", queue(panel, "r1", ["current", "waiting", "waiting"], robot_state="lost"))
    wait(lambda: panel.driven.trouble.away == ("r1",), 5)


def offered(panel, wait):
    press(panel, "fleet_plan_rest")
    wait(lambda: panel.driven.offer is not None and not panel.driven.busy, 15, "a new plan")


def put_road(*points):
    road = QgsVectorLayer("LineString?crs=EPSG:32633&field=width_m:double", "Roads", "memory")
    feature = QgsFeature(road.fields())
    feature.setGeometry(QgsGeometry.fromPolylineXY([QgsPointXY(E + x, N + y) for x, y in points]))
    road.dataProvider().addFeatures([feature])
    set_role(road, ROAD_CENTRELINE)
    QgsProject.instance().addMapLayer(road)


def closing(*lines):
    reports = [
        {"closure": f"closure-{k}", "line": line, "closed_at": 1.0, "closed_by": "bert", "reason": "tree"}
        for k, line in enumerate(lines)
    ]
    return {"closures": reports}


def way_to(plan, cone):
    (path,) = [stop.path for _, stop in plan.all_stops() if stop.id == cone]
    return path
