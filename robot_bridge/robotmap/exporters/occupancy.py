"""A robot map as an occupancy grid, the map that Nav2 and AMCL read."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from ..model import Obstacle, RobotMap, ShapeType
from .grid import LARGEST_GRID, Grid
from .lines import flanks_of
from .raster import enclosed_cells, touched_cells
from .solids import edges_of, solids_of

FREE, OCCUPIED, UNKNOWN = 0, 100, -1
"""Values of nav_msgs/OccupancyGrid."""

Inside = Literal["unknown", "occupied"]


@dataclass(frozen=True, eq=False)
class Occupancy:
    """``cells`` is (rows, columns) int8 of FREE, OCCUPIED and UNKNOWN; row 0 is the lowest."""

    grid: Grid
    cells: NDArray[Any]
    warnings: tuple[str, ...] = ()


def occupancy_of(
    robot_map: RobotMap,
    resolution: float = 0.05,
    *,
    inside: Inside = "unknown",
    drives_over: float = 0.0,
    limit: int = LARGEST_GRID,
) -> Occupancy:
    """Return the grid of a map, with the site frame as its frame.

    Every cell that a segment touches is occupied. Cells whose centre lies in an obstacle are unknown: the map
    says where its wall is and nothing of what is behind, and a laser scan matched against a solid block would
    fit as well a metre too deep. The wall has no gap, so a planner enters neither way; ``inside="occupied"``
    fills it for those that want it. Courtyards and everything else within the border are free, cells whose
    centre lies beyond the border unknown. Segments lower than ``drives_over`` metres and ramps are no
    obstacle; stairs are, with their flanks.

    :raises GridError: when the resolution is no length or the grid would have more than ``limit`` cells.
    """
    grid = Grid.covering(robot_map.border, resolution, limit)
    solids, warnings = solids_of(robot_map)
    kept = [solid.ring for solid in solids if not _driven_over(solid.obstacle, drives_over).all()]
    cells = np.full((grid.rows, grid.columns), FREE, dtype=np.int8)
    cells[enclosed_cells(grid, *edges_of(kept))] = OCCUPIED if inside == "occupied" else UNKNOWN
    _forget_beyond(robot_map, grid, cells)
    cells[touched_cells(grid, *_walls(robot_map, drives_over))] = OCCUPIED
    return Occupancy(grid, cells, tuple(warnings))


def _walls(robot_map: RobotMap, drives_over: float) -> tuple[NDArray[Any], NDArray[Any]]:
    """Return the segments that stand in the way, a→b, (n, 2) each."""
    starts, ends = [np.empty((0, 2))], [np.empty((0, 2))]
    for obstacle in robot_map.obstacles:
        stands = ~_driven_over(obstacle, drives_over)
        starts.append(obstacle.a[stands])
        ends.append(obstacle.b[stands])
        if obstacle.shape_type is ShapeType.STAIRS and stands.any():
            sides = flanks_of(obstacle)
            starts.append(sides[0])
            ends.append(sides[1])
    return np.concatenate(starts), np.concatenate(ends)


def _driven_over(obstacle: Obstacle, drives_over: float) -> NDArray[Any]:
    """Tell which segments a robot drives over; a flight of stairs is judged by its highest riser."""
    if obstacle.shape_type is ShapeType.RAMP:
        return np.ones(len(obstacle.a), dtype=bool)
    if obstacle.shape_type is ShapeType.STAIRS:
        return np.full(len(obstacle.a), bool((obstacle.height < drives_over).all()))
    lower: NDArray[Any] = obstacle.height < drives_over
    return lower


def _forget_beyond(robot_map: RobotMap, grid: Grid, cells: NDArray[Any]) -> None:
    """Mark the cells whose centre lies beyond the right or upper border."""
    x = grid.x_min + (np.arange(grid.columns) + 0.5) * grid.resolution
    y = grid.y_min + (np.arange(grid.rows) + 0.5) * grid.resolution
    cells[:, x > robot_map.border.x_max] = UNKNOWN
    cells[y > robot_map.border.y_max] = UNKNOWN
