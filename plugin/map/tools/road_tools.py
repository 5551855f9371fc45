"""Map tools on roads: a route drawn along them, and the surface at the mouse."""

from __future__ import annotations

from collections.abc import Callable

from qgis.core import QgsCoordinateReferenceSystem, QgsPointXY
from qgis.gui import QgisInterface, QgsMapCanvas, QgsMapMouseEvent, QgsMapTool
from qgis.PyQt.QtCore import Qt
from qgis.PyQt.QtGui import QIcon, QKeyEvent
from qgis.PyQt.QtWidgets import QAction, QToolTip

from ....robot_bridge.core.messages.roads import RouteReport
from ....robot_bridge.core.roads.network import Surface
from ...control.fleet_controller import FleetController
from ...control.messages import MessageBar
from ...control.pending_command import ROUTE, PendingCommand, Point
from ...control.route_queries import SHORTEST, RoutePreferences, RouteQuestion, route_in_words
from ...layers.road_surfaces import Key, SurfaceMap, SurfaceStore, key_of
from ...ui.actions import ICONS
from ...ui.errors import FleetError, NotSentError
from ...ui.language import tr, tr_count
from .drawing_tools import RoutePreview
from .route_tool import RouteTool


class RoadRouteTool(RouteTool):
    """The route along the roads follows the mouse; a click accepts it, and the next leg begins there.

    The first leg begins at the robot. Legs of this tool and of the drawing one can be mixed. Clicks
    that are faster than the gateway's answers add their legs one after the other.
    """

    def __init__(self, desk: FleetController):
        super().__init__(desk)
        self._way = RoutePreview(desk)
        self.preferences = SHORTEST
        """Preferences for the legs led from now on."""
        self._clicks: list[Point] = []
        """Clicked goals still to be reached; the first of them is being queried."""
        desk.preview.answered.connect(self._receive)
        desk.preview.refused.connect(self._refused)
        desk.preview.dropped.connect(self._leave_out)

    def set_preferences(self, preferences: RoutePreferences) -> None:
        """Lead legs by ``preferences`` from now on; the preview to the mouse is queried again."""
        self.preferences = preferences
        self._way.clear()

    def deactivate(self) -> None:
        self._way.clear()
        super().deactivate()

    def hovered(self, event: QgsMapMouseEvent) -> None:
        if self._is_finished:
            return
        robot, start = self._from()
        self._way.lead_to(event, robot, start, self.preferences)

    def finish(self) -> None:
        if self._clicks:
            # The routes to the clicked places are still to come, and belong to the draft.
            self._is_finished = True
        else:
            super().finish()
        if self._is_finished:
            self._way.hide()

    def clicked(self, point: Point) -> None:
        self._is_finished = False
        draft = self.draft
        if draft is not None and not self.is_for_selected(draft):
            return
        if not self.desk.preview.awaits_click:
            # The answer to an earlier one is lost.
            self._leave_out()
        self._clicks.append(point)
        if len(self._clicks) == 1:
            self._lead_on()

    def back(self) -> None:
        if not self._clicks:
            super().back()
            return
        self._clicks.pop()
        if not self._clicks:
            self._way.clear()

    def _changed(self) -> None:
        super()._changed()
        if self._clicks and self.desk.drafts.draft is None:
            self._leave_out()

    def _refused(self, why: str) -> None:
        after = len(self._clicks) - 1
        self._drop_clicks()
        if after > 0:
            why = tr_count(
                after,
                "{why} (Nor is the place clicked after it in the route.)",
                "{why} (Nor are the %n places clicked after it in the route.)",
                why=why,
            )
        self.desk.warning.emit(why)

    def _lead_on(self) -> None:
        robot, start = self._from()
        question = RouteQuestion(robot, start, self._clicks[0], taken=True, preferences=self.preferences)
        try:
            self.desk.preview.want(question)
        except NotSentError:
            self._clicks.pop(0)
            self._leave_out()
            raise

    def _leave_out(self, *_: object) -> None:
        """Report that the routes to the places clicked last come too late, or not at all."""
        left_out = len(self._clicks)
        self._drop_clicks()
        if not left_out:
            return
        self._way.clear()
        self.desk.warning.emit(
            tr_count(
                left_out,
                "The way to where you clicked last was not known yet, so it is not in the route.",
                "The ways to the %n places clicked last were not known yet, so they are not in the route.",
            )
        )

    def _drop_clicks(self) -> None:
        self._clicks.clear()
        if self.draft is None:
            self._is_finished = False

    def _from(self) -> tuple[str | None, Point | None]:
        """Return the robot of the next leg, and its beginning; None for the robot's position."""
        draft = self.draft
        if draft is None:
            return self.desk.selection.last, None
        return draft.robot, draft.points[-1]

    def _receive(self, question: RouteQuestion, route: RouteReport) -> None:
        if not self._clicks:
            return
        if (question.robot, question.start) != self._from():
            self._leave_out()
            return
        self._try(lambda: self._add(question, route))

    def _add(self, question: RouteQuestion, route: RouteReport) -> None:
        following, self._clicks = self._clicks[1:], []
        draft = self.draft or PendingCommand(question.robot, ROUTE, ())
        points = route.points if question.start is None else route.points[1:]
        try:
            self.set_command(draft.with_leg(tuple(points), route_in_words(route, question.preferences)))
        except FleetError:
            self._clicks = following
            self._leave_out()
            raise
        self._clicks = following
        if following:
            self._lead_on()
        if route.note:
            self.desk.warning.emit(tr("This leg does not follow the roads: {note}", note=route.note))


# --- The road surface at the mouse ---


class SurfaceTool(QgsMapTool):
    """Queries ``store`` for the project's road surfaces, and shows the result in ``notices``.

    Surfaces are read in the background when the tool is activated and when a layer has changed; an earlier
    click is answered as soon as they are there.
    """

    def __init__(self, canvas: QgsMapCanvas, store: SurfaceStore, notices: MessageBar):
        super().__init__(canvas)
        self._store = store
        self._notices = notices
        self._awaited: Key | None = None
        """The layers being read for it."""
        self._clicked: QgsPointXY | None = None
        self._listens = False
        self.setCursor(Qt.CursorShape.WhatsThisCursor)

    def activate(self) -> None:
        super().activate()
        if not self._listens:
            self._listens = True
            self._store.forgotten.connect(self._read_again)
            self._store.ended.connect(self._have_read)
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
        """Drop the surfaces being read."""
        self._leave()

    def _leave(self) -> None:
        if self._listens:
            self._listens = False
            self._store.forgotten.disconnect(self._read_again)
            self._store.ended.disconnect(self._have_read)
        self._clicked = self._awaited = None
        QToolTip.hideText()

    def _surfaces(self) -> SurfaceMap | None:
        layers = self._store.layers()
        return self._store.kept(layers) if layers else None

    def _read(self) -> None:
        """Start reading the surfaces, unless that is under way.

        :raises FleetError: when there are none, or a layer cannot be used.
        """
        layers = self._store.layers()
        if not layers:
            self._clicked = None
            raise FleetError(
                tr(
                    "No layer of the project has the role road surface: set it in Plugins > Fleet "
                    "Supervisor > Layer roles."
                )
            )
        self._awaited = key_of(layers)
        self._store.begin(layers)

    def _have_read(self, key: Key, why: str) -> None:
        if key != self._awaited:
            return
        self._awaited = None
        if why:
            self._clicked = None
            self._notices.warning(why)
        else:
            self._answer()

    def _answer(self) -> None:
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
            tr("{surface} at {where}", surface=_surface_text(_at(surfaces, place, crs)), where=where)
        )

    def _read_again(self) -> None:
        # Without layers there is nothing to read; a click reports it.
        if self._store.layers():
            self._try(self._read)

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
        self.action.triggered.connect(self._activate)
        iface.addPluginToMenu(menu, self.action)

    def remove(self) -> None:
        """Deactivate the tool and remove the entry from the menu."""
        self._iface.mapCanvas().unsetMapTool(self.tool)
        self.tool.remove()
        self.tool.deleteLater()
        self._iface.removePluginMenu(self._menu, self.action)
        self.action.deleteLater()

    def _activate(self) -> None:
        self._iface.mapCanvas().setMapTool(self.tool)
        self._iface.mapCanvas().setFocus()
