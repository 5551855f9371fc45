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
SPOT = np.array([36.0, 16.0])
STATE_LETTERS = 14.0
"""Letters that a robot's state and age take at most, but for hours and days."""
_URGENT = np.array([5, 3, 1, 5], dtype=np.int8)
"""The rank of each of STATES: the lost before the stale before all others, each with one before it for those
that had their texts shown already. Small numbers: numpy sorts them faster."""


class NamesPainter:
    """Chooses which robots have their names shown, and paints them."""

    def __init__(self, labels: Labels) -> None:
        self._labels = labels
        self._named: Rows = np.empty(0, dtype=np.intp)
        self._written: list[list[str]] = []
        self._widths = np.empty(0)
        self._pieces: list[tuple[int, float, QPixmap]] = []
        """Of the k-th of the written: how far along which picture stands."""
        self._waiting: list[int] = []
        self._chosen_at = -np.inf
        self._screen: Screen | None = None
        self._lengths = np.empty(0)

    def paint(
        self,
        painter: QPainter,
        placed: PlacedScene,
        pixels: Points,
        seen: Rows,
        screen: Screen,
        taken: Sequence[tuple[float, float, float, float]] = (),
    ) -> None:
        """Paint names of those in rows ``seen``; ``pixels`` (n, 2) is where each robot is.

        ``taken`` are left, top, right and bottom of what has texts already.
        """
        robots = placed.scene.robots
        now = placed.scene.now
        if abs(now - self._chosen_at) >= CHOOSE_EVERY or screen != self._screen or self._are_others(robots):
            self._named = self._chosen(placed, pixels, seen, screen, taken)
            self._chosen_at, self._screen = now, screen
            self._written = [texts(robots, row) for row in self._named.tolist()]
            self._widths = np.array([_width(parts) for parts in self._written])
            self._wait_for_pictures(screen.ratio)
        self._make_pictures(screen.ratio)
        corners = _corners(pixels[self._named], self._widths, screen).tolist()
        for k, along, picture in self._pieces:
            x, y = corners[k]
            top = y + (HEIGHT - picture.height() / screen.ratio) / 2
            painter.drawPixmap(QPointF(x + along, top), picture)

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
            self._pieces.append((k, along, picture))
            along += picture.width() / ratio - 2 * MARGIN + 4

    def _are_others(self, robots: RobotArrays) -> bool:
        """Tell whether another robot stands in the row of one that was chosen."""
        rows = self._named.tolist()
        if rows and max(rows) >= len(robots.names):
            return True
        return any(robots.names[row] != parts[0] for row, parts in zip(rows, self._written, strict=True))

    def _chosen(
        self,
        placed: PlacedScene,
        pixels: Points,
        seen: Rows,
        screen: Screen,
        taken: Sequence[tuple[float, float, float, float]] = (),
    ) -> Rows:
        """Return the rows whose texts do not cover another's text or robot, the most urgent first."""
        robots, scene = placed.scene.robots, placed.scene
        rank = _URGENT[robots.state]
        rank[self._named[self._named < len(rank)]] -= 1
        rank[[scene.rows[name] for name in scene.chosen if name in scene.rows]] = -1
        rank = rank[seen]
        if len(self._lengths) != len(robots.names) or self._are_others(robots):
            self._lengths = np.fromiter(map(len, robots.names), np.float64, len(robots.names))
        width = LETTER * (self._lengths[seen] + 1.0 + np.where(robots.state[seen] > 0, STATE_LETTERS, 0.0))
        corner = _corners(pixels[seen], width, screen)
        room = Room(screen, pixels[seen], taken)
        # Texts that urge may cover a robot; the others stand where there is none.
        possible = np.flatnonzero((rank < 4) | room.without_robots(corner, width, HEIGHT))
        order = possible[np.argsort(rank[possible], kind="stable")]
        order = order[_first_of_each_spot(corner[order])]
        return seen[order[room.take(corner[order], width[order], HEIGHT)]]


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
    x = np.where(right + width <= screen.width, right, pixels[:, 0] - BESIDE[0] - width)
    y = np.clip(pixels[:, 1] + BESIDE[1] - HEIGHT / 2, 0.0, screen.height - HEIGHT)
    return np.column_stack([x, y])


def _first_of_each_spot(corner: Points) -> Rows:
    """Return the indices of texts that begin where none before them does, to try no spot twice."""
    if len(corner) == 0:
        return np.empty(0, dtype=np.intp)
    across, down = np.floor(corner / SPOT).astype(np.intp).T
    spot = (across - across.min()) * (np.ptp(down) + 1) + down - down.min()
    first = np.full(spot.max() + 1, -1)
    # Of several values for one place numpy keeps the last, so they go there backwards.
    first[spot[::-1]] = np.arange(len(spot))[::-1]
    return np.sort(first[first >= 0])
