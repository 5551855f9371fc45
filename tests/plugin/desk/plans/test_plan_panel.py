"""The panel of cone plans on a real window, against a gateway on a socket."""

from __future__ import annotations

import itertools
import threading
import time
from dataclasses import replace

import pytest
from fleet_supervisor.plugin.desk.cone_store import ConeStore
from fleet_supervisor.plugin.desk.plans import draft
from fleet_supervisor.plugin.sites.roles import ROAD_CENTRELINE, set_role
from fleet_supervisor.plugin.wire.outbox import Answer, Order
from fleet_supervisor.robot_bridge.assignment import solving
from fleet_supervisor.robot_bridge.layouts.cone import Cone
from fleet_supervisor.robot_bridge.messages import to_json
from qgis.core import (
    QgsCoordinateReferenceSystem,
    QgsFeature,
    QgsGeometry,
    QgsPointXY,
    QgsProject,
    QgsVectorLayer,
)
from qgis.PyQt.QtCore import QEvent, QMimeData, QPointF, Qt
from qgis.PyQt.QtGui import QDropEvent
from qgis.PyQt.QtTest import QTest
from qgis.PyQt.QtWidgets import QAction, QApplication, QCheckBox, QDockWidget, QMessageBox, QPushButton

E, N = 488000.0, 5190000.0
CARRIES, ABOARD = 1, 2


def put_cones(*places, layout="row"):
    cones = [Cone(f"{layout}-{n}", n, E + x, N + y, 0.0, "", "") for n, (x, y) in enumerate(places, 1)]
    return ConeStore(QgsProject.instance()).add(cones, layout, QgsCoordinateReferenceSystem("EPSG:32633"))


@pytest.fixture
def site(site):
    """Robots report once here: they are not lost before the end, however long a slow machine plans."""
    return replace(site, lost_after=3600.0)


@pytest.fixture
def panel(at_desk, iface, wait):
    put_cones((40, 40), (45, 40), (50, 44), (75, 60), (80, 64), (85, 60))
    iface.findChild(QAction, "fleet_plan_panel").trigger()
    dock = iface.findChild(QDockWidget, "fleet_plan_dock")
    for robot in ("r1", "r2"):
        dock.drafts.settings = dock.drafts.settings.with_robot(
            robot, dock.drafts.settings.of_robot(robot).__class__(True, 8, 8, 1.0)
        )
    wait(lambda: dock.robots.model().rowCount() == 2, 5, "the robots in the panel")
    yield dock


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


def test_a_preview_gives_each_robot_the_cones_near_to_it_and_sends_nothing(panel, gateway, wait, iface):
    plan = planned(panel, wait)
    assert {robot: set(ids) for robot, ids in cones_of(plan).items()} == {
        "r1": {"row-1", "row-2", "row-3"},
        "r2": {"row-4", "row-5", "row-6"},
    }
    asked = {method for method, _ in gateway.requests}
    assert not asked & {"set_queue", "take_over", "send", "add_tasks"}
    tree = panel.tree
    assert [tree.topLevelItem(k).text(0) for k in range(2)] == ["r1", "r2"]
    assert tree.topLevelItem(0).child(0).text(1).startswith("+0:")
    assert "Not sent yet: 6 cones, 2 robots" in panel.bar.text.text()


@pytest.fixture
def endless(monkeypatch):
    """Called, it lets no stage be solved any more: six cones would be, before anybody can give up."""

    def stage(days, targets, start, aim, effort):
        for step in itertools.count(1):
            effort.progress(min(step / 1000, 1.0))
            time.sleep(0.01)

    return lambda: monkeypatch.setattr(solving, "solved_stage", stage)


def test_a_good_plan_is_made_with_progress_and_can_be_given_up(panel, wait, endless):
    endless()
    panel.form.seconds.setValue(60.0)
    press(panel, "fleet_plan_solve")
    wait(lambda: panel.drafts.task is not None and panel.drafts.task.progress() > 0, 20, "progress")
    assert not panel.preview.isEnabled()
    press(panel, "fleet_plan_cancel")
    wait(lambda: not panel.drafts.busy, 10, "the end")
    assert panel.drafts.draft is None and panel.preview.isEnabled()


def test_what_speaks_against_a_plan_is_found_beside_the_windows_thread(panel, wait, monkeypatch):
    threads = []
    for name in ("meetings", "closed_ways"):
        find = getattr(draft, name)
        monkeypatch.setattr(
            draft, name, lambda *args, find=find: threads.append(threading.get_ident()) or find(*args)
        )
    planned(panel, wait)
    assert len(threads) == 2 and threading.get_ident() not in threads


def test_the_plan_is_on_the_map_with_numbers_times_and_a_colour_for_each_robot(panel, wait):
    plan = planned(panel, wait)
    stops, ways = panel.layers.stops.layer, panel.layers.ways.layer
    assert stops.featureCount() == 6 and ways.featureCount() == 6
    found = {f["id"]: f for f in stops.getFeatures()}
    for one in plan.robots:
        for number, stop in enumerate(one.stops, 1):
            feature = found[stop.id]
            assert feature["number"] == number and feature["robot"] == one.robot.id
            assert feature["arrives"].startswith("+0:")
            at = feature.geometry().asPoint()
            assert (at.x(), at.y()) == pytest.approx((E + stop.x, N + stop.y))
    assert len({f["colour"] for f in found.values()}) == 2


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


def test_a_cone_is_moved_by_keys_and_the_times_are_made_anew(panel, wait):
    before = planned(panel, wait)
    first = cones_of(before)["r1"]
    key(panel, child(panel, "r1", first[0]), Qt.Key.Key_Down, Qt.KeyboardModifier.AltModifier)
    wait(lambda: panel.drafts.draft.plan is not before and not panel.drafts.busy, 10, "the change")
    after = panel.drafts.draft.plan
    assert cones_of(after)["r1"] == [first[1], first[0], first[2]]
    assert after.robot("r1").end_s != pytest.approx(before.robot("r1").end_s)
    assert panel.tree.currentItem().text(0).endswith(first[0]), "what was moved stays selected"


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


def test_a_cone_is_dragged_to_another_robot(panel, wait):
    before = planned(panel, wait)
    moved = cones_of(before)["r1"][-1]
    drop(panel, child(panel, "r1", moved), panel.tree.topLevelItem(1))
    wait(lambda: panel.drafts.draft.plan is not before and not panel.drafts.busy, 10, "the change")
    after = cones_of(panel.drafts.draft.plan)
    assert moved not in after["r1"] and after["r2"][-1] == moved
    other = after["r2"][0]
    drop(panel, child(panel, "r2", moved), child(panel, "r2", other))
    now = panel.drafts.draft.plan
    wait(lambda: panel.drafts.draft.plan is not now and not panel.drafts.busy, 10, "the change")
    assert cones_of(panel.drafts.draft.plan)["r2"][:2] == [other, moved]


def test_a_cone_is_taken_out_and_named_as_left_out(panel, wait):
    before = planned(panel, wait)
    gone = cones_of(before)["r2"][0]
    key(panel, child(panel, "r2", gone), Qt.Key.Key_Delete)
    wait(lambda: panel.drafts.draft.plan is not before and not panel.drafts.busy, 10, "the change")
    assert gone not in str(cones_of(panel.drafts.draft.plan))
    assert f"Left out: {gone} (taken out by hand)" in panel.bar.text.text()


def test_what_cannot_be_driven_is_told_and_the_plan_stays(panel, wait, iface):
    for row in range(2):
        write(panel, row, ABOARD, "3")
    before = planned(panel, wait)
    drop(panel, child(panel, "r1", cones_of(before)["r1"][0]), panel.tree.topLevelItem(1))
    wait(lambda: any("r2 cannot serve" in text for text in iface.texts()), 10, "the refusal")
    assert panel.drafts.draft.plan is before


@pytest.mark.parametrize(
    ("spoil", "expected"),
    [
        (lambda dock: dock.form.cones.setCurrentIndex(0), "No layer of cones is chosen"),
        (lambda dock: [untick(dock, row) for row in range(2)], "No robot that is there is chosen"),
        (lambda dock: [write(dock, row, ABOARD, "0") for row in range(2)], "There is no store"),
        (lambda dock: dock.form.selected_only.setChecked(True), "no selected features"),
        (lambda dock: write(dock, 0, CARRIES, "many"), "Carries of r1 is 'many'"),
    ],
)
def test_what_is_missing_is_named(panel, wait, iface, spoil, expected):
    spoil(panel)
    press(panel, "fleet_plan_preview")
    wait(lambda: any(expected in text for text in iface.texts()), 10, expected)


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


def test_only_send_and_a_second_send_fill_the_queues(panel, gateway, wait):
    plan = planned(panel, wait)
    box = question(panel)
    assert "r1: 3 cones" in box.text() and "The robots set off at once" in box.text()
    answer(box, send=False)
    QTest.qWait(200)
    assert gateway.asked("set_queue") == []
    answer(question(panel), send=True)
    wait(lambda: len(gateway.asked("set_queue")) == 2 and not panel.driven.busy, 10, "both queues")
    sent = {one["robot"]: one for one in gateway.asked("set_queue")}
    assert {robot: [t["cone"] for t in one["tasks"]] for robot, one in sent.items()} == cones_of(plan)
    assert all(one["revision"] == 0 for one in sent.values())
    tasks = [task for one in sent.values() for task in one["tasks"]]
    assert len({task["task"] for task in tasks}) == 6
    assert {task["kind"] for task in tasks} == {"place"} and {task["layout"] for task in tasks} == {"row"}
    assert "Under way: 0 of 6 cones" in panel.bar.text.text()
    before = panel.driven.driven.plan
    key(panel, child(panel, "r1", cones_of(plan)["r1"][0]), Qt.Key.Key_Delete)
    QTest.qWait(100)
    assert panel.driven.driven.plan is before, "what is driven is not edited"


def test_what_was_refused_and_what_was_not_done_is_said(panel, gateway, wait, iface):
    planned(panel, wait)
    gateway.refuse["set_queue"] = "the queue of robot 'r1' is at revision 4, not 0; look at it again"
    answer(question(panel), send=True)
    wait(lambda: any("was not sent as a whole" in text for text in iface.texts()), 10, "the refusal")
    (text,) = [text for text in iface.texts() if "as a whole" in text]
    assert "revision 4" in text and "Not done therefore" in text and "the queue of r2" in text
    assert len(gateway.asked("set_queue")) == 1


def test_the_question_names_robots_that_moved_and_would_meet(panel, gateway, wait, make_robot):
    panel.form.apart.setValue(50.0)
    planned(panel, wait)
    gateway.show(make_robot("r1", 50, 48))
    wait(lambda: panel._desk.picture.view("r1", panel._desk.clock()).report.y == 48, 5)
    text = question(panel).text()
    assert "r1 is 8.0 m from where the plan begins" in text
    assert "r1 and r2 come within" in text


def test_a_plan_that_is_driven_is_not_thrown_away_by_another_preview(panel, gateway, wait, iface):
    planned(panel, wait)
    answer(question(panel), send=True)
    wait(lambda: not panel.driven.busy and panel.driven.driven is not None, 10)
    driven = panel.driven.driven
    press(panel, "fleet_plan_preview")
    wait(lambda: any("A plan is being driven" in text for text in iface.texts()), 5)
    assert panel.driven.driven is driven
    press(panel, "fleet_plan_clear")
    assert panel.driven.driven is None and "No plan" in panel.bar.text.text()


def test_unloading_takes_panel_layers_and_tasks_away(panel, plugin, wait, iface, endless):
    planned(panel, wait)
    endless()
    panel.form.seconds.setValue(60.0)
    press(panel, "fleet_plan_solve")
    task = panel.drafts.task
    wait(lambda: task.progress() > 0, 20, "progress")
    plugin.unload()
    assert task.left.is_set()
    names = {layer.name() for layer in QgsProject.instance().mapLayers().values()}
    assert names == {"Cones"}
    QApplication.sendPostedEvents(None, QEvent.Type.DeferredDelete)
    assert iface.findChild(QDockWidget, "fleet_plan_dock") is None
    assert iface.findChild(QAction, "fleet_plan_panel") is None


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


@pytest.fixture
def under_way(panel, gateway, wait):
    """A plan that both robots drive; each is at its first cone."""
    planned(panel, wait)
    answer(question(panel), send=True)
    wait(lambda: len(gateway.asked("set_queue")) == 2 and not panel.driven.busy, 10)
    for robot in ("r1", "r2"):
        gateway.tell("queue", queue(panel, robot, ["current", "waiting", "waiting"]))
    wait(lambda: len(panel._desk.queues) == 2, 5)
    return panel


def lose_r1(panel, gateway, wait):
    gateway.tell("queue", queue(panel, "r1", ["current", "waiting", "waiting"], robot_state="lost"))
    wait(lambda: panel.driven.trouble.away == ("r1",), 5)


def offered(panel, wait):
    press(panel, "fleet_plan_rest")
    wait(lambda: panel.driven.offer is not None and not panel.driven.busy, 15, "a new plan")


def test_a_lost_robot_is_told_and_nothing_is_sent_before_somebody_agrees(under_way, gateway, wait, iface):
    lose_r1(under_way, gateway, wait)
    assert any("r1 is lost or offline" in text for text in iface.texts())
    QTest.qWait(300)
    asked = {method for method, _ in gateway.requests}
    assert not asked & {"pause_queue", "take_over", "resume_queue"}
    offered(under_way, wait)
    assert [one["robot"] for one in gateway.asked("pause_queue")] == ["r2"]
    assert gateway.asked("take_over") == [] and len(gateway.asked("set_queue")) == 2
    cones = cones_of(under_way.driven.offer.plan)
    assert len(cones["r2"]) == 5 and cones["r1"] == []
    press(under_way, "fleet_plan_confirm")
    wait(lambda: not under_way.driven.busy, 10)
    (taken,) = gateway.asked("take_over")
    assert taken["robot"] == "r1" and [share["robot"] for share in taken["shares"]] == ["r2"]
    # All that waits is in it: the two of r2, and the three of the lost robot with what it was doing.
    assert len(taken["shares"][0]["tasks"]) == 5
    assert [task["cone"] for task in gateway.asked("set_queue")[-1]["tasks"]] == cones["r2"]


def test_nobody_is_sent_by_itself_to_a_cone_at_which_a_lost_robot_stands(
    under_way, gateway, wait, make_robot
):
    cone = under_way.driven.driven.plan.robot("r1").stops[1]
    gateway.show(make_robot("r1", cone.x, cone.y))
    picture = under_way._desk.picture
    wait(lambda: picture.view("r1", under_way._desk.clock()).report.x == pytest.approx(cone.x), 5)
    under_way.bar.by_itself.click()
    lose_r1(under_way, gateway, wait)
    wait(lambda: under_way.driven.offer is not None and not under_way.driven.busy, 15, "a new plan")
    assert "r2 and r1 come within 0.0 m" in under_way.bar.trouble.text()
    QTest.qWait(300)
    assert under_way.driven.offer is not None and gateway.asked("take_over") == []


@pytest.mark.parametrize("again", [False, True])
def test_a_cone_that_failed_is_told_and_given_up_or_tried_again(under_way, gateway, wait, iface, again):
    first, *others = cones_of(under_way.driven.driven.plan)["r1"]
    stopped = queue(under_way, "r1", ["failed", "waiting", "waiting"], state="paused")
    stopped["tasks"][0]["reason"] = "a wall"
    gateway.tell("queue", stopped)
    wait(lambda: under_way.driven.trouble.failed == ((first, "a wall"),), 5)
    assert any(first in text and "a wall" in text for text in iface.texts())
    box = under_way.findChild(QCheckBox, "fleet_plan_again")
    assert box.isVisible() and not box.isChecked()
    box.setChecked(again)
    offered(under_way, wait)
    offer = under_way.driven.offer.plan
    assert len(gateway.asked("set_queue")) == 2 and not gateway.asked("take_over"), "nobody has agreed yet"
    planned_again = [cone for cones in cones_of(offer).values() for cone in cones]
    assert planned_again.count(first) == (1 if again else 0)
    assert set(others) <= set(planned_again)
    left_out = [(one.target.id, "a wall" in one.reason) for one in offer.left_out]
    assert left_out == ([] if again else [(first, True)])
    sent = len(gateway.requests)
    press(under_way, "fleet_plan_confirm")
    wait(lambda: not under_way.driven.busy, 10)
    queued = [params for method, params in gateway.requests[sent:] if method == "set_queue"]
    cones = [task.get("cone") for params in queued for task in params["tasks"]]
    assert cones.count(first) == (1 if again else 0) and set(others) <= set(cones)


def test_a_queue_that_somebody_else_holds_is_not_set_going(under_way, gateway, wait, iface):
    held = {"state": "paused", "reason": "paused by bert", "by": "bert", "at": 77.0}
    gateway.tell("queue", queue(under_way, "r2", ["waiting"] * 3, **held))
    lose_r1(under_way, gateway, wait)
    offered(under_way, wait)
    press(under_way, "fleet_plan_confirm")
    wait(lambda: not under_way.driven.busy, 10)
    assert gateway.asked("pause_queue") == [] and gateway.asked("resume_queue") == []
    assert any("r2 stays paused (paused by bert)" in text for text in iface.texts())


def test_going_on_as_before_lets_go_what_was_held_and_sends_nothing_else(under_way, gateway, wait):
    lose_r1(under_way, gateway, wait)
    ours = {"state": "paused", "reason": "paused by anna: plan of what is left", "by": "anna", "at": 88.0}
    gateway.mute.add("pause_queue")
    press(under_way, "fleet_plan_rest")
    wait(lambda: gateway.asked("pause_queue"), 5)
    gateway.tell("queue", queue(under_way, "r2", ["current", "waiting", "waiting"], **ours))
    wait(lambda: under_way._desk.queues.get("r2").at == 88.0, 5)
    under_way.driven.sending._answered(Answer(Order(under_way.driven.sending._key, "pause_queue"), {}))
    wait(lambda: under_way.driven.offer is not None and not under_way.driven.busy, 15)
    press(under_way, "fleet_plan_discard")
    wait(lambda: gateway.asked("resume_queue"), 5)
    assert gateway.asked("resume_queue") == [{"robot": "r2", "revision": 3}]
    assert gateway.asked("take_over") == [] and under_way.driven.offer is None


def test_a_new_plan_is_not_sent_when_a_cone_was_given_up_meanwhile(under_way, gateway, wait, iface):
    lose_r1(under_way, gateway, wait)
    offered(under_way, wait)
    gateway.tell("queue", queue(under_way, "r2", ["waiting"] * 3, state="paused", at=99.0))
    wait(lambda: under_way._desk.queues.get("r2").at == 99.0, 5)
    press(under_way, "fleet_plan_confirm")
    wait(lambda: any("was given up since this plan was made" in text for text in iface.texts()), 5)
    assert gateway.asked("take_over") == [] and under_way.driven.offer is not None


def test_nothing_is_sent_while_an_emergency_stop_is_in_force(panel, gateway, wait, iface):
    planned(panel, wait)
    gateway.stand(in_force=True, stop="stop-1", at=1.0, by="bert")
    wait(lambda: panel._desk.emergency is not None and panel._desk.emergency.in_force, 5)
    answer(question(panel), send=True)
    wait(lambda: any("An emergency stop is in force" in text for text in iface.texts()), 5)
    assert gateway.asked("set_queue") == [] and panel.driven.driven is None


def test_a_site_that_is_published_anew_keeps_the_plan_and_another_site_does_not(
    under_way, gateway, wait, site
):
    driven = under_way.driven.driven
    gateway.tell("site", to_json(replace(site, version="2")))
    wait(lambda: under_way._desk.site.version == "2", 5)
    assert under_way.driven.driven is driven
    gateway.tell("site", to_json(replace(site, id="elsewhere")))
    wait(lambda: under_way.driven.driven is None, 5)


def test_what_is_switched_on_is_done_once_it_can_be_and_not_said_again_and_again(
    under_way, gateway, wait, iface
):
    under_way.bar.by_itself.click()
    gateway.stand(in_force=True, stop="stop-1", at=1.0, by="bert")
    wait(lambda: under_way._desk.emergency is not None and under_way._desk.emergency.in_force, 5)
    lose_r1(under_way, gateway, wait)
    for revision in (4, 5):
        states = ["current", "waiting", "waiting"]
        gateway.tell("queue", queue(under_way, "r2", states, revision=revision))
        wait(lambda revision=revision: under_way._desk.queues.revision("r2") == revision, 5)
    assert sum("An emergency stop is in force" in text for text in iface.texts()) == 1
    assert gateway.asked("pause_queue") == [] and gateway.asked("take_over") == []


def test_another_project_switches_off_what_is_sent_by_itself(panel, tmp_path):
    panel.bar.by_itself.click()
    assert panel.drafts.settings.by_itself
    other = str(tmp_path / "other.qgz")
    assert QgsProject().write(other)
    assert QgsProject.instance().read(other)
    assert not panel.bar.by_itself.isChecked() and not panel.drafts.settings.by_itself


# --- closed roads ----------------------------------------------------------------------------------------


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


SHORT = [[60.0, 40.0], [200.0, 40.0]]


def test_a_plan_is_made_round_the_roads_that_are_closed_at_the_gateway(far_cones, gateway, wait):
    straight = way_to(planned(far_cones, wait), "far-1")
    assert max(y for _, y in straight) < 50
    assert far_cones.bar.trouble.text() == ""
    gateway.tell("closures", closing(SHORT))
    wait(lambda: "leads along a road that bert closed (tree)" in far_cones.bar.trouble.text(), 5)
    text = question(far_cones).text()
    assert "to far-1 leads along a road that bert closed (tree)" in text
    answer(far_cones.question, send=False)
    round_it = way_to(planned(far_cones, wait), "far-1")
    assert max(y for _, y in round_it) > 85
    assert far_cones.bar.trouble.text() == ""
    gateway.tell("closures", closing())
    wait(lambda: not far_cones._desk.roads.closures, 5)
    assert max(y for _, y in way_to(planned(far_cones, wait), "far-1")) < 50


def test_a_road_that_is_closed_under_a_plan_that_is_driven_is_told_until_another_is_agreed_to(
    far_cones, gateway, wait, iface
):
    planned(far_cones, wait)
    answer(question(far_cones), send=True)
    wait(lambda: gateway.asked("set_queue") and not far_cones.driven.busy, 10)
    gateway.tell("closures", closing(SHORT))
    wait(lambda: far_cones.driven.trouble.closed, 5)

    def told():
        return [text for text in iface.texts() if "leads along a road that bert closed" in text]

    assert len(told()) == 1
    offered(far_cones, wait)
    assert max(y for _, y in way_to(far_cones.driven.offer.plan, "far-1")) > 85
    assert len(told()) == 1, "nobody has agreed yet"
    press(far_cones, "fleet_plan_confirm")
    wait(lambda: not far_cones.driven.busy, 10)
    assert told() == []
    assert far_cones.driven.trouble.closed == ()


def test_a_road_that_is_opened_again_is_no_trouble_any_more(far_cones, gateway, wait, iface):
    planned(far_cones, wait)
    answer(question(far_cones), send=True)
    wait(lambda: gateway.asked("set_queue") and not far_cones.driven.busy, 10)
    gateway.tell("closures", closing(SHORT))
    wait(lambda: far_cones.driven.trouble.closed, 5)
    gateway.tell("closures", closing())
    wait(lambda: not far_cones.driven.trouble, 5)
    assert not any("closed" in text for text in iface.texts())


def test_what_was_told_of_a_lost_robot_is_taken_down_when_a_new_plan_is_agreed_to(
    under_way, gateway, wait, iface
):
    lose_r1(under_way, gateway, wait)
    assert any("r1 is lost or offline" in text for text in iface.texts())
    offered(under_way, wait)
    press(under_way, "fleet_plan_confirm")
    wait(lambda: not under_way.driven.busy, 10)
    assert not any("r1 is lost or offline" in text for text in iface.texts())
