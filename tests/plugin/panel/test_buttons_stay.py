"""No button of the fleet panel moves, whatever is reported or shown."""

from __future__ import annotations

import time

import pytest
from fleet_supervisor.plugin.control.pending_command import CONE, ROUTE, Findings, PendingCommand
from fleet_supervisor.robot_bridge.core.messages.commands import CommandState
from qgis.PyQt.QtTest import QTest
from qgis.PyQt.QtWidgets import QAbstractButton, QToolButton

from tests.support.button_places import Watched

LONG = "a text as long as none that anybody would write here, with a reason, a place and what to do. " * 4


def conflict(robot, other):
    at = time.time() + 20.0
    where = {"x": 50.0, "y": 40.0, "metres": 0.4}
    return {"robot": robot, "other": other, "kind": "head-on", "begins": at, "nearest_at": at, **where}


@pytest.fixture
def panel(at_desk, iface):
    iface.resize(1280, 800)
    QTest.qWait(50)
    return at_desk


@pytest.mark.parametrize("tab", range(5))
def test_no_button_moves_whatever_is_reported(panel, gateway, make_robot, wait, tab):
    desk, dock = panel.desk, panel.dock
    dock.tabs.setCurrentIndex(tab)
    watched = Watched(dock)
    names = [f"robot-{k}-with-a-long-name" for k in range(12)]
    gateway.show(*(make_robot(name, 10.0 * k, 20, battery=0.01) for k, name in enumerate(names)))
    wait(lambda: len(desk.state.robots) == 14, what="the robots")
    dock.table.refresh()
    watched.check("robots have come")
    desk.selection.select(names[0])
    watched.check("a robot is selected")
    found = Findings(refused=(LONG,), warnings=(LONG,))
    for words, draft in (
        ("a draft", PendingCommand(names[0], CONE, ((60.0, 50.0),), is_checked=True)),
        ("a route", PendingCommand(names[0], ROUTE, ((60.0, 50.0), (70.0, 50.0)), is_checked=True)),
        ("a refused draft", PendingCommand(names[0], CONE, ((60.0, 50.0),), found, is_checked=True)),
        (
            "one that can be overridden",
            PendingCommand(names[0], CONE, ((60.0, 50.0),), Findings(overridable=(LONG,)), is_checked=True),
        ),
        (
            "one that was overridden",
            PendingCommand(
                names[0], CONE, ((60.0, 50.0),), Findings(overridable=(LONG,)), override=LONG, is_checked=True
            ),
        ),
    ):
        desk.drafts.set_command(draft)
        watched.check(words)
    desk.drafts.undo()
    watched.check("a draft is taken back")
    desk.drafts.done()
    for text in (LONG, ""):
        desk.hint.emit(text)
        watched.check("something is remarked")
    gateway._queue("c1", names[0], "SetPosEnd", {"x": 60.0, "y": 50.0, "cone": True})
    gateway.step("c1", CommandState.DELIVERED, names[0])
    gateway.step("c1", CommandState.FAILED, names[0], reason=LONG)
    wait(lambda: desk.state.commands.get("c1") is not None, what="the command")
    watched.check("a command has failed")
    task = {
        "robot": names[0],
        "kind": "place",
        "added_by": "anna",
        "added_at": time.time(),
        "x": 6.0,
        "y": 5.0,
    }
    queue = {"robot": names[0], "revision": 1, "robot_state": "fresh", "by": "bob", "at": time.time()}
    for state in ("running", "paused"):
        tasks = [{**task, "task": f"t{k}", "state": "waiting"} for k in range(9)]
        gateway.tell("queue", {**queue, "state": state, "tasks": tasks, "reason": LONG})
        wait(lambda state=state: _state_of(desk, names[0]) == state, what="the queue")
        watched.check(f"its queue is {state}")
    pairs = [conflict(names[k], names[k + 1]) for k in range(5)]
    for listed in (pairs, pairs[2:], pairs[::-1], []):
        gateway.tell("conflicts", {"t": time.time(), "conflicts": listed, "waiting": []})
        wait(lambda listed=listed: len(desk.state.conflicts.conflicts) == len(listed), what="conflicts")
        watched.check(f"{len(listed)} conflicts")


def _state_of(desk, robot):
    queue = desk.state.queues.get(robot)
    return "" if queue is None else queue.state.value


@pytest.mark.parametrize("tab", range(5))
def test_no_button_moves_with_the_banner_and_the_link(panel, gateway, iface, wait, tab):
    desk, dock = panel.desk, panel.dock
    dock.tabs.setCurrentIndex(tab)
    watched = Watched(dock)
    names = [f"robot-{k}" for k in range(30)]
    how = {"in_force": True, "stop": "s1", "at": time.time(), "by": "anna"}
    for more in ({}, {"reason": LONG}, {"waiting": names, "refused": names, "robots": 30, "stored": False}):
        gateway.stand(**how, **more)
        wait(lambda: dock.banner.isVisible(), what="the banner")
        watched.check(f"an emergency stop is in force, {list(more)}")
    gateway.stop()
    wait(lambda: desk.state.link.phase.value == "retrying", what="the loss of the link")
    watched.check("the link is lost")
    panel.actions.connect.trigger()
    wait(lambda: desk.state.link.phase.value == "closed", what="the end of the link")
    watched.check("the link is ended")
    dock.findChild(QToolButton, "fleet_access_button").setChecked(True)
    watched.check("the fields of the token are open")
    gateway.start()
    panel.actions.connect.trigger()
    wait(lambda: desk.state.link.phase.value == "connected", what="the link")
    watched.check("the link is back")
    gateway.stand(in_force=False)
    wait(lambda: not dock.banner.isVisible(), what="the end of the banner")
    watched.check("it is cleared")


def test_a_gateway_that_refuses_moves_no_button(panel, gateway, wait):
    watched = Watched(panel.dock)
    panel.actions.connect.trigger()
    watched.check("the link is ended")
    gateway.protocol = 99
    panel.actions.connect.trigger()
    wait(lambda: panel.desk.state.link.phase.value == "failed", what="the refusal")
    watched.check("the gateway refuses")


def test_what_stops_robots_is_seen_with_everything_open(panel, gateway, wait):
    dock = panel.dock
    gateway.stand(in_force=True, stop="s1", at=time.time(), by="anna")
    wait(lambda: dock.banner.isVisible(), what="the banner")
    panel.actions.connect.trigger()
    dock.findChild(QToolButton, "fleet_access_button").setChecked(True)
    QTest.qWait(50)
    for name in ("fleet_emergency_stop_button", "fleet_abort_all_button", "fleet_clear_emergency_button"):
        button = dock.findChild(QAbstractButton, name)
        assert button.visibleRegion().boundingRect() == button.rect(), name
