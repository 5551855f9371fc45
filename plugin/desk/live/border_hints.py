"""Points, at the border of the map, to the robots beyond it."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from qgis.PyQt.QtCore import QPointF
from qgis.PyQt.QtGui import QBrush, QPainter, QPolygonF

from ..colours import CASING, PAPER, SELECTED, STATE_COLOURS
from ..picture import STATES
from .labels import Labels
from .scene import PlacedScene
from .screen import Screen
from .strokes import pen

Points = npt.NDArray[np.float64]
Rows = npt.NDArray[np.intp]

MARGIN = 14.0
APART = 56.0
"""Pixels of the border that share one arrow."""
_URGENT = np.array([1, 2, 3, 0])
"""The rank of each of STATES: an arrow for several robots has the colour of the one to worry about."""


@dataclass(frozen=True)
class Hint:
    """One arrow: where, which way it points (radians clockwise from +x), and the rows it stands for."""

    x: float
    y: float
    turn: float
    rows: Rows

    @property
    def area(self) -> tuple[float, float, float, float]:
        """About what the arrow and its text cover: left, top, right, bottom."""
        x, y = self.x - 24.0 * math.cos(self.turn), self.y - 24.0 * math.sin(self.turn)
        return min(x, self.x) - 16.0, min(y, self.y) - 14.0, max(x, self.x) + 16.0, max(y, self.y) + 14.0


def hints(pixels: Points, beyond: Rows, screen: Screen) -> list[Hint]:
    """Return the arrows for the robots in rows ``beyond``; ``pixels`` (n, 2) is where each robot is."""
    if len(beyond) == 0:
        return []
    middle = np.array([screen.width, screen.height]) / 2.0
    way = pixels[beyond] - middle
    reach = (middle - MARGIN) / np.maximum(np.abs(way), 1e-9)
    at = middle + way * reach.min(axis=1)[:, None]
    slots, of = np.unique(np.round(at / APART).astype(np.intp), axis=0, return_inverse=True)
    order = np.argsort(of, kind="stable")
    groups = np.split(order, np.cumsum(np.bincount(of, minlength=len(slots)))[:-1])
    found = []
    for group in groups:
        (x, y), (dx, dy) = at[group].mean(axis=0), way[group].mean(axis=0)
        found.append(Hint(float(x), float(y), float(np.arctan2(dy, dx)), beyond[group]))
    return found


def paint_hints(
    painter: QPainter, found: list[Hint], placed: PlacedScene, labels: Labels, screen: Screen
) -> None:
    """Paint each arrow in its robots' colour, with their name or number."""
    robots = placed.scene.robots
    chosen = {placed.scene.rows[name] for name in placed.scene.chosen if name in placed.scene.rows}
    for hint in found:
        state = max(robots.state[hint.rows].tolist(), key=_URGENT.__getitem__)
        edge = SELECTED if chosen.intersection(hint.rows.tolist()) else PAPER
        painter.save()
        painter.translate(hint.x, hint.y)
        painter.rotate(np.degrees(hint.turn))
        arrow = QPolygonF([QPointF(11, 0), QPointF(-6, 9), QPointF(-2, 0), QPointF(-6, -9)])
        painter.setBrush(QBrush(STATE_COLOURS[STATES[state]]))
        for stroke in (pen(CASING, 4.4), pen(edge, 2.0)):
            painter.setPen(stroke)
            painter.drawPolygon(arrow)
        painter.restore()
        text = robots.names[hint.rows[0]] if len(hint.rows) == 1 else str(len(hint.rows))
        _beside(painter, labels, text, hint, screen)


def _beside(painter: QPainter, labels: Labels, text: str, hint: Hint, screen: Screen) -> None:
    """Draw ``text`` on the inner side of the arrow, whole."""
    picture = labels.picture(text, screen.ratio)
    width, height = picture.width() / screen.ratio, picture.height() / screen.ratio
    inward = 8.0 + np.hypot(width, height) / 2
    x = hint.x - np.cos(hint.turn) * inward - width / 2
    y = hint.y - np.sin(hint.turn) * inward - height / 2
    x = min(max(x, 0.0), screen.width - width)
    y = min(max(y, 0.0), screen.height - height)
    painter.drawPixmap(QPointF(x, y), picture)
