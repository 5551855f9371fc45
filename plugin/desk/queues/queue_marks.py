"""The queue of the selected robot on the map: its tasks as numbers in their order, joined by a thin line."""

from __future__ import annotations

import numpy as np
from qgis.core import QgsPointXY
from qgis.gui import QgsMapCanvasItem
from qgis.PyQt import sip
from qgis.PyQt.QtCore import QPointF, QRectF, Qt
from qgis.PyQt.QtGui import QBrush, QColor, QFont, QPainter, QPen, QPolygonF
from qgis.PyQt.QtWidgets import QStyleOptionGraphicsItem, QWidget

from ...errors import FleetError
from ..colours import CASING, CONE, PAPER
from ..desk import Desk

RADIUS = 9.0
MOST_NUMBERED = 200
"""Tasks with a number; the line leads on through all."""
BELOW_ROBOTS = 80
"""Beneath the live picture, which lies at 90."""
INK = QColor(20, 24, 28)


class QueueMarks(QgsMapCanvasItem):
    """Covers the whole viewport; painted anew when queue, selection or map change."""

    def __init__(self, desk: Desk):
        super().__init__(desk.canvas)
        self._desk = desk
        self.places: list[QgsPointXY] = []
        """Of the tasks in their order, in the map's CRS."""
        self.setZValue(BELOW_ROBOTS)
        desk.queues_changed.connect(self._place)
        desk.selection_changed.connect(self._place)
        desk.site_changed.connect(self._place)
        desk.canvas.destinationCrsChanged.connect(self._place)

    def remove(self) -> None:
        """Take it off the canvas."""
        self._desk.canvas.destinationCrsChanged.disconnect(self._place)
        if not sip.isdeleted(self._desk.canvas):
            self._desk.canvas.scene().removeItem(self)

    def boundingRect(self) -> QRectF:
        return QRectF(0, 0, self._desk.canvas.width(), self._desk.canvas.height())

    def updatePosition(self) -> None:
        self.prepareGeometryChange()
        self.setPos(0, 0)

    def paint(
        self, painter: QPainter, option: QStyleOptionGraphicsItem | None = None, widget: QWidget | None = None
    ) -> None:
        if not self.places:
            return
        pixels = [self.toCanvasCoordinates(place) for place in self.places]
        painter.save()
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        painter.setBrush(QBrush(Qt.BrushStyle.NoBrush))
        for colour, width in ((CASING, 3.4), (PAPER, 1.4)):
            painter.setPen(QPen(colour, width, Qt.PenStyle.DotLine))
            painter.drawPolyline(QPolygonF(pixels))
        font = QFont(painter.font())
        font.setPixelSize(11)
        font.setBold(True)
        painter.setFont(font)
        # The first on top: where several stand in one place it comes next.
        for number in reversed(range(min(len(pixels), MOST_NUMBERED))):
            self._paint_number(painter, pixels[number], number + 1)
        painter.restore()

    def _paint_number(self, painter: QPainter, at: QPointF, number: int) -> None:
        painter.setPen(QPen(CONE, 2.0))
        painter.setBrush(QBrush(PAPER))
        painter.drawEllipse(at, RADIUS, RADIUS)
        painter.setPen(INK)
        box = QRectF(at.x() - 2 * RADIUS, at.y() - RADIUS, 4 * RADIUS, 2 * RADIUS)
        painter.drawText(box, Qt.AlignmentFlag.AlignCenter, str(number))

    def _place(self, *_: object) -> None:
        robot = self._desk.selected
        queue = self._desk.queues.get(robot) if robot is not None else None
        points = [(task.x, task.y) for task in queue.tasks] if queue is not None else []
        self.places = []
        if points:
            try:
                placed = self._desk.placement().to_map(np.array(points))
                self.places = [QgsPointXY(x, y) for x, y in placed.tolist()]
            except FleetError:
                # The live picture says why nothing can be placed on this map.
                self.places = []
        self.update()
