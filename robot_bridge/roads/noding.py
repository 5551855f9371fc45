"""Roads split where they meet.

Roads of one level meet where they cross or touch. Roads of different levels meet only where one of them
ends in a point that the other has too, as the end of a bridge does: over and under one another they pass.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .asking import Ask, go_on
from .box_pairs import boxes_of, touching
from .centrelines import Centrelines, Floats, Ints, ranges
from .points import flags, foot_on, same_points

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


def noded(roads: Centrelines, ask: Ask = go_on) -> Centrelines:
    """Return ``roads`` as pieces that meet at their ends only; ends that are one have one coordinate.

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
    # One pass leaves nothing: what stands within SAME of a point that goes is near the one before, too.
    keep = np.ones(len(roads.xy), bool)
    keep[1:] = (owner[1:] != owner[:-1]) | (np.hypot(*np.diff(roads.xy, axis=0).T) > SAME)
    counts = np.bincount(owner[keep], minlength=len(roads))
    lasting = counts > 1
    keep &= lasting[owner]
    first = np.concatenate([[0], np.cumsum(counts[lasting])])
    return roads.with_lines(roads.xy[keep], first, np.flatnonzero(lasting))


def _meetings(roads: Centrelines, ask: Ask) -> tuple[Floats, Floats]:
    """Return where roads meet or end: the place of each, a vertex's index plus a share, and its point."""
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
    # Nearer to an end than SAME it is a touch, which is found as such.
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
    """Tell which points along the roads stay: no vertex where a meeting is, no meeting twice."""
    again = np.zeros(len(at), bool)
    again[1:] = (road[1:] == road[:-1]) & (
        (at[1:] == at[:-1]) | ((label[1:] >= 0) & (label[1:] == label[:-1]))
    )
    kept = np.flatnonzero(~again)
    # A vertex that stands a hair from a meeting would make a piece without direction.
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
