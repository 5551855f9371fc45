"""Where on the screen a route can be taken hold of."""

from __future__ import annotations

import numpy as np
from qgis.core import QgsPointXY
from qgis.gui import QgsVertexMarker
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
        places = self._desk.placement().to_map(np.array([draft.points[k] for k in which]))
        screen = self._desk.canvas.getCoordinateTransform()
        at = (screen.transform(QgsPointXY(x, y)) for x, y in places.tolist())
        return np.array([(point.x(), point.y()) for point in at])


def middle(draft: Draft, vertex: int) -> tuple[float, float]:
    """Return the middle of the leg that ends in a vertex which is not the first point."""
    (ax, ay), (bx, by) = draft.points[vertex - 1 : vertex + 1]
    return (ax + bx) / 2, (ay + by) / 2
