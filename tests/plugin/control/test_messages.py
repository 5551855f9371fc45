"""A message goes when it is no longer true, and the newest one is seen first."""

from __future__ import annotations

import time

import pytest
from fleet_supervisor.plugin.control.messages import (
    EMERGENCY,
    SELECTION,
    Level,
    MessageBoard,
    Topic,
    robot_topic,
)
from fleet_supervisor.plugin.control.pending_command import CONE, PendingCommand
from qgis.PyQt.QtWidgets import QLabel

from tests.plugin.conftest import SmallGateway, robot

CONFLICT = {"robot": "r1", "other": "r2", "kind": "head-on", "x": 50.0, "y": 40.0, "metres": 0.4}
SEND_REFUSED = "an emergency stop is in force since 12:00:00 UTC, by anna"


# --- the board, without a window ---


@pytest.fixture
def board(qgis_app):
    made = MessageBoard()
    made.gone = []
    made.withdrawn.connect(made.gone.append)
    return made


def test_it_goes_with_the_first_of_its_topics_that_ends(board):
    board.post("one", Level.ERROR, EMERGENCY, robot_topic("r1"))
    board.post("two", Level.ERROR, robot_topic("r2"))
    board.end(SELECTION)
    assert board.gone == []
    board.end(robot_topic("r1"))
    assert board.gone == ["one"]
    board.end(EMERGENCY)
    assert board.gone == ["one"]


def test_of_one_kind_all_go_but_those_that_hold(board):
    board.post("one", Level.ERROR, Topic("draft", 1))
    board.post("two", Level.ERROR, Topic("draft", 2))
    board.post("three", Level.ERROR)
    board.end_others("draft", {Topic("draft", 2)})
    assert board.gone == ["one"]
    board.clear()
    assert board.gone == ["one", "two", "three"]


def test_what_the_operator_closed_is_not_kept(board):
    board.post("one", Level.ERROR, EMERGENCY)
    board.forget("one")
    board.end(EMERGENCY)
    assert board.gone == []


# --- the desk ---


def is_told(iface, part):
    return any(part in text for text in iface.texts())


def is_gone(iface, wait, part):
    """Wait until QGIS's bar has deleted the item."""
    wait(lambda: not is_told(iface, part), what=f"the end of {part}")
    return True


def first(iface):
    """What is seen of the message bar."""
    return iface.bar.currentItem().findChild(QLabel, "fleet_notice").text()


def in_conflict(gateway, desk, wait, *conflicts):
    at = time.time() + 20.0
    listed = [{**CONFLICT, "begins": at, "nearest_at": at, **one} for one in conflicts]
    gateway.tell("conflicts", {"t": time.time(), "conflicts": listed, "waiting": []})
    wait(lambda: len(desk.state.conflicts.conflicts) == len(listed), what="the conflicts")


@pytest.fixture
def refused_to_give_way(at_desk, gateway, iface, wait):
    gateway.refuse["resolve_conflict"] = "r1 would have to leave the road"
    in_conflict(gateway, at_desk.desk, wait, {})
    at_desk.desk.resolve_conflict("r1", "r2")
    wait(lambda: is_told(iface, "leave the road"), what="the refusal")
    return at_desk


def test_a_refusal_to_give_way_goes_when_the_robots_are_out_of_each_others_way(
    refused_to_give_way, gateway, iface, wait
):
    in_conflict(gateway, refused_to_give_way.desk, wait)
    assert is_gone(iface, wait, "leave the road")


def test_a_refusal_goes_when_the_same_is_asked_again(refused_to_give_way, gateway, iface, wait):
    gateway.refuse.clear()
    refused_to_give_way.desk.resolve_conflict("r2", "r1")
    assert is_told(iface, "leave the road")
    refused_to_give_way.desk.resolve_conflict("r1", "r2")
    assert is_gone(iface, wait, "leave the road")


def send_refused(window, gateway, iface, wait):
    gateway.refuse["send"] = SEND_REFUSED
    window.desk.selection.select("r1")
    window.actions.cone.trigger()
    iface.click(30, 30)
    window.desk.sending.send()
    wait(lambda: is_told(iface, SEND_REFUSED), what="the refusal")


def test_what_says_that_a_stop_is_in_force_goes_when_it_is_cleared(at_desk, gateway, iface, wait):
    gateway.stand(in_force=True, stop="s1", at=time.time(), by="bob")
    wait(lambda: at_desk.dock.banner.isVisible(), what="the banner")
    send_refused(at_desk, gateway, iface, wait)
    gateway.stand(in_force=False)
    wait(lambda: not at_desk.dock.banner.isVisible(), what="the end of the stop")
    assert is_gone(iface, wait, "in force")


def test_a_refusal_goes_with_its_draft(at_desk, gateway, iface, wait):
    send_refused(at_desk, gateway, iface, wait)
    assert at_desk.desk.drafts.draft is not None
    at_desk.desk.drafts.set_command(PendingCommand("r1", CONE, ((31.0, 30.0),)))
    assert is_gone(iface, wait, SEND_REFUSED)


def test_with_nothing_to_send_that_is_said_until_there_is_something(at_desk, iface, wait):
    at_desk.desk.sending.send()
    assert is_told(iface, "There is nothing to send")
    at_desk.desk.drafts.set_command(PendingCommand("r1", CONE, ((31.0, 30.0),)))
    assert is_gone(iface, wait, "There is nothing to send")


def test_without_a_robot_selected_that_is_said_until_one_is(at_desk, iface, wait):
    at_desk.desk.selection.select(None)
    at_desk.desk.abort_selected()
    assert is_told(iface, "No robot is selected")
    at_desk.desk.selection.select("r1")
    assert is_gone(iface, wait, "No robot is selected")


@pytest.fixture
def elsewhere(site):
    other = SmallGateway(site)
    other.start()
    other.show(robot("r9", 20, 20))
    yield other
    other.stop()


def with_messages(window, gateway, iface, wait):
    """Have an alarm, a refusal and a robot's trouble before the operator."""
    gateway.show(robot("r1", 50, 40, battery=0.01))
    wait(lambda: iface.bar.findChild(QLabel, "fleet_alarm_text") is not None, what="the alarm")
    gateway.refuse["abort_all"] = "not now"
    window.desk.abort_all()
    wait(lambda: is_told(iface, "not now"), what="the refusal")


def nothing_of_before(window, iface, wait):
    wait(
        lambda: window.desk.state.robots.row("r1") is None and len(window.desk.state.robots),
        what="other robots",
    )
    assert is_gone(iface, wait, "not now")
    wait(lambda: iface.bar.findChild(QLabel, "fleet_alarm_text") is None, what="the end of the alarms")


def test_nothing_of_a_gateway_is_left_at_another_one(at_desk, gateway, elsewhere, iface, wait):
    with_messages(at_desk, gateway, iface, wait)
    at_desk.actions.connect.trigger()
    at_desk.dock.connection_panel._url.setText(elsewhere.url)
    at_desk.actions.connect.trigger()
    nothing_of_before(at_desk, iface, wait)


def test_nothing_of_a_database_is_left_at_another_one(at_desk, gateway, iface, wait):
    gateway.database = "one"
    for _ in range(2):
        at_desk.actions.connect.trigger()
    wait(lambda: at_desk.desk.state._database == "one", what="the database")
    with_messages(at_desk, gateway, iface, wait)
    at_desk.actions.connect.trigger()
    gateway.database = "two"
    gateway.robots = {"r9": robot("r9", 20, 20)}
    at_desk.actions.connect.trigger()
    nothing_of_before(at_desk, iface, wait)
    assert is_told(iface, "another database than before")


def test_the_same_gateway_after_an_outage_keeps_what_is_true(at_desk, gateway, iface, wait):
    gateway.database = "one"
    with_messages(at_desk, gateway, iface, wait)
    for _ in range(2):
        at_desk.actions.connect.trigger()
    wait(lambda: at_desk.desk.state.link.phase.value == "connected", what="the link")
    assert is_told(iface, "not now")


def test_what_is_said_again_is_seen_first(at_desk, iface, wait):
    for text in ("one", "two", "one"):
        at_desk.desk.failed.emit(text)
    assert first(iface).endswith(": one")
    wait(lambda: len(iface.texts()) == 2, what="each text once")
