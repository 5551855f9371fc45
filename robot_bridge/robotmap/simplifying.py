"""Outlines with fewer corners, never farther from the drawn ones than is said, never crossing themselves."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .dissolving import shapely_module
from .model import ShapeType
from .outlines import OutlineRow
from .segments import CLOSED_TYPES


def simplified(row: OutlineRow, tolerance: float) -> OutlineRow:
    """Return ``row`` with corners left out (Douglas and Peucker, 1973), within ``tolerance`` metres of it.

    An outline that would cross itself, vanish or end up farther off (GEOS may move the corner where a ring
    begins beyond the tolerance) stays as it is, and so do stairs and what is no sound line.
    Raises MissingGeometryError without shapely.
    """
    shapely = shapely_module()
    closed = row.shape_type in CLOSED_TYPES
    if not _may_change(row, closed):
        return row
    line = shapely.Polygon(row.points) if closed else shapely.LineString(row.points)
    if not (line.is_valid and line.is_simple):
        return row
    fewer = shapely.simplify(line, tolerance, preserve_topology=True)
    points = shapely.get_coordinates(fewer)
    if not _sound(points, closed):
        return row
    off = shapely.hausdorff_distance(shapely.LineString(points), shapely.LineString(row.points))
    return replace(row, points=points) if off <= tolerance else row


def without_short_segments(row: OutlineRow, shortest: float) -> OutlineRow:
    """Return ``row`` without corners nearer than ``shortest`` metres to the one kept before.

    Ends of lines stay, a ring keeps three corners, and so a small thing stays whatever its size. An outline
    that would cross itself, or be farther than ``shortest`` from the drawn one, stays as it is, and so do
    stairs. Raises MissingGeometryError without shapely.
    """
    closed = row.shape_type in CLOSED_TYPES
    if not _may_change(row, closed):
        return row
    points = row.points
    kept = [0]
    for k in range(1, len(points) - 1):
        if _distance(points[k], points[kept[-1]]) >= shortest:
            kept.append(k)
    while len(kept) > (3 if closed else 1) and _distance(points[-1], points[kept[-1]]) < shortest:
        kept.pop()
    fewer = points[[*kept, len(points) - 1]]
    if not _sound(fewer, closed):
        return row
    shapely = shapely_module()
    off = shapely.hausdorff_distance(shapely.LineString(fewer), shapely.LineString(points))
    return replace(row, points=fewer) if off <= shortest else row


def _may_change(row: OutlineRow, closed: bool) -> bool:
    if row.shape_type is ShapeType.STAIRS or not np.isfinite(row.points).all():
        return False
    return len(row.points) > (4 if closed else 2) and (
        not closed or bool((row.points[0] == row.points[-1]).all())
    )


def _distance(one: NDArray[Any], other: NDArray[Any]) -> float:
    return float(np.hypot(*(one - other)))


def _sound(points: NDArray[Any], closed: bool) -> bool:
    if len(points) < (4 if closed else 2):
        return False
    shapely = shapely_module()
    if closed:
        return bool(shapely.Polygon(points).is_valid)
    return bool(shapely.LineString(points).is_simple)
