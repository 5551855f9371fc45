"""Where in a polygon there is room for a word."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

_STEPS = 24
_AS_GOOD = 0.85
"""Part of the best distance that is good enough for a place nearer to the middle."""


class Place(NamedTuple):
    """A point, how far it is from the nearest side, and from the nearest one on its left and right."""

    x: float
    y: float
    away: float
    beside: float


def roomy_place(rings: Sequence[NDArray[Any]]) -> Place:
    """Return a place in a polygon, whose rings are (n, 2) and closed, far from its sides.

    A grid of points is looked through, so a polygon that is narrow everywhere may give a distance of 0.
    """
    low, high = rings[0].min(axis=0), rings[0].max(axis=0)
    steps = (np.arange(_STEPS + 1) + 0.5) / (_STEPS + 1)
    x, y = (grid.reshape(-1, 1) for grid in np.meshgrid(*(low + steps[:, None] * (high - low)).T))
    a = np.concatenate([ring[:-1] for ring in rings])
    b = np.concatenate([ring[1:] for ring in rings])
    along = b - a
    across = (a[:, 1] > y) != (b[:, 1] > y)
    with np.errstate(divide="ignore", invalid="ignore"):
        level = a[:, 0] + (y - a[:, 1]) * along[:, 0] / along[:, 1]
    inside = (across & (level > x)).sum(axis=1) % 2 == 1
    squared = np.maximum((along**2).sum(axis=1), 1e-12)
    part = np.clip(((x - a[:, 0]) * along[:, 0] + (y - a[:, 1]) * along[:, 1]) / squared, 0.0, 1.0)
    distance = np.hypot(x - a[:, 0] - part * along[:, 0], y - a[:, 1] - part * along[:, 1])
    away = np.where(inside, distance.min(axis=1), 0.0)
    from_middle = np.hypot(*(np.hstack([x, y]) - (low + high) / 2).T)
    best = int(np.argmin(np.where(away >= _AS_GOOD * away.max(), from_middle, np.inf)))
    beside = np.where(across[best], np.abs(level[best] - x[best]), np.inf).min()
    return Place(float(x[best, 0]), float(y[best, 0]), float(away[best]), float(beside))
