"""``fleet:exportrobotmap``: obstacle layers and a window in, a robot map out."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

from qgis.core import (
    QgsCoordinateReferenceSystem,
    QgsMapLayer,
    QgsProcessing,
    QgsProcessingAlgorithm,
    QgsProcessingOutputNumber,
    QgsProcessingParameterBoolean,
    QgsProcessingParameterDefinition,
    QgsProcessingParameterEnum,
    QgsProcessingParameterExpression,
    QgsProcessingParameterFileDestination,
    QgsProcessingParameterMultipleLayers,
    QgsProcessingParameterNumber,
    QgsProcessingUtils,
    QgsProviderRegistry,
    QgsVectorLayer,
)
from qgis.PyQt.QtGui import QIcon

from ...robot_bridge.robotmap.binary import encode
from ...robot_bridge.robotmap.builder import Window, build_map
from ...robot_bridge.robotmap.model import RobotMap
from ...robot_bridge.robotmap.text import write_text
from ..sites.errors import LayerTypeError
from ..sites.obstacle_source import obstacle_sources
from ..sites.placing import SitePlacing
from ..sites.reading import Reading, read_outlines
from ..sites.roles import LayerExpressions
from ..sites.site_crs import site_crs_for
from .errors import shown_by_processing
from .export_help import HELP
from .map_window import (
    LOCAL,
    SITE_CRS,
    ParameterError,
    map_window,
    site_frame,
    window_parameters,
    window_problem,
)
from .whole_file import OutputError, write_whole

OBSTACLES, FORMAT, STRICT, OUTPUT = "OBSTACLES", "FORMAT", "STRICT", "OUTPUT"
HEIGHT_EXPRESSION, DEFAULT_HEIGHT = "HEIGHT_EXPRESSION", "DEFAULT_HEIGHT"
SEMANTICS_EXPRESSION, OUTDOOR_EXPRESSION = "SEMANTICS_EXPRESSION", "OUTDOOR_EXPRESSION"
TEXT, BINARY = "text", "binary"
NUMBERS = {
    "OBSTACLE_COUNT": "Obstacles",
    "SEGMENT_COUNT": "Segments",
    "BYTES": "Size of the file [bytes]",
    "BYTES_PER_M2": "Compactness [bytes/m²]",
    "WARNING_COUNT": "Warnings",
}
ESTIMATED = {"h": "est"}
"""The extra of an obstacle whose height nobody knows."""

ICON = Path(__file__).parents[2] / "resources" / "icons" / "export_robot_map.svg"


class ExportRobotMap(QgsProcessingAlgorithm):
    """Exports the obstacles in a window as a map that robots read (paper 1, section III)."""

    def name(self):
        return "exportrobotmap"

    def displayName(self):
        return "Export robot map"

    def group(self):
        return "Robot maps"

    def groupId(self):
        return "robotmaps"

    def tags(self):
        return ["robot", "map", "obstacle", "navigation", "segments", "partial map", "qgis_process"]

    def shortDescription(self):
        return "Writes the obstacles of line and polygon layers inside a window as a map that robots read."

    def shortHelpString(self):
        return HELP

    def icon(self):
        return QIcon(str(ICON))

    def svgIconPath(self):
        return str(ICON)

    def createInstance(self):
        return ExportRobotMap()

    def initAlgorithm(self, configuration=None):
        for parameter in (
            QgsProcessingParameterMultipleLayers(
                OBSTACLES, "Obstacle layers", QgsProcessing.SourceType.TypeVectorAnyGeometry
            ),
            *window_parameters(),
            *_value_parameters(),
            QgsProcessingParameterEnum(
                FORMAT, "Format", options=[TEXT, BINARY], defaultValue=TEXT, usesStaticStrings=True
            ),
            QgsProcessingParameterBoolean(
                STRICT, "Only what the paper's Fig. 2 has: no leading lines, no extras", defaultValue=False
            ),
            QgsProcessingParameterFileDestination(
                OUTPUT, "Robot map", "Robot map, text (*.txt);;Robot map, binary (*.rmap)"
            ),
        ):
            self.addParameter(parameter)
        for name, description in NUMBERS.items():
            self.addOutput(QgsProcessingOutputNumber(name, description))

    def checkParameterValues(self, parameters, context):
        problem = window_problem(parameters)
        if problem:
            return False, problem
        return super().checkParameterValues(parameters, context)

    def prepareAlgorithm(self, parameters, context, feedback):
        with shown_by_processing():
            layers = self._layers(parameters, context)
            self._target = self._output(parameters, context, layers)
            self._default_height = self._default_height_of(parameters, context)
            crs = self._site_crs(parameters, context, layers)
            frame = site_frame(self, parameters, context, crs)
            self._window = map_window(self, parameters, context, crs, frame)
            local = self.parameterAsBool(parameters, LOCAL, context)
            self._site = SitePlacing(crs, frame, context.transformContext(), local)
            general = LayerExpressions(
                height=self.parameterAsExpression(parameters, HEIGHT_EXPRESSION, context),
                semantics=self.parameterAsExpression(parameters, SEMANTICS_EXPRESSION, context),
                outdoor=self.parameterAsExpression(parameters, OUTDOOR_EXPRESSION, context),
            )
            scope = self.createExpressionContext(parameters, context)
            self._sources = obstacle_sources(layers, general, scope)
        return True

    def processAlgorithm(self, parameters, context, feedback):
        with shown_by_processing():
            border = self._window.border
            reading = read_outlines(self._sources, self._site, border, self._default_height, feedback)
            if not reading.complete:
                return {}
            robot_map = _marked(build_map(reading.outlines(), self._window, self._meta()), reading.estimated)
            text = write_text(robot_map, strict=self.parameterAsBool(parameters, STRICT, context))
            binary = self.parameterAsEnumString(parameters, FORMAT, context) == BINARY
            content = encode(text) if binary else text.encode()
            if feedback.isCanceled():
                return {}
            write_whole(self._target, content)
            warnings = _reported(reading, robot_map, feedback)
            _report_size(self._window, robot_map, text, content, feedback)
        feedback.setProgress(100)
        counts = (len(robot_map.obstacles), robot_map.segment_count, len(content))
        figures = (*counts, len(content) / border.area, warnings)
        return {OUTPUT: str(self._target), **dict(zip(NUMBERS, figures, strict=True))}

    def _layers(self, parameters, context) -> list[QgsVectorLayer]:
        """Return the obstacle layers; Processing itself passes over in silence those it cannot open."""
        values = parameters[OBSTACLES]
        for value in values if isinstance(values, (list, tuple)) else [values]:
            if isinstance(value, str) and QgsProcessingUtils.mapLayerFromString(value, context) is None:
                raise LayerTypeError(
                    f"The obstacle layer {value} cannot be opened: check the file, and the layer's name "
                    "after '|layername='."
                )
        layers = self.parameterAsLayerList(parameters, OBSTACLES, context)
        for layer in layers:
            if not isinstance(layer, QgsVectorLayer):
                raise LayerTypeError(f"The layer {layer.name()} is no vector layer: leave it out.")
        return layers

    def _output(self, parameters, context, layers: list[QgsMapLayer]) -> Path:
        target = Path(self.parameterAsFileOutput(parameters, OUTPUT, context))
        for layer in layers:
            path = QgsProviderRegistry.instance().decodeUri(layer.providerType(), layer.source()).get("path")
            if path and target.exists() and Path(path).exists() and target.samefile(path):
                raise OutputError(
                    f"OUTPUT {target} is the file of the layer {layer.name()}: choose another one."
                )
        return target

    def _default_height_of(self, parameters, context) -> float:
        height = self.parameterAsDouble(parameters, DEFAULT_HEIGHT, context)
        if not 0 <= height < float("inf"):
            raise ParameterError(f"DEFAULT_HEIGHT is {height}: give a number of metres of 0 or more.")
        return height

    def _site_crs(self, parameters, context, layers) -> QgsCoordinateReferenceSystem:
        chosen = self.parameterAsCrs(parameters, SITE_CRS, context)
        if parameters.get(SITE_CRS) and not chosen.isValid():
            raise ParameterError(
                f"SITE_CRS {parameters[SITE_CRS]} is no CRS that QGIS knows: write a code such as EPSG:32633."
            )
        project = context.project()
        project_crs = project.crs() if project is not None else QgsCoordinateReferenceSystem()
        return site_crs_for(chosen, project_crs, [layer.crs() for layer in layers])

    def _meta(self) -> dict[str, str]:
        """Return the leading lines, spelled as those of a published site are."""
        frame = self._site.frame
        if not self._site.crs.isValid():
            return {}
        return {
            "crs": frame.crs,
            "origin": f"{frame.origin[0]:.3f},{frame.origin[1]:.3f}",
            "rotation": f"{frame.rotation:.9f}",
        }


def _value_parameters() -> list[QgsProcessingParameterDefinition]:
    """Return the parameters that say what a feature is."""
    return [
        QgsProcessingParameterExpression(
            HEIGHT_EXPRESSION, "Height of each feature [m] (default: its field height)", optional=True
        ),
        QgsProcessingParameterNumber(
            DEFAULT_HEIGHT,
            "Height where none is known, marked as estimated [m]",
            QgsProcessingParameterNumber.Type.Double,
            3.0,
        ),
        QgsProcessingParameterExpression(
            SEMANTICS_EXPRESSION, "Label of each feature (default: the layer's name)", optional=True
        ),
        QgsProcessingParameterExpression(
            OUTDOOR_EXPRESSION, "Whether each feature is outdoors (default: true)", optional=True
        ),
    ]


def _marked(robot_map: RobotMap, estimated: set[str]) -> RobotMap:
    """Return the map with the obstacles of the sources in ``estimated`` marked."""
    return replace(
        robot_map,
        obstacles=tuple(
            replace(obstacle, ext={**obstacle.ext, **ESTIMATED})
            if obstacle.ext.get("src") in estimated
            else obstacle
            for obstacle in robot_map.obstacles
        ),
    )


def _reported(reading: Reading, robot_map: RobotMap, feedback) -> int:
    """Push every warning and return how many there are."""
    warnings = [*reading.warnings, *robot_map.warnings]
    for warning in warnings:
        feedback.pushWarning(warning)
    if not robot_map.obstacles:
        feedback.pushWarning("There is no obstacle in the window: check its place and the site CRS.")
        return len(warnings) + 1
    return len(warnings)


def _report_size(window: Window, robot_map: RobotMap, text: str, content: bytes, feedback) -> None:
    border, area = robot_map.border, robot_map.border.area
    size = len(text.encode())
    feedback.pushInfo(
        f"Window {window.width:g} m x {window.height:g} m = {area:.0f} m², from ({border.x_min:.2f}, "
        f"{border.y_min:.2f}) to ({border.x_max:.2f}, {border.y_max:.2f}) in the site frame"
    )
    feedback.pushInfo(f"{len(robot_map.obstacles)} obstacles, {robot_map.segment_count} segments")
    feedback.pushInfo(f"{size} bytes of text, {size / area:.2f} bytes/m² (paper 1: about 3 bytes/m² as text)")
    if len(content) != size:
        feedback.pushInfo(f"{len(content)} bytes in binary, {len(content) / area:.2f} bytes/m²")
