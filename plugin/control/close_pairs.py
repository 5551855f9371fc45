"""Pairs of places that are close to each other, of thousands at once."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

Ints = npt.NDArray[np.int64]
ROW = np.int64(2**32)
"""From a cell's number to that of the cell above it; the cell beside it is the next."""
LARGEST = 2**30
"""Cells from the origin; nobody's place is told further away."""


def close_pairs(xy: npt.NDArray[np.float64], reach: float) -> tuple[Ints, Ints, npt.NDArray[np.float64]]:
    """Return all pairs i < j of (n, 2) finite places at most ``reach`` apart, and how far apart they are."""
    nothing = np.empty(0, np.int64)
    if len(xy) < 2 or reach <= 0:
        return nothing, nothing, np.empty(0)
    number = _cells(xy, reach)
    order = np.argsort(number, kind="stable")
    ranked = number[order]
    # Cells beside each other have numbers beside each other. Half of those about a cell are enough: the other
    # half finds the same pairs from the other side.
    beside = np.arange(1, len(order) + 1), np.searchsorted(ranked, ranked + 1, side="right")
    above = (
        np.searchsorted(ranked, ranked + ROW - 1, side="left"),
        np.searchsorted(ranked, ranked + ROW + 1, side="right"),
    )
    found = [_pairs(begin, end) for begin, end in (beside, above)]
    one = order[np.concatenate([pair[0] for pair in found])]
    other = order[np.concatenate([pair[1] for pair in found])]
    apart = np.hypot(*(xy[one] - xy[other]).T)
    near = apart <= reach
    one, other, apart = one[near], other[near], apart[near]
    return np.minimum(one, other), np.maximum(one, other), apart


def pairs_between(
    ones: npt.NDArray[np.float64], others: npt.NDArray[np.float64], reach: float
) -> tuple[Ints, Ints, npt.NDArray[np.float64]]:
    """Return the rows of (n, 2) ``ones`` and (m, 2) ``others`` at most ``reach`` apart, and how far apart."""
    cells = _cells(others, reach)
    order = np.argsort(cells, kind="stable")
    ranked = cells[order]
    cells = _cells(ones, reach)
    found = [
        _pairs(np.searchsorted(ranked, row - 1, side="left"), np.searchsorted(ranked, row + 1, side="right"))
        for row in (cells - ROW, cells, cells + ROW)
    ]
    one = np.concatenate([pair[0] for pair in found])
    other = order[np.concatenate([pair[1] for pair in found])]
    apart = np.hypot(*(ones[one] - others[other]).T)
    near = apart <= reach
    return one[near], other[near], apart[near]


def _cells(xy: npt.NDArray[np.float64], reach: float) -> Ints:
    """Return the number of the cell that each place is in; those beside one another have numbers that are."""
    cell = np.clip(np.floor(xy / reach), -LARGEST, LARGEST).astype(np.int64)
    return cell[:, 1] * ROW + cell[:, 0]


def _pairs(begin: Ints, end: Ints) -> tuple[Ints, Ints]:
    """Return k and every number from begin[k] to before end[k], for each k."""
    count = end - begin
    one = np.repeat(np.arange(len(begin)), count)
    first = np.repeat(begin - (np.cumsum(count) - count), count)
    return one, first + np.arange(len(one))
