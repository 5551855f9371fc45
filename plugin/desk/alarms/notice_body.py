"""A text and its buttons in QGIS's message bar, which is as narrow as the panels beside the map leave it."""

from __future__ import annotations

from collections.abc import Sequence

from qgis.PyQt.QtCore import QSize, Qt
from qgis.PyQt.QtGui import QResizeEvent
from qgis.PyQt.QtWidgets import QAbstractButton, QBoxLayout, QHBoxLayout, QLabel, QSizePolicy, QWidget

BROAD_TEXT = 360
"""Pixels of text beside which its buttons stand; where that leaves less, they stand beneath it."""


class NoticeBody(QWidget):
    """Asks for no more than the width of its buttons, and takes what there is.

    QGIS's bar makes the whole window as wide as what hangs in it wishes to be.
    """

    def __init__(self, text: QLabel, buttons: Sequence[QAbstractButton], parent: QWidget):
        super().__init__(parent)
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Fixed)
        self._foot = QWidget()
        row = QHBoxLayout(self._foot)
        row.setContentsMargins(0, 0, 0, 0)
        for button in buttons:
            row.addWidget(button)
        self._parts = QBoxLayout(QBoxLayout.Direction.LeftToRight, self)
        self._parts.setContentsMargins(0, 0, 0, 0)
        self._parts.addWidget(text, 1)
        self._parts.addWidget(self._foot, 0, Qt.AlignmentFlag.AlignRight)

    def sizeHint(self) -> QSize:
        return QSize(self._foot.sizeHint().width(), super().sizeHint().height())

    def minimumSizeHint(self) -> QSize:
        return self.sizeHint()

    def resizeEvent(self, event: QResizeEvent) -> None:
        super().resizeEvent(event)
        is_broad = self.width() >= BROAD_TEXT + self._foot.sizeHint().width()
        direction = QBoxLayout.Direction.LeftToRight if is_broad else QBoxLayout.Direction.TopToBottom
        if direction != self._parts.direction():
            self._parts.setDirection(direction)
