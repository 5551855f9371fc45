"""The plugin's own menu, which QGIS makes for its first entry and leaves behind after its last."""

from __future__ import annotations

from qgis.PyQt.QtWidgets import QMenu, QWidget


class PluginMenu:
    """The menu ``title`` of ``window``. :meth:`remove` is for when every entry has been taken out."""

    def __init__(self, window: QWidget, title: str):
        self._window, self._title = window, title

    def remove(self) -> None:
        """Delete what QGIS has only taken off the list: each loading would add another one to the window."""
        for menu in self._window.findChildren(QMenu):
            if menu.title() == self._title and menu.isEmpty():
                menu.deleteLater()
