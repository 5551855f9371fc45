"""``fleet:assigncones``: which robot places or collects which cone, on which trip, and when."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

from qgis.core import (
    QgsCoordinateReferenceSystem,
    QgsProcessing,
    QgsProcessingContext,
    QgsProcessingFeedback,
    QgsProcessingOutputNumber,
    QgsProcessingOutputString,
    QgsProcessingParameterFeatureSink,
    QgsProcessingParameterFileDestination,
    QgsProcessingParameterNumber,
    QgsWkbTypes,
)

from ...robot_bridge.assignment.checks import check_plan
from ...robot_bridge.assignment.errors import CancelledError
from ...robot_bridge.assignment.plan import Plan
from ...robot_bridge.assignment.plan_json import to_json
from ...robot_bridge.assignment.scheduling import BALANCED
from ...robot_bridge.assignment.solving import AUTOMATIC, Wanted, assign
from ..assignment_words import METHODS, OBJECTIVES
from ..language import tr, tr_count, tr_page
from .errors import ParameterError, shown_by_processing
from .fleet_algorithm import FleetAlgorithm, Parameters, fields_of
from .job_source import JobSource, job_parameters
from .job_travel import TravelSource, travel_parameters
from .named_choice import named_choice
from .plan_rows import FIGURES, PATH_FIELDS, TARGET_FIELDS, figures, path_rows, target_rows
from .sinks import fill
from .whole_file import check_target, write_whole

OBJECTIVE, METHOD, TIME_LIMIT = "OBJECTIVE", "METHOD", "TIME_LIMIT"
TARGETS, PATHS, PLAN = "TARGETS", "PATHS", "PLAN"
METHOD_USED, TRAVEL_USED = "METHOD_USED", "TRAVEL_USED"
_READ, _MEASURED, _SOLVED = 15.0, 40.0, 95.0
"""Per cent of the work after reading, after distances, and after planning."""


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
            named_choice(OBJECTIVE, tr("Objective"), OBJECTIVES, BALANCED),
            named_choice(METHOD, tr("Method"), METHODS, AUTOMATIC),
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
            except CancelledError:
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
        told = _Told(feedback)
        travel = self._travel.travel(job, crs, feedback, told.measuring)
        plan = assign(job, travel, self._wanted(parameters, context), told.solving)
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

    def _wanted(self, parameters: Parameters, context: QgsProcessingContext) -> Wanted:
        return Wanted(
            self.parameterAsEnumString(parameters, OBJECTIVE, context),
            self.parameterAsEnumString(parameters, METHOD, context),
            self.parameterAsDouble(parameters, TIME_LIMIT, context),
        )

    def _plan_file(self, parameters: Parameters, context: QgsProcessingContext) -> Path | None:
        """Return the file of the plan, None where none is wanted.

        :raises OutputError: when it cannot be written, before the time limit is spent on planning.
        """
        name = self.parameterAsFileOutput(parameters, PLAN, context)
        if not name:
            return None
        check_target(Path(name), tr("The plan"))
        return Path(name)

    def _written(
        self,
        plan: Plan,
        crs: QgsCoordinateReferenceSystem,
        file: Path | None,
        parameters: Parameters,
        context: QgsProcessingContext,
        feedback: QgsProcessingFeedback,
    ) -> dict[str, str]:
        made = {}
        if file is not None:
            write_whole(file, to_json(plan).encode("utf-8"), tr("The plan"))
            made[PLAN] = str(file)
        types = QgsWkbTypes.Type
        for name, kind, rows, fields in (
            (TARGETS, types.Point, target_rows(plan), self._fields[0]),
            (PATHS, types.LineString, path_rows(plan), self._fields[1]),
        ):
            sink, made[name] = self.parameterAsSink(parameters, name, context, fields, kind, crs)
            fill(sink, fields, rows, feedback)
        self.remember(made)
        return made


class _Told:
    """Passes progress on to Processing, and its cancel back."""

    def __init__(self, feedback: QgsProcessingFeedback) -> None:
        self._feedback = feedback

    def measuring(self, share: float) -> None:
        """Tell the share of distances; raise when they are not wanted any more."""
        self._feedback.setProgress(_READ + (_MEASURED - _READ) * share)
        if self._feedback.isCanceled():
            raise CancelledError(tr("The assignment was cancelled."))

    def solving(self, share: float) -> bool:
        """Tell the share of planning; return whether to go on."""
        self._feedback.setProgress(_MEASURED + (_SOLVED - _MEASURED) * share)
        return not self._feedback.isCanceled()


def _report(plan: Plan, feedback: QgsProcessingFeedback) -> None:
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
