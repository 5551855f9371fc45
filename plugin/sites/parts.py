"""The polygons and lines of a QGIS geometry as plain arrays."""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
from qgis.core import QgsAbstractGeometry, QgsCurve, QgsCurvePolygon, QgsGeometry, QgsGeometryCollection

from ..language import tr

FARTHEST_M = 1e8
"""Metres: more than twice around the Earth, and more than any projection has."""


class Parts(NamedTuple):
    """Polygons as lists of (n, 2) rings, shell first; (n, 2) lines; a note for each part that is neither."""

    polygons: list[list[np.ndarray]]
    lines: list[np.ndarray]
    notes: list[str]

    @property
    def on_earth(self) -> bool:
        """Whether every coordinate is a number within :data:`FARTHEST_M` of the origin."""
        return all((np.abs(points) <= FARTHEST_M).all() for points in [*self._rings(), *self.lines])

    @property
    def rings_have_points(self) -> bool:
        """Whether every ring has the four points of a triangle."""
        return all(len(ring) >= 4 for ring in self._rings())

    def _rings(self) -> Iterator[np.ndarray]:
        return (ring for polygon in self.polygons for ring in polygon)


def parts_of(geometry: QgsGeometry) -> Parts:
    """Return what ``geometry`` is made of: collections opened, rings closed, Z and M dropped.

    A null geometry has no parts.
    """
    parts = Parts([], [], [])
    for part in _simple(geometry.constGet()) if not geometry.isNull() else ():
        if isinstance(part, QgsCurvePolygon):
            rings = [part.exteriorRing(), *(part.interiorRing(k) for k in range(part.numInteriorRings()))]
            parts.polygons.append([_closed(_points(ring)) for ring in rings if ring is not None])
        elif isinstance(part, QgsCurve):
            parts.lines.append(_points(part))
        else:
            kind = part.geometryType().lower()
            parts.notes.append(tr("has a {kind}, which is no area or line; it is left out", kind=kind))
    return parts


def _simple(part: QgsAbstractGeometry) -> Iterator[QgsAbstractGeometry]:
    if isinstance(part, QgsGeometryCollection):
        for k in range(part.numGeometries()):
            yield from _simple(part.geometryN(k))
    else:
        yield part


def _points(curve: QgsCurve) -> np.ndarray:
    line = curve.curveToLine()
    line.dropZValue()
    line.dropMValue()
    wkb = line.asWkb().data()
    order = "<" if wkb[:1] == b"\x01" else ">"
    # 9 bytes come first: byte order, geometry type, number of points.
    return np.frombuffer(wkb, order + "f8", offset=9).reshape(-1, 2).astype(np.float64)


def _closed(ring: np.ndarray) -> np.ndarray:
    if len(ring) and (ring[0] != ring[-1]).any():
        return np.concatenate([ring, ring[:1]])
    return ring
