"""Robots are selected on the map as QGIS users select features."""

from __future__ import annotations

import pytest
from qgis.PyQt.QtCore import QPoint, QRect, Qt
from qgis.PyQt.QtTest import QTest
from qgis.PyQt.QtWidgets import QRubberBand

LEFT = Qt.MouseButton.LeftButton
NONE = Qt.KeyboardModifier.NoModifier
SHIFT = Qt.KeyboardModifier.ShiftModifier
CONTROL = Qt.KeyboardModifier.ControlModifier


@pytest.fixture
def desk(at_desk, gateway, make_robot, iface, wait):
    """Four robots in a row, and the tool in hand."""
    gateway.show(*[make_robot(f"r{k}", 20.0 * k, 50.0) for k in range(1, 5)])
    wait(lambda: len(at_desk.desk.state.robots) == 4)
    wait(lambda: at_desk.view.overlay.robot_at(*xy(iface.pixel(80, 50))) == "r4")
    wait(lambda: at_desk.dock.table.model().rowCount() == 4)
    at_desk.actions.select.trigger()
    return at_desk.desk


def xy(point: QPoint):
    return point.x(), point.y()


def click(iface, x, y, held=NONE):
    QTest.mouseClick(iface.canvas.viewport(), LEFT, held, iface.pixel(x, y))


def drag(iface, start, end, held=NONE):
    viewport = iface.canvas.viewport()
    QTest.mousePress(viewport, LEFT, held, iface.pixel(*start))
    middle = (iface.pixel(*start) + iface.pixel(*end)) / 2
    move(iface, middle, held)
    move(iface, iface.pixel(*end), held)
    bands = [band.geometry() for band in viewport.findChildren(QRubberBand) if band.isVisible()]
    QTest.mouseRelease(viewport, LEFT, held, iface.pixel(*end))
    return bands


def move(iface, at, held):
    from qgis.PyQt.QtCore import QEvent, QPointF
    from qgis.PyQt.QtGui import QMouseEvent
    from qgis.PyQt.QtWidgets import QApplication

    viewport = iface.canvas.viewport()
    where = QPointF(at)
    event = QMouseEvent(
        QEvent.Type.MouseMove, where, QPointF(viewport.mapToGlobal(at)), Qt.MouseButton.NoButton, LEFT, held
    )
    QApplication.sendEvent(viewport, event)


def test_a_click_selects_one_robot_and_beside_them_none(desk, iface):
    click(iface, 40, 50)
    assert desk.selection.robots == ("r2",)
    click(iface, 60, 50)
    assert desk.selection.robots == ("r3",)
    click(iface, 60, 90)
    assert desk.selection.robots == ()


def test_a_right_click_changes_no_selection(desk, iface):
    click(iface, 40, 50)
    iface.click(60, 50, Qt.MouseButton.RightButton)
    assert desk.selection.robots == ("r2",)
    iface.click(60, 90, Qt.MouseButton.RightButton)
    assert desk.selection.robots == ("r2",)


@pytest.mark.parametrize("held", [SHIFT, CONTROL])
def test_a_click_with_shift_or_ctrl_adds_and_takes_away(desk, iface, held):
    click(iface, 40, 50)
    click(iface, 60, 50, held)
    assert desk.selection.robots == ("r2", "r3")
    assert desk.selection.last == "r3"
    click(iface, 60, 90, held)
    assert desk.selection.robots == ("r2", "r3")
    click(iface, 60, 50, held)
    assert desk.selection.robots == ("r2",)


def test_a_rectangle_selects_those_in_it_and_is_seen_while_it_is_drawn(desk, iface):
    (band,) = drag(iface, (30, 60), (70, 40))
    assert desk.selection.robots == ("r2", "r3")
    assert band == QRect(iface.pixel(30, 60), iface.pixel(70, 40)).normalized()
    assert not [b for b in iface.canvas.viewport().findChildren(QRubberBand) if b.isVisible()]


def test_rectangles_combine_with_what_is_selected_as_in_qgis(desk, iface):
    for held, left in (
        (SHIFT, ("r1", "r2", "r3", "r4")),
        (CONTROL, ("r1",)),
        (SHIFT | CONTROL, ("r2",)),
        (NONE, ("r2", "r3", "r4")),
    ):
        desk.selection.select_all(["r1", "r2"])
        drag(iface, (30, 60), (90, 40), held)
        assert desk.selection.robots == left


def test_a_rectangle_is_one_of_the_screen_when_the_map_is_rotated(desk, iface, wait):
    iface.canvas.setRotation(40)
    desk.canvas.refresh()
    at = [iface.pixel(20.0 * k, 50) for k in range(1, 5)]
    wait(lambda: iface.canvas.rotation() == 40)
    left, right = at[1] + QPoint(-12, -12), at[2] + QPoint(12, 12)
    viewport = iface.canvas.viewport()
    QTest.mousePress(viewport, LEFT, NONE, left)
    move(iface, right, NONE)
    QTest.mouseRelease(viewport, LEFT, NONE, right)
    assert desk.selection.robots == ("r2", "r3")


def test_a_double_click_goes_to_the_robot(desk, iface):
    at = iface.pixel(80, 50)
    QTest.mouseClick(iface.canvas.viewport(), LEFT, NONE, at)
    QTest.mouseDClick(iface.canvas.viewport(), LEFT, NONE, at)
    centre = iface.canvas.center()
    assert (centre.x() - 488000, centre.y() - 5190000) == pytest.approx((80, 50), abs=1)
    assert iface.canvas.extent().height() < 110
    assert desk.selection.robots == ("r4",)


def test_escape_selects_none(desk, iface):
    desk.selection.select_all(["r1", "r2"])
    QTest.keyClick(iface.canvas, Qt.Key.Key_Escape)
    assert desk.selection.robots == ()


def test_an_arrow_at_the_border_selects_and_shows_the_robots_beyond(desk, at_desk, iface, wait):
    iface.look_at(0, 0, 50, 40)
    wait(lambda: len(at_desk.view.overlay._painter.hints) > 0)
    iface.canvas.grab()
    row = desk.state.robots.row("r4")
    (hint,) = [h for h in at_desk.view.overlay._painter.hints if row in h.rows]
    assert hint.x < iface.canvas.width() and hint.y < iface.canvas.height()
    at = QPoint(round(hint.x), round(hint.y))
    QTest.mouseClick(iface.canvas.viewport(), LEFT, NONE, at)
    assert "r4" in desk.selection.robots
    QTest.mouseDClick(iface.canvas.viewport(), LEFT, NONE, at)
    shown = iface.canvas.extent()
    assert shown.xMinimum() < 488080 < shown.xMaximum()


def test_the_table_and_the_layer_show_the_same_selection(desk, at_desk, iface, wait):
    drag(iface, (30, 60), (70, 40))
    layer = at_desk.view.layer.layer
    wait(lambda: sorted(f["robot"] for f in layer.selectedFeatures()) == ["r2", "r3"])
    rows = at_desk.dock.table.selectionModel().selectedRows()
    assert sorted(index.data() for index in rows) == ["r2", "r3"]
    layer.selectByExpression("robot in ('r1', 'r3', 'r4')")
    assert sorted(desk.selection.robots) == ["r1", "r3", "r4"]
    assert desk.selection.last == "r3"
    layer.removeSelection()
    assert desk.selection.robots == ()


def test_abort_asks_every_selected_robot_and_no_other(desk, at_desk, gateway, wait):
    desk.selection.select_all(["r1", "r3"])
    at_desk.actions.abort.trigger()
    wait(lambda: len(gateway.requests_of("send")) == 2)
    sent = [(params["robot"], params["op"]) for params in gateway.requests_of("send")]
    assert sent == [("r1", "Abort"), ("r3", "Abort")]
