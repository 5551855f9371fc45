"""Checks of a robot map, numpy only: crossing obstacles, unreachable pockets, and all checks in order."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..errors import counted
from . import findings, obstacle_checks
from .findings import MapCheckLimits, MapFinding, MapFindingKind, SegmentTable, Severity, place
from .model import Border, RobotMap, ShapeType

# --- Obstacles that repeat, cover or cross one another ---

_SHORTEST_OVERLAP = 0.05
_PARALLEL = 0.95

_CROSSING, _SAME, _ALONG, _AGAINST = range(4)


@dataclass(frozen=True, eq=False)
class _Pairs:
    """m pairs of segments: the fault of each pair, and two lines each, (m, 2, 2, 2), that show the place."""

    one: NDArray[Any]
    other: NDArray[Any]
    what: NDArray[Any]
    lines: NDArray[Any]


def meeting_obstacles(table: SegmentTable, limits: MapCheckLimits) -> Iterator[MapFinding]:
    """Yield a finding for each pair of obstacles that share segments, cover each other or cross.

    Touching is no finding, nor are ramps: walls stand on their outlines.
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
    kept = np.flatnonzero(
        (table.shape_type[table.row] != ShapeType.RAMP) & (table.lengths >= findings.SAME_PLACE)
    )
    a, b = table.a[kept], table.b[kept]
    none = np.empty(0, dtype=np.int64)
    found = [_Pairs(none, none, none, np.empty((0, 2, 2, 2)))]
    for i, j in findings.overlapping_boxes(
        np.minimum(a, b) - findings.TOUCHING, np.maximum(a, b) + findings.TOUCHING
    ):
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
    clear = (
        np.minimum(np.minimum(np.abs(aj), np.abs(bj)), np.minimum(np.abs(ai), np.abs(bi))) > findings.TOUCHING
    )
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
    same = (
        (np.abs(start) <= findings.SAME_PLACE)
        & (np.abs(end - length) <= findings.SAME_PLACE)
        & (off <= findings.SAME_PLACE)
    )
    covers = (off <= findings.TOUCHING) & (np.abs(turn) >= _PARALLEL) & (high - low > _SHORTEST_OVERLAP)
    kept = covers | same
    what = np.where(same, _SAME, np.where(turn > 0, _ALONG, _AGAINST))[kept]
    ends = [(a[i] + t[:, None] * unit)[kept] for t in (low, high)]
    line = np.stack(ends, axis=1)
    return _Pairs(i[kept], j[kept], what, np.stack([line, line], axis=1))


def _finding(
    table: SegmentTable, first: int, second: int, what: int, count: int, lines: NDArray[Any]
) -> MapFinding:
    id, other = table.obstacles[second].id, table.obstacles[first].id
    length = np.hypot(*(lines[::2, 1] - lines[::2, 0]).T).sum()
    times = counted(count, "place")
    if first == second:
        return _with_itself(id, what, times, length, lines)
    if what == _CROSSING:
        text = f"crosses obstacle {other} in {times}: merge them, or move one"
        return MapFinding(MapFindingKind.OVERLAP, Severity.WARNING, id, text, lines)
    if what == _SAME:
        whole = count >= len(table.obstacles[second].a)
        text = ("is all in" if whole else f"shares {times} with") + f" obstacle {other}"
        return MapFinding(
            MapFindingKind.DUPLICATE, Severity.WARNING, id, f"{text}: leave one of them out", lines[::2]
        )
    if what == _ALONG:
        text = f"runs along obstacle {other} for {length:.2f} m in the same direction: cut or merge them"
        return MapFinding(MapFindingKind.OVERLAP, Severity.WARNING, id, text, lines[::2])
    text = (
        f"runs along obstacle {other} for {length:.2f} m in the opposite direction: a wall that both share, "
        "which no robot outside meets"
    )
    return MapFinding(MapFindingKind.SHARED_WALL, Severity.INFO, id, text, lines[::2])


def _with_itself(id: int, what: int, times: str, length: float, lines: NDArray[Any]) -> MapFinding:
    if what == _CROSSING:
        text = f"crosses itself in {times}: repair the outline that it comes from"
        return MapFinding(MapFindingKind.OVERLAP, Severity.WARNING, id, text, lines)
    text = f"goes twice along {length:.2f} m of itself in {times}: repair the outline that it comes from"
    return MapFinding(MapFindingKind.DUPLICATE, Severity.WARNING, id, text, lines[::2])


# --- Connected regions of a grid of true and false, by runs of cells; numpy only ---


def regions(free: NDArray[Any]) -> tuple[NDArray[Any], int]:
    """Return a label for each cell of ``free``, (rows, columns) bool, and how many labels there are.

    Cells that share a side have the same label, from 0; cells that are false have -1.
    """
    rows, columns = free.shape
    edges = np.diff(np.pad(free, ((0, 0), (1, 1))).astype(np.int8), axis=1)
    row, start = np.nonzero(edges == 1)
    end = np.nonzero(edges == -1)[1]
    label = _joined(np.arange(len(row)), *_neighbours(row, start, end, columns))
    names, label = np.unique(label, return_inverse=True)
    cells = np.full(free.size, -1, dtype=np.int64)
    cells[free.reshape(-1)] = np.repeat(label.reshape(-1), end - start)
    return cells.reshape(rows, columns), len(names)


def _neighbours(
    row: NDArray[Any], start: NDArray[Any], end: NDArray[Any], columns: int
) -> tuple[NDArray[Any], NDArray[Any]]:
    """Return the pairs of runs in following rows that share a column."""
    width = columns + 1
    # Runs are sorted by row and column, so each touches a stretch of those in the row above.
    first = np.searchsorted(row * width + end, (row - 1) * width + start, side="right")
    last = np.searchsorted(row * width + start, (row - 1) * width + end, side="left")
    counts = np.maximum(last - first, 0)
    below = np.repeat(np.arange(len(row)), counts)
    within = np.arange(len(below)) - np.repeat(np.cumsum(counts) - counts, counts)
    return below, first[below] + within


def _joined(label: NDArray[Any], one: NDArray[Any], other: NDArray[Any]) -> NDArray[Any]:
    """Return the smallest label that each can reach by the pairs (one, other)."""
    while True:
        low = np.minimum(label[one], label[other])
        smaller = label.copy()
        np.minimum.at(smaller, label[one], low)
        np.minimum.at(smaller, label[other], low)
        # Follow each label until it maps to itself.
        while (smaller[smaller] != smaller).any():
            smaller = smaller[smaller]
        if (smaller == label).all():
            return label
        label = smaller


# --- Free space that a robot cannot reach, found on a grid ---

_MOST_CELLS = 16_000_000
"""Bounds the memory to some 400 MB."""
_FINEST_M = 0.05


@dataclass(frozen=True)
class FreeSpaceGrid:
    """Square cells of ``size`` metres from the left-lower corner of a border; row 0 is the lowest."""

    x: float
    y: float
    size: float
    rows: int
    columns: int

    @classmethod
    def over(cls, border: Border, robot_width: float) -> FreeSpaceGrid:
        """Return a grid with four cells to a robot's width, coarser where that would be too many."""
        size = max(robot_width / 4, _FINEST_M, math.sqrt(border.area / _MOST_CELLS))
        width, height = border.x_max - border.x_min, border.y_max - border.y_min
        columns, rows = math.ceil(width / size), math.ceil(height / size)
        return cls(border.x_min, border.y_min, size, max(rows, 1), max(columns, 1))

    def part(self, at: tuple[slice, slice]) -> FreeSpaceGrid:
        """Return the grid of the rows and columns in ``at``."""
        down, across = at
        x, y = self.x + across.start * self.size, self.y + down.start * self.size
        return FreeSpaceGrid(x, y, self.size, down.stop - down.start, across.stop - across.start)

    def cells(self, points: NDArray[Any]) -> tuple[NDArray[Any], NDArray[Any]]:
        """Return row and column of each of ``points``, (n, 2); those beside the grid get its edge."""
        column = np.floor((points[:, 0] - self.x) / self.size).astype(np.int64)
        row = np.floor((points[:, 1] - self.y) / self.size).astype(np.int64)
        return np.clip(row, 0, self.rows - 1), np.clip(column, 0, self.columns - 1)


def unreachable_pockets(table: SegmentTable, limits: MapCheckLimits) -> Iterator[MapFinding]:
    """Yield a finding for each free area that is large enough for a robot but unreachable.

    Areas at the border are not judged: the way in may be outside the map. Solid rings are no free space,
    their courtyards are. The grid has a quarter of the robot's width, so passages and bottlenecks are
    distinguished with about that precision. A map too large for at least half of its width gets one finding
    that says so.
    """
    if not len(table.a):
        return
    grid = FreeSpaceGrid.over(table.robot_map.border, limits.robot_width)
    if grid.size > max(limits.robot_width / 2, _FINEST_M):
        yield _too_large(table.robot_map.border, limits.robot_width)
        return
    free = ~_widened(_walls(table, grid), limits.robot_width / 2 / grid.size) & ~_solid(table, grid)
    label, count = regions(free)
    sizes = np.bincount(label[label >= 0], minlength=count)
    rim = np.concatenate([label[0], label[-1], label[:, 0], label[:, -1]])
    outside = np.unique(rim[rim >= 0])
    # If nothing free touches the border, robots are assumed in the largest area.
    known = set(outside.tolist()) or ({int(np.argmax(sizes))} if count else set())
    for number, at in enumerate(_boxes(label, count)):
        area = float(sizes[number]) * grid.size**2
        if number in known or area < limits.pocket:
            continue
        yield _pocket(label[at] == number, grid.part(at), area, limits.robot_width)


def _pocket(cells: NDArray[Any], grid: FreeSpaceGrid, area: float, robot_width: float) -> MapFinding:
    inside = np.argwhere(cells)
    middle = np.array([grid.x, grid.y]) + (inside[len(inside) // 2][::-1] + 0.5) * grid.size
    text = (
        f"{area:.1f} m² of free space around {place(middle)} that a robot {robot_width:g} m wide cannot "
        "reach: open a way in, or fill it where none is meant"
    )
    return MapFinding(MapFindingKind.POCKET, Severity.INFO, None, text, _outline(cells, grid))


def _too_large(border: Border, robot_width: float) -> MapFinding:
    largest = _MOST_CELLS * (robot_width / 2) ** 2
    text = (
        f"pockets were not looked for: the map has {border.area:.0f} m², and for a robot {robot_width:g} m "
        f"wide at most {largest:.0f} m² are searched; export the site in tiles and check those"
    )
    (x_min, y_max), (x_max, y_min) = border.left_upper, border.right_lower
    corners = np.array([[x_min, y_min], [x_max, y_min], [x_max, y_max], [x_min, y_max]])
    outline = np.stack([corners, np.roll(corners, -1, axis=0)], axis=1)
    return MapFinding(MapFindingKind.POCKET, Severity.INFO, None, text, outline)


def _boxes(label: NDArray[Any], count: int) -> list[tuple[slice, slice]]:
    """Return the rows and columns that each region lies in."""
    row, column = np.nonzero(label >= 0)
    number = label[row, column]
    sides = []
    for where in (row, column):
        low, high = np.full(count, np.iinfo(np.int64).max), np.zeros(count, dtype=np.int64)
        np.minimum.at(low, number, where)
        np.maximum.at(high, number, where)
        sides.append([slice(int(a), int(b) + 1) for a, b in zip(low, high, strict=True)])
    return list(zip(*sides, strict=True))


def _walls(table: SegmentTable, grid: FreeSpaceGrid) -> NDArray[Any]:
    """Return the cells that segments pass through; ramps and level risers stop no robot."""
    kind = table.shape_type[table.row]
    stops = (kind != ShapeType.RAMP) & ~((kind == ShapeType.STAIRS) & (table.height <= 0))
    a, b = table.a[stops], table.b[stops]
    counts = np.ceil(np.hypot(*(b - a).T) / (grid.size / 2)).astype(np.int64) + 1
    segment = np.repeat(np.arange(len(a)), counts)
    step = np.arange(len(segment)) - np.repeat(np.cumsum(counts) - counts, counts)
    share = step / np.maximum(counts - 1, 1)[segment]
    wall = np.zeros((grid.rows, grid.columns), dtype=bool)
    wall[grid.cells(a[segment] + share[:, None] * (b - a)[segment])] = True
    return wall


def _widened(wall: NDArray[Any], radius: float) -> NDArray[Any]:
    """Return ``wall`` with every cell whose middle is within ``radius`` cells of one of it."""
    wide = wall.copy()
    reach = int(radius)
    rows, columns = wall.shape
    for down in range(-reach, reach + 1):
        for right in range(-reach, reach + 1):
            beside = abs(down) >= rows or abs(right) >= columns
            if beside or down * down + right * right > radius * radius:
                continue
            target = wide[max(down, 0) : rows + min(down, 0), max(right, 0) : columns + min(right, 0)]
            target |= wall[max(-down, 0) : rows + min(-down, 0), max(-right, 0) : columns + min(-right, 0)]
    return wide


def _solid(table: SegmentTable, grid: FreeSpaceGrid) -> NDArray[Any]:
    """Return the cells inside rings and not inside their courtyards, by the winding number."""
    ring = (table.closed & (table.shape_type != ShapeType.RAMP))[table.row]
    a, b = table.a[ring], table.b[ring]
    # Row r is crossed where its middle lies between the ends.
    low = np.ceil((np.minimum(a[:, 1], b[:, 1]) - grid.y) / grid.size - 0.5).astype(np.int64)
    high = np.ceil((np.maximum(a[:, 1], b[:, 1]) - grid.y) / grid.size - 0.5).astype(np.int64)
    low, high = np.clip(low, 0, grid.rows), np.clip(high, 0, grid.rows)
    counts = high - low
    edge = np.repeat(np.arange(len(a)), counts)
    row = low[edge] + np.arange(len(edge)) - np.repeat(np.cumsum(counts) - counts, counts)
    y = grid.y + (row + 0.5) * grid.size
    share = (y - a[edge, 1]) / (b[edge, 1] - a[edge, 1])
    x = a[edge, 0] + share * (b[edge, 0] - a[edge, 0])
    column = np.clip(np.ceil((x - grid.x) / grid.size - 0.5).astype(np.int64), 0, grid.columns)
    turns = np.zeros((grid.rows, grid.columns + 1), dtype=np.int32)
    np.add.at(turns, (row, column), np.where(b[edge, 1] < a[edge, 1], 1, -1))
    solid: NDArray[Any] = np.cumsum(turns, axis=1)[:, :-1] != 0
    return solid


def _outline(cells: NDArray[Any], grid: FreeSpaceGrid) -> NDArray[Any]:
    """Return the straight pieces, (m, 2, 2), of the boundary of the cells that are true."""
    inner = np.pad(cells, 1)
    across = np.diff(inner.astype(np.int8), axis=0)[:, 1:-1] != 0
    upright = np.diff(inner.astype(np.int8), axis=1)[1:-1] != 0
    level = _runs(across)
    pieces = [
        np.stack([level[:, [1, 0]], level[:, [2, 0]]], axis=1),
        np.stack([(runs := _runs(upright.T))[:, [0, 1]], runs[:, [0, 2]]], axis=1),
    ]
    outline: NDArray[Any] = np.concatenate(pieces) * grid.size + np.array([grid.x, grid.y])
    return outline


def _runs(lines: NDArray[Any]) -> NDArray[Any]:
    """Return line, start and end of each run of true cells, (m, 3)."""
    edges = np.diff(np.pad(lines, ((0, 0), (1, 1))).astype(np.int8), axis=1)
    line, start = np.nonzero(edges == 1)
    return np.column_stack([line, start, np.nonzero(edges == -1)[1]])


# --- Checks of a robot map; numpy only, so that they run wherever a map can be read ---

__all__ = [
    "CHECKS",
    "Check",
    "MapCheckLimits",
    "MapFinding",
    "MapFindingKind",
    "SegmentTable",
    "Severity",
    "check_map",
]

Check = Callable[[SegmentTable, MapCheckLimits], Iterable[MapFinding]]

CHECKS: tuple[Check, ...] = (
    obstacle_checks.repeated_ids,
    obstacle_checks.outside_border,
    obstacle_checks.without_length,
    obstacle_checks.wrong_heights,
    obstacle_checks.turned_risers,
    obstacle_checks.broken_chains,
    obstacle_checks.near_misses,
    obstacle_checks.wrong_rings,
    meeting_obstacles,
    unreachable_pockets,
)
"""Every check, the quick ones first; each processes the whole map and is independent of the others."""


def check_map(robot_map: RobotMap, limits: MapCheckLimits | None = None) -> list[MapFinding]:
    """Return the findings on ``robot_map``, in the order of :data:`CHECKS`; nothing is changed or raised."""
    table = SegmentTable.of(robot_map)
    return [finding for check in CHECKS for finding in check(table, limits or MapCheckLimits())]
