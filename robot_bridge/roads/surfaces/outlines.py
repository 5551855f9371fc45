"""The edges of surfaces as columns."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ..centrelines import Floats, Ints
from ..errors import RoadInputError
from .surface import Surface


@dataclass(frozen=True)
class Edges:
    """Edge ``k`` runs from ``a[k]`` to ``b[k]``, both (n, 2), in ring ``ring[k]`` of surface ``owner[k]``.

    Rings are counted through all surfaces; the first of each is its outer one.
    """

    a: Floats
    b: Floats
    owner: Ints
    ring: Ints

    def __len__(self) -> int:
        return len(self.owner)


def edges_of(surfaces: Sequence[Surface]) -> Edges:
    """Return the edges of every ring; one that is not closed is closed.

    :raises RoadInputError: naming the first surface with a coordinate that is no number.
    """
    rings = [np.asarray(ring, np.float64).reshape(-1, 2) for one in surfaces for ring in one.rings]
    owner = np.repeat(np.arange(len(surfaces)), [len(one.rings) for one in surfaces])
    kept = [k for k, ring in enumerate(rings) if len(ring)]
    rings, owner = [rings[k] for k in kept], owner[kept]
    if not rings:
        nothing = np.empty((0, 2))
        none = np.empty(0, np.int64)
        return Edges(nothing, nothing, none, none)
    counts = np.array([len(ring) for ring in rings])
    points = np.concatenate(rings)
    of_point = np.repeat(owner, counts)
    finite = np.isfinite(points).all(axis=1)
    if not finite.all():
        k = int(of_point[np.argmin(finite)])
        raise RoadInputError(
            f"Surface {k} ({surfaces[k].label or 'without a class'}) has a coordinate that is no number: "
            "correct it or leave it out."
        )
    last = np.cumsum(counts) - 1
    following = np.arange(1, len(points) + 1)
    following[last] = last - counts + 1
    ends = points[following]
    # A ring that repeats its first point has one edge without length.
    moves = (points != ends).any(axis=1) | (counts == 1).repeat(counts)
    of_ring = np.repeat(np.arange(len(rings)), counts)
    return Edges(points[moves], ends[moves], of_point[moves], of_ring[moves])


def areas_of(edges: Edges, count: int) -> Floats:
    """Return the square metres of each of ``count`` surfaces, holes taken off, whichever way they run."""
    areas = np.zeros(count)
    if len(edges):
        low = edges.a.min(axis=0)
        a, b = edges.a - low, edges.b - low
        rings, first, of_edge = np.unique(edges.ring, return_index=True, return_inverse=True)
        area = np.abs(np.bincount(of_edge, a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0])) / 2
        owner = edges.owner[first]
        hole = np.append(False, owner[1:] == owner[:-1])[: len(rings)]
        np.add.at(areas, owner, np.where(hole, -area, area))
    return areas
