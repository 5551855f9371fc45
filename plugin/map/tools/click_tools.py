"""Map tools that react to clicks without drawing: selecting robots, closing and opening roads."""

from __future__ import annotations

import math

import numpy as np
from qgis.core import QgsPointXY
from qgis.gui import QgsMapMouseEvent, QgsMapTool, QgsVertexMarker
from qgis.PyQt.QtCore import QPoint, QRect, Qt, pyqtSignal
from qgis.PyQt.QtGui import QKeyEvent
from qgis.PyQt.QtWidgets import QApplication, QLineEdit, QRubberBand, QWidget

from ....robot_bridge.core.messages.roads import ClosureReport
from ....robot_bridge.core.roads.network import foot_on
from ...control.fleet_controller import FleetController
from ...control.pending_command import Point
from ...ui.dialogs import QuestionDialog, confirm
from ...ui.errors import FleetError
from ...ui.language import time_of_day, tr
from ..live_view import LiveView

# --- Selection of robots ---

SHIFT = Qt.KeyboardModifier.ShiftModifier
CONTROL = Qt.KeyboardModifier.ControlModifier


class SelectTool(QgsMapTool):
    """A click selects a robot, a click beside all of them none; a rectangle selects those in it.

    As with QGIS's own tools a click with Shift or Ctrl adds or removes the robot; a rectangle with
    Shift adds, with Ctrl removes, with both keeps only what was selected before. A double click goes to
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


# --- Closing and opening of roads ---

TIMES = (
    (tr("until it is opened"), None),
    (tr("for 15 minutes"), 900.0),
    (tr("for 1 hour"), 3600.0),
    (tr("for 4 hours"), 14_400.0),
    (tr("for 1 day"), 86_400.0),
)
LONGEST_REASON = 200
REACH = 12.0
"""Distance in pixels by which a click may miss a road."""
LEAST_REACH = 3.0
"""Distance in metres by which it may miss one in any case: a road is wider than its centreline."""


class ClosureTool(QgsMapTool):
    """A click on a road asks for reason and duration of a closure; one on a closed road asks to open it.

    Enter acts like a click: at the mouse, or in the middle of the map, which the arrow keys move.
    """

    def __init__(self, desk: FleetController, window: QWidget):
        super().__init__(desk.canvas)
        self._desk = desk
        self._window = window
        self._mouse: QPoint | None = None
        self._middle: QgsVertexMarker | None = None
        self.setCursor(Qt.CursorShape.CrossCursor)

    def activate(self) -> None:
        super().activate()
        self.canvas().extentsChanged.connect(self._show_middle)
        self.canvas().setFocus()
        self._aim_at(None)

    def deactivate(self) -> None:
        self.canvas().extentsChanged.disconnect(self._show_middle)
        self._clear_middle()
        super().deactivate()

    def canvasMoveEvent(self, event: QgsMapMouseEvent) -> None:
        self._aim_at(event.pos())

    def canvasReleaseEvent(self, event: QgsMapMouseEvent) -> None:
        if event.button() == Qt.MouseButton.LeftButton:
            self._ask_at(event.pos())

    def keyPressEvent(self, event: QKeyEvent) -> None:
        if event.key() in (Qt.Key.Key_Return, Qt.Key.Key_Enter):
            self._ask_at(self.canvas().viewport().rect().center() if self._mouse is None else self._mouse)
        elif event.key() == Qt.Key.Key_Escape:
            self.canvas().unsetMapTool(self)
        else:
            self._aim_at(None)
            super().keyPressEvent(event)
            return
        event.accept()

    def _aim_at(self, mouse: QPoint | None) -> None:
        self._mouse = mouse
        self._show_middle()

    def _show_middle(self) -> None:
        """Show where Enter would click, unless that is at the mouse."""
        self._clear_middle()
        if self._mouse is None:
            self._middle = QgsVertexMarker(self.canvas())
            self._middle.setIconType(QgsVertexMarker.IconType.ICON_CROSS)
            self._middle.setIconSize(round(2 * REACH))
            self._middle.setPenWidth(2)
            self._middle.setCenter(self.canvas().center())

    def _clear_middle(self) -> None:
        if self._middle is not None:
            self.canvas().scene().removeItem(self._middle)
            self._middle = None

    def _ask_at(self, pixel: QPoint) -> None:
        try:
            place, reach = self._place(pixel)
        except FleetError as error:
            self._desk.warning.emit(str(error))
            return
        closed = self._closed_at(place, reach)
        if closed is None:
            self._ask_to_close(place, reach)
        else:
            self._ask_to_open(closed)

    def _place(self, pixel: QPoint) -> tuple[Point, float]:
        """Return the place of a click in the site frame, and the metres by which it may miss a road."""
        transform = self._desk.site_to_canvas.transform()
        place = transform.to_site(self.toMapCoordinates(pixel))
        beside = self.toMapCoordinates(pixel + QPoint(round(REACH), 0))
        return place, max(math.dist(place, transform.to_site(QgsPointXY(beside))), LEAST_REACH)

    def _closed_at(self, place: Point, reach: float) -> ClosureReport | None:
        found, least = None, reach
        for closure in self._desk.state.closures:
            line = np.array(closure.line)
            off = float(foot_on(line[:-1], line[1:], np.array(place))[1].min())
            if off <= least:
                found, least = closure, off
        return found

    def _ask_to_close(self, place: Point, reach: float) -> None:
        dialog = ClosureDialog(self._window)
        dialog.confirmed.connect(lambda why, seconds: self._desk.close_road(place, reach, why, seconds))
        # On another site the numbers are another place.
        self._desk.state.forgotten.connect(dialog.reject)
        dialog.open()

    def _ask_to_open(self, closure: ClosureReport) -> None:
        because = f": {closure.reason}" if closure.reason else ""
        text = tr(
            "{by} closed this road at {time}{because}",
            by=closure.closed_by,
            time=time_of_day(closure.closed_at),
            because=because,
        )
        opening = "fleet_open_road_confirm", tr("Open road")
        box = confirm(
            self._window, "fleet_open_road", text, opening, tr("Cancel"),
            lambda: self._desk.open_road(closure.closure),
        )  # fmt: skip
        box.setWindowTitle(tr("Open road"))
        box.setInformativeText(tr("Open it again for every robot?"))
        box.open()


class ClosureDialog(QuestionDialog):
    """Asks why and for how long a road is closed.

    ``confirmed`` carries the reason and the seconds, None for no end.
    """

    confirmed = pyqtSignal(str, object)

    def __init__(self, parent: QWidget):
        super().__init__(
            "fleet_closure_dialog",
            tr("Close road"),
            ("fleet_closure_confirm", tr("Close road")),
            is_safe=False,
            parent=parent,
        )
        self.add_text(
            tr(
                "The road is closed for every robot from this junction to the next. Robots whose way leads "
                "along it get another way; one that has no other way is stopped, unless the site's settings "
                "say otherwise."
            )
        )
        reason = QLineEdit()
        reason.setMaxLength(LONGEST_REASON)
        reason.setPlaceholderText(tr("such as: tree on the road"))
        self.add_field(tr("Reason"), reason, "fleet_closure_reason")
        time = self.add_choice(tr("Closed"), TIMES, "fleet_closure_time")
        self.lay_out()
        self.accepted.connect(lambda: self.confirmed.emit(reason.text().strip(), time.currentData()))
