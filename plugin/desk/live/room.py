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

    def cells(self, corner: Points, width: Widths) -> Cells:
        """Return (3, n) the first line, the left cell, and the one just right of the texts that have so much
        ``width`` and begin at the left upper ``corner``, (n, 2), all in pixels.
        """
        x, y = corner[:, 0], corner[:, 1]
        found = np.empty((3, len(corner)), dtype=np.intp)
        edges = (y, self._lines - LINES), (x, self._columns), (x + width + GRID, self._columns)
        for cell, (edge, most) in zip(found, edges, strict=True):
            # numpy takes ten times as long for //.
            cell[:] = np.minimum(np.maximum(np.floor(edge * (1.0 / GRID)), 0), most)
        return found

    def without_robots(self, cells: Cells) -> npt.NDArray[np.bool_]:
        """Tell which texts, as :meth:`cells` has them, cover no robot."""
        line, left, right = cells
        stride = self._lines + 2
        return self._robots.take(right * stride + line) == self._robots.take(left * stride + line)

    def take(self, cells: Cells) -> list[int]:
        """Take one place after the other unless a text has a part of it; return the indices of those."""
        found = []
        for index, (line, left, right) in enumerate(cells.T.tolist()):
            wanted = _bits(left, right)
            if not self._taken[line] & wanted:
                self._cover(line, line + LINES, wanted)
                found.append(index)
        return found

    def _cover(self, top: int, bottom: int, cells: int) -> None:
        """Let no text lie on ``cells`` of the lines from ``top`` to before ``bottom``."""
        for line in range(max(0, top - LINES + 1), min(self._lines, bottom)):
            self._taken[line] |= cells

    def _counted(self, robots: Points) -> npt.NDArray[np.int32]:
        """Return for each cell in how many of those left of it a text that begins on its line covers a robot:
        where that differs between two cells, a robot is between them.
        """
        # What is beyond the screen goes to lines and columns that no text lies on.
        line = np.minimum(np.maximum(np.floor(robots[:, 1] * (1.0 / GRID)), -1), self._lines) + 1
        column = np.minimum(np.maximum(np.floor(robots[:, 0] * (1.0 / GRID)), -1), self._columns - 1) + 1
        # Line beside line in memory: numpy sums up rows faster than along them.
        shape = self._columns + 1, self._lines + 2
        stands = np.zeros(shape[0] * shape[1] + LINES, dtype=np.uint8)
        stands[(column * shape[1] + line).astype(np.intp)] = 1
        below = stands[1 : 1 - LINES].copy()
        for down in range(1, LINES):
            below |= stands[1 + down : len(below) + 1 + down]
        return below.reshape(shape).cumsum(axis=0, dtype=np.int32)


def _bits(left: int, right: int) -> int:
    """Return a number with a bit for each cell from ``left`` to before ``right``."""
    return (1 << right) - (1 << left)
