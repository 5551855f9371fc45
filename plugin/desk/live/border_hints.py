"""Points, at the border of the map, to the robots beyond it."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from qgis.PyQt.QtCore import QPointF
from qgis.PyQt.QtGui import QPainter

from ..glyphs import ARROW_SIZE, ARROW_TURNS, arrow_atlas, cell
from .labels import Labels
from .scene import PlacedScene
from .screen import Screen
from .sprites import Sprites

Points = npt.NDArray[np.float64]
Rows = npt.NDArray[np.intp]

MARGIN = 14.0
APART = 56.0
"""Pixels of the border that share one arrow."""
FIND_EVERY = 0.25
"""Seconds for which the arrows and their numbers stay as they are unless the view moves."""
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
        # A single robot has its name there, several their number.
        inward, wide = (48.0, 44.0) if len(self.rows) == 1 else (24.0, 16.0)
        x, y = self.x - inward * math.cos(self.turn), self.y - inward * math.sin(self.turn)
        return min(x, self.x) - wide, min(y, self.y) - 14.0, max(x, self.x) + wide, max(y, self.y) + 14.0


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


class BorderHints:
    """Finds the arrows a few times a second, and paints them from an atlas."""

    def __init__(self, labels: Labels) -> None:
        self._labels = labels
        self._arrows: tuple[float, Sprites] | None = None
        self._found_for: tuple[Screen, list[str]] | None = None
        self._found_at = -np.inf
        self.hints: list[Hint] = []

    def find(self, placed: PlacedScene, pixels: Points, seen: Rows, screen: Screen) -> None:
        """Find the arrows for robots that are not in rows ``seen``, unless that was done just now."""
        now, names = placed.scene.now, placed.scene.robots.names
        is_new = self._found_for is None or self._found_for[0] != screen or self._found_for[1] != names
        if not is_new and abs(now - self._found_at) < FIND_EVERY:
            return
        self._found_for, self._found_at = (screen, names), now
        beyond = np.isfinite(pixels[:, 0])
        beyond[seen] = False
        self.hints = hints(pixels, np.flatnonzero(beyond), screen)

    def paint(self, painter: QPainter, placed: PlacedScene, screen: Screen) -> None:
        """Paint each arrow in its robots' colour, with their name or number."""
        if not self.hints:
            return
        if self._arrows is None or self._arrows[0] != screen.ratio:
            side = cell(screen.ratio, ARROW_SIZE)
            self._arrows = screen.ratio, Sprites(arrow_atlas(screen.ratio), side, screen.ratio)
        robots = placed.scene.robots
        chosen = {placed.scene.rows[name] for name in placed.scene.chosen if name in placed.scene.rows}
        rank = _URGENT[robots.state]
        states = np.array([robots.state[hint.rows[rank[hint.rows].argmax()]] for hint in self.hints])
        is_chosen = [bool(chosen) and not chosen.isdisjoint(hint.rows.tolist()) for hint in self.hints]
        turns = np.array([hint.turn for hint in self.hints]) / (2 * np.pi)
        column = np.round(turns * ARROW_TURNS).astype(np.intp) % ARROW_TURNS
        at = np.array([(hint.x, hint.y) for hint in self.hints])
        self._arrows[1].paint(painter, at, column, states * 2 + np.array(is_chosen, dtype=np.intp))
        for hint in self.hints:
            text = robots.names[hint.rows[0]] if len(hint.rows) == 1 else str(len(hint.rows))
            _beside(painter, self._labels, text, hint, screen)


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
