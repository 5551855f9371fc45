"""Map tools of one click: cone target, start position, and robots selected."""

from __future__ import annotations

import math

from qgis.core import QgsPointXY
from qgis.gui import QgsMapMouseEvent, QgsMapTool
from qgis.PyQt.QtCore import QPoint, QRect, Qt
from qgis.PyQt.QtGui import QKeyEvent
from qgis.PyQt.QtWidgets import QApplication, QRubberBand

from ...control.fleet_controller import FleetController
from ...control.pending_command import CONE, START, PendingCommand, Point
from ...ui.errors import FleetError
from ...ui.language import tr
from ..live_view import LiveView
from .drawing_tool import DrawingTool, is_arrow_move, moved_by_arrow
from .road_route_tool import RoutePreview


class ConeTool(DrawingTool):
    """A click puts the cone for the selected robot, another click moves it, as do Ctrl and the arrow keys.

    With Shift held down the robot is sent straight there, and not along the roads.
    """

    kind = CONE

    def __init__(self, desk: FleetController):
        super().__init__(desk)
        self._way = RoutePreview(desk)
        self._is_direct = False

    def canvasReleaseEvent(self, event: QgsMapMouseEvent) -> None:
        self._is_direct = bool(event.modifiers() & Qt.KeyboardModifier.ShiftModifier)
        try:
            super().canvasReleaseEvent(event)
        finally:
            self._is_direct = False

    def hovered(self, event: QgsMapMouseEvent) -> None:
        self._way.lead_to(event, self.desk.selection.last, None)

    def deactivate(self) -> None:
        self._way.clear()
        super().deactivate()

    def clicked(self, point: Point) -> None:
        other = self.on_map
        if other is not None and other.kind != CONE:
            self.desk.complained.emit(
                tr(
                    "{in_words} is still on the map. Send it (Enter) or cancel it (Esc) first.",
                    in_words=other.in_words(),
                )
            )
            return
        self.set_command(
            PendingCommand(self.desk.selection.last or other.robot, CONE, (point,), is_direct=self._is_direct)
        )

    def key(self, event: QKeyEvent) -> bool:
        draft = self.draft
        if draft is None or not is_arrow_move(event):
            return super().key(event)
        is_direct = draft.is_direct
        self._try(
            lambda: self.set_command(
                PendingCommand(
                    draft.robot,
                    CONE,
                    (moved_by_arrow(event, self.desk, draft.points[0]),),
                    is_direct=is_direct,
                )
            )
        )
        return True


class StartTool(DrawingTool):
    """A click puts the start position of the selected robot; a drag gives it the heading that it leads in."""

    kind = START

    def canvasReleaseEvent(self, event: QgsMapMouseEvent) -> None:
        pressed = self._pressed_at
        if (
            pressed is None
            or event.button() != Qt.MouseButton.LeftButton
            or not self.is_drag(pressed, event.pos())
        ):
            super().canvasReleaseEvent(event)
            return
        self._pressed_at = None
        self._try(lambda: self._drawn(self.toMapCoordinates(pressed), event.mapPoint()))

    def clicked(self, point: Point) -> None:
        self._put(point, None)

    def key(self, event: QKeyEvent) -> bool:
        draft = self.draft
        if draft is None or not is_arrow_move(event):
            return super().key(event)
        self._try(lambda: self._put(moved_by_arrow(event, self.desk, draft.points[0]), draft.theta))
        return True

    def _drawn(self, start: QgsPointXY, end: QgsPointXY) -> None:
        self._check_robot()
        placement = self.desk.site_to_canvas.transform()
        place, ahead = placement.to_site(start), placement.to_site(end)
        self._put(place, math.atan2(ahead[1] - place[1], ahead[0] - place[0]))

    def _put(self, place: Point, theta: float | None) -> None:
        other = self.on_map
        if other is not None and other.kind != START:
            raise FleetError(
                tr(
                    "{in_words} is still on the map. Send it (Enter) or cancel it (Esc) first.",
                    in_words=other.in_words(),
                )
            )
        self.set_command(
            PendingCommand(self.desk.selection.last or other.robot, START, (place,), theta=theta)
        )


# --- Robots selected ---

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
