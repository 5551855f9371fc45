"""The menu entries that put the cone layout tool into the operator's hand, one for each layout."""

from __future__ import annotations

from qgis.core import QgsProject
from qgis.gui import QgisInterface
from qgis.PyQt.QtGui import QIcon
from qgis.PyQt.QtWidgets import QAction, QMenu

from ...robot_bridge.layouts.catalogue import LAYOUTS
from ...robot_bridge.layouts.layout import Layout
from ..language import tr
from ..layout_words import layout_in_words
from .actions import ICONS
from .cone_file import ConeFile
from .layout_dimensions import LayoutDimensions, remembered
from .layout_tool import LayoutTool
from .notices import Notices


class LayoutAction:
    """An entry of ``menu`` with a menu of layouts. :meth:`remove` undoes the constructor."""

    def __init__(self, iface: QgisInterface, menu: str, notices: Notices):
        self._iface, self._menu = iface, menu
        window = iface.mainWindow()
        self.action = QAction(QIcon(str(ICONS / "cone_layout.svg")), tr("Place cone layout"), window)
        self.action.setObjectName("fleet_cone_layout")
        self.action.setToolTip(
            tr(
                "Place a cone layout: it is shown under the cursor, the wheel turns it (Shift: finely), a "
                "click places it, Ctrl+Z takes it back, Esc ends; by keys PgUp and PgDown turn it, Enter "
                "places it, F2 leads to its dimensions. Nothing is sent to robots"
            )
        )
        self.tool = LayoutTool(iface.mapCanvas(), QgsProject.instance(), notices)
        self.dimensions = LayoutDimensions(window)
        self.dimensions.changed.connect(self.tool.show_layout)
        self.dimensions.turned.connect(self.tool.turn_to)
        self.dimensions.left.connect(iface.mapCanvas().setFocus)
        self.tool.turned.connect(self.dimensions.show_heading)
        self.tool.dimensions_wanted.connect(self.dimensions.take_keys)
        self.dimensions.undo_wanted.connect(self.tool.undo)
        self.tool.undo_changed.connect(self.dimensions.undo.setEnabled)
        self._file = ConeFile(QgsProject.instance(), notices)
        self.tool.deactivated.connect(self.dimensions.hide)
        self._layouts = QMenu(window)
        for kind in LAYOUTS.values():
            entry = self._layouts.addAction(layout_in_words(kind))
            entry.setObjectName(f"fleet_cone_layout_{kind.NAME}")
            entry.triggered.connect(lambda _=False, kind=kind: self.take(remembered(kind)))
        self.action.setMenu(self._layouts)
        iface.addPluginToMenu(menu, self.action)

    def take(self, layout: Layout) -> None:
        """Put the tool into the operator's hand, with ``layout`` and its dimensions to be changed."""
        self._iface.mapCanvas().setMapTool(self.tool)
        self.tool.show_layout(layout)
        self.dimensions.show_layout(layout, self.tool.heading)
        self._iface.mapCanvas().setFocus()

    def remove(self) -> None:
        """Put the tool away and take the entries out of the menu."""
        self._iface.mapCanvas().unsetMapTool(self.tool)
        self._file.remove()
        self.tool.remove()
        self.tool.deleteLater()
        self.dimensions.deleteLater()
        self._iface.removePluginMenu(self._menu, self.action)
        self._layouts.deleteLater()
        self.action.deleteLater()
