"""The plugin: builds its parts when QGIS loads it and takes every one of them out again."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from qgis.core import QgsApplication, QgsProject

from .expressions.functions import ExpressionFunctions
from .expressions.robot_snapshot import SnapshotHolder
from .layers.road_surfaces import SurfaceStore
from .processing.provider import FleetProvider
from .ui.language import Language

if TYPE_CHECKING:  # qgis_process has no window, and needs nothing of what one is made of
    from qgis.gui import QgisInterface


class FleetPlugin:
    """What QGIS holds of the plugin.

    ``initProcessing`` is all that ``qgis_process`` calls; ``initGui`` adds what needs a window.
    """

    def __init__(self, iface: QgisInterface | None, language: Language | None = None):
        self._iface = iface
        self._language = language
        self._provider = None
        self._surfaces = None
        self._functions = None
        self._fleet = SnapshotHolder()
        self._window = None
        self._parts = []

    @property
    def window(self):
        """The desk in the QGIS window, None before ``initGui`` and after ``unload``."""
        return self._window

    def initProcessing(self):
        provider = FleetProvider()
        # The registry deletes a provider that it does not take, as when two copies of the plugin are loaded.
        if QgsApplication.processingRegistry().addProvider(provider):
            self._provider = provider
        self._surfaces = SurfaceStore(QgsProject.instance())
        self._functions = ExpressionFunctions(self._surfaces, self._fleet)

    def initGui(self):
        try:
            self.initProcessing()
            if self._iface is not None:
                self._open_desk()
        except Exception:
            # QGIS forgets a plugin that does not start; what it had put into QGIS by then would stay.
            self.unload()
            raise

    def _open_desk(self):
        # Only here, for qgis_process.
        from .admin.accounts_dialog import AccountsAction
        from .admin.recordings import RecordingsAction
        from .admin.robot_removal import RobotRemoval
        from .admin.site_choice import SiteChoiceAction
        from .expressions.robot_snapshot import ExpressionUpdater
        from .help import HelpActions
        from .layers.live_layers import LiveLayers
        from .layers.role_editor.roles_dialog import RolesAction
        from .locator import RobotLocator
        from .map.site_project import SiteDropHandler
        from .map.tools.surface_tool import SurfaceAction
        from .observations.observation_dock import ObservationsAction
        from .options_page import OptionsFactory
        from .panel.window import MENU, FleetWindow, WindowAlarms
        from .planning.layouts.layout_tool import LayoutAction
        from .planning.plan_dock import PlansAction
        from .replay.replay_dock import ReplayAction
        from .tour.tour_panel import TourAction
        from .ui.actions import MenuLetters, PluginMenu, Shortcuts

        iface, project, add = self._iface, QgsProject.instance(), self._add
        # The first ones, so that they go last: everything else has left menu and project by then.
        add(PluginMenu(iface.mainWindow(), MENU))
        add(LiveLayers(project))
        window = self._window = add(FleetWindow(iface))
        alarms = add(WindowAlarms(iface, window, self._surfaces))
        connections = window.dock.connection_panel.menu
        add(ExpressionUpdater(window.desk, self._fleet))
        add(OptionsFactory(iface, window, alarms.watch))
        add(RobotLocator(iface, self._fleet, window))
        add(SiteDropHandler(iface, project, window.notices))
        add(HelpActions(iface, MENU, window.dock))
        add(RolesAction(iface, MENU))
        add(LayoutAction(iface, MENU, window.notices))
        add(SurfaceAction(iface, MENU, self._surfaces, window.notices))
        add(PlansAction(iface, MENU, window.desk))
        add(ObservationsAction(iface, MENU, window.desk))
        add(ReplayAction(iface, MENU, window.desk))
        add(RecordingsAction(iface, MENU, connections, window.desk))
        add(AccountsAction(iface, MENU, connections, window.desk))
        add(SiteChoiceAction(iface, MENU, connections, window.desk))
        add(RobotRemoval(iface, MENU, connections, window.desk, window.dock.table))
        add(TourAction(iface, MENU, window))
        others = [part.action for part in self._parts if hasattr(part, "action")]
        # The last ones, so that they go first: while every action is still there.
        add(Shortcuts(iface.mainWindow(), [*window.actions.all(), *others]))
        for menu in ([*window.menu_entries(), *others], window.actions.for_drafts):
            # Letters may run out in a long menu: what has no key gets one first.
            add(MenuLetters(sorted(menu, key=lambda entry: not entry.shortcut().isEmpty())))

    def _add(self, part: Any):
        self._parts.append(part)
        return part

    def unload(self):
        while self._parts:
            self._parts.pop().remove()
        self._window = None
        if self._functions is not None:
            self._functions.remove()
            self._functions = None
            self._surfaces.remove()
            self._surfaces = None
        if self._provider is not None:
            QgsApplication.processingRegistry().removeProvider(self._provider)
            self._provider = None
        if self._language is not None:
            self._language.remove()
            self._language = None
