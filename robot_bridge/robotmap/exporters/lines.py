"""The segments of an obstacle as the lines that they form."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..model import Obstacle, ShapeType

Points = NDArray[Any]


def lines_of(obstacle: Obstacle) -> list[Points]:
    """Return (n, 2) points of each line; segments are one line while one begins where the last ended.

    Of stairs each riser is a line.
    """
    if not len(obstacle.a):
        return []
    parted = (obstacle.b[:-1] != obstacle.a[1:]).any(axis=1)
    if obstacle.shape_type is ShapeType.STAIRS:
        parted[:] = True
    pieces = np.split(np.arange(len(obstacle.a)), np.flatnonzero(parted) + 1)
    return [np.concatenate([obstacle.a[piece], obstacle.b[piece[-1:]]]) for piece in pieces]


def is_ring(line: Points) -> bool:
    """Tell whether a line ends where it began and may enclose something."""
    return len(line) > 3 and bool((line[0] == line[-1]).all())


def signed_area(ring: Points) -> float:
    """Return the area of a ring in square units, positive when it runs counter-clockwise."""
    x, y = (ring - ring[0]).T
    return float((x[:-1] * y[1:] - x[1:] * y[:-1]).sum() / 2)


def flanks_of(obstacle: Obstacle) -> tuple[Points, Points]:
    """Return the sides of a flight of stairs as segments a→b, (2 n - 2, 2) each, from riser to riser."""
    return (
        np.concatenate([obstacle.a[:-1], obstacle.b[:-1]]),
        np.concatenate([obstacle.a[1:], obstacle.b[1:]]),
    )


def treads_of(obstacle: Obstacle) -> list[Points]:
    """Return the ring, (5, 2) and counter-clockwise, of each tread between two risers of a flight."""
    a, b = obstacle.a, obstacle.b
    rings = [np.array([a[k], b[k], b[k + 1], a[k + 1], a[k]]) for k in range(len(a) - 1)]
    return [ring if signed_area(ring) >= 0 else ring[::-1] for ring in rings]
