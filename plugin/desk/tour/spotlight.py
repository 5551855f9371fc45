"""A frame around the widget that the tour speaks of."""

from __future__ import annotations

from qgis.PyQt.QtCore import QPoint, QRect, Qt, QTimer
from qgis.PyQt.QtGui import QColor, QPainter, QPaintEvent, QPen
from qgis.PyQt.QtWidgets import QWidget

LOOK_MS = 50
"""How often it looks whether its widget has moved: docks are dragged and tabs are changed."""
MARGIN = 4
COLOUR = QColor("#FF8F00")


class Spotlight(QWidget):
    """Lies over the whole window, takes no mouse and no focus, and paints nothing but the frame."""

    def __init__(self, window: QWidget):
        super().__init__(window)
        self.setObjectName("fleet_tour_spotlight")
        self.setAttribute(Qt.WidgetAttribute.WA_TransparentForMouseEvents)
        self.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        self._target: QWidget | None = None
        self.framed = QRect()
        self._clock = QTimer(self)
        self._clock.timeout.connect(self._look)

    def point_at(self, name: str) -> None:
        """Frame the widget of that object name; nothing for an empty name or one that is not there."""
        self._target = self.parentWidget().findChild(QWidget, name) if name else None
        if self._target is not None:
            self._target.destroyed.connect(self._forget)
            self._clock.start(LOOK_MS)
            self.show()
        else:
            self._clock.stop()
            self.hide()
        self._look()

    def paintEvent(self, event: QPaintEvent) -> None:
        if not self.framed.isNull():
            painter = QPainter(self)
            painter.setRenderHint(QPainter.RenderHint.Antialiasing)
            painter.setPen(QPen(COLOUR, 3))
            painter.drawRoundedRect(self.framed, 5, 5)

    def _forget(self) -> None:
        self._target = None

    def _look(self) -> None:
        window = self.parentWidget()
        self.setGeometry(window.rect())
        framed = QRect()
        if self._target is not None and self._target.isVisible():
            corner = self._target.mapTo(window, QPoint(0, 0))
            framed = QRect(corner, self._target.size()).adjusted(-MARGIN, -MARGIN, MARGIN, MARGIN)
        if framed != self.framed:
            self.framed = framed
            self.update()
