"""The live picture over the map: one canvas item for all robots, trails, targets and drafts."""

from __future__ import annotations

import time

import numpy as np
from qgis.gui import QgsMapCanvas, QgsMapCanvasItem
from qgis.PyQt.QtCore import QRect, QRectF
from qgis.PyQt.QtGui import QPainter
from qgis.PyQt.QtWidgets import QStyleOptionGraphicsItem, QWidget

from .painting import ScenePainter
from .scene import PlacedScene
from .screen import Screen, screen_of
from .trails import Trails

NEAR = 18.0
"""Pixels within which a click means a robot."""


class FleetOverlay(QgsMapCanvasItem):
    """Covers the whole viewport and paints the scene it was last given, in the map's CRS."""

    def __init__(self, canvas: QgsMapCanvas, trails: Trails | None = None):
        super().__init__(canvas)
        self._canvas = canvas
        self._placed: PlacedScene | None = None
        self._painter = ScenePainter(trails)
        self.took = 0.0
        """Seconds that painting took last."""
        self.frames = 0
        """How often it was painted."""
        self.setZValue(90)

    def show_scene(self, placed: PlacedScene | None) -> None:
        """Paint ``placed`` from now on, None for nothing."""
        self._placed = placed
        self.prepare()

    def prepare(self) -> None:
        """Go on with what is not whole of the scene, and have it as the canvas shows it now."""
        self._painter.prepare(self._placed, self.screen(self._canvas.viewport().devicePixelRatioF()))
        self.update()

    def boundingRect(self) -> QRectF:
        return QRectF(0, 0, self._canvas.width(), self._canvas.height())

    def updatePosition(self) -> None:
        self.prepareGeometryChange()
        self.setPos(0, 0)

    def paint(
        self, painter: QPainter, option: QStyleOptionGraphicsItem | None = None, widget: QWidget | None = None
    ) -> None:
        if self._placed is None:
            return
        began = time.perf_counter()
        ratio = painter.device().devicePixelRatioF() if painter.device() else 1.0
        painter.save()
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        self._painter.paint(painter, self._placed, self.screen(ratio))
        painter.restore()
        self.took = time.perf_counter() - began
        self.frames += 1

    @property
    def is_whole(self) -> bool:
        """Whether nothing is left to be painted by more frames."""
        return self._painter.is_whole

    def magnify(self, times: float) -> None:
        """Draw robots so many times as large as they come."""
        self._painter.robots.magnification = times
        self.update()

    def draw_arrows(self, wanted: bool) -> None:
        """Draw an arrow for each robot, or leave that to the layer; the rest is drawn always."""
        self._painter.robots.arrows = wanted

    def robot_at(self, x: float, y: float) -> str | None:
        """Return the robot nearest to pixel (x, y), None when there is none nearby."""
        pixels = self._pixels()
        if len(pixels) == 0:
            return None
        away = np.hypot(*(pixels - (x, y)).T)
        nearest = int(np.where(np.isfinite(away), away, np.inf).argmin())
        return self._placed.scene.robots.names[nearest] if away[nearest] <= NEAR else None

    def robots_in(self, area: QRect) -> list[str]:
        """Return the robots whose places are in ``area``, in pixels."""
        x, y = self._pixels().T
        inside = (x >= area.left()) & (x <= area.right()) & (y >= area.top()) & (y <= area.bottom())
        return [self._placed.scene.robots.names[row] for row in np.flatnonzero(inside).tolist()]

    def robots_beyond(self, x: float, y: float) -> list[str]:
        """Return the robots beyond the border that the arrow at pixel (x, y) points to."""
        for hint in self._painter.hints if self._placed else []:
            if np.hypot(hint.x - x, hint.y - y) <= NEAR:
                return [self._placed.scene.robots.names[row] for row in hint.rows.tolist()]
        return []

    def screen(self, ratio: float = 1.0) -> Screen:
        """Return what of the map the canvas shows now."""
        return screen_of(self._canvas, self, ratio)

    def _pixels(self) -> np.ndarray:
        if self._placed is None:
            return np.empty((0, 2))
        return self.screen().pixels(self._placed.robots)
