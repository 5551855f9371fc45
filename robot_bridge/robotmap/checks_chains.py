"""Whether the segments of an obstacle follow one another, and whether lines end where they should."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..counting import counted
from .checks_boxes import overlapping_boxes
from .checks_finding import Finding, Kind, Limits, Severity
from .checks_table import SAME_PLACE, TOUCHING, SegmentTable, place
from .model import ShapeType


def broken_chains(table: SegmentTable, limits: Limits) -> Iterator[Finding]:
    """Yield a finding for each place where an outline breaks off, and for segments turned round in one."""
    before, after = _joints(table)
    broken = _apart(table.b[before], table.a[after])
    head_on = broken & (before != after)
    head_on &= ~_apart(table.b[before], table.b[after]) | ~_apart(table.a[before], table.a[after])
    for row in np.unique(table.row[before[head_on]]):
        joints = head_on & (table.row[before] == row)
        segments = _most_frequent(np.concatenate([before[joints], after[joints]]))
        yield Finding(
            Kind.ORIENTATION,
            Severity.ERROR,
            table.obstacles[row].id,
            f"{counted(int(joints.sum()), 'joint')} where two segments run against each other, the first at "
            f"{place(table.b[before[joints][0]])}: turn one of the two round",
            table.lines(segments),
        )
    for i, j in zip(before[broken & ~head_on], after[broken & ~head_on], strict=True):
        yield _gap(table, int(i), int(j))


def near_misses(table: SegmentTable, limits: Limits) -> Iterator[Finding]:
    """Yield a finding for each end of a line that stops just short of another obstacle.

    Where the border cuts a line is no such end.
    """
    points, rows = _loose_ends(table)
    number, segment, distance = _distances(table, points, rows, limits.gap)
    attached = np.unique(number[distance <= TOUCHING])
    near = ~np.isin(number, attached)
    for end in np.unique(number[near]):
        candidates = np.flatnonzero(near & (number == end))
        nearest = candidates[np.argmin(distance[candidates])]
        reached = _nearest_points(points[[end]], table, segment[[nearest]])[0]
        other = table.obstacles[table.row[segment[nearest]]].id
        yield Finding(
            Kind.GAP,
            Severity.WARNING,
            table.obstacles[rows[end]].id,
            f"ends at {place(points[end])}, {distance[nearest]:.2f} m short of obstacle {other}: "
            "join them, or leave more room where a passage is meant",
            np.array([[points[end], reached]]),
        )


def _joints(table: SegmentTable) -> tuple[NDArray[Any], NDArray[Any]]:
    """Return the indices of the segments before and after each joint; stairs have none."""
    kept = np.flatnonzero(table.shape_type[table.row] != ShapeType.STAIRS)
    same = table.row[kept][1:] == table.row[kept][:-1] if len(kept) else np.zeros(0, dtype=bool)
    rings = np.flatnonzero(table.closed & (np.diff(table.offsets) > 0))
    before = np.concatenate([kept[:-1][same], table.offsets[rings + 1] - 1])
    after = np.concatenate([kept[1:][same], table.offsets[rings]])
    order = np.argsort(before, kind="stable")
    return before[order], after[order]


def _gap(table: SegmentTable, before: int, after: int) -> Finding:
    row = table.row[before]
    ends = np.array([[table.b[before], table.a[after]]])
    width = float(np.hypot(*(ends[0, 1] - ends[0, 0])))
    closed = bool(table.closed[row])
    return Finding(
        Kind.GAP,
        Severity.ERROR if closed else Severity.WARNING,
        table.obstacles[row].id,
        f"a gap of {width:.2f} m after {place(ends[0, 0])} in "
        + ("a ring that should close" if closed else "a line that should go on")
        + ": add the segment that is missing, or make it an open shape of its own",
        ends,
    )


def _apart(one: NDArray[Any], other: NDArray[Any]) -> NDArray[Any]:
    apart: NDArray[Any] = np.hypot(*(one - other).T) > SAME_PLACE
    return apart


def _most_frequent(segments: NDArray[Any]) -> NDArray[Any]:
    """Return the values that occur most often: a segment turned round in a chain has two bad joints."""
    values, counts = np.unique(segments, return_counts=True)
    most: NDArray[Any] = values[counts == counts.max()]
    return most


def _loose_ends(table: SegmentTable) -> tuple[NDArray[Any], NDArray[Any]]:
    """Return the ends of open lines that are not on the border, (m, 2), and the obstacle of each, (m,)."""
    rows = np.flatnonzero(
        np.isin(table.shape_type, [int(ShapeType.OPEN_POLYGON), int(ShapeType.OPEN_CURVE)])
        & (np.diff(table.offsets) > 0)
    )
    points = np.concatenate([table.a[table.offsets[rows]], table.b[table.offsets[rows + 1] - 1]])
    border = table.robot_map.border
    x, y = points.T
    inside = (np.minimum(x - border.x_min, border.x_max - x) > SAME_PLACE) & (
        np.minimum(y - border.y_min, border.y_max - y) > SAME_PLACE
    )
    return points[inside], np.concatenate([rows, rows])[inside]


def _distances(
    table: SegmentTable, points: NDArray[Any], rows: NDArray[Any], reach: float
) -> tuple[NDArray[Any], NDArray[Any], NDArray[Any]]:
    """Return point, segment and distance for each point that is within ``reach`` of another obstacle."""
    low = np.concatenate([points - reach, np.minimum(table.a, table.b)])
    high = np.concatenate([points + reach, np.maximum(table.a, table.b)])
    count = len(points)
    found = [(np.empty(0, dtype=np.int64), np.empty(0, dtype=np.int64))]
    for one, other in overlapping_boxes(low, high):
        point, segment = np.minimum(one, other), np.maximum(one, other) - count
        mixed = (point < count) & (segment >= 0)
        point, segment = point[mixed], segment[mixed]
        others = rows[point] != table.row[segment]
        found.append((point[others], segment[others]))
    number, segment = (np.concatenate(column) for column in zip(*found, strict=True))
    distance = np.hypot(*(_nearest_points(points[number], table, segment) - points[number]).T)
    within = distance <= reach
    return number[within], segment[within], distance[within]


def _nearest_points(points: NDArray[Any], table: SegmentTable, segments: NDArray[Any]) -> NDArray[Any]:
    """Return the point of each segment that is nearest to each point, (m, 2)."""
    a, along = table.a[segments], table.b[segments] - table.a[segments]
    squared = np.maximum((along**2).sum(axis=1), 1e-12)
    share = np.clip(((points - a) * along).sum(axis=1) / squared, 0.0, 1.0)
    nearest: NDArray[Any] = a + share[:, None] * along
    return nearest
