"""Paths, targets and remaining distances of robots, painted."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence

import numpy as np
import numpy.typing as npt
from qgis.PyQt.QtCore import QPointF, Qt
from qgis.PyQt.QtGui import QPainter, QPen

from ...ui.glyphs import PAPER, ROUTE
from ...ui.language import tr
from .labels import Labels
from .primitives import CONE_TARGET, TARGET, Sprites, broken, lines, polygon, route
from .scene import MapScene
from .screen import Screen, screen_image

# --- The ways of all plans on the canvas, whichever way the view moves ---

MANY = 60
"""With more plans ways are thin and targets small, and only selected robots have lines and distances."""
FILL_SECONDS = 0.003
"""What painting ways may take of one frame."""


class PathsImage:
    """Shows a sheet of ways, moved along with the view, until the next one is filled.

    Of a thousand robots some have new ways in every frame, and to paint all of them takes several frames. So
    each sheet is filled to its end, and shows what was so when it was begun.
    """

    def __init__(self) -> None:
        self.forget()

    def forget(self) -> None:
        """Show nothing until the next :meth:`prepare`."""
        self._shown: _PathsSheet | None = None
        self._next: _PathsSheet | None = None
        self.is_whole = True
        """Whether nothing is left to be painted by more frames."""

    def prepare(self, placed: MapScene, screen: Screen) -> None:
        """Paint some more of the ways into what is shown of them on ``screen``."""
        if self._next is not None and self._next.to_map != placed.to_map:
            self.forget()
        if self._next is None or (self._next.is_full and not self._next.is_of(placed, screen)):
            self._next = _PathsSheet(placed, screen)
        self._next.fill()
        self.is_whole = self._next.is_full and self._next.is_of(placed, screen)
        if self._next.is_full or self._shown is None:
            self._shown = self._next

    def paint(self, painter: QPainter, screen: Screen) -> None:
        """Show what was prepared, where it is on ``screen``."""
        if self._shown is None or self._shown.image is None:
            return
        painter.save()
        if screen != self._shown.screen:
            painter.setTransform(screen.since(self._shown.screen), True)
        painter.drawImage(QPointF(0.0, 0.0), self._shown.image)
        painter.restore()


class _PathsSheet:
    """The ways of ``placed`` as ``screen`` shows them; made empty and filled bit by bit."""

    def __init__(self, placed: MapScene, screen: Screen) -> None:
        self.screen = screen
        self.to_map = placed.to_map
        self._plans = placed.plans
        pairs = zip(placed.scene.plans, placed.plans, strict=True)
        self._left = [points for plan, points in pairs if plan.is_way]
        self.image = screen_image(screen, lambda _: None) if self._left else None
        """None where there is no way."""
        self._is_thin = len(self._left) > MANY

    @property
    def is_full(self) -> bool:
        """Whether every way is painted."""
        return not self._left

    def is_of(self, placed: MapScene, screen: Screen) -> bool:
        """Tell whether it shows the plans of ``placed`` on this screen."""
        return self._plans is placed.plans and self.screen == screen

    def fill(self) -> None:
        """Paint more ways while there is time, at least one."""
        if self.is_full:
            return
        until = time.perf_counter() + FILL_SECONDS
        painter = QPainter(self.image)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing, not self._is_thin)
        painter.setPen(QPen(ROUTE, 0.0))
        while self._left:
            pixels = self.screen.pixels(self._left.pop())
            if self._is_thin:
                painter.drawPolyline(polygon(pixels))
            else:
                route(painter, pixels, ROUTE)
            if time.perf_counter() > until:
                break
        painter.end()


# --- Paints what robots are about to do: their ways, targets, and how far it is still ---

Points = npt.NDArray[np.float64]
Marks = Callable[[float, float], Sprites]
"""Gives the marks of a pixel ratio and a size."""
SMALL = 0.5


class PathsPainter:
    """Keeps what changes only with the plans."""

    def __init__(self, labels: Labels) -> None:
        self._labels = labels
        self._ways = PathsImage()
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

    def prepare(self, placed: MapScene, screen: Screen, marks: Marks) -> None:
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
        self, painter: QPainter, placed: MapScene, pixels: Points, screen: Screen, marks: Marks
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

    def _take(self, placed: MapScene) -> None:
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


def _of_chosen(placed: MapScene) -> list[int]:
    chosen = set(placed.scene.chosen)
    return [k for k, plan in enumerate(placed.scene.plans) if plan.robot in chosen][:MANY]


def _lines_to_targets(
    painter: QPainter, placed: MapScene, shown: Sequence[int], pixels: Points, targets: Points
) -> None:
    """Paint broken lines from robots at ``pixels`` to ``targets`` to which no way leads."""
    scene = placed.scene
    there = [k for k in shown if not scene.plans[k].is_way and scene.plans[k].robot in scene.rows]
    start = pixels[[scene.rows[scene.plans[k].robot] for k in there]]
    is_known = np.isfinite(start).all(axis=1)
    broken(painter, lines(start[is_known], targets[there][is_known]), PAPER, Qt.PenStyle.DotLine)
