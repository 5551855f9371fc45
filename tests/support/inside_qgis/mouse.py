"""A mouse that nothing comes between: no other window over this one, and no real mouse."""

from __future__ import annotations

from qgis.PyQt.QtCore import QEvent, QPoint, QPointF, Qt
from qgis.PyQt.QtGui import QMouseEvent
from qgis.PyQt.QtWidgets import QApplication, QWidget


def move_mouse(widget: QWidget, place: QPoint, pressed: Qt.MouseButton = Qt.MouseButton.NoButton) -> None:
    """Tell ``widget`` that the mouse moved to ``place`` in it, with the button ``pressed`` held down.

    QTest.mouseMove moves the screen's cursor instead, and what is told of it depends on the windows there.
    """
    there = QPointF(place), QPointF(widget.mapToGlobal(place))
    buttons = Qt.MouseButtons(pressed)
    event = QMouseEvent(
        QEvent.Type.MouseMove, *there, Qt.MouseButton.NoButton, buttons, Qt.KeyboardModifier.NoModifier
    )
    QApplication.sendEvent(widget, event)
