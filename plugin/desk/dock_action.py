"""A menu entry that shows a panel."""

from __future__ import annotations

from qgis.core import QgsSettings
from qgis.gui import QgisInterface, QgsDockWidget
from qgis.PyQt.QtCore import QByteArray, Qt
from qgis.PyQt.QtGui import QIcon
from qgis.PyQt.QtWidgets import QAction, QDockWidget, QMainWindow

from .actions import ICONS

AREA = Qt.DockWidgetArea.LeftDockWidgetArea
BROWSER = "Browser"
"""QGIS's name for its panel of files and services."""


class ActionDock(QgsDockWidget):
    """A panel of the main window that a :class:`DockAction` shows."""

    def remove(self) -> None:
        """Take out what the panel put elsewhere, before it goes itself."""
        raise NotImplementedError


class DockAction:
    """An entry of ``menu`` and the panel that it shows. :meth:`remove` undoes the constructor.

    Opened for the first time, the panel is a tab beside QGIS's browser: beneath browser and layers a window
    of 800 pixels has no room for its parts. Wherever the user drags it, QGIS has it there the next time.
    """

    def __init__(
        self,
        iface: QgisInterface,
        menu: str,
        dock: ActionDock,
        *,
        icon: str,
        text: str,
        name: str,
        tip: str,
    ):
        self._iface, self._menu, self.dock = iface, menu, dock
        self.action = QAction(QIcon(str(ICONS / icon)), text, iface.mainWindow())
        self.action.setObjectName(name)
        self.action.setCheckable(True)
        self.action.setToolTip(tip)
        self._is_placed = self._lacks_height = False
        iface.addDockWidget(AREA, dock)
        dock.hide()
        # Before the panel is shown. While QGIS starts would be too soon: it arranges its panels after that.
        self.action.toggled.connect(self._place)
        dock.setToggleVisibilityAction(self.action)
        self.action.triggered.connect(self._make_room)
        self.action.triggered.connect(self._give_keyboard)
        iface.addPluginToMenu(menu, self.action)

    def _place(self, opened: bool) -> None:
        if self._is_placed or not opened:
            return
        self._is_placed = True
        window: QMainWindow = self._iface.mainWindow()
        browser = window.findChild(QDockWidget, BROWSER)
        if browser is None or self._is_known_to_qgis():
            return
        if window.dockWidgetArea(browser) == AREA and not browser.isFloating():
            window.tabifyDockWidget(browser, self.dock)
            self._lacks_height = True

    def _is_known_to_qgis(self) -> bool:
        """Tell whether QGIS has put the panel where it was when it was closed last."""
        arrangement = bytes(QgsSettings().value("UI/state", QByteArray()) or b"")
        return self.dock.objectName().encode("utf-16-be") in arrangement

    def _make_room(self, opened: bool) -> None:
        """Give a panel that is new beside the browser half of the column: layers would leave it a strip."""
        if opened and self._lacks_height:
            self._lacks_height = False
            window: QMainWindow = self._iface.mainWindow()
            window.resizeDocks([self.dock], [self.dock.sizeHint().height()], Qt.Orientation.Vertical)

    def _give_keyboard(self, opened: bool) -> None:
        """Let who opened the panel by its key go on in it by keys."""
        if opened:
            self.dock.setFocus(Qt.FocusReason.ShortcutFocusReason)

    def remove(self) -> None:
        """Take panel, layers and entry out."""
        self.dock.remove()
        self._iface.removeDockWidget(self.dock)
        self.dock.deleteLater()
        self._iface.removePluginMenu(self._menu, self.action)
        self.action.deleteLater()
