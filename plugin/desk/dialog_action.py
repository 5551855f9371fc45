"""A menu entry that opens a window, in the plugin's menu and in that of the connections."""

from __future__ import annotations

from qgis.gui import QgisInterface
from qgis.PyQt.QtGui import QIcon
from qgis.PyQt.QtWidgets import QAction, QDialog

from .actions import ICONS
from .connection_menu import ConnectionMenu


class DialogAction:
    """An entry of ``menu`` and of ``connections``, and the window. :meth:`remove` undoes the constructor."""

    def __init__(
        self,
        iface: QgisInterface,
        menu: str,
        connections: ConnectionMenu,
        dialog: QDialog,
        *,
        icon: str,
        text: str,
        name: str,
        tip: str,
    ):
        self._iface, self._menu, self._connections, self.dialog = iface, menu, connections, dialog
        self.action = QAction(QIcon(str(ICONS / icon)), text, iface.mainWindow())
        self.action.setObjectName(name)
        self.action.setToolTip(tip)
        self.action.triggered.connect(self.open)
        iface.addPluginToMenu(menu, self.action)
        connections.offer(self.action)

    def open(self) -> None:
        """Open the window, or bring it to the front."""
        self.dialog.show()
        self.dialog.raise_()
        self.dialog.activateWindow()

    def remove(self) -> None:
        """Close the window with all that it opened, and take the entries out."""
        self.dialog.close()
        self.dialog.deleteLater()
        self._connections.withdraw(self.action)
        self._iface.removePluginMenu(self._menu, self.action)
        self.action.deleteLater()
