"""Paints a scene, from the ground up: trails, ways, targets, draft, robots, names, the border."""

from __future__ import annotations

from qgis.PyQt.QtGui import QPainter

from .border_hints import BorderHints, Hint
from .draft_painting import DraftPainter
from .in_view import InView, in_view
from .labels import Labels
from .names_painting import NamesPainter
from .plans_painting import PlansPainter
from .robots_painting import RobotsPainter, circles, paint_circles
from .scene import PlacedScene
from .screen import Screen
from .trail_image import TrailImage
from .trails import Trails


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
        self._viewed: tuple[PlacedScene, Screen, InView] | None = None

    @property
    def hints(self) -> list[Hint]:
        """The arrows at the border that were painted last."""
        return self._borders.hints

    @property
    def is_whole(self) -> bool:
        """Whether nothing is left to be painted by more frames."""
        return self._plans.is_whole

    def prepare(self, placed: PlacedScene | None, screen: Screen) -> None:
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

    def paint(self, painter: QPainter, placed: PlacedScene, screen: Screen) -> None:
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

    def _view(self, placed: PlacedScene, screen: Screen) -> InView:
        """Return what of the robots is on ``screen``, reckoned once for each scene and screen."""
        if self._viewed is None or self._viewed[0] is not placed or self._viewed[1] != screen:
            self._viewed = placed, screen, in_view(placed, screen)
        return self._viewed[2]
