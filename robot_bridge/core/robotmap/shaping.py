"""Reduction of outlines before a map is built: joined lines, dissolved walls, fewer corners."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import Any, NamedTuple, TypeVar

import numpy as np
from numpy.typing import NDArray

from ..errors import MapCancelledError, MissingGeometryError, ShapingError, installation
from .model import ShapeType
from .outlines import CLOSED_TYPES, OutlineRow, Outlines

# --- Progress and cancellation of long work ---

Item = TypeVar("Item")

_EVERY = 100
"""Items between checks for cancellation."""


class ProgressMonitor:
    """Reports the finished share of the work, 0 to 1, to ``progress``, and polls ``cancelled``.

    Either may be None.
    """

    def __init__(
        self,
        progress: Callable[[float], None] | None = None,
        cancelled: Callable[[], bool] | None = None,
    ):
        self._progress, self._cancelled = progress, cancelled

    def at(self, share: float) -> None:
        """Report that ``share`` of the work is done; raises CancelledError when it was cancelled."""
        if self._cancelled is not None and self._cancelled():
            raise MapCancelledError("the work was cancelled; nothing of it is kept")
        if self._progress is not None:
            self._progress(share)

    def over(self, items: Sequence[Item]) -> Iterator[Item]:
        """Yield ``items`` and report progress on the way; raises CancelledError as :meth:`at`."""
        for k, item in enumerate(items):
            if k % _EVERY == 0:
                self.at(k / len(items))
            yield item

    def part(self, start: float, end: float) -> ProgressMonitor:
        """Return the monitor of a part of the work, ``start`` and ``end`` from 0 to 1."""
        tell = self._progress
        if tell is None:
            return ProgressMonitor(None, self._cancelled)
        return ProgressMonitor(lambda share: tell(start + share * (end - start)), self._cancelled)


UNMONITORED = ProgressMonitor()


# --- Lines that meet end to end joined into one: a wall given face by face is one obstacle ---

LINES = (ShapeType.OPEN_POLYGON, ShapeType.OPEN_CURVE)


class _End(NamedTuple):
    """One end of a line."""

    row: int
    last: bool


class _Part(NamedTuple):
    """One line of a chain, and whether it runs against it."""

    row: int
    backwards: bool


def chained(rows: Sequence[OutlineRow], watch: ProgressMonitor = UNMONITORED) -> list[OutlineRow]:
    """Return ``rows`` with lines joined wherever exactly two of a kind meet, to the centimetre.

    Lines are of a kind if they agree in everything but points and source. A chain has the direction and
    position of its first line; its source is that of the first line plus the number of others, ``walls:3+7``.
    Lines have no free side, so some are reversed. Raises CancelledError as ``watch`` does.
    """
    kinds: dict[Any, list[int]] = defaultdict(list)
    for k, row in enumerate(rows):
        if row.shape_type in LINES and len(row.points) > 1 and np.isfinite(row.points).all():
            kinds[_kind(row)].append(k)
    result = dict(enumerate(rows))
    for members in watch.over(list(kinds.values())):
        partners = _partners(rows, members)
        for k in members:
            if k in result:
                chain = _chain(k, partners)
                for part in chain:
                    del result[part.row]
                result[k] = _joined(rows, chain, k)
    return [result[k] for k in sorted(result)]


def _kind(row: OutlineRow) -> Any:
    extras = tuple(sorted(row.ext.items()))
    return row.shape_type, row.height, row.semantics, row.outdoor, row.base, extras


def _partners(rows: Sequence[OutlineRow], members: Sequence[int]) -> Mapping[_End, _End]:
    """Map each end that meets exactly one other line's end to that end."""
    nodes: dict[tuple[float, float], list[_End]] = defaultdict(list)
    for k in members:
        for last in (False, True):
            x, y = np.round(rows[k].points[-1 if last else 0], 2).tolist()
            nodes[x, y].append(_End(k, last))
    partners: dict[_End, _End] = {}
    for ends in nodes.values():
        if len(ends) == 2 and ends[0].row != ends[1].row:
            partners[ends[0]], partners[ends[1]] = ends[1], ends[0]
    return partners


def _chain(k: int, partners: Mapping[_End, _End]) -> list[_Part]:
    """Return the chain that line ``k`` is in, in the direction of ``k``."""
    after, goes_round = _followed(_End(k, True), partners)
    before = [] if goes_round else _followed(_End(k, False), partners)[0]
    return [
        *(_Part(end.row, not end.last) for end in reversed(before)),
        _Part(k, False),
        *(_Part(end.row, end.last) for end in after),
    ]


def _followed(end: _End, partners: Mapping[_End, _End]) -> tuple[list[_End], bool]:
    """Return the ends at which the lines beyond ``end`` are entered, and whether they return to its line."""
    start = end.row
    entered: list[_End] = []
    while end in partners:
        met = partners[end]
        if met.row == start:
            return entered, True
        entered.append(met)
        end = _End(met.row, not met.last)
    return entered, False


def _joined(rows: Sequence[OutlineRow], chain: Sequence[_Part], first: int) -> OutlineRow:
    if len(chain) == 1:
        return rows[first]
    points = [rows[part.row].points[:: -1 if part.backwards else 1] for part in chain]
    return replace(
        rows[first],
        points=np.concatenate([points[0], *(line[1:] for line in points[1:])]),
        source=f"{rows[first].source}+{len(chain) - 1}" if rows[first].source else "",
    )


# --- Walls that no robot outside can reach: between adjacent buildings, and inside buildings ---

_GRID = 0.01
"""metres; corners nearer than a map's resolution are merged when buildings are united."""
_ALONG = 0.05
"""metres; a line this near to a building's wall duplicates that wall."""
_BARRIER = 0.5
"""metres above the ground: obstacles that end lower, such as a kerb, or begin higher, such as a roof, hide
nothing on or below them, as robots get there."""


def without_shared_walls(
    rows: Sequence[OutlineRow], watch: ProgressMonitor = UNMONITORED
) -> list[OutlineRow]:
    """Return ``rows`` without walls between or inside touching polygons.

    Each polygon keeps the part of its outline on the outside of them all, with its height and source: a ring
    if that is complete, else open chains with free space to their right. Polygons that touch none stay
    unchanged, and so do invalid ones. Raises MissingGeometryError without shapely, CancelledError as
    ``watch`` does.
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


def without_hidden_lines(
    rows: Sequence[OutlineRow], watch: ProgressMonitor = UNMONITORED
) -> list[OutlineRow]:
    """Return ``rows`` with only those parts of lines that lie outside of all polygons and not along them.

    A line runs along a polygon within 5 cm of it. Raises MissingGeometryError without shapely, CancelledError
    as ``watch`` does.
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
    """Return shapely; raises MissingGeometryError if it is not installed."""
    try:
        import shapely
    except ImportError:
        raise MissingGeometryError(
            "dissolving and simplifying outlines need the Python package shapely 2, which is not installed "
            f"here; install it {installation('shapely')}, or leave them off"
        ) from None
    return shapely


def _polygons(rows: Sequence[OutlineRow]) -> Iterator[tuple[list[int], Any]]:
    """Yield the rows of each valid polygon that robots cannot enter, its shell first, and the polygon."""
    shapely = shapely_module()
    group: list[int] = []
    for k, row in enumerate(rows):
        if row.shape_type not in (ShapeType.CLOSED_POLYGON, ShapeType.CLOSED_CURVE):
            continue
        if not row.base < _BARRIER <= row.base + row.height:
            continue
        if row.courtyard and group and rows[group[0]].source == row.source:
            group.append(k)
            continue
        yield from _valid_polygons(shapely, rows, group)
        group = [k]
    yield from _valid_polygons(shapely, rows, group)


def _valid_polygons(
    shapely: Any, rows: Sequence[OutlineRow], group: list[int]
) -> Iterator[tuple[list[int], Any]]:
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


# --- Outlines with fewer corners, within a tolerance of the drawn ones, never crossing themselves


def simplified(row: OutlineRow, tolerance: float) -> OutlineRow:
    """Return ``row`` with corners left out (Douglas and Peucker, 1973), within ``tolerance`` metres of it.

    An outline that would cross itself, vanish or end up farther off (GEOS may move the corner where a ring
    begins beyond the tolerance) stays unchanged, and so do stairs and invalid lines.
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
    if not _is_valid(points, closed):
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
    if not _is_valid(fewer, closed):
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


def _is_valid(points: NDArray[Any], closed: bool) -> bool:
    if len(points) < (4 if closed else 2):
        return False
    shapely = shapely_module()
    if closed:
        return bool(shapely.Polygon(points).is_valid)
    return bool(shapely.LineString(points).is_simple)


# --- Options for reducing outlines before a map is built; each is independent and off by default

_STEP_SLACK = 1e-6
"""of a height step; 0.3 m is three steps of 0.1 m, not four."""
_DRIVEN_ON = (ShapeType.STAIRS, ShapeType.RAMP)


@dataclass(frozen=True)
class Shaping:
    """Options for reducing outlines to what a robot needs; lengths in metres, 0 or None is off."""

    plane: tuple[float, float] | None = None
    """The robot's lowest and highest point above the ground. Obstacles that end below or begin above are left
    out, except stairs and ramps."""
    height_step: float = 0.0
    """Heights are rounded up to a multiple of it."""
    dissolve: bool = False
    """Walls between buildings that touch, and lines inside or along buildings, are left out."""
    chain: bool = False
    """Lines that meet end to end and agree in all but their source become one."""
    tolerance: float = 0.0
    """Largest distance of a simplified outline from its original."""
    shortest: float = 0.0
    """Corners nearer than this to the one before are left out."""

    def __post_init__(self) -> None:
        for name in ("height_step", "tolerance", "shortest"):
            if not 0 <= getattr(self, name) < np.inf:
                raise ShapingError(f"{name} is {getattr(self, name)}; give metres, 0 or more")
        if self.plane is not None and not -np.inf < self.plane[0] < self.plane[1] < np.inf:
            raise ShapingError(f"plane is {self.plane}; give the lower and the upper height in metres")


def shaped(
    outlines: Outlines,
    shaping: Shaping,
    progress: Callable[[float], None] | None = None,
    cancelled: Callable[[], bool] | None = None,
) -> Outlines:
    """Return ``outlines`` reduced by ``shaping``.

    ``progress`` receives the finished share, 0 to 1; ``cancelled`` is polled and returns whether to end.
    Invalid outlines stay unchanged; the builder reports them. Raises MissingGeometryError if shapely is
    needed and missing, CancelledError when ``cancelled`` returned true.
    """
    stages, watch = _stages(shaping), ProgressMonitor(progress, cancelled)
    rows: Sequence[OutlineRow] = outlines.rows()
    for k, stage in enumerate(stages):
        rows = stage(rows, watch.part(k / len(stages), (k + 1) / len(stages)))
    watch.at(1.0)
    return Outlines.from_rows(rows)


Stage = Callable[[Sequence[OutlineRow], ProgressMonitor], Sequence[OutlineRow]]


def _stages(shaping: Shaping) -> list[Stage]:
    """Return the stages of the work in order."""
    plane, step = shaping.plane, shaping.height_step
    shortest, tolerance = shaping.shortest, shaping.tolerance
    stages: list[Stage] = []
    if plane is not None:
        stages.append(lambda rows, watch: [row for row in watch.over(rows) if _in_plane(row, *plane)])
    if step:
        stages.append(
            lambda rows, watch: [
                replace(row, height=_rounded_up(row.height, step)) for row in watch.over(rows)
            ]
        )
    if shaping.dissolve:
        stages.append(without_hidden_lines)
    if shaping.chain:
        stages.append(chained)
    # After chaining: the remaining pieces of a polygon's outline have a free side and must not be reversed.
    if shaping.dissolve:
        stages.append(without_shared_walls)
    if shortest:
        stages.append(lambda rows, watch: [without_short_segments(row, shortest) for row in watch.over(rows)])
    if tolerance:
        stages.append(lambda rows, watch: [simplified(row, tolerance) for row in watch.over(rows)])
    return stages


def _in_plane(row: OutlineRow, low: float, high: float) -> bool:
    """Return whether a robot between ``low`` and ``high`` meets it; non-finite heights count as met."""
    if row.shape_type in _DRIVEN_ON:
        return True
    return not (row.base >= high or row.base + row.height <= low)


def _rounded_up(height: float, step: float) -> float:
    if not np.isfinite(height):
        return height
    return float(np.round(np.ceil(height / step - _STEP_SLACK) * step, 2))
