"""Paints what the operator is about to send."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
from qgis.PyQt.QtCore import QPointF, Qt
from qgis.PyQt.QtGui import QColor, QPainter

from ..colours import PAPER, REFUSED, ROUTE
from ..drafts import CONE, START, TARGETS
from ..glyphs import draw_cone
from .scene import PlacedScene
from .screen import Screen
from .strokes import dashes, ring, route

Points = npt.NDArray[np.float64]


def paint_draft(painter: QPainter, placed: PlacedScene, robots: Points, screen: Screen) -> None:
    """Paint the draft and the next leg to the mouse; ``robots`` (n, 2) is where each robot is, in pixels."""
    draft = placed.scene.draft
    if draft is None:
        return
    points, cursor = screen.pixels(placed.draft), screen.pixels(placed.cursor)
    is_wrong = bool(draft.findings.faults) and draft.override is None
    colour = REFUSED if is_wrong else PAPER
    row = placed.scene.rows.get(draft.robot)
    start = robots[[row]] if row is not None and np.isfinite(robots[row]).all() else np.empty((0, 2))
    if draft.kind in (CONE, TARGETS):
        dashes(painter, np.concatenate([start, points]), colour, Qt.PenStyle.DashLine)
        painter.setOpacity(0.85)
        for point in points:
            ring(painter, point, 12.0, colour)
            draw_cone(painter, QPointF(*point), 26.0)
        painter.setOpacity(1.0)
        return
    if draft.kind == START:
        _paint_start(painter, points, colour)
        return
    dashes(painter, np.concatenate([start, points[:1]]), colour, Qt.PenStyle.DotLine)
    route(painter, points, colour if is_wrong else ROUTE)
    dashes(painter, np.concatenate([points[-1:], cursor]), colour, Qt.PenStyle.DashLine)
    for point in points:
        ring(painter, point, 3.5, colour)


def _paint_start(painter: QPainter, points: Points, colour: QColor) -> None:
    """Paint a start position, the first of ``points``; the second is in its heading, if it has one."""
    place, ahead = points[0], points[1:]
    for radius in (12.0, 3.0):
        ring(painter, place, radius, colour)
    length = float(np.hypot(*(ahead - place).T)[0]) if len(ahead) else 0.0
    if length > 0.0:
        tip = place + (ahead - place) / length * 34.0
        dashes(painter, np.concatenate([place[None], tip]), colour, Qt.PenStyle.SolidLine)
