"""Plain arrays to and from well-known binary, which geometry libraries speak (OGC 06-103r4, section 8)."""

from __future__ import annotations

import struct
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

_LINE, _POLYGON, _MULTI_LINE, _MULTI_POLYGON = 2, 3, 5, 6
_HEAD, _COUNT = struct.Struct("<BI"), struct.Struct("<I")
_BEFORE_POINTS = _HEAD.size + _COUNT.size
_POINT_BYTES = (16, 24, 24, 32)
"""Bytes of a point without Z and M, with Z, with M, and with both: a thousand between their kinds."""
_OLD_Z = 0x80000000
"""What a kind with Z has besides itself in older files."""


class Rings(NamedTuple):
    """The rings or lines of one geometry: ``points`` holds x and y of each as bytes of float64.

    ``inner`` says of each whether it is a hole of the ring before it; lines are not ``closed``.
    """

    points: list[bytes]
    inner: list[bool]
    closed: bool


def rings_of(wkb: bytes) -> Rings | None:
    """Return what a line, a polygon or several of them are made of; Z and M are dropped.

    None for everything else: points, curves, collections, and big-endian ones.
    """
    order, kind = _HEAD.unpack_from(wkb)
    dimensions, kind = (1, kind - _OLD_Z) if kind >= _OLD_Z else divmod(kind, 1000)
    closed = kind in (_POLYGON, _MULTI_POLYGON)
    if order != 1 or dimensions > 3 or not (closed or kind in (_LINE, _MULTI_LINE)):
        return None
    size = _POINT_BYTES[dimensions]
    parts, at = 1, 0
    if kind in (_MULTI_LINE, _MULTI_POLYGON):
        (parts,), at = _COUNT.unpack_from(wkb, _HEAD.size), _BEFORE_POINTS
    points: list[bytes] = []
    inner: list[bool] = []
    for _ in range(parts):
        count = 1
        if closed:
            (count,), at = _COUNT.unpack_from(wkb, at + _HEAD.size), at + _BEFORE_POINTS
        else:
            at += _HEAD.size
        for k in range(count):
            start = at + _COUNT.size
            at = start + size * _COUNT.unpack_from(wkb, at)[0]
            points.append(wkb[start:at])
            inner.append(k > 0)
    return Rings(points if size == _POINT_BYTES[0] else [_flat(one, size) for one in points], inner, closed)


def _flat(points: bytes, size: int) -> bytes:
    return np.frombuffer(points, "<f8").reshape(-1, size // 8)[:, :2].tobytes()


def line_wkb(points: bytes) -> bytes:
    """Return a line string; ``points`` is x and y of each as bytes of float64."""
    return _HEAD.pack(1, _LINE) + _COUNT.pack(len(points) // _POINT_BYTES[0]) + points


def multi_line_wkb(lines: Sequence[bytes]) -> bytes:
    """Return lines, as :func:`line_wkb` takes each, as one multi line string."""
    return _HEAD.pack(1, _MULTI_LINE) + _COUNT.pack(len(lines)) + b"".join(map(line_wkb, lines))


def polygon_wkb(rings: Sequence[bytes]) -> bytes:
    """Return closed rings, the outer one first, as a polygon; each as :func:`line_wkb` takes a line."""
    pieces = [_HEAD.pack(1, _POLYGON), _COUNT.pack(len(rings))]
    for ring in rings:
        pieces += (_COUNT.pack(len(ring) // _POINT_BYTES[0]), ring)
    return b"".join(pieces)
