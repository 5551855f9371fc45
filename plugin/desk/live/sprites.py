"""Many copies of a few pictures, painted in one call."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
from qgis.PyQt import sip
from qgis.PyQt.QtGui import QPainter, QPixmap

FIELDS = 10
"""x, y, source left, top, width, height, scale x, scale y, rotation, opacity: Qt's PixmapFragment."""


class Sprites:
    """A column of cells, ``side`` device pixels wide and high, ``ratio`` device pixels a logical one."""

    def __init__(self, atlas: QPixmap, side: int, ratio: float) -> None:
        self._atlas = atlas
        self._side = side
        self._ratio = ratio
        self._fragments = None
        self._table = np.empty((0, FIELDS))
        self._painted = 0

    def paint(
        self,
        painter: QPainter,
        centre: npt.NDArray[np.float64],
        cell: npt.NDArray[np.intp] | int,
    ) -> None:
        """Paint ``cell`` around each ``centre``, (n, 2) logical pixels."""
        count = len(centre)
        if count == 0:
            return
        self._provide(count)
        table, side = self._table, self._side
        # A whole device pixel keeps the drawing sharp.
        at = centre * self._ratio
        at -= side / 2
        np.rint(at, out=at)
        at += side / 2
        at /= self._ratio
        table[:count, 0:2] = at
        table[:count, 3] = cell * side
        # What was painted before and is no more must not show: a size of nothing hides it.
        table[count : self._painted, 4:6] = 0.0
        table[self._painted : count, 4:6] = side
        self._painted = count
        painter.drawPixmapFragments(self._fragments, self._atlas)

    def _provide(self, count: int) -> None:
        if count <= len(self._table) <= max(64, 4 * count):
            return
        size = max(16, count + count // 4)
        self._fragments = sip.array(QPainter.PixmapFragment, size)
        raw = sip.voidptr(self._fragments, size * FIELDS * 8, True)
        self._table = np.frombuffer(raw, dtype=np.float64).reshape(size, FIELDS)
        self._table[:] = 0.0
        self._table[:, 6:8] = 1.0 / self._ratio
        self._table[:, 9] = 1.0
        self._painted = 0
