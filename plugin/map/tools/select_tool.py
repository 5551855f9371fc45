"""The map tool that selects robots."""

from __future__ import annotations

from qgis.gui import QgsMapMouseEvent, QgsMapTool
from qgis.PyQt.QtCore import QPoint, QRect, Qt
from qgis.PyQt.QtGui import QKeyEvent
from qgis.PyQt.QtWidgets import QApplication, QRubberBand

from ...control.fleet_controller import FleetController
from ..live_view import LiveView

SHIFT = Qt.KeyboardModifier.ShiftModifier
CONTROL = Qt.KeyboardModifier.ControlModifier


class SelectTool(QgsMapTool):
    """A click selects a robot, a click beside all of them none; a rectangle selects those in it.

    As with QGIS's own tools a click with Shift or Ctrl adds the robot or takes it away; a rectangle with
    Shift adds, with Ctrl takes away, with both keeps only what was selected before. A double click goes to
    the robot.
    """

    def __init__(self, desk: FleetController, view: LiveView):
        super().__init__(desk.canvas)
        self._desk = desk
        self._view = view
        self._pressed_at: QPoint | None = None
        self._band: QRubberBand | None = None
        self.setCursor(Qt.CursorShape.PointingHandCursor)

    def deactivate(self) -> None:
        self._give_up()
        super().deactivate()

    def canvasPressEvent(self, event: QgsMapMouseEvent) -> None:
        if event.button() == Qt.MouseButton.LeftButton:
            self._pressed_at = event.pos()

    def canvasMoveEvent(self, event: QgsMapMouseEvent) -> None:
        if self._pressed_at is None or not self._is_drag(event.pos()):
            return
        if self._band is None:
            self._band = QRubberBand(QRubberBand.Shape.Rectangle, self.canvas().viewport())
        self._band.setGeometry(QRect(self._pressed_at, event.pos()).normalized())
        self._band.show()

    def canvasReleaseEvent(self, event: QgsMapMouseEvent) -> None:
        # The second click of a double click comes without a press and so is no click of its own.
        if event.button() != Qt.MouseButton.LeftButton or self._pressed_at is None:
            return
        pressed, held = self._pressed_at, event.modifiers()
        if self._is_drag(event.pos()):
            area = QRect(pressed, event.pos()).normalized()
            self._desk.selection.select_all(self._combined(self._view.overlay.robots_in(area), held))
        else:
            self._click(event.pos(), held)
        self._give_up()

    def canvasDoubleClickEvent(self, event: QgsMapMouseEvent) -> None:
        x, y = event.pos().x(), event.pos().y()
        robot = self._view.overlay.robot_at(x, y)
        self._view.zoom_to(*([robot] if robot else self._view.overlay.robots_beyond(x, y)))

    def keyPressEvent(self, event: QKeyEvent) -> None:
        if event.key() == Qt.Key.Key_Escape:
            self._desk.selection.select(None)
        else:
            super().keyPressEvent(event)

    def _click(self, at: QPoint, held: Qt.KeyboardModifier) -> None:
        robot = self._view.overlay.robot_at(at.x(), at.y())
        there = [robot] if robot else self._view.overlay.robots_beyond(at.x(), at.y())
        if not held & (SHIFT | CONTROL):
            self._desk.selection.select_all(there)
            return
        before, struck = dict.fromkeys(self._desk.selection.robots), set(there)
        kept = [name for name in before if name not in struck]
        self._desk.selection.select_all([*kept, *(name for name in there if name not in before)])

    def _combined(self, there: list[str], held: Qt.KeyboardModifier) -> list[str]:
        before = list(self._desk.selection.robots)
        if held & SHIFT and held & CONTROL:
            return [name for name in before if name in set(there)]
        if held & SHIFT:
            return before + there
        return [name for name in before if name not in set(there)] if held & CONTROL else there

    def _is_drag(self, at: QPoint) -> bool:
        return (at - self._pressed_at).manhattanLength() > QApplication.startDragDistance()

    def _give_up(self) -> None:
        self._pressed_at = None
        if self._band is not None:
            self._band.hide()
            self._band.deleteLater()
            self._band = None
