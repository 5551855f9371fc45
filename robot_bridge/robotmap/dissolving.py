"""Walls that no robot outside can meet: between buildings that touch, and inside buildings."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..missing_packages import installation
from .chaining import LINES
from .errors import MissingGeometryError
from .model import ShapeType
from .outlines import OutlineRow
from .watch import UNWATCHED, Watch

_GRID = 0.01
"""metres; corners nearer than a map tells apart are the same when buildings are put together."""
_ALONG = 0.05
"""metres; a line this near to a building's wall is that wall once more."""


def without_shared_walls(rows: Sequence[OutlineRow], watch: Watch = UNWATCHED) -> list[OutlineRow]:
    """Return ``rows`` without what polygons that touch have between or inside each other.

    Each polygon keeps what of its outline lies on the outside of them all, with its height and source: a ring
    where that is whole, else open chains with free space to their right. Polygons that touch none are as they
    were, and so are all that are no sound polygon. Raises MissingGeometryError without shapely,
    CancelledError when ``watch`` says so.
    """
    shapely = shapely_module()
    watch.at(0.0)
    groups = list(_polygons(rows))
    shapes = np.array([shape for _, shape in groups], dtype=object)
    one, other = shapely.STRtree(shapes).query(shapes, predicate="dwithin", distance=_GRID)
    touching = np.unique(one[one != other])
    if not len(touching):
        return list(rows)
    replaced = {k for place in touching for k in groups[place][0]}
    result = [(k, row) for k, row in enumerate(rows) if k not in replaced]
    watch.at(0.2)
    outside = shapely.union_all(shapely.set_precision(shapes[touching], _GRID), grid_size=_GRID)
    tree = shapely.STRtree(shapely.boundary(shapes[touching]))
    for points, inner in watch.part(0.7, 1.0).over(list(_oriented_rings(outside))):
        middles = (points[:-1] + points[1:]) / 2
        segment, place = tree.query_nearest(shapely.points(middles), all_matches=True)
        owner = np.full(len(middles), len(touching))
        np.minimum.at(owner, segment, place)
        for own, part, closed in _stretches(points, owner):
            shell = groups[touching[own]][0][0]
            result.append((shell, _stretch(rows[shell], part, closed, inner and closed)))
    return [row for _, row in sorted(result, key=lambda item: item[0])]


def without_hidden_lines(rows: Sequence[OutlineRow], watch: Watch = UNWATCHED) -> list[OutlineRow]:
    """Return ``rows`` with only those parts of lines that lie outside of all polygons and not along them.

    A line runs along a polygon within 5 cm of it. Raises MissingGeometryError without shapely,
    CancelledError when ``watch`` says so.
    """
    shapely = shapely_module()
    solid = shapely.buffer([shape for _, shape in _polygons(rows)], _ALONG, join_style="mitre")
    tree = shapely.STRtree(solid)
    result: list[OutlineRow] = []
    for row in watch.over(rows):
        line = _line(row)
        near = tree.query(line, predicate="intersects") if line is not None else ()
        if not len(near):
            result.append(row)
            continue
        left = shapely.get_parts(shapely.line_merge(shapely.difference(line, shapely.union_all(solid[near]))))
        result += [
            replace(row, points=shapely.get_coordinates(part)) for part in left if part.length >= _GRID
        ]
    return result


def shapely_module() -> Any:
    """Return shapely; raises MissingGeometryError where it is not installed."""
    try:
        import shapely
    except ImportError:
        raise MissingGeometryError(
            "dissolving and simplifying outlines need the Python package shapely 2, which is not installed "
            f"here; install it {installation('shapely')}, or leave them off"
        ) from None
    return shapely


def _polygons(rows: Sequence[OutlineRow]) -> Iterator[tuple[list[int], Any]]:
    """Yield the rows of each sound polygon, its shell first, and the polygon."""
    shapely = shapely_module()
    group: list[int] = []
    for k, row in enumerate(rows):
        if row.shape_type not in (ShapeType.CLOSED_POLYGON, ShapeType.CLOSED_CURVE):
            continue
        if row.courtyard and group and rows[group[0]].source == row.source:
            group.append(k)
            continue
        yield from _sound(shapely, rows, group)
        group = [k]
    yield from _sound(shapely, rows, group)


def _sound(shapely: Any, rows: Sequence[OutlineRow], group: list[int]) -> Iterator[tuple[list[int], Any]]:
    rings = [rows[k].points for k in group]
    if not rings or rows[group[0]].courtyard:
        return
    if any(len(ring) < 4 or not np.isfinite(ring).all() or (ring[0] != ring[-1]).any() for ring in rings):
        return
    polygon = shapely.Polygon(rings[0], rings[1:])
    if polygon.is_valid:
        yield group, polygon


def _line(row: OutlineRow) -> Any:
    if row.shape_type not in LINES or len(row.points) < 2 or not np.isfinite(row.points).all():
        return None
    return shapely_module().LineString(row.points)


def _oriented_rings(polygons: Any) -> Iterator[tuple[NDArray[Any], bool]]:
    """Yield points and whether it is a hole, for each ring: free space is to the right of its points."""
    shapely = shapely_module()
    for polygon in shapely.get_parts(polygons):
        for k, ring in enumerate((polygon.exterior, *polygon.interiors)):
            points = shapely.get_coordinates(ring)
            counter_clockwise = bool(shapely.is_ccw(ring))
            yield (points[::-1] if counter_clockwise == (k > 0) else points), k > 0


def _stretches(points: NDArray[Any], owner: NDArray[Any]) -> Iterator[tuple[int, NDArray[Any], bool]]:
    """Yield owner, points and whether it is the whole ring, for each stretch of a ring with one owner."""
    changes = np.flatnonzero(owner != np.roll(owner, 1))
    if not len(changes):
        yield int(owner[0]), points, True
        return
    ring = np.roll(points[:-1], -changes[0], axis=0)
    owner = np.roll(owner, -changes[0])
    ring = np.concatenate([ring, ring[:1]])
    starts = [0, *(np.flatnonzero(np.diff(owner)) + 1).tolist(), len(owner)]
    for start, end in pairwise(starts):
        yield int(owner[start]), ring[start : end + 1], False


def _stretch(row: OutlineRow, points: NDArray[Any], closed: bool, courtyard: bool) -> OutlineRow:
    opened = ShapeType.OPEN_CURVE if row.shape_type is ShapeType.CLOSED_CURVE else ShapeType.OPEN_POLYGON
    return replace(row, points=points, shape_type=row.shape_type if closed else opened, courtyard=courtyard)
