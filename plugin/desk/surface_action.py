"""The menu entry that puts the road surface tool into the operator's hand."""

from __future__ import annotations

from qgis.gui import QgisInterface
from qgis.PyQt.QtGui import QIcon
from qgis.PyQt.QtWidgets import QAction

from ..language import tr
from ..sites.surface_store import SurfaceStore
from .actions import ICONS
from .notices import Notices
from .surface_tool import SurfaceTool


class SurfaceAction:
    """An entry of ``menu`` for the tool. :meth:`remove` undoes the constructor."""

    def __init__(self, iface: QgisInterface, menu: str, store: SurfaceStore, notices: Notices):
        self._iface, self._menu = iface, menu
        self.action = QAction(
            QIcon(str(ICONS / "surface_at_point.svg")), tr("Which road surface is here?"), iface.mainWindow()
        )
        self.action.setObjectName("fleet_surface_at_point")
        self.action.setToolTip(
            tr("Tell the road surface under the cursor; a click says it with its coordinates, Esc ends")
        )
        self.action.setCheckable(True)
        self.tool = SurfaceTool(iface.mapCanvas(), store, notices)
        self.tool.setAction(self.action)
        self.action.triggered.connect(self._take)
        iface.addPluginToMenu(menu, self.action)

    def remove(self) -> None:
        """Put the tool away and take the entry out of the menu."""
        self._iface.mapCanvas().unsetMapTool(self.tool)
        self.tool.remove()
        self.tool.deleteLater()
        self._iface.removePluginMenu(self._menu, self.action)
        self.action.deleteLater()

    def _take(self) -> None:
        self._iface.mapCanvas().setMapTool(self.tool)
        self._iface.mapCanvas().setFocus()
