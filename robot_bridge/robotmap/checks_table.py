"""All segments of a robot map in one set of arrays, as the checks look at them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .model import Obstacle, RobotMap
from .segments import is_closed

SAME_PLACE = 0.005
"""metres; a map is in centimetres, so two points nearer than this are one."""

TOUCHING = 0.015
"""metres; corners rounded to centimetres may be this far off the wall that they touch."""


@dataclass(frozen=True, eq=False)
class SegmentTable:
    """n segments of K obstacles in the order of the map.

    ``a``, ``b`` are (n, 2), ``height`` (n,), ``row`` (n,) the obstacle that each belongs to, ``offsets``
    (K + 1,) where each obstacle begins, ``shape_type`` (K,).
    """

    robot_map: RobotMap
    a: NDArray[Any]
    b: NDArray[Any]
    height: NDArray[Any]
    row: NDArray[Any]
    offsets: NDArray[Any]
    shape_type: NDArray[Any]

    @classmethod
    def of(cls, robot_map: RobotMap) -> SegmentTable:
        """Return the table of ``robot_map``."""
        obstacles = robot_map.obstacles
        counts = np.array([len(o.a) for o in obstacles], dtype=np.int64)
        return cls(
            robot_map=robot_map,
            a=np.concatenate([np.empty((0, 2)), *(o.a for o in obstacles)]),
            b=np.concatenate([np.empty((0, 2)), *(o.b for o in obstacles)]),
            height=np.concatenate([np.empty(0), *(o.height for o in obstacles)]),
            row=np.repeat(np.arange(len(obstacles)), counts),
            offsets=np.concatenate([[0], np.cumsum(counts)]).astype(np.int64),
            shape_type=np.array([int(o.shape_type) for o in obstacles], dtype=np.int8),
        )

    @property
    def obstacles(self) -> tuple[Obstacle, ...]:
        """The obstacles by row."""
        return self.robot_map.obstacles

    @property
    def lengths(self) -> NDArray[Any]:
        """(n,) metres."""
        lengths: NDArray[Any] = np.hypot(*(self.b - self.a).T)
        return lengths

    @property
    def closed(self) -> NDArray[Any]:
        """(K,) bool, true for obstacles that say they are rings."""
        return is_closed(self.shape_type)

    def lines(self, chosen: NDArray[Any]) -> NDArray[Any]:
        """Return the segments that ``chosen`` (a mask or indices) selects as (m, 2, 2)."""
        return np.stack([self.a[chosen], self.b[chosen]], axis=1)

    def of_obstacle(self, row: int) -> slice:
        """Return where the segments of an obstacle stand."""
        return slice(int(self.offsets[row]), int(self.offsets[row + 1]))


def place(point: NDArray[Any]) -> str:
    """Return ``point`` as it stands in messages."""
    return f"({point[0]:.2f}, {point[1]:.2f})"


def mark(point: NDArray[Any], size: float = 0.25) -> NDArray[Any]:
    """Return an upright cross at ``point``, (2, 2, 2), for what has no extent of its own."""
    x, y = point
    return np.array([[[x - size, y], [x + size, y]], [[x, y - size], [x, y + size]]])
