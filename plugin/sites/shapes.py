"""From one QGIS geometry to the rings, lines and risers of a robot map."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from qgis.core import QgsAbstractGeometry, QgsGeometry

from ...robot_bridge.robotmap.model import ShapeType
from ..language import tr
from .parts import parts_of
from .ramps import corner_heights
from .roles import RAMP, STAIRS
from .soundness import lines_with_length, risers_of, sound_polygons

SAGITTA_M = 0.02
"""How far a chord may be from the curve it stands for (design, section 6)."""

NO_PLACE = tr(
    "has a coordinate that is no number, has no place in the site's CRS or lies beyond 100 000 km; "
    "it is left out"
)


class Shape(NamedTuple):
    """One outline: ``points`` is (n, 2) in the geometry's coordinates, rings repeat their first point.

    ``z`` is (n,), the height of each point of a ramp in metres, NaN where the geometry does not say it.
    """

    points: np.ndarray
    shape_type: ShapeType
    courtyard: bool = False
    z: np.ndarray | None = None

    @property
    def closed(self) -> bool:
        """Whether it is a ring."""
        return bool(len(self.points) > 3 and (self.points[0] == self.points[-1]).all())


class Shapes(NamedTuple):
    """What was found in a geometry, and a note for each thing that was repaired or left out."""

    shapes: list[Shape]
    notes: list[str]


def shapes_of(geometry: QgsGeometry, role: str = "") -> Shapes:
    """Return the outlines in ``geometry``, which is in metres, for a layer of ``role``.

    Curves become chords with a sagitta of 2 cm. Rings and lines without extent are left out, a ring that
    crosses itself is repaired; ``notes`` says so for each. Several lines of a stairs layer are one flight,
    a riser each, bottom first; a single one stays a low wall, which is what the paper makes of a riser.
    """
    curved = geometry.constGet().hasCurvedSegments()
    if curved:
        maximum = QgsAbstractGeometry.SegmentationToleranceType.MaximumDifference
        geometry = QgsGeometry(geometry.constGet().segmentize(SAGITTA_M, maximum))
    parts = parts_of(geometry)
    if not parts.on_earth:
        return Shapes([], [NO_PLACE])
    # Valid as a whole is the rule and quickly told; GEOS takes a ring without points for valid, too.
    sound = parts.rings_have_points and geometry.isGeosValid()
    polygons, polygon_notes = (parts.polygons, []) if sound else sound_polygons(parts.polygons)
    lines, line_notes = lines_with_length(parts.lines)
    notes = [*parts.notes, *polygon_notes, *line_notes]
    closed = _closed_type(role, curved)
    shapes = [Shape(ring, closed, k > 0) for polygon in polygons for k, ring in enumerate(polygon)]
    if role == RAMP:
        shapes = _with_heights(shapes, geometry)
    if role == STAIRS and len(lines) > 1:
        risers, bent = risers_of(lines)
        return Shapes([*shapes, Shape(risers, ShapeType.STAIRS)], [*notes, *bent])
    opened = ShapeType.OPEN_CURVE if curved else ShapeType.OPEN_POLYGON
    return Shapes([*shapes, *(Shape(line, opened) for line in lines)], notes)


def polygons_of(shapes: Sequence[Shape]) -> list[list[np.ndarray]]:
    """Return the rings of each polygon among ``shapes``, its outer ring first; lines are passed over."""
    polygons: list[list[np.ndarray]] = []
    for shape in shapes:
        if shape.courtyard:
            polygons[-1].append(shape.points)
        elif shape.closed:
            polygons.append([shape.points])
    return polygons


def _with_heights(ramps: list[Shape], geometry: QgsGeometry) -> list[Shape]:
    heights = corner_heights(geometry)
    return [
        ramp._replace(z=np.array([heights.get((x, y), np.nan) for x, y in ramp.points.tolist()]))
        for ramp in ramps
    ]


def _closed_type(role: str, curved: bool) -> ShapeType:
    if role == RAMP:
        return ShapeType.RAMP
    return ShapeType.CLOSED_CURVE if curved else ShapeType.CLOSED_POLYGON
