"""How the robots of an assignment get from place to place: along roads, or straight where none are given."""

from __future__ import annotations

from collections.abc import Callable

from qgis.core import (
    QgsCoordinateReferenceSystem,
    QgsProcessingAlgorithm,
    QgsProcessingContext,
    QgsProcessingFeedback,
    QgsProcessingParameterDefinition,
    QgsProcessingParameterNumber,
    QgsProcessingParameterString,
)

from ...robot_bridge.assignment.job import Job
from ...robot_bridge.assignment.road_travel import RoadTravel
from ...robot_bridge.assignment.travel import StraightTravel, Travel
from ...robot_bridge.roads.dense import Driving
from ...robot_bridge.roads.network import Network
from ...robot_bridge.roads.routes import REACH, Restrictions, Router
from ..language import tr
from .errors import ParameterError
from .fleet_algorithm import Parameters
from .job_source import CONES, ROBOTS, JobSource, layers_crs
from .keepout_areas import KeepoutAreas, keepout_parameter
from .road_source import ROADS, RoadSource, network_of_roads, repair_parameter, road_parameters
from .site_crs_choice import chosen_crs

SURFACES = "SURFACES"
_REAL = QgsProcessingParameterNumber.Type.Double
_DRIVING = Driving()
_LENGTHS = {
    "LEAST_WIDTH": (tr("Roads at least this wide [m]"), 0.0, 0.0),
    "DISTANCE": (tr("Farthest place from a road [m]"), REACH, 0.0),
    "SPACING": (tr("Points of the paths at most this far apart [m]"), _DRIVING.spacing, 0.01),
    "TURNING_RADIUS": (tr("Turning radius of the robots [m]"), _DRIVING.turning_radius, 0.0),
    "ROBOT_WIDTH": (tr("Width of the robots [m]"), _DRIVING.robot_width, 0.0),
}


def travel_parameters() -> list[QgsProcessingParameterDefinition]:
    """Return the parameters that say which roads may be driven, and how."""
    roads, tolerance, *others = road_parameters()
    roads.setDescription(tr("Road centrelines (default: straight lines)"))
    made = [
        QgsProcessingParameterString(SURFACES, tr("Surfaces that may be used (default: all)"), optional=True),
        keepout_parameter(),
        *(
            QgsProcessingParameterNumber(name, title, _REAL, value, minValue=least)
            for name, (title, value, least) in _LENGTHS.items()
        ),
        repair_parameter(),
        tolerance,
        *others,
    ]
    for parameter in (roads, *made):
        optional = QgsProcessingParameterDefinition.Flag.FlagOptional
        advanced = QgsProcessingParameterDefinition.Flag.FlagAdvanced
        parameter.setFlags(parameter.flags() | (optional if parameter is roads else advanced))
    return [roads, *made]


class TravelSource:
    """The roads of one run; made in the main thread, read in any."""

    def __init__(
        self, algorithm: QgsProcessingAlgorithm, parameters: Parameters, context: QgsProcessingContext
    ) -> None:
        self._algorithm, self._parameters, self._context = algorithm, parameters, context
        given = parameters.get(ROADS) not in (None, "")
        self._roads = RoadSource(algorithm, parameters, context) if given else None
        self._keepouts = KeepoutAreas(algorithm, parameters, context)
        self._network: Network | None = None

    def open(self, jobs: JobSource, feedback: QgsProcessingFeedback) -> QgsCoordinateReferenceSystem | None:
        """Read the roads, where there are any, and return the CRS of everything; None after a cancel.

        :raises FleetError: when the roads or the CRS cannot be used.
        """
        if self._roads is None:
            feedback.pushWarning(tr("No roads are given: distances and paths are straight lines."))
            return self._crs(jobs)
        reading = self._roads.read(feedback)
        if reading is None:
            return None
        built = network_of_roads(self._algorithm, self._parameters, self._context, reading, feedback)
        if built is None or feedback.isCanceled():
            return None
        self._network, _ = built
        return reading.crs

    def _crs(self, jobs: JobSource) -> QgsCoordinateReferenceSystem:
        own = layers_crs([jobs.source(CONES), jobs.source(ROBOTS)])
        crs = chosen_crs(self._algorithm, self._parameters, self._context, own, layer_first=True)
        if not crs.isValid():
            raise ParameterError(tr("The CRS of the cones is not known: give SITE_CRS, such as EPSG:32633."))
        return crs

    def travel(
        self,
        job: Job,
        crs: QgsCoordinateReferenceSystem,
        feedback: QgsProcessingFeedback,
        progress: Callable[[float], None],
    ) -> Travel:
        """Return the ways between the places of ``job``; ``progress`` may raise to end the work.

        :raises RoadsError: when a place is too far from every road.
        """
        value = {
            name: self._algorithm.parameterAsDouble(self._parameters, name, self._context)
            for name in _LENGTHS
        }
        driving = Driving(value["SPACING"], value["TURNING_RADIUS"], value["ROBOT_WIDTH"])
        if self._network is None:
            return StraightTravel(job, driving.spacing)
        names = self._algorithm.parameterAsString(self._parameters, SURFACES, self._context).split(",")
        surfaces = frozenset(name.strip() for name in names if name.strip())
        wanted = Restrictions(False, surfaces or None, value["LEAST_WIDTH"])
        router = Router(self._network)
        progress(0.0)
        self._keepouts.close(router, crs, feedback)
        return RoadTravel(job, router, driving, wanted, value["DISTANCE"], progress)
