"""Segments as one path of points for each obstacle; a point that two segments share is there once."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

RING, CHAIN, LOOSE = 0, 1, 2
"""How the segments of an obstacle hang together: round to the first point, one after another, not at all."""


class Paths(NamedTuple):
    """K forms, K first points (K, 2), and the steps (S, 2) from point to point, one path after the other.

    The points of a loose obstacle are both ends of each segment. Without segments the first point is (0, 0).
    """

    forms: NDArray[Any]
    starts: NDArray[Any]
    steps: NDArray[Any]


def paths_of(a: NDArray[Any], b: NDArray[Any], counts: NDArray[Any]) -> Paths:
    """Return the paths of K obstacles with ``counts`` segments each, from ``a`` to ``b``, (n, 2) int64."""
    obstacle = np.repeat(np.arange(len(counts)), counts)
    ends = np.cumsum(counts)
    filled = counts > 0
    first, last = np.zeros(len(a), dtype=bool), np.zeros(len(a), dtype=bool)
    first[(ends - counts)[filled]] = last[ends[filled] - 1] = True
    parted = ~first
    parted[1:] &= (a[1:] != b[:-1]).any(axis=1)
    forms = np.where(np.bincount(obstacle, parted, len(counts)) > 0, LOOSE, CHAIN)
    forms[~filled] = LOOSE
    closes = np.zeros(len(counts), dtype=bool)
    closes[filled] = (a[first] == b[last]).all(axis=1)
    forms[closes & (forms == CHAIN)] = RING
    begins = first | (forms == LOOSE)[obstacle]
    given = np.column_stack([begins, ~(last & (forms == RING)[obstacle])]).ravel()
    points = np.stack([a, b], axis=1).reshape(-1, 2)[given]
    is_start = np.column_stack([first, np.zeros(len(a), dtype=bool)]).ravel()[given]
    starts = np.zeros((len(counts), 2), dtype=np.int64)
    starts[filled] = points[is_start]
    return Paths(forms, starts, np.diff(points, axis=0, prepend=points[:1])[~is_start])


def step_counts(forms: NDArray[Any], counts: NDArray[Any]) -> NDArray[Any]:
    """Return how many steps the path of each obstacle has, (K,) int64."""
    steps: NDArray[Any] = np.where(forms == LOOSE, np.maximum(2 * counts - 1, 0), counts - (forms == RING))
    return steps


def segments_of(paths: Paths, counts: NDArray[Any]) -> tuple[NDArray[Any], NDArray[Any]]:
    """Return ``a`` and ``b``, (n, 2) int64: what :func:`paths_of` was given."""
    filled = counts > 0
    forms, starts, lengths = (
        paths.forms[filled],
        paths.starts[filled],
        1 + step_counts(paths.forms, counts)[filled],
    )
    path = np.repeat(np.arange(len(lengths)), lengths)
    ends = np.cumsum(lengths)
    place = np.arange(len(path)) - (ends - lengths)[path]
    steps = np.zeros((len(path), 2), dtype=np.int64)
    steps[place > 0] = paths.steps
    moved = np.cumsum(steps, axis=0)
    points = moved + (starts - moved[ends - lengths])[path]
    is_last = place == lengths[path] - 1
    begins = np.flatnonzero(
        np.where((forms == LOOSE)[path], place % 2 == 0, ~is_last | (forms == RING)[path])
    )
    follows = np.where(is_last[begins], (ends - lengths)[path[begins]], begins + 1)
    return points[begins], points[follows]
