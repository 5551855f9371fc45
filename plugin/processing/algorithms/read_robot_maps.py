"""``fleet:loadrobotmap`` and ``fleet:checkrobotmap``: the content of a robot map, and its faults."""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from qgis.core import (
    QgsGeometry,
    QgsProcessing,
    QgsProcessingContext,
    QgsProcessingFeedback,
    QgsProcessingOutputNumber,
    QgsProcessingParameterFeatureSink,
    QgsProcessingParameterNumber,
    QgsWkbTypes,
)

from ....robot_bridge.core.robotmap.checks import CHECKS
from ....robot_bridge.core.robotmap.exporters.geometries import MapShape, obstacle_shapes, segment_shapes
from ....robot_bridge.core.robotmap.findings import MapCheckLimits, MapFinding, SegmentTable, Severity
from ....robot_bridge.core.robotmap.model import Border, RobotMap
from ...ui.language import tr, tr_page
from ..common import map_files
from ..common.algorithm import FleetAlgorithm, Parameters, advanced, fields_of, shown_by_processing
from ..common.outputs import fill_sink, line, lines, polygon

# --- ``fleet:loadrobotmap``: a robot map in, layers with all its content out ---

AREAS, LINES, SEGMENTS, BORDER = "AREAS", "LINES", "SEGMENTS", "BORDER"

_OBSTACLE = {
    "id": "int8",
    "shape_type": "integer",
    "shape": "string",
    "semantics": "string",
    "height_m": "double",
    "outdoor": "bool",
    "segments": "integer",
    "courtyards": "string",
    "courtyard": "bool",
    "source": "string",
    "ext": "string",
}
_SEGMENT = {
    "obstacle": "int8",
    "number": "integer",
    "shape_type": "integer",
    "height_m": "double",
    "outdoor": "bool",
    "semantics": "string",
    "obstacle_semantics": "string",
    "source": "string",
    "ext": "string",
}
_BORDER = {"area_m2": "double", "obstacles": "integer", "segments": "integer", "meta": "string"}

_LAYERS = {
    AREAS: (tr("Obstacles that are areas"), QgsWkbTypes.Type.Polygon, _OBSTACLE),
    LINES: (tr("Obstacles that are lines"), QgsWkbTypes.Type.MultiLineString, _OBSTACLE),
    SEGMENTS: (tr("Segments"), QgsWkbTypes.Type.LineString, _SEGMENT),
    BORDER: (tr("Border of the map"), QgsWkbTypes.Type.Polygon, _BORDER),
}
_KINDS = {
    QgsWkbTypes.Type.Polygon: QgsProcessing.SourceType.TypeVectorPolygon,
    QgsWkbTypes.Type.MultiLineString: QgsProcessing.SourceType.TypeVectorLine,
    QgsWkbTypes.Type.LineString: QgsProcessing.SourceType.TypeVectorLine,
}
NUMBERS = {
    "OBSTACLE_COUNT": tr("Obstacles"),
    "SEGMENT_COUNT": tr("Segments"),
    "WARNING_COUNT": tr("Warnings"),
}

Row = tuple[QgsGeometry, Sequence[Any]]


class LoadRobotMap(FleetAlgorithm):
    """Converts a robot map back into layers, with all its attributes."""

    NAME = "loadrobotmap"
    TITLE = tr("Load robot map")
    SUMMARY = tr("Turns a robot map, text or binary, into layers with all that the map says.")
    ICON = "load_robot_map.svg"
    TAGS = ("load", "import", "read", "obstacle", "segments")
    STYLES = {  # noqa: RUF012
        AREAS: "robot_map_areas.qml",
        LINES: "robot_map_lines.qml",
        SEGMENTS: "robot_map_segments.qml",
        BORDER: "robot_map_border.qml",
    }
    ABOVE_AREAS = (SEGMENTS, LINES, AREAS, BORDER)
    HELP = tr_page("""
    <p>Reads a robot map, text or binary, and makes layers of it.</p>
    <p><b>Obstacles that are areas</b>: outlines that close, courtyards as holes. <b>Obstacles that are
    lines</b>: walls, stairs, and what the border of the map cuts. <b>Segments</b>: each from a to b, with
    free space on its right; the style shows that side by ticks and the height by colour. Fields: id, shape,
    labels, height, indoors or outdoors, extras (<i>ext</i>, as JSON).</p>
    <p><b>Place</b>: a map may name its CRS, origin and rotation in its leading lines; parameters win over
    them. Where neither does, the layers are in local metres, said in a warning.</p>
    """)

    def initAlgorithm(self, configuration: dict[str, Any] | None = None):
        for parameter in map_files.map_parameters():
            self.addParameter(parameter)
        for name, (title, kind, _) in _LAYERS.items():
            self.addParameter(
                QgsProcessingParameterFeatureSink(
                    name, title, _KINDS[kind], optional=True, createByDefault=name != BORDER
                )
            )
        for name, title in NUMBERS.items():
            self.addOutput(QgsProcessingOutputNumber(name, title))

    def checkParameterValues(self, parameters: Parameters, context: QgsProcessingContext):
        problem = map_files.file_problem(parameters)
        return (False, problem) if problem else super().checkParameterValues(parameters, context)

    def prepareAlgorithm(
        self, parameters: Parameters, context: QgsProcessingContext, feedback: QgsProcessingFeedback
    ):
        self._fields = {name: fields_of(columns) for name, (_, _, columns) in _LAYERS.items()}
        return True

    def processAlgorithm(
        self, parameters: Parameters, context: QgsProcessingContext, feedback: QgsProcessingFeedback
    ):
        with shown_by_processing(feedback):
            robot_map = map_files.read_map_file(
                Path(self.parameterAsFile(parameters, map_files.MAP, context))
            )
            feedback.setProgress(30)
            place = map_files.map_place(self, parameters, context, robot_map.meta, feedback)
            for warning in robot_map.warnings:
                feedback.pushWarning(warning)
            made = self._write(parameters, context, layer_rows(robot_map, place), place, feedback)
            if feedback.isCanceled():
                return {}
        self.remember(made)
        feedback.pushInfo(map_files.obstacles_in_words(len(robot_map.obstacles), robot_map.segment_count))
        figures = (len(robot_map.obstacles), robot_map.segment_count, len(robot_map.warnings))
        return {**made, **dict(zip(NUMBERS, figures, strict=True))}

    def _write(
        self,
        parameters: Parameters,
        context: QgsProcessingContext,
        rows: dict[str, list[Row]],
        place: map_files.MapPlace,
        feedback: QgsProcessingFeedback,
    ) -> dict[str, str]:
        made = {}
        for number, (name, (_, kind, _)) in enumerate(_LAYERS.items(), 1):
            fields = self._fields[name]
            sink, source = self.parameterAsSink(parameters, name, context, fields, kind, place.crs)
            if sink is None:
                continue
            made[name] = source
            if not fill_sink(sink, fields, rows[name], feedback):
                break
            feedback.setProgress(30 + 70 * number / len(_LAYERS))
        return made


def layer_rows(robot_map: RobotMap, place: map_files.MapPlace) -> dict[str, list[Row]]:
    """Return geometry and values of every feature of each layer."""
    shapes = obstacle_shapes(robot_map)
    return {
        AREAS: [_row(shape, place, _OBSTACLE) for shape in shapes if shape.kind == "Polygon"],
        LINES: [_row(shape, place, _OBSTACLE) for shape in shapes if shape.kind != "Polygon"],
        SEGMENTS: [_row(shape, place, _SEGMENT) for shape in segment_shapes(robot_map)],
        BORDER: [(border_polygon(robot_map.border, place), _border_values(robot_map))],
    }


def border_polygon(border: Border, place: map_files.MapPlace) -> QgsGeometry:
    """Return the rectangle of a map in the CRS of its place."""
    x_min, y_min, x_max, y_max = border
    ring = np.array([[x_min, y_min], [x_max, y_min], [x_max, y_max], [x_min, y_max], [x_min, y_min]])
    return polygon([place.points(ring)])


def _border_values(robot_map: RobotMap) -> list[Any]:
    meta = json.dumps(robot_map.meta, ensure_ascii=False)
    return [robot_map.border.area, len(robot_map.obstacles), robot_map.segment_count, meta]


def _row(shape: MapShape, place: map_files.MapPlace, columns: dict[str, str]) -> Row:
    parts = [place.points(part) for part in shape.parts]
    make = {"Polygon": polygon, "MultiLineString": lines}.get(shape.kind)
    geometry = make(parts) if make else line(parts[0])
    return geometry, [_value(shape.attributes[name]) for name in columns]


def _value(value: Any) -> Any:
    """Return ``value`` as a field can store it: mappings and lists as JSON, empty ones as an empty text."""
    if isinstance(value, (dict, list)):
        return json.dumps(value, ensure_ascii=False) if value else ""
    return value


# --- ``fleet:checkrobotmap``: a robot map in, a layer of its faults out ---

FINDINGS = "FINDINGS"
_FIELDS = {"kind": "string", "severity": "string", "obstacle": "int8", "text": "string"}
_LIMITS = {
    "GAP": (tr("Longest gap that was not meant [m]"), "gap", 0.0),
    "SLIVER": (tr("Narrowest ring that is an obstacle [m]"), "sliver", 0.0),
    "ROBOT_WIDTH": (tr("Width of the robot, for unreachable pockets [m]"), "robot_width", 0.05),
    "POCKET": (tr("Smallest unreachable pocket [m²]"), "pocket", 0.0),
}
FINDING_COUNTS = {
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
        for parameter in map_files.map_parameters():
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
        for name, title in FINDING_COUNTS.items():
            self.addOutput(QgsProcessingOutputNumber(name, title))

    def checkParameterValues(self, parameters: Parameters, context: QgsProcessingContext):
        problem = map_files.file_problem(parameters)
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
            robot_map = map_files.read_map_file(
                Path(self.parameterAsFile(parameters, map_files.MAP, context))
            )
            place = map_files.map_place(self, parameters, context, robot_map.meta, feedback)
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
            fill_sink(sink, self._fields, [_finding_row(finding, place) for finding in findings], feedback)
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


def _finding_row(finding: MapFinding, place: map_files.MapPlace):
    values = [finding.kind.value, finding.severity.value, finding.obstacle, finding.text]
    return lines(place.points(finding.segments)), values


def _reported(findings: list[MapFinding], feedback: QgsProcessingFeedback) -> dict[str, int]:
    """Report the number of findings of each kind, and return the figures of the outputs."""
    counts = Counter((finding.severity.value, finding.kind.value) for finding in findings)
    for (severity, kind), count in sorted(counts.items()):
        feedback.pushInfo(f"{severity}: {kind}: {count}")
    if not findings:
        feedback.pushInfo(tr("Nothing is odd in this map."))
    by_severity = Counter(finding.severity for finding in findings)
    figures = (len(findings), *(by_severity[severity] for severity in Severity))
    return dict(zip(FINDING_COUNTS, figures, strict=True))
