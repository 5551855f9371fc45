"""Surfaces generated from centrelines and widths: strips, joined at corners, dissolved by class."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from ..errors import RoadsCancelledError, RoadsError, installation
from .network import GENERATED, Centrelines, Floats, Ints, Surface, same_points

# --- Roads as strips of their widths ---

MITRE_LIMIT = 2.0
"""A corner reaches no further from its centre than twice half the width; a sharper one is cut off."""


def strips_of(roads: Centrelines, numbers: Ints) -> Any:
    """Return the polygon of each of the roads ``numbers``, an array of shapely's."""
    import shapely

    taken = roads.taken(numbers)
    if not len(taken):
        return np.empty(0, dtype=object)
    lines = shapely.linestrings(taken.xy, indices=np.repeat(np.arange(len(taken)), taken.counts()))
    return widened(lines, taken.width)


def widened(lines: Any, width: Floats) -> Any:
    """Return ``lines``, an array of shapely's, as strips with square ends and mitred corners."""
    import shapely

    return shapely.buffer(lines, width / 2, cap_style="flat", join_style="mitre", mitre_limit=MITRE_LIMIT)


# --- Gaps between strips that end in one point at an angle: the wedge on the outer side ---

MEETING_M = 0.001
"""Ends this near to one another are one point, as in the network."""

_SHARPEST = np.cos(np.radians(100.0))
"""Roads at a sharper turn do not continue each other, and their strips overlap anyway."""

_LONGEST_STUB = 1.0
"""Length at a road's end that is considered, in widths of the road."""


def wedges(roads: Centrelines, rank: Sequence[int]) -> tuple[Any, Ints]:
    """Return polygons that fill the corners between roads that end in one point, and the road of each.

    The road is the one whose class has the lower ``rank``, and its class is that of the wedge, which does not
    cover roads of other classes there. The corner is as wide as the narrower of the two.
    """
    import shapely

    road, node, away = _ends(roads)
    one, other = _pairs(node)
    lengths = np.hypot(*away.T)
    turn = -(away[one] * away[other]).sum(axis=1) / np.maximum(lengths[one] * lengths[other], 1e-12)
    leads_on = (turn > _SHARPEST) & (turn < 1 - 1e-9)
    one, other = one[leads_on], other[leads_on]
    width = np.minimum(roads.width[road[one]], roads.width[road[other]])
    at = _points_of(roads)[one]
    corners = np.stack([at + away[one], at, at + away[other]], axis=1)
    lines = shapely.linestrings(corners) if len(corners) else np.empty(0, dtype=object)
    made = widened(lines, width)
    ranks = np.asarray(rank, np.int64)
    first = ranks[road[one]] <= ranks[road[other]]
    winner = np.where(first, road[one], road[other])
    mixed = roads.surface[road[one]] != roads.surface[road[other]]
    for k in np.flatnonzero(mixed).tolist():
        meeting = np.unique(road[node == node[one[k]]])
        others = meeting[roads.surface[meeting] != roads.surface[winner[k]]]
        made[k] = shapely.difference(made[k], shapely.union_all(strips_of(roads, others)))
    return made, winner


def _points_of(roads: Centrelines) -> Floats:
    return np.concatenate([roads.xy[roads.first[:-1]], roads.xy[roads.first[1:] - 1]])


def _ends(roads: Centrelines) -> tuple[Ints, Ints, Floats]:
    """Return, for the beginning and the end of each road, its index, its node, and a step along the road."""
    count = len(roads)
    points = _points_of(roads)
    inner = np.concatenate([roads.xy[roads.first[:-1] + 1], roads.xy[roads.first[1:] - 2]])
    road = np.tile(np.arange(count), 2)
    step = inner - points
    length = np.maximum(np.hypot(*step.T), 1e-12)
    shorter = np.minimum(1.0, _LONGEST_STUB * roads.width[road] / length)
    return road, same_points(points, MEETING_M), step * shorter[:, None]


def _pairs(node: Ints) -> tuple[Ints, Ints]:
    """Return all pairs of ends that share a node."""
    order = np.argsort(node, kind="stable")
    _, begin, count = np.unique(node[order], return_index=True, return_counts=True)
    pairs = [
        (order[first + i], order[first + j])
        for first, size in zip(begin.tolist(), count.tolist(), strict=True)
        for i in range(size)
        for j in range(i + 1, size)
    ]
    one, other = np.array(pairs, np.int64).reshape(-1, 2).T
    return one, other


# --- Surfaces from centrelines and widths, dissolved by class, without overlaps ---

PRECEDENCE = ("slippery", "asphalt", "parking pavement")
"""Precedence of classes on overlapping ground: a slippery surface must never count as one with grip."""

SMALLEST_M2, SMALLEST_HOLE_M2 = 0.01, 1.0
"""Smaller pieces and holes are leftovers between almost identical outlines."""

_AT_ONCE = 2000
"""Strips joined at a time; cancelling is checked between them."""

Progress = Callable[[float], bool]
"""Receives the finished share of the work, 0 to 1; returns whether to continue."""


def generate_surfaces(
    roads: Centrelines,
    drawn: Sequence[Surface] = (),
    precedence: Sequence[str] = PRECEDENCE,
    progress: Progress = lambda share: True,
) -> list[Surface]:
    """Return the surfaces of ``roads``, a piece of ground in one of them only, and in none of ``drawn``.

    Roads are strips of their widths, ended square, with mitred corners, within a road and where roads end in
    one point. Strips of one class become one surface. Where classes meet, the one that comes first in
    ``precedence`` keeps the ground; classes not in it come after, the one with less ground first.

    :raises CancelledError: when ``progress`` returns false.
    :raises RoadsError: if shapely is not installed.
    """
    shapely = _shapely()
    names = sorted(set(roads.surface.tolist()))
    steps = _Steps(len(roads) + 2 * len(names) + 1, progress)
    corners, of_corner = wedges(roads, [_place(name, precedence) for name in roads.surface.tolist()])
    wholes: dict[str, Any] = {}
    for name in names:
        own = np.flatnonzero(roads.surface == name)
        strips = np.concatenate([strips_of(roads, own), corners[np.isin(of_corner, own)]])
        wholes[name] = _without_slits(_joined(strips, steps, len(own)))
    taken = shapely.union_all([polygon_of(one.rings) for one in drawn]) if drawn else shapely.Polygon()
    steps.done(1)
    made: list[Surface] = []
    for name in _order(wholes, precedence):
        free = shapely.difference(wholes[name], taken)
        steps.done(1)
        made += [Surface(rings_of(part), name, origin=GENERATED) for part in _polygons(free)]
        taken = shapely.union(taken, wholes[name])
        steps.done(1)
    return made


def polygon_of(rings: Sequence[Any]) -> Any:
    """Return the valid shapely geometry of ``rings``, the outer one first."""
    shapely = _shapely()
    outer, *holes = rings
    return shapely.make_valid(shapely.Polygon(outer, holes))


def rings_of(polygon: Any) -> tuple[Any, ...]:
    """Return the rings of a shapely polygon, the outer one first, (n, 2) each."""
    shapely = _shapely()
    # Not by coords: inside QGIS, which has another GEOS, shapely 2.2 sometimes fails there.
    return tuple(shapely.get_coordinates(ring) for ring in shapely.get_rings(polygon))


class _Steps:
    def __init__(self, total: int, progress: Progress) -> None:
        self._total, self._progress, self._count = total, progress, 0

    def done(self, count: int) -> None:
        self._count += count
        if not self._progress(self._count / self._total):
            raise RoadsCancelledError("Making road surfaces was cancelled; nothing was written.")


def _joined(strips: Any, steps: _Steps, roads: int) -> Any:
    """Return the union of ``strips``, neighbours first; counts ``roads`` steps."""
    shapely = _shapely()
    strips = strips[~shapely.is_empty(strips)]
    strips = strips[np.argsort(shapely.get_x(shapely.centroid(strips)))]
    parts = []
    for begin in range(0, len(strips), _AT_ONCE):
        parts.append(shapely.union_all(strips[begin : begin + _AT_ONCE]))
        steps.done(0)
    whole = shapely.union_all(parts)
    steps.done(roads)
    return whole


def _without_slits(whole: Any) -> Any:
    shapely = _shapely()
    rings = shapely.get_rings(whole)
    slits = shapely.polygons(rings[shapely.area(shapely.polygons(rings)) < SMALLEST_HOLE_M2])
    return shapely.union_all([whole, *slits]) if len(slits) else whole


def _place(name: str, precedence: Sequence[str]) -> int:
    known = [_plain(one) for one in precedence]
    return known.index(_plain(name)) if _plain(name) in known else len(known)


def _plain(name: str) -> str:
    """Return the name of a class in normal form: ``Parking_pavement`` is ``parking pavement``."""
    return " ".join(name.replace("_", " ").split()).lower()


def _order(wholes: dict[str, Any], precedence: Sequence[str]) -> list[str]:
    # Ground of unknown class ranks below any class.
    return sorted(
        wholes, key=lambda name: (name == "", _place(name, precedence), _shapely().area(wholes[name]), name)
    )


def _polygons(geometry: Any) -> list[Any]:
    shapely = _shapely()
    parts = shapely.get_parts(geometry)
    polygons = parts[(shapely.get_type_id(parts) == 3) & (shapely.area(parts) >= SMALLEST_M2)]
    return list(polygons)


def _shapely() -> Any:
    try:
        import shapely
    except ImportError as error:
        raise RoadsError(
            "The Python package shapely 2 is missing, which makes surfaces of centrelines: install it "
            f"{installation('shapely')}."
        ) from error
    return shapely
