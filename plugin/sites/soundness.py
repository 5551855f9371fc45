"""Repairs polygons and lines where that is safe, and says what it did or could not do."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from qgis.core import Qgis, QgsGeometry, QgsPointXY

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
        return [], [*notes, f"{_fault(geometry)}; it cannot be repaired and is left out"]
    return parts.polygons, [*notes, f"{_fault(geometry)}; it was repaired"]


def lines_with_length(lines: Sequence[np.ndarray]) -> tuple[list[np.ndarray], list[str]]:
    """Return lines without repeated points, and a note for each that is one point and left out."""
    kept, notes = [], []
    for number, line in enumerate(lines, 1):
        moves = np.ones(len(line), dtype=bool)
        moves[1:] = (line[1:] != line[:-1]).any(axis=1)
        if moves.sum() < 2:
            notes.append(f"line {number} has fewer than two different points; it is left out")
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
            notes.append(f"riser {number} is bent; the straight line between its ends is used")
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
    which = f"the outer ring of part {number}" if k == 0 else f"courtyard {k} of part {number}"
    place = f" at ({ring[0, 0]:.2f} {ring[0, 1]:.2f})" if len(ring) else ""
    count = len(np.unique(ring, axis=0))
    lost = "the part" if k == 0 else "the courtyard"
    points = f"{count} different point{'' if count == 1 else 's'}"
    return f"{which}{place} has {points} and encloses nothing; {lost} is left out"


def _as_geometry(polygons: Sequence[list[np.ndarray]]) -> QgsGeometry:
    return QgsGeometry.fromMultiPolygonXY(
        [[[QgsPointXY(x, y) for x, y in ring.tolist()] for ring in polygon] for polygon in polygons]
    )


def _fault(geometry: QgsGeometry) -> str:
    """Return what GEOS finds wrong first, and where."""
    for error in geometry.validateGeometry(Qgis.GeometryValidationEngine.Geos):
        place = f" at ({error.where().x():.2f} {error.where().y():.2f})" if error.hasWhere() else ""
        return f"the polygon is broken{place}: {error.what()}"
    return f"the polygon is broken: {geometry.lastError() or 'not valid'}"
