"""Ray casting at segments: exact ranges, for many poses and bearings at once."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .segments import BINS, Candidates, VisibleSegments, merge_collinear
from .settings import ReferenceRobotError

FINE_CELL = 0.25
"""metres: for particles that are together."""
COARSE_CELL = 4.0
"""metres: for particles all over a map."""
FEW_CELLS = 48
"""Most fine cells per call; poses spread over more are cast from coarse ones."""

RAYS_AT_ONCE = 2_000
"""Rays per batch in numpy: all of their arrays stay in the processor's cache."""

Evaluation = Callable[
    [NDArray[Any], NDArray[Any], NDArray[Any], Candidates, NDArray[Any], float], NDArray[Any]
]
"""(poses (P, 3), bearings (B,), cells (P,), candidates, segments (5, S), reach) -> ranges (P, B)."""


class RayCaster:
    """Casts rays at segments from ``a`` to ``b``, (S, 2) float64, metres, as far as ``reach`` metres.

    With ``compiled`` numba is used, else numpy alone; the default is numba if available. A ray along a
    segment does not hit it; the ends of segments count.

    :raises ReferenceRobotError: for segments or a reach that are not finite, and for ``compiled`` without
        numba.
    """

    def __init__(self, a: NDArray[Any], b: NDArray[Any], reach: float, compiled: bool | None = None) -> None:
        a, b = (np.asarray(ends, dtype=np.float64).reshape(-1, 2) for ends in (a, b))
        if len(a) != len(b) or not (np.isfinite(a).all() and np.isfinite(b).all()):
            raise ReferenceRobotError(
                f"ray casting: {len(a)} first and {len(b)} second ends; give as many of both, all finite"
            )
        if not 0 < reach < np.inf:
            raise ReferenceRobotError(f"ray casting: the reach is {reach} m; give a finite one above 0")
        self.reach = reach
        a, b = merge_collinear(a, b)
        # Relative to the middle of all segments: large coordinates would cost digits.
        self._middle = (a.min(axis=0) + a.max(axis=0)) / 2 if len(a) else np.zeros(2)
        a, b = a - self._middle, b - self._middle
        cross = a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]
        self._segments = np.ascontiguousarray(np.column_stack([a, b - a, cross]).T)
        self._fine = VisibleSegments(a, b, reach, FINE_CELL)
        self._coarse = VisibleSegments(a, b, reach, COARSE_CELL)
        self._evaluate = _evaluation(compiled)

    def cast(self, poses: NDArray[Any], bearings: NDArray[Any]) -> NDArray[Any]:
        """Return the range of each ray, (P, B) metres; ``reach`` where it meets nothing nearer.

        ``poses``, (P, 3), are x, y in metres and theta in radians in the frame of the segments; ``bearings``,
        (B,) radians, count counter-clockwise from theta.

        :raises ReferenceRobotError: for poses or bearings that are not finite.
        """
        poses = np.asarray(poses, dtype=np.float64).reshape(-1, 3)
        bearings = np.asarray(bearings, dtype=np.float64)
        if not (np.isfinite(poses).all() and np.isfinite(bearings).all()):
            raise ReferenceRobotError("ray casting: a pose or a bearing is not finite; leave such beams out")
        if not len(poses) or not len(bearings):
            return np.full((len(poses), len(bearings)), self.reach)
        poses = poses - np.append(self._middle, 0.0)
        seen = self._fine
        cells, cell = seen.cells_of(poses[:, :2])
        if len(cells) > FEW_CELLS:
            seen = self._coarse
            cells, cell = seen.cells_of(poses[:, :2])
        return self._evaluate(poses, bearings, cell, seen.candidates(cells), self._segments, self.reach)


def _evaluation(compiled: bool | None) -> Evaluation:
    if compiled is False:
        return nearest_hits
    try:
        from .compiled_casting import nearest_hits as compiled_hits
    except ImportError as error:
        if compiled:
            raise ReferenceRobotError(
                f"ray casting: numba cannot be imported ({error}); install robot-bridge with its extra "
                "'compiled', or go without"
            ) from error
        return nearest_hits
    return compiled_hits


def nearest_hits(
    poses: NDArray[Any],
    bearings: NDArray[Any],
    cell: NDArray[Any],
    candidates: Candidates,
    segments: NDArray[Any],
    reach: float,
) -> NDArray[Any]:
    """Return the ranges, (P, B), of rays whose candidates are those of row ``cell``, (P,), by numpy."""
    ranges = np.empty((len(poses), len(bearings)))
    step = max(1, RAYS_AT_ONCE // len(bearings))
    for first in range(0, len(poses), step):
        some = slice(first, first + step)
        ranges[some] = _nearest(poses[some], bearings, cell[some], candidates, segments, reach)
    return ranges


def _nearest(
    poses: NDArray[Any],
    bearings: NDArray[Any],
    cell: NDArray[Any],
    candidates: Candidates,
    segments: NDArray[Any],
    reach: float,
) -> NDArray[Any]:
    turns = (poses[:, 2:] + bearings).ravel()
    turns *= BINS / (2 * np.pi)
    row = np.floor(turns).astype(np.int64)
    row %= BINS
    row += np.repeat(cell * BINS, len(bearings))
    begin = candidates.offset[row]
    count = candidates.offset[row + 1] - begin
    ranges = np.full(len(row), reach)
    some = np.flatnonzero(count)
    if len(some):
        count = count[some]
        starts = np.cumsum(count) - count
        ray = np.repeat(some, count)
        place = np.arange(len(ray)) + np.repeat(begin[some] - starts, count)
        ways = _ways(poses, bearings, ray, segments[:, candidates.segment[place]])
        ranges[some] = np.minimum(np.minimum.reduceat(ways, starts), reach)
    return ranges.reshape(len(poses), len(bearings))


def _ways(
    poses: NDArray[Any], bearings: NDArray[Any], ray: NDArray[Any], segments: NDArray[Any]
) -> NDArray[Any]:
    """Return the distance of each ray to its segment, infinite if it misses.

    ``ray``, (n,), counts the bearings of one pose after those of another; ``segments`` is (5, n).
    """
    x, y, theta = poses.T
    cos, sin, cos_b, sin_b = np.cos(theta), np.sin(theta), np.cos(bearings), np.sin(bearings)
    dx = np.outer(cos, cos_b) - np.outer(sin, sin_b)
    dy = np.outer(sin, cos_b) + np.outer(cos, sin_b)
    moment = (dx * y[:, None] - dy * x[:, None]).ravel()[ray]
    pose = ray // len(bearings)
    dx, dy, x, y = dx.ravel()[ray], dy.ravel()[ray], x[pose], y[pose]
    ax, ay, along_x, along_y, cross = segments
    turn_a = dx * ay - dy * ax - moment
    opening = dx * along_y - dy * along_x
    with np.errstate(divide="ignore", invalid="ignore"):
        ways: NDArray[Any] = (cross - x * along_y + y * along_x) / opening
        missed = (turn_a * (turn_a + opening) > 0) | ~(ways >= 0)
    ways[missed] = np.inf
    return ways
