"""Paints what the operator is about to send."""

from __future__ import annotations

from collections.abc import Callable
from itertools import accumulate

import numpy as np
import numpy.typing as npt
from qgis.PyQt.QtCore import QPointF, Qt
from qgis.PyQt.QtGui import QColor, QImage, QPainter, QPen

from ..colours import PAPER, REFUSED, ROUTE
from ..drafts import CONE, START, TARGETS, Draft, WayKind
from ..glyphs import draw_cone
from .atlases import CONE_TARGET
from .scene import PlacedScene
from .screen import Screen
from .screen_image import screen_image
from .sprites import Sprites
from .strokes import dashes, polygon, ring, route

Points = npt.NDArray[np.float64]
Marks = Callable[[float, float], Sprites]
MANY = 60
"""With more points targets are small and the line is painted once into an image; more clicks get no rings."""
SMALL = 0.5
MANY_LEGS, FAR_PX = 2000, 10000.0
"""With more legs, or a longer way on the screen, a route is thin: in full width it would take over 10 ms."""


class DraftPainter:
    """Keeps an image of a large draft: to stroke a thousand legs anew for each frame takes seconds."""

    def __init__(self) -> None:
        self._image: QImage | None = None
        self._made_for: tuple = ()

    def paint(
        self, painter: QPainter, placed: PlacedScene, robots: Points, screen: Screen, marks: Marks
    ) -> None:
        """Paint the draft and the next leg to the mouse; ``robots`` (n, 2) is where each robot is, in pixels.

        ``marks`` gives the marks of a pixel ratio and a size.
        """
        draft = placed.scene.draft
        if draft is None:
            self._image, self._made_for = None, ()
            return
        is_wrong = bool(draft.findings.faults) and draft.override is None
        colour = REFUSED if is_wrong else PAPER
        points, cursor = screen.pixels(placed.draft), screen.pixels(placed.cursor)
        if draft.kind == START:
            _paint_start(painter, points, colour)
            return
        start = _robot_of(draft, placed, robots)
        if draft.way.is_along_roads:
            self._paint_way(painter, placed, points, screen, colour if is_wrong else ROUTE)
            _paint_targets(painter, points[-1:], colour)
            return
        targets = draft.kind in (CONE, TARGETS)
        first = Qt.PenStyle.DashLine if targets else Qt.PenStyle.DotLine
        dashes(painter, np.concatenate([start, points[:1]]), colour, first)
        if targets and len(points) > MANY:
            self._paint_many(painter, placed.draft, points, screen, colour, marks)
        elif targets:
            _paint_targets(painter, points, colour)
        else:
            self._paint_way(painter, placed, points, screen, colour if is_wrong else ROUTE)
        if not targets:
            _paint_clicks(painter, points, draft, colour)
            dashes(painter, np.concatenate([points[-1:], cursor]), colour, Qt.PenStyle.DashLine)

    def _paint_way(
        self, painter: QPainter, placed: PlacedScene, points: Points, screen: Screen, colour: QColor
    ) -> None:
        if len(points) > MANY:
            self._paint_many(painter, placed.draft, points, screen, colour, None)
        else:
            route(painter, points, colour)

    def _paint_many(
        self,
        painter: QPainter,
        on_map: Points,
        points: Points,
        screen: Screen,
        colour: QColor,
        marks: Marks | None,
    ) -> None:
        made_for = (on_map, screen, colour.rgba(), marks is None)
        if not self._made_for or self._made_for[0] is not on_map or self._made_for[1:] != made_for[1:]:
            self._image, self._made_for = _drawn(points, screen, colour, marks), made_for
        painter.drawImage(QPointF(0.0, 0.0), self._image)


def _drawn(points: Points, screen: Screen, colour: QColor, marks: Marks | None) -> QImage:
    def paint(painter: QPainter) -> None:
        if marks is None and _is_cheap(points, screen):
            painter.setRenderHint(QPainter.RenderHint.Antialiasing)
            route(painter, points, colour)
            return
        painter.setPen(QPen(colour, 0.0))
        painter.drawPolyline(polygon(points))
        if marks is not None:
            seen = points[screen.seen(points, 30.0)]
            marks(screen.ratio, SMALL).paint(painter, seen, CONE_TARGET)

    return screen_image(screen, paint)


def _is_cheap(points: Points, screen: Screen) -> bool:
    """Tell whether a route through (n, 2) pixels is painted soon: what is off the screen costs nothing."""
    low, high = np.minimum(points[:-1], points[1:]), np.maximum(points[:-1], points[1:])
    seen = (high > 0.0).all(axis=1) & (low < (screen.width, screen.height)).all(axis=1)
    length = np.hypot(*(high - low)[seen].T).sum()
    return len(points) <= MANY_LEGS and float(length) <= FAR_PX


def _robot_of(draft: Draft, placed: PlacedScene, robots: Points) -> Points:
    """Return where the draft's robot is, (1, 2) pixels; (0, 2) where that is not known.

    Nor while the way to a target is sought: a straight line would be taken for it.
    """
    row = placed.scene.rows.get(draft.robot)
    if row is None or draft.way.kind is WayKind.SOUGHT or not np.isfinite(robots[row]).all():
        return np.empty((0, 2))
    return robots[[row]]


def _paint_targets(painter: QPainter, points: Points, colour: QColor) -> None:
    dashes(painter, points, colour, Qt.PenStyle.DashLine)
    painter.setOpacity(0.85)
    for point in points:
        ring(painter, point, 12.0, colour)
        draw_cone(painter, QPointF(*point), 26.0)
    painter.setOpacity(1.0)


def _paint_clicks(painter: QPainter, points: Points, draft: Draft, colour: QColor) -> None:
    """Paint a ring at each click of a route; a way along the roads has hundreds of points between two."""
    if len(draft.legs) > MANY:
        return
    for end in accumulate(draft.legs):
        ring(painter, points[end - 1], 3.5, colour)


def _paint_start(painter: QPainter, points: Points, colour: QColor) -> None:
    """Paint a start position, the first of ``points``; the second is in its heading, if it has one."""
    place, ahead = points[0], points[1:]
    for radius in (12.0, 3.0):
        ring(painter, place, radius, colour)
    length = float(np.hypot(*(ahead - place).T)[0]) if len(ahead) else 0.0
    if length > 0.0:
        tip = place + (ahead - place) / length * 34.0
        dashes(painter, np.concatenate([place[None], tip]), colour, Qt.PenStyle.SolidLine)
