"""The tool that closes roads, by mouse and by keys on a real canvas."""

from __future__ import annotations

import pytest
from qgis.gui import QgsVertexMarker
from qgis.PyQt.QtCore import Qt
from qgis.PyQt.QtTest import QTest
from qgis.PyQt.QtWidgets import QDialog, QLineEdit, QPushButton


@pytest.fixture
def tool(at_desk, iface):
    at_desk.actions.closures.trigger()
    return iface.canvas.mapTool()


def press(iface, key):
    QTest.keyClick(iface.canvas, key)


def crosses(iface):
    """Where crosses are drawn, in metres from the site's origin."""
    items = [item for item in iface.canvas.scene().items() if isinstance(item, QgsVertexMarker)]
    return [(item.center().x() - 488000.0, item.center().y() - 5190000.0) for item in items]


def closed(iface, gateway, wait):
    """Confirm the open dialog and return where the gateway was asked to close a road."""
    dialog = iface.findChild(QDialog, "fleet_closure_dialog")
    QTest.keyClicks(dialog.findChild(QLineEdit, "fleet_closure_reason"), "tree")
    QTest.mouseClick(dialog.findChild(QPushButton, "fleet_closure_confirm"), Qt.MouseButton.LeftButton)
    wait(lambda: gateway.requests_of("close_road"), what="the request")
    (asked,) = gateway.requests_of("close_road")
    assert asked["reason"] == "tree"
    return asked["x"], asked["y"]


def test_a_click_asks_and_closes_there(tool, iface, gateway, wait):
    iface.click(30, 20)
    assert gateway.requests_of("close_road") == []
    assert closed(iface, gateway, wait) == pytest.approx((30, 20), abs=0.3)


@pytest.mark.parametrize("key", [Qt.Key.Key_Return, Qt.Key.Key_Enter])
def test_enter_clicks_in_the_middle_of_the_map_where_a_cross_is(tool, iface, gateway, wait, key):
    assert crosses(iface) == [pytest.approx((60, 50), abs=0.3)]
    press(iface, Qt.Key.Key_Right)
    (middle,) = crosses(iface)
    assert middle[0] > 70
    press(iface, key)
    assert closed(iface, gateway, wait) == pytest.approx(middle, abs=0.3)


def test_enter_clicks_at_the_mouse_while_that_is_over_the_map(tool, iface, gateway, wait):
    iface.hover(30, 20)
    assert crosses(iface) == []
    press(iface, Qt.Key.Key_Return)
    assert closed(iface, gateway, wait) == pytest.approx((30, 20), abs=0.3)


def test_esc_puts_the_tool_and_its_cross_away_and_nothing_is_asked(tool, iface, gateway):
    press(iface, Qt.Key.Key_Escape)
    assert iface.canvas.mapTool() is not tool
    assert crosses(iface) == []
    assert iface.findChild(QDialog, "fleet_closure_dialog") is None
    assert gateway.requests_of("close_road") == []


def test_a_right_click_asks_nothing(tool, iface):
    iface.click(30, 20, Qt.MouseButton.RightButton)
    assert iface.findChild(QDialog, "fleet_closure_dialog") is None
    assert iface.canvas.mapTool() is tool
