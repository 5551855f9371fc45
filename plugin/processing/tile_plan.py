"""What an export of tiles will do, settled and checked before it starts."""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from qgis.core import (
    QgsFeature,
    QgsProcessingAlgorithm,
    QgsProcessingContext,
    QgsProcessingOutputLayerDefinition,
)

from ..language import tr
from ..sites.feature_filter import FeatureFilter
from ..sites.placing import SitePlacing
from ..sites.shapes import shapes_of
from .errors import ParameterError
from .export_plan import ObstaclePlan, obstacle_plan_of
from .fleet_algorithm import Parameters
from .map_profile import filter_in
from .map_window import EXTENT, map_window
from .tile_windows import Tile, TileSize, grid_tiles, route_tiles
from .whole_file import check_target

ROUTE, TILE_WIDTH, TILE_HEIGHT, OVERLAP = "ROUTE", "TILE_WIDTH", "TILE_HEIGHT", "OVERLAP"
FOLDER, INDEX, SKIP_EMPTY = "OUTPUT", "INDEX", "SKIP_EMPTY"


@dataclass(frozen=True)
class TilePlan(ObstaclePlan):
    """Everything that is needed of the parameters and layers to export tiles.

    ``index`` is the file that the index is to be, None where it is none; ``warnings`` are about the route.
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


def tile_plan_of(
    algorithm: QgsProcessingAlgorithm, parameters: Parameters, context: QgsProcessingContext
) -> TilePlan:
    """Return the plan for ``parameters``; to be called in the main thread.

    :raises FleetError: when a parameter or a layer cannot be used.
    :raises WindowError: when the extent encloses nothing.
    """
    plan = obstacle_plan_of(algorithm, parameters, context)
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
    return TilePlan(**vars(plan), tiles=tiles, folder=folder, index=index, warnings=warnings)


def _index_file(parameters: Parameters) -> Path | None:
    """Return the file that the index is to be, None where it is none."""
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
    site: SitePlacing,
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
    for feature in source.getFeatures():
        if not _counts(feature, source.sourceName(), counted):
            continue
        notes: list[str] = []
        geometry = placing.of_feature(feature, notes)
        shapes, odd = ([], []) if geometry is None else shapes_of(geometry)
        warnings += [
            tr("Layer {layer}, feature {id}: {note}", layer=source.sourceName(), id=feature.id(), note=note)
            for note in (*notes, *odd)
        ]
        routes += [placing.to_site(shape.points) for shape in shapes]
    return routes


def _counts(feature: QgsFeature, layer: str, counted: FeatureFilter | None) -> bool:
    doubts: list[str] = []
    kept = counted is None or counted.keeps(feature, doubts)
    if doubts:
        raise ParameterError(
            tr(
                "ROUTE: feature {id} of {layer}: {doubts}. Correct the filter of the layer.",
                id=feature.id(),
                layer=layer,
                doubts=doubts[0],
            )
        )
    return kept
