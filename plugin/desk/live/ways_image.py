"""The ways of all plans on the canvas, whichever way the view moves."""

from __future__ import annotations

import time

from qgis.PyQt.QtCore import QPointF
from qgis.PyQt.QtGui import QPainter, QPen

from ..colours import ROUTE
from .scene import PlacedScene
from .screen import Screen
from .screen_image import screen_image
from .strokes import polygon, route

MANY = 60
"""With more plans ways are thin and targets small, and only selected robots have lines and distances."""
FILL_SECONDS = 0.003
"""What painting ways may take of one frame."""


class WaysImage:
    """Shows a sheet of ways, moved along with the view, until the next one is filled.

    Of a thousand robots some have new ways in every frame, and to paint all of them takes several frames. So
    each sheet is filled to its end, and shows what was so when it was begun.
    """

    def __init__(self) -> None:
        self.forget()

    def forget(self) -> None:
        """Show nothing until the next :meth:`prepare`."""
        self._shown: _WaysSheet | None = None
        self._next: _WaysSheet | None = None
        self.is_whole = True
        """Whether nothing is left to be painted by more frames."""

    def prepare(self, placed: PlacedScene, screen: Screen) -> None:
        """Paint some more of the ways into what is shown of them on ``screen``."""
        if self._next is not None and self._next.to_map != placed.to_map:
            self.forget()
        if self._next is None or (self._next.is_full and not self._next.is_of(placed, screen)):
            self._next = _WaysSheet(placed, screen)
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


class _WaysSheet:
    """The ways of ``placed`` as ``screen`` shows them; made empty and filled bit by bit."""

    def __init__(self, placed: PlacedScene, screen: Screen) -> None:
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

    def is_of(self, placed: PlacedScene, screen: Screen) -> bool:
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
