"""Many copies of a few pictures, painted in one call."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
from qgis.PyQt import sip
from qgis.PyQt.QtGui import QPainter, QPixmap

FIELDS = 10
"""x, y, source left, top, width, height, scale x, scale y, rotation, opacity: Qt's PixmapFragment."""


class Sprites:
    """A ``sip.array`` of pixmap fragments, written through numpy; grows and never shrinks."""

    def __init__(self) -> None:
        self._fragments = None
        self._table = np.empty((0, FIELDS))

    def paint(
        self,
        painter: QPainter,
        atlas: QPixmap,
        cell: float,
        pixel_ratio: float,
        centre: npt.NDArray[np.float64],
        column: npt.NDArray[np.intp],
        row: npt.NDArray[np.intp],
        rotation: npt.NDArray[np.float64],
    ) -> None:
        """Paint cell (``column``, ``row``) of ``atlas`` around each ``centre``.

        ``centre`` (n, 2) logical pixels, ``rotation`` (n,) degrees clockwise on the screen. ``atlas`` holds
        cells of ``cell`` logical pixels at ``pixel_ratio`` device pixels each.
        """
        count = len(centre)
        if count == 0:
            return
        self._provide(count)
        side = round(cell * pixel_ratio)
        table = self._table
        # What was painted before and is no more must not show: a size of nothing hides it.
        table[count:, 4:6] = 0.0
        table[:count, 0:2] = centre
        table[:count, 2] = column * side
        table[:count, 3] = row * side
        table[:count, 4:6] = side
        table[:count, 6:8] = cell / side
        table[:count, 8] = rotation
        table[:count, 9] = 1.0
        painter.drawPixmapFragments(self._fragments, atlas)

    def _provide(self, count: int) -> None:
        if count <= len(self._table):
            return
        size = max(16, 2 * count)
        self._fragments = sip.array(QPainter.PixmapFragment, size)
        raw = sip.voidptr(self._fragments, size * FIELDS * 8, True)
        self._table = np.frombuffer(raw, dtype=np.float64).reshape(size, FIELDS)
        self._table[:] = 0.0
