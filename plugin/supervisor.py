"""The plugin: builds its parts when QGIS loads it and takes every one of them out again."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from qgis.core import QgsApplication, QgsProject

from .expressions.functions import ExpressionFunctions
from .expressions.robots_now import FleetNow
from .language import Language
from .processing.provider import FleetProvider
from .sites.surface_store import SurfaceStore

if TYPE_CHECKING:  # qgis_process has no window, and needs nothing of what one is made of
    from qgis.gui import QgisInterface


class FleetSupervisor:
    """What QGIS holds of the plugin.

    ``initProcessing`` is all that ``qgis_process`` calls; ``initGui`` adds what needs a window.
    """

    def __init__(self, iface: QgisInterface | None, language: Language | None = None):
        self._iface = iface
        self._language = language
        self._provider = None
        self._surfaces = None
        self._functions = None
        self._fleet = FleetNow()
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
        from .desk.accounts.accounts_action import AccountsAction
        from .desk.layout_action import LayoutAction
        from .desk.live_layers import LiveLayers
        from .desk.menu_letters import MenuLetters
        from .desk.observations.observations_action import ObservationsAction
        from .desk.options.options_factory import OptionsFactory
        from .desk.plans.plans_action import PlansAction
        from .desk.plugin_menu import PluginMenu
        from .desk.replay.recordings_dialog import RecordingsAction
        from .desk.replay.replay_action import ReplayAction
        from .desk.robot_feed import RobotFeed
        from .desk.robots.removal import RobotRemoval
        from .desk.shortcuts import Shortcuts
        from .desk.site_choice.site_choice_action import SiteChoiceAction
        from .desk.site_drop import SiteDrop
        from .desk.surface_action import SurfaceAction
        from .desk.tour.tour_action import TourAction
        from .desk.window import MENU, DeskWindow
        from .desk.window_alarms import WindowAlarms
        from .help.help_desk import HelpDesk
        from .locator.robot_locator import RobotLocator
        from .roles.roles_action import RolesAction

        iface, project, add = self._iface, QgsProject.instance(), self._add
        # The first ones, so that they go last: everything else has left menu and project by then.
        add(PluginMenu(iface.mainWindow(), MENU))
        add(LiveLayers(project))
        window = self._window = add(DeskWindow(iface))
        alarms = add(WindowAlarms(iface, window, self._surfaces))
        connections = window.dock.connection_panel.menu
        add(RobotFeed(window.desk, self._fleet))
        add(OptionsFactory(iface, window, alarms.watch.set_limits))
        add(RobotLocator(iface, self._fleet, window.go_to))
        add(SiteDrop(iface, project, window.notices))
        add(HelpDesk(iface, MENU, window.dock))
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
