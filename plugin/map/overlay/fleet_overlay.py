"""The canvas item of the overlay, and the order in which a scene is painted."""

from __future__ import annotations

import time

import numpy as np
from qgis.gui import QgsMapCanvas, QgsMapCanvasItem
from qgis.PyQt.QtCore import QRect, QRectF
from qgis.PyQt.QtGui import QPainter
from qgis.PyQt.QtWidgets import QStyleOptionGraphicsItem, QWidget

from .labels import Labels, NamesPainter
from .paths_painter import PathsPainter
from .robots_painter import BorderHints, Hint, RobotsPainter, circles, paint_circles
from .scene import InView, MapScene, in_view
from .screen import Screen, screen_of
from .task_painter import PendingCommandPainter
from .trails import TrailImage, Trails

# --- Paints a scene, from the ground up: trails, ways, targets, draft, robots, names, the border ---


class ScenePainter:
    """Paints scenes; keeps the pictures that it paints again and again."""

    def __init__(self, trails: Trails | None = None) -> None:
        self._labels = Labels()
        self._trails = TrailImage(Trails() if trails is None else trails)
        self._plans = PathsPainter(self._labels)
        self._draft = PendingCommandPainter()
        self.robots = RobotsPainter()
        self._names = NamesPainter(self._labels)
        self._borders = BorderHints(self._labels)
        self._circles: list = []
        self._viewed: tuple[MapScene, Screen, InView] | None = None

    @property
    def hints(self) -> list[Hint]:
        """The arrows at the border that were painted last."""
        return self._borders.hints

    @property
    def is_whole(self) -> bool:
        """Whether nothing is left to be painted by more frames."""
        return self._plans.is_whole

    def prepare(self, placed: MapScene | None, screen: Screen) -> None:
        """Take in a new scene: what is drawn once for each and not for each time it is painted.

        The same scene is taken in again while it is not whole, or when it is seen on another screen.
        """
        if placed is None:
            self._trails.forget()
            self._viewed = None
            return
        self._trails.extend(placed.robots, screen, placed.to_map, placed.scene.now)
        view = self._view(placed, screen)
        self._circles = circles(placed, view)
        self.robots.prepare(placed, view, screen)
        self._plans.prepare(placed, screen, self.robots.marks)

    def paint(self, painter: QPainter, placed: MapScene, screen: Screen) -> None:
        """Paint the scene that was prepared last."""
        view = self._view(placed, screen)
        self._trails.paint(painter, screen)
        paint_circles(painter, self._circles, placed, screen)
        self._plans.paint(painter, placed, view.pixels, screen, self.robots.marks)
        self._draft.paint(painter, placed, view.pixels, screen, self.robots.marks)
        self.robots.paint(painter, placed, view, screen)
        self._borders.find(placed, view, screen)
        taken = [(x - 24.0, y, x + 24.0, y + 26.0) for x, y in self._plans.distances]
        taken += [hint.area for hint in self.hints]
        self._names.paint(painter, placed, view, screen, taken)
        self._borders.paint(painter, placed, screen)

    def _view(self, placed: MapScene, screen: Screen) -> InView:
        """Return what of the robots is on ``screen``, reckoned once for each scene and screen."""
        if self._viewed is None or self._viewed[0] is not placed or self._viewed[1] != screen:
            self._viewed = placed, screen, in_view(placed, screen)
        return self._viewed[2]


# --- The live picture over the map: one canvas item for all robots, trails, targets and drafts ---

NEAR = 18.0
"""Pixels within which a click means a robot."""


class FleetOverlay(QgsMapCanvasItem):
    """Covers the whole viewport and paints the scene it was last given, in the map's CRS."""

    def __init__(self, canvas: QgsMapCanvas, trails: Trails | None = None):
        super().__init__(canvas)
        self._canvas = canvas
        self._placed: MapScene | None = None
        self._painter = ScenePainter(trails)
        self.took = 0.0
        """Seconds that painting took last."""
        self.frames = 0
        """How often it was painted."""
        self.setZValue(90)

    def show_scene(self, placed: MapScene | None) -> None:
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
