"""How the robots of an assignment get from place to place: along roads, or straight where none are given."""

from __future__ import annotations

from collections.abc import Callable

from qgis.core import (
    QgsCoordinateReferenceSystem,
    QgsProcessingAlgorithm,
    QgsProcessingContext,
    QgsProcessingFeedback,
    QgsProcessingParameterDefinition,
)

from ...robot_bridge.assignment.job import Job
from ...robot_bridge.assignment.road_travel import RoadTravel
from ...robot_bridge.assignment.travel import StraightTravel, Travel
from ...robot_bridge.roads.network import Network
from ...robot_bridge.roads.routes import Router
from ..language import tr
from .driving_wishes import driving_wishes, length_parameters, surfaces_parameter
from .errors import ParameterError
from .fleet_algorithm import Parameters
from .job_source import CONES, ROBOTS, JobSource, layers_crs
from .keepout_areas import KeepoutAreas, keepout_parameter
from .road_source import ROADS, RoadSource, network_of_roads, repair_parameter, road_parameters
from .site_crs_choice import chosen_crs


def travel_parameters() -> list[QgsProcessingParameterDefinition]:
    """Return the parameters that say which roads may be driven, and how."""
    roads, tolerance, *others = road_parameters()
    roads.setDescription(tr("Road centrelines (default: straight lines)"))
    made = [
        surfaces_parameter(),
        keepout_parameter(),
        *length_parameters(),
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
        self._wishes = driving_wishes(algorithm, parameters, context)
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
        reading.warnings += self._wishes.doubts(reading.roads)
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
        wishes = self._wishes
        if self._network is None:
            return StraightTravel(job, wishes.driving.spacing)
        router = Router(self._network)
        progress(0.0)
        self._keepouts.close(router, crs, feedback)
        return RoadTravel(job, router, wishes.driving, wishes.restrictions, wishes.reach, progress)
