"""A drawing that points to all sides: an eighth of them is drawn, the others are its mirror images."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import numpy.typing as npt
from qgis.PyQt.QtGui import QImage, QPainter, QPixmap

Cells = npt.NDArray[np.uint32]
Draw = Callable[[QPainter], None]

FORMAT = QImage.Format.Format_ARGB32_Premultiplied


def turned(draw: Draw, side: int, scale: float, turns: int) -> Cells:
    """Return (``turns``, side, side) pixels: in cell k the drawing points k / ``turns`` of a turn clockwise
    from +x.

    ``draw`` draws around (0, 0), pointing along +x, and the same on both sides of that axis; ``scale`` device
    pixels make one of its own. ``turns`` is a multiple of eight.
    """
    quarter, half = turns // 4, turns // 2
    cells = np.empty((turns, side, side), dtype=np.uint32)
    for k in range(turns // 8 + 1):
        cells[k] = drawn(draw, side, scale, k * 360.0 / turns)
        cells[quarter - k] = cells[k].T
    for k in range(quarter + 1):
        cells[half - k] = cells[k][:, ::-1]
    for k in range(1, half):
        cells[turns - k] = cells[k][::-1]
    return cells


def drawn(draw: Draw, side: int, scale: float, degrees: float = 0.0) -> Cells:
    """Return (side, side) pixels with the drawing around their middle, turned clockwise."""
    image = QImage(side, side, FORMAT)
    image.fill(0)
    painter = QPainter(image)
    painter.setRenderHint(QPainter.RenderHint.Antialiasing)
    painter.translate(side / 2, side / 2)
    painter.scale(scale, scale)
    painter.rotate(degrees)
    draw(painter)
    painter.end()
    bits = image.constBits()
    bits.setsize(image.sizeInBytes())
    return np.frombuffer(bits, dtype=np.uint32).reshape(side, side).copy()


def in_a_column(cells: Cells) -> QPixmap:
    """Return (n, side, side) pixels as one picture, from the top down: each cell's are together in memory."""
    count, side, _ = cells.shape
    column = np.ascontiguousarray(cells)
    # A picture of its own: the image only looks at the array.
    return QPixmap.fromImage(QImage(column.data, side, count * side, side * 4, FORMAT).copy())
