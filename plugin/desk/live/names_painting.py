"""Paints robots' names, as many as there is room for, and what is to be known of those that are silent."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt
from qgis.PyQt.QtCore import QPointF
from qgis.PyQt.QtGui import QPainter, QPixmap

from ....robot_bridge.messages import RobotState
from ...language import tr
from ..picture import STATES, RobotArrays
from ..state_words import ROBOT_STATES
from .in_view import InView
from .labels import HEIGHT, MARGIN, Labels, age_in_words
from .room import Room
from .scene import PlacedScene
from .screen import Screen

Points = npt.NDArray[np.float64]
Rows = npt.NDArray[np.intp]

CHOOSE_EVERY = 0.25
"""Seconds for which the same robots keep their texts, so that names do not come and go as robots pass."""
NEW_IN_A_FRAME = 8
"""Pictures of names are made by so many a frame: a map full of new ones must not hold up the window."""
BESIDE = (15.0, -12.0)
"""Where a text begins, its middle, as seen from the robot."""
LETTER = 8.0
"""About what a letter is wide."""
SPOT = (36.0, 16.0)
"""Pixels within which one text is tried."""
SPOTS = 10_000
"""More than any screen has from top to bottom."""
STATE_LETTERS = 14.0
"""Letters that a robot's state and age take at most, but for hours and days."""
_URGENT = np.array([5, 3, 1, 7], dtype=np.int8)
"""The rank of each of STATES: the lost before the stale before the fresh before those that are off, each with
one before it for those that had their texts shown already. Small numbers: numpy sorts them faster."""


class NamesPainter:
    """Chooses which robots have their names shown, and paints them."""

    def __init__(self, labels: Labels) -> None:
        self._labels = labels
        self._named: Rows = np.empty(0, dtype=np.intp)
        self._written: list[list[str]] = []
        self._widths = np.empty(0)
        self._pieces: list[tuple[int, float, float, QPixmap]] = []
        """Of the k-th of the written: how far along and how far down which picture stands."""
        self._waiting: list[int] = []
        self._chosen_at = -np.inf
        self._screen: Screen | None = None
        self._names: list[str] = []
        self._lengths = np.empty(0)
        """Of each of the names."""

    def paint(
        self,
        painter: QPainter,
        placed: PlacedScene,
        view: InView,
        screen: Screen,
        taken: Sequence[tuple[float, float, float, float]] = (),
    ) -> None:
        """Paint names of those in view.

        ``taken`` are left, top, right and bottom of what has texts already.
        """
        robots = placed.scene.robots
        now = placed.scene.now
        if abs(now - self._chosen_at) >= CHOOSE_EVERY or screen != self._screen or self._are_others(robots):
            self._named = self._chosen(placed, view, screen, taken)
            self._chosen_at, self._screen = now, screen
            self._written = [texts(robots, row) for row in self._named.tolist()]
            self._widths = np.array([_width(parts) for parts in self._written])
            self._wait_for_pictures(screen.ratio)
        self._make_pictures(screen.ratio)
        corners = _corners(view.pixels.take(self._named, axis=0), self._widths, screen).tolist()
        for k, along, down, picture in self._pieces:
            x, y = corners[k]
            painter.drawPixmap(QPointF(x + along, y + down), picture)

    def _wait_for_pictures(self, ratio: float) -> None:
        """Have at once what is written wherever its pictures are there already."""
        self._pieces, self._waiting = [], []
        for k, parts in enumerate(self._written):
            if all(self._labels.known(text, ratio) for text in parts):
                self._put(k, ratio)
            else:
                self._waiting.append(k)

    def _make_pictures(self, ratio: float) -> None:
        """Make some of the pictures that are waited for; the others come with the next frames."""
        new = NEW_IN_A_FRAME
        while self._waiting and new > 0:
            k = self._waiting.pop(0)
            new -= sum(not self._labels.known(text, ratio) for text in self._written[k])
            self._put(k, ratio)

    def _put(self, k: int, ratio: float) -> None:
        """Have what is written beside the k-th robot painted, its parts one after the other."""
        along = 0.0
        for text in self._written[k]:
            picture = self._labels.picture(text, ratio)
            self._pieces.append((k, along, (HEIGHT - picture.height() / ratio) / 2, picture))
            along += picture.width() / ratio - 2 * MARGIN + 4

    def _are_others(self, robots: RobotArrays) -> bool:
        """Tell whether another robot stands in the row of one that was chosen."""
        if robots.names is self._names:
            return False
        rows = self._named.tolist()
        if rows and max(rows) >= len(robots.names):
            return True
        return any(robots.names[row] != parts[0] for row, parts in zip(rows, self._written, strict=True))

    def _chosen(
        self,
        placed: PlacedScene,
        view: InView,
        screen: Screen,
        taken: Sequence[tuple[float, float, float, float]] = (),
    ) -> Rows:
        """Return the rows whose texts do not cover another's text or robot, the most urgent first."""
        robots, scene, seen = placed.scene.robots, placed.scene, view.rows
        rank = _URGENT.take(robots.state)
        rank[self._named[self._named < len(rank)]] -= 1
        rank[[scene.rows[name] for name in scene.chosen if name in scene.rows]] = -1
        rank = rank.take(seen)
        if robots.names is not self._names and robots.names != self._names:
            self._lengths = np.fromiter(map(len, robots.names), np.float64, len(robots.names))
        self._names = robots.names
        more = np.where(robots.state.take(seen) > 0, STATE_LETTERS + 1.0, 1.0)
        width = LETTER * (self._lengths.take(seen) + more)
        corner = _corners(view.there, width, screen)
        room = Room(screen, view.there, taken)
        # Texts that urge may cover a robot; the others stand where there is none.
        cells = room.cells(corner, width)
        possible = np.flatnonzero((rank < 4) | room.without_robots(cells))
        order = possible[np.argsort(rank[possible], kind="stable")]
        order = order[_first_of_each_spot(corner.take(order, axis=0))]
        return seen[order[room.take(cells.take(order, axis=1))]]


def texts(robots: RobotArrays, row: int) -> list[str]:
    """Return the texts beside a robot: its name; and its state and its last message's age unless fresh."""
    state = STATES[robots.state[row]]
    if state is RobotState.FRESH:
        return [robots.names[row]]
    if state is RobotState.OFFLINE:
        return [robots.names[row], tr("· offline")]
    return [robots.names[row], f"· {ROBOT_STATES[state]} {age_in_words(robots.age[row])}"]


def _width(written: list[str]) -> float:
    return LETTER * sum(len(text) + 1 for text in written)


def _corners(pixels: Points, width: npt.NDArray[np.float64], screen: Screen) -> Points:
    """Return the left upper corners of texts beside robots at (n, 2) ``pixels``: where they are whole."""
    right = pixels[:, 0] + BESIDE[0]
    top = pixels[:, 1] + (BESIDE[1] - HEIGHT / 2)
    corners = np.empty_like(pixels)
    corners[:, 0] = np.where(right + width <= screen.width, right, pixels[:, 0] - BESIDE[0] - width)
    corners[:, 1] = np.minimum(np.maximum(top, 0.0), screen.height - HEIGHT)
    return corners


def _first_of_each_spot(corner: Points) -> Rows:
    """Return the indices of texts that begin where none before them does, to try no spot twice."""
    across, down = np.floor(corner[:, 0] * (1.0 / SPOT[0])), np.floor(corner[:, 1] * (1.0 / SPOT[1]))
    _, first = np.unique(across * SPOTS + down, return_index=True)
    return np.sort(first)
