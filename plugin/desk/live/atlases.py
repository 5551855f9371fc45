"""The pictures that robots, marks and arrows are painted from, a cell for each way that one can look."""

from __future__ import annotations

import numpy as np
from qgis.PyQt.QtCore import QPointF, Qt
from qgis.PyQt.QtGui import QPainter, QPixmap

from ....robot_bridge.messages import RobotState
from ..colours import CASING, PAPER, SELECTED
from ..glyphs import CELL, draw_arrow, draw_cone, draw_robot
from ..pens import pen
from .turned import Draw, drawn, in_a_column, turned

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
