"""A cone plan is sent when the operator agrees, and not otherwise."""

from __future__ import annotations

from dataclasses import replace

from fleet_supervisor.plugin.desk.plans import plan_rows
from fleet_supervisor.plugin.wire.outbox import Answer, Order
from fleet_supervisor.robot_bridge.messages import TaskState, to_json
from qgis.PyQt.QtCore import Qt
from qgis.PyQt.QtTest import QTest

from tests.plugin.desk.plans.panel_parts import (
    answer,
    child,
    cones_of,
    key,
    planned,
    press,
    question,
    queue,
)


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


def test_nothing_is_sent_while_an_emergency_stop_is_in_force(panel, gateway, wait, iface):
    planned(panel, wait)
    gateway.stand(in_force=True, stop="stop-1", at=1.0, by="bert")
    wait(lambda: panel._desk.emergency is not None and panel._desk.emergency.in_force, 5)
    answer(question(panel), send=True)
    wait(lambda: any("An emergency stop is in force" in text for text in iface.texts()), 5)
    assert gateway.asked("set_queue") == [] and panel.driven.driven is None


def test_a_site_that_is_published_anew_or_chosen_keeps_the_plan_and_another_does_not(
    under_way, gateway, wait, site
):
    driven = under_way.driven.driven
    gateway.tell("site", to_json(replace(site, version="2")))
    wait(lambda: under_way._desk.site.version == "2", 5)
    assert under_way.driven.driven is driven
    gateway.tell("site", to_json(replace(site, id="chosen")))
    wait(lambda: under_way._desk.site.id == "chosen", 5)
    assert under_way.driven.driven is driven
    gateway.tell("site", to_json(replace(site, origin=(1.0, 2.0))))
    wait(lambda: under_way.driven.driven is None, 5)


def test_what_is_done_is_counted_and_off_the_map_in_every_language(under_way, gateway, wait, monkeypatch):
    monkeypatch.setattr(plan_rows, "_WORDS", {state: f"«{state.value}»" for state in TaskState})
    first, *others = cones_of(under_way.driven.driven.plan)["r1"]
    gateway.tell("queue", queue(under_way, "r1", ["done", "failed", "waiting"]))
    wait(lambda: first in under_way.driven.progress.done, 5)
    cone = child(under_way, "r1", first)
    assert cone.text(2) == "«done»" and cone.parent().text(2) == "1 of 3 cones"

    def stops():
        return {one["id"]: one["state"] for one in under_way.layers.stops.layer.getFeatures()}

    shown = ["done", "failed", "waiting"]
    wait(lambda: [stops().get(one) for one in (first, *others)] == shown, what="the stops on the map")
    under_way.layers.ways.finish()
    drawn = {one["to_stop"] for one in under_way.layers.ways.layer.getFeatures()}
    assert first not in drawn and set(others) <= drawn


def test_a_plan_that_is_cleared_while_it_is_sent_is_sent_no_further(panel, gateway, wait):
    planned(panel, wait)
    gateway.mute.add("set_queue")
    answer(question(panel), send=True)
    wait(lambda: gateway.asked("set_queue"), 5, "the first queue")
    first = Order(panel.driven.sending._key, "set_queue")
    panel.driven.clear()
    assert not panel.driven.busy and panel.driven.driven is None
    panel._desk.answered.emit(Answer(first, {}))
    QTest.qWait(200)
    assert len(gateway.asked("set_queue")) == 1 and panel.driven.sending is None
