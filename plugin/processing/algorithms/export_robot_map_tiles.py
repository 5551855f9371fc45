"""``fleet:exportrobotmaptiles``: obstacle layers in, many robot maps and their index out."""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from qgis.core import (
    QgsFeature,
    QgsFeedback,
    QgsProcessing,
    QgsProcessingAlgorithm,
    QgsProcessingContext,
    QgsProcessingFeedback,
    QgsProcessingMultiStepFeedback,
    QgsProcessingOutputLayerDefinition,
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
from ....robot_bridge.core.robotmap.builder import SurroundingOutlines
from ....robot_bridge.core.robotmap.model import Border, Window
from ....robot_bridge.core.robotmap.window_index import OutlineIndex
from ...layers.geometry import shapes_of
from ...layers.layer_source import FeatureReader
from ...layers.site_transform import SiteGeoreference
from ...ui.errors import FleetError
from ...ui.language import tr, tr_count, tr_page
from ..common import export_parameters
from ..common.algorithm import FleetAlgorithm, ParameterError, Parameters, fields_of, shown_by_processing
from ..common.map_files import layer_crs
from ..common.outputs import WholeFolder, check_target, fill_sink, polygon, replaced_whole
from ..common.parameters import (
    EXTENT,
    PAPERS_SIDE_M,
    filter_in,
    frame_parameters,
    map_window,
    profile_parameter,
    warn_of_profile,
)
from .export_robot_map import value_parameters

# --- The tiles of a map: in a grid, or along a route ---

MOST_TILES = 10_000


@dataclass(frozen=True)
class Tile:
    """One window: its ``name``; its row and column in a grid, or its route and the metres along it."""

    name: str
    window: Window
    row: int | None = None
    column: int | None = None
    route: int | None = None
    along: float | None = None


@dataclass(frozen=True)
class TileSize:
    """Width along x, height along y, and the overlap of neighbours; metres in the site frame."""

    width: float
    height: float
    overlap: float = 0.0

    def __post_init__(self) -> None:
        for name in ("width", "height"):
            value = getattr(self, name)
            if not (math.isfinite(value) and value >= 1.0):
                raise ParameterError(
                    tr(
                        "The {name} of a tile is {value} m: give at least 1 m, such as 100.",
                        name=name,
                        value=value,
                    )
                )
        if not 0.0 <= self.overlap <= 0.9 * min(self.width, self.height):
            raise ParameterError(
                tr(
                    "OVERLAP is {overlap} m: give 0 or more, and at most nine tenths of a tile's side.",
                    overlap=self.overlap,
                )
            )


def grid_tiles(area: Border, size: TileSize) -> list[Tile]:
    """Return tiles of one size that cover ``area``, from its left-lower corner, row by row.

    The last ones of a row or column reach beyond the area.

    :raises ParameterError: when there would be too many.
    """
    step_x, step_y = size.width - size.overlap, size.height - size.overlap
    columns = _steps(area.x_max - area.x_min - size.overlap, step_x)
    rows = _steps(area.y_max - area.y_min - size.overlap, step_y)
    _check_count(rows * columns)
    return [
        Tile(
            f"tile_r{row + 1:03}_c{column + 1:03}",
            _window(area.x_min + column * step_x, area.y_min + row * step_y, size),
            row=row + 1,
            column=column + 1,
        )
        for row in range(rows)
        for column in range(columns)
    ]


def route_tiles(routes: Sequence[np.ndarray], size: TileSize) -> list[Tile]:
    """Return tiles centred on points of each of ``routes``, (n, 2) metres in the site frame.

    Consecutive tiles share at least the overlap, and every point of a route is at least half of it
    inside a tile. Where routes meet, a duplicate tile is left out.

    :raises ParameterError: when there would be too many, or no route has a length.
    """
    step = min(size.width, size.height) - size.overlap
    along = [np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(route, axis=0).T))]) for route in routes]
    counts = [_steps(float(distance[-1]), step) for distance in along]
    _check_count(sum(counts) + len(counts))
    tiles: list[Tile] = []
    seen: set[Border] = set()
    for number, (route, distance, count) in enumerate(zip(routes, along, counts, strict=True), 1):
        for at in np.linspace(0.0, distance[-1], count + 1):
            x, y = (float(np.interp(at, distance, route[:, axis])) for axis in (0, 1))
            window = _window(x - size.width / 2, y - size.height / 2, size)
            if window.border not in seen:
                seen.add(window.border)
                name = f"route_{len(tiles) + 1:04}"
                tiles.append(Tile(name, window, route=number, along=round(float(at), 2)))
    if not tiles:
        raise ParameterError(tr("ROUTE holds no line: choose a layer with the route to export along."))
    return tiles


def area_of(tiles: Sequence[Tile]) -> Border:
    """Return the rectangle that contains all ``tiles``."""
    corners = np.array([tile.window.border for tile in tiles])
    low, high = corners[:, :2].min(axis=0), corners[:, 2:].max(axis=0)
    return Border(float(low[0]), float(low[1]), float(high[0]), float(high[1]))


def _window(x: float, y: float, size: TileSize) -> Window:
    # In whole centimetres, so that neighbours without overlap share their side exactly.
    x, y = round(x, 2), round(y, 2)
    return Window.from_bounds(x, y, x + size.width, y + size.height)


def _steps(length: float, step: float) -> int:
    # A millimetre more than whole steps is a rounding error, not a step.
    return max(math.ceil((length - 1e-3) / step), 1)


def _check_count(count: int) -> None:
    if count > MOST_TILES:
        raise ParameterError(
            tr(
                "That would be {count} tiles, and {most_tiles} are the most: choose larger tiles, less "
                "overlap or a smaller area.",
                count=count,
                most_tiles=MOST_TILES,
            )
        )


# --- The plan of an export of tiles, checked before it starts ---

ROUTE, TILE_WIDTH, TILE_HEIGHT, OVERLAP = "ROUTE", "TILE_WIDTH", "TILE_HEIGHT", "OVERLAP"
FOLDER, INDEX, SKIP_EMPTY = "OUTPUT", "INDEX", "SKIP_EMPTY"


@dataclass(frozen=True)
class TileParameters(export_parameters.ObstacleParameters):
    """Everything from the parameters and layers that the export of tiles needs.

    ``index`` is the file of the index, None if it is not a file; ``warnings`` are about the route.
    """

    tiles: list[Tile]
    folder: Path
    index: Path | None
    warnings: list[str]


def tiles_problem(parameters: Parameters) -> str:
    """Return the error in the choice of area, or an empty text."""
    has_extent, has_route = (parameters.get(name) not in (None, "") for name in (EXTENT, ROUTE))
    if has_extent and has_route:
        return tr("Both EXTENT and ROUTE are given: give one of them, for a grid or for tiles along a route.")
    if not has_extent and not has_route:
        return tr(
            "Neither EXTENT nor ROUTE is given: give an extent for a grid, or a layer of lines to follow."
        )
    return ""


def read_tile_parameters(
    algorithm: QgsProcessingAlgorithm, parameters: Parameters, context: QgsProcessingContext
) -> TileParameters:
    """Return the plan for ``parameters``; must be called in the main thread.

    :raises FleetError: when a parameter or a layer cannot be used.
    :raises WindowError: when the extent encloses nothing.
    """
    plan = export_parameters.read_obstacle_parameters(algorithm, parameters, context)
    numbers = (
        algorithm.parameterAsDouble(parameters, n, context) for n in (TILE_WIDTH, TILE_HEIGHT, OVERLAP)
    )
    size = TileSize(*numbers)
    warnings: list[str] = []
    if parameters.get(ROUTE) not in (None, ""):
        tiles = route_tiles(_routes(algorithm, parameters, context, plan.site, warnings), size)
    else:
        area = map_window(algorithm, parameters, context, plan.site.crs, plan.site.frame)
        tiles = grid_tiles(area.border, size)
    folder = Path(algorithm.parameterAsFileOutput(parameters, FOLDER, context))
    if folder.exists() and not folder.is_dir():
        raise ParameterError(tr("OUTPUT {folder} is a file: choose a folder for the tiles.", folder=folder))
    index = _index_file(parameters)
    if index is not None and index.parent != folder:
        # It is written after the tiles.
        check_target(index, tr("The index"))
    return TileParameters(**vars(plan), tiles=tiles, folder=folder, index=index, warnings=warnings)


def _index_file(parameters: Parameters) -> Path | None:
    """Return the file of the index, None if it is not a file."""
    value = parameters.get(INDEX)
    if isinstance(value, QgsProcessingOutputLayerDefinition):
        value = value.sink.staticValue()
    # Neither TEMPORARY_OUTPUT nor a provider prefix, such as memory: or postgres:, is a file.
    is_file = isinstance(value, str) and Path(value).suffix and not re.match(r"\w{2,}:", value)
    return Path(value) if is_file else None


def _routes(
    algorithm: QgsProcessingAlgorithm,
    parameters: Parameters,
    context: QgsProcessingContext,
    site: SiteGeoreference,
    warnings: list[str],
) -> list[np.ndarray]:
    """Return each line of ROUTE as (n, 2) metres in the site frame; ``warnings`` receive omissions."""
    source = algorithm.parameterAsSource(parameters, ROUTE, context)
    if source is None:
        raise ParameterError(
            tr("ROUTE {route} cannot be opened: choose a layer of lines.", route=parameters[ROUTE])
        )
    placing = site.of_layer(source.sourceName(), source.sourceCrs())
    counted = filter_in(algorithm, parameters, ROUTE, context)
    routes = []
    for feature, counts, geometry, notes in FeatureReader(
        source.sourceName(), source, placing, counted, QgsFeedback()
    ):
        if notes and not counts:
            raise _doubtful(feature, source.sourceName(), notes[0])
        shapes, odd = ([], []) if geometry is None else shapes_of(geometry)
        warnings += [
            tr("Layer {layer}, feature {id}: {note}", layer=source.sourceName(), id=feature.id(), note=note)
            for note in (*notes, *odd)
        ]
        routes += [placing.to_site(shape.points) for shape in shapes]
    return routes


def _doubtful(feature: QgsFeature, layer: str, doubt: str) -> ParameterError:
    return ParameterError(
        tr(
            "ROUTE: feature {id} of {layer}: {doubts}. Correct the filter of the layer.",
            id=feature.id(),
            layer=layer,
            doubts=doubt,
        )
    )


# --- The algorithm ---

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
            export_parameters.obstacles_parameter(),
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
            *export_parameters.shaping_parameters(),
            *export_parameters.format_parameters(),
            QgsProcessingParameterFolderDestination(FOLDER, tr("Folder of the tiles")),
            QgsProcessingParameterFeatureSink(INDEX, tr("Index of the tiles"), kinds.TypeVectorPolygon),
        ):
            self.addParameter(parameter)
        for name, title in NUMBERS.items():
            self.addOutput(QgsProcessingOutputNumber(name, title))

    def checkParameterValues(self, parameters: Parameters, context: QgsProcessingContext):
        problem = tiles_problem(parameters)
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
            layers = export_parameters.obstacle_layers(self, parameters, context)
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
            found = export_parameters.obstacle_outlines(plan, Window.from_bounds(*area_of(plan.tiles)), steps)
            if found is None:
                return {}
            reading, outlines, _ = found
            steps.setCurrentStep(1)
            skip_empty = self.parameterAsBool(parameters, SKIP_EMPTY, context)
            maker = _TileMaker(plan, [*plan.warnings, *reading.warnings], skip_empty)
            if not maker.make_all(OutlineIndex.of(outlines), folder, steps):
                return {}
            folder.publish()
            # Only now, so that no index lists missing tiles.
            with replaced_whole(plan.index, tr("The index")):
                index = self._write_index(parameters, context, maker.rows)
        self.remember({INDEX: index})
        feedback.setProgress(100)
        return {FOLDER: str(plan.folder), INDEX: index, **maker.reported(feedback)}

    def _write_index(self, parameters: Parameters, context: QgsProcessingContext, rows: list) -> str:
        """Write the index; return its layer."""
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
        # A note about an outline occurs with every tile that it touches, but is reported once.
        self._notes: dict[str, None] = dict.fromkeys(warnings)
        self._around: dict[str, None] = {}
        self.rows: list = []

    def make_all(self, index: OutlineIndex, folder: WholeFolder, feedback: QgsProcessingFeedback) -> bool:
        """Add every tile to ``folder``; return False if cancelled."""
        surrounding = SurroundingOutlines(index.outlines)
        for number, tile in enumerate(self._plan.tiles, 1):
            if feedback.isCanceled():
                return False
            self._make(tile, index, folder)
            self._around.update(dict.fromkeys(surrounding.around(tile.window.border)))
            feedback.setProgress(100 * number / len(self._plan.tiles))
        return not feedback.isCanceled()

    def reported(self, feedback: QgsProcessingFeedback) -> dict[str, int]:
        """Push the warnings and the sums, and return the figures of the outputs."""
        notes = [*self._notes, *export_parameters.surrounding_note(list(self._around))]
        for note in notes:
            feedback.pushWarning(note)
        warnings = len(notes)
        obstacles, segments, size = (int(count) for count in self._counts)
        if not obstacles and not self._around:
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
