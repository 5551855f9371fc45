"""Lines and rings that can be seen on any ground: a colour on a dark casing."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
from qgis.PyQt.QtCore import QByteArray, QDataStream, QLineF, QPointF, Qt
from qgis.PyQt.QtGui import QBrush, QColor, QPainter, QPainterPath, QPen, QPolygonF

from ..colours import CASING
from ..pens import pen

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
