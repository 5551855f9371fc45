"""A menu entry that shows a panel."""

from __future__ import annotations

from qgis.gui import QgisInterface, QgsDockWidget
from qgis.PyQt.QtCore import Qt
from qgis.PyQt.QtGui import QIcon
from qgis.PyQt.QtWidgets import QAction

from .actions import ICONS


class ActionDock(QgsDockWidget):
    """A panel of the main window that a :class:`DockAction` shows."""

    def remove(self) -> None:
        """Take out what the panel put elsewhere, before it goes itself."""
        raise NotImplementedError


class DockAction:
    """An entry of ``menu`` and the panel that it shows. :meth:`remove` undoes the constructor."""

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
        iface.addDockWidget(Qt.DockWidgetArea.LeftDockWidgetArea, dock)
        dock.hide()
        dock.setToggleVisibilityAction(self.action)
        iface.addPluginToMenu(menu, self.action)

    def remove(self) -> None:
        """Take panel, layers and entry out."""
        self.dock.remove()
        self._iface.removeDockWidget(self.dock)
        self.dock.deleteLater()
        self._iface.removePluginMenu(self._menu, self.action)
        self.action.deleteLater()
