"""The connection goes away at the worst moment: what was asked for is done once, or visibly refused."""

from __future__ import annotations

from types import SimpleNamespace

import pytest
from fleet_supervisor.plugin.control.pending_command import ApproachKind
from fleet_supervisor.plugin.gateway_client.connection_status import ConnectionPhase
from fleet_supervisor.robot_bridge.core.messages.commands import CommandState

from tests.support.bridge.cut_line import CutLine
from tests.support.operators import ask

SLOW = 60, 0.1
"""Bytes that reach the gateway at a time, and seconds between them."""


@pytest.fixture
def line(loop):
    made = CutLine(loop.port)
    yield made
    made.close()


@pytest.fixture
def desk(loop, line, operator):
    """The operator at the end of the line, with a target on the map for a robot that stands."""
    loop.start_robot("r1", (20, 8, 0), speed=2)
    operator.connect_to(SimpleNamespace(address=line.address, find_first_way=loop.find_first_way), ["r1"])
    operator.select("r1")
    operator.choose("fleet_cone_target")
    operator.click_site(110.0, 8.0)
    drafts = operator.desk.drafts
    operator.wait_for_draft("the target")
    operator.wait("its way", lambda: drafts.draft.way.kind is not ApproachKind.SOUGHT, 20)
    return operator


def sent(loop):
    """Return what the gateway was asked to send, the newest first."""
    (answer,) = ask(loop.address, ("get_commands", {"robot": "r1"}))
    return [command["op"] for command in answer["commands"]]


def queued(loop):
    (answer,) = ask(loop.address, ("get_queue", {"robot": "r1"}))
    return [task["kind"] for queue in answer["queues"] for task in queue["tasks"]]


def answered(desk):
    desk.wait("every answer", lambda: not len(desk.desk.orders), 30)


def test_the_abort_goes_before_the_target_that_it_made_void_and_that_is_not_sent(desk, loop, line, iface):
    line.cut()
    desk.press("fleet_send")
    desk.wait("the target asked for", lambda: len(desk.desk.orders) == 1, 10)
    desk.press("fleet_abort")
    desk.wait("the Abort asked for", lambda: len(desk.desk.orders) == 2, 10)
    # Each message arrives by itself: at the gateway none is there to be overtaken.
    line.slow_down(*SLOW)
    line.mend(reset=True)
    answered(desk)
    assert sent(loop) == ["Abort"]
    (text,) = (text for text in iface.texts() if "Cone for r1" in text)
    assert "it was not sent again: robots were asked to stop after it" in text
    assert desk.desk.drafts.draft is not None


def test_a_target_that_was_sent_before_the_abort_ends_with_it(desk, loop, line, iface):
    line.cut(only_back=True)
    desk.press("fleet_send")
    desk.wait("the target at the gateway", lambda: sent(loop) == ["SetPath"], 20)
    desk.press("fleet_abort")
    line.mend(reset=True)
    answered(desk)
    desk.wait_for_state("r1", "SetPath", CommandState.ABORTED)
    assert sent(loop) == ["Abort", "SetPath"]


def test_a_task_whose_answer_was_lost_is_in_the_queue_once_and_not_told_to_be_missing(
    desk, loop, line, plugin, iface
):
    line.cut(only_back=True)
    desk.press("fleet_enqueue")
    desk.wait("the task at the gateway", lambda: queued(loop) == ["place"], 20)
    line.mend(reset=True)
    answered(desk)
    assert queued(loop) == ["place"]
    assert not any("into the queue" in text for text in iface.texts())
    assert plugin.window.queue_edits.conflict("r1") == "" and desk.desk.drafts.draft is None


def test_a_stop_on_a_link_that_was_given_up_for_another_is_told(desk, line, plugin, iface, wait):
    line.cut()
    desk.desk.emergency_stop()
    for _ in ("Disconnect", "Connect"):
        plugin.window.actions.connect.trigger()
    line.mend(reset=True)
    desk.wait("the link", lambda: desk.desk.state.link.phase is ConnectionPhase.CONNECTED, 20)
    desk.wait("what became of the stop", lambda: not desk.desk.orders.awaits_stop, 10)
    assert any("EMERGENCY STOP: The link was closed before" in text for text in iface.texts())
