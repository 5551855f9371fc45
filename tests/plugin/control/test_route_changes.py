"""A route that is changed by mouse and keys on a real canvas."""

from __future__ import annotations

from dataclasses import replace

import pytest
from fleet_supervisor.robot_bridge.core.messages.base import to_json
from qgis.PyQt.QtCore import QEvent, Qt
from qgis.PyQt.QtGui import QKeyEvent
from qgis.PyQt.QtTest import QTest
from qgis.PyQt.QtWidgets import QApplication

CORNERS = ((40, 30), (60, 30), (60, 60))
CTRL, SHIFT = Qt.KeyboardModifier.ControlModifier, Qt.KeyboardModifier.ShiftModifier


@pytest.fixture
def route(hand):
    hand.take("route").click(*CORNERS)
    return hand


def like(*points, off=0.3):
    return [pytest.approx(point, abs=off) for point in points]


def test_a_vertex_is_dragged_and_the_route_goes_through_it(route):
    route.drag((60, 30), (70, 25))
    assert list(route.points) == like((40, 30), (70, 25), (60, 60))
    assert route.nothing_sent()
    route.key(Qt.Key.Key_Return)
    assert route.sent()["params"]["points"] == like((40, 30), (70, 25), (60, 60))


def test_a_leg_is_dragged_and_gets_a_vertex_there(route):
    route.drag((60, 45), (75, 45))
    assert list(route.points) == like((40, 30), (60, 30), (75, 45), (60, 60))


def test_a_route_that_is_dragged_does_not_come_back_on_another_site(route, site, iface):
    route.drag((60, 30), (70, 25), let_go=False)
    route.gateway.tell("site", to_json(replace(site, origin=(488100.0, 5190000.0))))
    route.wait(lambda: route.drafts.draft is None, what="the news of the other site")
    left, none = Qt.MouseButton.LeftButton, Qt.KeyboardModifier.NoModifier
    route._move(iface.pixel(75, 25), left)
    QTest.mouseRelease(iface.canvas.viewport(), left, none, iface.pixel(75, 25))
    assert route.drafts.draft is None


def test_a_right_click_ends_drawing_and_another_click_goes_on_from_there(route):
    route.move(90, 80)
    assert route.drafts.cursor is not None
    route.right_click(90, 80)
    assert list(route.points) == like(*CORNERS)
    assert route.drafts.cursor is None
    route.move(95, 85)
    assert route.drafts.cursor is None, "the next leg still follows the mouse"
    assert route.nothing_sent()
    route.click((80, 60))
    route.move(95, 85)
    assert list(route.points) == like(*CORNERS, (80, 60))
    assert route.drafts.cursor == pytest.approx((95, 85), abs=0.3)


def test_a_route_whose_drawing_was_ended_is_changed_and_sent(route):
    route.right_click(90, 80)
    route.drag((60, 30), (70, 25))
    route.key(Qt.Key.Key_Return)
    assert route.sent()["params"]["points"] == like((40, 30), (70, 25), (60, 60))


def test_the_next_route_is_drawn_with_its_leg_to_the_mouse(route):
    route.right_click(90, 80)
    route.key(Qt.Key.Key_Escape)
    route.click((40, 30), (60, 30))
    route.move(95, 85)
    assert route.drafts.cursor == pytest.approx((95, 85), abs=0.3)


def test_a_right_click_after_one_point_says_what_is_missing_and_keeps_it(hand):
    hand.take("route").click((40, 30))
    hand.right_click(60, 30)
    assert hand.complained("A route needs at least two points")
    assert list(hand.points) == like((40, 30))
    hand.move(60, 30)
    assert hand.drafts.cursor == pytest.approx((60, 30), abs=0.3)


def test_a_right_click_before_the_first_point_does_nothing(hand):
    hand.take("route").right_click(60, 30)
    assert hand.points is None
    assert not hand.has_message("A route needs")
    hand.click((40, 30))
    hand.move(60, 30)
    assert hand.drafts.cursor == pytest.approx((60, 30), abs=0.3)


def test_a_drag_beside_the_route_changes_nothing(route):
    before = route.drafts.draft
    route.drag((90, 80), (95, 85))
    assert route.drafts.draft == before
    assert route.nothing_sent()


def test_escape_while_dragging_leaves_the_route_as_it_was(route):
    before = route.drafts.draft
    route.drag((60, 30), (80, 20), let_go=False)
    assert list(route.points)[1] == pytest.approx((80, 20), abs=0.3)
    route.key(Qt.Key.Key_Escape)
    assert route.drafts.draft == before
    view = route.iface.canvas.viewport()
    none = Qt.KeyboardModifier.NoModifier
    QTest.mouseRelease(view, Qt.MouseButton.LeftButton, none, route.iface.pixel(80, 20))
    assert len(route.points) == 3


def test_leaving_the_tool_while_dragging_leaves_the_route_as_it_was_and_sends_nothing(route):
    before = route.drafts.draft
    route.drag((60, 30), (80, 20), let_go=False)
    route.iface.actionPan().trigger()
    assert route.drafts.draft == before
    assert route.nothing_sent()


def test_delete_takes_out_the_vertex_under_the_mouse_and_backspace_the_last(route):
    route.move(60, 30)
    route.key(Qt.Key.Key_Delete)
    assert list(route.points) == like((40, 30), (60, 60))
    route.key(Qt.Key.Key_Backspace)
    assert list(route.points) == like((40, 30))


def test_keys_alone_choose_move_insert_and_delete_vertices(route):
    route.move(100, 90)
    route.type(">>")
    route.key(Qt.Key.Key_Right, CTRL, SHIFT)
    route.key(Qt.Key.Key_Up, CTRL)
    first = route.drafts.draft
    x, y = first.points[1]
    assert (x, y) == pytest.approx((61, 30.1), abs=0.3)
    route.key(Qt.Key.Key_Insert)
    (ax, ay), middle = route.points[:2]
    assert middle == pytest.approx(((ax + x) / 2, (ay + y) / 2))
    route.key(Qt.Key.Key_Delete)
    assert route.points == first.points
    route.type("<")
    route.key(Qt.Key.Key_Delete)
    assert route.points == first.points[:2]


def test_a_step_of_the_keys_is_exact_in_metres(route):
    route.type(">")
    (x, y) = route.points[0]
    route.key(Qt.Key.Key_Left, CTRL)
    assert route.points[0] == pytest.approx((x - 0.1, y), abs=1e-3)
    route.key(Qt.Key.Key_Down, CTRL, SHIFT)
    assert route.points[0] == pytest.approx((x - 0.1, y - 1.0), abs=1e-3)


def test_the_route_is_turned_round_by_key_and_by_button(route):
    there = route.points
    route.type("r")
    assert route.points == there[::-1]
    route.push("fleet_reverse_route")
    assert route.points == there


def test_every_change_is_taken_back_and_made_again(route):
    route.drag((60, 30), (70, 25))
    route.type("r")
    states = []
    for _ in range(5):
        states.append(route.points)
        route.key(Qt.Key.Key_Z, CTRL)
    assert route.points is None
    assert [len(points) for points in states] == [3, 3, 3, 2, 1]
    for points in reversed(states):
        route.key(Qt.Key.Key_Z, CTRL, SHIFT)
        assert route.points == points
    assert route.nothing_sent()


def test_a_cancelled_route_comes_back_and_one_that_was_sent_does_not(route):
    there = route.points
    route.key(Qt.Key.Key_Escape)
    assert route.points is None
    route.push("fleet_undo")
    assert route.points == there
    route.key(Qt.Key.Key_Return)
    route.sent()
    route.key(Qt.Key.Key_Z, CTRL)
    assert route.points is None
    assert len(route.gateway.requests_of("send")) == 1


def test_undo_and_paste_over_the_map_are_the_tools_and_not_those_of_qgis(route):
    canvas = route.iface.canvas
    for key in (Qt.Key.Key_Z, Qt.Key.Key_V):
        event = QKeyEvent(QEvent.Type.ShortcutOverride, key, CTRL)
        event.ignore()
        QApplication.sendEvent(canvas, event)
        assert event.isAccepted()
    route.iface.actionPan().trigger()
    event = QKeyEvent(QEvent.Type.ShortcutOverride, Qt.Key.Key_V, CTRL)
    event.ignore()
    QApplication.sendEvent(canvas, event)
    assert not event.isAccepted()


def test_what_follows_the_roads_is_not_changed_by_hand(route):
    route.window.desk.target_ways.set_command(
        route.drafts.draft.with_leg(((65, 60), (70, 62), (75, 60)), "11 m")
    )
    route.wait(route.iface.is_settled)
    draft = route.drafts.draft
    route.drag((70, 62), (70, 80))
    assert route.drafts.draft == draft
    route.type("r")
    assert route.drafts.draft == draft
    assert route.complained("A part of this route follows the roads")
    route.drag((60, 30), (55, 25))
    assert list(route.points)[1] == pytest.approx((55, 25), abs=0.3)
    assert route.drafts.draft.legs == (1, 1, 1, 3)


def test_a_route_is_changed_for_its_own_robot_whoever_is_selected(route):
    route.window.desk.selection.select("r2")
    route.drag((60, 30), (70, 25))
    assert route.drafts.draft.robot == "r1"
    route.key(Qt.Key.Key_Return)
    assert route.sent()["robot"] == "r1"
