"""What an operator does at the panel of cone plans, and what is found there."""

from __future__ import annotations

from dataclasses import replace

from fleet_supervisor.plugin.layers.roles import ROAD_CENTRELINE, set_role
from fleet_supervisor.plugin.planning.layouts.layout_layer import LayoutLayer
from fleet_supervisor.robot_bridge.core.assignment.plan import PlannedTrip, document_of, plan_of_document
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


NEXT = {
    "pause_plan": "paused", "resume_plan": "driven", "replan": "replanning", "confirm_replan": "driven",
    "discard_replan": "driven", "clear_plan": "cleared",
}  # fmt: skip
"""The state that a plan is in once it was asked for that."""


class GatewayPlans:
    """The cone plans that the small gateway has been given, and what it tells of them."""

    def __init__(self, gateway):
        self.gateway = gateway
        self.reports, self.documents, self.proposals = {}, {}, {}
        gateway.answers["submit_plan"] = self.submit
        gateway.answers["get_plans"] = self._read
        for method in NEXT:
            gateway.answers[method] = lambda params, method=method: self._steer(method, params)

    @property
    def name(self):
        """The plan that was submitted last."""
        return list(self.reports)[-1]

    @property
    def newest(self):
        return self.reports[self.name]

    def submit(self, params, by="anna"):
        document = params["document"]
        driving = [one for one in document["robots"] if not one["lost"]]
        stops = [
            {
                "task": f"task-{one['robot']['id']}-{stop['id']}", "robot": one["robot"]["id"],
                "state": "waiting", **{name: stop[name] for name in ("kind", "id", "x", "y")},
            }
            for one in driving for trip in one["trips"] for stop in trip["stops"]
        ]  # fmt: skip
        self.documents[params["plan"]] = document
        self.reports[params["plan"]] = {
            "plan": params["plan"], "revision": 1, "state": "driven", "submitted_by": by,
            "submitted_at": 1_700_000_000.0 + len(self.reports), "by_itself": params["by_itself"],
            "cones": len(document["targets"]), "done": 0, "stops": stops, "problems": [], "left_out": [],
            "robots": [one["robot"]["id"] for one in driving], "by": by, "at": 1_700_000_000.0,
        }  # fmt: skip
        return {"result": self.reports[params["plan"]]}

    def tell(self, *, steps=1, states=None, **more):
        """Tell every desk that the newest plan is otherwise: ``states`` of stops by their ids."""
        report = self._changed(self.name, steps, **more)
        for stop in report["stops"]:
            stop["state"], stop["reason"] = (states or {}).get(
                stop["id"], (stop["state"], stop.get("reason"))
            )
        self.gateway.tell("plan", report)

    def propose(self, document, **more):
        """Tell of a plan of what is left."""
        self.proposals[self.name] = document
        self.tell(state="proposed", by="gateway", reason="plan of what is left", **more)

    def _changed(self, name, steps=1, **more):
        report = self.reports[name]
        report = {**report, "stops": [dict(one) for one in report["stops"]], **more}
        report["revision"] += steps
        self.reports[name] = report
        return report

    def _whole(self, name):
        report = {**self.reports[name], "document": self.documents[name]}
        return {**report, "proposal": self.proposals[name]} if name in self.proposals else report

    def _read(self, params):
        names = [params["plan"]] if params.get("plan") else list(self.reports)
        plans = [self._whole(name) if params["documents"] else self.reports[name] for name in names]
        return {"result": {"plans": plans}}

    def _steer(self, method, params):
        name = params["plan"]
        report = self.reports[name]
        if params.get("revision", report["revision"]) != report["revision"]:
            text = f"plan {name!r} is at revision {report['revision']}; look at it again"
            return {"error": {"code": -32006, "message": text, "data": report}}
        if method == "confirm_replan":
            self.documents[name] = self.proposals[name]
        self.proposals.pop(name, None)
        return {"result": self._changed(name, state=NEXT[method], by="anna", reason=None)}


def queue(panel, robot, states, **more):
    """A queue's report with the tasks of the plan that is shown, for ``robot``, in ``states``."""
    report = panel.driven.known.report
    sent = [stop for stop in report.stops if stop.robot == robot]
    tasks = [
        {
            "task": one.task, "robot": robot, "kind": "place", "state": state, "x": one.x, "y": one.y,
            "added_by": "anna", "added_at": 1.0, "cone": one.id, "plan": report.plan,
        }
        for one, state in zip(sent, states, strict=True)
    ]  # fmt: skip
    values = {"robot": robot, "revision": 3, "state": "running", "robot_state": "fresh", "ended": []}
    return {**values, "tasks": tasks, **more}


def hung(iface, part):
    """What hangs in the message bar and holds ``part``."""
    return [text for text in iface.texts() if part in text]


def submitted(panel, plans, wait):
    """Make a plan and send it; return it as the desk made it."""
    plan = planned(panel, wait)
    answer(question(panel), send=True)
    wait(lambda: panel.driven.known is not None and panel.driven.known.is_whole, 10, "the plan as driven")
    wait(lambda: not panel.driven.busy, 10, "the answers")
    return plan


LOST_R1 = [{"kind": "away", "robot": "r1"}]


def lose_r1(panel, plans, wait):
    plans.tell(problems=LOST_R1, steps=0)
    wait(lambda: panel.driven.known.report.problems, 5, "the loss")


def without_r1(document):
    """A plan as the gateway makes it of what is left when r1 is lost before its first cone."""
    plan = plan_of_document(document)
    names = [one.robot.id for one in plan.robots]
    lost = names.index("r1")
    stops = [stop for one in plan.robots for stop in one.stops]
    robots = [
        replace(one, trips=() if k == lost else (PlannedTrip(1, tuple(stops)),), lost=k == lost)
        for k, one in enumerate(plan.robots)
    ]
    return document_of(replace(plan, robots=tuple(robots)))


def offered(panel, plans, wait, **more):
    """Ask for a plan of what is left without r1, and wait until it is shown."""
    press(panel, "fleet_plan_rest")
    wait(lambda: panel.driven.known.report.state.value == "replanning" and not panel.driven.asking, 10)
    plans.propose(without_r1(plans.documents[plans.name]), robots=["r1", "r2"], **more)
    wait(lambda: panel.driven.known.proposal is not None and panel.driven.known.is_whole, 10, "a new plan")


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
