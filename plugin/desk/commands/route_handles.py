"""Where on the screen a route can be taken hold of."""

from __future__ import annotations

from itertools import chain

import numpy as np
from qgis.core import QgsPointXY
from qgis.gui import QgsMapCanvas, QgsVertexMarker
from qgis.PyQt import sip
from qgis.PyQt.QtCore import QPoint
from qgis.PyQt.QtGui import QColor

from ..desk import Desk
from ..drafting.route_editing import vertices
from ..drafts import Draft

REACH = 9.0
"""Pixels by which the mouse may miss a vertex or a leg."""
MARK = QColor("#FFE14D")


class RouteHandles:
    """Finds vertices and legs near the mouse, and marks the vertex in hand."""

    def __init__(self, desk: Desk):
        self._desk = desk
        self._marker: QgsVertexMarker | None = None
        # Which points were placed on the map last, how, the points themselves, and where they are.
        self._placed: tuple = (None, None, (), np.empty((0, 2)))

    def vertex_at(self, draft: Draft, mouse: QPoint) -> int | None:
        """Return the vertex nearest to the mouse, None where none is near.

        :raises PlacementError: when the route has no place on the map.
        """
        found = vertices(draft)
        if not found:
            return None
        away = np.hypot(*(self._pixels(draft, found) - (mouse.x(), mouse.y())).T)
        nearest = int(np.argmin(away))
        return found[nearest] if away[nearest] <= REACH else None

    def leg_at(self, draft: Draft, mouse: QPoint) -> int | None:
        """Return the end of the straight leg that the mouse is on, None where there is none."""
        ends = [end for end in vertices(draft) if end > 0]
        if not ends:
            return None
        a, b = self._pixels(draft, [end - 1 for end in ends]), self._pixels(draft, ends)
        step, from_a = b - a, np.array([mouse.x(), mouse.y()]) - a
        square = np.maximum((step * step).sum(axis=1), 1e-9)
        share = np.clip((from_a * step).sum(axis=1) / square, 0.0, 1.0)
        away = np.hypot(*(from_a - share[:, None] * step).T)
        nearest = int(np.argmin(away))
        return ends[nearest] if away[nearest] <= REACH else None

    def mark(self, draft: Draft | None, vertex: int | None) -> None:
        """Mark a vertex, None for none."""
        if self._marker is not None and not sip.isdeleted(self._marker):
            self._desk.canvas.scene().removeItem(self._marker)
        self._marker = None
        if draft is None or vertex is None:
            return
        ((x, y),) = self._desk.placement().to_map(np.array([draft.points[vertex]]))
        self._marker = QgsVertexMarker(self._desk.canvas)
        self._marker.setCenter(QgsPointXY(x, y))
        self._marker.setIconType(QgsVertexMarker.IconType.ICON_BOX)
        self._marker.setIconSize(14)
        self._marker.setPenWidth(3)
        self._marker.setColor(MARK)

    def _pixels(self, draft: Draft, which: list[int]) -> np.ndarray:
        placement = self._desk.placement()
        if self._placed[:2] != (id(draft.points), placement):
            flat = np.fromiter(chain.from_iterable(draft.points), np.float64).reshape(-1, 2)
            self._placed = id(draft.points), placement, draft.points, placement.to_map(flat)
        return _on_screen(self._placed[3][which], self._desk.canvas)


def _on_screen(places: np.ndarray, canvas: QgsMapCanvas) -> np.ndarray:
    """Return (n, 2) map coordinates as pixels, together: a route may have thousands of points."""
    screen, centre = canvas.getCoordinateTransform(), canvas.center()
    unit = canvas.mapUnitsPerPixel() * 1000.0
    at = screen.transform(centre)
    right = screen.transform(QgsPointXY(centre.x() + unit, centre.y()))
    up = screen.transform(QgsPointXY(centre.x(), centre.y() + unit))
    axes = np.array([(right.x() - at.x(), right.y() - at.y()), (up.x() - at.x(), up.y() - at.y())]) / unit
    return (places - (centre.x(), centre.y())) @ axes + (at.x(), at.y())


def middle(draft: Draft, vertex: int) -> tuple[float, float]:
    """Return the middle of the leg that ends in a vertex which is not the first point."""
    (ax, ay), (bx, by) = draft.points[vertex - 1 : vertex + 1]
    return (ax + bx) / 2, (ay + by) / 2
