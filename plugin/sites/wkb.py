"""Plain arrays as well-known binary, which every writer of geometries takes (OGC 06-103r4, section 8)."""

from __future__ import annotations

import struct
from collections.abc import Sequence

import numpy as np

_LINE, _POLYGON, _MULTI_LINE = 2, 3, 5


def line_wkb(points: np.ndarray) -> bytes:
    """Return the (n, 2) ``points`` as a line string."""
    return _head(_LINE) + _points(points)


def multi_line_wkb(lines: Sequence[np.ndarray]) -> bytes:
    """Return (n, 2) arrays as one multi line string."""
    return _head(_MULTI_LINE) + _count(lines) + b"".join(line_wkb(line) for line in lines)


def polygon_wkb(rings: Sequence[np.ndarray]) -> bytes:
    """Return closed (n, 2) rings, the outer one first, as a polygon."""
    return _head(_POLYGON) + _count(rings) + b"".join(_points(ring) for ring in rings)


def _head(kind: int) -> bytes:
    return struct.pack("<BI", 1, kind)


def _count(items: Sequence[np.ndarray]) -> bytes:
    return struct.pack("<I", len(items))


def _points(points: np.ndarray) -> bytes:
    return _count(points) + np.ascontiguousarray(points, dtype="<f8").tobytes()
