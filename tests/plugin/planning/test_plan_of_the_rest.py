"""What is left is planned anew when a robot is lost or a cone failed."""

from __future__ import annotations

import pytest
from fleet_supervisor.plugin.gateway_client.buffers import OperatorRequest, RequestResult
from qgis.PyQt.QtTest import QTest
from qgis.PyQt.QtWidgets import QCheckBox

from tests.plugin.planning.panel_parts import (
    cones_of,
    lose_r1,
    offered,
    press,
    queue,
)


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
    assert box.isEnabled() and not box.isChecked()
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
    under_way.driven.sending._answered(
        RequestResult(OperatorRequest(under_way.driven.sending._key, "pause_queue"), {})
    )
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
    wait(lambda: any("Given up since this plan was made: " in text for text in iface.texts()), 5)
    assert gateway.asked("take_over") == [] and under_way.driven.offer is not None


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


def test_what_was_told_of_a_lost_robot_is_taken_down_when_a_new_plan_is_agreed_to(
    under_way, gateway, wait, iface
):
    lose_r1(under_way, gateway, wait)
    assert any("r1 is lost or offline" in text for text in iface.texts())
    offered(under_way, wait)
    press(under_way, "fleet_plan_confirm")
    wait(lambda: not under_way.driven.busy, 10)
    assert not any("r1 is lost or offline" in text for text in iface.texts())


def pause(under_way, gateway, wait, **why):
    """Pause both queues, as an emergency stop does."""
    for robot in ("r1", "r2"):
        told = {"state": "paused", "at": 50.0, "by": "bert", "reason": "emergency stop by bert", **why}
        gateway.tell("queue", queue(under_way, robot, ["waiting"] * 3, **told))
    wait(lambda: len(under_way.driven.paused) == 2, 5, "the pauses")


def test_a_plan_that_somebody_paused_says_so_and_goes_on_by_one_button(under_way, gateway, wait):
    assert not under_way.bar.resume.isEnabled()
    pause(under_way, gateway, wait)
    assert under_way.bar.text.text() == "Under way: 0 of 6 cones. Paused: r1, r2 (emergency stop by bert)"
    press(under_way, "fleet_plan_resume")
    wait(lambda: len(gateway.asked("resume_queue")) == 2 and not under_way.driven.busy, 10)
    assert [one["robot"] for one in gateway.asked("resume_queue")] == ["r1", "r2"]


def test_no_robot_goes_on_while_an_emergency_stop_is_in_force(under_way, gateway, wait, iface):
    gateway.stand(in_force=True, stop="stop-1", at=1.0, by="bert")
    wait(lambda: under_way._desk.emergency is not None and under_way._desk.emergency.in_force, 5)
    pause(under_way, gateway, wait)
    press(under_way, "fleet_plan_resume")
    wait(lambda: any("An emergency stop is in force" in text for text in iface.texts()), 5)
    assert gateway.asked("resume_queue") == []


def test_a_robot_whose_cone_failed_does_not_go_on_with_the_others(under_way, gateway, wait):
    pause(under_way, gateway, wait)
    gateway.tell("queue", queue(under_way, "r1", ["failed", "waiting", "waiting"], state="paused", at=60.0))
    wait(lambda: list(under_way.driven.paused) == ["r2"], 5)
    press(under_way, "fleet_plan_resume")
    wait(lambda: gateway.asked("resume_queue") and not under_way.driven.busy, 10)
    assert [one["robot"] for one in gateway.asked("resume_queue")] == ["r2"]
