"""Pause robot and Continue, by menu and by key, for every selected robot."""

from __future__ import annotations

import pytest
from fleet_supervisor.plugin.panel.robot_model import TITLES
from fleet_supervisor.robot_bridge.core.messages.queues import QueueState, QueueTask, TaskKind
from fleet_supervisor.robot_bridge.protocol.jsonrpc import FORBIDDEN
from qgis.PyQt.QtCore import Qt
from qgis.PyQt.QtTest import QTest
from qgis.PyQt.QtWidgets import QLabel

ALT = Qt.KeyboardModifier.AltModifier
SHIFT = Qt.KeyboardModifier.ShiftModifier


@pytest.fixture
def driving(at_desk, gateway, wait):
    """A desk whose two robots do tasks of their queues."""
    for robot in ("r1", "r2"):
        cone = QueueTask(f"task-of-{robot}", 60.0, 50.0, kind=TaskKind.PLACE, cone=f"K-{robot}")
        gateway.queues.give(robot, [cone])
    wait(lambda: len(at_desk.desk.state.queues) == 2, what="both queues")
    return at_desk


def line(desk) -> str:
    return desk.dock.findChild(QLabel, "fleet_draft_text").text()


def is_paused(gateway, robot) -> bool:
    return gateway.queues.get(robot).state is QueueState.PAUSED


def test_by_the_menu_every_selected_robot_is_paused_and_goes_on(driving, gateway, wait):
    driving.desk.selection.select_all(["r1", "r2"])
    driving.actions.pause.trigger()
    wait(lambda: is_paused(gateway, "r1") and is_paused(gateway, "r2"), what="both pauses")
    assert [one["robot"] for one in gateway.requests_of("pause_robot")] == ["r1", "r2"]
    wait(lambda: line(driving) == "Pause of r2: done", what="the line")
    wait(driving.actions.go_on.isEnabled, what="Continue")
    driving.actions.go_on.trigger()
    wait(lambda: not is_paused(gateway, "r1") and not is_paused(gateway, "r2"), what="both going on")
    wait(lambda: line(driving) == "r2 continues with place cone K-r2 at 60.00, 50.00: done", what="the line")
    wait(lambda: not driving.actions.go_on.isEnabled(), what="nothing to continue")


def test_both_are_in_menu_and_toolbar_beside_abort_robot(driving, gateway, wait):
    actions, toolbar = driving.actions, driving.toolbar
    for row in (driving.menu_entries(), toolbar.actions()):
        at = row.index(actions.abort)
        assert row[at - 2 : at] == [actions.pause, actions.go_on]
    driving.desk.selection.select("r1")
    toolbar.show()
    QTest.mouseClick(toolbar.widgetForAction(actions.pause), Qt.MouseButton.LeftButton)
    wait(lambda: is_paused(gateway, "r1") and actions.go_on.isEnabled(), what="the pause")
    QTest.mouseClick(toolbar.widgetForAction(actions.go_on), Qt.MouseButton.LeftButton)
    wait(lambda: not is_paused(gateway, "r1"), what="going on")


def test_by_key_too(driving, gateway, iface, wait):
    driving.desk.selection.select("r1")
    QTest.keyClick(iface, Qt.Key.Key_F10, ALT)
    wait(lambda: is_paused(gateway, "r1") and driving.actions.go_on.isEnabled(), what="the pause")
    assert gateway.requests_of("emergency_stop") == []
    QTest.keyClick(iface, Qt.Key.Key_F10, ALT | SHIFT)
    wait(lambda: not is_paused(gateway, "r1"), what="going on")
    assert not is_paused(gateway, "r2")


def test_the_reason_is_told_where_the_queue_is(driving, gateway, wait):
    driving.desk.selection.select("r1")
    driving.dock.tabs.setCurrentWidget(driving.dock.queue_panel)
    driving.actions.pause.trigger()
    head = driving.dock.queue_panel.findChild(QLabel, "fleet_queue_head")
    wait(lambda: "PAUSED" in head.text() and "paused by anna" in head.text(), what="who paused it")


def test_only_where_a_selected_robot_is_paused_there_is_something_to_continue(driving, gateway, wait):
    assert not driving.actions.go_on.isEnabled()
    driving.desk.selection.select("r1")
    driving.actions.pause.trigger()
    wait(driving.actions.go_on.isEnabled, what="Continue")
    driving.desk.selection.select("r2")
    assert not driving.actions.go_on.isEnabled()
    driving.desk.selection.select_all(["r1", "r2"])
    assert driving.actions.go_on.isEnabled()
    driving.actions.go_on.trigger()
    wait(lambda: not is_paused(gateway, "r1"), what="going on")
    assert [one["robot"] for one in gateway.requests_of("resume_queue")] == ["r1"]


def test_without_a_robot_it_says_so(at_desk, gateway, iface):
    at_desk.actions.pause.trigger()
    assert any("none was paused" in text for text in iface.texts())
    assert gateway.requests_of("pause_robot") == []


def test_who_may_not_is_told_by_the_gateway(driving, gateway, iface, wait):
    refusal = "pause_robot: anna is viewer, and this takes operator"
    gateway.answers["pause_robot"] = lambda params: {"error": {"code": FORBIDDEN, "message": refusal}}
    driving.desk.selection.select("r1")
    driving.actions.pause.trigger()
    wait(lambda: is_told(iface, refusal), what="the refusal")
    assert not is_paused(gateway, "r1")


def is_told(iface, refusal):
    return any(f"Pause of r1: {refusal}" in text for text in iface.texts())


def test_its_refusal_goes_when_the_queue_is_paused_whoever_asked(driving, gateway, iface, wait):
    halt = gateway.answers["pause_robot"]
    gateway.answers["pause_robot"] = lambda params: {"error": {"code": FORBIDDEN, "message": "not you"}}
    driving.desk.pause_robots(["r1"])
    wait(lambda: is_told(iface, "not you"), what="the refusal")
    gateway.tell("queue", halt({"robot": "r1"})["result"])
    wait(lambda: not is_told(iface, "not you"), what="the end of the refusal")


def test_changes_of_the_queue_wait_for_the_answer(driving, gateway):
    gateway.mute.add("pause_robot")
    driving.desk.selection.select("r1")
    driving.actions.pause.trigger()
    assert driving.queue_edits.awaits_answer("r1")


def test_without_a_link_it_says_that_nothing_was_sent(plugin, iface):
    plugin.window.desk.selection.select("r1")
    plugin.window.actions.pause.trigger()
    assert any("Pause of r1 was NOT sent" in text for text in iface.texts())


def test_a_paused_robot_is_shown_as_paused_and_found_by_that(driving, gateway, make_robot, wait):
    table = driving.dock.table
    model = table.model()
    task = TITLES.index("Task")

    def shown():
        return {model.name_at(row): model.index(row, task).data() for row in range(model.rowCount())}

    gateway.show(make_robot("r1", stopped=True), make_robot("r2", stopped=True))
    wait(lambda: shown() == {"r1": "stopped", "r2": "stopped"}, what="both standing")
    driving.desk.selection.select_all(["r1"])
    driving.actions.pause.trigger()
    wait(lambda: shown() == {"r1": "paused", "r2": "stopped"}, what="the pause")
    model.text = "paused"
    table.refresh()
    assert list(shown()) == ["r1"]
