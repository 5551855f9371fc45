"""Paints what robots are about to do: their ways, targets, and how far it is still."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import numpy.typing as npt
from qgis.PyQt.QtCore import QPointF, Qt
from qgis.PyQt.QtGui import QImage, QPainter, QPen

from ...language import tr
from ..colours import PAPER, ROUTE
from .atlases import CONE_TARGET, TARGET
from .labels import Labels
from .scene import PlacedScene
from .screen import Screen
from .screen_image import screen_image
from .sprites import Sprites
from .strokes import dashes, polygon, route

Points = npt.NDArray[np.float64]
MANY = 60
"""With more plans ways are thin, targets small, and only selected robots have their lines and distances."""
SMALL = 0.5


class PlansPainter:
    """Keeps an image of the ways, which change seldom."""

    def __init__(self, labels: Labels) -> None:
        self._labels = labels
        self._image: QImage | None = None
        self.distances: list[tuple[float, float]] = []
        """The targets, in pixels, below which a distance was written last."""
        self._made_for: tuple = ()

    def paint(
        self,
        painter: QPainter,
        placed: PlacedScene,
        pixels: Points,
        screen: Screen,
        marks: Callable[[float, float], Sprites],
    ) -> None:
        """Paint every plan; ``pixels`` (n, 2) is where each robot is.

        ``marks`` gives the marks of a pixel ratio and a size.
        """
        plans = placed.scene.plans
        self.distances = []
        if not plans:
            self._image, self._made_for = None, ()
            return
        self._ways(painter, placed, screen)
        targets = screen.pixels(np.array([points[-1] for points in placed.plans]))
        shown = range(len(plans)) if len(plans) <= MANY else self._of_chosen(placed)
        for k in shown:
            if not plans[k].is_way and plans[k].robot in placed.scene.rows:
                start = pixels[placed.scene.rows[plans[k].robot]]
                if np.isfinite(start).all():
                    dashes(painter, np.array([start, targets[k]]), PAPER, Qt.PenStyle.DotLine)
        kind = np.array([CONE_TARGET if plan.cone else TARGET for plan in plans])
        on = screen.seen(targets, 30.0)
        large = np.isin(np.arange(len(plans)), shown)
        marks(screen.ratio, SMALL).paint(painter, targets[on & ~large], kind[on & ~large])
        marks(screen.ratio, 1.0).paint(painter, targets[on & large], kind[on & large])
        self.distances = [(float(targets[k, 0]), float(targets[k, 1])) for k in shown if on[k]]
        for k in shown:
            self._distance(painter, placed.scene.remaining.get(plans[k].command), targets[k], screen)

    def _of_chosen(self, placed: PlacedScene) -> list[int]:
        chosen = set(placed.scene.chosen)
        return [k for k, plan in enumerate(placed.scene.plans) if plan.robot in chosen][:MANY]

    def _distance(self, painter: QPainter, metres: float | None, at: Points, screen: Screen) -> None:
        if metres is None:
            return
        text = (
            tr(
                "{metres:.0f} m",
                metres=metres,
            )
            if metres < 9950
            else tr("{km:.0f} km", km=metres / 1000)
        )
        label = self._labels.picture(text, screen.ratio)
        painter.drawPixmap(QPointF(at[0] - label.width() / screen.ratio / 2, at[1] + 5), label)

    def _ways(self, painter: QPainter, placed: PlacedScene, screen: Screen) -> None:
        ways = [k for k, plan in enumerate(placed.scene.plans) if plan.is_way]
        made_for = (screen, placed.to_map, tuple(placed.scene.plans[k].command for k in ways))
        if made_for != self._made_for:
            self._image = _drawn([screen.pixels(placed.plans[k]) for k in ways], screen) if ways else None
            self._made_for = made_for
        if self._image is not None:
            painter.drawImage(QPointF(0.0, 0.0), self._image)


def _drawn(ways: list[Points], screen: Screen) -> QImage:
    def paint(painter: QPainter) -> None:
        if len(ways) <= MANY:
            painter.setRenderHint(QPainter.RenderHint.Antialiasing)
            for way in ways:
                route(painter, way, ROUTE)
        else:
            painter.setPen(QPen(ROUTE, 0.0))
            for way in ways:
                painter.drawPolyline(polygon(way))

    return screen_image(screen, paint)
