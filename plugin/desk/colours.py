"""The desk's colours: of Okabe and Ito's palette, told apart by colour-blind people as well."""

from __future__ import annotations

from qgis.PyQt.QtGui import QColor, QPalette
from qgis.PyQt.QtWidgets import QApplication

from ...robot_bridge.messages import CommandState, RobotState

STATE_COLOURS = {
    RobotState.FRESH: QColor("#0072B2"),
    RobotState.STALE: QColor("#E69F00"),
    RobotState.LOST: QColor("#C62828"),
    RobotState.OFFLINE: QColor("#757575"),
}
"""Each state has a shape of its own as well (see :mod:`.glyphs`)."""

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
"""Letters that say what is wrong."""
DOUBTFUL = QColor("#8A5A00")
"""Letters that say what may be wrong."""
WRONG_STYLE = "color: #B71C1C; background: #FDECEA;"
DOUBTFUL_STYLE = "color: #6B4300; background: #FFF1D0;"
"""Labels that bring their own background: some themes of QGIS are of a grey on which no red is legible."""
DARK = 128
"""Lightness of a background below which letters have to be paler."""


def is_dark() -> bool:
    """Tell whether lists have a dark background now."""
    return QApplication.palette().color(QPalette.ColorRole.Base).lightness() < DARK


def for_letters(colour: QColor) -> QColor:
    """Return a colour as letters of a list take it: paler on a dark background, darker on a light one."""
    if is_dark():
        return colour.lighter(175)
    # As a spot on the map amber is seen well; its letters on white are not.
    return QColor(STALE_LETTERS) if colour == STATE_COLOURS[RobotState.STALE] else colour
