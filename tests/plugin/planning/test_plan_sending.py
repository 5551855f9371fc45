"""A cone plan is sent when the operator agrees, and not otherwise."""

from __future__ import annotations

from dataclasses import replace

import pytest
from fleet_supervisor.plugin.gateway_client.buffers import OperatorRequest, RequestResult
from fleet_supervisor.plugin.planning import plan_views
from fleet_supervisor.robot_bridge.core.messages import TaskState, to_json
from qgis.PyQt.QtCore import Qt
from qgis.PyQt.QtTest import QTest
from qgis.PyQt.QtWidgets import QDialog, QLabel, QLineEdit, QPushButton

from tests.plugin.planning.panel_parts import (
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


FOUND = [f"the path to ({x}.00, 40.00) enters the keepout 'Water basin'" for x in (75, 80)]
QUEUE_OF_R2 = "the queue of r2: the path to (75.00, 40.00) enters the keepout 'Water basin'."


def sent_to(gateway, robot):
    return [one for one in gateway.asked("set_queue") if one["robot"] == robot]


def hung(iface, part):
    return [text for text in iface.texts() if part in text]


@pytest.fixture
def fenced(panel, gateway, wait):
    """A plan that is being sent: r1 has its queue, and r2 gets its own with an override alone."""
    refusal = {"code": -32007, "message": f"{'; '.join(FOUND)}: choose a place", "data": {"found": FOUND}}

    def answered(params):
        takes_it = params["robot"] == "r1" or "override" in params
        return {"result": {}} if takes_it else {"error": refusal}

    gateway.answers["set_queue"] = answered
    planned(panel, wait)
    answer(question(panel), send=True)
    wait(lambda: panel.driven.refusal is not None, what="the refusal")
    return panel


def override(panel, why="the basin is drained"):
    press(panel, "fleet_plan_override")
    dialog = panel.findChild(QDialog, "fleet_override")
    confirm = dialog.findChild(QPushButton, "fleet_override_confirm")
    assert not confirm.isEnabled() and not confirm.isDefault()
    assert FOUND[0] in told_in(dialog) and FOUND[1] in told_in(dialog)
    QTest.keyClicks(dialog.findChild(QLineEdit, "fleet_override_why"), why)
    return confirm


def told_in(dialog):
    return " ".join(label.text() for label in dialog.findChildren(QLabel))


def test_what_can_be_overridden_waits_and_is_told_once_with_where_that_is_done(fenced, gateway, wait, iface):
    wait(lambda: len(hung(iface, "Water basin")) == 1, what="one text of two")
    (text,) = hung(iface, "Water basin")
    assert "The cone plan is not sent any further" in text and QUEUE_OF_R2 in text
    assert "Override… in the panel Cone plan" in text
    assert QUEUE_OF_R2 in fenced.bar.trouble.text() and "where your role may" in fenced.bar.trouble.text()
    assert not fenced.bar.send.isEnabled() and not fenced.bar.clear.isEnabled()
    assert len(sent_to(gateway, "r2")) == 1


def test_an_override_sends_the_same_tasks_with_what_was_found_and_why(fenced, gateway, wait, iface):
    confirm = override(fenced)
    assert len(sent_to(gateway, "r2")) == 1
    QTest.mouseClick(confirm, Qt.MouseButton.LeftButton)
    wait(lambda: not fenced.driven.busy, what="the rest of the plan")
    refused, done = sent_to(gateway, "r2")
    assert done["tasks"] == refused["tasks"] and "override" not in refused
    assert done["override"] == " ".join(f"{text}." for text in FOUND) + " because: the basin is drained"
    assert len(sent_to(gateway, "r1")) == 1
    wait(lambda: hung(iface, "Water basin") == [], what="the text of what is over")
    assert hung(iface, "as a whole") == []
    assert not fenced.bar.override.isEnabled()


def test_a_plan_that_is_not_to_be_overridden_stays_as_far_as_it_was_sent(fenced, gateway, wait, iface):
    press(fenced, "fleet_plan_leave")
    assert not fenced.driven.busy and fenced.driven.refusal is None
    wait(lambda: len(hung(iface, "Water basin")) == 1, what="one text of two")
    (text,) = hung(iface, "Water basin")
    assert "was not sent as a whole" in text and "Done before: the queue of r1" in text
    assert len(sent_to(gateway, "r2")) == 1


def test_what_was_not_sent_is_told_until_a_plan_is_sent_or_watched_no_more(fenced, gateway, wait, iface):
    gateway.answers["set_queue"] = lambda params: {"error": {"code": -32000, "message": "no such robot"}}
    press(fenced, "fleet_plan_leave")
    wait(lambda: hung(iface, "was not sent as a whole"), what="the text")
    press(fenced, "fleet_plan_clear")
    wait(lambda: not hung(iface, "was not sent as a whole"), what="the end of it")
    planned(fenced, wait)
    answer(question(fenced), send=True)
    wait(lambda: len(hung(iface, "no such robot")) == 2, what="the refusal, and what was not done therefore")
    gateway.answers["set_queue"] = lambda params: {"result": {}}
    press(fenced, "fleet_plan_clear")
    planned(fenced, wait)
    answer(question(fenced), send=True)
    wait(lambda: not hung(iface, "no such robot"), what="the end of both")


def test_a_plan_that_waits_for_the_end_of_a_stop_says_so_until_that_is_cleared(panel, gateway, wait, iface):
    planned(panel, wait)
    gateway.stand(in_force=True, stop="s1", at=1.0, by="bob")
    wait(lambda: panel._desk.emergency.in_force, what="the stop")
    answer(question(panel), send=True)
    wait(lambda: hung(iface, "An emergency stop is in force"), what="the refusal")
    gateway.stand(in_force=False)
    wait(lambda: not hung(iface, "An emergency stop is in force"), what="the end of it")


def test_an_override_that_the_role_does_not_reach_is_refused_as_that_of_a_draft_is(
    fenced, gateway, wait, iface
):
    confirm = override(fenced)
    gateway.refuse["set_queue"] = "set_queue: anna is operator, and an override takes supervisor"
    QTest.mouseClick(confirm, Qt.MouseButton.LeftButton)
    wait(lambda: hung(iface, "was not sent as a whole"), what="the refusal")
    (text,) = hung(iface, "was not sent as a whole")
    assert "an override takes supervisor" in text and "Not done therefore: letting r2 go on" in text
    assert not fenced.driven.busy and fenced.driven.refusal is None


def test_nothing_is_overridden_while_an_emergency_stop_is_in_force(fenced, gateway, wait, iface):
    confirm = override(fenced)
    gateway.stand(in_force=True, stop="stop-1", at=1.0, by="bert")
    wait(lambda: fenced._desk.emergency is not None and fenced._desk.emergency.in_force, 5)
    QTest.mouseClick(confirm, Qt.MouseButton.LeftButton)
    wait(lambda: hung(iface, "An emergency stop is in force"), 5)
    assert len(sent_to(gateway, "r2")) == 1 and fenced.driven.refusal is not None


def test_an_override_of_a_plan_that_was_cleared_behind_the_dialog_is_none(fenced, gateway, wait, iface):
    confirm = override(fenced)
    fenced.driven.clear()
    wait(lambda: hung(iface, "Water basin") == [], what="the text of what is over")
    QTest.mouseClick(confirm, Qt.MouseButton.LeftButton)
    assert hung(iface, "Nothing was overridden")
    QTest.qWait(200)
    assert len(sent_to(gateway, "r2")) == 1


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
    monkeypatch.setattr(plan_views, "_WORDS", {state: f"«{state.value}»" for state in TaskState})
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
    first = OperatorRequest(panel.driven.sending._key, "set_queue")
    panel.driven.clear()
    assert not panel.driven.busy and panel.driven.driven is None
    panel._desk.answered.emit(RequestResult(first, {}))
    QTest.qWait(200)
    assert len(gateway.asked("set_queue")) == 1 and panel.driven.sending is None
