"""Whether obstacles repeat, cover or cross one another."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..counting import counted
from .checks_boxes import overlapping_boxes
from .checks_finding import Finding, Kind, Limits, Severity
from .checks_table import SAME_PLACE, TOUCHING, SegmentTable
from .model import ShapeType

_SHORTEST_OVERLAP = 0.05
_PARALLEL = 0.95

_CROSSING, _SAME, _ALONG, _AGAINST = range(4)


@dataclass(frozen=True, eq=False)
class _Pairs:
    """m pairs of segments: what each pair does, and two lines each, (m, 2, 2, 2), that show where."""

    one: NDArray[Any]
    other: NDArray[Any]
    what: NDArray[Any]
    lines: NDArray[Any]


def meeting_obstacles(table: SegmentTable, limits: Limits) -> Iterator[Finding]:
    """Yield a finding for each two obstacles that share segments, cover each other or cross.

    Touching is no finding. Ramps are none either: walls stand on their outlines.
    """
    pairs = _meeting(table)
    rows = np.sort(np.stack([table.row[pairs.one], table.row[pairs.other]], axis=1), axis=1)
    keys = np.column_stack([rows, pairs.what])
    groups, group = np.unique(keys, axis=0, return_inverse=True)
    group = group.reshape(-1)
    order = np.argsort(group, kind="stable")
    bounds = np.searchsorted(group[order], np.arange(len(groups) + 1))
    for k, (first, second, what) in enumerate(groups.tolist()):
        members = order[bounds[k] : bounds[k + 1]]
        lines = pairs.lines[members].reshape(-1, 2, 2)
        yield _finding(table, first, second, what, len(members), lines)


def _meeting(table: SegmentTable) -> _Pairs:
    kept = np.flatnonzero((table.shape_type[table.row] != ShapeType.RAMP) & (table.lengths >= SAME_PLACE))
    a, b = table.a[kept], table.b[kept]
    none = np.empty(0, dtype=np.int64)
    found = [_Pairs(none, none, none, np.empty((0, 2, 2, 2)))]
    for i, j in overlapping_boxes(np.minimum(a, b) - TOUCHING, np.maximum(a, b) + TOUCHING):
        # The first of a pair is the longer one: whether the shorter lies on it is well defined.
        longer = np.hypot(*(b - a)[i].T) >= np.hypot(*(b - a)[j].T)
        i, j = np.where(longer, i, j), np.where(longer, j, i)
        crossing = _crossing(a, b, i, j)
        covering = _covering(a, b, i, j)
        found += [
            _Pairs(kept[p.one], kept[p.other], p.what, p.lines) for p in (crossing, covering) if len(p.one)
        ]
    return _Pairs(
        one=np.concatenate([p.one for p in found]),
        other=np.concatenate([p.other for p in found]),
        what=np.concatenate([p.what for p in found]),
        lines=np.concatenate([p.lines for p in found]),
    )


def _sides(a: NDArray[Any], b: NDArray[Any], line: NDArray[Any], point: NDArray[Any]) -> NDArray[Any]:
    """Return how far to the left of each line each point is, (m,) metres."""
    along = b[line] - a[line]
    off = point - a[line]
    sides: NDArray[Any] = (along[:, 0] * off[:, 1] - along[:, 1] * off[:, 0]) / np.hypot(*along.T)
    return sides


def _crossing(a: NDArray[Any], b: NDArray[Any], i: NDArray[Any], j: NDArray[Any]) -> _Pairs:
    aj, bj = _sides(a, b, i, a[j]), _sides(a, b, i, b[j])
    ai, bi = _sides(a, b, j, a[i]), _sides(a, b, j, b[i])
    clear = np.minimum(np.minimum(np.abs(aj), np.abs(bj)), np.minimum(np.abs(ai), np.abs(bi))) > TOUCHING
    cross = clear & (aj * bj < 0) & (ai * bi < 0)
    i, j, aj, bj = i[cross], j[cross], aj[cross], bj[cross]
    point = a[j] + (aj / (aj - bj))[:, None] * (b[j] - a[j])
    lines = np.stack([_around(point, b[k] - a[k]) for k in (i, j)], axis=1)
    return _Pairs(i, j, np.full(len(i), _CROSSING), lines)


def _around(point: NDArray[Any], along: NDArray[Any]) -> NDArray[Any]:
    """Return half a metre of a line around each point, (m, 2, 2)."""
    step = 0.25 * along / np.maximum(np.hypot(*along.T), 1e-9)[:, None]
    return np.stack([point - step, point + step], axis=1)


def _covering(a: NDArray[Any], b: NDArray[Any], i: NDArray[Any], j: NDArray[Any]) -> _Pairs:
    """Return the pairs in which the shorter segment lies along the longer one."""
    along = b[i] - a[i]
    length = np.hypot(*along.T)
    unit = along / length[:, None]
    turn = (unit * (b[j] - a[j])).sum(axis=1) / np.hypot(*(b[j] - a[j]).T)
    start, end = ((unit * (points - a[i])).sum(axis=1) for points in (a[j], b[j]))
    low = np.maximum(np.minimum(start, end), 0.0)
    high = np.minimum(np.maximum(start, end), length)
    off = np.maximum(np.abs(_sides(a, b, i, a[j])), np.abs(_sides(a, b, i, b[j])))
    same = (np.abs(start) <= SAME_PLACE) & (np.abs(end - length) <= SAME_PLACE) & (off <= SAME_PLACE)
    covers = (off <= TOUCHING) & (np.abs(turn) >= _PARALLEL) & (high - low > _SHORTEST_OVERLAP)
    kept = covers | same
    what = np.where(same, _SAME, np.where(turn > 0, _ALONG, _AGAINST))[kept]
    ends = [(a[i] + t[:, None] * unit)[kept] for t in (low, high)]
    line = np.stack(ends, axis=1)
    return _Pairs(i[kept], j[kept], what, np.stack([line, line], axis=1))


def _finding(
    table: SegmentTable, first: int, second: int, what: int, count: int, lines: NDArray[Any]
) -> Finding:
    id, other = table.obstacles[second].id, table.obstacles[first].id
    length = np.hypot(*(lines[::2, 1] - lines[::2, 0]).T).sum()
    times = counted(count, "place")
    if first == second:
        return _with_itself(id, what, times, length, lines)
    if what == _CROSSING:
        text = f"crosses obstacle {other} in {times}: merge them, or move one"
        return Finding(Kind.OVERLAP, Severity.WARNING, id, text, lines)
    if what == _SAME:
        whole = count >= len(table.obstacles[second].a)
        text = ("is all in" if whole else f"shares {times} with") + f" obstacle {other}"
        return Finding(Kind.DUPLICATE, Severity.WARNING, id, f"{text}: leave one of them out", lines[::2])
    if what == _ALONG:
        text = f"runs along obstacle {other} for {length:.2f} m in the same direction: cut or merge them"
        return Finding(Kind.OVERLAP, Severity.WARNING, id, text, lines[::2])
    text = (
        f"runs along obstacle {other} for {length:.2f} m in the opposite direction: a wall that both share, "
        "which no robot outside meets"
    )
    return Finding(Kind.SHARED_WALL, Severity.INFO, id, text, lines[::2])


def _with_itself(id: int, what: int, times: str, length: float, lines: NDArray[Any]) -> Finding:
    if what == _CROSSING:
        text = f"crosses itself in {times}: repair the outline that it comes from"
        return Finding(Kind.OVERLAP, Severity.WARNING, id, text, lines)
    text = f"goes twice along {length:.2f} m of itself in {times}: repair the outline that it comes from"
    return Finding(Kind.DUPLICATE, Severity.WARNING, id, text, lines[::2])
