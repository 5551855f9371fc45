"""Segments as runs of points: a point that ends one segment and begins the next is there once."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

RING, CHAIN, LOOSE = 0, 1, 2
"""How the segments of an obstacle hang together: round to the first point, one after another, not at all."""


class Runs(NamedTuple):
    """R runs of points: K forms, R first points (R, 2), and the steps (S, 2) from point to point of a run."""

    forms: NDArray[Any]
    starts: NDArray[Any]
    steps: NDArray[Any]


def runs_of(a: NDArray[Any], b: NDArray[Any], counts: NDArray[Any]) -> Runs:
    """Return the runs of K obstacles with ``counts`` segments each, from ``a`` to ``b``, (n, 2) int64."""
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
    is_start = np.column_stack([begins, np.zeros(len(a), dtype=bool)]).ravel()[given]
    steps = np.diff(points, axis=0, prepend=points[:1])
    return Runs(forms, points[is_start], steps[~is_start])


def run_lengths(forms: NDArray[Any], counts: NDArray[Any]) -> NDArray[Any]:
    """Return how many points each run has, (R,) int64."""
    runs = np.where(forms == LOOSE, counts, 1)
    lengths = np.where(forms == LOOSE, 2, counts + (forms == CHAIN))
    return np.repeat(lengths, runs)


def segments_of(runs: Runs, counts: NDArray[Any]) -> tuple[NDArray[Any], NDArray[Any]]:
    """Return ``a`` and ``b``, (n, 2) int64: what :func:`runs_of` was given."""
    lengths = run_lengths(runs.forms, counts)
    run = np.repeat(np.arange(len(lengths)), lengths)
    ends = np.cumsum(lengths)
    is_start, is_end = np.zeros(len(run), dtype=bool), np.zeros(len(run), dtype=bool)
    is_start[ends - lengths] = is_end[ends - 1] = True
    steps = np.zeros((len(run), 2), dtype=np.int64)
    steps[~is_start] = runs.steps
    moved = np.cumsum(steps, axis=0)
    points = moved + (runs.starts - moved[is_start])[run]
    per_run = np.repeat(runs.forms == RING, np.where(runs.forms == LOOSE, counts, 1))
    begins = np.flatnonzero(~is_end | per_run[run])
    follows = np.where(is_end[begins], (ends - lengths)[run[begins]], begins + 1)
    return points[begins], points[follows]
