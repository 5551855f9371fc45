"""The plugin's parts in the QGIS window: actions, tools, dock, alarms, project check, sites dropped in."""

from __future__ import annotations

import math
from functools import partial
from pathlib import Path
from typing import Any

from qgis.core import (
    Qgis,
    QgsCoordinateReferenceSystem,
    QgsMessageLog,
    QgsMimeDataUtils,
    QgsProject,
    QgsSettings,
)
from qgis.gui import (
    QgisInterface,
    QgsApplicationExitBlockerInterface,
    QgsCustomDropHandler,
)
from qgis.PyQt.QtCore import QEvent, QMimeData, QObject, Qt, QTimer, pyqtSignal
from qgis.PyQt.QtWidgets import QAction, QDialog, QDockWidget, QMainWindow, QMenu, QToolBar

from ...robot_bridge.core.messages.positions import AlarmLimits
from ...robot_bridge.core.reconnection import FleetGateways
from ...robot_bridge.core.sites.frame import SiteFrame
from ..control.fleet_controller import FleetController
from ..control.messages import OUTAGE, TITLE, Level, MessageBar, request_topic
from ..control.request_tracker import RequestTracker
from ..gateway_client.connection_status import ConnectionPhase
from ..gateway_client.fleet_state import FleetState
from ..layers.crs import own_frame
from ..layers.live_layers import ProjectWatch
from ..layers.publishing.publication import LoadedSite, load_site, loaded_already, site_folder
from ..layers.road_surfaces import SurfaceStore
from ..layers.site_transform import frame_of
from ..map.live_view import LiveView
from ..map.overlay.scene import FollowMode
from ..map.overlay.task_painter import QueueMarks
from ..map.reported_layers import RoadLayers, StandingCones
from ..map.tools.click_tools import ClosureTool, SelectTool
from ..map.tools.drawing_tools import ConeTool, StartTool
from ..map.tools.road_tools import RoadRouteTool
from ..map.tools.route_tool import RoutePreferencesDialog, RouteTool
from ..settings.profile import KnownGateways
from ..ui.actions import OURS, Actions
from ..ui.dialogs import QuestionDialog
from ..ui.errors import FleetError, Part, Removal, remove_all
from ..ui.language import first_of, tr, tr_count
from .alarms.alarm_panel import AlarmPanel
from .alarms.board import alarm_colour
from .alarms.watch import AlarmBar, AlarmWatch
from .dock import FleetDock
from .emergency import ClearDialog, EmergencyKey
from .pending_command_panel import PendingCommandActions
from .queue import PauseActions, QueueEdits

MENU = "Fleet Supervisor"
CONNECTING = request_topic("hello", "")
"""Topic of requests made with Connect."""
MOST_ASKED = 3
"""Unanswered requests that are named to an operator who quits."""
LAYERS_WIDTH = 230
"""Pixels in which the names of layers can be read."""
LEAST_MAP_WIDTH = 500
"""Pixels that the map keeps when the list of layers is widened."""
WIDENED = "fleet_supervisor/layers_widened"


class LayersWidth(QObject):
    """Widens the list of layers once in a profile. :meth:`remove` undoes the constructor.

    QGIS first opens on 80 % of the screen. On a small one the fleet panel squeezes the panels at the left
    there, and when the window is enlarged Qt gives all of the new width to the map.
    """

    def __init__(self, window: QMainWindow, parent: QObject):
        super().__init__(parent)
        self._window = window
        self._check = QTimer(self)
        self._check.setSingleShot(True)
        self._check.timeout.connect(self._widen)
        if not QgsSettings().value(WIDENED, False, bool):
            window.installEventFilter(self)

    def eventFilter(self, _watched: QObject, event: QEvent) -> bool:
        if event.type() == QEvent.Type.Resize:
            # Once the panels have their new sizes.
            self._check.start(0)
        return False

    def remove(self) -> None:
        """Leave the panels as they are from now on."""
        self._check.stop()
        self._window.removeEventFilter(self)

    def _widen(self) -> None:
        window, side = self._window, Qt.DockWidgetArea.LeftDockWidgetArea
        docks = window.findChildren(QDockWidget)
        shown = [one for one in docks if one.isVisible() and not one.isFloating()]
        left = [one for one in shown if window.dockWidgetArea(one) == side]
        if not left:
            return
        lacks = LAYERS_WIDTH - left[0].width()
        if lacks > 0:
            if window.centralWidget().width() - lacks < LEAST_MAP_WIDTH:
                return
            window.resizeDocks(left[:1], [LAYERS_WIDTH], Qt.Orientation.Horizontal)
        QgsSettings().setValue(WIDENED, True)
        self.remove()


class FleetWindow(QObject):
    """All parts of the desk in the QGIS window. :meth:`remove` undoes the constructor."""

    def __init__(self, iface: QgisInterface):
        # A child of the main window, so that scripts find its actions there by their object names.
        super().__init__(iface.mainWindow())
        self._iface = iface
        self._reasons: set[str] = set()
        """Reasons why the link is down that the message bar has shown."""
        self._gateways = KnownGateways()
        self._parts: list[Part] = [Removal(self.deleteLater)]
        """Parts that :meth:`remove` removes, the last one first."""
        self._ending: list[Part] = []
        """What is removed before all of them: the desk, once there is one, as it reports to them."""
        try:
            self.desk = FleetController(iface.mapCanvas(), QgsProject.instance(), self)
            self._ending.append(Removal(self._shut_down))
            self._build(iface.mainWindow())
        except Exception:
            # Nobody else knows this window yet.
            self.remove()
            raise

    def _build(self, window: QMainWindow) -> None:
        self.actions = Actions(self)
        self.notices = self._add(MessageBar(self._iface.messageBar(), self))
        self._key = self._add(EmergencyKey(self.actions.emergency, self._iface.mainWindow(), self))
        self._add(QuitGuard(self._iface, self.desk.orders))
        self._project_match = self._add(ProjectMatch(self.desk.state, self.desk.project, self))
        self.view = self._add(LiveView(self.desk, self))
        self.queue_edits = QueueEdits(self.desk, self)
        self.queue_marks = self._add(QueueMarks(self.desk))
        self.dock = FleetDock(self.desk, self.actions, self.queue_edits, window)
        self._add(Removal(self._remove_dock))
        self._add(LayersWidth(window, self))
        self.road_layers = self._add(RoadLayers(self.desk.state, self.desk.project, self))
        self.standing_cones = self._add(StandingCones(self.desk.state, self.desk.project, self))
        self.toolbar: QToolBar = self._iface.addToolBar("Fleet Supervisor")
        self._add(Removal(self._remove_toolbar))
        self.toolbar.setObjectName("fleet_toolbar")
        self._road_route = RoadRouteTool(self.desk)
        self._tools = {
            self.actions.select: SelectTool(self.desk, self.view),
            self.actions.cone: ConeTool(self.desk),
            self.actions.road_route: self._road_route,
            self.actions.route: RouteTool(self.desk),
            self.actions.start: StartTool(self.desk),
            self.actions.closures: ClosureTool(self.desk, window),
        }
        for action in self._tools:
            self._add(Removal(partial(self._remove_tool, action)))
        self._draft_menu = QMenu(tr("Targets and routes"), window)
        self._add(Removal(self._remove_entries))
        self._draft_menu.setObjectName("fleet_draft_menu")
        self._draft_menu.setIcon(self.actions.cone.icon())
        self.draft_commands = self._add(
            PendingCommandActions(self.desk, self.queue_edits, self.actions, window)
        )
        self.robot_pauses = PauseActions(self.desk, self.queue_edits, self.actions, self)
        self._wire_actions()
        self._place()
        self._add(Removal(self._close_dialogs))

    def remove(self) -> None:
        """Remove every part from the window and wait for the connection's threads."""
        self._parts += self._ending
        remove_all(self._parts)

    def _shut_down(self) -> None:
        """End the link, and log which requests it leaves unanswered."""
        try:
            self.desk.shut_down()
        finally:
            if asked := self.desk.orders.unanswered:
                text = tr(
                    "Closed before the gateway answered, so it may be done or not: {asked}",
                    asked="; ".join(asked),
                )
                QgsMessageLog.logMessage(text, TITLE, Qgis.MessageLevel.Critical)

    def _close_dialogs(self) -> None:
        """Close the plugin's dialogs without doing what they ask about: nobody would carry it out."""
        for dialog in self._iface.mainWindow().findChildren(QDialog):
            if dialog.objectName().startswith(OURS):
                if not dialog.isHidden():
                    # One that was closed before would signal its end a second time.
                    dialog.reject()
                dialog.deleteLater()

    def _remove_tool(self, action: QAction) -> None:
        tool, canvas = self._tools.pop(action), self._iface.mapCanvas()
        if canvas.mapTool() is tool:
            canvas.unsetMapTool(tool)
            # A QGIS without any map tool would not react to clicks.
            self._iface.actionPan().trigger()
        tool.deleteLater()

    def _remove_entries(self) -> None:
        for action in self.menu_entries():
            self._iface.removePluginMenu(MENU, action)
        self._draft_menu.deleteLater()

    def _remove_toolbar(self) -> None:
        window: QMainWindow = self._iface.mainWindow()
        window.removeToolBar(self.toolbar)
        self.toolbar.deleteLater()

    def _remove_dock(self) -> None:
        self._iface.removeDockWidget(self.dock)
        self.dock.deleteLater()

    def _add(self, part: Any) -> Any:
        self._parts.append(part)
        return part

    def menu_entries(self) -> list[QAction]:
        """Return the entries of the plugin's menu itself; one of them opens the menu of drafts."""
        drafts = self.actions.for_drafts
        entries = [self._draft_menu.menuAction() if one in drafts else one for one in self.actions.all()]
        return list(dict.fromkeys(entries))

    def show_on_map(self, robot: str) -> None:
        """Select a robot alone and show it on the map."""
        self.desk.selection.select(robot)
        self.view.zoom_to(robot)

    def _place(self) -> None:
        self._draft_menu.addActions(self.actions.for_drafts)
        for action in self.menu_entries():
            self._iface.addPluginToMenu(MENU, action)
        for action in self.actions.all():
            if action not in self.actions.off_toolbar:
                self.toolbar.addAction(action)
            if action in (self.actions.connect, self.actions.cancel, self.actions.follow_all):
                self.toolbar.addSeparator()
        self._iface.addDockWidget(Qt.DockWidgetArea.RightDockWidgetArea, self.dock)

    def _wire_actions(self) -> None:
        actions, desk = self.actions, self.desk
        for action, tool in self._tools.items():
            tool.setAction(action)
            action.triggered.connect(lambda _, tool=tool: self._iface.mapCanvas().setMapTool(tool))
            # A click on the button of the active tool keeps it, as QGIS's own do.
            action.triggered.connect(lambda _, tool=tool: tool.action().setChecked(True))
        actions.panel.triggered.connect(self._focus_opened)
        actions.connect.triggered.connect(self._connect_or_not)
        actions.send.triggered.connect(desk.sending.send)
        actions.cancel.triggered.connect(lambda: desk.drafts.set_command(None))
        actions.follow.toggled.connect(lambda on: self._follow(FollowMode.SELECTED, on))
        actions.follow_all.toggled.connect(lambda on: self._follow(FollowMode.ALL, on))
        actions.abort.triggered.connect(desk.abort_selected)
        actions.abort_all.triggered.connect(desk.abort_all)
        actions.emergency.triggered.connect(desk.emergency_stop)
        actions.clear_emergency.triggered.connect(self._ask_to_clear)
        actions.route_preferences.triggered.connect(self._ask_for_ways)
        desk.emergency_changed.connect(self._show_emergency)
        self.dock.table.zoom_requested.connect(self.view.zoom_to)
        self.dock.log.place_requested.connect(self.view.show_place)
        self.dock.queue_panel.place_requested.connect(self.view.show_place)
        desk.messages.posted.connect(self.notices.show_message)
        desk.messages.withdrawn.connect(self.notices.remove_text)
        self.notices.closed.connect(desk.messages.forget)
        self._project_match.differs.connect(self.notices.error)
        self._project_match.over.connect(self.notices.remove_text)
        desk.state.link_changed.connect(self._show_link)
        desk.state.gateways_changed.connect(self._keep_gateways)

    def _focus_opened(self, opened: bool) -> None:
        """Set the focus in a panel opened by its shortcut: once connected, no access key leads there."""
        if opened:
            self.dock.setFocus(Qt.FocusReason.ShortcutFocusReason)

    def _follow(self, mode: FollowMode, on: bool) -> None:
        if on:
            other = self.actions.follow_all if mode is FollowMode.SELECTED else self.actions.follow
            other.setChecked(False)
            self.view.follow(mode)
        elif self.view.following is mode:
            self.view.follow(FollowMode.NOBODY)

    def _connect_or_not(self, connect: bool) -> None:
        self.desk.messages.end(CONNECTING)
        if not connect:
            self.desk.close_link()
            return
        panel = self.dock.connection_panel
        try:
            known = self._gateways.of(panel.url())
            self.desk.open_link(panel.url(), panel.operator(), panel.credentials(), known)
        except FleetError as error:
            self.desk.messages.post(str(error), Level.ERROR, CONNECTING)
            self._show_link()
            return
        try:
            panel.remember()
        except FleetError as error:
            self.notices.warning(str(error))

    def _keep_gateways(self, gateways: FleetGateways) -> None:
        self._gateways.keep(self.desk.state.url, gateways)

    def _show_link(self) -> None:
        link = self.desk.state.link
        is_open = link.phase not in (ConnectionPhase.CLOSED, ConnectionPhase.FAILED)
        self.actions.connect.setChecked(is_open)
        self.actions.connect.setText(tr("Disconnect") if is_open else tr("Connect"))
        if link.phase is ConnectionPhase.FAILED:
            self.desk.messages.post(link.reason, Level.ERROR, OUTAGE)
        elif link.phase is ConnectionPhase.RETRYING and link.reason not in self._reasons:
            # The panel keeps showing it; the message bar shows it once for each outage and gateway.
            self._reasons.add(link.reason)
            self.desk.messages.post(link.reason, Level.WARNING, OUTAGE)
        if not link.reason:
            self._reasons.clear()
            self.desk.messages.end(OUTAGE)

    def _show_emergency(self) -> None:
        if not self.dock.banner.isHidden() and not self.dock.isUserVisible():
            self.dock.setUserVisible(True)

    def _ask_for_ways(self) -> None:
        dialog = RoutePreferencesDialog(self._road_route.preferences, self._iface.mainWindow())
        dialog.confirmed.connect(self._road_route.set_preferences)
        dialog.open()

    def _ask_to_clear(self) -> None:
        report = self.desk.state.emergency
        if report is None or not report.in_force:
            self.desk.warning.emit(tr("No emergency stop is in force."))
        else:
            dialog = ClearDialog(report, self._iface.mainWindow())
            dialog.confirmed.connect(self.desk.clear_emergency)
            self.dock.banner.changed.connect(dialog.show_state)
            dialog.show_state(self.dock.banner.text())
            dialog.open()


class QuitGuard(QgsApplicationExitBlockerInterface):
    """Asks for confirmation when QGIS is left, in whatever way, before the gateway has answered a request.

    :meth:`remove` undoes the constructor.
    """

    def __init__(self, iface: QgisInterface, requests: RequestTracker):
        super().__init__()
        self._iface, self._requests = iface, requests
        self._window: QMainWindow = iface.mainWindow()
        self._dialog: QuestionDialog | None = None
        self._is_confirmed = False
        iface.registerApplicationExitBlocker(self)

    def remove(self) -> None:
        """Stop asking, and close the dialog."""
        self._iface.unregisterApplicationExitBlocker(self)
        if self._dialog is not None:
            self._dialog.reject()

    def allowExit(self) -> bool:
        asked = self._requests.unanswered
        if self._is_confirmed or not asked:
            return True
        if self._dialog is None:
            self._ask(asked)
        return False

    def _ask(self, asked: list[str]) -> None:
        self._dialog = dialog = QuestionDialog(
            "fleet_quit_dialog",
            tr("Quit before the gateway has answered?"),
            ("fleet_quit_confirm", tr("Quit all the same")),
            ("fleet_quit_stay", tr("Stay")),
            is_safe=True,
            parent=self._window,
        )
        dialog.add_text(
            tr(
                "The gateway has not answered yet: {asked}. Who quits now does not learn whether it is done, "
                "and what is not sent yet never is.",
                asked="; ".join(first_of(asked, MOST_ASKED)),
            )
        )
        dialog.lay_out()
        dialog.finished.connect(self._forget_dialog)
        dialog.accepted.connect(self._quit)
        dialog.open()

    def _forget_dialog(self) -> None:
        self._dialog = None

    def _quit(self) -> None:
        # QGIS may ask in turn whether to save, and stay.
        self._is_confirmed = True
        self._window.close()
        self._is_confirmed = False


class WindowAlarms(QObject):
    """Adds the alarms to the lists of the Fleet panel. :meth:`remove` undoes the constructor."""

    def __init__(self, iface: QgisInterface, window: FleetWindow, surfaces: SurfaceStore):
        super().__init__(window)
        self._window = window
        self.watch = AlarmWatch(
            window.desk.state, window.desk.site_to_canvas, window.desk.beat, surfaces, self
        )
        self.panel = AlarmPanel(self.watch)
        self.bar = AlarmBar(iface.messageBar(), self.watch, self)
        self._tabs = window.dock.tabs
        self._tabs.add_page(self.panel, tr("Alarms"), counts=True)
        window.dock.details.show_alarms_of(self.watch.board)
        self.watch.changed.connect(self._changed)
        self.panel.robots_requested.connect(self._go)
        self.panel.counted.connect(self._count)
        self.bar.requested.connect(self._show)

    def remove(self) -> None:
        """Stop watching and remove panel and message."""
        self.bar.remove()
        self.watch.remove()
        self.panel.remove()
        self._window.dock.details.show_alarms_of(None)
        self._tabs.removeTab(self._tabs.indexOf(self.panel))
        self.panel.deleteLater()
        self.deleteLater()

    def _changed(self) -> None:
        alarms = self.watch.board.alarms()
        robots = {name for alarm in alarms for name in (alarm.robot, alarm.other) if name}
        self._window.dock.robots.mark_troubled(robots)
        limits = self.watch.board.limits
        judged = AlarmLimits(limits.low_battery, limits.unsure, limits.outside_margin)
        self._window.desk.view.watch_alarms(sorted(robots), judged)

    def _count(self, new: int) -> None:
        self._tabs.show_count(self.panel, tr("Alarms"), new)
        self._tabs.show_colour(self.panel, alarm_colour(True) if new else None)

    def _go(self, robots: list[str]) -> None:
        self._window.desk.selection.select_all(robots)
        self._window.view.zoom_to(*robots)

    def _show(self) -> None:
        self._window.dock.setUserVisible(True)
        self._tabs.setCurrentWidget(self.panel)


# --- Project of the site: whether the open one matches the gateway's site, and published sites dropped in ---

SAME_PLACE = 0.01
"""Metres up to which two origins are the same."""
SAME_ANGLE = 1e-6
"""Radians up to which two rotations are the same."""


class ProjectMatch(QObject):
    """Warns of a project whose variables have another site frame than the site that is served.

    Robots are shown in the right places even so; but the checks before a command is sent, and the alarms,
    use the project's own roads, keepouts and obstacles.
    """

    differs = pyqtSignal(str)
    """The warning for the operator."""
    over = pyqtSignal(str)
    """The warning is no longer true."""

    def __init__(self, state: FleetState, project: QgsProject, parent: QObject | None = None):
        super().__init__(parent)
        self._state, self._project = state, project
        self._posted = ""
        self._watch = ProjectWatch(project, self)
        self._watch.opened.connect(self._compare)
        state.site_changed.connect(self._compare)

    def remove(self) -> None:
        """Stop comparing."""
        self._watch.remove()

    def _compare(self) -> None:
        if self._posted:
            self.over.emit(self._posted)
        self._posted = ""
        site, mine = self._state.site, own_frame(self._project)
        if site is None or mine is None or _is_one(mine, frame_of(site)):
            return
        self._posted = tr(
            "This project is not that of site {site}: its variables have another origin, CRS or rotation. "
            "Checks and alarms go by the layers of this project: open the site's.",
            site=site.name,
        )
        self.differs.emit(self._posted)


def _is_one(a: SiteFrame, b: SiteFrame) -> bool:
    crs = [QgsCoordinateReferenceSystem(frame.crs) for frame in (a, b)]
    turned = math.remainder(a.rotation - b.rotation, math.tau)
    return crs[0] == crs[1] and math.dist(a.origin, b.origin) < SAME_PLACE and abs(turned) < SAME_ANGLE


WHOLE = ("directory", "collection")
"""The browser panel's types of a folder, and of a GeoPackage with all its layers."""


class SiteDropHandler(QgsCustomDropHandler):
    """Handles a site's folder, its site.toml or its site.gpkg; everything else is left to QGIS.

    :meth:`remove` undoes the constructor.
    """

    def __init__(self, iface: QgisInterface, project: QgsProject, notices: MessageBar):
        super().__init__()
        self._iface, self._project, self._notices = iface, project, notices
        iface.registerCustomDropHandler(self)

    def remove(self) -> None:
        """Stop handling drops."""
        self._iface.unregisterCustomDropHandler(self)
        self.deleteLater()

    def handleMimeDataV2(self, data: QMimeData) -> bool:
        # Not as files: items of the browser panel name data sources.
        sources = QgsMimeDataUtils.decodeUriList(data) if QgsMimeDataUtils.isUriList(data) else []
        folders = [site_folder(Path(one.uri)) for one in sources if one.layerType in WHOLE]
        if not folders or None in folders or len(folders) < len(sources):
            return False
        for folder in folders:
            self._load(folder)
        return True

    def handleFileDrop(self, file: str) -> bool:
        folder = site_folder(Path(file))
        if folder is None:
            return False
        self._load(folder)
        return True

    def _load(self, folder: Path) -> None:
        """Load the site, or report why not."""
        known = loaded_already(folder, self._project)
        if known:
            names = ", ".join(layer.name() for layer in known)
            self._notices.info(
                tr("The site in {folder} is in the project already: {names}.", folder=folder, names=names)
            )
            return
        was_empty = not self._project.mapLayers()
        try:
            site = load_site(folder, self._project)
        except FleetError as error:
            self._notices.error(error)
            return
        self._notices.info(_in_words(site))
        if was_empty:
            # QGIS is about to switch to the site's CRS; an extent set before would be small then.
            QTimer.singleShot(0, self._iface.mapCanvas().zoomToFullExtent)


def _in_words(site: LoadedSite) -> str:
    text = tr_count(len(site.layers), "{site}: 1 layer loaded.", "{site}: %n layers loaded.", site=site.name)
    if site.without_role:
        text += tr(
            " Without a role, since other layers of the project have it: {layers}. Plugins > Fleet "
            "Supervisor > Layer roles changes that.",
            layers=", ".join(site.without_role),
        )
    return text
