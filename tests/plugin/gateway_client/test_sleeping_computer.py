"""The lid of the operator's laptop is closed for an hour: nothing old is taken for new, or done."""

from __future__ import annotations

import time
from types import SimpleNamespace

import pytest
from fleet_supervisor.plugin.gateway_client import connection
from fleet_supervisor.plugin.gateway_client.robot_states import STATES
from fleet_supervisor.robot_bridge.core import clock as clock_module
from fleet_supervisor.robot_bridge.core.messages.base import to_json
from fleet_supervisor.robot_bridge.core.messages.safety import RobotState
from qgis.PyQt.QtWidgets import QToolButton

from tests.support.fleet_panel import press

HOURS = 3 * 3600.0


class Lid:
    """Closed and opened again, so many seconds have gone by for every clock that counts them."""

    asleep = 0.0

    def clock_gettime(self, which: int) -> float:
        return time.clock_gettime(which) + self.asleep


@pytest.fixture
def lid(monkeypatch):
    made = Lid()
    stand_in = SimpleNamespace(clock_gettime=made.clock_gettime, monotonic=time.monotonic)
    monkeypatch.setattr(clock_module, "time", stand_in)
    return made


@pytest.fixture
def laptop(lid, at_desk):
    """A connected desk on a computer whose ``lid`` can be closed."""
    return at_desk


def states(window):
    robots = window.desk.state.robots.arrays(window.desk.clock.steady())
    return {STATES[state] for state in robots.state.tolist()}


def test_the_clock_counts_sleep_where_the_system_has_one_that_does():
    if not hasattr(time, "CLOCK_BOOTTIME"):
        pytest.skip("only Linux has a clock that counts sleep beside one that does not")
    assert clock_module._COUNTS_SLEEP == time.CLOCK_BOOTTIME
    assert clock_module.steady_time() == pytest.approx(time.clock_gettime(time.CLOCK_BOOTTIME), abs=60.0)


def test_robots_are_lost_at_once_and_come_back_with_the_link(laptop, lid, gateway, wait):
    assert states(laptop) == {RobotState.FRESH}
    lid.asleep = HOURS
    assert states(laptop) == {RobotState.LOST}
    wait(lambda: len(gateway.requests_of("hello")) == 2, 10, "another link")
    wait(lambda: states(laptop) == {RobotState.FRESH}, what="the robots")


def test_what_had_come_in_before_is_not_taken_for_new(lid, monkeypatch, plugin, gateway, wait, make_robot):
    # Here the message itself has to bring it to light, neither a timer nor an answer on its way.
    monkeypatch.setattr(connection, "AWAKE_EVERY", HOURS)
    gateway.mute |= {"get_commands", "get_closures", "get_queue", "get_plans", "get_observations"}
    window = plugin.window
    window.dock.connection_panel._url.setText(gateway.url)
    window.dock.connection_panel._operator.setText("anna")
    window.actions.connect.trigger()
    wait(lambda: gateway._sockets and window.desk.state.link.phase.value == "connected", what="the link")
    gateway.show(make_robot("r8"))
    wait(lambda: window.desk.state.robots.row("r8") is not None, what="all that came before")
    lid.asleep = HOURS
    gateway.tell("positions", {"t": time.time(), "robots": [to_json(make_robot("r9"))]})
    wait(lambda: len(gateway.requests_of("hello")) == 2, 10, "another link")
    wait(lambda: len(gateway.requests_of("get_commands")) == 2, what="its questions")
    assert window.desk.state.robots.row("r9") is None


def test_what_was_clicked_before_the_window_stood_still_sends_no_robot_off(laptop, lid, gateway, wait, iface):
    lid.asleep = HOURS
    assert laptop.queue_edits.resume("r1") is None
    assert any("what was clicked meanwhile may be old" in text for text in iface.texts())
    # The window has caught up, and goes on with the clicks that waited.
    laptop.desk.state.pull()
    assert laptop.queue_edits.make_current("r1", "task-1") is None
    assert gateway.requests_of("resume_queue") == gateway.requests_of("make_current") == []
    laptop.desk.selection.select("r1")
    laptop.desk.abort_selected()
    wait(lambda: gateway.requests_of("send"), 10, "the Abort")
    wait(lambda: laptop.desk.state.standstill == 0, what="the window having caught up")
    wait(lambda: laptop.desk.state.link.phase.value == "connected", what="the link")
    assert laptop.queue_edits.resume("r1") is not None


def test_an_order_from_before_is_handed_back_and_not_sent_again(laptop, lid, gateway, wait, iface):
    laptop.desk.selection.select("r1")
    laptop.actions.cone.trigger()
    iface.click(70, 55)
    gateway.mute.add("send")
    press(laptop, QToolButton, "fleet_send_button")
    wait(lambda: gateway.requests_of("send"), what="the order")
    lid.asleep = HOURS
    gateway.mute.clear()
    wait(lambda: any("it was not repeated" in text for text in iface.texts()), 10, "the order")
    assert len(gateway.requests_of("send")) == 1 and gateway.commands == {}
    assert laptop.desk.drafts.draft is not None
