"""The one place where what went wrong becomes a text in QGIS's message bar."""

from __future__ import annotations

from qgis.core import Qgis, QgsMessageLog
from qgis.gui import QgsMessageBar, QgsMessageBarItem
from qgis.PyQt.QtCore import QObject

TITLE = "Fleet Supervisor"
SECONDS = {Qgis.MessageLevel.Info: 6, Qgis.MessageLevel.Success: 5, Qgis.MessageLevel.Warning: 12}
"""How long a text stays; what is critical stays until it is closed."""


class Notices(QObject):
    """Shows texts in the message bar, each once at a time, and writes all of them to QGIS's message log."""

    def __init__(self, bar: QgsMessageBar, parent: QObject | None = None):
        super().__init__(parent)
        self._bar = bar
        self._shown: dict[str, QgsMessageBarItem] = {}
        bar.widgetRemoved.connect(self._removed)

    def error(self, error: Exception | str) -> None:
        """Say what failed; stays until it is closed."""
        self._show(str(error), Qgis.MessageLevel.Critical)

    def warning(self, text: Exception | str) -> None:
        """Say what the operator should know and mend."""
        self._show(str(text), Qgis.MessageLevel.Warning)

    def info(self, text: str) -> None:
        """Say what happened."""
        self._show(text, Qgis.MessageLevel.Info)

    def withdraw(self) -> None:
        """Take down whatever still hangs there."""
        self._bar.widgetRemoved.disconnect(self._removed)
        for item in list(self._shown.values()):
            self._bar.popWidget(item)
        self._shown.clear()

    def _show(self, text: str, level: Qgis.MessageLevel) -> None:
        if text in self._shown:
            return
        QgsMessageLog.logMessage(text, TITLE, level, False)
        item = QgsMessageBarItem(TITLE, text, level, SECONDS.get(level, 0))
        self._shown[text] = item
        self._bar.pushItem(item)

    def _removed(self, item: QgsMessageBarItem) -> None:
        self._shown = {text: shown for text, shown in self._shown.items() if shown is not item}
