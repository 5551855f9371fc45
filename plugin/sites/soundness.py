"""Repairs polygons and lines where that is safe, and says what it did or could not do."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from qgis.core import Qgis, QgsGeometry, QgsPointXY

from ..language import tr, tr_count
from .parts import Parts, parts_of

STRAIGHT_M = 0.02
"""How far a riser's middle points may be from the line between its ends."""


def sound_polygons(polygons: Sequence[list[np.ndarray]]) -> tuple[list[list[np.ndarray]], list[str]]:
    """Return polygons that are valid, without rings that enclose nothing, and a note for each change."""
    notes: list[str] = []
    kept = []
    for number, rings in enumerate(polygons, 1):
        flat = [k for k, ring in enumerate(rings) if _encloses_nothing(ring)]
        notes += [_flat_note(number, k, rings[k]) for k in flat]
        if rings and 0 not in flat:
            kept.append([ring for k, ring in enumerate(rings) if k not in flat])
    geometry = _as_geometry(kept)
    if not kept or geometry.isGeosValid():
        return kept, notes
    repaired = geometry.makeValid()
    parts = parts_of(repaired) if not repaired.isNull() else Parts([], [], [])
    if not parts.polygons:
        return [], [*notes, tr("{fault}; it cannot be repaired and is left out", fault=_fault(geometry))]
    return parts.polygons, [*notes, tr("{fault}; it was repaired", fault=_fault(geometry))]


def lines_with_length(lines: Sequence[np.ndarray]) -> tuple[list[np.ndarray], list[str]]:
    """Return lines without repeated points, and a note for each that is one point and left out."""
    kept, notes = [], []
    for number, line in enumerate(lines, 1):
        moves = np.ones(len(line), dtype=bool)
        moves[1:] = (line[1:] != line[:-1]).any(axis=1)
        if len(line) > 1 and moves.all():
            kept.append(line)
        elif moves.sum() < 2:
            notes.append(
                tr("line {number} has fewer than two different points; it is left out", number=number)
            )
        else:
            kept.append(line[moves])
    return kept, notes


def risers_of(lines: Sequence[np.ndarray]) -> tuple[np.ndarray, list[str]]:
    """Return the two ends of each line, (2 n, 2), and a note for each line that is not straight.

    ``lines`` are two or more risers, bottom first. Seen from the bottom each runs from left to right,
    whichever way it was drawn (paper 1, section II).
    """
    notes = []
    for number, line in enumerate(lines, 1):
        along = line[-1] - line[0]
        length = max(float(np.hypot(*along)), 1e-9)
        off = along[0] * (line[:, 1] - line[0, 1]) - along[1] * (line[:, 0] - line[0, 0])
        if np.abs(off).max() / length > STRAIGHT_M or length == 1e-9:
            notes.append(
                tr("riser {number} is bent; the straight line between its ends is used", number=number)
            )
    ends = np.array([line[[0, -1]] for line in lines])
    middle = ends.mean(axis=1)
    climb = np.diff(middle, axis=0, append=middle[-1:] * 2 - middle[-2:-1])
    along = ends[:, 1] - ends[:, 0]
    backwards = along[:, 1] * climb[:, 0] - along[:, 0] * climb[:, 1] > 0
    ends[backwards] = ends[backwards, ::-1]
    return ends.reshape(-1, 2), notes


def _encloses_nothing(ring: np.ndarray) -> bool:
    """Tell whether all points of a closed ring lie on one line; a ring that crosses itself does enclose."""
    if len(np.unique(ring, axis=0)) < 3:
        return True
    x, y = (ring - ring[0]).T
    size = max(float(np.ptp(ring, axis=0).max()), 1.0)
    return bool(np.abs(x[:-1] * y[1:] - x[1:] * y[:-1]).sum() < 1e-9 * size)


def _flat_note(number: int, k: int, ring: np.ndarray) -> str:
    place = _place(*ring[0]) if len(ring) else ""
    count = len(np.unique(ring, axis=0))
    points = tr_count(count, "1 different point", "%n different points")
    if k == 0:
        return tr(
            "the outer ring of part {number}{place} has {points} and encloses nothing; the part is left out",
            number=number,
            place=place,
            points=points,
        )
    return tr(
        "courtyard {k} of part {number}{place} has {points} and encloses nothing; the courtyard is left out",
        k=k,
        number=number,
        place=place,
        points=points,
    )


def _place(x: float, y: float) -> str:
    return tr(" at ({x:.2f} {y:.2f})", x=x, y=y)


def _as_geometry(polygons: Sequence[list[np.ndarray]]) -> QgsGeometry:
    return QgsGeometry.fromMultiPolygonXY(
        [[[QgsPointXY(x, y) for x, y in ring.tolist()] for ring in polygon] for polygon in polygons]
    )


def _fault(geometry: QgsGeometry) -> str:
    """Return what GEOS finds wrong first, and where."""
    for error in geometry.validateGeometry(Qgis.GeometryValidationEngine.Geos):
        place = _place(error.where().x(), error.where().y()) if error.hasWhere() else ""
        return tr("the polygon is broken{place}: {what}", place=place, what=error.what())
    return tr("the polygon is broken{place}: {what}", place="", what=geometry.lastError() or tr("not valid"))
