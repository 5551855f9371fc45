"""Points that are one, and parts that hang together."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from .box_pairs import boxes_of, touching
from .centrelines import Floats, Ints


def same_points(points: Floats, within: float) -> Ints:
    """Return a label for each of ``points``, (n, 2): those ``within`` metres of one another share it.

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
    """Return, for each of ``count`` things, the least index of its part; a[k] and b[k] hang together."""
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
    """Return where on the segments from ``a`` to ``b`` the points nearest to ``p`` are, all (n, 2).

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
