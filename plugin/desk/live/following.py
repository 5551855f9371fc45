"""Keeps robots in view."""

from __future__ import annotations

import math
from enum import Enum

import numpy as np
import numpy.typing as npt
from qgis.core import QgsPointXY, QgsRectangle
from qgis.gui import QgsMapCanvas

from .screen import Screen

Points = npt.NDArray[np.float64]

INSIDE = 0.5
"""The part of the view, about its middle, in which a robot moves before the view moves."""
INSIDE_ALL = 0.96
"""The same where several are followed, who need their room."""
AROUND = 1.25
"""How much more than the robots is shown when the view has to grow."""


class Whom(Enum):
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
