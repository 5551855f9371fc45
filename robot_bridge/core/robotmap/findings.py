"""Findings of map checks, and the table of segments that the checks share."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from enum import Enum
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .model import Obstacle, RobotMap
from .outlines import is_closed

# --- Findings of a check of a robot map: place, severity, and remedy ---


class Severity(str, Enum):
    """``ERROR``: a robot is misled. ``WARNING``: probably unintended. ``INFO``: worth knowing."""

    ERROR = "error"
    WARNING = "warning"
    INFO = "info"


class MapFindingKind(str, Enum):
    """Kinds of findings; the value is shown to users, who filter by it."""

    ORIENTATION = "orientation"
    GAP = "gap"
    SLIVER = "sliver"
    DUPLICATE = "duplicate"
    OVERLAP = "overlap"
    SHARED_WALL = "shared wall"
    POCKET = "pocket"
    HEIGHT = "height"
    OUTSIDE = "outside"
    ID = "id"


@dataclass(frozen=True)
class MapCheckLimits:
    """Thresholds of the checks; metres and m²."""

    gap: float = 0.10
    """A line that ends within this distance of another obstacle was meant to reach it."""
    sliver: float = 0.05
    """A ring narrower than this, on average, is no obstacle but a remnant of one."""
    robot_width: float = 0.60
    """A robot passes through gaps of this width."""
    pocket: float = 1.0
    """The smallest unreachable free area worth a finding."""


@dataclass(frozen=True, eq=False)
class MapFinding:
    """One finding. ``obstacle`` is the id of the one to change, None if none can be named."""

    kind: MapFindingKind
    severity: Severity
    obstacle: int | None
    text: str
    segments: NDArray[Any]
    """(m, 2, 2) float64, the lines that show the place, metres in the site frame; m is at least 1."""


# --- All segments of a robot map in one set of arrays, for the checks ---

SAME_PLACE = 0.005
"""metres; a map is in centimetres, so points nearer than this coincide."""

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
    def obstacles(self) -> Sequence[Obstacle]:
        """The obstacles by row."""
        return self.robot_map.obstacles

    @property
    def lengths(self) -> NDArray[Any]:
        """(n,) metres."""
        lengths: NDArray[Any] = np.hypot(*(self.b - self.a).T)
        return lengths

    @property
    def closed(self) -> NDArray[Any]:
        """(K,) bool, true for obstacles declared as rings."""
        return is_closed(self.shape_type)

    def lines(self, chosen: NDArray[Any]) -> NDArray[Any]:
        """Return the segments that ``chosen`` (a mask or indices) selects as (m, 2, 2)."""
        return np.stack([self.a[chosen], self.b[chosen]], axis=1)

    def of_obstacle(self, row: int) -> slice:
        """Return the slice of an obstacle's segments."""
        return slice(int(self.offsets[row]), int(self.offsets[row + 1]))


def place(point: NDArray[Any]) -> str:
    """Return ``point`` as text for messages."""
    return f"({point[0]:.2f}, {point[1]:.2f})"


def mark(point: NDArray[Any], size: float = 0.25) -> NDArray[Any]:
    """Return an upright cross at ``point``, (2, 2, 2), for what has no extent of its own."""
    x, y = point
    return np.array([[[x - size, y], [x + size, y]], [[x, y - size], [x, y + size]]])


# --- Touching pairs among many rectangles, by a sweep along the longer side of their extent ---

_AT_ONCE = 1_000_000
"""Pairs processed together: bounds the memory."""


def overlapping_boxes(low: NDArray[Any], high: NDArray[Any]) -> Iterator[tuple[NDArray[Any], NDArray[Any]]]:
    """Yield the indices of pairs of boxes that touch, each pair once.

    ``low`` and ``high`` are (n, 2), the lower and upper corners.
    """
    if len(low) < 2:
        return
    axis = int(np.argmax(high.max(axis=0) - low.min(axis=0)))
    order = np.argsort(low[:, axis], kind="stable")
    start = np.arange(1, len(order) + 1)
    end = np.searchsorted(low[order, axis], high[order, axis], side="right")
    counts = np.maximum(end - start, 0)
    first = 0
    total = np.cumsum(counts)
    while first < len(order):
        reached = total[first - 1] if first else 0
        last = max(int(np.searchsorted(total, reached + _AT_ONCE, side="right")), first + 1)
        one = np.repeat(np.arange(first, last), counts[first:last])
        before = total[first:last] - counts[first:last] - reached
        within = np.arange(len(one)) - np.repeat(before, counts[first:last])
        i, j = order[one], order[start[one] + within]
        across = 1 - axis
        touch = (low[i, across] <= high[j, across]) & (low[j, across] <= high[i, across])
        yield i[touch], j[touch]
        first = last
