"""The menu entry that opens the dialog *Layer roles*, and takes it away again."""

from __future__ import annotations

from pathlib import Path

from qgis.core import QgsProject
from qgis.gui import QgisInterface
from qgis.PyQt import sip
from qgis.PyQt.QtGui import QIcon
from qgis.PyQt.QtWidgets import QAction

from ..language import tr
from .roles_dialog import RolesDialog

ICON = Path(__file__).parents[2] / "resources" / "icons" / "layer_roles.svg"


class RolesAction:
    """An entry of ``menu``. :meth:`remove` undoes the constructor and closes the dialog."""

    def __init__(self, iface: QgisInterface, menu: str):
        self._iface, self._menu = iface, menu
        self._dialog: RolesDialog | None = None
        self.action = QAction(QIcon(str(ICON)), tr("Layer roles…"), iface.mainWindow())
        self.action.setObjectName("fleet_layer_roles")
        self.action.setToolTip(tr("Say what each layer of the project is to robots"))
        self.action.triggered.connect(self.open)
        iface.addPluginToMenu(menu, self.action)

    def open(self) -> None:
        """Open the dialog, or bring it to the front."""
        if self._dialog is None or sip.isdeleted(self._dialog) or not self._dialog.isVisible():
            self._dialog = RolesDialog(QgsProject.instance(), self._iface.mainWindow())
            self._dialog.open()
        self._dialog.raise_()

    def remove(self) -> None:
        """Close the dialog without keeping anything, and take the entry out of the menu."""
        if self._dialog is not None and not sip.isdeleted(self._dialog):
            self._dialog.reject()
            self._dialog.deleteLater()
        self._dialog = None
        self._iface.removePluginMenu(self._menu, self.action)
        self.action.deleteLater()
