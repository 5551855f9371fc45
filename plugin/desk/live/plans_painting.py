"""Paints what robots are about to do: their ways, targets, and how far it is still."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
import numpy.typing as npt
from qgis.PyQt.QtCore import QPointF, Qt
from qgis.PyQt.QtGui import QPainter

from ...language import tr
from ..colours import PAPER
from .atlases import CONE_TARGET, TARGET
from .labels import Labels
from .scene import PlacedScene
from .screen import Screen
from .sprites import Sprites
from .strokes import broken, lines
from .ways_image import MANY, WaysImage

Points = npt.NDArray[np.float64]
Marks = Callable[[float, float], Sprites]
"""Gives the marks of a pixel ratio and a size."""
SMALL = 0.5


class PlansPainter:
    """Keeps what changes only with the plans."""

    def __init__(self, labels: Labels) -> None:
        self._labels = labels
        self._ways = WaysImage()
        self._of: list[Points] | None = None
        """The plans, as they are placed, that these are of:"""
        self._ends = np.empty((0, 2))
        self._kinds = np.empty(0, dtype=np.intp)
        self.distances: list[tuple[float, float]] = []
        """The targets, in pixels, below which a distance was written last."""

    @property
    def is_whole(self) -> bool:
        """Whether nothing is left to be painted by more frames."""
        return self._ways.is_whole

    def prepare(self, placed: PlacedScene, screen: Screen, marks: Marks) -> None:
        """Make what :meth:`paint` only puts there: in one piece both would hold up the window."""
        plans = placed.scene.plans
        if not plans:
            self._ways.forget()
            self._of = None
            return
        if placed.plans is not self._of:
            self._take(placed)
        self._ways.prepare(placed, screen)
        for size in (SMALL, 1.0):
            marks(screen.ratio, size)

    def paint(
        self, painter: QPainter, placed: PlacedScene, pixels: Points, screen: Screen, marks: Marks
    ) -> None:
        """Paint every plan that was prepared; ``pixels`` (n, 2) is where each robot is."""
        plans = placed.scene.plans
        self.distances = []
        if not plans:
            return
        self._ways.paint(painter, screen)
        targets = screen.pixels(self._ends)
        shown = list(range(len(plans))) if len(plans) <= MANY else _of_chosen(placed)
        _lines_to_targets(painter, placed, shown, pixels, targets)
        on = screen.seen(targets, 30.0)
        small = on.copy()
        small[shown] = False
        large = on & ~small
        marks(screen.ratio, SMALL).paint(painter, targets[small], self._kinds[small])
        marks(screen.ratio, 1.0).paint(painter, targets[large], self._kinds[large])
        seen = [k for k in shown if on[k]]
        self.distances = [(x, y) for x, y in targets[seen].tolist()]
        for k, (x, y) in zip(seen, self.distances, strict=True):
            self._distance(painter, placed.scene.remaining.get(plans[k].command), x, y, screen)

    def _take(self, placed: PlacedScene) -> None:
        self._of = placed.plans
        self._ends = np.array([points[-1] for points in placed.plans])
        self._kinds = np.array([CONE_TARGET if plan.cone else TARGET for plan in placed.scene.plans])

    def _distance(self, painter: QPainter, metres: float | None, x: float, y: float, screen: Screen) -> None:
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
        painter.drawPixmap(QPointF(x - label.width() / screen.ratio / 2, y + 5), label)


def _of_chosen(placed: PlacedScene) -> list[int]:
    chosen = set(placed.scene.chosen)
    return [k for k, plan in enumerate(placed.scene.plans) if plan.robot in chosen][:MANY]


def _lines_to_targets(
    painter: QPainter, placed: PlacedScene, shown: Sequence[int], pixels: Points, targets: Points
) -> None:
    """Paint broken lines from robots at ``pixels`` to ``targets`` to which no way leads."""
    scene = placed.scene
    there = [k for k in shown if not scene.plans[k].is_way and scene.plans[k].robot in scene.rows]
    start = pixels[[scene.rows[scene.plans[k].robot] for k in there]]
    is_known = np.isfinite(start).all(axis=1)
    broken(painter, lines(start[is_known], targets[there][is_known]), PAPER, Qt.PenStyle.DotLine)
