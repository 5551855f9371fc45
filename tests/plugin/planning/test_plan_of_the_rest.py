"""A plan that the gateway drives is steered and followed, whichever desk submitted it."""

from __future__ import annotations

import pytest
from fleet_supervisor.plugin.control.messages import PLAN_REQUEST
from qgis.PyQt.QtCore import Qt
from qgis.PyQt.QtTest import QTest

from tests.plugin.planning.panel_parts import (
    LOST_R1,
    child,
    cones_of,
    hung,
    lose_r1,
    offered,
    planned,
    press,
    queue,
    submitted,
)

STEERING = ("pause_plan", "resume_plan", "replan", "confirm_replan", "discard_replan", "clear_plan")


def steered(gateway):
    return [(method, params) for method, params in gateway.requests if method in STEERING]


def state_of(panel):
    known = panel.driven.known
    return None if known is None else known.report.state.value


def test_a_lost_robot_is_told_and_nothing_is_confirmed_before_somebody_agrees(
    under_way, plans, gateway, wait, iface
):
    lose_r1(under_way, plans, wait)
    assert len(hung(iface, "r1 is lost or offline")) == 1 and "r1 is lost" in under_way.bar.trouble.text()
    assert steered(gateway) == []
    offered(under_way, plans, wait)
    name = plans.name
    assert steered(gateway) == [("replan", {"plan": name, "revision": 1, "try_again": False})]
    assert "New plan, not sent yet: 6 cones, 1 robot" in under_way.bar.text.text()
    assert under_way.tree.topLevelItem(0).text(2) == "LOST, 0 cones"
    assert cones_of(under_way.driven.shown_plan)["r1"] == []
    press(under_way, "fleet_plan_confirm")
    wait(lambda: state_of(under_way) == "driven" and not under_way.driven.asking, 10)
    assert steered(gateway)[1:] == [("confirm_replan", {"plan": name, "revision": 3})]
    plans.tell(problems=[], robots=["r2"])
    wait(lambda: not hung(iface, "r1 is lost or offline"), what="the end of what is over")
    assert under_way.bar.trouble.text() == ""


def test_what_speaks_against_a_new_plan_is_counted_beside_it(under_way, plans, wait):
    lose_r1(under_way, plans, wait)
    offered(under_way, plans, wait, meetings=2, closed=1)
    text = under_way.bar.trouble.text()
    assert text == "1 way leads along a closed road; robots come too near to one another at 2 places"


@pytest.mark.parametrize("again", [False, True])
def test_a_cone_that_failed_is_told_and_given_up_or_tried_again(
    under_way, plans, gateway, wait, iface, again
):
    first = cones_of(under_way.driven.shown_plan)["r1"][0]
    assert not under_way.bar.again.isEnabled()
    plans.tell(steps=0, problems=[{"kind": "failed", "stop": first, "reason": "a wall"}])
    wait(lambda: hung(iface, f"cone {first} failed: a wall"), 5)
    assert under_way.bar.again.isEnabled() and not under_way.bar.again.isChecked()
    under_way.bar.again.setChecked(again)
    press(under_way, "fleet_plan_rest")
    wait(lambda: gateway.requests_of("replan"), 5)
    assert gateway.requests_of("replan")[0]["try_again"] is again


def test_a_road_that_was_closed_is_told_until_it_is_open_again(under_way, plans, wait, iface):
    closed = {"kind": "closed", "robot": "r1", "stop": "row-2", "reason": "tree"}
    plans.tell(steps=0, problems=[closed])
    wait(lambda: hung(iface, "the way of r1 to row-2 leads along a closed road (tree)"), 5)
    plans.tell(steps=0, problems=[])
    wait(lambda: not hung(iface, "leads along a closed road"), 5)


def test_going_on_as_before_discards_the_new_plan(under_way, plans, gateway, wait):
    lose_r1(under_way, plans, wait)
    offered(under_way, plans, wait)
    press(under_way, "fleet_plan_discard")
    wait(lambda: state_of(under_way) == "driven", 5)
    assert gateway.requests_of("discard_replan") == [{"plan": plans.name, "revision": 3}]
    assert "New plan" not in under_way.bar.text.text()


def test_what_another_operator_did_meanwhile_is_shown_in_place_of_what_was_seen(
    under_way, plans, gateway, wait, iface
):
    report = plans._changed(plans.name, state="paused", by="bert", reason="people on the track")
    press(under_way, "fleet_plan_rest")
    wait(lambda: hung(iface, "look at it again"), 5, "the refusal")
    assert under_way.driven.known.report.revision == report["revision"]
    assert under_way.bar.text.text().endswith("Paused: r1, r2 (bert: people on the track)")


def test_a_plan_is_paused_and_goes_on_by_one_button_each(under_way, plans, gateway, wait):
    assert not under_way.bar.resume.isEnabled()
    press(under_way, "fleet_plan_pause")
    wait(lambda: state_of(under_way) == "paused", 5)
    assert under_way.bar.text.text() == "Under way: 0 of 6 cones. Paused: r1, r2 (anna)"
    press(under_way, "fleet_plan_resume")
    wait(lambda: state_of(under_way) == "driven", 5)
    assert steered(gateway) == [
        ("pause_plan", {"plan": plans.name}),
        ("resume_plan", {"plan": plans.name, "revision": 2}),
    ]


def test_robots_that_somebody_paused_are_named_also_when_they_do_not_go_on(under_way, gateway, wait, iface):
    for robot, states in (("r1", ["failed", "waiting", "waiting"]), ("r2", ["waiting"] * 3)):
        why = {"state": "paused", "at": 50.0, "by": "bert", "reason": "paused by bert"}
        gateway.tell("queue", queue(under_way, robot, states, **why))
    wait(lambda: under_way.driven.paused == ["r2"], 5, "the pause, without the robot whose cone failed")
    assert under_way.bar.text.text() == "Under way: 0 of 6 cones. Paused: r2 (paused by bert)"
    press(under_way, "fleet_plan_resume")
    wait(lambda: hung(iface, "The queue of r2 stays paused (paused by bert)"), 5, "what did not go on")


def test_a_queue_that_somebody_else_holds_is_named_when_a_new_plan_is_confirmed(
    under_way, plans, gateway, wait, iface
):
    held = {"state": "paused", "reason": "paused by bert", "by": "bert", "at": 77.0}
    gateway.tell("queue", queue(under_way, "r2", ["waiting"] * 3, **held))
    offered(under_way, plans, wait)
    press(under_way, "fleet_plan_confirm")
    wait(lambda: hung(iface, "r2 stays paused (paused by bert)"), 10)


def test_no_click_is_lost_between_two_and_a_pause_waits_for_no_answer(under_way, plans, gateway, wait):
    press(under_way, "fleet_plan_pause")
    wait(lambda: state_of(under_way) == "paused", 5)
    gateway.mute.add("resume_plan")
    press(under_way, "fleet_plan_resume")
    assert "Being sent" in under_way.bar.text.text()
    bar = under_way.bar
    for button in (bar.resume, bar.rest, bar.confirm, bar.discard, bar.clear, bar.send):
        assert not button.isEnabled(), "what cannot be asked now cannot be pressed either"
    press(under_way, "fleet_plan_pause")
    wait(lambda: [method for method, _ in steered(gateway)] == ["pause_plan", "resume_plan", "pause_plan"], 5)


@pytest.mark.parametrize(
    ("state", "buttons"),
    [("driven", ("rest", "clear", "pause")), ("paused", ("resume",)), ("proposed", ("confirm", "discard"))],
)
def test_every_refusal_is_told_with_its_reason(under_way, plans, gateway, wait, iface, state, buttons):
    if state == "proposed":
        offered(under_way, plans, wait)
    else:
        plans.tell(state=state)
    wait(lambda: state_of(under_way) == state, 5)
    for button in buttons:
        why = f"{button}: anna is viewer, and that takes operator"
        gateway.refuse.update(dict.fromkeys(STEERING, why))
        press(under_way, f"fleet_plan_{button}")
        wait(lambda why=why: hung(iface, why), 5)
        assert state_of(under_way) == state and not under_way.driven.asking


def test_what_is_sent_by_itself_is_chosen_before_and_told_when_it_happened(
    panel, plans, gateway, wait, iface
):
    told = []
    panel.driven.hint.connect(told.append)
    panel.bar.by_itself.click()
    submitted(panel, plans, wait)
    assert gateway.requests_of("submit_plan")[0]["by_itself"] is True
    assert panel.bar.by_itself.isChecked() and not panel.bar.by_itself.isEnabled()
    why = "plan of what is left: r1 is lost or offline"
    plans.tell(steps=3, by="gateway", reason=why, robots=["r2"])
    wait(lambda: any("sent by itself" in text and why in text for text in told), 5)
    plans.tell(by="gateway", reason="no robot of plan 'x' is left to take over", problems=LOST_R1)
    wait(lambda: hung(iface, "No new cone plan was sent by itself: no robot of plan"), 5)
    why = "what is left could not be planned: it took too long"
    plans.tell(by="gateway", reason=why, state="paused")
    wait(lambda: hung(iface, f"The cone plan is paused: {why}."), 5)
    wait(lambda: not hung(iface, "No new cone plan was sent by itself"), 5, "the end of what is over")
    press(panel, "fleet_plan_resume")
    wait(lambda: not hung(iface, "could not be planned"), 5, "the end of what is over")


def berts(plans, gateway, name="berts", robots=("r1", "r2")):
    """Have bert submit once more what was submitted first."""
    params = {**gateway.requests_of("submit_plan")[0], "plan": name}
    report = plans.submit(params, by="bert")["result"]
    report["robots"] = list(robots)
    return report


def test_the_plan_of_another_operator_is_shown_and_can_be_steered(under_way, plans, gateway, wait, iface):
    own = plans.name
    press(under_way, "fleet_plan_clear")
    wait(lambda: under_way.driven.known is None, 5)
    gateway.tell("plan", berts(plans, gateway))
    wait(lambda: under_way.which.count() == 2, 5)
    assert under_way.driven.known is None, "no button is another plan's all at once"
    under_way.which.setCurrentIndex(1)
    under_way.which.activated.emit(1)
    wait(lambda: under_way.driven.shown_plan is not None, 5, "its document")
    assert under_way.which.currentText().startswith("bert, ") and own != under_way.driven.shown
    assert child(under_way, "r1", "row-1") and under_way.tree.topLevelItemCount() == 2
    press(under_way, "fleet_plan_pause")
    wait(lambda: gateway.requests_of("pause_plan") == [{"plan": "berts"}], 5)
    plans.tell(state="cleared", by="bert")
    wait(lambda: hung(iface, "bert cleared the cone plan"), 5)
    assert under_way.driven.known is None and under_way.which.count() == 1


def test_a_new_plan_is_made_beside_one_that_others_drive(under_way, plans, gateway, wait):
    own = under_way.driven.shown
    assert under_way.which.currentData() == own
    under_way.which.setCurrentIndex(0)
    under_way.which.activated.emit(0)
    planned(under_way, wait)
    assert "Not sent yet: 6 cones" in under_way.bar.text.text()
    plans.tell(steps=0, done=1)
    wait(lambda: under_way._desk.state.plans.get(own).report.done == 1, 5)
    assert under_way.drafts.draft is not None and under_way.driven.known is None


def test_a_desk_that_is_started_again_shows_what_is_driven(under_way, plans, gateway, wait, plugin, iface):
    subscribed = gateway.subscriptions
    gateway.stop()
    plans.tell(done=2)
    # What the window knows of it is gone, as with another QGIS.
    under_way._desk.state.plans.clear()
    under_way.driven.forget()
    gateway.start()
    wait(lambda: gateway.subscriptions > subscribed, 15, "the link")
    wait(lambda: under_way.driven.shown_plan is not None, 10, "the plan")
    assert under_way.bar.text.text() == "Under way: 2 of 6 cones"
    assert cones_of(under_way.driven.shown_plan)["r1"] and under_way.tree.topLevelItemCount() == 2


def test_a_plan_that_ended_while_the_link_was_down_is_shown_as_done(under_way, plans, gateway, wait):
    subscribed = gateway.subscriptions
    gateway.stop()
    plans.tell(state="finished", done=6, ended_at=1_700_000_100.0)
    gateway.start()
    wait(lambda: gateway.subscriptions > subscribed, 15, "the link")
    wait(lambda: under_way.bar.text.text() == "Done: 6 of 6 cones", 10)
    press(under_way, "fleet_plan_clear")
    assert gateway.requests_of("clear_plan") == [] and under_way.driven.known is None


def test_nothing_of_a_question_is_left_when_something_else_is_asked(under_way, plans, gateway, wait, iface):
    gateway.refuse["replan"] = "nobody is left"
    press(under_way, "fleet_plan_rest")
    wait(lambda: hung(iface, "nobody is left"), 5)
    under_way._desk.messages.end(PLAN_REQUEST)
    assert hung(iface, "nobody is left")
    press(under_way, "fleet_plan_pause")
    wait(lambda: not hung(iface, "nobody is left"), 5)
    QTest.keyClick(under_way.tree, Qt.Key.Key_Delete)
    assert not under_way.drafts.busy
