"""The way from the map's coordinates to pixels, for many points at once."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
import numpy.typing as npt
from qgis.core import QgsPointXY
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
        # Spelled out: numpy is three times as slow at a product of such narrow matrices.
        dx, dy = xy[:, 0] - self.centre[0], xy[:, 1] - self.centre[1]
        x = dx * self.right[0] + dy * self.up[0] + self.at[0]
        return np.column_stack([x, dx * self.right[1] + dy * self.up[1] + self.at[1]])

    def seen(self, pixels: Points, margin: float) -> npt.NDArray[np.bool_]:
        """Tell which of (n, 2) ``pixels`` are on the screen, or no farther than ``margin`` off it."""
        x, y = pixels[:, 0], pixels[:, 1]
        return (x > -margin) & (x < self.width + margin) & (y > -margin) & (y < self.height + margin)

    def since(self, earlier: Screen) -> QTransform:
        """Return what takes pixels of ``earlier`` to those of this screen, both without rounding."""
        linear = np.linalg.solve(earlier._axes, self._axes)
        shift = self.pixels(np.array([earlier.centre]))[0] - np.array(earlier.at) @ linear
        return QTransform(*linear[0].tolist(), *linear[1].tolist(), *shift.tolist())

    @cached_property
    def _axes(self) -> Points:
        return np.array([self.right, self.up])


def screen_of(canvas: QgsMapCanvas, item: QgsMapCanvasItem, ratio: float) -> Screen:
    """Return the screen that ``canvas`` is now, panning and rotation included."""
    centre = canvas.center()
    unit = canvas.mapUnitsPerPixel() * 1000.0
    at = item.toCanvasCoordinates(centre)
    right = item.toCanvasCoordinates(QgsPointXY(centre.x() + unit, centre.y())) - at
    up = item.toCanvasCoordinates(QgsPointXY(centre.x(), centre.y() + unit)) - at
    return Screen(
        (centre.x(), centre.y()),
        (at.x(), at.y()),
        (right.x() / unit, right.y() / unit),
        (up.x() / unit, up.y() / unit),
        canvas.viewport().width(),
        canvas.viewport().height(),
        ratio,
    )
