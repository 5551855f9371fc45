"""Paints a scene, from the ground up: trails, routes, targets, draft, robots, names."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import numpy.typing as npt
from qgis.PyQt.QtCore import QPointF, Qt
from qgis.PyQt.QtGui import QBrush, QColor, QPainter, QPen, QPolygonF

from ...robot_bridge.messages import RobotState
from .colours import CASING, PAPER, REFUSED, ROUTE, SELECTED, TRAIL
from .drafts import CONE as CONE_DRAFT
from .glyphs import CELL, draw_cone, robot_atlas
from .labels import Labels
from .picture import STATES
from .scene import PlacedScene
from .sprites import Sprites
from .trails import LONGEST as TRAIL_SECONDS
from .trails import MANY

Points = npt.NDArray[np.float64]
ToPixels = Callable[[Points], Points]
FADES = 6
APART = 4.0
"""Pixels between the points of a trail that are painted."""


class ScenePainter:
    """Paints scenes; keeps the pictures that it paints again and again."""

    def __init__(self) -> None:
        self._sprites = Sprites()
        self._labels = Labels()
        self._atlas = None
        self._ratio = 0.0

    def paint(self, painter: QPainter, placed: PlacedScene, to_pixels: ToPixels, ratio: float) -> None:
        """Paint ``placed``; ``to_pixels`` takes (n, 2) map coordinates to logical pixels."""
        robots = to_pixels(placed.robots)
        self._trails(painter, placed, to_pixels)
        for path in placed.paths:
            _route(painter, to_pixels(path), ROUTE)
        self._targets(painter, placed, robots, to_pixels(placed.targets))
        _draft(painter, placed, robots, to_pixels(placed.draft), to_pixels(placed.cursor))
        self._robots(painter, placed, robots, to_pixels(placed.ahead), ratio)
        self._names(painter, placed, robots, ratio)

    def _trails(self, painter: QPainter, placed: PlacedScene, to_pixels: ToPixels) -> None:
        if len(placed.trails) > MANY:
            # One pixel wide, which costs Qt a tenth of a wider line.
            painter.setPen(_flat_pen(TRAIL, 1.0))
            for points in placed.trails:
                painter.drawPolyline(_polygon(to_pixels(points)))
            return
        for trail, points in zip(placed.scene.trails, placed.trails, strict=True):
            _faded_trail(painter, *_thinned(to_pixels(points), trail[:, 2]))

    def _targets(self, painter: QPainter, placed: PlacedScene, robots: Points, targets: Points) -> None:
        names = placed.scene.robots.names
        for target, at in zip(placed.scene.targets, targets, strict=True):
            if target.robot in names:
                start = robots[names.index(target.robot)]
                _dashes(painter, np.array([start, at]), PAPER, Qt.PenStyle.DotLine)
            _ring(painter, at, 4.0, PAPER)
            if target.cone:
                draw_cone(painter, QPointF(*at))

    def _robots(
        self, painter: QPainter, placed: PlacedScene, at: Points, ahead: Points, ratio: float
    ) -> None:
        robots = placed.scene.robots
        if placed.scene.selected in robots.names:
            _ring(painter, at[robots.names.index(placed.scene.selected)], 18.0, SELECTED)
        if self._atlas is None or ratio != self._ratio:
            self._atlas, self._ratio = robot_atlas(ratio), ratio
        known = np.isfinite(robots.theta)
        step = ahead - at
        angle = np.where(known, np.degrees(np.arctan2(step[:, 1], step[:, 0])), 0.0)
        row = np.where(known, 0, 1)
        painter.setRenderHint(QPainter.RenderHint.SmoothPixmapTransform)
        self._sprites.paint(painter, self._atlas, CELL, ratio, at, robots.state, row, angle)

    def _names(self, painter: QPainter, placed: PlacedScene, at: Points, ratio: float) -> None:
        robots = placed.scene.robots
        for name, state, age, (x, y) in zip(
            robots.names, robots.state, placed.scene.ages, at, strict=True
        ):
            label = self._labels.picture(_label(name, STATES[state], age), ratio)
            painter.drawPixmap(QPointF(x + 15, y - label.height() / ratio / 2 - 12), label)


def _label(name: str, state: RobotState, age: float) -> str:
    if state is RobotState.FRESH:
        return name
    return f"{name} · offline" if state is RobotState.OFFLINE else f"{name} · {state.value} {age:.0f} s"


def _draft(painter: QPainter, placed: PlacedScene, robots: Points, points: Points, cursor: Points) -> None:
    draft = placed.scene.draft
    if draft is None:
        return
    colour = REFUSED if draft.findings.refused else PAPER
    names = placed.scene.robots.names
    start = robots[[names.index(draft.robot)]] if draft.robot in names else np.empty((0, 2))
    if draft.kind == CONE_DRAFT:
        _dashes(painter, np.concatenate([start, points]), colour, Qt.PenStyle.DashLine)
        _ring(painter, points[0], 12.0, colour)
        painter.setOpacity(0.85)
        draw_cone(painter, QPointF(*points[0]), 26.0)
        painter.setOpacity(1.0)
        return
    _dashes(painter, np.concatenate([start, points[:1]]), colour, Qt.PenStyle.DotLine)
    _route(painter, points, colour if draft.findings.refused else ROUTE)
    _dashes(painter, np.concatenate([points[-1:], cursor]), colour, Qt.PenStyle.DashLine)
    for point in points:
        _ring(painter, point, 3.5, colour)


def _faded_trail(painter: QPainter, pixels: Points, age: npt.NDArray[np.float64]) -> None:
    """Draw a trail, oldest point first, in pieces that grow paler with age."""
    fade = np.clip((age / TRAIL_SECONDS * FADES).astype(int), 0, FADES - 1)
    begins = np.flatnonzero(np.diff(fade, prepend=-1))
    # Each piece has the next one's first point, so that they meet.
    for first, last in zip(begins, [*begins[1:], len(fade) - 1], strict=True):
        strength = 1.0 - fade[first] / FADES
        piece = _polygon(pixels[first : last + 1])
        painter.setPen(_flat_pen(CASING, 4.4, strength * 0.45))
        painter.drawPolyline(piece)
        painter.setPen(_flat_pen(TRAIL, 2.4, strength))
        painter.drawPolyline(piece)


def _thinned(pixels: Points, age: npt.NDArray[np.float64]) -> tuple[Points, npt.NDArray[np.float64]]:
    """Return the points that lie some pixels apart along the way, and the last."""
    if len(pixels) < 3:
        return pixels, age
    way = np.cumsum(np.hypot(*np.diff(pixels, axis=0, prepend=pixels[:1]).T)) // APART
    keep = np.flatnonzero(np.diff(way, prepend=-1.0))
    if keep[-1] != len(pixels) - 1:
        keep = np.append(keep, len(pixels) - 1)
    return pixels[keep], age[keep]


def _route(painter: QPainter, pixels: Points, colour: QColor) -> None:
    painter.setPen(_pen(CASING, 5.6))
    painter.drawPolyline(_polygon(pixels))
    painter.setPen(_pen(colour, 2.8))
    painter.drawPolyline(_polygon(pixels))
    for point in pixels[-1:]:
        _ring(painter, point, 5.0, colour)


def _dashes(painter: QPainter, pixels: Points, colour: QColor, style: Qt.PenStyle) -> None:
    if len(pixels) < 2:
        return
    painter.setPen(_pen(CASING, 3.4, 0.5))
    painter.drawPolyline(_polygon(pixels))
    pen = _pen(colour, 1.8)
    pen.setStyle(style)
    painter.setPen(pen)
    painter.drawPolyline(_polygon(pixels))


def _ring(painter: QPainter, at: Points, radius: float, colour: QColor) -> None:
    painter.setBrush(QBrush(Qt.BrushStyle.NoBrush))
    for pen in (_pen(CASING, 4.6), _pen(colour, 2.2)):
        painter.setPen(pen)
        painter.drawEllipse(QPointF(*at), radius, radius)


def _polygon(pixels: Points) -> QPolygonF:
    return QPolygonF([QPointF(x, y) for x, y in pixels.tolist()])


def _flat_pen(colour: QColor, width: float, strength: float = 1.0) -> QPen:
    """Return a pen for long lines of many points, without the round joins that take half of the time."""
    pen = _pen(colour, width, strength)
    pen.setCapStyle(Qt.PenCapStyle.FlatCap)
    pen.setJoinStyle(Qt.PenJoinStyle.BevelJoin)
    return pen


def _pen(colour: QColor, width: float, strength: float = 1.0) -> QPen:
    shade = QColor(colour)
    shade.setAlphaF(colour.alphaF() * strength)
    return QPen(shade, width, Qt.PenStyle.SolidLine, Qt.PenCapStyle.RoundCap, Qt.PenJoinStyle.RoundJoin)
