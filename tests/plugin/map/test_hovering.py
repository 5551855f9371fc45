"""The card of the robot under the mouse."""

from __future__ import annotations

import pytest
from fleet_supervisor.plugin.map.tools.drawing_tools import BESIDE
from fleet_supervisor.plugin.ui.glyphs import UNSURE_COLOUR
from fleet_supervisor.robot_bridge.core.messages.commands import CommandState
from qgis.PyQt.QtCore import QEvent, QPoint, QPointF, QRect, QSize, Qt
from qgis.PyQt.QtGui import QMouseEvent
from qgis.PyQt.QtWidgets import QApplication, QLabel

NO_BUTTON = Qt.MouseButton.NoButton


@pytest.fixture
def viewport(at_desk, iface, wait):
    at = iface.pixel(80, 60)
    wait(lambda: at_desk.view.overlay.robot_at(at.x(), at.y()) == "r2")
    return iface.canvas.viewport()


def point_at(viewport, at: QPoint, buttons=NO_BUTTON):
    where = QPointF(at)
    event = QMouseEvent(
        QEvent.Type.MouseMove,
        where,
        QPointF(viewport.mapToGlobal(at)),
        NO_BUTTON,
        buttons,
        Qt.KeyboardModifier.NoModifier,
    )
    QApplication.sendEvent(viewport, event)


def cards(viewport):
    found = viewport.findChildren(QLabel, "fleet_hover_card")
    return [label.text() for label in found if label.isVisible()]


@pytest.mark.parametrize("tool", ["pan", "select", "cone"])
def test_a_card_says_what_is_known_whichever_tool_is_in_hand(at_desk, viewport, iface, tool):
    if tool != "pan":
        getattr(at_desk.actions, tool).trigger()
    point_at(viewport, iface.pixel(80, 60))
    (text,) = cards(viewport)
    for part in ("<b>r2</b>", "fresh", "websocket", "80.00, 60.00 m", "0.50 m/s", "80%", "4°"):
        assert part in text
    assert "task" not in text


def test_the_card_is_whole_and_leaves_the_place_of_a_tools_tip_free(
    at_desk, viewport, gateway, iface, make_robot, wait
):
    for place in ((50, 50), (90, 97), (115, 97), (115, 50), (50, 3)):
        point_at(viewport, iface.pixel(20, 90))
        assert cards(viewport) == []
        at = iface.pixel(*place)
        gateway.show(make_robot("r2", *place))
        wait(lambda at=at: at_desk.view.overlay.robot_at(at.x(), at.y()) == "r2", what="the robot there")
        point_at(viewport, at)
        (card,) = [c for c in viewport.findChildren(QLabel, "fleet_hover_card") if c.isVisible()]
        assert viewport.rect().contains(card.geometry())
        tip = QRect(at + BESIDE, QSize(200, 60))
        assert not card.geometry().intersects(tip) and not card.geometry().contains(at)


def test_beside_all_robots_there_is_none(viewport, iface):
    point_at(viewport, iface.pixel(80, 60))
    point_at(viewport, iface.pixel(20, 90))
    assert cards(viewport) == []


def test_it_goes_when_the_mouse_leaves_or_drags(viewport, iface):
    point_at(viewport, iface.pixel(80, 60))
    QApplication.sendEvent(viewport, QEvent(QEvent.Type.Leave))
    assert cards(viewport) == []
    point_at(viewport, iface.pixel(80, 60), Qt.MouseButton.LeftButton)
    assert cards(viewport) == []


def test_it_follows_what_comes_in_and_goes_when_the_robot_drives_off(
    viewport, gateway, iface, make_robot, wait
):
    point_at(viewport, iface.pixel(80, 60))
    gateway.show(make_robot("r2", 80, 60, battery=0.25))
    wait(lambda: "25%" in cards(viewport)[0], what="the battery")
    gateway.show(make_robot("r2", 20, 20))
    wait(lambda: cards(viewport) == [], what="the card to go")


def test_why_a_robot_may_be_elsewhere_is_on_its_card_once(viewport, gateway, iface, make_robot, wait):
    point_at(viewport, iface.pixel(80, 60))
    # As a gateway tells it in rows: the status says it to desks that do not know more.
    gateway.show(make_robot("r2", 80, 60, status="it <leapt>", doubt="it <leapt>"))
    wait(lambda: "fresh, may be elsewhere" in cards(viewport)[0])
    (text,) = cards(viewport)
    assert text.count("it &lt;leapt&gt;") == 1 and UNSURE_COLOUR.name() in text
    gateway.show(make_robot("r2", 80, 60))
    wait(lambda: "elsewhere" not in cards(viewport)[0])
    assert UNSURE_COLOUR.name() not in cards(viewport)[0]


def test_what_a_robot_says_is_text_and_no_markup(viewport, gateway, iface, make_robot, wait):
    gateway.show(make_robot("r2", 80, 60, status="<img src=x>"))
    point_at(viewport, iface.pixel(80, 60))
    wait(lambda: "&lt;img src=x&gt;" in cards(viewport)[0])


def test_the_card_is_whole_in_the_corner_of_the_map(at_desk, viewport, gateway, iface, make_robot, wait):
    gateway.show(make_robot("r2", 118, 1))
    corner = iface.pixel(118, 1)
    wait(lambda: at_desk.view.overlay.robot_at(corner.x(), corner.y()) == "r2")
    point_at(viewport, corner)
    (card,) = [c for c in viewport.findChildren(QLabel, "fleet_hover_card") if c.isVisible()]
    assert viewport.rect().contains(card.geometry())
    assert not card.geometry().contains(corner)


def test_a_task_stands_on_the_card_with_the_metres_to_go(at_desk, viewport, gateway, iface, wait):
    gateway._queue("command-1", "r2", "SetPosEnd", {"x": 80.0, "y": 72.5, "cone": True})
    gateway.step("command-1", CommandState.ACKNOWLEDGED, "r2")
    wait(lambda: at_desk.desk.state.commands.task_of("r2") is not None)
    point_at(viewport, iface.pixel(80, 60))
    assert "cone at 80.00, 72.50: acknowledged, 12.5 m to go" in cards(viewport)[0]


def test_nothing_of_it_is_left_after_unloading(plugin, at_desk, viewport, iface):
    point_at(viewport, iface.pixel(80, 60))
    plugin.unload()
    assert viewport.findChildren(QLabel, "fleet_hover_card") == []
    point_at(viewport, iface.pixel(80, 60))
