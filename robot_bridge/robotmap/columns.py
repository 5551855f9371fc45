"""Columns of whole numbers as bytes: differences of one sign, in few bytes, ready to be compressed."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from .errors import BinaryError

_WIDTHS = (1, 2, 4, 8)
"""bytes of one number where all have as many; the first byte of such a column."""
_VARIABLE = 0
"""The first byte of a column whose numbers have as many bytes as each needs."""
_MOST_BYTES = 9
"""of one number; 63 bits."""
_FEW_BYTES = 1.5
"""of a number, on average: where planes and variable lengths become equally large once compressed."""


def differences(values: NDArray[Any]) -> NDArray[Any]:
    """Return each of ``values``, (n,) or (n, axes) int64, less the one before it; the first less 0."""
    return np.diff(values, axis=0, prepend=np.int64(0))


def pack(values: NDArray[Any]) -> bytes:
    """Return ``values``, (n,) int64 of at most 62 bits: nothing where all are 0, else a byte and the numbers.

    A number v is written as 2v, or as -2v - 1 where it is negative, so that small ones have few bytes
    whatever their sign. Either each has the number of bytes that the first byte says and they stand in
    planes: the lowest byte of each, then the next byte of each, ...; or the first byte is 0, and each is
    in bytes of seven bits, the lowest first, all but the last of them with 128 added (LEB128). Numbers that
    need few bytes are compressed better in the second way, large ones in the first.
    """
    if not values.any():
        return b""
    unsigned = ((values << 1) ^ (values >> 63)).view(np.uint64)
    variable = _variable(unsigned)
    return variable if len(variable) <= _FEW_BYTES * len(values) else _in_planes(unsigned)


def unpack(column: bytes, count: int, name: str) -> NDArray[Any]:
    """Return the ``count`` numbers, int64, in ``column``; raises BinaryError naming the column."""
    if not column:
        return np.zeros(count, dtype=np.int64)
    numbers = np.frombuffer(column, np.uint8)[1:]
    unsigned = _from_variable(numbers, count) if column[0] == _VARIABLE else _from_planes(column, count)
    if unsigned is None:
        raise BinaryError(
            f"columns check: {name} has {len(column)} bytes for {count} numbers; get the map once more"
        )
    return (unsigned >> np.uint64(1)).astype(np.int64) ^ -(unsigned & np.uint64(1)).astype(np.int64)


def _in_planes(unsigned: NDArray[Any]) -> bytes:
    largest = int(unsigned.max())
    width = next(w for w in _WIDTHS if largest < 1 << 8 * w)
    planes = unsigned.astype("<u8").view(np.uint8).reshape(-1, 8)[:, :width]
    return bytes([width]) + planes.T.tobytes()


def _from_planes(column: bytes, count: int) -> NDArray[Any] | None:
    width = column[0]
    if width not in _WIDTHS or len(column) != 1 + width * count:
        return None
    planes = np.zeros((count, 8), dtype=np.uint8)
    planes[:, :width] = np.frombuffer(column, np.uint8)[1:].reshape(width, count).T
    return planes.view("<u8")[:, 0].astype(np.uint64)


def _variable(unsigned: NDArray[Any]) -> bytes:
    shifted = unsigned[:, None] >> (7 * np.arange(_MOST_BYTES, dtype=np.uint64))
    goes_on = shifted >= 128
    needed = np.ones(shifted.shape, dtype=bool)
    needed[:, 1:] = goes_on[:, :-1]
    written = (shifted & np.uint64(127)).astype(np.uint8) + 128 * goes_on.astype(np.uint8)
    return bytes([_VARIABLE]) + bytes(written[needed])


def _from_variable(numbers: NDArray[Any], count: int) -> NDArray[Any] | None:
    # What follows takes many times the room of a column, whose length must have been seen to fit before.
    if not count <= len(numbers) <= _MOST_BYTES * count:
        return None
    ends = np.flatnonzero(numbers < 128)
    if len(ends) != count or not count or ends[-1] != len(numbers) - 1:
        return None
    starts = np.concatenate([[0], ends[:-1] + 1])
    lengths = ends - starts + 1
    longest = int(lengths.max())
    if longest > _MOST_BYTES:
        return None
    unsigned = np.zeros(count, dtype=np.uint64)
    for place in range(longest):
        own = np.flatnonzero(lengths > place) if place else slice(None)
        unsigned[own] |= (numbers[starts[own] + place] & 127).astype(np.uint64) << np.uint64(7 * place)
    return unsigned
