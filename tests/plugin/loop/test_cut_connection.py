"""The connection goes away at the worst moment: what was asked for is done once, or visibly refused."""

from __future__ import annotations

import dataclasses
from types import SimpleNamespace

import pytest
from fleet_supervisor.plugin.control.pending_command import ApproachKind
from fleet_supervisor.plugin.gateway_client import connection
from fleet_supervisor.plugin.gateway_client.connection_status import ConnectionPhase, OperatorCredentials
from fleet_supervisor.plugin.gateway_client.fleet_state import OperatorRequest
from fleet_supervisor.robot_bridge.core.clock import steady_time
from fleet_supervisor.robot_bridge.core.messages.commands import CommandState

from robot_bridge.gateway.auth import certificates
from tests.support.bridge.cut_line import CutLine
from tests.support.operators import ask

SLOW = 60, 0.1
"""Bytes that reach the gateway at a time, and seconds between them."""
SLOW_FOR_MUCH = 8_192, 0.04
TASKS, POINTS = 250, 150
"""of a queue of 0.5 MB, which takes longer on that line than a ping may take."""
HASTY = dataclasses.replace(connection.DESK_PACE, ping_interval=0.2)


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


def test_an_abort_goes_before_the_rest_of_a_large_request_that_is_then_done_once(
    start_loop, root, tmp_path, wait, qgis_app, monkeypatch
):
    """Over TLS, where the most waits: the library of Python takes all that it is handed."""
    monkeypatch.setattr(connection, "DESK_PACE", HASTY)
    tls = certificates.create(tmp_path / "tls", [], ["127.0.0.1"])
    site = root / "resources" / "sample_site"
    loop = start_loop(site, "--certificate", tls.certificate, "--key", tls.key)
    loop.start_robot("r1", (20, 8, 0), sql=True)
    loop.start_robot("r2", (40, 8, 0), sql=True)
    line, desk = CutLine(loop.port), connection.ConnectionThread()
    robots, links, answers = set(), [], {}

    def news():
        update = desk.collect_updates()
        robots.update(update.robots.names)
        links.extend([] if update.link.phase in links[-1:] else [update.link.phase])
        answers.update({one.order.key: one for one in update.answers})
        return links

    path = [[30.0 + 0.5 * k, 8.0] for k in range(POINTS)]
    tasks = [{"task": f"task-{k:04d}", "x": path[-1][0], "y": 8.0, "path": path} for k in range(TASKS)]
    large = {"robot": "r2", "revision": 0, "tasks": tasks}
    desk.open(f"wss://127.0.0.1:{line.port}/desk", "anna", OperatorCredentials("", str(tls.ca)))
    try:
        wait(lambda: news() and len(robots) == 2, 20)
        line.slow_down(*SLOW_FOR_MUCH)
        desk.submit(OperatorRequest("large", "add_tasks", large, steady_time()))
        abort = {"robot": "r1", "command": "abort-r1"}
        desk.submit(OperatorRequest("stop", "abort", abort, steady_time()))
        wait(lambda: news() and "stop" in answers, 20)
        assert "large" not in answers and links.count(ConnectionPhase.CONNECTED) == 2, "it waited"
        wait(lambda: news() and "large" in answers, 40)
    finally:
        desk.shut_down()
        line.close()
    assert answers["stop"].error is None
    assert answers["large"].error is None and len(answers["large"].result["tasks"]) == TASKS
    assert links.count(ConnectionPhase.CONNECTED) == 2, "pings waited for the rest of the large request"
