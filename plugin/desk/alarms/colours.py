"""How pressing an alarm looks."""

from __future__ import annotations

from qgis.PyQt.QtGui import QColor, QPalette
from qgis.PyQt.QtWidgets import QApplication

from ..colours import is_dark
from .alarm import Alarm
from .thresholds import AlarmKind

PRESSING = frozenset(
    {
        AlarmKind.LOST,
        AlarmKind.UNSURE,
        AlarmKind.IN_KEEPOUT,
        AlarmKind.AT_OBSTACLE,
        AlarmKind.NEAR_ROBOT,
        AlarmKind.COMES_NEAR,
        AlarmKind.TOO_CLOSE,
        AlarmKind.WILL_PASS,
        AlarmKind.OUTSIDE_SITE,
    }
)
"""Kinds for which somebody has to act at once."""


def colour_of(alarm: Alarm) -> QColor:
    """Return the colour of an alarm's letters; pale where it is over."""
    if alarm.ended is not None:
        return QApplication.palette().color(QPalette.ColorGroup.Disabled, QPalette.ColorRole.Text)
    return letters(alarm.kind in PRESSING)


def letters(pressing: bool) -> QColor:
    """Return red for what is pressing, else amber, legible on the background of lists."""
    if pressing:
        return QColor("#FF8A80" if is_dark() else "#B71C1C")
    return QColor("#FFB74D" if is_dark() else "#A15C00")
