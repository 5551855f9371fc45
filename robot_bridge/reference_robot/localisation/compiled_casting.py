"""The nearest hits of rays, compiled by numba; imported only where numba may be installed."""

from __future__ import annotations

from typing import Any

import numpy as np
from numba import njit
from numpy.typing import NDArray

from .segments import BINS, Candidates


def nearest_hits(
    poses: NDArray[Any],
    bearings: NDArray[Any],
    cell: NDArray[Any],
    candidates: Candidates,
    segments: NDArray[Any],
    reach: float,
) -> NDArray[Any]:
    """Return the same as :func:`.ray_casting.nearest_hits`."""
    ranges: NDArray[Any] = _nearest(
        poses, bearings, cell, candidates.offset, candidates.segment, segments, reach
    )
    return ranges


@njit(cache=True, nogil=True)  # type: ignore[untyped-decorator, unused-ignore]
def _nearest(
    poses: NDArray[Any],
    bearings: NDArray[Any],
    cell: NDArray[Any],
    offset: NDArray[Any],
    candidate: NDArray[Any],
    segments: NDArray[Any],
    reach: float,
) -> NDArray[Any]:
    ranges = np.empty((len(poses), len(bearings)))
    cos_b, sin_b = np.cos(bearings), np.sin(bearings)
    for p in range(len(poses)):
        x, y, theta = poses[p]
        cos, sin = np.cos(theta), np.sin(theta)
        for k in range(len(bearings)):
            dx, dy = cos * cos_b[k] - sin * sin_b[k], sin * cos_b[k] + cos * sin_b[k]
            moment = dx * y - dy * x
            into = int(np.floor((theta + bearings[k]) * (BINS / (2 * np.pi)))) % BINS
            row = cell[p] * BINS + into
            nearest = reach
            for c in range(offset[row], offset[row + 1]):
                s = candidate[c]
                turn = dx * segments[1, s] - dy * segments[0, s] - moment
                opening = dx * segments[3, s] - dy * segments[2, s]
                if turn * (turn + opening) <= 0.0 and opening != 0.0:
                    way = (segments[4, s] - x * segments[3, s] + y * segments[2, s]) / opening
                    if 0.0 <= way < nearest:
                        nearest = way
            ranges[p, k] = nearest
    return ranges
