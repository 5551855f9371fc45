"""Colours, drawings of robots and cones, pens, and strokes of many points."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from functools import cached_property

import numpy as np
import numpy.typing as npt
from qgis.PyQt.QtCore import QByteArray, QDataStream, QLineF, QPointF, QRectF, Qt
from qgis.PyQt.QtGui import (
    QBrush,
    QColor,
    QIcon,
    QPaintDevice,
    QPainter,
    QPainterPath,
    QPalette,
    QPen,
    QPixmap,
    QPolygonF,
)
from qgis.PyQt.QtWidgets import QApplication

from ...robot_bridge.core.messages.commands import CommandState
from ...robot_bridge.core.messages.safety import RobotState

STATE_COLOURS = {
    RobotState.FRESH: QColor("#0072B2"),
    RobotState.STALE: QColor("#E69F00"),
    RobotState.LOST: QColor("#C62828"),
    RobotState.OFFLINE: QColor("#757575"),
}
"""Each state has its own shape as well (see :mod:`.glyphs`)."""

UNSURE_COLOUR = STATE_COLOURS[RobotState.STALE]
"""Colour of a fresh robot that may be elsewhere: as of a stale one, with a broken outline."""

STALE_LETTERS = QColor("#A15C00")

COMMAND_COLOURS = {
    CommandState.REACHED: QColor("#00795C"),
    CommandState.ABORTED: QColor("#C62828"),
    CommandState.FAILED: QColor("#C62828"),
    CommandState.EXPIRED: QColor("#A15C00"),
    CommandState.SUPERSEDED: QColor("#757575"),
}

CASING = QColor(20, 24, 28, 170)
PAPER = QColor(255, 255, 255)
TRAIL = QColor("#56C7FF")
ROUTE = QColor("#FFE14D")
CONE = QColor("#F26A1B")
SELECTED = QColor("#FFE14D")
REFUSED = QColor("#E53935")
WRONG = QColor("#C62828")
"""Text colour of errors."""
DOUBTFUL = QColor("#8A5A00")
"""Text colour of warnings."""
WRONG_STYLE = "color: #B71C1C; background: #FDECEA;"
DOUBTFUL_STYLE = "color: #6B4300; background: #FFF1D0;"
"""Labels with their own background: some themes of QGIS are of a grey on which no red is legible."""
DARK = 128
"""Lightness of a background below which text must be paler."""


def is_dark() -> bool:
    """Return whether lists have a dark background now."""
    return QApplication.palette().color(QPalette.ColorRole.Base).lightness() < DARK


def for_letters(colour: QColor) -> QColor:
    """Return a colour for text in a list: paler on a dark background, darker on a light one."""
    if is_dark():
        return colour.lighter(175)
    # As a spot on the map amber is clearly visible; as text on white it is not.
    return QColor(STALE_LETTERS) if colour == STATE_COLOURS[RobotState.STALE] else colour


@contextmanager
def painting(device: QPaintDevice) -> Iterator[QPainter]:
    """Yield a painter on ``device`` that is ended even if an error is raised.

    If a traceback keeps a painter that was not ended beyond its device, Qt ends the program.
    """
    painter = QPainter(device)
    try:
        yield painter
    finally:
        painter.end()


def pen(colour: QColor, width: float, strength: float = 1.0) -> QPen:
    """Return a pen with round ends, ``width`` pixels; ``strength`` is the opacity, 0 to 1."""
    shade = QColor(colour)
    shade.setAlphaF(colour.alphaF() * strength)
    return QPen(shade, width, Qt.PenStyle.SolidLine, Qt.PenCapStyle.RoundCap, Qt.PenJoinStyle.RoundJoin)


CELL = 32
"""Width and height of the square that holds a robot's drawing at any heading."""
BROKEN = [1.5, 1.1]
"""Dashes and gaps of an outline, in widths of its pen."""
ICON_SCALE = 2.04
"""Scale from a robot's drawing to an icon of 64 pixels for tables."""


def state_icon(state: RobotState, *, unsure: bool = False) -> QIcon:
    """Return the icon of a robot in ``state``, pointing up, for tables and legends."""
    pixmap = QPixmap(64, 64)
    pixmap.fill(QColor(0, 0, 0, 0))
    with painting(pixmap) as painter:
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        painter.translate(32, 32)
        painter.scale(ICON_SCALE, ICON_SCALE)
        painter.rotate(-90)
        draw_robot(painter, state, True, unsure=unsure)
    return QIcon(pixmap)


class StateIcons(dict[RobotState, QIcon]):
    """The icon of each state, drawn on first use; must be used in the thread of the window."""

    def __missing__(self, state: RobotState) -> QIcon:
        self[state] = state_icon(state)
        return self[state]

    @cached_property
    def unsure(self) -> QIcon:
        """The icon of a fresh robot that may be elsewhere."""
        return state_icon(RobotState.FRESH, unsure=True)


def draw_robot(painter: QPainter, state: RobotState, with_heading: bool, *, unsure: bool = False) -> None:
    """Draw a robot that points along +x: full when fresh, hollow when stale, crossed out when lost, and a
    box when offline; hollow with a broken outline when ``unsure``: it may be elsewhere."""
    colour = UNSURE_COLOUR if unsure else STATE_COLOURS[state]
    outline = _outline(state, with_heading)
    painter.setBrush(Qt.BrushStyle.NoBrush)
    painter.setPen(pen(CASING, 5.0))
    painter.drawPath(outline)
    hollow = unsure or state in (RobotState.STALE, RobotState.LOST)
    painter.setPen(pen(PAPER, 3.2))
    painter.drawPath(outline)
    painter.setBrush(QBrush(PAPER if hollow else colour))
    rim = pen(colour, 2.6 if hollow else 0.6)
    if unsure:
        rim.setCapStyle(Qt.PenCapStyle.FlatCap)
        rim.setDashPattern(BROKEN)
    painter.setPen(rim)
    painter.drawPath(outline)
    if state is RobotState.LOST:
        _cross(painter, colour)


def draw_arrow(painter: QPainter, state: RobotState, rim: QColor) -> None:
    """Draw the arrow at the map's border to a robot in ``state``: it points along +x."""
    arrow = QPolygonF([QPointF(11, 0), QPointF(-6, 9), QPointF(-2, 0), QPointF(-6, -9)])
    painter.setBrush(QBrush(STATE_COLOURS[state]))
    for stroke in (pen(CASING, 4.4), pen(rim, 2.0)):
        painter.setPen(stroke)
        painter.drawPolygon(arrow)


def draw_cone(painter: QPainter, foot: QPointF, size: float = 22.0) -> None:
    """Draw a traffic cone that stands on ``foot``, ``size`` logical pixels high."""
    painter.save()
    painter.translate(foot)
    painter.scale(size / 22.0, size / 22.0)
    body = QPolygonF([QPointF(-6.5, -2.5), QPointF(-1.4, -21), QPointF(1.4, -21), QPointF(6.5, -2.5)])
    base = QRectF(-9.5, -3.2, 19, 4.4)
    painter.setPen(pen(CASING, 3.6))
    painter.drawPolygon(body)
    painter.drawRoundedRect(base, 1.6, 1.6)
    painter.setPen(pen(PAPER, 1.6))
    painter.setBrush(QBrush(CONE))
    painter.drawPolygon(body)
    painter.drawRoundedRect(base, 1.6, 1.6)
    painter.setPen(Qt.PenStyle.NoPen)
    painter.drawPolygon(body)
    painter.drawRoundedRect(base, 1.6, 1.6)
    painter.setBrush(QBrush(PAPER))
    painter.drawPolygon(
        QPolygonF([QPointF(-4.8, -8.6), QPointF(-3.7, -12.4), QPointF(3.7, -12.4), QPointF(4.8, -8.6)])
    )
    painter.restore()


def _outline(state: RobotState, with_heading: bool) -> QPainterPath:
    path = QPainterPath()
    if state is RobotState.OFFLINE:
        path.addRoundedRect(QRectF(-7.5, -7.5, 15, 15), 2, 2)
        nose = [QPointF(7.5, -4), QPointF(12.5, 0), QPointF(7.5, 4)]
    elif with_heading:
        path.addPolygon(QPolygonF([QPointF(13, 0), QPointF(-9.5, 9), QPointF(-5, 0), QPointF(-9.5, -9)]))
        path.closeSubpath()
        return path
    else:
        path.addEllipse(QPointF(0, 0), 8.5, 8.5)
        return path
    if with_heading:
        point = QPainterPath()
        point.addPolygon(QPolygonF(nose))
        point.closeSubpath()
        path = path.united(point)
    return path


def _cross(painter: QPainter, colour: QColor) -> None:
    """Draw a cross on a disc, small enough to leave the heading visible."""
    centre, arm = QPointF(-7.0, 0.0), 3.1
    painter.setPen(pen(PAPER, 2.0))
    painter.setBrush(QBrush(colour))
    painter.drawEllipse(centre, 7.0, 7.0)
    painter.setPen(pen(PAPER, 2.4))
    painter.drawLine(centre + QPointF(-arm, -arm), centre + QPointF(arm, arm))
    painter.drawLine(centre + QPointF(-arm, arm), centre + QPointF(arm, -arm))


# --- Strokes: many at once, from arrays ---

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
    # After the elements: the beginning of the last line, and the fill rule.
    last = np.array([len(elements) - 2, 0], dtype=">i4")
    data = QByteArray(count.tobytes() + elements.tobytes() + last.tobytes())
    path = QPainterPath()
    QDataStream(data) >> path
    return path


def lines(start: Points, end: Points) -> list[QLineF]:
    """Return the lines from (n, 2) ``start`` to ``end`` pixels, as separate objects."""
    return [QLineF(*ends) for ends in np.hstack([start, end]).tolist()]


def flat(stroke: QPen) -> QPen:
    """Return ``stroke`` without the round ends, for which Qt takes fifty times as long.

    They also do not reach beyond the line: translucent ones would overlap where they meet.
    """
    stroke.setCapStyle(Qt.PenCapStyle.FlatCap)
    return stroke


def route(painter: QPainter, pixels: Points, colour: QColor) -> None:
    """Draw a way that ends in a ring."""
    painter.setBrush(QBrush(Qt.BrushStyle.NoBrush))
    legs = _legs(pixels)
    line = pen(colour, 2.8)
    # So that there are no gaps at its bends.
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
