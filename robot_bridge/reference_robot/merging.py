"""Segments on one line that touch or overlap, made one: what hides others is then as wide as it can be."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

SAME_LINE = 1e-4
"""metres that an end may lie beside the line that it is taken to be on, and apart from its neighbour."""


def merged(a: NDArray[Any], b: NDArray[Any]) -> tuple[NDArray[Any], NDArray[Any]]:
    """Return segments that cover what those from ``a`` to ``b``, (S, 2) metres, cover, fewer and longer.

    No point moves by more than :data:`SAME_LINE`; what has no length is left out. The direction of segments
    is not kept.
    """
    a, b = a[(a != b).any(axis=1)], b[(a != b).any(axis=1)]
    if not len(a):
        return a, b
    # One direction for either sense, from -90° on; the line is told by its direction and distance from 0.
    turn = (a[:, 0] > b[:, 0]) | ((a[:, 0] == b[:, 0]) & (a[:, 1] > b[:, 1]))
    a, b = np.where(turn[:, None], b, a), np.where(turn[:, None], a, b)
    unit = (b - a) / np.hypot(*(b - a).T)[:, None]
    off = unit[:, 0] * a[:, 1] - unit[:, 1] * a[:, 0]
    span = np.abs(np.concatenate([a, b])).max()
    # Two neighbours in this order are on one line or not; a segment that two lines could claim stays alone.
    angle = np.round(np.arctan2(unit[:, 1], unit[:, 0]) / (SAME_LINE / 4 / max(span, 1.0)))
    start = (unit * a).sum(axis=1)
    end = (unit * b).sum(axis=1)
    order = np.lexsort((start, np.round(off / (SAME_LINE / 2)), angle))
    angle, off, start, end, a, b = (each[order] for each in (angle, off, start, end, a, b))
    begins = _runs(angle, np.round(off / (SAME_LINE / 2)), start, end)
    first = np.flatnonzero(begins)
    # The end of a run is that of whichever of its segments goes farthest.
    run = np.cumsum(begins) - 1
    farthest = np.lexsort((end, run))[np.append(first[1:], len(end)) - 1]
    return a[first], b[farthest]


def _runs(angle: NDArray[Any], off: NDArray[Any], start: NDArray[Any], end: NDArray[Any]) -> NDArray[Any]:
    """Tell which segments, sorted by line and start, do not go on where those before them end."""
    begins = np.ones(len(start), dtype=bool)
    same = (np.diff(angle) == 0) & (np.diff(off) == 0)
    line = np.concatenate([[0], np.cumsum(~same)])
    # The farthest end so far on the same line: a running maximum that begins anew with each line.
    width = float(end.max() - start.min()) + 1.0
    reached = np.maximum.accumulate(end + line * width) - line * width
    begins[1:] = ~same | (start[1:] > reached[:-1] + SAME_LINE)
    return begins
