"""QGIS geometries as plain arrays: parts, repair, outlines, ramps, well-known binary."""

from __future__ import annotations

import struct
from collections.abc import Iterator, Sequence
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from qgis.core import (
    Qgis,
    QgsAbstractGeometry,
    QgsCurve,
    QgsCurvePolygon,
    QgsGeometry,
    QgsGeometryCollection,
    QgsPointXY,
)

from ...robot_bridge.core.errors import ShapingError
from ...robot_bridge.core.robotmap.model import ShapeType
from ...robot_bridge.core.robotmap.parametric_shapes import ramp_normal
from ..ui.language import tr, tr_count
from .roles import RAMP, STAIRS

# --- Plain arrays to and from well-known binary, the format of geometry libraries (OGC 06-103r4, section 8)

_POINT, _LINE, _POLYGON, _MULTI_POINT, _MULTI_LINE, _MULTI_POLYGON = range(1, 7)
_HEAD, _COUNT = struct.Struct("<BI"), struct.Struct("<I")
_BEFORE_POINTS = _HEAD.size + _COUNT.size
_POINT_BYTES = (16, 24, 24, 32)
"""Bytes of a point without Z and M, with Z, with M, and with both: the type codes differ by a thousand."""
_OLD_Z = 0x80000000
"""Bit of the type code for Z in older files."""
_POINTS = frozenset(
    _HEAD.pack(1, kind + more) for kind in (_POINT, _MULTI_POINT) for more in (0, 1000, 2000, 3000, _OLD_Z)
)
_ONE = _COUNT.pack(1)
_ONE_RING, _ONE_LINE = _HEAD.pack(1, _POLYGON) + _ONE, _HEAD.pack(1, _LINE)
_USUAL = (
    (_ONE_RING, True),
    (_HEAD.pack(1, _MULTI_POLYGON) + _ONE + _ONE_RING, True),
    (_ONE_LINE, False),
    (_HEAD.pack(1, _MULTI_LINE) + _ONE + _ONE_LINE, False),
)
"""Headers of the most common geometries, with one ring or line and no Z and M, and whether it is closed."""


class Rings(NamedTuple):
    """The rings or lines of one geometry: ``points`` holds x and y of each as bytes of float64.

    ``inner`` is whether each is a hole of the ring before it; lines are not ``closed``.
    """

    points: list[bytes]
    inner: list[bool]
    closed: bool


def rings_of(wkb: bytes) -> Rings | None:
    """Return the rings or lines of a line, a polygon or several of them; Z and M are dropped.

    None for everything else: points, curves, collections, and big-endian ones.
    """
    for head, closed in _USUAL:
        if wkb.startswith(head):
            return Rings([wkb[len(head) + _COUNT.size :]], [False], closed)
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


def are_points(wkb: bytes) -> bool:
    """Return whether a geometry is a point, or several of them."""
    return wkb[: _HEAD.size] in _POINTS


def _flat(points: bytes, size: int) -> bytes:
    return np.frombuffer(points, "<f8").reshape(-1, size // 8)[:, :2].tobytes()


def geometry_of(wkb: bytes) -> QgsGeometry:
    """Return the geometry encoded in ``wkb``."""
    geometry = QgsGeometry()
    geometry.fromWkb(wkb)
    return geometry


def line_wkb(points: bytes) -> bytes:
    """Return a line string; ``points`` is x and y of each as bytes of float64."""
    return _HEAD.pack(1, _LINE) + _COUNT.pack(len(points) // _POINT_BYTES[0]) + points


def multi_line_wkb(lines: Sequence[bytes]) -> bytes:
    """Return lines, each as for :func:`line_wkb`, as one multi line string."""
    return _HEAD.pack(1, _MULTI_LINE) + _COUNT.pack(len(lines)) + b"".join(map(line_wkb, lines))


def polygon_wkb(rings: Sequence[bytes]) -> bytes:
    """Return closed rings, the outer one first, as a polygon; each as a line for :func:`line_wkb`."""
    pieces = [_HEAD.pack(1, _POLYGON), _COUNT.pack(len(rings))]
    for ring in rings:
        pieces += (_COUNT.pack(len(ring) // _POINT_BYTES[0]), ring)
    return b"".join(pieces)


def polygon_heads(lengths: np.ndarray) -> list[bytes]:
    """Return the headers of polygons of one ring each, with these numbers of points."""
    heads = np.empty(len(lengths), [("order", "u1"), ("kind", "<u4"), ("rings", "<u4"), ("points", "<u4")])
    heads["order"], heads["kind"], heads["rings"], heads["points"] = 1, _POLYGON, 1, lengths
    data, size = heads.tobytes(), heads.itemsize
    return [data[at : at + size] for at in range(0, len(data), size)]


# --- The polygons and lines of a QGIS geometry as plain arrays ---

FARTHEST_M = 1e8
"""Metres: more than twice around the Earth, and more than any projection has."""


class GeometryParts(NamedTuple):
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


def parts_of(geometry: QgsGeometry) -> GeometryParts:
    """Return the parts of ``geometry``: collections opened, rings closed, Z and M dropped.

    A null geometry has no parts.
    """
    parts = GeometryParts([], [], [])
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


# --- The rings of many geometries processed together ---


class RingTable:
    """The rings and lines of n features: the number of points of each, and which features are ``sound``.

    ``points`` is x and y of each ring as bytes of float64. ``counts`` is the number of rings of each feature,
    ``closed`` is true unless they are lines, and ``valid`` where GEOS finds them valid. Sound features need
    neither repair nor note: closed rings of three corners or more that are valid together, lines without
    repeated points, every coordinate finite and on Earth.
    """

    def __init__(
        self, points: Sequence[bytes], counts: Sequence[int], closed: Sequence[bool], valid: Sequence[bool]
    ) -> None:
        of_each, shut = np.array(counts, dtype=np.int64), np.array(closed, dtype=bool)
        self._coordinates = np.frombuffer(b"".join(points), "<f8").reshape(-1, 2)
        self.lengths = np.array(list(map(len, points)), dtype=np.int64) // _POINT_BYTES[0]
        self._first_ring = np.concatenate([[0], np.cumsum(of_each)])
        self._first_point = np.concatenate([[0], np.cumsum(self.lengths)])
        self.sound = (of_each > 0) & np.array(valid, dtype=bool)
        odd = self._odd_rings(np.repeat(shut, of_each))
        self.sound[np.repeat(np.arange(len(of_each)), of_each)[odd]] = False

    def rings(self, first: int, last: int) -> slice:
        """Return the slice of the rings of features ``first`` to ``last``."""
        return slice(int(self._first_ring[first]), int(self._first_ring[last]))

    def coordinates(self, rings: slice) -> np.ndarray:
        """Return the coordinates of some rings, (m, 2)."""
        return self._coordinates[self._first_point[rings.start] : self._first_point[rings.stop]]

    def apart(self, coordinates: np.ndarray, k: int) -> list[np.ndarray]:
        """Return the rings of feature ``k``, cut out of the ``coordinates`` of all."""
        edges = self._first_point[self._first_ring[k] : self._first_ring[k + 1] + 1].tolist()
        return [coordinates[first:last] for first, last in pairwise(edges)]

    def _odd_rings(self, closed: np.ndarray) -> np.ndarray:
        """Return which rings need a closer check; ``closed`` is false for lines."""
        odd: np.ndarray = self.lengths < np.where(closed, 4, 2)
        xy = self._coordinates
        if not len(xy):
            return odd
        last = len(xy) - 1
        starts = np.minimum(self._first_point[:-1], last)
        ends = np.clip(self._first_point[1:] - 1, 0, last)
        odd |= closed & (xy[starts] != xy[ends]).any(axis=1)
        ring = np.repeat(np.arange(len(odd)), self.lengths)
        # NaN then compares as not on Earth either.
        odd[ring[~(np.abs(xy) <= FARTHEST_M).all(axis=1)]] = True
        repeated = (xy[1:] == xy[:-1]).all(axis=1) & (ring[1:] == ring[:-1]) & ~closed[ring[1:]]
        odd[ring[1:][repeated]] = True
        return odd


# --- Repairs of polygons and lines where that is safe, with notes of repairs and failures ---

STRAIGHT_M = 0.02
"""Greatest distance in metres of a riser's middle points from the line between its ends."""


def repair_polygons(polygons: Sequence[list[np.ndarray]]) -> tuple[list[list[np.ndarray]], list[str]]:
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
    # Separately: together, the overlap of two parts would become a hole of both.
    repaired = QgsGeometry.unaryUnion([_as_geometry([polygon]).makeValid() for polygon in kept])
    parts = parts_of(repaired) if not repaired.isNull() else GeometryParts([], [], [])
    if not parts.polygons:
        return [], [*notes, tr("{fault}; it cannot be repaired and is left out", fault=_fault(geometry))]
    return parts.polygons, [*notes, tr("{fault}; it was repaired", fault=_fault(geometry))]


def lines_with_length(lines: Sequence[np.ndarray]) -> tuple[list[np.ndarray], list[str]]:
    """Return lines without repeated points, and a note for each that is a single point and left out."""
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
    in whichever direction it was drawn (paper 1, section II).
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
    """Return whether all points of a closed ring lie on one line; a ring that crosses itself does enclose."""
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
    """Return the first error that GEOS finds, and its place."""
    for error in geometry.validateGeometry(Qgis.GeometryValidationEngine.Geos):
        place = _place(error.where().x(), error.where().y()) if error.hasWhere() else ""
        return tr("the polygon is broken{place}: {what}", place=place, what=error.what())
    return tr("the polygon is broken{place}: {what}", place="", what=geometry.lastError() or tr("not valid"))


# --- The direction that a ramp's surface faces, where its polygon has the heights of its corners ---

NORMAL = "n"
"""The extra of a ramp: the upward unit normal of its surface in the site frame (paper 1, section II)."""


def corner_heights(geometry: QgsGeometry) -> dict[tuple[float, float], float]:
    """Return the Z of each corner (x, y) of ``geometry``; NaN where two Z differ, as at a step."""
    heights: dict[tuple[float, float], float] = {}
    for point in geometry.vertices() if geometry.constGet().is3D() else ():
        z = point.z()
        known = heights.setdefault((point.x(), point.y()), z)
        if known != z:
            heights[point.x(), point.y()] = np.nan
    return heights


def normal_extra(points: np.ndarray, z: np.ndarray, notes: list[str]) -> dict[str, str]:
    """Return the extra of a ramp with outline ``points``, (n, 2) in the site frame, at heights ``z``, (n,).

    There is none without a height for each corner, nor where all are equal: such a polygon was drawn in 3D
    without its heights. A surface that cannot be driven on is reported in ``notes``.
    """
    if not np.isfinite(z).all() or not np.ptp(z):
        return {}
    try:
        return {NORMAL: ramp_normal(np.column_stack([points, z]))}
    except ShapingError:
        notes.append(tr("its corners span no surface that one can drive on; its normal is left out"))
        return {}


# --- From one QGIS geometry to the rings, lines and risers of a robot map ---

SAGITTA_M = 0.02
"""Greatest distance in metres of a chord from its curve."""

NO_PLACE = tr(
    "has a coordinate that is no number, has no place in the site's CRS or lies beyond 100 000 km; "
    "it is left out"
)


class FeatureShape(NamedTuple):
    """One outline: ``points`` is (n, 2) in the geometry's coordinates, rings repeat their first point.

    ``z`` is (n,), the height of each point of a ramp in metres, NaN where the geometry has none.
    """

    points: np.ndarray
    shape_type: ShapeType
    courtyard: bool = False
    z: np.ndarray | None = None

    @property
    def closed(self) -> bool:
        """Whether it is a ring."""
        return bool(len(self.points) > 3 and (self.points[0] == self.points[-1]).all())


class FeatureShapes(NamedTuple):
    """The outlines in a geometry, and a note for each repair or omission."""

    shapes: list[FeatureShape]
    notes: list[str]


def shapes_of(geometry: QgsGeometry, role: str = "") -> FeatureShapes:
    """Return the outlines in ``geometry``, which is in metres, for a layer of ``role``.

    Curves become chords with a sagitta of 2 cm. Rings and lines without extent are left out, a ring that
    crosses itself is repaired, each with an entry in ``notes``. Several lines of a stairs layer are one
    flight, a riser each, bottom first; a single one stays a low wall, as the paper treats a riser.
    """
    curved = geometry.constGet().hasCurvedSegments()
    if curved:
        maximum = QgsAbstractGeometry.SegmentationToleranceType.MaximumDifference
        geometry = QgsGeometry(geometry.constGet().segmentize(SAGITTA_M, maximum))
    parts = parts_of(geometry)
    if not parts.on_earth:
        return FeatureShapes([], [NO_PLACE])
    # Valid as a whole is the rule and quickly checked; GEOS takes a ring without points for valid, too.
    sound = parts.rings_have_points and geometry.isGeosValid()
    polygons, polygon_notes = (parts.polygons, []) if sound else repair_polygons(parts.polygons)
    lines, line_notes = lines_with_length(parts.lines)
    notes = [*parts.notes, *polygon_notes, *line_notes]
    closed = _closed_type(role, curved)
    shapes = [FeatureShape(ring, closed, k > 0) for polygon in polygons for k, ring in enumerate(polygon)]
    if role == RAMP:
        shapes = _with_heights(shapes, geometry)
    if role == STAIRS and len(lines) > 1:
        risers, bent = risers_of(lines)
        return FeatureShapes([*shapes, FeatureShape(risers, ShapeType.STAIRS)], [*notes, *bent])
    opened = ShapeType.OPEN_CURVE if curved else ShapeType.OPEN_POLYGON
    return FeatureShapes([*shapes, *(FeatureShape(line, opened) for line in lines)], notes)


def polygons_of(shapes: Sequence[FeatureShape]) -> list[list[np.ndarray]]:
    """Return the rings of each polygon among ``shapes``, its outer ring first; lines are ignored."""
    polygons: list[list[np.ndarray]] = []
    for shape in shapes:
        if shape.courtyard:
            polygons[-1].append(shape.points)
        elif shape.closed:
            polygons.append([shape.points])
    return polygons


def _with_heights(ramps: list[FeatureShape], geometry: QgsGeometry) -> list[FeatureShape]:
    heights = corner_heights(geometry)
    return [
        ramp._replace(z=np.array([heights.get((x, y), np.nan) for x, y in ramp.points.tolist()]))
        for ramp in ramps
    ]


def _closed_type(role: str, curved: bool) -> ShapeType:
    if role == RAMP:
        return ShapeType.RAMP
    return ShapeType.CLOSED_CURVE if curved else ShapeType.CLOSED_POLYGON
