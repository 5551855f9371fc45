"""Base of map tools that draw: clicks, keys, pasted coordinates, points moved by arrow keys."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
from qgis.core import QgsCoordinateReferenceSystem, QgsPointXY
from qgis.gui import QgsMapMouseEvent, QgsMapTool, QgsSnapIndicator
from qgis.PyQt.QtCore import QEvent, QObject, QPoint, Qt
from qgis.PyQt.QtGui import QKeyEvent, QKeySequence
from qgis.PyQt.QtWidgets import QApplication

from ...control.coordinates import read_site_place
from ...control.fleet_controller import FleetController
from ...control.messages import SELECTION, Level
from ...control.pending_command import PendingCommand, Point
from ...ui.errors import FleetError
from ...ui.language import tr

FINE_M, COARSE_M = 0.1, 1.0
"""Metres a key press, with Ctrl, and with Ctrl and Shift."""
_ASIDE = {Qt.Key.Key_Left: (-1, 0), Qt.Key.Key_Right: (1, 0), Qt.Key.Key_Up: (0, -1), Qt.Key.Key_Down: (0, 1)}
_PIXELS = 50


def is_arrow_move(event: QKeyEvent) -> bool:
    """Tell whether it is Ctrl with an arrow key."""
    return event.key() in _ASIDE and bool(event.modifiers() & Qt.KeyboardModifier.ControlModifier)


def moved_by_arrow(event: QKeyEvent, desk: FleetController, point: Point) -> Point:
    """Return where ``point`` of the site frame goes by Ctrl and an arrow key.

    Left is left on the screen, however map and site frame are turned.

    :raises MapTransformError: when the point has no place on the map.
    """
    aside = _ASIDE[event.key()]
    coarse = event.modifiers() & Qt.KeyboardModifier.ShiftModifier
    placement, screen = desk.site_to_canvas.transform(), desk.canvas.getCoordinateTransform()
    ((x, y),) = placement.to_map(np.array([point]))
    pixel = screen.transform(QgsPointXY(x, y))
    beside = placement.to_site(
        screen.toMapCoordinatesF(pixel.x() + aside[0] * _PIXELS, pixel.y() + aside[1] * _PIXELS)
    )
    dx, dy = beside[0] - point[0], beside[1] - point[1]
    step = (COARSE_M if coarse else FINE_M) / math.hypot(dx, dy)
    return point[0] + dx * step, point[1] + dy * step


SEND_KEYS = (Qt.Key.Key_Return, Qt.Key.Key_Enter)
UNDO, REDO = QKeySequence.StandardKey.Undo, QKeySequence.StandardKey.Redo
PASTE = QKeySequence.StandardKey.Paste
PASTED_IN = "EPSG:4326"


class DrawingTool(QgsMapTool):
    """A tool that makes a draft. Nothing but Enter sends it: no click, no double click, no leaving.

    Clicks snap as QGIS's snapping settings say.
    """

    kind = ""

    def __init__(self, desk: FleetController):
        super().__init__(desk.canvas)
        self.desk = desk
        self._pressed_at: QPoint | None = None
        self._snapped: QgsSnapIndicator | None = None
        self.setCursor(Qt.CursorShape.CrossCursor)

    def activate(self) -> None:
        super().activate()
        # No longer than the tool is in hand: its marker must not outlive the canvas.
        self._snapped = QgsSnapIndicator(self.canvas())
        self.canvas().installEventFilter(self)
        self.canvas().setFocus()
        if self.desk.selection.last is None:
            text = tr("Select a robot first, in the table or on the map.")
            self.desk.messages.post(text, Level.WARNING, SELECTION)

    def deactivate(self) -> None:
        self._pressed_at = None
        self._snapped = None
        self.canvas().removeEventFilter(self)
        if self.draft is not None:
            self.desk.drafts.point_at(None)
        super().deactivate()

    @property
    def on_map(self) -> PendingCommand | None:
        """The draft that can be changed; one that was sent goes out as it is once it has been checked."""
        return None if self.desk.checks.has_order else self.desk.drafts.draft

    @property
    def draft(self) -> PendingCommand | None:
        """The draft if it is one of this tool's."""
        draft = self.on_map
        return draft if draft is not None and draft.kind == self.kind else None

    def canvasPressEvent(self, event: QgsMapMouseEvent) -> None:
        self._pressed_at = event.pos()

    def canvasMoveEvent(self, event: QgsMapMouseEvent) -> None:
        event.snapPoint()
        if self._snapped is not None:
            self._snapped.setMatch(event.mapPointMatch())
        self.hovered(event)

    def canvasReleaseEvent(self, event: QgsMapMouseEvent) -> None:
        # The second click of a double click comes without a press and so is no click of its own.
        pressed, self._pressed_at = self._pressed_at, None
        if pressed is None:
            return
        if self.is_drag(pressed, event.pos()):
            return
        if event.button() == Qt.MouseButton.RightButton:
            self.finish()
        elif event.button() == Qt.MouseButton.LeftButton:
            at = event.snapPoint()
            self._try(lambda: self._place(lambda: self.desk.site_to_canvas.transform().to_site(at)))

    def keyPressEvent(self, event: QKeyEvent) -> None:
        if event.key() in SEND_KEYS:
            if not event.isAutoRepeat():
                self.desk.sending.send()
            event.accept()
        elif event.key() == Qt.Key.Key_Escape:
            self.desk.drafts.set_command(None)
            event.ignore()
        elif self.key(event):
            # An ignored event tells QGIS that the tool took it; else it deletes the selected features.
            event.ignore()
        else:
            super().keyPressEvent(event)

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        # QGIS's own Undo and Paste are about layers; over the map a tool that draws comes first.
        if event.type() == QEvent.Type.ShortcutOverride and _is_ours(event):
            event.accept()
        return False

    def hovered(self, event: QgsMapMouseEvent) -> None:
        """Take in that the mouse moved; the event's map point is snapped."""

    def key(self, event: QKeyEvent) -> bool:
        """Take in a key; false for one that means nothing here."""
        if event.matches(UNDO):
            self._undo(self.desk.drafts.undo(), tr("There is nothing to take back."))
        elif event.matches(REDO):
            self._undo(self.desk.drafts.redo(), tr("There is nothing to do again."))
        elif event.matches(PASTE):
            self.paste()
        elif event.key() in (Qt.Key.Key_Backspace, Qt.Key.Key_Delete):
            self.back()
        else:
            return False
        return True

    def clicked(self, point: Point) -> None:
        """Take in a click at a point of the site frame."""
        raise NotImplementedError

    def finish(self) -> None:
        """Take in a right click, which with QGIS's own tools ends drawing: what is drawn stays.

        A draft of one point is whole with its click, so there is nothing to end.
        """

    def back(self) -> None:
        """Take back the last click."""
        self.desk.drafts.set_command(None)

    def paste(self) -> None:
        """Take what the clipboard holds, ``lat, lon`` in WGS 84, for a click there."""
        self._try(lambda: self._place(self._pasted))

    def add_point(self, point: Point) -> None:
        """Take a point of the site frame, from wherever, for a click there."""
        self._try(lambda: self._place(lambda: point))

    def set_command(self, draft: PendingCommand) -> None:
        """Check a draft and make it the one.

        :raises FleetError: when it cannot be checked.
        """
        self.desk.put_draft(draft)

    @staticmethod
    def is_drag(pressed: QPoint, now: QPoint) -> bool:
        """Tell whether the mouse went further than in a click."""
        return (now - pressed).manhattanLength() > QApplication.startDragDistance()

    def _place(self, where: Callable[[], Point]) -> None:
        """Take in a click at the point that ``where`` returns, if there is somebody to send there."""
        self._check_robot()
        self.clicked(where())

    def _pasted(self) -> Point:
        self.desk.site_to_canvas.transform()
        wgs84 = QgsCoordinateReferenceSystem(PASTED_IN)
        context = self.desk.project.transformContext()
        return read_site_place(QApplication.clipboard().text(), wgs84, self.desk.state.site, context)

    def _try(self, change: Callable[[], object]) -> None:
        try:
            change()
        except FleetError as error:
            self.desk.complained.emit(str(error))

    def _check_robot(self) -> None:
        if self.desk.selection.last is None and self.draft is None:
            raise FleetError(
                tr(
                    "No robot is selected, so there is nobody to send there. Select one in the table or on "
                    "the map."
                )
            )

    def _undo(self, done: bool, otherwise: str) -> None:
        if not done:
            self.desk.remarked.emit(otherwise)


def _is_ours(event: QKeyEvent) -> bool:
    return any(event.matches(key) for key in (UNDO, REDO, PASTE))
