"""The map tool that selects a robot."""

from __future__ import annotations

from qgis.gui import QgsMapMouseEvent, QgsMapTool
from qgis.PyQt.QtCore import Qt

from .desk import Desk
from .overlay import FleetOverlay


class SelectTool(QgsMapTool):
    """A click on a robot selects it, a click beside all of them selects none."""

    def __init__(self, desk: Desk, overlay: FleetOverlay):
        super().__init__(desk.canvas)
        self._desk = desk
        self._overlay = overlay
        self.setCursor(Qt.CursorShape.PointingHandCursor)

    def canvasReleaseEvent(self, event: QgsMapMouseEvent) -> None:
        if event.button() == Qt.MouseButton.LeftButton:
            self._desk.select(self._overlay.robot_at(event.pos().x(), event.pos().y()))
