"""Which particles go on, and how many (Thrun, Burgard, Fox: Probabilistic Robotics, 4.3.4 and 8.3.7)."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .settings import FilterSettings

FEWEST = 20
"""particles of a group."""
NEGLIGIBLE = 1e-3
"""of all weight."""
MOST_GROUPS = 100
_QUANTILE = 2.3263
"""of the normal distribution at 99 %."""


def low_variance(weights: NDArray[Any], count: int, rng: np.random.Generator) -> NDArray[Any]:
    """Return the rows of ``count`` particles drawn by ``weights``, (N,), of sum 1: (count,) int64.

    One random number serves all: a particle of weight w is drawn ⌊w·count⌋ or ⌈w·count⌉ times, w·count on
    average.
    """
    places = (rng.random() + np.arange(count)) / count
    reached = np.cumsum(weights)
    return np.minimum(np.searchsorted(reached / reached[-1], places, side="right"), len(weights) - 1)


def in_groups(
    weights: NDArray[Any], group: NDArray[Any], count: int, rng: np.random.Generator
) -> tuple[NDArray[Any], NDArray[Any]]:
    """Return the rows of about ``count`` particles drawn in each group by itself, and their weights of sum 1.

    ``group``, (N,) int64, tells which belong together. A group keeps its weight, and has :data:`FEWEST`
    particles at least: of places that look alike none dies out by chance, and what scans say of them adds up.
    Groups of less weight than :data:`NEGLIGIBLE` are left out, and all but the :data:`MOST_GROUPS` heaviest.
    """
    _, number = np.unique(group, return_inverse=True)
    total = np.bincount(number, weights=weights) / weights.sum()
    kept = np.argsort(-total)[:MOST_GROUPS]
    kept = kept[total[kept] >= min(NEGLIGIBLE, total.max())]
    rows, drawn = [], []
    for one in kept:
        members = np.flatnonzero(number == one)
        enough = max(FEWEST, round(float(total[one]) * count))
        own = weights[members] / weights[members].sum()
        rows.append(members[low_variance(own, enough, rng)])
        drawn.append(np.full(enough, total[one] / enough))
    all_weights = np.concatenate(drawn)
    return np.concatenate(rows), all_weights / all_weights.sum()


def bins_of(poses: NDArray[Any], size: float, turn: float) -> NDArray[Any]:
    """Return a number for each of ``poses``, (N, 3), the same for those in one bin: (N,) int64.

    Bins are ``size`` metres wide and deep, and ``turn`` radians of the heading, a part of the whole turn.
    """
    placed = np.column_stack([poses[:, :2], np.mod(poses[:, 2], 2 * math.pi)])
    row = np.floor(placed / (size, size, turn)).astype(np.int64)
    row -= row.min(axis=0)
    spans = row.max(axis=0) + 1
    number: NDArray[Any] = (row[:, 0] * spans[1] + row[:, 1]) * spans[2] + row[:, 2]
    return number


def occupied_bins(poses: NDArray[Any], settings: FilterSettings) -> int:
    """Return how many bins of place and heading ``poses``, (N, 3), lie in."""
    turn = 2 * math.pi / max(1, round(360 / settings.bin_turn_deg))
    return len(np.unique(bins_of(poses, settings.bin_size, turn)))


def particles_for(bins: int, settings: FilterSettings) -> int:
    """Return how many particles are enough for as many occupied bins, between ``least`` and ``most``.

    So that with 99 % the Kullback-Leibler distance to the true distribution is below ``kld_error``
    (Wilson-Hilferty approximation of the chi-square quantile).
    """
    if bins <= 1:
        return settings.least
    part = 2 / (9 * (bins - 1))
    enough = (bins - 1) / (2 * settings.kld_error) * (1 - part + math.sqrt(part) * _QUANTILE) ** 3
    return int(min(max(math.ceil(enough), settings.least), settings.most))
