"""Road network: centrelines as columns, and edges between nodes, split where they meet."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, fields, replace
from functools import cached_property
from typing import Any, Final, Literal, TypeVar

import numpy as np
from numpy.typing import NDArray

from ..errors import RoadInputError

# --- Centrelines of roads as columns: the input of the network ---

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

BOTH, FORWARD, BACKWARD = 0, 1, -1
"""Directions in which a road may be driven, as seen along its digitised line."""

DEFAULT_SPEED = 1.0
"""m/s on a road of unknown speed."""


@dataclass(frozen=True)
class Centrelines:
    """``m`` lines with attributes, metres in the site frame.

    Line ``k`` is ``xy[first[k]:first[k + 1]]``; ``xy`` is (n, 2), ``first`` (m + 1,). ``width`` is in metres,
    ``speed`` in m/s, ``direction`` one of BOTH, FORWARD and BACKWARD, ``level`` 0 on the ground, above it on
    bridges and below it in tunnels. ``source`` is the index of the road that each line is a piece of.
    """

    xy: Floats
    first: Ints
    width: Floats
    surface: NDArray[np.object_]
    direction: NDArray[np.int8]
    speed: Floats
    closed: NDArray[np.bool_]
    level: Ints
    source: Ints

    def __len__(self) -> int:
        return len(self.first) - 1

    def line(self, k: int) -> Floats:
        """Return the points of line ``k``, (n, 2)."""
        return self.xy[self.first[k] : self.first[k + 1]]

    def counts(self) -> Ints:
        """Return how many points each line has, (m,)."""
        return np.diff(self.first)

    def lengths(self) -> Floats:
        """Return the metres of each line, (m,)."""
        along = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(self.xy, axis=0).T))])
        lengths: Floats = along[self.first[1:] - 1] - along[self.first[:-1]]
        return lengths

    def taken(self, keep: NDArray[Any]) -> Centrelines:
        """Return the lines with the indices ``keep``, in that order."""
        counts = self.counts()[keep]
        first = np.concatenate([[0], np.cumsum(counts)])
        points = ranges(self.first[:-1][keep], counts)
        return self.with_lines(self.xy[points], first, keep)

    def with_lines(self, xy: Floats, first: Ints, of: NDArray[Any]) -> Centrelines:
        """Return other lines; line ``k`` has the attributes that line ``of[k]`` has here."""
        columns = {name: getattr(self, name)[of] for name in _ATTRIBUTES}
        return replace(self, xy=xy, first=first, **columns)


_ATTRIBUTES = tuple(field.name for field in fields(Centrelines) if field.name not in ("xy", "first"))


def centrelines(
    lines: Sequence[Any],
    width: Any = 3.5,
    surface: Any = "",
    direction: Any = BOTH,
    speed: Any = DEFAULT_SPEED,
    closed: Any = False,
    level: Any = 0,
) -> Centrelines:
    """Return ``lines``, each (n, 2) with n ≥ 2, as columns; an attribute is one value or one for each line.

    :raises RoadInputError: naming the first invalid road.
    """
    arrays = [np.asarray(line, dtype=np.float64) for line in lines]
    for k, line in enumerate(arrays):
        if line.ndim != 2 or line.shape[1] != 2 or len(line) < 2:
            raise RoadInputError(f"Road {k} has the shape {line.shape}: give two points (x, y) or more.")
    count = len(arrays)
    made = Centrelines(
        xy=np.concatenate(arrays) if arrays else np.empty((0, 2)),
        first=np.concatenate([[0], np.cumsum([len(line) for line in arrays])]).astype(np.int64),
        width=_column(width, count, np.float64),
        surface=_column(surface, count, np.object_),
        direction=_column(direction, count, np.int8),
        speed=_column(speed, count, np.float64),
        closed=_column(closed, count, np.bool_),
        level=_column(level, count, np.int64),
        source=np.arange(count),
    )
    _check(made)
    return made


def ranges(start: Ints, count: Ints) -> Ints:
    """Return start[0], start[0] + 1, ... (count[0] of them), start[1], ... in one array."""
    total = int(count.sum())
    ends = np.cumsum(count)
    numbers: Ints = np.arange(total) + np.repeat(start - (ends - count), count)
    return numbers


def _column(value: Any, count: int, kind: Any) -> NDArray[Any]:
    column = np.asarray(value, dtype=kind)
    return np.full(count, value, dtype=kind) if column.ndim == 0 else column.reshape(count)


def _check(roads: Centrelines) -> None:
    finite = np.isfinite(roads.xy).all(axis=1)
    if not finite.all():
        k = int(np.searchsorted(roads.first, int(np.argmin(finite)), side="right")) - 1
        raise RoadInputError(f"Road {k} has a coordinate that is no number: correct it or leave it out.")
    for name in ("width", "speed"):
        values = getattr(roads, name)
        good = np.isfinite(values) & (values > 0)
        if not good.all():
            k = int(np.argmin(good))
            raise RoadInputError(f"The {name} of road {k} is {values[k]:g}: give a number above 0.")
    if not np.isin(roads.direction, (BOTH, FORWARD, BACKWARD)).all():
        k = int(np.argmin(np.isin(roads.direction, (BOTH, FORWARD, BACKWARD))))
        raise RoadInputError(f"The direction of road {k} is {roads.direction[k]}: give 0, 1 or -1.")


# --- One piece of ground to drive on ---

Origin = Literal["drawn", "generated"]
"""Origin of a surface: drawn by hand, or generated from the widths of centrelines."""

DRAWN: Final = "drawn"
GENERATED: Final = "generated"


@dataclass(frozen=True)
class Surface:
    """One polygon of a class such as ``asphalt``, its ``label``.

    ``rings`` holds the outer ring and then its holes, each (n, 2), metres in the site frame, closed.
    ``origin`` is DRAWN or GENERATED.
    """

    rings: tuple[Floats, ...]
    label: str
    name: str = ""
    origin: Origin = DRAWN


# --- Cancelling long work ---

CancelCheck = Callable[[], None]
"""Called between the steps of long work; an exception from it ends the work, with nothing changed."""


def never_cancel() -> None:
    """Never cancel the work."""


# --- Which boxes may touch: a grid in plain numpy, so that a stock QGIS needs no spatial library ---

_Numbers = TypeVar("_Numbers", int, Ints)

_CELLS_FOR_EACH_BOX = 8.0
"""Most cells of a box on average: more cells cost memory, fewer cost comparisons."""


def boxes_of(a: Floats, b: Floats, margin: float) -> Floats:
    """Return the boxes x_min, y_min, x_max, y_max, (n, 4), of segments from ``a`` to ``b``, both (n, 2)."""
    return np.hstack([np.minimum(a, b) - margin, np.maximum(a, b) + margin])


def touching(one: Floats, other: Floats) -> tuple[Ints, Ints]:
    """Return the indices (i, j) of all boxes of ``one`` and ``other``, (n, 4) and (m, 4), that touch."""
    if not len(one) or not len(other):
        return np.empty(0, np.int64), np.empty(0, np.int64)
    both = np.concatenate([one, other])
    cell = cell_size(both)
    low = both[:, :2].min(axis=0)
    of_one, cell_one = cells_of(one, low, cell)
    of_other, cell_other = cells_of(other, low, cell)
    order = np.argsort(cell_other, kind="stable")
    of_other, cell_other = of_other[order], cell_other[order]
    begin = np.searchsorted(cell_other, cell_one, side="left")
    count = np.searchsorted(cell_other, cell_one, side="right") - begin
    i, j = np.repeat(of_one, count), of_other[ranges(begin, count)]
    touch = (one[i, :2] <= other[j, 2:]).all(axis=1) & (other[j, :2] <= one[i, 2:]).all(axis=1)
    pairs = np.unique(i[touch] * len(other) + j[touch])
    return pairs // len(other), pairs % len(other)


def cell_size(boxes: Floats) -> float:
    """Return the side of cells of which ``boxes`` cover few on average."""
    sides = boxes[:, 2:] - boxes[:, :2]
    cell = max(float(np.median(sides.max(axis=1))), 1e-3)
    while np.prod(np.floor(sides / cell) + 2.0, axis=1).mean() > _CELLS_FOR_EACH_BOX:
        cell *= 1.5
    return cell


def cells_of(boxes: Floats, low: Floats, cell: float) -> tuple[Ints, Ints]:
    """Return, for each cell that a box covers, the index of the box and the cell's number."""
    begin = np.floor((boxes[:, :2] - low) / cell).astype(np.int64)
    size = np.floor((boxes[:, 2:] - low) / cell).astype(np.int64) - begin + 1
    count = size.prod(axis=1)
    box = np.repeat(np.arange(len(boxes)), count)
    number = ranges(np.zeros(len(boxes), np.int64), count)
    wide = size[box, 0]
    return box, cell_number(begin[box, 0] + number % wide, begin[box, 1] + number // wide)


def cell_number(column: _Numbers, row: _Numbers) -> _Numbers:
    """Return one number for a column and a row of the grid."""
    return (row << 31) + column


# --- Coincident points and connected parts ---


def same_points(points: Floats, within: float) -> Ints:
    """Return a label for each of ``points``, (n, 2): those ``within`` metres of one another share one.

    The label is the index of the first point of the group.
    """
    exact, group = np.unique(points, axis=0, return_inverse=True)
    first = np.full(len(exact), len(points), np.int64)
    np.minimum.at(first, group, np.arange(len(points)))
    boxes = boxes_of(exact, exact, within / 2)
    i, j = touching(boxes, boxes)
    near = (i < j) & (np.hypot(*(exact[i] - exact[j]).T) <= within)
    parts = connected(len(exact), i[near], j[near])
    least = np.full(len(exact), len(points), np.int64)
    np.minimum.at(least, parts, first)
    labels: Ints = least[parts][group]
    return labels


def connected(count: int, a: Ints, b: Ints) -> Ints:
    """Return, for each of ``count`` things, the least index of its part; a[k] and b[k] are connected."""
    label = np.arange(count)
    while True:
        least = np.minimum(label[a], label[b])
        before = label.copy()
        np.minimum.at(label, label[a], least)
        np.minimum.at(label, label[b], least)
        while not np.array_equal(label, label[label]):
            label = label[label]
        if np.array_equal(label, before):
            return label


def foot_on(a: Floats, b: Floats, p: Floats) -> tuple[Floats, Floats]:
    """Return the places on the segments from ``a`` to ``b`` nearest to ``p``, all (n, 2).

    The first array holds shares of the segments, 0 to 1, the second metres from ``p``; both (n,).
    """
    step = b - a
    square = np.maximum((step * step).sum(axis=1), 1e-18)
    share: Floats = np.minimum(np.maximum(((p - a) * step).sum(axis=1) / square, 0.0), 1.0)
    away: Floats = np.hypot(*(a + share[:, None] * step - p).T)
    return share, away


def flags(count: int, indices: Ints) -> NDArray[np.bool_]:
    """Return (count,) flags that are true at ``indices``."""
    marks = np.zeros(count, bool)
    marks[indices] = True
    return marks


# --- Roads split where they meet ---
# Roads of one level meet where they cross or touch. Roads of different levels meet only where one of them
# ends in a point that the other has too, as the end of a bridge does: otherwise they pass over and under one
# another.

SAME = 1e-3
"""Metres within which two points are one."""


@dataclass(frozen=True)
class _Segments:
    """The straight pieces of all roads; ``at`` is the index of the vertex where each begins."""

    at: Ints
    road: Ints
    a: Floats
    b: Floats

    @classmethod
    def of(cls, roads: Centrelines) -> _Segments:
        at = ranges(roads.first[:-1], roads.counts() - 1)
        road = np.repeat(np.arange(len(roads)), roads.counts() - 1)
        return cls(at, road, roads.xy[at], roads.xy[at + 1])


def noded(roads: Centrelines, ask: CancelCheck = never_cancel) -> Centrelines:
    """Return ``roads`` as pieces that meet only at their ends; coincident ends get equal coordinates.

    Points that repeat the one before are left out, and so are roads without length. ``ask`` may raise.
    """
    roads = _without_repeats(roads)
    if not len(roads):
        return roads
    place, xy = _meetings(roads, ask)
    ask()
    return _split(roads, place, xy)


def _without_repeats(roads: Centrelines) -> Centrelines:
    owner = np.repeat(np.arange(len(roads)), roads.counts())
    # One pass is enough: a point within SAME of a removed point is also near the one before it.
    keep = np.ones(len(roads.xy), bool)
    keep[1:] = (owner[1:] != owner[:-1]) | (np.hypot(*np.diff(roads.xy, axis=0).T) > SAME)
    counts = np.bincount(owner[keep], minlength=len(roads))
    lasting = counts > 1
    keep &= lasting[owner]
    first = np.concatenate([[0], np.cumsum(counts[lasting])])
    return roads.with_lines(roads.xy[keep], first, np.flatnonzero(lasting))


def _meetings(roads: Centrelines, ask: CancelCheck) -> tuple[Floats, Floats]:
    """Return where roads meet or end: the position of each, a vertex's index plus a share, and its point."""
    segments = _Segments.of(roads)
    boxes = boxes_of(segments.a, segments.b, SAME)
    i, j = touching(boxes, boxes)
    ask()
    apart = (segments.road[i] != segments.road[j]) | (segments.at[j] - segments.at[i] > 1)
    i, j = i[(i < j) & apart], j[(i < j) & apart]
    level = roads.level[segments.road]
    same_level = level[i] == level[j]
    found = [_crossings(segments, i[same_level], j[same_level])]
    ends = flags(len(roads.xy), np.concatenate([roads.first[:-1], roads.first[1:] - 1]))
    for one, other in ((i, j), (j, i)):
        for last in (0, 1):
            ask()
            found += _touches(segments, one, other, last, same_level, ends)
    own = np.flatnonzero(ends)
    found.append((own.astype(float), roads.xy[own]))
    return np.concatenate([place for place, _ in found]), np.concatenate([xy for _, xy in found])


def _crossings(segments: _Segments, i: Ints, j: Ints) -> tuple[Floats, Floats]:
    """Return the places, on both, where segments ``i`` and ``j`` cross well inside each other."""
    p, r = segments.a[i], segments.b[i] - segments.a[i]
    q, s = segments.a[j], segments.b[j] - segments.a[j]
    turn = r[:, 0] * s[:, 1] - r[:, 1] * s[:, 0]
    slanted = np.abs(turn) > 1e-12 * np.maximum(np.hypot(*r.T) * np.hypot(*s.T), 1e-12)
    safe = np.where(slanted, turn, 1.0)
    w = q - p
    t = (w[:, 0] * s[:, 1] - w[:, 1] * s[:, 0]) / safe
    u = (w[:, 0] * r[:, 1] - w[:, 1] * r[:, 0]) / safe
    # Nearer to an end than SAME it is a touch, which is found separately.
    t_min, u_min = (SAME / np.maximum(np.hypot(*v.T), SAME) for v in (r, s))
    hit = slanted & (t > t_min) & (t < 1 - t_min) & (u > u_min) & (u < 1 - u_min)
    xy = p[hit] + t[hit, None] * r[hit]
    place = np.concatenate([segments.at[i[hit]] + t[hit], segments.at[j[hit]] + u[hit]])
    return place, np.concatenate([xy, xy])


def _touches(
    segments: _Segments,
    one: Ints,
    other: Ints,
    last: int,
    same_level: NDArray[np.bool_],
    ends: NDArray[np.bool_],
) -> list[tuple[Floats, Floats]]:
    """Return the places, on both, where the first or ``last`` point of ``one`` lies on ``other``."""
    point = segments.b[one] if last else segments.a[one]
    share, away = foot_on(segments.a[other], segments.b[other], point)
    length = np.hypot(*(segments.b[other] - segments.a[other]).T)
    share = np.where(share * length <= SAME, 0.0, np.where((1 - share) * length <= SAME, 1.0, share))
    vertex, place = segments.at[one] + last, segments.at[other] + share
    on_vertex = (share == 0.0) | (share == 1.0)
    either_ends = ends[vertex] | (on_vertex & ends[place.astype(np.int64)])
    hit = (away <= SAME) & (same_level | (on_vertex & either_ends))
    return [(vertex[hit].astype(float), point[hit]), (place[hit], point[hit])]


def _split(roads: Centrelines, place: Floats, xy: Floats) -> Centrelines:
    """Return the pieces of ``roads`` between the places."""
    label = same_points(xy, SAME)
    vertices = np.arange(len(roads.xy), dtype=float)
    at = np.concatenate([place, vertices])
    label_at = np.concatenate([label, np.full(len(vertices), -1)])
    points = np.concatenate([xy[label], roads.xy])
    order = np.lexsort([label_at < 0, at])
    at, label_at, points = at[order], label_at[order], points[order]
    road = np.searchsorted(roads.first, np.floor(at).astype(np.int64), side="right") - 1
    keep = _lasting(at, label_at, points, road)
    return _pieces(roads, label_at[keep], points[keep], road[keep])


def _lasting(at: Floats, label: Ints, points: Floats, road: Ints) -> NDArray[np.bool_]:
    """Return which points along the roads stay: no vertex at a meeting point, no meeting point twice."""
    again = np.zeros(len(at), bool)
    again[1:] = (road[1:] == road[:-1]) & (
        (at[1:] == at[:-1]) | ((label[1:] >= 0) & (label[1:] == label[:-1]))
    )
    kept = np.flatnonzero(~again)
    # A vertex very near to a meeting point would make a piece without direction.
    near = np.hypot(*np.diff(points[kept], axis=0).T) <= SAME
    near &= road[kept][1:] == road[kept][:-1]
    bare = label[kept] < 0
    drop = np.zeros(len(kept), bool)
    drop[1:] |= near & bare[1:]
    drop[:-1] |= near & bare[:-1]
    return flags(len(at), kept[~drop])


def _pieces(roads: Centrelines, label: Ints, points: Floats, road: Ints) -> Centrelines:
    cut = np.flatnonzero(label >= 0)
    begin, end = cut[:-1], cut[1:]
    inside = (road[begin] == road[end]) & ((end - begin > 1) | (label[begin] != label[end]))
    begin, end = begin[inside], end[inside]
    count = end - begin + 1
    first = np.concatenate([[0], np.cumsum(count)])
    return roads.with_lines(points[ranges(begin, count)], first, road[begin])


# --- The road network: edges between nodes ---


@dataclass(frozen=True)
class Network:
    """``n`` nodes, (n, 2) metres in the site frame, and the edges between them.

    Edge ``k`` is line ``k`` of ``edges``, from node ``tail[k]`` to node ``head[k]``; its ``source`` is the
    index of the road that it is a piece of.
    """

    nodes: Floats
    edges: Centrelines
    tail: Ints
    head: Ints

    def __len__(self) -> int:
        return len(self.tail)

    @cached_property
    def lengths(self) -> Floats:
        """Metres of each edge."""
        return self.edges.lengths()

    @cached_property
    def degrees(self) -> Ints:
        """How many ends of edges each node has."""
        return np.bincount(np.concatenate([self.tail, self.head]), minlength=len(self.nodes))

    @cached_property
    def parts(self) -> Ints:
        """The part that each node belongs to, as the least index of its nodes, whatever the directions."""
        return connected(len(self.nodes), self.tail, self.head)

    def arcs(self) -> tuple[Ints, Ints, Ints]:
        """Return the drivable arcs: edge, from node, to node; first along the edges, then against them."""
        there = np.flatnonzero(self.edges.direction != BACKWARD)
        back = np.flatnonzero(self.edges.direction != FORWARD)
        return (
            np.concatenate([there, back]),
            np.concatenate([self.tail[there], self.head[back]]),
            np.concatenate([self.head[there], self.tail[back]]),
        )


def network_of(pieces: Centrelines) -> Network:
    """Return the network of ``pieces`` that meet at their ends, as :func:`noded` returns them."""
    ends = np.concatenate([pieces.xy[pieces.first[:-1]], pieces.xy[pieces.first[1:] - 1]])
    nodes, index = np.unique(ends, axis=0, return_inverse=True)
    index = index.reshape(-1).astype(np.int64)
    return Network(nodes.reshape(-1, 2), pieces, index[: len(pieces)], index[len(pieces) :])


def build_network(roads: Centrelines, ask: CancelCheck = never_cancel) -> Network:
    """Return the network of ``roads``, split where they meet, without repairs.

    An exception of ``ask`` between two steps ends the work.
    """
    return network_of(noded(roads, ask))
