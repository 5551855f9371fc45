"""The one place where what went wrong becomes a text in QGIS's message bar."""

from __future__ import annotations

from qgis.core import Qgis, QgsMessageLog
from qgis.gui import QgsMessageBar, QgsMessageBarItem
from qgis.PyQt.QtCore import QObject, QSize, Qt, pyqtSignal
from qgis.PyQt.QtGui import QResizeEvent
from qgis.PyQt.QtWidgets import QLabel, QSizePolicy

from .messages import Level

TITLE = "Fleet Supervisor"
LEVELS = {
    Level.ERROR: Qgis.MessageLevel.Critical,
    Level.WARNING: Qgis.MessageLevel.Warning,
    Level.INFO: Qgis.MessageLevel.Info,
}
SECONDS = {Qgis.MessageLevel.Info: 6, Qgis.MessageLevel.Success: 5, Qgis.MessageLevel.Warning: 12}
"""How long a text stays; what is critical stays until it is closed."""
BESIDE_TEXT = 190
"""Pixels of the bar's width that its icons, counter and buttons take."""


class Notices(QObject):
    """Shows texts in the message bar, each once at a time, and writes all of them to QGIS's message log.

    The newest one is seen first, also one that hung beneath others already.
    """

    closed = pyqtSignal(str)
    """A text does not hang there any more."""

    def __init__(self, bar: QgsMessageBar, parent: QObject | None = None):
        super().__init__(parent)
        self._bar = bar
        self._shown: dict[str, QgsMessageBarItem] = {}
        bar.widgetRemoved.connect(self._removed)

    def show_message(self, text: str, level: Level) -> None:
        """Show a message of the desk."""
        self._show(text, LEVELS[level])

    def error(self, error: Exception | str) -> None:
        """Say what failed; stays until it is closed."""
        self._show(str(error), Qgis.MessageLevel.Critical)

    def warning(self, text: Exception | str) -> None:
        """Say what the operator should know and mend."""
        self._show(str(text), Qgis.MessageLevel.Warning)

    def info(self, text: str) -> None:
        """Say what happened."""
        self._show(text, Qgis.MessageLevel.Info)

    def texts(self) -> list[str]:
        """Return what hangs there now."""
        return list(self._shown)

    def take_down(self, text: str) -> None:
        """Take down a text that is over; one that does not hang there is passed over."""
        item = self._shown.pop(text, None)
        if item is not None:
            self._bar.popWidget(item)

    def withdraw(self) -> None:
        """Take down whatever still hangs there."""
        self._bar.widgetRemoved.disconnect(self._removed)
        for item in list(self._shown.values()):
            self._bar.popWidget(item)
        self._shown.clear()

    def _show(self, text: str, level: Qgis.MessageLevel) -> None:
        hanging = self._shown.get(text)
        if hanging is not None and self._bar.currentItem() is hanging:
            return
        if hanging is None:
            QgsMessageLog.logMessage(text, TITLE, level, False)
        else:
            self.take_down(text)
        item = QgsMessageBarItem(NoticeLabel(text, self._bar), level, SECONDS.get(level, 0))
        self._shown[text] = item
        self._bar.pushItem(item)

    def _removed(self, item: QgsMessageBarItem) -> None:
        for text in [text for text, shown in self._shown.items() if shown is item]:
            del self._shown[text]
            self.closed.emit(text)


class NoticeLabel(QLabel):
    """A text on as many lines as it needs; an item of QGIS's own cuts it after one and a half.

    It asks for the width of its longest word and takes what there is: QGIS's bar makes the whole window as
    wide as what hangs in it wishes to be.
    """

    def __init__(self, text: str, bar: QgsMessageBar):
        super().__init__(f"{TITLE}: {text}", bar)
        self.setObjectName("fleet_notice")
        self.setTextFormat(Qt.TextFormat.PlainText)
        self.setTextInteractionFlags(Qt.TextInteractionFlag.TextSelectableByMouse)
        self.setWordWrap(True)
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Fixed)
        self._fit(max(200, bar.width() - BESIDE_TEXT))

    def show_text(self, text: str) -> None:
        """Show ``text`` in place of the other one; laying out QGIS's bar anew takes time."""
        if self.text() == f"{TITLE}: {text}":
            return
        self.setText(f"{TITLE}: {text}")
        self._fit(self.width())

    def sizeHint(self) -> QSize:
        return QSize(self.minimumSizeHint().width(), super().sizeHint().height())

    def resizeEvent(self, event: QResizeEvent) -> None:
        super().resizeEvent(event)
        self._fit(self.width())

    def _fit(self, width: int) -> None:
        # Qt counts the least height that was set before among what the text takes.
        self.setMinimumHeight(0)
        self.setFixedHeight(self.heightForWidth(width))
