"""Whether closed outlines run the right way round, enclose something, and do not lie in one another."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .checks_boxes import overlapping_boxes
from .checks_finding import Finding, Kind, Limits, Severity
from .checks_table import SAME_PLACE, SegmentTable, mark
from .model import ShapeType

_STEP_IN = 0.02
"""metres from an edge to a point that is surely on one side of it."""


@dataclass(frozen=True, eq=False)
class _Rings:
    """The R obstacles that are whole rings: their rows, signed areas (positive counter-clockwise), boxes."""

    rows: NDArray[Any]
    area: NDArray[Any]
    perimeter: NDArray[Any]
    low: NDArray[Any]
    high: NDArray[Any]

    @classmethod
    def of(cls, table: SegmentTable) -> _Rings:
        rows = np.array([r for r in np.flatnonzero(table.closed) if _is_whole(table, int(r))], dtype=np.int64)
        points = [table.a[table.of_obstacle(int(row))] for row in rows]
        lengths = table.lengths
        return cls(
            rows=rows,
            area=np.array([_signed_area(p) for p in points]),
            perimeter=np.array([lengths[table.of_obstacle(int(row))].sum() for row in rows]),
            low=np.array([p.min(axis=0) for p in points]).reshape(-1, 2),
            high=np.array([p.max(axis=0) for p in points]).reshape(-1, 2),
        )


def wrong_rings(table: SegmentTable, limits: Limits) -> Iterator[Finding]:
    """Yield a finding for each ring that is thin, runs the wrong way round, or lies inside a solid one.

    Solid rings run counter-clockwise. A clockwise one is a courtyard, and that lies in a solid one.
    """
    rings = _Rings.of(table)
    width = 2 * np.abs(rings.area) / np.maximum(rings.perimeter, 1e-9)
    thin = width < limits.sliver
    for k in np.flatnonzero(thin):
        text = (
            f"a ring {width[k]:.3f} m wide on average that encloses {abs(rings.area[k]):.3f} m²: leave it "
            "out, or make it a line"
        )
        yield _finding(table, Kind.SLIVER, Severity.WARNING, int(rings.rows[k]), text)
    solid_kind = table.shape_type[rings.rows] != ShapeType.RAMP
    around = _rings_around(table, rings, ~thin & solid_kind)
    cut = _cut_sources(table)
    for k in np.flatnonzero(~thin):
        outer = around.get(int(k))
        in_solid = outer is not None and bool(rings.area[outer] > 0)
        row = int(rings.rows[k])
        if rings.area[k] < 0 and not (in_solid and solid_kind[k]):
            yield from _clockwise(table, row, cut)
        elif rings.area[k] > 0 and in_solid and solid_kind[k] and outer is not None:
            yield _inside(table, row, int(rings.rows[outer]))


def _clockwise(table: SegmentTable, row: int, cut: set[str]) -> Iterator[Finding]:
    """Yield a finding unless the border cuts the building that the ring may be a courtyard of."""
    source = table.obstacles[row].ext.get("src", "")
    if source and source in cut:
        return
    unsure = not source and bool(cut)
    text = (
        "a ring that runs clockwise and is no courtyard of another: its free space is inside; turn it round"
    )
    if unsure:
        text += ", unless the border cuts the building around it"
    severity = Severity.WARNING if unsure else Severity.ERROR
    yield _finding(table, Kind.ORIENTATION, severity, row, text)


def _inside(table: SegmentTable, row: int, outer: int) -> Finding:
    id, source = table.obstacles[outer].id, table.obstacles[row].ext.get("src")
    if source and source == table.obstacles[outer].ext.get("src"):
        text = (
            f"a courtyard of obstacle {id} (both from {source}) that runs counter-clockwise: its free space "
            "is in the wall; turn it round"
        )
        return _finding(table, Kind.ORIENTATION, Severity.ERROR, row, text)
    text = f"lies inside obstacle {id}, where no robot comes: leave one of them out"
    return _finding(table, Kind.OVERLAP, Severity.WARNING, row, text)


def _cut_sources(table: SegmentTable) -> set[str]:
    """Return the sources of the outlines that the border cuts; an empty one where none is stated."""
    border = table.robot_map.border
    sources = set()
    for row in np.flatnonzero(~table.closed & (np.diff(table.offsets) > 0)):
        at = table.of_obstacle(int(row))
        (x, y) = np.stack([table.a[at][0], table.b[at][-1]]).T
        to_side = np.min([x - border.x_min, border.x_max - x, y - border.y_min, border.y_max - y], axis=0)
        if (to_side <= SAME_PLACE).all():
            sources.add(table.obstacles[row].ext.get("src", ""))
    return sources


def _finding(table: SegmentTable, kind: Kind, severity: Severity, row: int, text: str) -> Finding:
    lines = table.lines(np.arange(*table.of_obstacle(row).indices(len(table.a))))
    return Finding(kind, severity, table.obstacles[row].id, text, lines if len(lines) else mark(np.zeros(2)))


def _is_whole(table: SegmentTable, row: int) -> bool:
    at = table.of_obstacle(row)
    a, b = table.a[at], table.b[at]
    return len(a) >= 3 and bool((np.hypot(*(np.roll(a, -1, axis=0) - b).T) <= SAME_PLACE).all())


def _signed_area(points: NDArray[Any]) -> float:
    x, y = (points - points[0]).T
    return float((x * np.roll(y, -1) - np.roll(x, -1) * y).sum() / 2)


def _rings_around(table: SegmentTable, rings: _Rings, usable: NDArray[Any]) -> dict[int, int]:
    """Return the smallest other ring that each ring lies in, for those that lie in one."""
    inner, outer = [], []
    for one, other in overlapping_boxes(rings.low, rings.high):
        for i, j in ((one, other), (other, one)):
            holds = (rings.low[j] <= rings.low[i]).all(axis=1) & (rings.high[j] >= rings.high[i]).all(axis=1)
            holds &= usable[j] & (np.abs(rings.area[j]) > np.abs(rings.area[i]))
            inner.append(i[holds])
            outer.append(j[holds])
    pairs = sorted(_columns(inner, outer), key=lambda pair: float(abs(rings.area[pair[1]])))
    around: dict[int, int] = {}
    for small, large in pairs:
        point = _inner_point(table, rings, small)
        if small not in around and _holds(table, int(rings.rows[large]), point):
            around[small] = large
    return around


def _columns(inner: list[NDArray[Any]], outer: list[NDArray[Any]]) -> Iterator[tuple[int, int]]:
    for i, j in zip(inner, outer, strict=True):
        yield from zip(i.tolist(), j.tolist(), strict=True)


def _inner_point(table: SegmentTable, rings: _Rings, k: int) -> NDArray[Any]:
    """Return a point just inside ring ``k``: beside the middle of its longest edge."""
    at = table.of_obstacle(int(rings.rows[k]))
    along = table.b[at] - table.a[at]
    length = np.hypot(*along.T)
    longest = int(np.argmax(length))
    left = np.array([-along[longest, 1], along[longest, 0]]) / length[longest]
    middle = (table.a[at][longest] + table.b[at][longest]) / 2
    point: NDArray[Any] = middle + _STEP_IN * np.sign(rings.area[k]) * left
    return point


def _holds(table: SegmentTable, row: int, point: NDArray[Any]) -> bool:
    """Tell whether the ring of an obstacle encloses ``point``, by the even-odd rule."""
    at = table.of_obstacle(row)
    (ax, ay), (bx, by) = table.a[at].T, table.b[at].T
    x, y = point
    crosses = (ay > y) != (by > y)
    with np.errstate(divide="ignore", invalid="ignore"):
        right = x < ax + (y - ay) * (bx - ax) / (by - ay)
    return bool((crosses & right).sum() % 2)
