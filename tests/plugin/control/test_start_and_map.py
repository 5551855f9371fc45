"""The start position by mouse and keys, and the map on request."""

from __future__ import annotations

import math

import pytest
from qgis.core import QgsCoordinateReferenceSystem
from qgis.PyQt.QtCore import Qt
from qgis.PyQt.QtTest import QTest

CTRL, NONE = Qt.KeyboardModifier.ControlModifier, Qt.KeyboardModifier.NoModifier


@pytest.fixture
def start(hand):
    return hand.take("start")


def test_a_click_and_enter_tell_the_robot_where_it_stands(start):
    start.click((70, 55))
    assert start.nothing_sent()
    assert start.draft_text.startswith("Start position of r1 at ")
    start.key(Qt.Key.Key_Return)
    sent = start.sent()
    assert (sent["robot"], sent["op"]) == ("r1", "SetPosIni")
    assert (sent["params"]["x"], sent["params"]["y"]) == pytest.approx((70, 55), abs=0.3)
    assert "theta" not in sent["params"]


def test_a_drag_gives_the_heading_and_sends_nothing(start):
    start.drag((70, 55), (60, 65))
    assert start.nothing_sent()
    assert start.drafts.draft.theta == pytest.approx(3 * math.pi / 4, abs=0.05)
    assert start.points == (pytest.approx((70, 55), abs=0.3),)
    start.key(Qt.Key.Key_Left, CTRL)
    start.key(Qt.Key.Key_Return)
    assert start.sent()["params"]["theta"] == pytest.approx(3 * math.pi / 4, abs=0.05)


def pressed_and_let_go(start, meanwhile):
    """Drag from (50, 50) towards the right, and do something before the mouse button comes up."""
    start.drag((50, 50), (70, 50), let_go=False)
    at = start.iface.pixel(70, 50)
    meanwhile()
    QTest.mouseRelease(start.iface.canvas.viewport(), Qt.MouseButton.LeftButton, NONE, at)
    start.wait(start.iface.is_settled, what="the check of the draft")


def test_a_start_position_stays_where_the_mouse_went_down_though_the_map_moves_after_a_robot(start):
    pressed_and_let_go(start, lambda: start.iface.look_at(30, 0, 150, 100))
    assert start.points == (pytest.approx((50, 50), abs=0.3),)
    assert start.drafts.draft.theta == pytest.approx(0.0, abs=0.05)


def test_a_drag_over_two_maps_is_no_start_position(start):
    other = QgsCoordinateReferenceSystem("EPSG:3857")
    pressed_and_let_go(start, lambda: start.iface.canvas.setDestinationCrs(other))
    assert start.points is None
    assert start.complained("the map's CRS has changed meanwhile")


def test_a_start_position_may_be_where_a_robot_may_not_go_but_not_outside_the_site(start, layer_of, iface):
    layer_of("Polygon", "Polygon ((60 50, 80 50, 80 60, 60 60, 60 50))", role="keepout", names=["Bay"])
    start.click((70, 55))
    assert "Not to be sent" not in start.draft_text
    iface.look_at(-60, -60, 260, 200)
    start.click((-20, 30))
    assert "Not to be sent" in start.draft_text


def test_escape_and_leaving_the_tool_send_nothing(start):
    start.click((70, 55))
    start.iface.actionPan().trigger()
    assert start.points is not None
    start.take("start").key(Qt.Key.Key_Escape)
    assert start.points is None
    assert start.nothing_sent()


def test_a_start_position_does_not_wipe_out_a_route(hand):
    hand.take("route").click((40, 30), (60, 30))
    before = hand.drafts.draft
    hand.take("start").click((70, 55))
    hand.drag((70, 55), (80, 55))
    assert hand.drafts.draft == before
    assert hand.complained("is still on the map")


def test_the_map_is_sent_to_every_selected_robot(hand, gateway, wait):
    hand.window.desk.selection.select_all(["r1", "r2"])
    hand.window.actions.send_map.trigger()
    wait(lambda: gateway.requests_of("send_map") == [{"robot": "r1"}, {"robot": "r2"}])
    wait(lambda: hand.draft_text == "Map for r2: done", what="that it was sent")
    hand.window.desk.selection.select(None)
    hand.window.actions.send_map.trigger()
    assert hand.complained("No robot is selected, so none was sent the map")
