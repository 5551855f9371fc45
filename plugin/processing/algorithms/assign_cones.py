"""``fleet:assigncones``: which robot places or collects which cone, on which trip, and when."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from qgis.core import (
    QgsCoordinateReferenceSystem,
    QgsGeometry,
    QgsPointXY,
    QgsProcessing,
    QgsProcessingAlgorithm,
    QgsProcessingContext,
    QgsProcessingFeatureSource,
    QgsProcessingFeedback,
    QgsProcessingOutputNumber,
    QgsProcessingOutputString,
    QgsProcessingParameterDefinition,
    QgsProcessingParameterFeatureSink,
    QgsProcessingParameterFeatureSource,
    QgsProcessingParameterFileDestination,
    QgsProcessingParameterNumber,
    QgsProcessingParameterString,
    QgsWkbTypes,
)

from ....robot_bridge.core.assignment.job import (
    PLACE,
    TO_STORE,
    AssignmentJob,
    ConeTarget,
    PlanRobot,
    RoadTravel,
    Store,
    StraightTravel,
    Travel,
)
from ....robot_bridge.core.assignment.plan import (
    ConePlan,
    PlannedTrip,
    PlanStop,
    RobotPlan,
    check_plan,
    plan_to_json,
)
from ....robot_bridge.core.assignment.schedules import BALANCED
from ....robot_bridge.core.assignment.solver import AUTOMATIC, Objective, assign
from ....robot_bridge.core.errors import AssignmentCancelledError
from ....robot_bridge.core.geometry import theta_of
from ....robot_bridge.core.roads.network import Network
from ....robot_bridge.core.roads.routes import Router
from ...cone_texts import FINISHES, METHODS, OBJECTIVES, TASKS
from ...layers.site_transform import SiteGeoreference
from ...ui.language import tr, tr_count, tr_page
from ..common import road_sources
from ..common.algorithm import (
    FleetAlgorithm,
    ParameterError,
    Parameters,
    enum_parameter,
    fields_of,
    shown_by_processing,
)
from ..common.cone_layers import PointRow, point_rows
from ..common.outputs import check_target, fill_sink, line, write_whole
from ..common.parameters import chosen_crs

# --- Cones, robots and stores, read from point layers by field names ---

CONES, ROBOTS, STORES = "CONES", "ROBOTS", "STORES"
TASK, FINISH, STAGE_FIELD = "TASK", "FINISH", "STAGE_FIELD"
_REAL = QgsProcessingParameterNumber.Type.Double
_WHOLE = QgsProcessingParameterNumber.Type.Integer
_NAMES = ("id", "robot", "name")
"""Fields that may contain the id of a feature; the first one in the layer is used."""
_NUMBERS = {
    "CAPACITY": (tr("Cones that a robot carries (default of field capacity)"), _WHOLE, 8, 1),
    "ROBOT_SPEED": (tr("Speed of a robot [m/s] (default of field speed)"), _REAL, 1.0, 0.01),
    "RANGE": (
        tr("Metres that a robot's battery lasts, 0 for any (default of field range_m)"),
        _REAL,
        0.0,
        0.0,
    ),
    "SERVICE_TIME": (tr("Seconds to place or collect a cone (default of field service_s)"), _REAL, 10.0, 0.0),
    "STORE_TIME": (tr("Seconds of a visit to a store (default of its field service_s)"), _REAL, 30.0, 0.0),
}


def job_parameters() -> list[QgsProcessingParameterDefinition]:
    """Return the parameters of the job and its robots."""
    points = [QgsProcessing.SourceType.TypeVectorPoint]
    return [
        QgsProcessingParameterFeatureSource(CONES, tr("Cones"), points),
        QgsProcessingParameterFeatureSource(ROBOTS, tr("Robots, where they are"), points),
        QgsProcessingParameterFeatureSource(STORES, tr("Stores of cones"), points, optional=True),
        enum_parameter(TASK, tr("What is done with cones (default of field task)"), TASKS, PLACE),
        QgsProcessingParameterString(
            STAGE_FIELD, tr("Field of the stage: cones of lower ones come first"), "stage", optional=True
        ),
        *(
            QgsProcessingParameterNumber(name, title, kind, value, minValue=least)
            for name, (title, kind, value, least) in _NUMBERS.items()
        ),
        enum_parameter(FINISH, tr("Where robots go at the end"), FINISHES, TO_STORE),
    ]


class JobSource:
    """The layers of one run."""

    def __init__(
        self, algorithm: QgsProcessingAlgorithm, parameters: Parameters, context: QgsProcessingContext
    ) -> None:
        self._algorithm, self._parameters, self._context = algorithm, parameters, context

    def source(self, name: str) -> QgsProcessingFeatureSource | None:
        """Return the layer of parameter ``name``; None where it is not given.

        :raises ParameterError: when it cannot be opened.
        """
        given = self._parameters.get(name)
        source = self._algorithm.parameterAsSource(self._parameters, name, self._context)
        if source is None and given not in (None, ""):
            raise ParameterError(
                tr(
                    "{name} {given} cannot be opened: check the file and the layer's name.",
                    name=name,
                    given=given,
                )
            )
        return source

    def read(self, crs: QgsCoordinateReferenceSystem) -> AssignmentJob:
        """Return the job, with coordinates in ``crs``.

        :raises ParameterError: when a layer cannot be opened; LayerReadingError naming layer, feature and
        the invalid field; JobError when a job with these values cannot be planned.
        """
        number = {name: self._number(name) for name in _NUMBERS}
        return AssignmentJob(
            tuple(self._target(row, number) for row in self._rows(CONES, crs)),
            tuple(_robot(row, number) for row in self._rows(ROBOTS, crs)),
            tuple(
                Store(row.name, row.x, row.y, row.number("service_s", number["STORE_TIME"]))
                for row in self._rows(STORES, crs)
            ),
            self._algorithm.parameterAsEnumString(self._parameters, FINISH, self._context),
        )

    def _number(self, name: str) -> float:
        return self._algorithm.parameterAsDouble(self._parameters, name, self._context)

    def _target(self, row: PointRow, number: dict[str, float]) -> ConeTarget:
        text = self._algorithm.parameterAsString
        stage = text(self._parameters, STAGE_FIELD, self._context).strip()
        task = self._algorithm.parameterAsEnumString(self._parameters, TASK, self._context)
        return ConeTarget(
            row.name,
            row.x,
            row.y,
            theta_of(row.number("heading", 90.0)),
            row.whole(stage, 0) if stage else 0,
            str(row.values.get("task") or task),
            row.whole("demand", 1),
            row.number("service_s", number["SERVICE_TIME"]),
        )

    def _rows(self, name: str, crs: QgsCoordinateReferenceSystem) -> Iterator[PointRow]:
        source = self.source(name)
        if source is None:
            return
        site = SiteGeoreference.in_crs(crs, self._context.transformContext())
        placing = site.of_layer(source.sourceName(), source.sourceCrs())
        yield from point_rows(source.sourceName(), source.getFeatures(), placing, _NAMES)


def _robot(row: PointRow, number: dict[str, float]) -> PlanRobot:
    # A range of 0 means unlimited.
    metres = row.number("range_m", number["RANGE"]) or math.inf
    return PlanRobot(
        row.name,
        row.x,
        row.y,
        row.whole("capacity", number["CAPACITY"]),
        row.number("speed", number["ROBOT_SPEED"]),
        metres,
        row.whole("aboard", 0),
        row.whole("collected", 0),
        row.number("ready_s", 0.0),
    )


def layers_crs(sources: Sequence[QgsProcessingFeatureSource | None]) -> list[QgsCoordinateReferenceSystem]:
    """Return the CRSs of the layers that are given."""
    return [source.sourceCrs() for source in sources if source is not None]


# --- The ways of an assignment's robots from place to place: along roads, or straight where none are given


def travel_parameters() -> list[QgsProcessingParameterDefinition]:
    """Return the parameters of the roads that may be driven, and how."""
    roads, tolerance, *others = road_sources.road_parameters()
    roads.setDescription(tr("Road centrelines (default: straight lines)"))
    made = [
        road_sources.surfaces_parameter(),
        road_sources.keepout_parameter(),
        *road_sources.length_parameters(),
        road_sources.repair_parameter(),
        tolerance,
        *others,
    ]
    for parameter in (roads, *made):
        optional = QgsProcessingParameterDefinition.Flag.FlagOptional
        advanced = QgsProcessingParameterDefinition.Flag.FlagAdvanced
        parameter.setFlags(parameter.flags() | (optional if parameter is roads else advanced))
    return [roads, *made]


class TravelSource:
    """The roads of one run; created in the main thread, read in any."""

    def __init__(
        self, algorithm: QgsProcessingAlgorithm, parameters: Parameters, context: QgsProcessingContext
    ) -> None:
        self._algorithm, self._parameters, self._context = algorithm, parameters, context
        given = parameters.get(road_sources.ROADS) not in (None, "")
        self._roads = road_sources.RoadSource(algorithm, parameters, context) if given else None
        self._keepouts = road_sources.KeepoutAreas(algorithm, parameters, context)
        self._wishes = road_sources.driving_options(algorithm, parameters, context)
        self._network: Network | None = None

    def open(self, jobs: JobSource, feedback: QgsProcessingFeedback) -> QgsCoordinateReferenceSystem | None:
        """Read the roads, if given, and return the common CRS; None if cancelled.

        :raises FleetError: when the roads or the CRS cannot be used.
        """
        if self._roads is None:
            feedback.pushWarning(tr("No roads are given: distances and paths are straight lines."))
            return self._crs(jobs)
        reading = self._roads.read(feedback)
        if reading is None:
            return None
        reading.warnings += self._wishes.doubts(reading.roads)
        built = road_sources.network_of_roads(
            self._algorithm, self._parameters, self._context, reading, feedback
        )
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
        job: AssignmentJob,
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


# --- An assignment's plan as rows of layers, and its summary figures ---

_COMMON = {"robot": "string", "trip": "integer", "sequence": "integer", "kind": "string", "id": "string"}
TARGET_FIELDS = {
    **_COMMON,
    "eta_s": "double",
    "begin_s": "double",
    "end_s": "double",
    "loaded": "integer",
    "unloaded": "integer",
    "aboard": "integer",
    "collected": "integer",
}
PATH_FIELDS = {**_COMMON, "metres": "double", "start_s": "double", "eta_s": "double"}
FIGURES = {
    "END_S": tr("Seconds until the last robot has finished"),
    "SERVED_S": tr("Seconds until the last cone is done"),
    "METRES": tr("Metres of all robots"),
    "TRIP_COUNT": tr("Trips"),
    "ROBOT_COUNT": tr("Robots that drive"),
}

Rows = list[tuple[QgsGeometry, list[Any]]]


def _stops(plan: ConePlan) -> Iterator[tuple[RobotPlan, PlannedTrip, int, PlanStop]]:
    for one in plan.robots:
        sequence = 0
        for trip in one.trips:
            for stop in trip.stops:
                sequence += 1
                yield one, trip, sequence, stop


def target_rows(plan: ConePlan) -> Rows:
    """Return a point for each stop, with the values of ``TARGET_FIELDS``."""
    return [
        (
            QgsGeometry.fromPointXY(QgsPointXY(stop.x, stop.y)),
            [
                *_common(one, trip, sequence, stop),
                *(round(value, 2) for value in (stop.arrival_s, stop.begin_s, stop.end_s)),
                stop.loaded,
                stop.unloaded,
                stop.aboard,
                stop.collected,
            ],
        )
        for one, trip, sequence, stop in _stops(plan)
    ]


def path_rows(plan: ConePlan) -> Rows:
    """Return the way to each stop, with the values of ``PATH_FIELDS``."""
    return [
        (
            line(np.array(stop.path)),
            [
                *_common(one, trip, sequence, stop),
                round(stop.metres, 3),
                round(stop.arrival_s - stop.metres / one.robot.speed, 2),
                round(stop.arrival_s, 2),
            ],
        )
        for one, trip, sequence, stop in _stops(plan)
    ]


def _common(one: RobotPlan, trip: PlannedTrip, sequence: int, stop: PlanStop) -> list:
    return [one.robot.id, trip.number, sequence, stop.kind, stop.id]


def figures(plan: ConePlan) -> dict[str, float]:
    """Return the values of ``FIGURES``."""
    driving = [one for one in plan.robots if one.stops]
    trips = sum(len(one.trips) for one in driving)
    values = (plan.end_s, plan.served_s, plan.metres, trips, len(driving))
    return dict(zip(FIGURES, values, strict=True))


# --- ``fleet:assigncones``: which robot places or collects which cone, on which trip, and when ---

OBJECTIVE, METHOD, TIME_LIMIT = "OBJECTIVE", "METHOD", "TIME_LIMIT"
TARGETS, PATHS, PLAN = "TARGETS", "PATHS", "PLAN"
METHOD_USED, TRAVEL_USED = "METHOD_USED", "TRAVEL_USED"
_READ, _MEASURED, _SOLVED = 15.0, 40.0, 95.0
"""Percentage of the work after reading, after distances, and after planning."""


class AssignCones(FleetAlgorithm):
    """Plans which robot serves which cone."""

    GROUP = ("cones", tr("Cones"))
    NAME = "assigncones"
    TITLE = tr("Assign cones to robots")
    SUMMARY = tr(
        "Plans which robot places or collects which cone, on which trip, along which roads, and when."
    )
    ICON = "assign_cones.svg"
    TAGS = ("cone", "assignment", "vehicle routing", "plan", "fleet", "trips")
    STYLES = {TARGETS: "assigned_targets.qml", PATHS: "assigned_paths.qml"}  # noqa: RUF012
    HELP = tr_page("""
    <p>Shares <b>cones</b> out among <b>robots</b>. Robots load cones to place, and unload collected ones, at
    <b>stores</b>, as often as their capacity asks for. Distances are those of the <b>roads</b>; without roads
    they are straight lines, and the log says so.</p>
    <p>Fields that layers may have, with the parameters as defaults: cones <i>id, heading, stage, task</i>
    (place or collect), <i>demand, service_s</i>; robots <i>id, capacity, speed, range_m, aboard, collected,
    ready_s</i>; stores <i>id, service_s</i>. Every cone of a lower <b>stage</b> is done before one of a
    higher stage is begun.</p>
    <p><b>Objective</b>: <i>balanced</i> has the last robot finish as early as possible, <i>distance</i>
    drives the fewest metres in all. <b>Method</b>: <i>pyvrp</i> works until the time limit is over,
    <i>preview</i> is quick; <i>automatic</i> takes pyvrp where Python has it.</p>
    <p><b>Targets</b> are the stops of each robot in order with their times, <b>paths</b> the ways between
    them, <b>plan</b> is all of it as JSON. A cone that cannot be served is named, and nothing is written.</p>
    <pre>qgis_process run fleet:assigncones -- CONES=cones.gpkg ROBOTS=robots.gpkg STORES=stores.gpkg
    ROADS=roads.gpkg CAPACITY=8 TIME_LIMIT=10 TARGETS=targets.gpkg PATHS=paths.gpkg PLAN=plan.json</pre>
    """)

    def initAlgorithm(self, configuration: dict[str, Any] | None = None):
        cones, robots, stores, *others = job_parameters()
        roads, *driving = travel_parameters()
        for parameter in (
            cones,
            robots,
            stores,
            roads,
            *others,
            enum_parameter(OBJECTIVE, tr("Objective"), OBJECTIVES, BALANCED),
            enum_parameter(METHOD, tr("Method"), METHODS, AUTOMATIC),
            QgsProcessingParameterNumber(
                TIME_LIMIT, tr("Time limit [s]"), QgsProcessingParameterNumber.Type.Double, 10.0, minValue=0.1
            ),
            *driving,
        ):
            self.addParameter(parameter)
        kinds = QgsProcessing.SourceType
        self.addParameter(QgsProcessingParameterFeatureSink(TARGETS, tr("Targets"), kinds.TypeVectorPoint))
        self.addParameter(QgsProcessingParameterFeatureSink(PATHS, tr("Paths"), kinds.TypeVectorLine))
        self.addParameter(
            QgsProcessingParameterFileDestination(PLAN, tr("Plan"), tr("JSON (*.json)"), optional=True)
        )
        for name, title in FIGURES.items():
            self.addOutput(QgsProcessingOutputNumber(name, title))
        self.addOutput(QgsProcessingOutputString(METHOD_USED, tr("Method that was used")))
        self.addOutput(QgsProcessingOutputString(TRAVEL_USED, tr("What the ways follow")))

    def prepareAlgorithm(
        self, parameters: Parameters, context: QgsProcessingContext, feedback: QgsProcessingFeedback
    ):
        self._fields = fields_of(TARGET_FIELDS), fields_of(PATH_FIELDS)
        with shown_by_processing():
            self._travel = TravelSource(self, parameters, context)
        return True

    def processAlgorithm(
        self, parameters: Parameters, context: QgsProcessingContext, feedback: QgsProcessingFeedback
    ):
        with shown_by_processing(feedback):
            try:
                return self._run(parameters, context, feedback)
            except AssignmentCancelledError:
                return {}

    def _run(
        self, parameters: Parameters, context: QgsProcessingContext, feedback: QgsProcessingFeedback
    ) -> dict:
        file = self._plan_file(parameters, context)
        jobs = JobSource(self, parameters, context)
        crs = self._travel.open(jobs, feedback)
        if crs is None:
            return {}
        job = jobs.read(crs)
        if not job.targets:
            feedback.pushWarning(tr("CONES holds no cone: there is nothing to plan."))
        feedback.setProgress(_READ)
        progress = _Progress(feedback)
        travel = self._travel.travel(job, crs, feedback, progress.measuring)
        plan = assign(job, travel, self._objective(parameters, context), progress.solving)
        plan = replace(plan, crs=crs.authid() or crs.toWkt())
        faults = check_plan(plan)
        if faults:
            raise ParameterError(
                tr(
                    "The plan cannot be driven: {faults}. Please report this.",
                    faults="; ".join(faults[:5]),
                )
            )
        made = self._written(plan, crs, file, parameters, context, feedback)
        if feedback.isCanceled():
            return {}
        _report(plan, feedback)
        return {**made, **figures(plan), METHOD_USED: plan.method, TRAVEL_USED: plan.travel}

    def _objective(self, parameters: Parameters, context: QgsProcessingContext) -> Objective:
        return Objective(
            self.parameterAsEnumString(parameters, OBJECTIVE, context),
            self.parameterAsEnumString(parameters, METHOD, context),
            self.parameterAsDouble(parameters, TIME_LIMIT, context),
        )

    def _plan_file(self, parameters: Parameters, context: QgsProcessingContext) -> Path | None:
        """Return the file of the plan, None if not requested.

        :raises OutputError: when it cannot be written, before the time limit is spent on planning.
        """
        name = self.parameterAsFileOutput(parameters, PLAN, context)
        if not name:
            return None
        check_target(Path(name), tr("The plan"))
        return Path(name)

    def _written(
        self,
        plan: ConePlan,
        crs: QgsCoordinateReferenceSystem,
        file: Path | None,
        parameters: Parameters,
        context: QgsProcessingContext,
        feedback: QgsProcessingFeedback,
    ) -> dict[str, str]:
        made = {}
        if file is not None:
            write_whole(file, plan_to_json(plan).encode("utf-8"), tr("The plan"))
            made[PLAN] = str(file)
        types = QgsWkbTypes.Type
        for name, kind, rows, fields in (
            (TARGETS, types.Point, target_rows(plan), self._fields[0]),
            (PATHS, types.LineString, path_rows(plan), self._fields[1]),
        ):
            sink, made[name] = self.parameterAsSink(parameters, name, context, fields, kind, crs)
            fill_sink(sink, fields, rows, feedback)
        self.remember(made)
        return made


class _Progress:
    """Forwards progress to Processing, and cancellation back."""

    def __init__(self, feedback: QgsProcessingFeedback) -> None:
        self._feedback = feedback

    def measuring(self, share: float) -> None:
        """Report the share of distances; raise when cancelled."""
        self._feedback.setProgress(_READ + (_MEASURED - _READ) * share)
        if self._feedback.isCanceled():
            raise AssignmentCancelledError(tr("The assignment was cancelled."))

    def solving(self, share: float) -> bool:
        """Report the share of planning; return whether to continue."""
        self._feedback.setProgress(_MEASURED + (_SOLVED - _MEASURED) * share)
        return not self._feedback.isCanceled()


def _report(plan: ConePlan, feedback: QgsProcessingFeedback) -> None:
    for one in plan.robots:
        cones = sum(len(trip.targets) for trip in one.trips)
        feedback.pushInfo(
            tr(
                "Robot {id}: {cones} on {trips}, {metres:.0f} m, done after {end_s:.0f} s",
                id=one.robot.id,
                cones=tr_count(cones, "1 cone", "%n cones"),
                trips=tr_count(len(one.trips), "1 trip", "%n trips"),
                metres=one.metres,
                end_s=one.end_s,
            )
        )
    feedback.pushInfo(
        tr(
            "Planned by {method} along {travel}: the last robot is done after {end_s:.0f} s, {metres:.0f} m "
            "in all",
            method=plan.method,
            travel=plan.travel,
            end_s=plan.end_s,
            metres=plan.metres,
        )
    )
