"""``fleet:exportrobotmap``: obstacle layers and a window in, a robot map out."""

from __future__ import annotations

from typing import Any

from qgis.core import (
    QgsProcessing,
    QgsProcessingContext,
    QgsProcessingFeedback,
    QgsProcessingOutputNumber,
    QgsProcessingParameterDefinition,
    QgsProcessingParameterExpression,
    QgsProcessingParameterFileDestination,
    QgsProcessingParameterMultipleLayers,
    QgsProcessingParameterNumber,
)

from ...robot_bridge.robotmap.builder import Window, build_map
from ...robot_bridge.robotmap.errors import RobotMapError
from ...robot_bridge.robotmap.model import RobotMap
from ..errors import FleetError
from ..language import tr
from ..sites.reading import Reading
from .errors import shown_by_processing
from .export_help import HELP
from .export_plan import (
    BASE_EXPRESSION,
    DEFAULT_HEIGHT,
    HEIGHT_EXPRESSION,
    OBSTACLES,
    OUTDOOR_EXPRESSION,
    OUTPUT,
    SEMANTICS_EXPRESSION,
    obstacle_layers,
    plan_of,
)
from .fleet_algorithm import FleetAlgorithm, Parameters
from .given_layers import layers_problem
from .map_format import format_parameters
from .map_profile import profile_parameter, warn_of_profile
from .map_shaping import shaping_parameters
from .map_window import window_parameters, window_problem
from .obstacle_outlines import obstacle_outlines
from .obstacle_words import obstacles_in_words
from .whole_file import write_whole

NUMBERS = {
    "OBSTACLE_COUNT": tr("Obstacles"),
    "SEGMENT_COUNT": tr("Segments"),
    "BYTES": tr("Size of the file [bytes]"),
    "BYTES_PER_M2": tr("Compactness [bytes/m²]"),
    "WARNING_COUNT": tr("Warnings"),
}


class ExportRobotMap(FleetAlgorithm):
    """Exports the obstacles in a window as a map that robots read (paper 1, section III)."""

    NAME = "exportrobotmap"
    TITLE = tr("Export robot map")
    SUMMARY = tr("Writes the obstacles of line and polygon layers inside a window as a map that robots read.")
    HELP = HELP
    ICON = "export_robot_map.svg"
    TAGS = ("obstacle", "navigation", "segments", "partial map", "qgis_process")

    def initAlgorithm(self, configuration: dict[str, Any] | None = None):
        for parameter in (
            QgsProcessingParameterMultipleLayers(
                OBSTACLES,
                tr("Obstacle layers (default: those of the project with such a role)"),
                QgsProcessing.SourceType.TypeVectorAnyGeometry,
                optional=True,
            ),
            *window_parameters(),
            *value_parameters(),
            profile_parameter(),
            *shaping_parameters(),
            *format_parameters(),
            QgsProcessingParameterFileDestination(
                OUTPUT, tr("Robot map"), tr("Robot map, text (*.txt);;Robot map, binary (*.rmap)")
            ),
        ):
            self.addParameter(parameter)
        for name, description in NUMBERS.items():
            self.addOutput(QgsProcessingOutputNumber(name, description))

    def checkParameterValues(self, parameters: Parameters, context: QgsProcessingContext):
        # Before QGIS's own checks, which say that a value is wrong and not why.
        problem = window_problem(parameters) or layers_problem(parameters, OBSTACLES, context)
        if problem:
            return False, problem
        fine, message = super().checkParameterValues(parameters, context)
        return (False, message) if not fine else self._check_plan(parameters, context)

    def prepareAlgorithm(
        self, parameters: Parameters, context: QgsProcessingContext, feedback: QgsProcessingFeedback
    ):
        with shown_by_processing():
            self._plan = plan_of(self, parameters, context)
            layers = obstacle_layers(self, parameters, context)
            warn_of_profile(self, parameters, context, layers, feedback)
        return True

    def processAlgorithm(
        self, parameters: Parameters, context: QgsProcessingContext, feedback: QgsProcessingFeedback
    ):
        with shown_by_processing(feedback):
            plan = self._plan
            border = plan.window.border
            found = obstacle_outlines(plan, border, feedback)
            if found is None:
                return {}
            reading, outlines = found
            robot_map = build_map(outlines, plan.window, plan.meta)
            text, content = plan.format.written(robot_map)
            if feedback.isCanceled():
                return {}
            write_whole(plan.target, content)
            warnings = _reported(reading, robot_map, feedback)
            _report_size(plan.window, robot_map, text, content, feedback)
        feedback.setProgress(100)
        counts = (len(robot_map.obstacles), robot_map.segment_count, len(content))
        figures = (*counts, len(content) / border.area, warnings)
        return {OUTPUT: str(plan.target), **dict(zip(NUMBERS, figures, strict=True))}

    def _check_plan(self, parameters: Parameters, context: QgsProcessingContext) -> tuple[bool, str]:
        """Make the plan once before the run: the dialog and scripts are told what is wrong with it."""
        try:
            plan_of(self, parameters, context)
        except (FleetError, RobotMapError) as error:
            return False, str(error)
        return True, ""


def value_parameters() -> list[QgsProcessingParameterDefinition]:
    """Return the parameters that say what a feature is."""
    base = QgsProcessingParameterExpression(
        BASE_EXPRESSION, tr("Foot of each feature above ground [m] (default: on it)"), optional=True
    )
    base.setHelp(
        tr(
            'Such as "clearance" of arches, or 2.2 for signs; the height of a feature counts from there. '
            "The upper height of the robot's plane leaves out what begins above it."
        )
    )
    return [
        QgsProcessingParameterExpression(
            HEIGHT_EXPRESSION, tr("Height of each feature [m] (default: its field height)"), optional=True
        ),
        base,
        QgsProcessingParameterNumber(
            DEFAULT_HEIGHT,
            tr("Height where none is known, marked as estimated [m]"),
            QgsProcessingParameterNumber.Type.Double,
            3.0,
        ),
        QgsProcessingParameterExpression(
            SEMANTICS_EXPRESSION, tr("Label of each feature (default: the layer's name)"), optional=True
        ),
        QgsProcessingParameterExpression(
            OUTDOOR_EXPRESSION, tr("Whether each feature is outdoors (default: true)"), optional=True
        ),
    ]


def _reported(reading: Reading, robot_map: RobotMap, feedback: QgsProcessingFeedback) -> int:
    """Push every warning and return how many there are."""
    warnings = [*reading.warnings, *robot_map.warnings]
    for warning in warnings:
        feedback.pushWarning(warning)
    if not robot_map.obstacles:
        feedback.pushWarning(tr("There is no obstacle in the window: check its place and the site CRS."))
        return len(warnings) + 1
    return len(warnings)


def _report_size(
    window: Window, robot_map: RobotMap, text: str, content: bytes, feedback: QgsProcessingFeedback
) -> None:
    border, area = robot_map.border, robot_map.border.area
    size = len(text.encode())
    feedback.pushInfo(
        tr(
            "Window {width:g} m x {height:g} m = {area:.0f} m², from ({x_min:.2f}, {y_min:.2f}) to "
            "({x_max:.2f}, {y_max:.2f}) in the site frame",
            width=window.width,
            height=window.height,
            area=area,
            x_min=border.x_min,
            y_min=border.y_min,
            x_max=border.x_max,
            y_max=border.y_max,
        )
    )
    feedback.pushInfo(obstacles_in_words(len(robot_map.obstacles), robot_map.segment_count))
    feedback.pushInfo(
        tr(
            "{size} bytes of text, {ratio:.3g} bytes/m² (paper 1: about 3 bytes/m² as text)",
            size=size,
            ratio=size / area,
        )
    )
    if len(content) != size:
        feedback.pushInfo(
            tr(
                "{size} bytes in binary, {ratio:.3g} bytes/m²",
                size=len(content),
                ratio=len(content) / area,
            )
        )
