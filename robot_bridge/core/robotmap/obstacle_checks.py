"""Checks of single obstacles: ids, heights, broken chains, rings, stairs."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..errors import counted
from . import findings
from .findings import MapCheckLimits, MapFinding, MapFindingKind, SegmentTable, Severity, mark, place
from .model import ShapeType

# --- Checks of one obstacle or one segment at a time: ids, border, heights, lengths ---


def repeated_ids(table: SegmentTable, limits: MapCheckLimits) -> Iterator[MapFinding]:
    """Yield a finding for each id that several obstacles have."""
    rows = defaultdict(list)
    for row, obstacle in enumerate(table.obstacles):
        rows[obstacle.id].append(row)
    for id, bearers in rows.items():
        if len(bearers) > 1:
            yield MapFinding(
                MapFindingKind.ID,
                Severity.ERROR,
                id,
                f"{len(bearers)} obstacles have the id {id}: number them anew, a robot keeps one of them",
                _of_all(table, bearers),
            )


def outside_border(table: SegmentTable, limits: MapCheckLimits) -> Iterator[MapFinding]:
    """Yield a finding for each obstacle that leaves the border of the map."""
    border = table.robot_map.border
    low = np.array([border.x_min, border.y_min]) - findings.SAME_PLACE
    high = np.array([border.x_max, border.y_max]) + findings.SAME_PLACE
    within = (table.a >= low) & (table.a <= high) & (table.b >= low) & (table.b <= high)
    inside: NDArray[Any] = np.all(within, axis=1)
    for row, segments in _by_obstacle(table, ~inside):
        yield MapFinding(
            MapFindingKind.OUTSIDE,
            Severity.ERROR,
            table.obstacles[row].id,
            f"{counted(len(segments), 'segment')} outside the border of the map: clip the map to its border "
            "or widen it",
            table.lines(segments),
        )


def without_length(table: SegmentTable, limits: MapCheckLimits) -> Iterator[MapFinding]:
    """Yield a finding for each obstacle with segments whose two ends are one point."""
    for row, segments in _by_obstacle(table, table.lengths < findings.SAME_PLACE):
        first = table.a[segments[0]]
        yield MapFinding(
            MapFindingKind.SLIVER,
            Severity.WARNING,
            table.obstacles[row].id,
            f"{counted(len(segments), 'segment')} without length, the first at {place(first)}: leave it out",
            mark(first),
        )


def wrong_heights(table: SegmentTable, limits: MapCheckLimits) -> Iterator[MapFinding]:
    """Yield a finding for each obstacle with a height that its shape cannot have.

    Ramps have height 0 and so has the last riser of stairs (paper 1, section II); nothing else has.
    """
    kind = table.shape_type[table.row]
    last = np.zeros(len(kind), dtype=bool)
    last[table.offsets[1:][np.diff(table.offsets) > 0] - 1] = True
    level = (kind == ShapeType.RAMP) | ((kind == ShapeType.STAIRS) & last)
    for row, segments in _by_obstacle(table, ~level & (table.height <= 0)):
        yield _height(
            table,
            row,
            segments,
            "a height of 0 or less: a robot may take it for floor; give its height in metres",
        )
    for row, segments in _by_obstacle(table, level & (table.height != 0)):
        ramp = table.shape_type[row] == ShapeType.RAMP
        rule = "a ramp has height 0" if ramp else "the last riser of stairs has height 0"
        yield _height(table, row, segments, f"a height that is not 0, and {rule}: write 0")


def _height(table: SegmentTable, row: int, segments: NDArray[Any], text: str) -> MapFinding:
    id = table.obstacles[row].id
    statement = f"{counted(len(segments), 'segment')} with {text}"
    return MapFinding(MapFindingKind.HEIGHT, Severity.WARNING, id, statement, table.lines(segments))


def _by_obstacle(table: SegmentTable, odd: NDArray[Any]) -> Iterator[tuple[int, NDArray[Any]]]:
    """Yield each obstacle that has segments marked in ``odd``, and the indices of those."""
    indices = np.flatnonzero(odd)
    for row in np.unique(table.row[indices]):
        yield int(row), indices[table.row[indices] == row]


def _of_all(table: SegmentTable, rows: list[int]) -> NDArray[Any]:
    """Return the segments of all obstacles in ``rows``; without any, a cross in the middle."""
    lines = table.lines(np.isin(table.row, rows))
    border = table.robot_map.border
    middle = np.array([(border.x_min + border.x_max) / 2, (border.y_min + border.y_max) / 2])
    return lines if len(lines) else mark(middle)


# --- Checks of chains: gaps between segments, and lines that end short of another obstacle ---


def broken_chains(table: SegmentTable, limits: MapCheckLimits) -> Iterator[MapFinding]:
    """Yield a finding for each place where an outline breaks off, and for reversed segments in one."""
    before, after = _joints(table)
    broken = _apart(table.b[before], table.a[after])
    head_on = broken & (before != after)
    head_on &= ~_apart(table.b[before], table.b[after]) | ~_apart(table.a[before], table.a[after])
    for row in np.unique(table.row[before[head_on]]):
        joints = head_on & (table.row[before] == row)
        segments = _most_frequent(np.concatenate([before[joints], after[joints]]))
        yield MapFinding(
            MapFindingKind.ORIENTATION,
            Severity.ERROR,
            table.obstacles[row].id,
            f"{counted(int(joints.sum()), 'joint')} where two segments run against each other, the first at "
            f"{place(table.b[before[joints][0]])}: turn one of the two round",
            table.lines(segments),
        )
    for i, j in zip(before[broken & ~head_on], after[broken & ~head_on], strict=True):
        yield _gap(table, int(i), int(j))


def near_misses(table: SegmentTable, limits: MapCheckLimits) -> Iterator[MapFinding]:
    """Yield a finding for each end of a line that stops just short of another obstacle.

    Ends cut by the border do not count.
    """
    points, rows = _loose_ends(table)
    number, segment, distance = _distances(table, points, rows, limits.gap)
    attached = np.unique(number[distance <= findings.TOUCHING])
    near = ~np.isin(number, attached)
    for end in np.unique(number[near]):
        candidates = np.flatnonzero(near & (number == end))
        nearest = candidates[np.argmin(distance[candidates])]
        reached = _nearest_points(points[[end]], table, segment[[nearest]])[0]
        other = table.obstacles[table.row[segment[nearest]]].id
        yield MapFinding(
            MapFindingKind.GAP,
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


def _gap(table: SegmentTable, before: int, after: int) -> MapFinding:
    row = table.row[before]
    ends = np.array([[table.b[before], table.a[after]]])
    width = float(np.hypot(*(ends[0, 1] - ends[0, 0])))
    closed = bool(table.closed[row])
    return MapFinding(
        MapFindingKind.GAP,
        Severity.ERROR if closed else Severity.WARNING,
        table.obstacles[row].id,
        f"a gap of {width:.2f} m after {place(ends[0, 0])} in "
        + ("a ring that should close" if closed else "a line that should go on")
        + ": add the segment that is missing, or make it an open shape of its own",
        ends,
    )


def _apart(one: NDArray[Any], other: NDArray[Any]) -> NDArray[Any]:
    apart: NDArray[Any] = np.hypot(*(one - other).T) > findings.SAME_PLACE
    return apart


def _most_frequent(segments: NDArray[Any]) -> NDArray[Any]:
    """Return the values that occur most often: a reversed segment in a chain has two bad joints."""
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
    inside = (np.minimum(x - border.x_min, border.x_max - x) > findings.SAME_PLACE) & (
        np.minimum(y - border.y_min, border.y_max - y) > findings.SAME_PLACE
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
    for one, other in findings.overlapping_boxes(low, high):
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


# --- Checks of rings: direction, enclosed area, and nesting

_STEP_IN = 0.02
"""metres from an edge to a point that is safely on one side of it."""


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


def wrong_rings(table: SegmentTable, limits: MapCheckLimits) -> Iterator[MapFinding]:
    """Yield a finding for each ring that is thin, has the wrong direction, or lies inside a solid one.

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
        yield _finding(table, MapFindingKind.SLIVER, Severity.WARNING, int(rings.rows[k]), text)
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


def _clockwise(table: SegmentTable, row: int, cut: set[str]) -> Iterator[MapFinding]:
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
    yield _finding(table, MapFindingKind.ORIENTATION, severity, row, text)


def _inside(table: SegmentTable, row: int, outer: int) -> MapFinding:
    id, source = table.obstacles[outer].id, table.obstacles[row].ext.get("src")
    if source and source == table.obstacles[outer].ext.get("src"):
        text = (
            f"a courtyard of obstacle {id} (both from {source}) that runs counter-clockwise: its free space "
            "is in the wall; turn it round"
        )
        return _finding(table, MapFindingKind.ORIENTATION, Severity.ERROR, row, text)
    text = f"lies inside obstacle {id}, where no robot comes: leave one of them out"
    return _finding(table, MapFindingKind.OVERLAP, Severity.WARNING, row, text)


def _cut_sources(table: SegmentTable) -> set[str]:
    """Return the sources of the outlines that the border cuts; an empty one if none is stated."""
    border = table.robot_map.border
    sources = set()
    for row in np.flatnonzero(~table.closed & (np.diff(table.offsets) > 0)):
        at = table.of_obstacle(int(row))
        (x, y) = np.stack([table.a[at][0], table.b[at][-1]]).T
        to_side = np.min([x - border.x_min, border.x_max - x, y - border.y_min, border.y_max - y], axis=0)
        if (to_side <= findings.SAME_PLACE).all():
            sources.add(table.obstacles[row].ext.get("src", ""))
    return sources


def _finding(
    table: SegmentTable, kind: MapFindingKind, severity: Severity, row: int, text: str
) -> MapFinding:
    lines = table.lines(np.arange(*table.of_obstacle(row).indices(len(table.a))))
    return MapFinding(
        kind, severity, table.obstacles[row].id, text, lines if len(lines) else mark(np.zeros(2))
    )


def _is_whole(table: SegmentTable, row: int) -> bool:
    at = table.of_obstacle(row)
    a, b = table.a[at], table.b[at]
    return len(a) >= 3 and bool((np.hypot(*(np.roll(a, -1, axis=0) - b).T) <= findings.SAME_PLACE).all())


def _signed_area(points: NDArray[Any]) -> float:
    x, y = (points - points[0]).T
    return float((x * np.roll(y, -1) - np.roll(x, -1) * y).sum() / 2)


def _rings_around(table: SegmentTable, rings: _Rings, usable: NDArray[Any]) -> dict[int, int]:
    """Return the smallest other ring that each ring lies in, for those that lie in one."""
    inner, outer = [], []
    for one, other in findings.overlapping_boxes(rings.low, rings.high):
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
    """Return whether the ring of an obstacle encloses ``point``, by the even-odd rule."""
    at = table.of_obstacle(row)
    (ax, ay), (bx, by) = table.a[at].T, table.b[at].T
    x, y = point
    crosses = (ay > y) != (by > y)
    with np.errstate(divide="ignore", invalid="ignore"):
        right = x < ax + (y - ay) * (bx - ax) / (by - ay)
    return bool((crosses & right).sum() % 2)


# --- Checks of the direction of stairs ---


def turned_risers(table: SegmentTable, limits: MapCheckLimits) -> Iterator[MapFinding]:
    """Yield a finding for each flight with risers that have the way up on their right.

    The first riser is the bottom one; seen from there each runs from left to right, so that free space is on
    its right (paper 1, section II).
    """
    for row in np.flatnonzero(table.shape_type == ShapeType.STAIRS):
        at = table.of_obstacle(int(row))
        a, b = table.a[at], table.b[at]
        if len(a) < 2:
            continue
        up = (a[-1] + b[-1] - a[0] - b[0]) / 2
        along = b - a
        turned = along[:, 0] * up[1] - along[:, 1] * up[0] < 0
        if turned.any():
            yield MapFinding(
                MapFindingKind.ORIENTATION,
                Severity.ERROR,
                table.obstacles[row].id,
                f"{turned.sum()} of {len(a)} risers run from right to left seen from the bottom: turn them "
                "round, or write the bottom riser first",
                table.lines(np.arange(at.start, at.stop)[turned]),
            )
