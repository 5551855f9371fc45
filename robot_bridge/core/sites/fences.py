"""Fenced areas, keepouts and obstacles: which of them are near a robot, which roads come into them."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections import OrderedDict
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ..geometry import Track
from ..roads.network import Floats, Ints, Network
from ..robotmap.model import ShapeType
from ..robotmap.outlines import Outlines, is_closed
from ..robotmap.window_index import BoxGrid
from .frame import Points
from .site_layers import group_spans

# --- Forbidden areas: edges, places and paths that enter them ---


class KeepoutIndex:
    """Finds geometries that enter one of ``areas``, each an outer ring and its holes, (n, 2) each.

    Running along the rim of an area, or standing on it, is not entering.

    :raises ImportError: if shapely is not installed.
    """

    def __init__(self, areas: Sequence[Sequence[Floats]]) -> None:
        import shapely

        self._tree = shapely.STRtree(
            [shapely.make_valid(shapely.Polygon(outer, holes)) for outer, *holes in areas]
        )

    def entered(self, tracks: Sequence[Track]) -> dict[int, int]:
        """Return the indices of ``tracks`` that enter an area, each with the lowest area's number."""
        import shapely

        found = self._entries([shapely.LineString(t) if len(t) > 1 else shapely.Point(t[0]) for t in tracks])
        return dict(sorted(found.T.tolist(), reverse=True))

    def between_ends(self, path: Track) -> int | None:
        """Return the number of an area that ``path`` enters and that holds neither of its ends, or None.

        A robot in an area must be able to leave it, and one sent into an area must be able to reach it.
        """
        import numpy as np
        import shapely

        through = self._entries([shapely.LineString(path)])[1]
        of_ends = self._entries([shapely.Point(path[0]), shapely.Point(path[-1])])[1]
        crossed = np.setdiff1d(through, of_ends)
        return int(crossed[0]) if len(crossed) else None

    def edges_through(self, network: Network) -> Ints:
        """Return the edges of ``network`` that enter an area, each once."""
        import numpy as np
        import shapely

        index = np.repeat(np.arange(len(network)), network.edges.counts())
        through: Ints = np.unique(self._entries(shapely.linestrings(network.edges.xy, indices=index))[0])
        return through.astype(np.int64)

    def _entries(self, geometries: Sequence[object]) -> Ints:
        """Return the indices of entering geometries, and those of the areas, (2, n)."""
        import numpy as np

        found = [self._tree.query(geometries, predicate=predicate) for predicate in ("crosses", "within")]
        entries: Ints = np.concatenate(found, axis=1)
        return entries


# --- Areas closed to robots, keepouts and obstacles, and queries for those nearby

if TYPE_CHECKING:
    from .geopackage import Area

Indices = NDArray[np.int64]

OVERHEAD_M = 2.5
"""Metres above the ground from which robots drive under an obstacle."""
TOUCH_M = 0.05
"""Metres within which a leg touches an area."""
_MOST_KEPT = 20_000
"""obstacles whose geometries are cached, the most recently approached ones."""


class FencedAreas(ABC):
    """Named areas; metres in the site frame."""

    @abstractmethod
    def __len__(self) -> int:
        """Return how many there are."""

    @abstractmethod
    def name(self, area: int) -> str:
        """Return the name of an area."""

    def id(self, area: int) -> int:
        """Return the id of an area, unique among its kind: its number."""
        return area

    def near(self, places: Points, metres: float) -> Indices:
        """Return which of ``places``, (n, 2), are within ``metres`` of which area: (2, m), place and area.

        0 metres means inside an area; the rim does not count as inside, as with the paths of commands.
        """
        import shapely

        return self._near(places, places, lambda rows: shapely.points(places[rows]), metres)

    def are_near(self, places: Points, pairs: Indices, metres: float) -> NDArray[np.bool_]:
        """Return a mask of ``pairs``, (2, m) of place and area, that :meth:`near` would return for
        ``metres``."""
        import shapely

        return _are_within(self._shapes(pairs[1]), shapely.points(places[pairs[0]]), metres)

    def near_legs(self, start: tuple[float, float], ends: Points, metres: float) -> Indices:
        """Return which straight legs, from ``start`` to each of ``ends``, (n, 2), come within ``metres`` of
        which area: (2, m), leg and area."""
        import shapely

        legs = np.empty((len(ends), 2, 2))
        legs[:, 0], legs[:, 1] = start, ends
        low, high = legs.min(axis=1), legs.max(axis=1)
        return self._near(low, high, lambda rows: shapely.linestrings(legs[rows]), metres)

    def are_between(self, start: tuple[float, float], goal: tuple[float, float], metres: float) -> bool:
        """Return whether the straight leg comes within ``metres`` of an area at neither end, or touches one.

        A robot may leave an area that it is at, and reach one that it is sent to.
        """
        places = np.array([start, goal])
        for apart in (metres, TOUCH_M):
            passed = self.near_legs(start, places[1:], apart)[1]
            if len(np.setdiff1d(passed, self.near(places, apart)[1])):
                return True
        return False

    def _near(
        self, low: Points, high: Points, geometries: Callable[[Indices], NDArray[Any]], metres: float
    ) -> Indices:
        """Return which geometries are within ``metres`` of which area; with 0 metres inside it.

        Their boxes are from ``low`` to ``high``, (n, 2) each. Most are near no area, and are never built:
        ``geometries`` builds those of the given rows.
        """
        query, area = self._boxes_between(low - metres, high + metres)
        if not len(query):
            return np.empty((2, 0), dtype=np.int64)
        rows, of_row = np.unique(query, return_inverse=True)
        queried, shapes = geometries(rows)[of_row], self._shapes(area)
        pairs: Indices = np.array([query, area], dtype=np.int64)[:, _are_within(shapes, queried, metres)]
        return pairs

    @abstractmethod
    def _boxes_between(self, low: Points, high: Points) -> tuple[Indices, Indices]:
        """Return which rectangles from ``low`` to ``high``, (n, 2) each, touch the box of which area."""

    @abstractmethod
    def _shapes(self, areas: Indices) -> NDArray[Any]:
        """Return the geometries of areas."""


class FencedPolygons(FencedAreas):
    """Some areas, with ``ids`` if their numbers could collide with others.

    :raises ImportError: if shapely is not installed.
    """

    def __init__(
        self, geometries: Sequence[Any], names: Sequence[str], ids: Sequence[int] | None = None
    ) -> None:
        import shapely

        self._names, self._ids = list(names), ids
        self._made = shapely.make_valid(np.array(geometries, dtype=object))
        shapely.prepare(self._made)
        boxes = shapely.bounds(self._made).reshape(-1, 4)
        self._boxes = boxes[:, :2], boxes[:, 2:]
        self._grid, self._order = BoxGrid.of(*self._boxes)

    @classmethod
    def of(cls, areas: Sequence[tuple[int, str, Points]]) -> FencedPolygons:
        """Return areas of which each is an id, a name, and a ring, (n, 2)."""
        import shapely

        rings = [shapely.Polygon(ring) for _, _, ring in areas]
        return cls(rings, [name for _, name, _ in areas], [id for id, _, _ in areas])

    def __len__(self) -> int:
        return len(self._names)

    def name(self, area: int) -> str:
        """Return the name of an area."""
        return self._names[area]

    def id(self, area: int) -> int:
        """Return the id of an area."""
        return area if self._ids is None else self._ids[area]

    def _boxes_between(self, low: Points, high: Points) -> tuple[Indices, Indices]:
        query, box = self._grid.pairs(low, high)
        return _touching(query, self._order[box], low, high, self._boxes)

    def _shapes(self, areas: Indices) -> NDArray[Any]:
        made: NDArray[Any] = self._made[areas]
        return made


@dataclass(frozen=True)
class FencedRows:
    """Which outlines are fenced, for :class:`FencedOutlines`: area k is rows ``first[k]`` to ``last[k]`` - 1.

    ``low`` and ``high``, (n, 2), are the corners of their boxes. They stand in the order of ``grid``.
    """

    first: NDArray[Any]
    last: NDArray[Any]
    low: NDArray[Any]
    high: NDArray[Any]
    grid: BoxGrid

    @classmethod
    def of(cls, outlines: Outlines) -> FencedRows:
        """Return the fenced ones of ``outlines``: :func:`fenced_boxes`."""
        groups, low, high = fenced_boxes(outlines)
        grid, order = BoxGrid.of(low, high)
        return cls(groups[order, 0], groups[order, 1], low[order], high[order], grid)


def fenced_boxes(outlines: Outlines) -> tuple[Indices, NDArray[Any], NDArray[Any]]:
    """Return the fenced ones of ``outlines``; ramps and overhead obstacles are excluded, as robots pass them.

    The first row of each area and the one behind its last, (n, 2), and the corners of its box, (n, 2) each.
    """
    groups = group_spans(outlines)
    ramp = outlines.shape_type[groups[:, 0]] == ShapeType.RAMP
    overhead = np.zeros(len(groups), dtype=bool)
    if outlines.base is not None:
        overhead = outlines.base[groups[:, 0]] >= OVERHEAD_M
    low, high, count = _boxes(outlines, groups[:, 0])
    fenced = ~ramp & ~overhead & (count >= 2)
    return groups[fenced], low[fenced], high[fenced]


class FencedOutlines(FencedAreas):
    """The obstacles of a site; geometries are built only of those near robots."""

    def __init__(self, outlines: Outlines, rows: FencedRows) -> None:
        self._outlines = outlines
        self._rows = rows
        self._kept: OrderedDict[int, Any] = OrderedDict()

    def __len__(self) -> int:
        return len(self._rows.first)

    def name(self, area: int) -> str:
        """Return the name of an area."""
        return _name(self._outlines, int(self._rows.first[area]))

    def _boxes_between(self, low: Points, high: Points) -> tuple[Indices, Indices]:
        query, area = self._rows.grid.pairs(low, high)
        return _touching(query, area, low, high, (self._rows.low, self._rows.high))

    def _shapes(self, areas: Indices) -> NDArray[Any]:
        some, which = np.unique(areas, return_inverse=True)
        made: NDArray[Any] = np.array([self._geometry(one) for one in some.tolist()], dtype=object)[which]
        return made

    def _geometry(self, area: int) -> Any:
        import shapely

        known = self._kept.get(area)
        if known is None:
            first, last = int(self._rows.first[area]), int(self._rows.last[area])
            known = shapely.make_valid(_geometry(self._outlines, first, last))
            shapely.prepare(known)
            self._kept[area] = known
            if len(self._kept) > _MOST_KEPT:
                self._kept.popitem(last=False)
        return known


@dataclass(frozen=True)
class Fences:
    """The keepouts and the obstacles of one publication, and ``observed`` ones, which operators accepted.

    The ids of observed ones differ from those of the publication's obstacles.
    """

    keepouts: FencedAreas
    obstacles: FencedAreas
    observed: FencedAreas = field(default_factory=lambda: FencedPolygons([], []))

    @classmethod
    def of(cls, keepouts: Iterable[Area], outlines: Outlines, rows: FencedRows | None = None) -> Fences:
        """Return the fences of a site; ``rows`` are those of ``outlines`` if they are known."""
        import shapely

        areas = list(keepouts)
        polygons = [shapely.Polygon(outer, holes) for outer, *holes in (area.rings for area in areas)]
        obstacles = FencedOutlines(outlines, FencedRows.of(outlines) if rows is None else rows)
        return cls(FencedPolygons(polygons, [area.label for area in areas]), obstacles)


def _are_within(areas: NDArray[Any], geometries: NDArray[Any], metres: float) -> NDArray[np.bool_]:
    """Return which geometries are within ``metres`` of their area, (n,) bool; with 0 metres inside it."""
    import shapely

    found: NDArray[np.bool_] = (
        shapely.dwithin(areas, geometries, metres) if metres > 0 else shapely.contains(areas, geometries)
    )
    return found


def _touching(
    query: Indices, area: Indices, low: Points, high: Points, boxes: tuple[NDArray[Any], NDArray[Any]]
) -> tuple[Indices, Indices]:
    """Return those pairs of a rectangle from ``low`` to ``high`` and a box that touch."""
    touches = ((boxes[1][area] >= low[query]) & (boxes[0][area] <= high[query])).all(axis=1)
    return query[touches], area[touches]


def _boxes(outlines: Outlines, rows: NDArray[Any]) -> tuple[NDArray[Any], NDArray[Any], NDArray[Any]]:
    """Return the corners of the boxes of ``rows``, (n, 2) each, and how many finite points each has."""
    points, lengths = outlines.coordinates, np.diff(outlines.offsets)
    finite = np.isfinite(points).all(axis=1)
    count = lengths
    if not finite.all():
        of = np.repeat(np.arange(len(outlines)), lengths)
        points, count = points[finite], np.bincount(of[finite], minlength=len(outlines))
    low, high = np.full((len(outlines), 2), np.inf), np.full((len(outlines), 2), -np.inf)
    some = np.flatnonzero(count)
    if len(some):
        starts = np.concatenate([[0], np.cumsum(count[some])[:-1]])
        low[some] = np.minimum.reduceat(points, starts)
        high[some] = np.maximum.reduceat(points, starts)
    return low[rows], high[rows], count[rows]


def _name(outlines: Outlines, k: int) -> str:
    """Return the name after the kind in ``building,Control tower``, else the whole label."""
    kind, _, name = outlines.semantics[k].partition(",")
    return name or kind or outlines.source[k] or f"obstacle {k + 1}"


def _geometry(outlines: Outlines, first: int, last: int) -> Any:
    """Return a group of outlines, whose first has two finite points or more, as one geometry."""
    import shapely

    points = outlines.points(first)
    points = points[np.isfinite(points).all(axis=1)]
    if is_closed(outlines.shape_type[first : first + 1])[0] and len(points) > 3:
        holes = [ring for ring in map(outlines.points, range(first + 1, last)) if len(ring) > 3]
        return shapely.Polygon(points, holes)
    if outlines.shape_type[first] == ShapeType.STAIRS and len(points) % 2 == 0:
        # The whole area between the first and the last riser is steps.
        return shapely.MultiLineString(list(points.reshape(-1, 2, 2))).convex_hull
    return shapely.LineString(points)
