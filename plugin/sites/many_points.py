"""Many coordinates through one transform, together and not point by point."""

from __future__ import annotations

import struct

import numpy as np
from qgis.core import QgsCoordinateTransform, QgsCsException, QgsGeometry, QgsPointXY

from .crs_way import check_way

_LINE_HEADER = struct.Struct("<BII")
_POINT_HEADER = struct.Struct("<BI")
_POINT, _LINE_STRING = 1, 2


def line_of(xy: np.ndarray) -> QgsGeometry:
    """Return (n, 2) coordinates as a line, a single one as a point; an object for each would be slow."""
    head = _POINT_HEADER.pack(1, _POINT) if len(xy) == 1 else _LINE_HEADER.pack(1, _LINE_STRING, len(xy))
    geometry = QgsGeometry()
    geometry.fromWkb(head + xy.astype("<f8").tobytes())
    return geometry


def moved_together(xy: np.ndarray, transform: QgsCoordinateTransform) -> np.ndarray:
    """Return (n, 2) coordinates through ``transform``.

    :raises QgsCsException: when one of them has no place in the target CRS, unless QGIS makes it infinite,
        and when nothing is known of how the CRSs lie to each other.
    """
    check_way(transform)
    if len(xy) == 0 or transform.isShortCircuited():
        return np.asarray(xy, dtype=np.float64).reshape(-1, 2)
    # A line string of one point is none, so the first point goes twice.
    geometry = line_of(np.concatenate([xy[:1], xy]))
    geometry.transform(transform)
    return np.frombuffer(geometry.asWkb().data(), dtype="<f8", offset=_LINE_HEADER.size).reshape(-1, 2)[1:]


def moved(xy: np.ndarray, transform: QgsCoordinateTransform) -> np.ndarray:
    """Return (n, 2) coordinates through ``transform``, not finite where the target CRS has no place."""
    try:
        return moved_together(xy, transform)
    except QgsCsException:
        return np.array([_moved_alone(x, y, transform) for x, y in xy.tolist()])


def _moved_alone(x: float, y: float, transform: QgsCoordinateTransform) -> tuple[float, float]:
    try:
        check_way(transform)
        point = transform.transform(QgsPointXY(x, y))
    except QgsCsException:
        return float("nan"), float("nan")
    return point.x(), point.y()
