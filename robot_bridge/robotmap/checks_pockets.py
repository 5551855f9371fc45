"""Free space that a robot cannot reach, found on a grid."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .checks_finding import Finding, Kind, Limits, Severity
from .checks_regions import regions
from .checks_table import SegmentTable, place
from .model import Border, ShapeType

_MOST_CELLS = 16_000_000
"""Bounds the memory to some 400 MB."""
_FINEST_M = 0.05


@dataclass(frozen=True)
class Grid:
    """Square cells of ``size`` metres from the left-lower corner of a border; row 0 is the lowest."""

    x: float
    y: float
    size: float
    rows: int
    columns: int

    @classmethod
    def over(cls, border: Border, robot_width: float) -> Grid:
        """Return a grid with four cells to a robot's width, coarser where that would be too many."""
        size = max(robot_width / 4, _FINEST_M, math.sqrt(border.area / _MOST_CELLS))
        width, height = border.x_max - border.x_min, border.y_max - border.y_min
        columns, rows = math.ceil(width / size), math.ceil(height / size)
        return cls(border.x_min, border.y_min, size, max(rows, 1), max(columns, 1))

    def part(self, at: tuple[slice, slice]) -> Grid:
        """Return the grid of the rows and columns in ``at``."""
        down, across = at
        x, y = self.x + across.start * self.size, self.y + down.start * self.size
        return Grid(x, y, self.size, down.stop - down.start, across.stop - across.start)

    def cells(self, points: NDArray[Any]) -> tuple[NDArray[Any], NDArray[Any]]:
        """Return row and column of each of ``points``, (n, 2); those beside the grid get its edge."""
        column = np.floor((points[:, 0] - self.x) / self.size).astype(np.int64)
        row = np.floor((points[:, 1] - self.y) / self.size).astype(np.int64)
        return np.clip(row, 0, self.rows - 1), np.clip(column, 0, self.columns - 1)


def unreachable_pockets(table: SegmentTable, limits: Limits) -> Iterator[Finding]:
    """Yield a finding for each free area where a robot fits and that it cannot get into.

    Areas at the border are not judged: the way in may be outside the map. Solid rings are no free space,
    their courtyards are. The grid has a quarter of the robot's width, so a passage is told from a bottleneck
    to about that much. A map too large for at least half of its width gets one finding that says so.
    """
    if not len(table.a):
        return
    grid = Grid.over(table.robot_map.border, limits.robot_width)
    if grid.size > max(limits.robot_width / 2, _FINEST_M):
        yield _too_large(table.robot_map.border, limits.robot_width)
        return
    free = ~_widened(_walls(table, grid), limits.robot_width / 2 / grid.size) & ~_solid(table, grid)
    label, count = regions(free)
    sizes = np.bincount(label[label >= 0], minlength=count)
    rim = np.concatenate([label[0], label[-1], label[:, 0], label[:, -1]])
    outside = np.unique(rim[rim >= 0])
    # Where nothing free touches the border the largest area is the one that robots are in.
    known = set(outside.tolist()) or ({int(np.argmax(sizes))} if count else set())
    for number, at in enumerate(_boxes(label, count)):
        area = float(sizes[number]) * grid.size**2
        if number in known or area < limits.pocket:
            continue
        yield _pocket(label[at] == number, grid.part(at), area, limits.robot_width)


def _pocket(cells: NDArray[Any], grid: Grid, area: float, robot_width: float) -> Finding:
    inside = np.argwhere(cells)
    middle = np.array([grid.x, grid.y]) + (inside[len(inside) // 2][::-1] + 0.5) * grid.size
    text = (
        f"{area:.1f} m² of free space around {place(middle)} that a robot {robot_width:g} m wide cannot "
        "reach: open a way in, or fill it where none is meant"
    )
    return Finding(Kind.POCKET, Severity.INFO, None, text, _outline(cells, grid))


def _too_large(border: Border, robot_width: float) -> Finding:
    largest = _MOST_CELLS * (robot_width / 2) ** 2
    text = (
        f"pockets were not looked for: the map has {border.area:.0f} m², and for a robot {robot_width:g} m "
        f"wide at most {largest:.0f} m² are searched; export the site in tiles and check those"
    )
    (x_min, y_max), (x_max, y_min) = border.left_upper, border.right_lower
    corners = np.array([[x_min, y_min], [x_max, y_min], [x_max, y_max], [x_min, y_max]])
    outline = np.stack([corners, np.roll(corners, -1, axis=0)], axis=1)
    return Finding(Kind.POCKET, Severity.INFO, None, text, outline)


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


def _walls(table: SegmentTable, grid: Grid) -> NDArray[Any]:
    """Return the cells that segments go through; ramps and level risers stop nobody."""
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


def _solid(table: SegmentTable, grid: Grid) -> NDArray[Any]:
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


def _outline(cells: NDArray[Any], grid: Grid) -> NDArray[Any]:
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
