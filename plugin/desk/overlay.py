"""The live picture over the map: one canvas item for all robots, trails, targets and drafts."""

from __future__ import annotations

import numpy as np
from qgis.core import QgsPointXY
from qgis.gui import QgsMapCanvas, QgsMapCanvasItem
from qgis.PyQt.QtCore import QRectF
from qgis.PyQt.QtGui import QPainter

from .painting import ScenePainter, ToPixels
from .scene import PlacedScene

NEAR = 18.0
"""Pixels within which a click means a robot."""


class FleetOverlay(QgsMapCanvasItem):
    """Covers the whole viewport and paints the scene it was last given, in the map's CRS."""

    def __init__(self, canvas: QgsMapCanvas):
        super().__init__(canvas)
        self._canvas = canvas
        self._placed: PlacedScene | None = None
        self._painter = ScenePainter()
        self.setZValue(90)

    def show_scene(self, placed: PlacedScene | None) -> None:
        """Paint ``placed`` from now on, None for nothing."""
        self._placed = placed
        self.update()

    def boundingRect(self) -> QRectF:
        return QRectF(0, 0, self._canvas.width(), self._canvas.height())

    def updatePosition(self) -> None:
        self.prepareGeometryChange()
        self.setPos(0, 0)

    def paint(self, painter: QPainter, option=None, widget=None) -> None:
        if self._placed is None:
            return
        ratio = painter.device().devicePixelRatioF() if painter.device() else 1.0
        painter.save()
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        self._painter.paint(painter, self._placed, self._to_pixels(), ratio)
        painter.restore()

    def robot_at(self, x: float, y: float) -> str | None:
        """Return the robot nearest to pixel (x, y), None when there is none nearby."""
        if self._placed is None or len(self._placed.robots) == 0:
            return None
        away = np.hypot(*(self._to_pixels()(self._placed.robots) - (x, y)).T)
        nearest = int(away.argmin())
        return self._placed.scene.robots.names[nearest] if away[nearest] <= NEAR else None

    def _to_pixels(self) -> ToPixels:
        """Return what takes (n, 2) map coordinates to logical pixels, panning and rotation included."""
        centre = self._canvas.center()
        unit = self._canvas.mapUnitsPerPixel() * 1000.0
        corner = self.toCanvasCoordinates(centre)
        right = self.toCanvasCoordinates(QgsPointXY(centre.x() + unit, centre.y()))
        up = self.toCanvasCoordinates(QgsPointXY(centre.x(), centre.y() + unit))
        origin = np.array([centre.x(), centre.y()])
        pixel = np.array([corner.x(), corner.y()])
        axes = np.array([[right.x(), right.y()], [up.x(), up.y()]]) - pixel
        return lambda xy: (xy - origin) @ (axes / unit) + pixel
