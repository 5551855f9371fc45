"""The trails on the canvas, whichever way the view moves."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import numpy.typing as npt
from qgis.PyQt.QtCore import QPointF
from qgis.PyQt.QtGui import QPainter

from .screen import Screen
from .trail_sheet import TrailSheet
from .trails import Trails

Points = npt.NDArray[np.float64]


class TrailImage:
    """Shows a sheet of trails, moved along with the view, until one for the new view is filled."""

    def __init__(self, trails: Trails) -> None:
        self._trails = trails
        self.forget()

    def forget(self) -> None:
        """Draw nothing until the next :meth:`extend`."""
        self._shown: TrailSheet | None = None
        self._newest: TrailSheet | None = None
        self._view: tuple = ()
        self._made_for: tuple = ()

    def extend(self, xy: Points, screen: Screen, to_map: Callable[[Points], Points], now: float) -> None:
        """Draw on to (n, 2) ``xy``, where the robots are now in map coordinates, NaN where not known.

        ``now`` is on the clock of the trails' samples.
        """
        view = (self._trails.generation, to_map, screen)
        if view[:2] != self._made_for[:2]:
            self.forget()
        # While the view moves a new sheet would be out of date before it is filled.
        at_rest = view == self._view or self._newest is None
        self._view = view
        if view != self._made_for and at_rest:
            self._newest = TrailSheet(self._trails, screen, to_map, now)
            self._made_for = view
        self._newest.extend(xy, now)
        if self._newest.filled or self._shown is None:
            self._shown = self._newest

    def paint(self, painter: QPainter, screen: Screen) -> None:
        """Draw the trails as far as they are known on ``screen``."""
        if self._shown is None:
            return
        painter.save()
        if screen != self._shown.screen:
            painter.setTransform(screen.since(self._shown.screen), True)
        # The image is one of device pixels; to tell it so would make it a copy of the array.
        painter.scale(1 / self._shown.screen.ratio, 1 / self._shown.screen.ratio)
        painter.drawImage(QPointF(0.0, 0.0), self._shown.image)
        painter.restore()
