"""Columns of whole numbers as bytes: differences of one sign, in the fewest bytes, ready to be compressed."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from .errors import BinaryError

WIDTHS = (0, 1, 2, 4, 8)
"""bytes of one number; a column of zeros has none at all."""


def differences(values: NDArray[Any]) -> NDArray[Any]:
    """Return each of ``values``, (n,) int64, less the one before it; the first less 0."""
    return np.diff(values, prepend=np.int64(0))


def pack(values: NDArray[Any]) -> bytes:
    """Return ``values``, (n,) int64, in planes: the lowest byte of each, then the next byte of each, ...

    A number v is written as 2v, or as -2v - 1 where it is negative, so that small ones have empty high
    planes whatever their sign.
    """
    unsigned = ((values << 1) ^ (values >> 63)).view(np.uint64)
    largest = int(unsigned.max()) if len(unsigned) else 0
    width = next(w for w in WIDTHS if largest < 1 << 8 * w)
    planes = unsigned.astype("<u8").view(np.uint8).reshape(-1, 8)[:, :width]
    return planes.T.tobytes()


def unpack(column: bytes, count: int, name: str) -> NDArray[Any]:
    """Return the ``count`` numbers, int64, in ``column``; raises BinaryError naming the column."""
    width = len(column) // count if count else 0
    if len(column) != width * count or width not in WIDTHS:
        raise BinaryError(
            f"columns check: {name} has {len(column)} bytes for {count} numbers; get the map once more"
        )
    planes = np.zeros((count, 8), dtype=np.uint8)
    planes[:, :width] = np.frombuffer(column, np.uint8).reshape(width, count).T
    unsigned = planes.view("<u8")[:, 0].astype(np.uint64)
    return (unsigned >> np.uint64(1)).astype(np.int64) ^ -(unsigned & np.uint64(1)).astype(np.int64)
