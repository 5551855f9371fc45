"""``fleet:exportrobotmaptiles``: obstacle layers in, many robot maps and an index of them out."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from qgis.core import (
    QgsProcessing,
    QgsProcessingContext,
    QgsProcessingFeedback,
    QgsProcessingMultiStepFeedback,
    QgsProcessingOutputNumber,
    QgsProcessingParameterBoolean,
    QgsProcessingParameterExtent,
    QgsProcessingParameterFeatureSink,
    QgsProcessingParameterFeatureSource,
    QgsProcessingParameterFolderDestination,
    QgsProcessingParameterNumber,
    QgsWkbTypes,
)

from ....robot_bridge.core.errors import RobotMapError
from ....robot_bridge.core.robotmap.model import Window
from ....robot_bridge.core.robotmap.window_index import OutlineIndex
from ...ui.errors import FleetError
from ...ui.language import tr, tr_count, tr_page
from ..common.algorithm import FleetAlgorithm, Parameters, fields_of, shown_by_processing
from ..common.export_parameters import (
    FOLDER,
    INDEX,
    OBSTACLES,
    OVERLAP,
    ROUTE,
    SKIP_EMPTY,
    TILE_HEIGHT,
    TILE_WIDTH,
    Tile,
    TileParameters,
    area_of,
    obstacle_layers,
    obstacle_outlines,
    obstacles_parameter,
    read_tile_parameters,
    tiles_problem,
)
from ..common.map_files import layer_crs
from ..common.map_parameters import (
    EXTENT,
    PAPERS_SIDE_M,
    format_parameters,
    frame_parameters,
    shaping_parameters,
)
from ..common.outputs import WholeFolder, fill_sink, polygon, replaced_whole
from ..common.parameters import layers_problem, profile_parameter, warn_of_profile
from .export_robot_map import value_parameters

_FIELDS = {
    "tile": "string",
    "file": "string",
    "row": "integer",
    "col": "integer",
    "route": "integer",
    "along_m": "double",
    "x_min": "double",
    "y_min": "double",
    "x_max": "double",
    "y_max": "double",
    "obstacles": "integer",
    "segments": "integer",
    "bytes": "int8",
    "bytes_per_m2": "double",
}
NUMBERS = {
    "TILE_COUNT": tr("Tiles"),
    "OBSTACLE_COUNT": tr("Obstacles in all tiles"),
    "SEGMENT_COUNT": tr("Segments in all tiles"),
    "BYTES": tr("Size of all tiles [bytes]"),
    "WARNING_COUNT": tr("Warnings"),
}
_REAL = QgsProcessingParameterNumber.Type.Double


class ExportRobotMapTiles(FleetAlgorithm):
    """Exports a site as many maps, in a grid or along a route."""

    NAME = "exportrobotmaptiles"
    TITLE = tr("Export robot map tiles")
    SUMMARY = tr("Writes many robot maps, in a grid or along a route, and a layer that tells which is where.")
    ICON = "export_robot_map_tiles.svg"
    TAGS = ("tiles", "grid", "route", "batch", "obstacle", "partial map")
    STYLES = {INDEX: "robot_map_tiles.qml"}  # noqa: RUF012
    HELP = tr_page("""
    <p>Writes one robot map for each tile, as <i>Export robot map</i> does for one window, and an index: a
    polygon for each tile with its file, border, counts and bytes. The layers are read once.</p>
    <p><b>Grid</b>: tiles of one size from the left-lower corner of the extent; the last ones reach beyond it.
    <b>Route</b>: tiles centred on the lines of a layer, so close that two that follow each other share the
    overlap. Sizes are in metres along the site's axes.</p>
    <p><b>Advanced</b>: obstacles are reduced as in <i>Export robot map</i>, before the tiles are cut. The log
    says how many obstacles and segments the whole area had before and after.</p>
    <p>An obstacle has the same id in every tile that it reaches into. Either every tile and the index are
    there at the end, or, after a cancel or an error, none of them.</p>
    """)

    def initAlgorithm(self, configuration: dict[str, Any] | None = None):
        kinds = QgsProcessing.SourceType
        for parameter in (
            obstacles_parameter(),
            QgsProcessingParameterExtent(EXTENT, tr("Extent of a grid (or choose a route)"), optional=True),
            QgsProcessingParameterFeatureSource(
                ROUTE, tr("Route, instead of a grid"), [kinds.TypeVectorLine], optional=True
            ),
            QgsProcessingParameterNumber(
                TILE_WIDTH, tr("Width of a tile, along x [m]"), _REAL, PAPERS_SIDE_M
            ),
            QgsProcessingParameterNumber(
                TILE_HEIGHT, tr("Height of a tile, along y [m]"), _REAL, PAPERS_SIDE_M
            ),
            QgsProcessingParameterNumber(OVERLAP, tr("What neighbouring tiles share [m]"), _REAL, 10.0),
            QgsProcessingParameterBoolean(SKIP_EMPTY, tr("Leave out tiles without obstacles"), False),
            *frame_parameters(),
            *value_parameters(),
            profile_parameter(),
            *shaping_parameters(),
            *format_parameters(),
            QgsProcessingParameterFolderDestination(FOLDER, tr("Folder of the tiles")),
            QgsProcessingParameterFeatureSink(INDEX, tr("Index of the tiles"), kinds.TypeVectorPolygon),
        ):
            self.addParameter(parameter)
        for name, title in NUMBERS.items():
            self.addOutput(QgsProcessingOutputNumber(name, title))

    def checkParameterValues(self, parameters: Parameters, context: QgsProcessingContext):
        problem = tiles_problem(parameters) or layers_problem(parameters, OBSTACLES, context)
        if problem:
            return False, problem
        fine, message = super().checkParameterValues(parameters, context)
        if not fine:
            return False, message
        try:
            read_tile_parameters(self, parameters, context)
        except (FleetError, RobotMapError) as error:
            return False, str(error)
        return True, ""

    def prepareAlgorithm(
        self, parameters: Parameters, context: QgsProcessingContext, feedback: QgsProcessingFeedback
    ):
        with shown_by_processing():
            self._plan = read_tile_parameters(self, parameters, context)
            layers = obstacle_layers(self, parameters, context)
            warn_of_profile(self, parameters, context, layers, feedback)
        self._fields = fields_of(_FIELDS)
        return True

    def processAlgorithm(
        self, parameters: Parameters, context: QgsProcessingContext, feedback: QgsProcessingFeedback
    ):
        plan = self._plan
        steps = QgsProcessingMultiStepFeedback(2, feedback)
        with shown_by_processing(feedback), WholeFolder(plan.folder, tr("The set of tiles")) as folder:
            if feedback.isCanceled():
                return {}
            found = obstacle_outlines(plan, Window.from_bounds(*area_of(plan.tiles)), steps)
            if found is None:
                return {}
            reading, outlines, _ = found
            steps.setCurrentStep(1)
            skip_empty = self.parameterAsBool(parameters, SKIP_EMPTY, context)
            maker = _TileMaker(plan, [*plan.warnings, *reading.warnings], skip_empty)
            if not maker.make_all(OutlineIndex.of(outlines), folder, steps):
                return {}
            folder.publish()
            # Only now, so that no index tells of tiles that are not there.
            with replaced_whole(plan.index, tr("The index")):
                index = self._write_index(parameters, context, maker.rows)
        self.remember({INDEX: index})
        feedback.setProgress(100)
        return {FOLDER: str(plan.folder), INDEX: index, **maker.reported(feedback)}

    def _write_index(self, parameters: Parameters, context: QgsProcessingContext, rows: list) -> str:
        """Write the index; return the layer that it is."""
        crs = layer_crs(self._plan.site.crs)
        sink, index = self.parameterAsSink(
            parameters, INDEX, context, self._fields, QgsWkbTypes.Type.Polygon, crs
        )
        fill_sink(sink, self._fields, rows, QgsProcessingFeedback())
        return index


class _TileMaker:
    """Makes the tiles of a plan one by one; ``rows`` become the features of the index."""

    def __init__(self, plan: TileParameters, warnings: Sequence[str], skip_empty: bool):
        self._plan, self._skip_empty = plan, skip_empty
        self._counts = np.zeros(3, dtype=np.int64)
        # A note about an outline comes with every tile that it touches: said once.
        self._notes: dict[str, None] = dict.fromkeys(warnings)
        self.rows: list = []

    def make_all(self, index: OutlineIndex, folder: WholeFolder, feedback: QgsProcessingFeedback) -> bool:
        """Add every tile to ``folder``; return False when cancelled on the way."""
        for number, tile in enumerate(self._plan.tiles, 1):
            if feedback.isCanceled():
                return False
            self._make(tile, index, folder)
            feedback.setProgress(100 * number / len(self._plan.tiles))
        return not feedback.isCanceled()

    def reported(self, feedback: QgsProcessingFeedback) -> dict[str, int]:
        """Push the warnings and the sums, and return the figures of the outputs."""
        for note in self._notes:
            feedback.pushWarning(note)
        warnings = len(self._notes)
        obstacles, segments, size = (int(count) for count in self._counts)
        if not obstacles:
            feedback.pushWarning(tr("There is no obstacle in any tile: check their place and the site CRS."))
            warnings += 1
        feedback.pushInfo(
            tr(
                "{tiles}, {segments}, {size} bytes",
                tiles=tr_count(len(self.rows), "1 tile", "%n tiles"),
                segments=tr_count(segments, "1 segment", "%n segments"),
                size=size,
            )
        )
        return dict(zip(NUMBERS, (len(self.rows), obstacles, segments, size, warnings), strict=True))

    def _make(self, tile: Tile, index: OutlineIndex, folder: WholeFolder) -> None:
        robot_map = index.map_of(tile.window, self._plan.meta)
        self._notes.update(dict.fromkeys(robot_map.warnings))
        if self._skip_empty and not robot_map.obstacles:
            return
        content = self._plan.format.written(robot_map)[1]
        name = f"{tile.name}.{self._plan.format.suffix}"
        folder.add(name, content)
        counts = (len(robot_map.obstacles), robot_map.segment_count, len(content))
        self._counts += counts
        border = robot_map.border
        x_min, y_min, x_max, y_max = border
        ring = np.array([[x_min, y_min], [x_max, y_min], [x_max, y_max], [x_min, y_max], [x_min, y_min]])
        outline = polygon([self._plan.site.frame.to_crs(ring)])
        place = (tile.row, tile.column, tile.route, tile.along)
        values = [tile.name, name, *place, *border, *counts, len(content) / border.area]
        self.rows.append((outline, values))
