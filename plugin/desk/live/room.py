"""Where on the screen there is room for a text."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from .labels import HEIGHT
from .screen import Screen

Points = npt.NDArray[np.float64]
Widths = npt.NDArray[np.float64]
Cells = npt.NDArray[np.intp]
GRID = 6.0
"""Pixels of a cell that is taken or free as a whole."""
LINES = int(HEIGHT // GRID) + 1
"""Lines of cells that a text lies on, wherever it begins."""


class Room:
    """What of the screen is taken, by (n, 2) ``robots`` in pixels and by texts.

    ``texts`` are left, top, right and bottom of those that are there already.
    """

    def __init__(
        self, screen: Screen, robots: Points, texts: Sequence[tuple[float, float, float, float]] = ()
    ) -> None:
        self._lines, self._columns = int(screen.height // GRID) + LINES, int(screen.width // GRID) + 2
        self._robots = self._counted(robots)
        self._taken = [0] * self._lines
        """For each line the cells, a bit each, where no other text may lie that begins on it."""
        for left, top, right, bottom in texts:
            cells = _bits(max(0, int(left // GRID)), max(0, int(right // GRID) + 1))
            self._cover(int(top // GRID), int(bottom // GRID) + 1, cells)

    def without_robots(self, corner: Points, width: Widths) -> npt.NDArray[np.bool_]:
        """Tell which texts, (n, 2) left upper ``corner`` and ``width`` in pixels, cover no robot."""
        line, left, right = self._cells(corner, width)
        begin = line * (self._columns + 1)
        return self._robots.take(begin + right) == self._robots.take(begin + left)

    def take(self, corner: Points, width: Widths) -> list[int]:
        """Take one place after the other unless a text has a part of it; return the indices of those."""
        found = []
        cells = zip(*(edge.tolist() for edge in self._cells(corner, width)), strict=True)
        for index, (line, left, right) in enumerate(cells):
            wanted = _bits(left, right)
            if not self._taken[line] & wanted:
                self._cover(line, line + LINES, wanted)
                found.append(index)
        return found

    def _cover(self, top: int, bottom: int, cells: int) -> None:
        """Let no text lie on ``cells`` of the lines from ``top`` to before ``bottom``."""
        for line in range(max(0, top - LINES + 1), min(self._lines, bottom)):
            self._taken[line] |= cells

    def _counted(self, robots: Points) -> Cells:
        """Return for each line, and the :data:`LINES` from it on, the robots left of each cell and in all
        lines before: where that differs between two cells, a robot is between them."""
        stride = self._columns + 1
        # What is beyond the screen goes to lines and columns that no text lies on.
        line = np.clip(np.floor(robots[:, 1] * (1.0 / GRID)), -1, self._lines) + 1
        column = np.clip(np.floor(robots[:, 0] * (1.0 / GRID)), -1, self._columns - 1) + 1
        cells = (line * stride + column).astype(np.intp)
        count = np.bincount(cells, minlength=(self._lines + 2) * stride).reshape(-1, stride)[1:-1]
        below = sum(count[k : len(count) - LINES + 1 + k] for k in range(LINES))
        return below.cumsum()

    def _cells(self, corner: Points, width: Widths) -> tuple[Cells, Cells, Cells]:
        """Return the first line, the left cell, and the one just right of each text."""
        x, y = corner[:, 0], corner[:, 1]
        edges = (y, self._lines - LINES), (x, self._columns), (x + width + GRID, self._columns)
        # numpy takes ten times as long for //.
        line, left, right = (
            np.clip(np.floor(edge * (1.0 / GRID)), 0, most).astype(np.intp) for edge, most in edges
        )
        return line, left, right


def _bits(left: int, right: int) -> int:
    """Return a number with a bit for each cell from ``left`` to before ``right``."""
    return (1 << right) - (1 << left)
