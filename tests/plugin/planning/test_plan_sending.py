"""A cone plan is submitted to the gateway when the operator agrees, and not otherwise."""

from __future__ import annotations

from dataclasses import replace

import pytest
from fleet_supervisor.plugin.planning import plan_texts
from fleet_supervisor.robot_bridge.core.assignment.plan import plan_of_document
from fleet_supervisor.robot_bridge.core.messages.base import to_json
from fleet_supervisor.robot_bridge.core.messages.queues import TaskState
from qgis.PyQt.QtCore import Qt
from qgis.PyQt.QtTest import QTest
from qgis.PyQt.QtWidgets import QDialog, QLabel, QLineEdit, QPushButton

from tests.plugin.planning.panel_parts import answer, child, cones_of, hung, key, planned, press, question
from tests.support.bridge.bridge_programs import wait_until


def test_only_send_and_a_second_send_submit_the_plan_whole(panel, plans, gateway, wait):
    plan = planned(panel, wait)
    box = question(panel)
    assert "r1: 3 cones" in box.text() and "The robots set off at once" in box.text()
    answer(box, send=False)
    QTest.qWait(200)
    assert gateway.requests_of("submit_plan") == []
    answer(question(panel), send=True)
    wait(lambda: panel.driven.known is not None and not panel.driven.busy, 10, "the gateway's report")
    (sent,) = gateway.requests_of("submit_plan")
    assert plan_of_document(sent["document"]) == plan
    assert sent["revisions"] == {"r1": 0, "r2": 0} and sent["by_itself"] is False
    assert {(one["id"], one["cone"], one["layout"]) for one in sent["cones"]} == {
        (f"row-{n}", f"row-{n}", "row") for n in range(1, 7)
    }
    assert gateway.requests_of("set_queue") == [] and "Under way: 0 of 6 cones" in panel.bar.text.text()
    assert panel.drafts.draft is None, "it is the gateway's from now on"
    key(panel, child(panel, "r1", cones_of(plan)["r1"][0]), Qt.Key.Key_Delete)
    assert not panel.drafts.busy, "what is driven is not edited"


def test_what_was_refused_is_said_and_the_plan_can_be_sent_again(panel, plans, gateway, wait, iface):
    plan = planned(panel, wait)
    gateway.refuse["submit_plan"] = "robot 'r1' drives plan 'x'; clear that first, or leave it out"
    answer(question(panel), send=True)
    wait(lambda: hung(iface, "clear that first, or leave it out"), 10, "the refusal")
    assert panel.drafts.draft.plan is plan and panel.driven.known is None
    gateway.refuse.clear()
    answer(question(panel), send=True)
    wait(lambda: panel.driven.known is not None, 10, "the report")
    wait(lambda: not hung(iface, "clear that first"), what="the end of what is over")


FOUND = [f"the path to ({x}.00, 40.00) enters the keepout 'Water basin'" for x in (75, 80)]
SAID = "Sending the cone plan: the path to (75.00, 40.00) enters the keepout 'Water basin'."


@pytest.fixture
def fenced(panel, plans, gateway, wait):
    """A plan that the gateway takes with an override alone."""
    refusal = {"code": -32007, "message": f"{'; '.join(FOUND)}: choose a place", "data": {"found": FOUND}}
    gateway.answers["submit_plan"] = lambda params: (
        plans.submit(params) if "override" in params else {"error": refusal}
    )
    planned(panel, wait)
    answer(question(panel), send=True)
    wait(lambda: panel.driven.refusal is not None, what="the refusal")
    return panel


def override(panel, why="the basin is drained"):
    press(panel, "fleet_plan_override")
    dialog = panel.findChild(QDialog, "fleet_override")
    confirm = dialog.findChild(QPushButton, "fleet_override_confirm")
    assert not confirm.isEnabled() and not confirm.isDefault()
    told = " ".join(label.text() for label in dialog.findChildren(QLabel))
    assert FOUND[0] in told and FOUND[1] in told
    QTest.keyClicks(dialog.findChild(QLineEdit, "fleet_override_why"), why)
    return confirm


def press_it(button):
    QTest.mouseClick(button, Qt.MouseButton.LeftButton)


def test_what_can_be_overridden_waits_and_is_told_once_with_where_that_is_done(fenced, gateway, wait, iface):
    wait(lambda: len(hung(iface, "Water basin")) == 1, what="one text of two")
    (text,) = hung(iface, "Water basin")
    assert "The cone plan was not sent" in text and SAID in text
    assert "Override… in the panel Cone plan" in text
    assert SAID in fenced.bar.trouble.text() and "where your role may" in fenced.bar.trouble.text()
    assert "Not sent yet: 6 cones" in fenced.bar.text.text() and fenced.driven.known is None


def test_an_override_sends_the_same_plan_with_what_was_found_and_why(fenced, gateway, wait, iface):
    confirm = override(fenced)
    assert len(gateway.requests_of("submit_plan")) == 1
    press_it(confirm)
    wait(lambda: fenced.driven.known is not None and not fenced.driven.busy, what="the plan")
    refused, done = gateway.requests_of("submit_plan")
    assert done.pop("override") == " ".join(f"{text}." for text in FOUND) + " because: the basin is drained"
    assert done == refused
    wait(lambda: hung(iface, "Water basin") == [], what="the text of what is over")
    assert not fenced.bar.override.isEnabled()


def test_a_plan_that_was_changed_is_not_sent_by_the_override_of_another(fenced, gateway, wait, iface):
    confirm = override(fenced)
    first = cones_of(fenced.drafts.draft.plan)["r1"][0]
    fenced.drafts.remove(first)
    wait(lambda: not fenced.drafts.busy, 10, "the change")
    assert not fenced.bar.override.isEnabled()
    press_it(confirm)
    wait(lambda: hung(iface, "Nothing was overridden"), what="the text")
    assert len(gateway.requests_of("submit_plan")) == 1


def test_an_override_that_is_refused_leaves_the_plan_and_says_why(fenced, gateway, wait, iface):
    confirm = override(fenced)
    gateway.refuse["submit_plan"] = "submit_plan: anna is operator, and an override takes supervisor"
    press_it(confirm)
    wait(lambda: hung(iface, "an override takes supervisor"), what="the refusal")
    assert fenced.drafts.draft is not None and fenced.driven.refusal is None
    press(fenced, "fleet_plan_clear")
    wait(lambda: not hung(iface, "an override takes supervisor"), what="the end of it")
    assert fenced.drafts.draft is None


def test_a_refusal_because_of_an_emergency_stop_is_told_until_that_is_cleared(panel, gateway, wait, iface):
    planned(panel, wait)
    gateway.stand(in_force=True, stop="s1", at=1.0, by="bob")
    wait(lambda: panel._desk.state.emergency.in_force, what="the stop")
    gateway.refuse["submit_plan"] = "an emergency stop is in force; it has to be cleared first"
    answer(question(panel), send=True)
    wait(lambda: hung(iface, "an emergency stop is in force"), what="the refusal")
    gateway.stand(in_force=False)
    wait(lambda: not hung(iface, "an emergency stop is in force"), what="the end of it")


def test_the_question_names_robots_that_moved_and_would_meet(panel, gateway, wait, make_robot):
    panel.form.apart.setValue(50.0)
    planned(panel, wait)
    gateway.show(make_robot("r1", 50, 48))
    wait(lambda: panel._desk.state.robots.view("r1", panel._desk.clock.steady()).report.y == 48, 5)
    text = question(panel).text()
    assert "r1 is 8.0 m from where the plan begins" in text
    assert "r1 and r2 come within" in text


def test_a_plan_that_is_driven_is_not_thrown_away_by_another_preview(under_way, gateway, wait, iface):
    driven = under_way.driven.known
    press(under_way, "fleet_plan_preview")
    wait(lambda: hung(iface, "A plan is being driven"), 5)
    assert under_way.driven.known is driven and not under_way.drafts.busy
    under_way.collect(None)
    assert gateway.requests_of("collect_layout") == []


def test_what_stands_on_one_site_is_collected_on_no_other(panel, gateway):
    desk, greeted = panel._desk, gateway.subscriptions
    stands = {"task": "collected-1", "kind": "collect", "x": 75.0, "y": 40.0, "cone": "c1", "placement": 1}
    gateway.answers["collect_layout"] = lambda params: {"result": {"tasks": [stands], "in_queues": 0}}
    # A window that stands still: the answer lies there when another site is served.
    desk.state._timer.stop()
    panel.collect(None)
    wait_until(lambda: desk.state._source._buffer._update.answers)
    gateway.stop()
    gateway.site = replace(gateway.site, origin=(1000.0, 2000.0))
    gateway.start()
    wait_until(lambda: gateway.subscriptions != greeted)
    refused = []
    panel.collecting.refused.connect(refused.append)
    desk.state.pull()
    assert refused == []
    assert desk.state.site.origin == (1000.0, 2000.0)
    assert not panel.drafts.busy and panel.drafts.draft is None


def test_a_plan_that_is_cleared_is_asked_of_the_gateway_and_shown_no_longer(under_way, plans, gateway, wait):
    press(under_way, "fleet_plan_clear")
    wait(lambda: under_way.driven.known is None, 5)
    assert gateway.requests_of("clear_plan") == [{"plan": plans.name}]
    assert "No plan" in under_way.bar.text.text()


def test_a_site_that_is_published_anew_or_chosen_keeps_the_plan_and_another_does_not(
    under_way, gateway, wait, site
):
    name = under_way.driven.shown
    for change in ({"version": "2"}, {"id": "chosen"}):
        gateway.tell("site", to_json(replace(site, **change)))
        wait(lambda change=change: change.items() <= to_json(under_way._desk.state.site).items(), 5)
        assert under_way.driven.shown == name
    gateway.tell("site", to_json(replace(site, origin=(1.0, 2.0))))
    wait(lambda: under_way.driven.known is None, 5)
    assert gateway.requests_of("clear_plan") == []


def test_what_is_done_is_counted_and_off_the_map_in_every_language(under_way, plans, wait, monkeypatch):
    monkeypatch.setattr(plan_texts, "_WORDS", {state: f"«{state.value}»" for state in TaskState})
    first, *others = cones_of(under_way.driven.shown_plan)["r1"]
    states = {first: ("done", None), others[0]: ("failed", "a wall"), others[1]: ("waiting", None)}
    plans.tell(steps=0, done=1, states=states)
    wait(lambda: under_way.driven.known.report.done == 1, 5)
    cone = child(under_way, "r1", first)
    assert cone.text(2) == "«done»" and cone.parent().text(2) == "1 of 3 cones"
    assert child(under_way, "r1", others[0]).text(2) == "«failed»: a wall"
    assert "Under way: 1 of 6 cones" in under_way.bar.text.text()

    def stops():
        return {one["id"]: one["state"] for one in under_way.layers.stops.layer.getFeatures()}

    shown = ["done", "failed", "waiting"]
    wait(lambda: [stops().get(one) for one in (first, *others)] == shown, what="the stops on the map")
    under_way.layers.ways.finish()
    drawn = {one["to_stop"] for one in under_way.layers.ways.layer.getFeatures()}
    assert first not in drawn and set(others) <= drawn


def test_a_plan_whose_answer_was_lost_is_the_gateways_all_the_same(panel, plans, gateway, wait):
    planned(panel, wait)
    gateway.mute.add("submit_plan")
    answer(question(panel), send=True)
    wait(lambda: gateway.requests_of("submit_plan"), 10)
    assert "Being sent" in panel.bar.text.text() and not panel.bar.send.isEnabled()
    assert not panel.preview.isEnabled(), "the draft stays until it is known what became of it"
    plans.submit(gateway.requests_of("submit_plan")[0])
    plans.tell(steps=0)
    wait(lambda: panel.driven.known is not None and panel.drafts.draft is None, 10, "the plan")
    assert panel.driven.shown == plans.name


def test_a_gateway_that_knows_no_plans_is_named_and_nothing_is_sent(panel, gateway, wait, iface):
    gateway.answers["get_plans"] = lambda params: {"error": {"code": -32601, "message": "no such method"}}
    subscribed = gateway.subscriptions
    gateway.stop()
    gateway.start()
    wait(lambda: gateway.subscriptions > subscribed and panel.driven.is_without_plans, 15, "the link")
    planned(panel, wait)
    assert "older than this plugin and drives no cone plans" in panel.bar.trouble.text()
    answer(question(panel), send=True)
    wait(lambda: hung(iface, "with Add to queue"), 5)
    assert gateway.requests_of("submit_plan") == [] and panel.drafts.draft is not None
