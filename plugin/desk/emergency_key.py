"""The key of the emergency stop over dialogs that block their window, QGIS's own among them."""

from __future__ import annotations

from qgis.core import QgsApplication
from qgis.PyQt.QtCore import QObject
from qgis.PyQt.QtWidgets import QAction, QApplication


class EmergencyKey(QObject):
    """Lends ``action`` to every dialog that blocks its window: Qt gives a blocked window's keys to nobody."""

    def __init__(self, action: QAction, parent: QObject):
        super().__init__(parent)
        self._action = action
        QgsApplication.instance().focusWindowChanged.connect(self._lend)

    def remove(self) -> None:
        """Lend the key to no more dialogs."""
        QgsApplication.instance().focusWindowChanged.disconnect(self._lend)

    def _lend(self) -> None:
        dialog = QApplication.activeModalWidget()
        if dialog is not None and self._action not in dialog.actions():
            dialog.addAction(self._action)
