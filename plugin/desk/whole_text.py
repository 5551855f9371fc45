"""Text that is never lower than its lines."""

from __future__ import annotations

from qgis.PyQt.QtCore import Qt
from qgis.PyQt.QtGui import QResizeEvent
from qgis.PyQt.QtWidgets import QLabel, QWidget


class WholeText(QLabel):
    """Plain text that wraps; at least as high as ``lines`` lines, so that what is below it jumps less.

    A layout that has too little room for everything takes it from labels that wrap first, and a dialog does
    not ask them how high they become.
    """

    def __init__(self, text: str = "", lines: int = 1, parent: QWidget | None = None):
        super().__init__(text, parent)
        self._least = lines * self.fontMetrics().lineSpacing() + 2
        self.setWordWrap(True)
        self.setTextFormat(Qt.TextFormat.PlainText)
        # How high it becomes is known at its width; guessed before, a dialog would stay that high.
        self.setMinimumHeight(self._least)

    def setText(self, text: str) -> None:
        super().setText(text)
        self._fit()

    def resizeEvent(self, event: QResizeEvent) -> None:
        super().resizeEvent(event)
        self._fit()

    def _fit(self) -> None:
        # Qt counts the least height that was set before among what the text takes.
        self.setMinimumHeight(0)
        self.setMinimumHeight(max(self._least, self.heightForWidth(self.width())))
