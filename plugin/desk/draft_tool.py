"""What the map tools that draw have in common: click for a point, Enter to send, Esc to cancel."""

from __future__ import annotations

from qgis.core import QgsPointXY
from qgis.gui import QgsMapMouseEvent, QgsMapTool
from qgis.PyQt.QtCore import QPoint, Qt
from qgis.PyQt.QtGui import QKeyEvent
from qgis.PyQt.QtWidgets import QApplication

from ..errors import FleetError
from .desk import Desk
from .drafts import Draft, Point

SEND_KEYS = (Qt.Key.Key_Return, Qt.Key.Key_Enter)


class DraftTool(QgsMapTool):
    """A tool that makes a draft. Nothing but Enter sends it: no click, no double click, no leaving."""

    kind = ""

    def __init__(self, desk: Desk):
        super().__init__(desk.canvas)
        self.desk = desk
        self._pressed_at: QPoint | None = None
        self.setCursor(Qt.CursorShape.CrossCursor)

    def activate(self) -> None:
        super().activate()
        self.canvas().setFocus()
        if self.desk.selected is None:
            self.desk.complained.emit("Select a robot first, in the table or on the map.")

    def deactivate(self) -> None:
        self._pressed_at = None
        if self.draft is not None:
            self.desk.drafts.point_at(None)
        super().deactivate()

    @property
    def draft(self) -> Draft | None:
        """The draft if it is one of this tool's."""
        draft = self.desk.drafts.draft
        return draft if draft is not None and draft.kind == self.kind else None

    def canvasPressEvent(self, event: QgsMapMouseEvent) -> None:
        self._pressed_at = event.pos()

    def canvasReleaseEvent(self, event: QgsMapMouseEvent) -> None:
        # The second click of a double click comes without a press and so is no click of its own.
        pressed, self._pressed_at = self._pressed_at, None
        if pressed is None:
            return
        if (event.pos() - pressed).manhattanLength() > QApplication.startDragDistance():
            return
        if event.button() == Qt.MouseButton.RightButton:
            self.desk.drafts.put(None)
        elif event.button() == Qt.MouseButton.LeftButton:
            self._try_click(event.mapPoint())

    def keyPressEvent(self, event: QKeyEvent) -> None:
        if event.key() in SEND_KEYS:
            if not event.isAutoRepeat():
                self.desk.send_draft()
            event.accept()
        elif event.key() == Qt.Key.Key_Escape:
            self.desk.drafts.put(None)
            event.ignore()
        elif event.key() in (Qt.Key.Key_Backspace, Qt.Key.Key_Delete):
            self.back()
            # An ignored event tells QGIS that the tool took it; else it deletes the selected features.
            event.ignore()
        else:
            super().keyPressEvent(event)

    def clicked(self, point: Point) -> None:
        """Take in a click at a point of the site frame."""
        raise NotImplementedError

    def back(self) -> None:
        """Take back the last click."""
        self.desk.drafts.put(None)

    def _try_click(self, map_point: QgsPointXY) -> None:
        if self.desk.selected is None and self.draft is None:
            self.desk.complained.emit(
                "No robot is selected, so there is nobody to send there. Select one in the table or on the "
                "map."
            )
            return
        try:
            self.clicked(self.desk.placement().to_site(map_point))
        except FleetError as error:
            self.desk.complained.emit(str(error))
