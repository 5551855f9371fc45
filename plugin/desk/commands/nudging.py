"""Points moved by the arrow keys."""

from __future__ import annotations

import math

import numpy as np
from qgis.core import QgsPointXY
from qgis.PyQt.QtCore import Qt
from qgis.PyQt.QtGui import QKeyEvent

from ..desk import Desk
from ..drafts import Point

FINE_M, COARSE_M = 0.1, 1.0
"""Metres a key press, with Ctrl, and with Ctrl and Shift."""
_ASIDE = {Qt.Key.Key_Left: (-1, 0), Qt.Key.Key_Right: (1, 0), Qt.Key.Key_Up: (0, -1), Qt.Key.Key_Down: (0, 1)}
_PIXELS = 50


def is_nudge(event: QKeyEvent) -> bool:
    """Tell whether it is Ctrl with an arrow key."""
    return event.key() in _ASIDE and bool(event.modifiers() & Qt.KeyboardModifier.ControlModifier)


def nudged(event: QKeyEvent, desk: Desk, point: Point) -> Point:
    """Return where ``point`` of the site frame goes by Ctrl and an arrow key.

    Left is left on the screen, however map and site frame are turned.

    :raises PlacementError: when the point has no place on the map.
    """
    aside = _ASIDE[event.key()]
    coarse = event.modifiers() & Qt.KeyboardModifier.ShiftModifier
    placement, screen = desk.placement(), desk.canvas.getCoordinateTransform()
    ((x, y),) = placement.to_map(np.array([point]))
    pixel = screen.transform(QgsPointXY(x, y))
    beside = placement.to_site(
        screen.toMapCoordinatesF(pixel.x() + aside[0] * _PIXELS, pixel.y() + aside[1] * _PIXELS)
    )
    dx, dy = beside[0] - point[0], beside[1] - point[1]
    step = (COARSE_M if coarse else FINE_M) / math.hypot(dx, dy)
    return point[0] + dx * step, point[1] + dy * step
