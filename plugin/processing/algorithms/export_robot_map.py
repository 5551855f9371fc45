"""``fleet:exportrobotmap``: obstacle layers and a window in, a robot map out."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from qgis.core import (
    QgsProcessingContext,
    QgsProcessingFeedback,
    QgsProcessingOutputNumber,
    QgsProcessingParameterDefinition,
    QgsProcessingParameterExpression,
    QgsProcessingParameterFileDestination,
    QgsProcessingParameterNumber,
    QgsVectorLayer,
)

from ....robot_bridge.core.errors import RobotMapError
from ....robot_bridge.core.robotmap.builder import SurroundingOutlines, build_map
from ....robot_bridge.core.robotmap.model import Border, RobotMap, Window
from ...layers.obstacle_layers import ObstacleReading
from ...layers.site_transform import Bounds, SiteGeoreference
from ...ui.errors import FleetError
from ...ui.language import tr, tr_page
from ..common import export_parameters
from ..common.algorithm import FleetAlgorithm, Parameters, shown_by_processing
from ..common.map_files import obstacles_in_words
from ..common.outputs import write_whole
from ..common.parameters import (
    profile_parameter,
    warn_of_profile,
    window_parameters,
    window_problem,
)

# --- The help of ``fleet:exportrobotmap`` ---

HELP = tr_page("""
<p>Writes the obstacles in a window of the site as a map that robots read: oriented segments with free space
to their right, grouped by kind. Robots get metres in the <b>site frame</b>: a projected CRS, an origin in it
and a rotation.</p>
<p><b>Obstacle layers</b>: lines and polygons, several at once, in any CRS. Curves become chords (2 cm). What
the window cuts becomes open chains; no wall is invented on the border.</p>
<p><b>Window</b>: a centre with width and height in metres, or an extent. Positions may name their CRS, as in
<i>12.5,48.1 [EPSG:4326]</i>; without one they are in the site CRS.</p>
<p><b>Site CRS</b>: in metres, such as the local UTM zone. EPSG:3857 is refused, because its metres are not
metres. Default: the project's CRS; without a project the layers' own. A local engineering CRS is used as it
is.</p>
<p><b>Height, foot, label, outdoors</b>: QGIS expressions; the foot is where a feature begins above the
ground, and its height counts from there. What a layer keeps (menu Fleet Supervisor, Layer roles) wins over
these. There its role makes flights of risers of a layer (stairs) or surfaces without height (ramp), its
filter says which features count, and points of furniture get a shape. Default: the field <i>height</i> or
<i>height_m</i>, on the ground, the layer's name, true. Where no height is known, the default height is used,
said in a warning and marked <i>h=est</i> in the map.</p>
<p><b>Map profile</b>: a file that says by layer name what layers are: <i>openstreetmap</i>,
<i>upc_campus_nord</i> or the path of one's own. It wins over what the layers keep.</p>
<p><b>Smaller maps</b> (advanced, each off unless asked for): only what the robot's plane meets, without
walls between or inside buildings, lines joined, fewer corners, no short segments, heights in steps. The log
says how many obstacles and segments there were before and after. Walls between buildings, corners and short
segments need the Python package shapely 2.</p>
<p><b>Format</b>: text; binary (the text compressed, with a check sum), which needs the Python package
zstandard; compact (about a third of binary, whole centimetres), which needs cbor2 instead. The file
<i>docs/robot-map.md</i> of the project describes them, and exports from a script.</p>
<p>Broken geometry is repaired where that is safe and left out where it is not. Each time a warning names the
layer and the feature; the export goes on.</p>
""")
"""In one line, because QGIS treats every line break as the end of a paragraph."""


# --- ``fleet:exportrobotmap``: obstacle layers and a window in, a robot map out ---

NUMBERS = {
    "OBSTACLE_COUNT": tr("Obstacles"),
    "SEGMENT_COUNT": tr("Segments"),
    "BYTES": tr("Size of the file [bytes]"),
    "BYTES_PER_M2": tr("Compactness [bytes/m²]"),
    "WARNING_COUNT": tr("Warnings"),
}


class ExportRobotMap(FleetAlgorithm):
    """Exports the obstacles in a window as a map for robots (paper 1, section III)."""

    NAME = "exportrobotmap"
    TITLE = tr("Export robot map")
    SUMMARY = tr("Writes the obstacles of line and polygon layers inside a window as a map that robots read.")
    HELP = HELP
    ICON = "export_robot_map.svg"
    TAGS = ("obstacle", "navigation", "segments", "partial map", "qgis_process")

    def initAlgorithm(self, configuration: dict[str, Any] | None = None):
        for parameter in (
            export_parameters.obstacles_parameter(),
            *window_parameters(),
            *value_parameters(),
            profile_parameter(),
            *export_parameters.shaping_parameters(),
            *export_parameters.format_parameters(),
            QgsProcessingParameterFileDestination(
                export_parameters.OUTPUT,
                tr("Robot map"),
                tr("Robot map, text (*.txt);;Robot map, binary (*.rmap)"),
            ),
        ):
            self.addParameter(parameter)
        for name, description in NUMBERS.items():
            self.addOutput(QgsProcessingOutputNumber(name, description))

    def checkParameterValues(self, parameters: Parameters, context: QgsProcessingContext):
        # Before QGIS's own checks, which report an invalid value without the reason.
        problem = window_problem(parameters)
        if problem:
            return False, problem
        fine, message = super().checkParameterValues(parameters, context)
        return (False, message) if not fine else self._check_plan(parameters, context)

    def prepareAlgorithm(
        self, parameters: Parameters, context: QgsProcessingContext, feedback: QgsProcessingFeedback
    ):
        with shown_by_processing():
            self._plan = export_parameters.read_export_parameters(self, parameters, context)
            layers = export_parameters.obstacle_layers(self, parameters, context)
            warn_of_profile(self, parameters, context, layers, feedback)
            self._bounds = _bounds_of(layers, self._plan.site)
        return True

    def processAlgorithm(
        self, parameters: Parameters, context: QgsProcessingContext, feedback: QgsProcessingFeedback
    ):
        with shown_by_processing(feedback):
            plan = self._plan
            border = plan.window.border
            found = export_parameters.obstacle_outlines(plan, plan.window, feedback)
            if found is None:
                return {}
            reading, outlines, robot_map = found
            if robot_map is None:
                robot_map = build_map(outlines, plan.window, plan.meta)
            text, content = plan.format.written(robot_map)
            if feedback.isCanceled():
                return {}
            write_whole(plan.target, content)
            around = SurroundingOutlines(outlines).around(border)
            warnings = _reported(reading, robot_map, around, self._bounds, feedback)
            _report_size(plan.window, robot_map, text, content, feedback)
        feedback.setProgress(100)
        counts = (len(robot_map.obstacles), robot_map.segment_count, len(content))
        figures = (*counts, len(content) / border.area, warnings)
        return {export_parameters.OUTPUT: str(plan.target), **dict(zip(NUMBERS, figures, strict=True))}

    def _check_plan(self, parameters: Parameters, context: QgsProcessingContext) -> tuple[bool, str]:
        """Make the plan once before the run, so that the dialog and scripts get its errors."""
        try:
            export_parameters.read_export_parameters(self, parameters, context)
        except (FleetError, RobotMapError) as error:
            return False, str(error)
        return True, ""


def value_parameters() -> list[QgsProcessingParameterDefinition]:
    """Return the parameters of features' values."""
    base = QgsProcessingParameterExpression(
        export_parameters.BASE_EXPRESSION,
        tr("Foot of each feature above ground [m] (default: on it)"),
        optional=True,
    )
    base.setHelp(
        tr(
            'Such as "clearance" of arches, or 2.2 for signs; the height of a feature counts from there. '
            "The upper height of the robot's plane leaves out what begins above it."
        )
    )
    return [
        QgsProcessingParameterExpression(
            export_parameters.HEIGHT_EXPRESSION,
            tr("Height of each feature [m] (default: its field height)"),
            optional=True,
        ),
        base,
        QgsProcessingParameterNumber(
            export_parameters.DEFAULT_HEIGHT,
            tr("Height where none is known, marked as estimated [m]"),
            QgsProcessingParameterNumber.Type.Double,
            3.0,
        ),
        QgsProcessingParameterExpression(
            export_parameters.SEMANTICS_EXPRESSION,
            tr("Label of each feature (default: the layer's name)"),
            optional=True,
        ),
        QgsProcessingParameterExpression(
            export_parameters.OUTDOOR_EXPRESSION,
            tr("Whether each feature is outdoors (default: true)"),
            optional=True,
        ),
    ]


def _bounds_of(layers: Sequence[QgsVectorLayer], site: SiteGeoreference) -> Bounds | None:
    """Return the bounds in the site frame of all ``layers``, None where those of one are not known."""
    found = []
    for layer in layers:
        extent = layer.extent()
        if not extent.isNull():
            found.append(site.of_layer(layer.name(), layer.crs()).bounds_of(extent))
    known = [one for one in found if one is not None and np.isfinite(one).all()]
    if not known or len(known) < len(found):
        return None
    lower, upper = np.min(known, axis=0), np.max(known, axis=0)
    return float(lower[0]), float(lower[1]), float(upper[2]), float(upper[3])


def _nothing_there(border: Border, bounds: Bounds | None) -> str:
    """Return the warning of a map without obstacles; ``bounds`` are those of the layers."""
    if bounds is not None:
        x_min, y_min, x_max, y_max = bounds
        apart_x = border.x_max < x_min or border.x_min > x_max
        if apart_x or border.y_max < y_min or border.y_min > y_max:
            return tr(
                "There is no obstacle in the window, and no layer reaches it: the layers lie from "
                "({x_min:.0f}, {y_min:.0f}) to ({x_max:.0f}, {y_max:.0f}) in the site frame. Check the order "
                "of the window's numbers, their CRS and the site CRS. To a robot this map says that all is "
                "free.",
                x_min=x_min,
                y_min=y_min,
                x_max=x_max,
                y_max=y_max,
            )
    return tr("There is no obstacle in the window: check its place and the site CRS.")


def _reported(
    reading: ObstacleReading,
    robot_map: RobotMap,
    around: Sequence[str],
    bounds: Bounds | None,
    feedback: QgsProcessingFeedback,
) -> int:
    """Push every warning and return their number.

    ``around`` are obstacles that contain the whole window, ``bounds`` those of the layers in the site frame.
    """
    warnings = [*reading.warnings, *robot_map.warnings, *export_parameters.surrounding_note(around)]
    for warning in warnings:
        feedback.pushWarning(warning)
    if not robot_map.obstacles and not around:
        feedback.pushWarning(_nothing_there(robot_map.border, bounds))
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
