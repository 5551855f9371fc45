"""Where on the screen there is room for a text."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from .screen import Screen

Points = npt.NDArray[np.float64]
GRID = 6.0
"""Pixels of a cell that is taken or free as a whole."""


class Room:
    """What of the screen is taken, by (n, 2) ``robots`` in pixels and by texts.

    ``texts`` are left, top, right and bottom of those that are there already.
    """

    def __init__(
        self, screen: Screen, robots: Points, texts: Sequence[tuple[float, float, float, float]] = ()
    ) -> None:
        self._shape = int(screen.height // GRID) + 2, int(screen.width // GRID) + 2
        self._texts = np.zeros(self._shape, dtype=bool)
        x, y = np.floor(robots / GRID).astype(np.intp).T
        rows, columns = self._shape
        inside = (x >= 0) & (y >= 0) & (x < columns) & (y < rows)
        cells = (y[inside] + 1) * (columns + 1) + x[inside] + 1
        count = np.bincount(cells, minlength=(rows + 1) * (columns + 1)).reshape(rows + 1, columns + 1)
        self._robots = count.cumsum(axis=0).cumsum(axis=1)
        for left, top, right, bottom in texts:
            columns = slice(max(0, int(left // GRID)), max(0, int(right // GRID) + 1))
            self._texts[max(0, int(top // GRID)) : max(0, int(bottom // GRID) + 1), columns] = True

    def without_robots(
        self, corner: Points, width: npt.NDArray[np.float64], height: float
    ) -> npt.NDArray[np.bool_]:
        """Tell which rectangles at (n, 2) left upper ``corner`` cover no robot."""
        left, top, right, bottom = self._cells(corner, width, height)
        sums = self._robots
        return sums[bottom, right] - sums[top, right] - sums[bottom, left] + sums[top, left] == 0

    def take(self, corner: Points, width: npt.NDArray[np.float64], height: float) -> list[int]:
        """Take one rectangle after the other unless a text has a part of it; return the indices of those."""
        taken = []
        cells = np.column_stack(self._cells(corner, width, height)).tolist()
        for index, (left, top, right, bottom) in enumerate(cells):
            place = self._texts[top:bottom, left:right]
            if not place.any():
                place[:] = True
                taken.append(index)
        return taken

    def _cells(
        self, corner: Points, width: npt.NDArray[np.float64], height: float
    ) -> list[npt.NDArray[np.intp]]:
        """Return left, top, right and bottom cells, the latter two just outside."""
        rows, columns = self._shape
        x, y = corner.T
        edges = (x, columns), (y, rows), (x + width + GRID, columns), (y + height + GRID, rows)
        # numpy takes ten times as long for //.
        return [np.clip(np.floor(edge * (1.0 / GRID)).astype(np.intp), 0, most) for edge, most in edges]
