"""Segments: merging collinear ones, and finding those that a ray can hit first."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

SAME_LINE = 1e-4
"""metres of tolerance for an end beside its line, and for gaps between neighbours."""


def merge_collinear(a: NDArray[Any], b: NDArray[Any]) -> tuple[NDArray[Any], NDArray[Any]]:
    """Return fewer and longer segments that cover the same as those from ``a`` to ``b``, (S, 2) metres.

    No point moves by more than :data:`SAME_LINE`; those without length are left out. The direction of
    segments is not kept.
    """
    a, b = a[(a != b).any(axis=1)], b[(a != b).any(axis=1)]
    if not len(a):
        return a, b
    # One direction for either sense, from -90° on; the line is known by its direction and distance from 0.
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
    # The end of a run is that of its farthest segment.
    run = np.cumsum(begins) - 1
    farthest = np.lexsort((end, run))[np.append(first[1:], len(end)) - 1]
    return a[first], b[farthest]


def _runs(angle: NDArray[Any], off: NDArray[Any], start: NDArray[Any], end: NDArray[Any]) -> NDArray[Any]:
    """Return which segments, sorted by line and start, do not continue those before them."""
    begins = np.ones(len(start), dtype=bool)
    same = (np.diff(angle) == 0) & (np.diff(off) == 0)
    line = np.concatenate([[0], np.cumsum(~same)])
    # The farthest end so far on the same line: a running maximum that begins again with each line.
    width = float(end.max() - start.min()) + 1.0
    reached = np.maximum.accumulate(end + line * width) - line * width
    begins[1:] = ~same | (start[1:] > reached[:-1] + SAME_LINE)
    return begins


# Which segments a ray can hit first: space is cut into square cells and the circle into bins. For a cell and
# a bin, a segment hit by every ray of the bin from anywhere in the cell hides everything beyond it: this
# leaves a few candidates for each ray, and the nearest of them is the nearest of all.

BINS = 240
"""of the circle, 1.5° each."""
LIST_GROWTH = 8
"""Side in cells of the square block whose segments are searched for a cell's candidates."""
KEPT_CELLS = 20_000
"""Cached cells; the oldest is dropped first."""

_WIDTH = 2 * np.pi / BINS
_SLACK = 1e-9
"""metres and radians by which bounds are widened, so that rounding hides nothing."""
_CORNERS = np.array([[-0.5, -0.5], [0.5, -0.5], [0.5, 0.5], [-0.5, 0.5]])


@dataclass(frozen=True)
class Candidates:
    """Of m cells: row r of cell k and bin j is ``k * BINS + j``; its segments are
    ``segment[offset[r]:offset[r + 1]]``, int64."""

    offset: NDArray[Any]
    segment: NDArray[Any]


class VisibleSegments:
    """Segments from ``a`` to ``b``, (S, 2) metres, as seen from square cells of ``cell`` metres.

    A cell is computed at first use, and cached. Segments farther from it than ``reach`` metres are left out.
    """

    def __init__(self, a: NDArray[Any], b: NDArray[Any], reach: float, cell: float) -> None:
        self._a, self._b = a, b
        self._reach = reach
        self._cell = cell
        self._known: dict[tuple[int, int], tuple[NDArray[Any], NDArray[Any]]] = {}
        self._blocks: dict[tuple[int, int], NDArray[Any]] = {}

    def cells_of(self, points: NDArray[Any]) -> tuple[NDArray[Any], NDArray[Any]]:
        """Return the distinct cells, (m, 2) int64, of ``points``, (n, 2), and each point's row among them."""
        column = np.floor(points / self._cell).astype(np.int64)
        low = column.min(axis=0)
        height = int(column[:, 1].max() - low[1]) + 1
        key = (column[:, 0] - low[0]) * height + (column[:, 1] - low[1])
        different, row = np.unique(key, return_inverse=True)
        return np.stack([different // height + low[0], different % height + low[1]], axis=1), row

    def candidates(self, cells: NDArray[Any]) -> Candidates:
        """Return the segments that can be hit first from each of ``cells``, (m, 2) int64."""
        lists = [self._of_cell(int(column), int(row)) for column, row in cells]
        counts = np.concatenate([count for count, _ in lists])
        offset = np.zeros(len(counts) + 1, dtype=np.int64)
        np.cumsum(counts, out=offset[1:])
        return Candidates(offset, np.concatenate([segment for _, segment in lists]))

    def _of_cell(self, column: int, row: int) -> tuple[NDArray[Any], NDArray[Any]]:
        found = self._known.get((column, row))
        if found is None:
            if len(self._known) >= KEPT_CELLS:
                del self._known[next(iter(self._known))]
            near = self._near(column // LIST_GROWTH, row // LIST_GROWTH)
            centre = (np.array([column, row]) + 0.5) * self._cell
            found = self._known[column, row] = self._seen_from(centre, near)
        return found

    def _near(self, column: int, row: int) -> NDArray[Any]:
        """Return the segments within reach of any cell of a block."""
        found = self._blocks.get((column, row))
        if found is None:
            if len(self._blocks) >= KEPT_CELLS:
                del self._blocks[next(iter(self._blocks))]
            side = self._cell * LIST_GROWTH
            centre = (np.array([column, row]) + 0.5) * side
            distance = distances(centre, self._a, self._b)
            found = np.flatnonzero(distance <= self._reach + side * np.sqrt(0.5) + _SLACK)
            self._blocks[column, row] = found
        return found

    def _seen_from(self, centre: NDArray[Any], near: NDArray[Any]) -> tuple[NDArray[Any], NDArray[Any]]:
        """Return the number of candidates of each bin, (BINS,), and all of them one bin after the other."""
        radius = self._cell * np.sqrt(0.5) + _SLACK
        distance = distances(centre, self._a[near], self._b[near])
        within = distance <= self._reach + radius
        near, distance = near[within], distance[within]
        corners = centre + self._cell * _CORNERS
        # (4, s, 2): the ends as seen from each corner.
        a, b = self._a[near] - corners[:, None], self._b[near] - corners[:, None]
        first, count = _bins_seen(a, b, centre, (self._a[near] + self._b[near]) / 2, distance <= 2 * radius)
        pair = np.repeat(np.arange(len(near)), count)
        into = np.arange(len(pair)) - np.repeat(np.cumsum(count) - count, count)
        bins = (first[pair] + into) % BINS
        least, most = _ways_to(a[:, pair], b[:, pair], bins)
        limit = np.full(BINS, self._reach)
        np.minimum.at(limit, bins, most)
        kept = np.maximum(distance[pair] - radius, least) <= limit[bins] + _SLACK
        pair, bins = pair[kept], bins[kept]
        order = np.argsort(bins, kind="stable")
        return np.bincount(bins, minlength=BINS), near[pair[order]]


def distances(point: NDArray[Any], a: NDArray[Any], b: NDArray[Any]) -> NDArray[Any]:
    """Return the distance of ``point``, (2,), from each segment ``a`` to ``b``, (S, 2): (S,) metres."""
    along, to = b - a, point - a
    square = np.maximum((along * along).sum(axis=1), np.finfo(float).tiny)
    part = np.clip((along * to).sum(axis=1) / square, 0.0, 1.0)
    apart = to - part[:, None] * along
    away: NDArray[Any] = np.hypot(apart[:, 0], apart[:, 1])
    return away


def _bins_seen(
    a: NDArray[Any], b: NDArray[Any], centre: NDArray[Any], middle: NDArray[Any], close: NDArray[Any]
) -> tuple[NDArray[Any], NDArray[Any]]:
    """Return the first bin in which each segment is seen from any corner, and how many there are."""
    # Directions relative to that from the cell's centre to the segment's middle; a segment is seen under
    # less than half a turn from any corner, so nothing wraps around.
    reference = np.arctan2(middle[:, 1] - centre[1], middle[:, 0] - centre[0])
    half = (a + b) / 2
    own = np.arctan2(half[..., 1], half[..., 0])
    shift = _wrapped(own - reference)
    seen = [shift + _wrapped(np.arctan2(end[..., 1], end[..., 0]) - own) for end in (a, b)]
    low = np.minimum(*seen).min(axis=0) + reference - _SLACK
    high = np.maximum(*seen).max(axis=0) + reference + _SLACK
    first = np.floor(low / _WIDTH).astype(np.int64)
    count = np.minimum(np.floor(high / _WIDTH).astype(np.int64) - first + 1, BINS)
    # From beside or on a segment it may be seen anywhere.
    count[close] = BINS
    return first, count


def _ways_to(a: NDArray[Any], b: NDArray[Any], bins: NDArray[Any]) -> tuple[NDArray[Any], NDArray[Any]]:
    """Return the least and the greatest distance of a ray of ``bins``, (p,), to its segment.

    ``a`` and ``b``, (4, p, 2), are the segment's ends as seen from the cell's corners. The greatest is
    infinite if a ray may miss, the least 0 if it is unknown. Whether a ray passes an end on its left is
    linear in its origin and its direction, and the distance to a line is greatest, and, except for a line met
    at a right angle, least, at the extremes of both: the four corners and the bin's two edges bound all rays.
    """
    cross = a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0]
    along = b[0] - a[0]
    edge = np.arange(BINS + 1) * _WIDTH
    edge_x, edge_y = np.cos(edge), np.sin(edge)
    turn_a, turn_b = np.empty((2, *cross.shape)), np.empty((2, *cross.shape))
    slant = np.empty((2, len(bins)))
    for side in (0, 1):
        x, y = edge_x[bins + side], edge_y[bins + side]
        turn_a[side] = x * a[..., 1] - y * a[..., 0]
        turn_b[side] = x * b[..., 1] - y * b[..., 0]
        slant[side] = x * along[:, 0] + y * along[:, 1]
    with np.errstate(divide="ignore", invalid="ignore"):
        way = cross / (turn_b - turn_a)
    left, right = turn_a > _SLACK, turn_b < -_SLACK
    hit = (left & right).all(axis=(0, 1)) | ((turn_a < -_SLACK) & (turn_b > _SLACK)).all(axis=(0, 1))
    opening = turn_b - turn_a
    one_way = (opening > _SLACK).all(axis=(0, 1)) | (opening < -_SLACK).all(axis=(0, 1))
    one_way &= (way > 0).all(axis=(0, 1))
    least = np.where(one_way & (slant[0] * slant[1] > 0), way.min(axis=(0, 1)), 0.0)
    return least, np.where(hit & one_way, way.max(axis=(0, 1)), np.inf)


def _wrapped(angle: NDArray[Any]) -> NDArray[Any]:
    wrapped: NDArray[Any] = (angle + np.pi) % (2 * np.pi) - np.pi
    return wrapped
