"""A robot sent by a click is paused and continues by keys: gateway and robot are real."""

from __future__ import annotations

import math

from fleet_supervisor.robot_bridge.core.messages.commands import CommandState
from qgis.PyQt.QtCore import Qt
from qgis.PyQt.QtTest import QTest

ALT = Qt.KeyboardModifier.AltModifier
SHIFT = Qt.KeyboardModifier.ShiftModifier
TOLERANCE = 0.20


def test_a_robot_that_was_sent_directly_stands_and_places_its_cone_after_that_once(
    loop, operator, plugin, iface
):
    loop.start_robot("r1", (20, 8, 0), speed=5)
    operator.connect_to(loop, ["r1"])
    operator.set_cone("r1", 110.0, 8.0)
    operator.wait("r1 driving", lambda: (operator.report("r1").v or 0) > 1.0, 20)
    QTest.keyClick(iface, Qt.Key.Key_F10, ALT)
    aborted = operator.wait_for_state("r1", "SetPath", CommandState.ABORTED)
    assert aborted.steps[-1].by == "anna" and "paused" in aborted.steps[-1].reason
    operator.wait("the desk seeing r1 stand", lambda: operator.report("r1").v < 0.05, 10)
    assert operator.report("r1").x < 109
    operator.wait("something to continue", plugin.window.actions.go_on.isEnabled, 10)
    QTest.keyClick(iface, Qt.Key.Key_F10, ALT | SHIFT)
    operator.wait("the cone", lambda: len(operator.desk.state.placed_cones) == 1, 60)
    x, y = aborted.params["points"][-1]
    operator.wait(
        "r1 at its place",
        lambda: math.dist((operator.report("r1").x, operator.report("r1").y), (x, y)) <= TOLERANCE,
        10,
    )
    ends = [(one.op, one.state.value) for one in operator.sent_to("r1")]
    # What was left of the path, and the cone at its end, are one task of the queue.
    assert sorted(ends) == [
        ("Abort", "reached"),
        ("SetPath", "aborted"),
        ("SetPath", "reached"),
        ("SetPosEnd", "reached"),
    ]
    assert operator.desk.state.queues.get("r1").tasks == []
