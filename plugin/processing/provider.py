"""The Processing provider ``fleet``."""

from pathlib import Path

from qgis.core import QgsProcessingProvider
from qgis.PyQt.QtGui import QIcon

from .algorithms.as_placed_report import AsPlacedReport
from .algorithms.assign_cones import AssignCones
from .algorithms.cone_layouts import ConeLayout, ImportConeLayout
from .algorithms.export_navigation_map import ExportNavigationMap
from .algorithms.export_road_network import ExportRoadNetwork
from .algorithms.export_robot_map import ExportRobotMap
from .algorithms.export_robot_map_tiles import ExportRobotMapTiles
from .algorithms.import_navigation_map import ImportNavigationMap
from .algorithms.publish_site import PublishSite
from .algorithms.read_robot_maps import CheckRobotMap, LoadRobotMap
from .algorithms.road_network import BuildRoadNetwork, CheckRoadNetwork, FindRoute
from .algorithms.road_surfaces import BuildRoadSurfaces, SurfaceAtPoint
from .algorithms.trajectories import Trajectories

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
