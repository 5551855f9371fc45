"""``fleet:checkrobotmap``: a robot map in, a layer of what is odd in it out."""

from __future__ import annotations

from collections import Counter
from pathlib import Path
from typing import Any

from qgis.core import (
    QgsProcessing,
    QgsProcessingContext,
    QgsProcessingFeedback,
    QgsProcessingOutputNumber,
    QgsProcessingParameterFeatureSink,
    QgsProcessingParameterNumber,
    QgsWkbTypes,
)

from ....robot_bridge.core.robotmap.checks import CHECKS
from ....robot_bridge.core.robotmap.findings import MapCheckLimits, MapFinding, SegmentTable, Severity
from ...ui.language import tr, tr_page
from ..common.algorithm import FleetAlgorithm, Parameters, advanced, fields_of, shown_by_processing
from ..common.map_files import MAP, MapPlace, file_problem, map_parameters, map_place, read_map_file
from ..common.outputs import fill_sink, lines

FINDINGS = "FINDINGS"
_FIELDS = {"kind": "string", "severity": "string", "obstacle": "int8", "text": "string"}
_LIMITS = {
    "GAP": (tr("Longest gap that was not meant [m]"), "gap", 0.0),
    "SLIVER": (tr("Narrowest ring that is an obstacle [m]"), "sliver", 0.0),
    "ROBOT_WIDTH": (tr("Width of the robot, for unreachable pockets [m]"), "robot_width", 0.05),
    "POCKET": (tr("Smallest unreachable pocket [m²]"), "pocket", 0.0),
}
NUMBERS = {
    "FINDING_COUNT": tr("Findings"),
    "ERROR_COUNT": tr("Errors"),
    "WARNING_COUNT": tr("Warnings"),
    "INFO_COUNT": tr("Worth knowing"),
}


class CheckRobotMap(FleetAlgorithm):
    """Checks a robot map and shows each finding at its place."""

    NAME = "checkrobotmap"
    TITLE = tr("Check robot map")
    SUMMARY = tr(
        "Finds turned outlines, gaps, slivers, repeats, overlaps and unreachable pockets in a robot map."
    )
    ICON = "check_robot_map.svg"
    TAGS = ("check", "validate", "quality", "orientation", "gap", "overlap", "duplicate")
    STYLES = {FINDINGS: "robot_map_findings.qml"}  # noqa: RUF012
    HELP = tr_page("""
    <p>Checks a robot map, text or binary, and makes a layer of lines that show what is odd, each with a kind,
    a severity, the obstacle to look at, and what to do.</p>
    <p><b>orientation</b>: outlines, courtyards, segments or risers that run the wrong way round. <b>gap</b>:
    rings that do not close, and lines that stop just short of another obstacle. <b>sliver</b>: rings next to
    nothing wide, segments without length. <b>duplicate</b>, <b>overlap</b>: obstacles that repeat, cross or
    cover one another or lie inside another. <b>shared wall</b>: where two outlines touch back to back.
    <b>pocket</b>: free space that a robot of the given width cannot reach; courtyards are such pockets.
    <b>height</b>: heights of 0 or less, or above 0 where there must be none. <b>outside</b>: segments beyond
    the border. <b>id</b>: ids used twice.</p>
    <p>Severities: <i>error</i> misleads a robot, <i>warning</i> is probably not meant, <i>info</i> is worth
    knowing. The map itself is not changed.</p>
    """)

    def initAlgorithm(self, configuration: dict[str, Any] | None = None):
        defaults = MapCheckLimits()
        for parameter in map_parameters():
            self.addParameter(parameter)
        for name, (title, key, least) in _LIMITS.items():
            kind = QgsProcessingParameterNumber.Type.Double
            number = QgsProcessingParameterNumber(name, title, kind, getattr(defaults, key), minValue=least)
            self.addParameter(advanced(number))
        self.addParameter(
            QgsProcessingParameterFeatureSink(
                FINDINGS, tr("Findings"), QgsProcessing.SourceType.TypeVectorLine
            )
        )
        for name, title in NUMBERS.items():
            self.addOutput(QgsProcessingOutputNumber(name, title))

    def checkParameterValues(self, parameters: Parameters, context: QgsProcessingContext):
        problem = file_problem(parameters)
        return (False, problem) if problem else super().checkParameterValues(parameters, context)

    def prepareAlgorithm(
        self, parameters: Parameters, context: QgsProcessingContext, feedback: QgsProcessingFeedback
    ):
        self._fields = fields_of(_FIELDS)
        return True

    def processAlgorithm(
        self, parameters: Parameters, context: QgsProcessingContext, feedback: QgsProcessingFeedback
    ):
        with shown_by_processing(feedback):
            robot_map = read_map_file(Path(self.parameterAsFile(parameters, MAP, context)))
            place = map_place(self, parameters, context, robot_map.meta, feedback)
            for warning in robot_map.warnings:
                feedback.pushWarning(warning)
            numbers = {
                key: self.parameterAsDouble(parameters, name, context)
                for name, (_, key, _) in _LIMITS.items()
            }
            findings = _findings(SegmentTable.of(robot_map), MapCheckLimits(**numbers), feedback)
            if feedback.isCanceled():
                return {}
            kind = QgsWkbTypes.Type.MultiLineString
            sink, source = self.parameterAsSink(parameters, FINDINGS, context, self._fields, kind, place.crs)
            fill_sink(sink, self._fields, [_row(finding, place) for finding in findings], feedback)
        self.remember({FINDINGS: source})
        return {FINDINGS: source, **_reported(findings, feedback)}


def _findings(
    table: SegmentTable, limits: MapCheckLimits, feedback: QgsProcessingFeedback
) -> list[MapFinding]:
    """Run the checks one after another until the user cancels."""
    findings: list[MapFinding] = []
    for number, check in enumerate(CHECKS, 1):
        if feedback.isCanceled():
            break
        findings += check(table, limits)
        feedback.setProgress(95 * number / len(CHECKS))
    return findings


def _row(finding: MapFinding, place: MapPlace):
    values = [finding.kind.value, finding.severity.value, finding.obstacle, finding.text]
    return lines(place.points(finding.segments)), values


def _reported(findings: list[MapFinding], feedback: QgsProcessingFeedback) -> dict[str, int]:
    """Say how many findings of each kind there are, and return the figures of the outputs."""
    counts = Counter((finding.severity.value, finding.kind.value) for finding in findings)
    for (severity, kind), count in sorted(counts.items()):
        feedback.pushInfo(f"{severity}: {kind}: {count}")
    if not findings:
        feedback.pushInfo(tr("Nothing is odd in this map."))
    by_severity = Counter(finding.severity for finding in findings)
    figures = (len(findings), *(by_severity[severity] for severity in Severity))
    return dict(zip(NUMBERS, figures, strict=True))
