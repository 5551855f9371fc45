"""The walls of a map as seen by a laser, and a world that differs from the map."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...core.robotmap.model import Obstacle, RobotMap, ShapeType
from .segments import merge_collinear
from .settings import WorldSettings

_CLOSED = (ShapeType.CLOSED_POLYGON, ShapeType.CLOSED_CURVE)
_DRIVEN_ON = (ShapeType.STAIRS, ShapeType.RAMP)


@dataclass(frozen=True)
class Walls:
    """S segments from ``a`` to ``b``, (S, 2) metres, with ``height``, (S,) metres above the ground.

    ``obstacle``, (S,) int64, is the obstacle of each.
    """

    a: NDArray[Any]
    b: NDArray[Any]
    height: NDArray[Any]
    obstacle: NDArray[Any]

    def __len__(self) -> int:
        return len(self.a)

    def higher_than(self, height: float) -> Walls:
        """Return the walls that reach above ``height`` metres."""
        high = self.height > height
        return Walls(self.a[high], self.b[high], self.height[high], self.obstacle[high])


def standing_obstacles(robot_map: RobotMap) -> list[Obstacle]:
    """Return the obstacles that :attr:`Walls.obstacle` of :func:`walls_of` counts, in that order."""
    return [one for one in robot_map.obstacles if one.shape_type not in _DRIVEN_ON]


def walls_of(robot_map: RobotMap) -> Walls:
    """Return the upright obstacles of a map: everything but stairs and ramps."""
    standing = standing_obstacles(robot_map)
    return Walls(
        a=np.concatenate([np.empty((0, 2)), *(one.a for one in standing)]),
        b=np.concatenate([np.empty((0, 2)), *(one.b for one in standing)]),
        height=np.concatenate([np.empty(0), *(one.height for one in standing)]),
        obstacle=np.repeat(np.arange(len(standing)), [len(one.a) for one in standing]),
    )


def changed(walls: Walls, settings: WorldSettings, rng: np.random.Generator) -> Walls:
    """Return a world whose map has ``walls``, as the laser sees it; a different one for each ``rng``.

    Small objects are moved as a whole or missing; of others each straight wall is moved by itself. Walls that
    a map has twice at one place become one wall of infinite height.
    """
    small = _is_small(walls, settings.furniture)
    things = np.unique(walls.obstacle[small])
    gone = rng.permutation(things)[: round(settings.missing * len(things))]
    kept = small & ~np.isin(walls.obstacle, gone)
    shift = rng.uniform(-settings.moved, settings.moved, (int(walls.obstacle.max(initial=0)) + 1, 2))
    own = shift[walls.obstacle[kept]]
    a, b = merge_collinear(walls.a[~small], walls.b[~small])
    moved = rng.uniform(-settings.moved, settings.moved, a.shape)
    return Walls(
        a=np.concatenate([a + moved, walls.a[kept] + own]),
        b=np.concatenate([b + moved, walls.b[kept] + own]),
        height=np.concatenate([np.full(len(a), np.inf), walls.height[kept]]),
        obstacle=np.concatenate(
            [np.arange(len(a)), len(a) + np.unique(walls.obstacle[kept], return_inverse=True)[1]]
        ),
    )


def _is_small(walls: Walls, size: float) -> NDArray[Any]:
    """Return which segments belong to objects smaller than ``size`` both ways that are no single line."""
    count = int(walls.obstacle.max(initial=-1)) + 1
    low, high = np.full((count, 2), np.inf), np.full((count, 2), -np.inf)
    for ends in (walls.a, walls.b):
        np.minimum.at(low, walls.obstacle, ends)
        np.maximum.at(high, walls.obstacle, ends)
    several = np.bincount(walls.obstacle, minlength=count) > 1
    small: NDArray[Any] = ((high - low < size).all(axis=1) & several)[walls.obstacle]
    return small


def inside_solids(robot_map: RobotMap, points: NDArray[Any]) -> NDArray[Any]:
    """Return which of ``points``, (n, 2), lie in something solid: (n,) bool.

    Solid rings run counter-clockwise and courtyards clockwise: a point is inside if the rings wind
    around it more often one way than the other. Rings cut by the border are ignored.
    """
    turns = np.zeros(len(points), dtype=np.int64)
    x, y = points.T
    for one in robot_map.obstacles:
        if one.shape_type not in _CLOSED or not len(one.a):
            continue
        low, high = np.minimum(one.a, one.b).min(axis=0), np.maximum(one.a, one.b).max(axis=0)
        near = np.flatnonzero((x >= low[0]) & (x <= high[0]) & (y >= low[1]) & (y <= high[1]))
        if len(near):
            turns[near] += _turns_around(one.a, one.b, x[near, None], y[near, None])
    return turns > 0


def _turns_around(a: NDArray[Any], b: NDArray[Any], x: NDArray[Any], y: NDArray[Any]) -> NDArray[Any]:
    """Return the winding number of the ring around each point, by crossings of a ray."""
    up = (a[:, 1] <= y) & (b[:, 1] > y)
    down = (a[:, 1] > y) & (b[:, 1] <= y)
    left = (b[:, 0] - a[:, 0]) * (y - a[:, 1]) - (x - a[:, 0]) * (b[:, 1] - a[:, 1])
    turns: NDArray[Any] = (up & (left > 0)).sum(axis=1) - (down & (left < 0)).sum(axis=1)
    return turns
