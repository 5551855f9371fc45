"""Screen: map coordinates to pixels, images kept for a screen, robots kept in view."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from enum import Enum
from functools import cached_property

import numpy as np
import numpy.typing as npt
from qgis.core import QgsPointXY, QgsRectangle
from qgis.gui import QgsMapCanvas, QgsMapCanvasItem
from qgis.PyQt.QtGui import QColor, QImage, QPainter, QTransform

# --- The way from the map's coordinates to pixels, for many points at once ---

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


# --- What changes seldom and takes long to paint: painted once for a screen, into an image that is kept


def screen_image(screen: Screen, paint: Callable[[QPainter], None]) -> QImage:
    """Return a clear image as large as ``screen`` with what ``paint`` paints there, in logical pixels."""
    width, height = round(screen.width * screen.ratio), round(screen.height * screen.ratio)
    image = QImage(width, height, QImage.Format.Format_ARGB32_Premultiplied)
    image.setDevicePixelRatio(screen.ratio)
    image.fill(QColor(0, 0, 0, 0))
    painter = QPainter(image)
    paint(painter)
    painter.end()
    return image


# --- Keeps robots in view ---

INSIDE = 0.5
"""The part of the view, about its middle, in which a robot moves before the view moves."""
INSIDE_ALL = 0.96
"""The same where several are followed, who need their room."""
AROUND = 1.25
"""How much more than the robots is shown when the view has to grow."""


class FollowMode(Enum):
    """Who is followed."""

    NOBODY = "nobody"
    SELECTED = "selected"
    ALL = "all"


def keep_in_view(canvas: QgsMapCanvas, screen: Screen, places: Points) -> bool:
    """Move the view where a robot leaves it, widen it where they do not all fit; tell whether it moved.

    ``places`` (n, 2) are map coordinates; ``screen`` is what ``canvas`` shows now.
    """
    places = places[np.isfinite(places).all(axis=1)]
    if len(places) == 0:
        return False
    pixels = screen.pixels(places)
    size = np.array([screen.width, screen.height])
    part = INSIDE if len(places) == 1 else INSIDE_ALL
    if (np.abs(pixels - size / 2) <= size / 2 * part).all():
        return False
    needed = (np.ptp(pixels, axis=0) / size).max() * AROUND
    if needed > 1.0:
        canvas.zoomByFactor(float(needed))
    middle, _ = _box(canvas, places)
    canvas.setCenter(QgsPointXY(*middle.tolist()))
    canvas.refresh()
    return True


def show_places(canvas: QgsMapCanvas, places: Points) -> None:
    """Show the smallest part of the map that has all of (n, 2) map coordinates, however it is rotated."""
    middle, half = _box(canvas, places)
    # QGIS takes an extent for that of the map before it is rotated about its middle.
    canvas.setExtent(QgsRectangle(*(middle - half).tolist(), *(middle + half).tolist()))
    canvas.refresh()


def _box(canvas: QgsMapCanvas, places: Points) -> tuple[Points, Points]:
    """Return the middle, (2,) map coordinates, of the box about ``places`` that is upright on the screen, and
    half its width and height in map units."""
    turn = math.radians(canvas.rotation())
    to_screen = np.array([[math.cos(turn), -math.sin(turn)], [math.sin(turn), math.cos(turn)]])
    seen = places @ to_screen
    low, high = seen.min(axis=0), seen.max(axis=0)
    return to_screen @ ((low + high) / 2), (high - low) / 2
