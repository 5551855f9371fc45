"""Obstacle layers read into outlines, with a warning for everything that could not be read unchanged."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from itertools import chain, pairwise, repeat
from typing import Any

import numpy as np
from qgis.core import QgsFeature, QgsFeatureRequest, QgsFeedback, QgsGeometry, QgsWkbTypes

from ...robot_bridge.core.errors import ShapingError
from ...robot_bridge.core.robotmap.model import ShapeType
from ...robot_bridge.core.robotmap.outlines import OutlineRow, Outlines
from ...robot_bridge.core.robotmap.parametric_shapes import Template, template
from ..ui.language import tr, tr_count
from .geometry import (
    NO_PLACE,
    FeatureShape,
    FeatureShapes,
    Rings,
    RingTable,
    are_points,
    geometry_of,
    normal_extra,
    rings_of,
    shapes_of,
)
from .layer_expressions import UNKNOWN, FeatureFilter, FeatureValues, LayerRules, Memory, ObstacleValues
from .layer_source import (
    FeatureWarnings,
    ObstacleSource,
    SomeFeatures,
    check_readable,
    count_stored,
    without_geometry,
)
from .reading import begin_reading
from .roles import OBSTACLE_ROLES, RAMP, STAIRS, LayerExpressions
from .site_transform import Bounds, LayerToSiteTransform, SiteGeoreference, SiteTransformError, widen_bounds

# --- Furniture drawn as points: the small closed shape that each stands for ---

POST_ACROSS_M = 0.5
"""Width in metres of a piece of furniture drawn as a point without a size."""

REACH_M = 100.0
"""Greatest extent of a point's shape from it: a triangle around the largest circle allowed."""


class PointObstacles:
    """Makes shapes of points by the expressions of one layer: from a template, else an octagon of a width.

    :raises ExpressionError: when one of the expressions is invalid.
    """

    def __init__(self, rules: LayerRules, expressions: LayerExpressions):
        self._rules = rules
        self._width = rules.rule("width", expressions.width)
        self._template = rules.rule("template", expressions.template)
        self._rotation = rules.rule("rotation", expressions.rotation)
        self._memory = Memory([self._width, self._template, self._rotation])

    def of(self, feature: QgsFeature, points: QgsGeometry) -> FeatureShapes:
        """Return a shape around each of ``points``, the geometry of ``feature`` in metres.

        ``rotation`` turns it clockwise, so that a heading turns a shape facing north to face there.
        """
        places = _places(points)
        if not all(map(math.isfinite, chain.from_iterable(places))):
            return FeatureShapes([], [NO_PLACE])
        self._rules.at(feature)
        known, key = self._rules.known(self._memory)
        if known is UNKNOWN:
            notes: list[str] = []
            made = self._named(notes) or self._round(notes)
            known = made.turned(-math.radians(self._degrees(notes))), notes
            self._memory.keep(key, known)
        made, notes = known
        return FeatureShapes(
            [FeatureShape(made.at(x, y), ShapeType.CLOSED_POLYGON) for x, y in places], list(notes)
        )

    def _named(self, notes: list[str]) -> Template | None:
        value = self._rules.value("template", self._template, notes)
        if value is None or not str(value).strip():
            return None
        try:
            return template(str(value))
        except ShapingError as error:
            notes.append(tr("{error}; its width is used", error=error))
            return None

    def _round(self, notes: list[str]) -> Template:
        width = self._rules.metres("width", self._width, notes)
        try:
            return template(f"circle {POST_ACROSS_M if width is None else width}")
        except ShapingError:
            notes.append(
                tr(
                    "its width {width:g} m is none of furniture; {used:g} is used",
                    width=width,
                    used=POST_ACROSS_M,
                )
            )
            return template(f"circle {POST_ACROSS_M}")

    def _degrees(self, notes: list[str]) -> float:
        value = self._rules.value("rotation", self._rotation, notes)
        if value is None or value == "":
            return 0.0
        try:
            degrees = float(str(value).strip().rstrip("°"))
        except ValueError:
            degrees = math.nan
        if not math.isfinite(degrees):
            notes.append(
                tr("its rotation {value!r} is not a number of degrees; it is not turned", value=value)
            )
            return 0.0
        return degrees


def _places(points: QgsGeometry) -> list[tuple[float, float]]:
    some = points.vertices() if points.isMultipart() else [points.asPoint()]
    return [(point.x(), point.y()) for point in some]


# --- Features of one obstacle layer converted to outlines, many at a time ---

ESTIMATED = {"h": "est"}
"""The extra of an obstacle of unknown height."""

_NOTHING: dict[str, str] = {}


class OutlineBatch:
    """Makes the outlines of the layer ``name`` with ``role``; warns of repairs and omissions.

    ``unknown`` are features of unknown height, ``odd_for_role`` those unexpected in a layer of that
    role.
    """

    def __init__(
        self, name: str, role: str, placing: LayerToSiteTransform, warnings: FeatureWarnings
    ) -> None:
        self._name, self._role, self._placing, self._warnings = name, role, placing, warnings
        # Ramps need their corners' heights, stairs their risers in order.
        self._is_plain = role not in (RAMP, STAIRS)
        self._features = _FeatureColumns()
        self.unknown = SomeFeatures()
        self.odd_for_role = SomeFeatures()

    def __len__(self) -> int:
        """Return the number of features waiting until their outlines are requested."""
        return len(self._features.ids)

    def add(self, id: int, wkb: bytes, geometry: QgsGeometry, values: ObstacleValues) -> None:
        """Add a feature that counts: its geometry in metres, also as ``wkb``, and its values."""
        rings = rings_of(wkb) if self._is_plain else None
        is_valid = rings is not None and (not rings.closed or geometry.isGeosValid())
        self._features.add(id, wkb, rings or _NO_RINGS, is_valid, values)

    def add_shapes(self, id: int, shapes: Sequence[FeatureShape], values: ObstacleValues) -> None:
        """Add a feature whose geometry was converted to closed ``shapes``, such as the template of a point.

        Its notes are in ``values``.
        """
        rings = Rings([shape.points.tobytes() for shape in shapes], [False] * len(shapes), True)
        self._features.add(id, b"", rings, True, values)

    def outlines(self) -> Iterator[Outlines]:
        """Yield the outlines of the features added, in order, and forget them.

        Sound lines and polygons together, which is quick; each of the others separately.
        """
        features, self._features = self._features, _FeatureColumns()
        if not features.ids:
            return
        table = RingTable(features.points, features.counts, features.closed, features.valid)
        changes = np.flatnonzero(table.sound[1:] != table.sound[:-1]) + 1
        edges = [0, *changes.tolist(), len(features.ids)]
        for first, last in pairwise(edges):
            if table.sound[first]:
                yield self._together(features, table, first, last)
            else:
                rows = [row for k in range(first, last) for row in self._one_by_one(features, table, k)]
                if rows:
                    yield Outlines.from_rows(rows)

    def _together(self, features: _FeatureColumns, table: RingTable, first: int, last: int) -> Outlines:
        ids, values = features.ids[first:last], features.values[first:last]
        closed, counts = features.closed[first:last], features.counts[first:last]
        for id, one in zip(ids, values, strict=True):
            if one.unknown:
                self.unknown.add(id)
            for note in one.notes:
                self._warnings.add(self._name, id, note)
        base = np.repeat([one.base for one in values], counts)
        rings = table.rings(first, last)
        coordinates, lengths = table.coordinates(rings), table.lengths[rings]
        offsets = np.concatenate([[0], np.cumsum(lengths)])
        points = np.array(self._placing.to_site(coordinates))
        # The frame may place the two ends of a ring a rounding error apart.
        shut = np.flatnonzero(np.repeat(closed, counts))
        points[offsets[shut + 1] - 1] = points[offsets[shut]]
        kinds = np.where(closed, int(ShapeType.CLOSED_POLYGON), int(ShapeType.OPEN_POLYGON))
        extras = [ESTIMATED if one.estimated else _NOTHING for one in values]
        return Outlines(
            coordinates=points,
            offsets=offsets,
            shape_type=np.repeat(kinds, counts).astype(np.int8),
            courtyard=np.array(features.inner[rings]),
            height=np.repeat([one.height for one in values], counts),
            outdoor=np.repeat([one.outdoor for one in values], counts),
            semantics=_repeated([one.semantics for one in values], counts),
            source=_repeated([f"{self._name}:{id}" for id in ids], counts),
            base=base if base.any() else None,
            ext=_repeated(extras, counts) if any(extras) else None,
        )

    def _one_by_one(self, features: _FeatureColumns, table: RingTable, k: int) -> list[OutlineRow]:
        id, values = features.ids[k], features.values[k]
        notes = list(values.notes)
        if features.wkb[k]:
            shapes, found = shapes_of(geometry_of(features.wkb[k]), self._role)
            notes = [*found, *(notes if shapes else [])]
        else:
            rings = features.points[table.rings(k, k + 1)]
            points = [np.frombuffer(ring, "<f8").reshape(-1, 2) for ring in rings]
            shapes = [FeatureShape(ring, ShapeType.CLOSED_POLYGON) for ring in points]
        rows = self._rows(id, values, shapes, notes) if shapes else []
        for note in notes:
            self._warnings.add(self._name, id, note)
        return rows

    def _rows(
        self, id: int, values: ObstacleValues, shapes: Sequence[FeatureShape], notes: list[str]
    ) -> list[OutlineRow]:
        if values.unknown:
            self.unknown.add(id)
        if any(_odd(shape, self._role) for shape in shapes):
            self.odd_for_role.add(id)
        rows: list[OutlineRow] = []
        ext: dict[str, str] = {}
        for shape in shapes:
            points = np.array(self._placing.to_site(shape.points))
            if shape.closed:
                points[-1] = points[0]
            if not shape.courtyard:
                # A courtyard is in the surface of the ring around it and has the same values.
                ext = _extras(shape, points, values.estimated, notes)
            rows.append(
                OutlineRow(
                    points=points,
                    shape_type=shape.shape_type,
                    height=values.height,
                    semantics=values.semantics,
                    source=f"{self._name}:{id}",
                    courtyard=shape.courtyard,
                    outdoor=values.outdoor,
                    base=values.base,
                    ext=ext,
                )
            )
        return rows


_NO_RINGS = Rings([], [], True)


class _FeatureColumns:
    """Features that count, a list for each of their properties.

    No object per feature: with ever more of them that hold others, Python's garbage collector would
    scan all of them again and again.
    """

    def __init__(self) -> None:
        self.ids: list[int] = []
        self.wkb: list[bytes] = []
        """Their geometries in metres, empty where there are only rings."""
        self.valid: list[bool] = []
        """Whether GEOS finds the rings valid."""
        self.values: list[ObstacleValues] = []
        self.closed: list[bool] = []
        self.counts: list[int] = []
        """The number of rings or lines of each; ``points`` and ``inner`` have those of all."""
        self.points: list[bytes] = []
        self.inner: list[bool] = []

    def add(self, id: int, wkb: bytes, rings: Rings, is_valid: bool, values: ObstacleValues) -> None:
        self.ids.append(id)
        self.wkb.append(wkb)
        self.valid.append(is_valid)
        self.values.append(values)
        self.closed.append(rings.closed)
        self.counts.append(len(rings.points))
        self.points += rings.points
        self.inner += rings.inner


def _repeated(values: Sequence[Any], counts: Sequence[int]) -> list[Any]:
    return list(chain.from_iterable(map(repeat, values, counts)))


def _extras(shape: FeatureShape, points: np.ndarray, estimated: bool, notes: list[str]) -> dict[str, str]:
    """Return the extras of ``shape``, whose ``points`` are (n, 2) in the site frame."""
    if shape.z is not None:
        return normal_extra(points, shape.z, notes)
    return dict(ESTIMATED) if estimated else {}


def _odd(shape: FeatureShape, role: str) -> bool:
    """Return whether this shape is unexpected in a layer of ``role``."""
    return (role == STAIRS and shape.closed) or (role == RAMP and not shape.closed)


# --- Obstacle layers read into outlines; everything that could not be read unchanged becomes a warning ---

TOGETHER = 2000
"""Features converted to outlines at a time: few enough for memory, enough for speed."""
NO_GEOMETRY = tr("has no geometry; it is left out")


@dataclass
class ObstacleReading:
    """The result of reading: outlines in the site frame, warnings naming layer and feature.

    Outlines with the default height are marked in their ``ext``. ``complete`` is false if cancelled.
    """

    parts: list[Outlines] = field(default_factory=list)
    warnings: list[str] = field(default_factory=list)
    complete: bool = True

    @property
    def rows(self) -> list[OutlineRow]:
        """The outlines one by one, in the order of layers and features."""
        return [row for part in self.parts for row in part.rows()]

    def outlines(self) -> Outlines:
        """Return the outlines in the order of layers and features."""
        return Outlines.joined(self.parts)


def read_outlines(
    sources: Sequence[ObstacleSource],
    site: SiteGeoreference,
    window: Bounds | None,
    default_height: float,
    feedback: QgsFeedback,
) -> ObstacleReading:
    """Return the outlines of all features whose bounding box touches ``window``, metres in the site frame.

    Without a window, those of all features.

    Expressions and CRSs of every layer are checked before the first feature is read.

    :raises LayerReadingError: when a layer has no known place on the site or an expression is not one.
    """
    reader = ObstacleReader(sources, site, window, default_height)
    parts = list(reader.parts(feedback))
    return ObstacleReading(parts, reader.warnings.texts(), reader.complete)


def check_sources(sources: Sequence[ObstacleSource], site: SiteGeoreference) -> None:
    """Raise :class:`LayerReadingError` for what :func:`read_outlines` would refuse, without reading."""
    ObstacleReader(sources, site, (0.0, 0.0, 1.0, 1.0), 0.0)


class ObstacleReader:
    """Reads like :func:`read_outlines`, and keeps nothing of the results but ``warnings``.

    ``complete`` is false if cancelled.
    """

    def __init__(
        self,
        sources: Sequence[ObstacleSource],
        site: SiteGeoreference,
        window: Bounds | None,
        default_height: float,
    ) -> None:
        self.warnings = FeatureWarnings()
        self.complete = True
        self._layers = [
            _LayerReader(source, site, window, default_height, self.warnings) for source in sources
        ]

    def parts(self, feedback: QgsFeedback) -> Iterator[Outlines]:
        """Yield the outlines, of some features at a time, in the order of layers and features."""
        total = max(sum(max(count_stored(layer.source), 0) for layer in self._layers), 1)
        step, done = max(total // 1000, 1), 0
        for layer in self._layers:
            for feature in layer.features():
                if feedback.isCanceled():
                    self.complete = False
                    return
                layer.read(feature)
                done += 1
                if done % step == 0:
                    feedback.setProgress(90.0 * done / total)
                if layer.waiting >= TOGETHER:
                    yield from layer.outlines()
            yield from layer.outlines()
            layer.finish()


class _LayerReader:
    """Reads the features of one layer, and keeps them until their outlines are requested."""

    def __init__(
        self,
        source: ObstacleSource,
        site: SiteGeoreference,
        window: Bounds | None,
        default_height: float,
        warnings: FeatureWarnings,
    ):
        self.source = source
        self._default_height = default_height
        self._warnings = warnings
        self._filter = FeatureFilter(source.name, source.fields, source.expressions.filter, source.context)
        self._rules = LayerRules(source.name, source.fields, source.context)
        self._values = FeatureValues(
            source.name, source.role, source.expressions, default_height, self._rules
        )
        self._posts = PointObstacles(self._rules, source.expressions)
        self._placing: LayerToSiteTransform = site.of_layer(source.name, source.crs)
        self._window = window
        self._area = self._placing.area_of(window) if window else None
        self._around = self._placing.area_of(widen_bounds(window, REACH_M)) if window else None
        self._batch = OutlineBatch(source.name, source.role, self._placing, warnings)

    @property
    def waiting(self) -> int:
        """The number of features read whose outlines were not requested."""
        return len(self._batch)

    def features(self) -> Iterator[QgsFeature]:
        """Yield the features that may touch the window, and those without a geometry.

        By the layer's own index: most of a city is nowhere near a window. All features where the window
        cannot be expressed in the layer's CRS.
        """
        request = QgsFeatureRequest()
        if self._around is not None:
            yield from without_geometry(self.source)
            request.setFilterRect(self._around)
        begin_reading()
        yield from self.source.features.getFeatures(request)

    def read(self, feature: QgsFeature) -> None:
        """Keep ``feature`` if it counts, or a warning why nothing of it is read."""
        doubts: list[str] = []
        if not self._filter.keeps(feature, doubts):
            self._warn(feature, doubts)
            return
        geometry = feature.geometry()
        if geometry.isEmpty():
            self._warn(feature, [NO_GEOMETRY])
            return
        if self._area is not None and not self._may_touch(geometry):
            return
        try:
            metres = self._placing.to_metres(geometry)
        except SiteTransformError as error:
            note = tr("cannot be transformed into the site's CRS ({error}); it is left out", error=error)
            self._warn(feature, [note])
            return
        values = self._values.of(feature)
        wkb = metres.asWkb().data()
        if not are_points(wkb):
            self._batch.add(feature.id(), wkb, metres, values)
            return
        shapes, notes = self._posts_in(feature, metres)
        if notes or not shapes:
            values = values._replace(notes=[*notes, *(values.notes if shapes else [])])
        self._batch.add_shapes(feature.id(), shapes, values)

    def outlines(self) -> Iterator[Outlines]:
        """Yield the outlines of the features that wait."""
        yield from self._batch.outlines()

    def finish(self) -> None:
        """Add the warnings about the layer as a whole.

        :raises LayerTypeError: when it can no longer be read.
        """
        check_readable(self.source)
        name, role = self.source.name, self.source.role
        for warning in (*self._placing.doubts(name), *self._rules.warnings):
            self._warnings.add_text(warning)
        if role and role not in OBSTACLE_ROLES:
            self._warnings.add_text(
                tr("Layer {name}: its role is {role}, yet it is exported as obstacles", name=name, role=role)
            )
        if self._batch.unknown.count:
            self._warnings.add_text(
                tr_count(
                    self._batch.unknown.count,
                    "Layer {name}: 1 height is not known and estimated as {height:g} m ({features})",
                    "Layer {name}: %n heights are not known and estimated as {height:g} m ({features})",
                    name=name,
                    height=self._default_height,
                    features=self._batch.unknown,
                )
            )
        if self._batch.odd_for_role.count:
            wanted = tr("lines, one a riser") if role == STAIRS else tr("polygons")
            self._warnings.add_text(
                tr(
                    "Layer {name}: its role {role} wants {wanted}; other features are exported as plain "
                    "obstacles ({features})",
                    name=name,
                    role=role,
                    wanted=wanted,
                    features=self._batch.odd_for_role,
                )
            )

    def _may_touch(self, geometry: QgsGeometry) -> bool:
        """Return whether a feature of ``geometry`` must be processed, if there is a window."""
        area = self._around if _is_points(geometry) else self._area
        box = geometry.boundingBox()
        return area is None or box.isNull() or not box.isFinite() or area.intersects(box)

    def _posts_in(self, feature: QgsFeature, points: QgsGeometry) -> FeatureShapes:
        """Return the shapes of ``points``; empty where none of them reaches into the window."""
        posts = self._posts.of(feature, points)
        if self._window is None:
            return posts
        reaching = any(self._reaches_in(self._placing.to_site(post.points)) for post in posts.shapes)
        return posts if reaching or not posts.shapes else FeatureShapes([], [])

    def _reaches_in(self, points: np.ndarray) -> bool:
        if self._window is None:
            return True
        x_min, y_min, x_max, y_max = self._window
        return bool(
            (points.max(axis=0) >= (x_min, y_min)).all() and (points.min(axis=0) <= (x_max, y_max)).all()
        )

    def _warn(self, feature: QgsFeature, notes: Sequence[str]) -> None:
        for note in notes:
            self._warnings.add(self.source.name, feature.id(), note)


def _is_points(geometry: QgsGeometry) -> bool:
    return bool(geometry.type() == QgsWkbTypes.GeometryType.PointGeometry)
