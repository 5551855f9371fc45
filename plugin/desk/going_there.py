"""Lists of things that have a place on the map."""

from __future__ import annotations

from collections.abc import Callable

from qgis.PyQt.QtCore import QEvent, QModelIndex, QObject, Qt
from qgis.PyQt.QtWidgets import QAbstractItemView

ENTER = (Qt.Key.Key_Return, Qt.Key.Key_Enter)
ALONE = (Qt.KeyboardModifier.NoModifier, Qt.KeyboardModifier.KeypadModifier)


class GoingThere(QObject):
    """Calls ``go`` with a row of ``view`` at a double click on it, and at Enter with the selected one."""

    def __init__(self, view: QAbstractItemView, go: Callable[[QModelIndex], object]):
        super().__init__(view)
        self._view = view
        self._go = go
        view.doubleClicked.connect(go)
        view.installEventFilter(self)

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        if event.type() != QEvent.Type.KeyPress or event.key() not in ENTER:
            return False
        if event.modifiers() not in ALONE:
            return False
        selection, index = self._view.selectionModel(), self._view.currentIndex()
        if not selection.isSelected(index):
            # What is renewed all the time may have selected rows and no current one.
            index = next(iter(selection.selectedRows()), QModelIndex())
        if index.isValid():
            self._go(index)
        return True
