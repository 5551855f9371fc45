"""The plugin: builds its parts when QGIS loads it and removes all of them when it is unloaded."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

from qgis.core import QgsApplication, QgsProcessingProvider, QgsProject
from qgis.PyQt.QtGui import QIcon

from .expressions import ExpressionFunctions, SnapshotHolder
from .layers.road_surfaces import SurfaceStore
from .processing.algorithms.as_placed_report import AsPlacedReport
from .processing.algorithms.assign_cones import AssignCones
from .processing.algorithms.cone_layouts import ConeLayout, ImportConeLayout
from .processing.algorithms.export_navigation_map import ExportNavigationMap
from .processing.algorithms.export_road_network import ExportRoadNetwork
from .processing.algorithms.export_robot_map import ExportRobotMap
from .processing.algorithms.export_robot_map_tiles import ExportRobotMapTiles
from .processing.algorithms.import_navigation_map import ImportNavigationMap
from .processing.algorithms.publish_site import PublishSite
from .processing.algorithms.read_robot_maps import CheckRobotMap, LoadRobotMap
from .processing.algorithms.road_network import BuildRoadNetwork, CheckRoadNetwork, FindRoute
from .processing.algorithms.road_surfaces import BuildRoadSurfaces, SurfaceAtPoint
from .processing.algorithms.trajectories import Trajectories
from .ui.errors import Part, remove_all
from .ui.language import Language

if TYPE_CHECKING:  # qgis_process has no window, and needs nothing of what one is made of
    from qgis.gui import QgisInterface

ICON = Path(__file__).parents[1] / "resources" / "icons" / "fleet.svg"


class FleetProvider(QgsProcessingProvider):
    """Groups the plugin's algorithms in the Processing toolbox and in ``qgis_process``."""

    def id(self):
        return "fleet"

    def name(self):
        return "Fleet"

    def icon(self):
        return QIcon(str(ICON))

    def loadAlgorithms(self):
        self.addAlgorithm(ExportRobotMap())
        self.addAlgorithm(ExportNavigationMap())
        self.addAlgorithm(ImportNavigationMap())
        self.addAlgorithm(PublishSite())
        self.addAlgorithm(ExportRobotMapTiles())
        self.addAlgorithm(LoadRobotMap())
        self.addAlgorithm(CheckRobotMap())
        self.addAlgorithm(BuildRoadNetwork())
        self.addAlgorithm(CheckRoadNetwork())
        self.addAlgorithm(FindRoute())
        self.addAlgorithm(ExportRoadNetwork())
        self.addAlgorithm(BuildRoadSurfaces())
        self.addAlgorithm(SurfaceAtPoint())
        self.addAlgorithm(ConeLayout())
        self.addAlgorithm(ImportConeLayout())
        self.addAlgorithm(AssignCones())
        self.addAlgorithm(Trajectories())
        self.addAlgorithm(AsPlacedReport())


class RegisteredProvider:
    """The provider of algorithms, while the plugin is loaded."""

    def __init__(self, provider: FleetProvider):
        # The registry deletes a provider that it rejects, as when two copies of the plugin are loaded.
        is_taken = QgsApplication.processingRegistry().addProvider(provider)
        self._provider = provider if is_taken else None

    def remove(self) -> None:
        """Remove the provider, which QGIS deletes."""
        if self._provider is not None:
            QgsApplication.processingRegistry().removeProvider(self._provider)


class FleetPlugin:
    """The plugin's entry point for QGIS.

    ``initProcessing`` is all that ``qgis_process`` calls; ``initGui`` adds the parts that need a window.
    """

    def __init__(self, iface: QgisInterface | None, language: Language | None = None):
        self._iface = iface
        self._fleet = SnapshotHolder()
        self._window = None
        self._parts: list[Part] = [] if language is None else [language]
        """The parts built, in order; :meth:`unload` removes them in reverse order."""

    @property
    def window(self):
        """The desk in the QGIS window, None before ``initGui`` and after ``unload``."""
        return self._window

    def initProcessing(self):
        self._add(RegisteredProvider(FleetProvider()))
        self._surfaces = self._add(SurfaceStore(QgsProject.instance(), has_window=self._iface is not None))
        self._add(ExpressionFunctions(self._surfaces, self._fleet))

    def initGui(self):
        try:
            self.initProcessing()
            if self._iface is not None:
                self._open_desk(self._iface, QgsProject.instance())
        except Exception:
            # QGIS drops a plugin that fails to start; its parts already in QGIS would stay.
            self.unload()
            raise

    def unload(self):
        self._window = self._surfaces = None
        remove_all(self._parts)

    def _open_desk(self, iface: QgisInterface, project: QgsProject):
        # Imported only here, for qgis_process.
        from .admin.accounts_dialog import AccountsAction
        from .admin.supervision import RecordingsAction, RobotRemoval, SiteChoiceAction
        from .expressions import ExpressionUpdater
        from .help import HelpActions
        from .layers.live_layers import LiveLayers
        from .layers.role_editor.roles_dialog import RolesAction
        from .locator import RobotLocator
        from .map.tools.road_tools import SurfaceAction
        from .observations.observation_dock import ObservationsAction
        from .options_page import OptionsFactory
        from .panel.window import MENU, FleetWindow, SiteDropHandler, WindowAlarms
        from .planning.layouts.layout_tool import LayoutAction
        from .planning.plan_dock import PlansAction
        from .replay.replay_dock import ReplayAction
        from .tour.tour_panel import TourAction
        from .ui.actions import FailedStart, MenuLetters, PluginMenu, Shortcuts, emergency_keys_in, keys_in

        main = iface.mainWindow()
        # Before it contains the plugin's own widgets, which are thousands.
        taken = keys_in(main)
        # The first ones, so that they are removed last: everything else has left menu and project by then.
        start = self._add(FailedStart(main, iface.mapCanvas()))
        self._add(PluginMenu(main, MENU))
        self._add(LiveLayers(project))
        window = self._window = self._add(FleetWindow(iface))
        alarms = self._add(WindowAlarms(iface, window, self._surfaces))
        desk, notices, connections = window.desk, window.notices, window.dock.connection_panel.menu
        for part, *needs in (
            (ExpressionUpdater, desk.state, desk.view, desk.beat, self._fleet),
            (OptionsFactory, iface, window, alarms.watch),
            (RobotLocator, iface, self._fleet, desk, window),
            (SiteDropHandler, iface, project, notices),
            (HelpActions, iface, MENU, window.dock),
            (RolesAction, iface, MENU),
            (LayoutAction, iface, MENU, notices),
            (SurfaceAction, iface, MENU, self._surfaces, notices),
            (PlansAction, iface, MENU, desk, window.view),
            (ObservationsAction, iface, MENU, desk),
            (ReplayAction, iface, MENU, desk),
            (RecordingsAction, iface, MENU, connections, desk),
            (AccountsAction, iface, MENU, connections, desk),
            (SiteChoiceAction, iface, MENU, connections, desk),
            (RobotRemoval, iface, MENU, connections, desk, window.dock.table),
            (TourAction, iface, MENU, window),
        ):
            self._add(part(*needs))
        others = [part.action for part in self._parts if hasattr(part, "action")]
        # The last ones, so that they are removed first: while every action still exists.
        self._add(Shortcuts(main, [*window.actions.all(), *others], taken))
        for menu in ([*window.menu_entries(), *others], window.actions.for_drafts):
            # Letters may run out in a long menu: entries without a shortcut get one first.
            self._add(MenuLetters(sorted(menu, key=lambda entry: not entry.shortcut().isEmpty())))
        for text in emergency_keys_in(taken):
            notices.warning(text)
        start.finish()

    def _add(self, part: Any):
        self._parts.append(part)
        return part
