"""The queue of the selected robot on the map: its tasks as numbers in their order, joined by a thin line."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
from qgis.gui import QgsMapCanvasItem
from qgis.PyQt import sip
from qgis.PyQt.QtCore import QPointF, QRectF, Qt
from qgis.PyQt.QtGui import QBrush, QColor, QFont, QImage, QPainter, QPen
from qgis.PyQt.QtWidgets import QStyleOptionGraphicsItem, QWidget

from ...errors import FleetError
from ..colours import CASING, CONE, PAPER
from ..desk import Desk
from ..live.screen import Screen, screen_of
from ..live.screen_image import screen_image
from ..live.strokes import lines, polygon

Points = npt.NDArray[np.float64]

RADIUS = 9.0
MOST_DOTTED = 60
"""With more tasks the line between them is thin: dots on all of it would take longer than a frame."""
MOST_NUMBERED = 200
"""Tasks with a number; the line leads on through all."""
BELOW_ROBOTS = 80
"""Beneath the live picture, which lies at 90."""
INK = QColor(20, 24, 28)
NOWHERE: Points = np.empty((0, 2))


class QueueMarks(QgsMapCanvasItem):
    """Covers the whole viewport. Painted into an image once for each queue, selection and view: the robots
    above it are painted twenty times a second, and it with them.
    """

    def __init__(self, desk: Desk):
        super().__init__(desk.canvas)
        self._desk = desk
        self.places = NOWHERE
        """Of the tasks in their order, (n, 2) in the map's CRS."""
        self._image: QImage | None = None
        self._made_for: Screen | None = None
        self.setZValue(BELOW_ROBOTS)
        desk.queues_changed.connect(self._place)
        desk.selection_changed.connect(self._place)
        desk.site_changed.connect(self._place)
        desk.canvas.destinationCrsChanged.connect(self._place)
        desk.project.transformContextChanged.connect(self._place)

    def remove(self) -> None:
        """Take it off the canvas."""
        self._desk.canvas.destinationCrsChanged.disconnect(self._place)
        self._desk.project.transformContextChanged.disconnect(self._place)
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
        if len(self.places) == 0:
            return
        ratio = painter.device().devicePixelRatioF() if painter.device() else 1.0
        screen = screen_of(self._desk.canvas, self, ratio)
        if screen != self._made_for:
            pixels = screen.pixels(self.places)
            self._image, self._made_for = screen_image(screen, lambda on: _paint(on, pixels, screen)), screen
        painter.drawImage(QPointF(0.0, 0.0), self._image)

    def _place(self, *_: object) -> None:
        robot = self._desk.selected
        queue = self._desk.queues.get(robot) if robot is not None else None
        points = [(task.x, task.y) for task in queue.tasks] if queue is not None else []
        self.places, self._image, self._made_for = NOWHERE, None, None
        if points:
            try:
                self.places = self._desk.placement().to_map(np.array(points))
            except FleetError:
                # The live picture says why nothing can be placed on this map.
                self.places = NOWHERE
        self.update()


def _paint(painter: QPainter, pixels: Points, screen: Screen) -> None:
    """Paint tasks at (n, 2) ``pixels`` and the line through them."""
    painter.setRenderHint(QPainter.RenderHint.Antialiasing)
    if len(pixels) <= MOST_DOTTED:
        legs = lines(pixels[:-1], pixels[1:])
        for colour, width in ((CASING, 3.4), (PAPER, 1.4)):
            painter.setPen(QPen(colour, width, Qt.PenStyle.DotLine))
            painter.drawLines(legs)
    else:
        painter.setPen(QPen(CONE, 0.0))
        painter.drawPolyline(polygon(pixels))
    font = QFont(painter.font())
    font.setPixelSize(11)
    font.setBold(True)
    painter.setFont(font)
    numbered = pixels[:MOST_NUMBERED]
    # The first on top: where several stand in one place it comes next.
    for number in np.flatnonzero(screen.seen(numbered, 2 * RADIUS))[::-1].tolist():
        _paint_number(painter, QPointF(*numbered[number].tolist()), number + 1)


def _paint_number(painter: QPainter, at: QPointF, number: int) -> None:
    painter.setPen(QPen(CONE, 2.0))
    painter.setBrush(QBrush(PAPER))
    painter.drawEllipse(at, RADIUS, RADIUS)
    painter.setPen(INK)
    box = QRectF(at.x() - 2 * RADIUS, at.y() - RADIUS, 4 * RADIUS, 2 * RADIUS)
    painter.drawText(box, Qt.AlignmentFlag.AlignCenter, str(number))
