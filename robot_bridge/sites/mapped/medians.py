"""The median of more numbers than there is memory for."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from .row_file import AT_ONCE, RowFile

_BINS = 1 << 16
_SIGN = np.uint64(1 << 63)

Codes = NDArray[np.uint64]


def median(numbers: RowFile) -> float:
    """Return what ``numpy.median`` does of ``numbers``, float64 and finite; 0 of none. Raises OSError."""
    count = len(numbers)
    if not count:
        return 0.0
    lower = _at_rank(numbers, (count - 1) // 2)
    if count % 2:
        return lower
    up_to, beyond = 0, np.inf
    for some in numbers.pieces():
        more = some > lower
        up_to += len(some) - int(more.sum())
        beyond = min(beyond, some[more].min(initial=np.inf))
    return (lower + (lower if up_to > count // 2 else float(beyond))) / 2


def _at_rank(numbers: RowFile, rank: int) -> float:
    """Return the number that would be at ``rank`` if they were sorted.

    What it is among is counted in bins that become narrower, until few enough are left to be sorted.
    """
    low, high, left = 0, 1 << 64, len(numbers)
    while left > AT_ONCE and high - low > 1:
        width = -(-(high - low) // _BINS)
        counts = np.zeros(_BINS, dtype=np.int64)
        for some in numbers.pieces():
            bins = (_within(_codes(some), low, high) - np.uint64(low)) // np.uint64(width)
            counts += np.bincount(bins.astype(np.int64), minlength=_BINS)
        one = int(np.searchsorted(np.cumsum(counts), rank, side="right"))
        rank -= int(counts[:one].sum())
        low, high, left = low + one * width, min(low + (one + 1) * width, high), int(counts[one])
    if high - low == 1:
        return _number(low)
    found = np.concatenate([_within(_codes(some), low, high) for some in numbers.pieces()])
    return _number(int(np.partition(found, rank)[rank]))


def _codes(numbers: NDArray[np.float64]) -> Codes:
    """Return whole numbers that are in the same order."""
    bits = numbers.view(np.uint64)
    # Of what is below zero all bits are turned round, else the sign alone.
    return np.where(bits & _SIGN, ~bits, bits | _SIGN)


def _number(code: int) -> float:
    bits = code - (1 << 63) if code >> 63 else (1 << 64) - 1 - code
    return float(np.array(bits, dtype=np.uint64).view(np.float64))


def _within(codes: Codes, low: int, high: int) -> Codes:
    return codes[(codes >= np.uint64(low)) & (codes <= np.uint64(high - 1))]
