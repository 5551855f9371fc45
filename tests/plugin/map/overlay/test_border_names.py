"""Names at the border of the map, where many robots are beyond it."""

from __future__ import annotations

import pytest
from fleet_supervisor.robot_bridge.core.messages.safety import RobotState
from qgis.PyQt.QtCore import QPointF, QRectF

NAMES = [f"street-sweeper-{k}" for k in range(8)]
"""So long that beside arrows next to one another there is no room for all."""


@pytest.fixture
def beyond(at_desk, gateway, make_robot, iface, wait):
    """A desk with robots side by side beyond the upper border; the fourth is lost."""
    states = {NAMES[3]: {"state": RobotState.LOST, "age": 30.0}}
    robots = [
        make_robot(name, 60 + 130 * (k - 3.5), 600, **states.get(name, {})) for k, name in enumerate(NAMES)
    ]
    gateway.show(*robots)
    wait(lambda: len(at_desk.desk.state.robots) == 10, what="the robots")
    return at_desk


def texts(window):
    return window.view.overlay._painter._borders.texts


def areas(window):
    return [QRectF(QPointF(*text[1:3]), QPointF(*text[3:])) for text in texts(window)]


def is_named(window, name):
    """Tell whether the robot's name stands beside its arrow."""
    return any(text.text == name for text in texts(window))


def test_no_name_lies_over_another(beyond, wait):
    wait(lambda: areas(beyond), what="the names")
    found = areas(beyond)
    assert 1 < len(found) < len(beyond.view.overlay._painter.hints)
    assert not any(one.intersects(other) for k, one in enumerate(found) for other in found[:k])


def test_the_one_to_worry_about_and_the_selected_one_are_named_first(beyond, wait):
    wait(lambda: is_named(beyond, NAMES[3]), what="the name of the lost one")
    assert not is_named(beyond, NAMES[4])
    beyond.desk.selection.select(NAMES[4])
    wait(lambda: is_named(beyond, NAMES[4]), what="the name of the selected one")
