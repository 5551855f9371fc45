"""Map tool that shows the road surface, and its menu entry."""

from __future__ import annotations

from collections.abc import Callable

from qgis.core import QgsApplication, QgsCoordinateReferenceSystem, QgsPointXY
from qgis.gui import QgisInterface, QgsMapCanvas, QgsMapMouseEvent, QgsMapTool
from qgis.PyQt.QtCore import Qt
from qgis.PyQt.QtGui import QIcon, QKeyEvent
from qgis.PyQt.QtWidgets import QAction, QToolTip

from ....robot_bridge.core.roads.centrelines import Surface
from ...control.messages import MessageBar
from ...layers.road_surfaces import SurfaceMap, SurfaceStore, SurfaceTask
from ...ui.actions import ICONS
from ...ui.errors import FleetError
from ...ui.language import tr


class SurfaceTool(QgsMapTool):
    """Asks ``store`` for the project's road surfaces. It says in ``notices`` what it found.

    Surfaces are read beside the window when the tool is taken up and when a layer has changed; a click that
    comes before is answered as soon as they are there.
    """

    def __init__(self, canvas: QgsMapCanvas, store: SurfaceStore, notices: MessageBar):
        super().__init__(canvas)
        self._store = store
        self._notices = notices
        self._task: SurfaceTask | None = None
        self._clicked: QgsPointXY | None = None
        self._listens = False
        self.setCursor(Qt.CursorShape.WhatsThisCursor)

    def activate(self) -> None:
        super().activate()
        if not self._listens:
            self._listens = True
            self._store.forgotten.connect(self._read_anew)
        self._try(self._read)

    def deactivate(self) -> None:
        self._leave()
        super().deactivate()

    def canvasMoveEvent(self, event: QgsMapMouseEvent) -> None:
        surfaces = self._surfaces()
        if surfaces is None:
            return
        found = _at(surfaces, event.mapPoint(), self._crs())
        at = self.canvas().viewport().mapToGlobal(event.pos())
        QToolTip.showText(at, _named(found), self.canvas())

    def canvasReleaseEvent(self, event: QgsMapMouseEvent) -> None:
        if event.button() != Qt.MouseButton.LeftButton:
            return
        self._clicked = event.mapPoint()
        if self._surfaces() is None:
            self._try(self._read)
        else:
            self._answer()

    def keyPressEvent(self, event: QKeyEvent) -> None:
        if event.key() == Qt.Key.Key_Escape:
            self.canvas().unsetMapTool(self)
        else:
            super().keyPressEvent(event)

    def remove(self) -> None:
        """Let go of what is being read."""
        self._leave()

    def _leave(self) -> None:
        if self._listens:
            self._listens = False
            self._store.forgotten.disconnect(self._read_anew)
        self._clicked = None
        QToolTip.hideText()
        if self._task is not None:
            self._task.taskCompleted.disconnect(self._answer)
            self._task.taskTerminated.disconnect(self._complain)
            self._task.cancel()
            self._task = None

    def _surfaces(self) -> SurfaceMap | None:
        layers = self._store.layers()
        return self._store.kept(layers) if layers else None

    def _read(self) -> None:
        """Begin to read the surfaces, unless that is under way.

        :raises FleetError: when there are none, or a layer cannot be used.
        """
        if self._task is not None:
            return
        layers = self._store.layers()
        if not layers:
            self._clicked = None
            raise FleetError(
                tr(
                    "No layer of the project has the role road surface: set it in Plugins > Fleet "
                    "Supervisor > Layer roles."
                )
            )
        self._task = self._store.task(layers)
        self._task.taskCompleted.connect(self._answer)
        self._task.taskTerminated.connect(self._complain)
        QgsApplication.taskManager().addTask(self._task)

    def _answer(self) -> None:
        self._task = None
        place, surfaces = self._clicked, self._surfaces()
        if surfaces is None:
            # A layer has changed meanwhile.
            self._try(self._read)
            return
        if place is None:
            return
        self._clicked = None
        crs = self._crs()
        digits = 6 if crs.isGeographic() else 2
        where = f"{place.x():.{digits}f}, {place.y():.{digits}f} ({crs.authid() or tr('no CRS')})"
        self._notices.info(
            tr("{told} at {where}", told=_surface_text(_at(surfaces, place, crs)), where=where)
        )

    def _read_anew(self) -> None:
        # Without layers there is nothing to read; a click says so.
        if self._store.layers():
            self._try(self._read)

    def _complain(self) -> None:
        task, self._task = self._task, None
        self._clicked = None
        if task is not None and task.why:
            self._notices.warning(task.why)

    def _crs(self) -> QgsCoordinateReferenceSystem:
        return self.canvas().mapSettings().destinationCrs()

    def _try(self, action: Callable[[], None]) -> None:
        try:
            action()
        except FleetError as error:
            self._notices.warning(error)


def _at(surfaces: SurfaceMap, place: QgsPointXY, crs: QgsCoordinateReferenceSystem) -> Surface | None:
    return surfaces.at(place.x(), place.y(), surfaces.way_from(crs))


def _named(surface: Surface | None) -> str:
    if surface is None:
        return tr("no road surface")
    return surface.label or tr("road surface without a class")


def _surface_text(surface: Surface | None) -> str:
    if surface is None:
        return tr("No road surface")
    name = f"“{surface.name}”, " if surface.name else ""
    return f"{_named(surface).capitalize()} ({name}{surface.origin})"


class SurfaceAction:
    """An entry of ``menu`` for the tool. :meth:`remove` undoes the constructor."""

    def __init__(self, iface: QgisInterface, menu: str, store: SurfaceStore, notices: MessageBar):
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
