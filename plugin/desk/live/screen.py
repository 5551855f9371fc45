"""The way from the map's coordinates to pixels, for many points at once."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
import numpy.typing as npt
from qgis.gui import QgsMapCanvas, QgsMapCanvasItem
from qgis.PyQt.QtGui import QTransform

Points = npt.NDArray[np.float64]


@dataclass(frozen=True)
class Screen:
    """What of the map is seen, and how: two are equal when they show the same.

    ``centre`` is in map coordinates; ``at`` is its place in logical pixels; ``right`` and ``up`` are the
    pixels that one map unit along x and along y makes. ``width`` and ``height`` are logical pixels,
    ``ratio`` device pixels for each.
    """

    centre: tuple[float, float]
    at: tuple[float, float]
    right: tuple[float, float]
    up: tuple[float, float]
    width: int
    height: int
    ratio: float = 1.0

    def pixels(self, xy: Points) -> Points:
        """Return (n, 2) map coordinates as (n, 2) logical pixels."""
        pixels = self.ways(xy)
        # Column by column: numpy is slow where it goes along rows of two.
        pixels[:, 0] += self._shift[0]
        pixels[:, 1] += self._shift[1]
        return pixels

    def ways(self, xy: Points) -> Points:
        """Return (n, 2) ways in map units as ways in logical pixels."""
        return xy @ self._axes

    def seen(self, pixels: Points, margin: float) -> npt.NDArray[np.bool_]:
        """Tell which of (n, 2) ``pixels`` are on the screen, or no farther than ``margin`` off it."""
        x, y = pixels[:, 0], pixels[:, 1]
        return (x > -margin) & (x < self.width + margin) & (y > -margin) & (y < self.height + margin)

    def since(self, earlier: Screen) -> QTransform:
        """Return what takes pixels of ``earlier`` to those of this screen, both without rounding."""
        # Not by numpy's solver: on a busy machine that takes milliseconds now and then, in a frame.
        (rx, ry), (ux, uy) = earlier.right, earlier.up
        scale = 1.0 / (rx * uy - ry * ux)
        to_map = QTransform(uy * scale, -ry * scale, -ux * scale, rx * scale, 0.0, 0.0)
        turned = to_map * QTransform(*self.right, *self.up, 0.0, 0.0)
        was_x, was_y = turned.map(*earlier.at)
        (x, y), *_ = self.pixels(np.array([earlier.centre])).tolist()
        return turned * QTransform.fromTranslate(x - was_x, y - was_y)

    @cached_property
    def _axes(self) -> Points:
        return np.array([self.right, self.up])

    @cached_property
    def _shift(self) -> tuple[float, float]:
        """The pixels of the map's (0, 0)."""
        (cx, cy), (rx, ry), (ux, uy) = self.centre, self.right, self.up
        return self.at[0] - cx * rx - cy * ux, self.at[1] - cx * ry - cy * uy


def screen_of(canvas: QgsMapCanvas, item: QgsMapCanvasItem, ratio: float) -> Screen:
    """Return the screen that ``canvas`` is now, panning and rotation included."""
    centre = canvas.center()
    at = item.toCanvasCoordinates(centre)
    axes = canvas.getCoordinateTransform().transform()
    seen = canvas.viewport().size()
    return Screen(
        (centre.x(), centre.y()),
        (at.x(), at.y()),
        (axes.m11(), axes.m12()),
        (axes.m21(), axes.m22()),
        seen.width(),
        seen.height(),
        ratio,
    )
