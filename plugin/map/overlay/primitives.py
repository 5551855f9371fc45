"""Primitives of the overlay: strokes, and sprites out of atlases, painted many at once."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import numpy.typing as npt
from qgis.PyQt import sip
from qgis.PyQt.QtCore import QByteArray, QDataStream, QLineF, QPointF, Qt
from qgis.PyQt.QtGui import QBrush, QColor, QImage, QPainter, QPainterPath, QPen, QPixmap, QPolygonF

from ....robot_bridge.core.messages.safety import RobotState
from ...ui.glyphs import CASING, CELL, PAPER, SELECTED, draw_arrow, draw_cone, draw_robot, painting, pen

Points = npt.NDArray[np.float64]


def polygon(pixels: Points) -> QPolygonF:
    """Return (n, 2) pixels as Qt's points."""
    made = QPolygonF()
    if len(pixels) == 0:
        return made
    made.fill(QPointF(), len(pixels))
    data = made.data()
    data.setsize(len(pixels) * 16)
    data.setwriteable(True)
    np.frombuffer(data, dtype=np.float64).reshape(-1, 2)[:] = pixels
    return made


_ELEMENT = np.dtype([("kind", ">i4"), ("x", ">f8"), ("y", ">f8")])
"""An element of a path as QDataStream holds it: 0 moves, 1 draws a line."""


def segments(start: Points, end: Points) -> QPainterPath:
    """Return the lines from (n, 2) ``start`` to ``end`` pixels as one path; an object for each is slow."""
    elements = np.zeros(2 * len(start), dtype=_ELEMENT)
    elements["kind"][1::2] = 1
    for name, axis in (("x", 0), ("y", 1)):
        elements[name][0::2], elements[name][1::2] = start[:, axis], end[:, axis]
    count = np.array([len(elements)], dtype=">i4")
    # After the elements: where the last line began, and by which rule it would be filled.
    last = np.array([len(elements) - 2, 0], dtype=">i4")
    data = QByteArray(count.tobytes() + elements.tobytes() + last.tobytes())
    path = QPainterPath()
    QDataStream(data) >> path
    return path


def lines(start: Points, end: Points) -> list[QLineF]:
    """Return the lines from (n, 2) ``start`` to ``end`` pixels, each by itself."""
    return [QLineF(*ends) for ends in np.hstack([start, end]).tolist()]


def flat(stroke: QPen) -> QPen:
    """Return ``stroke`` without the round ends, for which Qt takes fifty times as long.

    They also do not reach beyond the line's: where what shines through meets, it would overlap.
    """
    stroke.setCapStyle(Qt.PenCapStyle.FlatCap)
    return stroke


def route(painter: QPainter, pixels: Points, colour: QColor) -> None:
    """Draw a way that ends in a ring."""
    painter.setBrush(QBrush(Qt.BrushStyle.NoBrush))
    legs = _legs(pixels)
    line = pen(colour, 2.8)
    # So that there are no gaps where it turns.
    line.setCapStyle(Qt.PenCapStyle.SquareCap)
    for stroke in (flat(pen(CASING, 5.6)), line):
        painter.setPen(stroke)
        painter.drawLines(legs)
    for point in pixels[-1:]:
        ring(painter, point, 5.0, colour)


def dashes(painter: QPainter, pixels: Points, colour: QColor, style: Qt.PenStyle) -> None:
    """Draw a broken line."""
    broken(painter, _legs(pixels), colour, style)


def broken(painter: QPainter, legs: list[QLineF], colour: QColor, style: Qt.PenStyle) -> None:
    """Draw broken lines."""
    painter.setPen(flat(pen(CASING, 3.4, 0.5)))
    painter.drawLines(legs)
    stroke = flat(pen(colour, 1.8))
    stroke.setStyle(style)
    painter.setPen(stroke)
    painter.drawLines(legs)


def ring(painter: QPainter, at: Points, radius: float, colour: QColor) -> None:
    """Draw a circle around ``at``, (2,) pixels."""
    painter.setBrush(QBrush(Qt.BrushStyle.NoBrush))
    for stroke in (pen(CASING, 4.6), pen(colour, 2.2)):
        painter.setPen(stroke)
        painter.drawEllipse(QPointF(*at), radius, radius)


def _legs(pixels: Points) -> list[QLineF]:
    """Return a way leg by leg: as one line, sixty legs that cross each other take Qt a third of a second."""
    return lines(pixels[:-1], pixels[1:])


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
    with painting(image) as painter:
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        painter.translate(side / 2, side / 2)
        painter.scale(scale, scale)
        painter.rotate(degrees)
        draw(painter)
    bits = image.constBits()
    bits.setsize(image.sizeInBytes())
    return np.frombuffer(bits, dtype=np.uint32).reshape(side, side).copy()


def in_a_column(cells: Cells) -> QPixmap:
    """Return (n, side, side) pixels as one picture, from the top down: each cell's are together in memory."""
    count, side, _ = cells.shape
    column = np.ascontiguousarray(cells)
    # A picture of its own: the image only looks at the array.
    return QPixmap.fromImage(QImage(column.data, side, count * side, side * 4, FORMAT).copy())


HEADINGS = 88
"""Directions that robots are drawn in; between them nobody sees a difference."""
MARK_SIZE = 1.5625
ARROW_SIZE = 0.95
"""Of marks and of arrows, in cells."""
ARROW_TURNS = 40
"""Directions that the arrows at the border point in."""
RING, OTHER_RING, TARGET, CONE_TARGET = range(4)
_MARKS = ((18.0, SELECTED, 3.0), (16.0, SELECTED, 1.6), (4.0, PAPER, 2.2), (4.0, PAPER, 2.2))
"""Radius, colour and width of each mark's circle."""


def cell(pixel_ratio: float, size: float = 1.0) -> int:
    """Return the device pixels along a side of the square that a robot of ``size`` fits in."""
    return round(CELL * size * pixel_ratio)


def robot_atlas(pixel_ratio: float, size: float, state: RobotState) -> QPixmap:
    """Return a robot in ``state`` in a column of cells of :func:`cell` device pixels.

    In cell k it points k / :data:`HEADINGS` of a turn clockwise from +x; in the last one its heading is not
    known. ``size`` 1 is the drawing as it is.
    """
    side = cell(pixel_ratio, size)
    scale = side / CELL
    pointing = turned(lambda painter: draw_robot(painter, state, True), side, scale, HEADINGS)
    unknown = drawn(lambda painter: draw_robot(painter, state, False), side, scale)
    return in_a_column(np.concatenate([pointing, unknown[None]]))


def arrow_atlas(pixel_ratio: float, state: RobotState, is_chosen: bool) -> QPixmap:
    """Return the arrow at the map's border to a robot in ``state``, turned as in :func:`robot_atlas`."""
    side = cell(pixel_ratio, ARROW_SIZE)
    rim = SELECTED if is_chosen else PAPER
    return in_a_column(
        turned(lambda painter: draw_arrow(painter, state, rim), side, pixel_ratio, ARROW_TURNS)
    )


def mark_atlas(pixel_ratio: float, size: float = 1.0) -> QPixmap:
    """Return the marks, a cell each: the ring of the selected robot that commands go to, that of others
    selected with it, a target, and a cone target, both with their spot in the middle."""
    side = cell(pixel_ratio, MARK_SIZE * size)
    scale = side / (CELL * MARK_SIZE)
    return in_a_column(np.stack([drawn(_mark(mark), side, scale) for mark in range(len(_MARKS))]))


def _mark(mark: int) -> Draw:
    radius, colour, width = _MARKS[mark]

    def draw(painter: QPainter) -> None:
        painter.setBrush(Qt.BrushStyle.NoBrush)
        for stroke in (pen(CASING, width + 2.4), pen(colour, width)):
            painter.setPen(stroke)
            painter.drawEllipse(QPointF(0.0, 0.0), radius, radius)
        if mark == CONE_TARGET:
            draw_cone(painter, QPointF(0.0, 0.0))

    return draw


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
