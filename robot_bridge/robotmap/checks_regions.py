"""Connected regions of a grid of true and false, by runs of cells; numpy only."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray


def regions(free: NDArray[Any]) -> tuple[NDArray[Any], int]:
    """Return a label for each cell of ``free``, (rows, columns) bool, and how many labels there are.

    Cells that share a side have the same label, from 0; cells that are false have -1.
    """
    rows, columns = free.shape
    edges = np.diff(np.pad(free, ((0, 0), (1, 1))).astype(np.int8), axis=1)
    row, start = np.nonzero(edges == 1)
    end = np.nonzero(edges == -1)[1]
    label = _joined(np.arange(len(row)), *_neighbours(row, start, end, columns))
    names, label = np.unique(label, return_inverse=True)
    cells = np.full(free.size, -1, dtype=np.int64)
    cells[free.reshape(-1)] = np.repeat(label.reshape(-1), end - start)
    return cells.reshape(rows, columns), len(names)


def _neighbours(
    row: NDArray[Any], start: NDArray[Any], end: NDArray[Any], columns: int
) -> tuple[NDArray[Any], NDArray[Any]]:
    """Return the pairs of runs in following rows that share a column."""
    width = columns + 1
    # Runs are sorted by row and column, so each touches a stretch of those in the row above.
    first = np.searchsorted(row * width + end, (row - 1) * width + start, side="right")
    last = np.searchsorted(row * width + start, (row - 1) * width + end, side="left")
    counts = np.maximum(last - first, 0)
    below = np.repeat(np.arange(len(row)), counts)
    within = np.arange(len(below)) - np.repeat(np.cumsum(counts) - counts, counts)
    return below, first[below] + within


def _joined(label: NDArray[Any], one: NDArray[Any], other: NDArray[Any]) -> NDArray[Any]:
    """Return the smallest label that each can reach by the pairs (one, other)."""
    while True:
        low = np.minimum(label[one], label[other])
        smaller = label.copy()
        np.minimum.at(smaller, label[one], low)
        np.minimum.at(smaller, label[other], low)
        # Follow each label to the one that it was given, until that is its own.
        while (smaller[smaller] != smaller).any():
            smaller = smaller[smaller]
        if (smaller == label).all():
            return label
        label = smaller
