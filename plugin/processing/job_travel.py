"""How the robots of an assignment get from place to place: along roads, or straight where none are given."""

from __future__ import annotations

from collections.abc import Callable

from qgis.core import (
    QgsCoordinateReferenceSystem,
    QgsProcessing,
    QgsProcessingAlgorithm,
    QgsProcessingContext,
    QgsProcessingFeedback,
    QgsProcessingParameterDefinition,
    QgsProcessingParameterMultipleLayers,
    QgsProcessingParameterNumber,
    QgsProcessingParameterString,
)

from ...robot_bridge.assignment.job import Job
from ...robot_bridge.assignment.road_travel import RoadTravel
from ...robot_bridge.assignment.travel import StraightTravel, Travel
from ...robot_bridge.roads.dense import Driving
from ...robot_bridge.roads.keepouts import edges_through
from ...robot_bridge.roads.network import Network
from ...robot_bridge.roads.routes import REACH, Restrictions, Router
from ...robot_bridge.sites.frame import SiteFrame
from ..language import tr
from ..sites.ground_reading import read_areas
from ..sites.obstacle_source import obstacle_sources
from ..sites.placing import SitePlacing
from ..sites.roles import KEEPOUT, LayerExpressions
from ..sites.site_crs import site_crs_for
from .errors import ParameterError
from .fleet_algorithm import Parameters
from .job_source import CONES, ROBOTS, JobSource, layers_crs
from .map_window import SITE_CRS
from .road_source import ROADS, RoadSource, network_of_roads, repair_parameter, road_parameters

SURFACES, KEEPOUTS = "SURFACES", "KEEPOUTS"
_REAL = QgsProcessingParameterNumber.Type.Double
_DRIVING = Driving()
_LENGTHS = {
    "LEAST_WIDTH": (tr("Roads at least this wide [m]"), 0.0, 0.0),
    "DISTANCE": (tr("Cones, robots and stores at most this far from a road [m]"), REACH, 0.0),
    "SPACING": (tr("Points of the paths at most this far apart [m]"), _DRIVING.spacing, 0.01),
    "TURNING_RADIUS": (tr("Turning radius of the robots [m]"), _DRIVING.turning_radius, 0.0),
    "ROBOT_WIDTH": (tr("Width of the robots [m]"), _DRIVING.robot_width, 0.0),
}


def travel_parameters() -> list[QgsProcessingParameterDefinition]:
    """Return the parameters that say which roads may be driven, and how."""
    roads, tolerance, *others = road_parameters()
    roads.setDescription(tr("Road centrelines (default: straight lines)"))
    areas = QgsProcessing.SourceType.TypeVectorPolygon
    made = [
        QgsProcessingParameterString(SURFACES, tr("Surfaces that may be used (default: all)"), optional=True),
        QgsProcessingParameterMultipleLayers(
            KEEPOUTS, tr("Areas that no road leads through"), areas, optional=True
        ),
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
        layers = algorithm.parameterAsLayerList(parameters, KEEPOUTS, context)
        expressions = algorithm.createExpressionContext(parameters, context)
        self._keepouts = obstacle_sources(layers, LayerExpressions(), expressions) if layers else []
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
        algorithm, parameters, context = self._algorithm, self._parameters, self._context
        chosen = algorithm.parameterAsCrs(parameters, SITE_CRS, context)
        if parameters.get(SITE_CRS) and not chosen.isValid():
            given = parameters[SITE_CRS]
            raise ParameterError(
                tr(
                    "SITE_CRS {given} is no CRS that QGIS knows: write a code such as EPSG:32633.",
                    given=given,
                )
            )
        own = layers_crs([jobs.source(CONES), jobs.source(ROBOTS)])
        if not chosen.isValid() and own and own[0].isValid() and not own[0].isGeographic():
            chosen = own[0]
        project = context.project()
        crs = site_crs_for(
            chosen, project.crs() if project is not None else QgsCoordinateReferenceSystem(), own
        )
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
        self._close(router, crs, feedback)
        return RoadTravel(job, router, driving, wanted, value["DISTANCE"], progress)

    def _close(
        self, router: Router, crs: QgsCoordinateReferenceSystem, feedback: QgsProcessingFeedback
    ) -> None:
        if not self._keepouts:
            return
        site = SitePlacing(crs, SiteFrame(crs.authid(), (0.0, 0.0)), self._context.transformContext())
        areas = read_areas(self._keepouts, site, KEEPOUT, feedback)
        for warning in areas.warnings:
            feedback.pushWarning(warning)
        closed = edges_through(router.network, [area.rings for area in areas.items])
        router.close(closed.tolist())
        feedback.pushInfo(tr("{closed} edges lead through keepouts and are not used", closed=len(closed)))
