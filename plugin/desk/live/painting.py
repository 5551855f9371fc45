"""Paints a scene, from the ground up: trails, ways, targets, draft, robots, names, the border."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
from qgis.PyQt.QtGui import QPainter

from .border_hints import BorderHints, Hint
from .draft_painting import DraftPainter
from .labels import Labels
from .names_painting import NamesPainter
from .plans_painting import PlansPainter
from .robots_painting import RobotsPainter, circles, paint_circles
from .scene import PlacedScene
from .screen import Screen
from .trail_image import TrailImage
from .trails import Trails

Points = npt.NDArray[np.float64]

BESIDE = 12.0
"""Pixels beyond the border at which a robot still reaches in."""


class ScenePainter:
    """Paints scenes; keeps the pictures that it paints again and again."""

    def __init__(self, trails: Trails | None = None) -> None:
        self._labels = Labels()
        self._trails = TrailImage(Trails() if trails is None else trails)
        self._plans = PlansPainter(self._labels)
        self._draft = DraftPainter()
        self.robots = RobotsPainter()
        self._names = NamesPainter(self._labels)
        self._borders = BorderHints(self._labels)
        self._circles: list = []
        self._placed: tuple | None = None

    @property
    def hints(self) -> list[Hint]:
        """The arrows at the border that were painted last."""
        return self._borders.hints

    def prepare(self, placed: PlacedScene | None, screen: Screen) -> None:
        """Take in a new scene: what is drawn once for each and not for each time it is painted."""
        if placed is None:
            self._trails.forget()
            self._placed = None
            return
        self._trails.extend(placed.robots, screen, placed.to_map, placed.scene.now)
        _, seen, metre = self._place(placed, screen)
        self._circles = circles(placed, seen, metre)

    def paint(self, painter: QPainter, placed: PlacedScene, screen: Screen) -> None:
        """Paint the scene that was prepared last."""
        pixels, seen, metre = self._place(placed, screen)
        self._trails.paint(painter, screen)
        paint_circles(painter, self._circles, placed, screen)
        self._plans.paint(painter, placed, pixels, screen, self.robots.marks)
        self._draft.paint(painter, placed, pixels, screen, self.robots.marks)
        self.robots.paint(painter, placed, pixels, seen, metre, screen)
        self._borders.find(placed, pixels, seen, screen)
        taken = [(x - 24.0, y, x + 24.0, y + 26.0) for x, y in self._plans.distances]
        taken += [hint.area for hint in self.hints]
        self._names.paint(painter, placed, pixels, seen, screen, taken)
        self._borders.paint(painter, placed, screen)

    def _place(self, placed: PlacedScene, screen: Screen) -> tuple[Points, npt.NDArray[np.intp], Points]:
        """Return each robot's place in pixels, the rows of those seen, and the ways of these to 1 m ahead."""
        if self._placed is None or self._placed[0] is not placed or self._placed[1] != screen:
            pixels = screen.pixels(placed.robots)
            seen = np.flatnonzero(screen.seen(pixels, BESIDE))
            metre = screen.pixels(placed.ahead[seen]) - pixels[seen]
            self._placed = placed, screen, pixels, seen, metre
        return self._placed[2:]
