"""Which of many rectangles touch each other, by a sweep along the longer side of their extent."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray

_AT_ONCE = 1_000_000
"""How many pairs are looked at together: bounds the memory."""


def overlapping_boxes(low: NDArray[Any], high: NDArray[Any]) -> Iterator[tuple[NDArray[Any], NDArray[Any]]]:
    """Yield the indices of pairs of boxes that touch, each pair once.

    ``low`` and ``high`` are (n, 2), the lower and upper corners.
    """
    if len(low) < 2:
        return
    axis = int(np.argmax(high.max(axis=0) - low.min(axis=0)))
    order = np.argsort(low[:, axis], kind="stable")
    start = np.arange(1, len(order) + 1)
    end = np.searchsorted(low[order, axis], high[order, axis], side="right")
    counts = np.maximum(end - start, 0)
    first = 0
    total = np.cumsum(counts)
    while first < len(order):
        reached = total[first - 1] if first else 0
        last = max(int(np.searchsorted(total, reached + _AT_ONCE, side="right")), first + 1)
        one = np.repeat(np.arange(first, last), counts[first:last])
        before = total[first:last] - counts[first:last] - reached
        within = np.arange(len(one)) - np.repeat(before, counts[first:last])
        i, j = order[one], order[start[one] + within]
        across = 1 - axis
        touch = (low[i, across] <= high[j, across]) & (low[j, across] <= high[i, across])
        yield i[touch], j[touch]
        first = last
