"""The Processing provider ``fleet``."""

from __future__ import annotations

from pathlib import Path

from qgis.core import QgsProcessingProvider
from qgis.PyQt.QtGui import QIcon

from .as_placed_report import AsPlacedReport
from .assign_cones import AssignCones
from .build_road_network import BuildRoadNetwork
from .build_road_surfaces import BuildRoadSurfaces
from .check_road_network import CheckRoadNetwork
from .check_robot_map import CheckRobotMap
from .cone_layout import ConeLayout
from .export_navigation_map import ExportNavigationMap
from .export_road_network import ExportRoadNetwork
from .export_robot_map import ExportRobotMap
from .export_robot_map_tiles import ExportRobotMapTiles
from .find_route import FindRoute
from .import_cone_layout import ImportConeLayout
from .import_navigation_map import ImportNavigationMap
from .load_robot_map import LoadRobotMap
from .publish_site import PublishSite
from .surface_at_point import SurfaceAtPoint
from .trajectories import Trajectories

ICON = Path(__file__).parents[2] / "resources" / "icons" / "fleet.svg"


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
