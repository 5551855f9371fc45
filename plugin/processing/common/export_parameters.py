"""Parameters of an export, whole or in tiles, checked before it starts, and the obstacles that it reads."""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

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
    QgsProcessingParameterDefinition,
    QgsProcessingParameterMultipleLayers,
    QgsProviderRegistry,
    QgsVectorLayer,
)

from ....robot_bridge.core.errors import MapCancelledError
from ....robot_bridge.core.robotmap.builder import build_map
from ....robot_bridge.core.robotmap.model import Border, RobotMap, Window
from ....robot_bridge.core.robotmap.outlines import Outlines
from ....robot_bridge.core.robotmap.shaping import Shaping, shaped
from ...layers.geometry import shapes_of
from ...layers.layer_source import FeatureReader, ObstacleSource, obstacle_sources
from ...layers.obstacle_layers import ObstacleReading, check_sources, read_outlines
from ...layers.roles import OBSTACLE_ROLES, LayerExpressions
from ...layers.site_transform import SiteGeoreference
from ...ui.errors import LayerTypeError
from ...ui.language import tr
from .algorithm import ParameterError, Parameters
from .map_files import obstacles_in_words
from .map_parameters import EXTENT, LOCAL, MapFormat, map_window, read_map_format, read_shaping, site_frame
from .outputs import OutputError, check_target
from .parameters import chosen_crs, filter_in, layers_of_project, layers_problem, setups_of

# --- What an export will do, settled and checked before it starts ---

OBSTACLES, OUTPUT = "OBSTACLES", "OUTPUT"
HEIGHT_EXPRESSION, DEFAULT_HEIGHT = "HEIGHT_EXPRESSION", "DEFAULT_HEIGHT"
BASE_EXPRESSION = "BASE_EXPRESSION"
SEMANTICS_EXPRESSION, OUTDOOR_EXPRESSION = "SEMANTICS_EXPRESSION", "OUTDOOR_EXPRESSION"
GENERAL = {
    "height": HEIGHT_EXPRESSION,
    "base": BASE_EXPRESSION,
    "semantics": SEMANTICS_EXPRESSION,
    "outdoor": OUTDOOR_EXPRESSION,
}
"""The parameters whose expressions count for layers that have none of their own."""


@dataclass(frozen=True)
class ObstacleParameters:
    """What is read, where it lies, what is made of it and how it is written; usable from any thread."""

    sources: list[ObstacleSource]
    site: SiteGeoreference
    default_height: float
    shaping: Shaping | None
    format: MapFormat

    @property
    def meta(self) -> dict[str, str]:
        """The leading lines of the map, spelled as those of a published site are."""
        frame = self.site.frame
        if not self.site.crs.isValid():
            return {}
        return {
            "crs": frame.crs,
            "origin": f"{frame.origin[0]:.3f},{frame.origin[1]:.3f}",
            "rotation": f"{frame.rotation:.9f}",
        }


@dataclass(frozen=True)
class ExportParameters(ObstacleParameters):
    """Everything that is needed of the parameters and layers to export one window."""

    window: Window
    target: Path


def read_export_parameters(
    algorithm: QgsProcessingAlgorithm, parameters: Parameters, context: QgsProcessingContext
) -> ExportParameters:
    """Return the plan for ``parameters``; to be called in the main thread.

    :raises FleetError: when a parameter or a layer cannot be used.
    :raises WindowError: when the window encloses nothing.
    """
    plan = read_obstacle_parameters(algorithm, parameters, context)
    return ExportParameters(
        **vars(plan),
        window=map_window(algorithm, parameters, context, plan.site.crs, plan.site.frame),
        target=_target(algorithm, parameters, context),
    )


def read_obstacle_parameters(
    algorithm: QgsProcessingAlgorithm, parameters: Parameters, context: QgsProcessingContext
) -> ObstacleParameters:
    """Return what is read for ``parameters``; to be called in the main thread.

    :raises FleetError: when a parameter or a layer cannot be used.
    :raises RobotMapError: when something asked for needs a package that this Python does not have.
    """
    layers = obstacle_layers(algorithm, parameters, context)
    # As strings: parameterAsExpression replaces what is no expression by the default, in silence.
    general = LayerExpressions(
        **{what: algorithm.parameterAsString(parameters, name, context) for what, name in GENERAL.items()}
    )
    setups = setups_of(algorithm, parameters, context)
    scopes = algorithm.createExpressionContext(parameters, context)
    sources = obstacle_sources(layers, general, scopes, setups)
    crs = chosen_crs(algorithm, parameters, context, [source.crs for source in sources])
    frame = site_frame(algorithm, parameters, context, crs)
    local = algorithm.parameterAsBool(parameters, LOCAL, context)
    site = SiteGeoreference(crs, frame, context.transformContext(), local)
    check_sources(sources, site)
    shaping = read_shaping(algorithm, parameters, context)
    return ObstacleParameters(
        sources,
        site,
        default_height(algorithm, parameters, context),
        shaping,
        read_map_format(algorithm, parameters, context),
    )


def obstacles_parameter() -> QgsProcessingParameterDefinition:
    """Return the parameter of the layers that are read."""
    return QgsProcessingParameterMultipleLayers(
        OBSTACLES,
        tr("Obstacle layers (default: those of the project with such a role)"),
        QgsProcessing.SourceType.TypeVectorAnyGeometry,
        optional=True,
    )


def obstacle_layers(
    algorithm: QgsProcessingAlgorithm, parameters: Parameters, context: QgsProcessingContext
) -> list[QgsVectorLayer]:
    """Return the layers in OBSTACLES; without any the project's that have a role of obstacles.

    :raises LayerTypeError: naming the first that cannot be read or is no vector layer.
    :raises ParameterError: when there are none.
    """
    if not parameters.get(OBSTACLES):
        setups = setups_of(algorithm, parameters, context)
        found = layers_of_project(context.project(), OBSTACLE_ROLES, setups)
        if not found:
            raise ParameterError(
                tr(
                    "No obstacle layer is given, and no layer of the project has a role of obstacles. Give "
                    "OBSTACLES, roles (Fleet Supervisor > Layer roles), or a PROFILE."
                )
            )
        return found
    problem = layers_problem(parameters, OBSTACLES, context)
    if problem:
        raise LayerTypeError(problem)
    layers = algorithm.parameterAsLayerList(parameters, OBSTACLES, context)
    for layer in layers:
        if not isinstance(layer, QgsVectorLayer):
            raise LayerTypeError(
                tr("The layer {layer} is no vector layer: leave it out.", layer=layer.name())
            )
    return layers


def default_height(
    algorithm: QgsProcessingAlgorithm, parameters: Parameters, context: QgsProcessingContext
) -> float:
    """Return DEFAULT_HEIGHT in metres.

    :raises ParameterError: when it is none.
    """
    height = algorithm.parameterAsDouble(parameters, DEFAULT_HEIGHT, context)
    if not 0 <= height < math.inf:
        raise ParameterError(
            tr("DEFAULT_HEIGHT is {height}: give a number of metres of 0 or more.", height=height)
        )
    return height


def _target(algorithm: QgsProcessingAlgorithm, parameters: Parameters, context: QgsProcessingContext) -> Path:
    target = Path(algorithm.parameterAsFileOutput(parameters, OUTPUT, context))
    check_target(target, tr("The robot map"))
    for layer in obstacle_layers(algorithm, parameters, context):
        path = QgsProviderRegistry.instance().decodeUri(layer.providerType(), layer.source()).get("path")
        if path and target.exists() and Path(path).exists() and target.samefile(path):
            raise OutputError(
                tr(
                    "OUTPUT {target} is the file of the layer {layer}: choose another one.",
                    target=target,
                    layer=layer.name(),
                )
            )
    return target


# --- The obstacles of an export: read from their layers, then reduced to what is asked for ---


def obstacle_outlines(
    plan: ObstacleParameters, area: Window, feedback: QgsProcessingFeedback
) -> tuple[ObstacleReading, Outlines, RobotMap | None] | None:
    """Return what was read in ``area`` and the outlines of which maps are built; None after a cancel.

    Last comes the map of ``area``, where it was built to say how much is reduced.

    :raises LayerReadingError: when a layer cannot be read.
    :raises MissingGeometryError: when a package is missing.
    """
    steps = QgsProcessingMultiStepFeedback(1 if plan.shaping is None else 2, feedback)
    reading = read_outlines(plan.sources, plan.site, area.border, plan.default_height, steps)
    if not reading.complete:
        return None
    if plan.shaping is None:
        return reading, reading.outlines(), None
    steps.setCurrentStep(1)
    made = _reduced(reading.outlines(), plan, plan.shaping, area, steps)
    return None if made is None else (reading, *made)


def _reduced(
    outlines: Outlines,
    plan: ObstacleParameters,
    shaping: Shaping,
    area: Window,
    feedback: QgsProcessingFeedback,
) -> tuple[Outlines, RobotMap] | None:
    """Return the reduced outlines and their map of ``area``, None after a cancel; say what is other there."""
    feedback.setProgressText(tr("Reducing obstacles"))
    try:
        made = shaped(outlines, shaping, lambda share: feedback.setProgress(100 * share), feedback.isCanceled)
    except MapCancelledError:
        return None
    before, after = build_map(outlines, area), build_map(made, area, plan.meta)
    # Fewer walls can be more obstacles: what is left of a ring is open chains.
    feedback.pushInfo(
        tr(
            "{before} became {after}",
            before=obstacles_in_words(len(before.obstacles), before.segment_count),
            after=obstacles_in_words(len(after.obstacles), after.segment_count),
        )
    )
    return made, after


# --- Where the tiles of a map lie: in a grid, or along a route ---

MOST_TILES = 10_000


@dataclass(frozen=True)
class Tile:
    """One window: its ``name``; its row and column in a grid, or how many metres along which route."""

    name: str
    window: Window
    row: int | None = None
    column: int | None = None
    route: int | None = None
    along: float | None = None


@dataclass(frozen=True)
class TileSize:
    """Width along x, height along y, and what neighbours share; metres in the site frame."""

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

    Two that follow each other share at least the overlap, and every point of a route is at least half of it
    inside a tile. Where routes meet, a tile that is there already is left out.

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
    """Return the rectangle that holds all ``tiles``."""
    corners = np.array([tile.window.border for tile in tiles])
    low, high = corners[:, :2].min(axis=0), corners[:, 2:].max(axis=0)
    return Border(float(low[0]), float(low[1]), float(high[0]), float(high[1]))


def _window(x: float, y: float, size: TileSize) -> Window:
    # In whole centimetres, so that neighbours without overlap share their side to the digit.
    x, y = round(x, 2), round(y, 2)
    return Window.from_bounds(x, y, x + size.width, y + size.height)


def _steps(length: float, step: float) -> int:
    # A millimetre more than whole steps is rounding, not a step.
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


# --- What an export of tiles will do, settled and checked before it starts ---

ROUTE, TILE_WIDTH, TILE_HEIGHT, OVERLAP = "ROUTE", "TILE_WIDTH", "TILE_HEIGHT", "OVERLAP"
FOLDER, INDEX, SKIP_EMPTY = "OUTPUT", "INDEX", "SKIP_EMPTY"


@dataclass(frozen=True)
class TileParameters(ObstacleParameters):
    """Everything that is needed of the parameters and layers to export tiles.

    ``index`` is the file of the index, None where it is none; ``warnings`` are about the route.
    """

    tiles: list[Tile]
    folder: Path
    index: Path | None
    warnings: list[str]


def tiles_problem(parameters: Parameters) -> str:
    """Return what is wrong with the choice of area, or nothing."""
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
    """Return the plan for ``parameters``; to be called in the main thread.

    :raises FleetError: when a parameter or a layer cannot be used.
    :raises WindowError: when the extent encloses nothing.
    """
    plan = read_obstacle_parameters(algorithm, parameters, context)
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
        # It comes after the tiles are there.
        check_target(index, tr("The index"))
    return TileParameters(**vars(plan), tiles=tiles, folder=folder, index=index, warnings=warnings)


def _index_file(parameters: Parameters) -> Path | None:
    """Return the file of the index, None where it is none."""
    value = parameters.get(INDEX)
    if isinstance(value, QgsProcessingOutputLayerDefinition):
        value = value.sink.staticValue()
    # Neither TEMPORARY_OUTPUT nor what begins with a provider, such as memory: or postgres:, is a file.
    is_file = isinstance(value, str) and Path(value).suffix and not re.match(r"\w{2,}:", value)
    return Path(value) if is_file else None


def _routes(
    algorithm: QgsProcessingAlgorithm,
    parameters: Parameters,
    context: QgsProcessingContext,
    site: SiteGeoreference,
    warnings: list[str],
) -> list[np.ndarray]:
    """Return each line of ROUTE as (n, 2) metres in the site frame; ``warnings`` get what is left out."""
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
