"""Obstacle layers read into outlines; whatever could not be read as it is becomes a warning."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from qgis.core import QgsFeature, QgsFeedback, QgsGeometry, QgsRectangle, QgsWkbTypes

from ...robot_bridge.robotmap.outlines import OutlineRow, Outlines
from ..language import tr, tr_count
from .feature_filter import FeatureFilter
from .feature_values import FeatureValues
from .layer_rules import LayerRules
from .obstacle_source import ObstacleSource
from .placing import Bounds, LayerPlacing, PlacingError, SitePlacing, widened
from .posts import REACH_M, Posts
from .ramps import normal_extra
from .roles import OBSTACLE_ROLES, RAMP, STAIRS
from .shapes import Shape, Shapes, shapes_of

NAMED = 5
"""How many features a warning about a whole layer names."""

ESTIMATED = {"h": "est"}
"""The extra of an obstacle whose height nobody knows."""


@dataclass
class Reading:
    """What was read: outlines in the site frame, warnings naming layer and feature.

    Rows whose height is the default say so in their ``ext``. ``complete`` is false after a cancel.
    """

    rows: list[OutlineRow] = field(default_factory=list)
    warnings: list[str] = field(default_factory=list)
    complete: bool = True

    def outlines(self) -> Outlines:
        """Return the outlines in the order of layers and features."""
        return Outlines.from_rows(self.rows)


def read_outlines(
    sources: Sequence[ObstacleSource],
    site: SitePlacing,
    window: Bounds | None,
    default_height: float,
    feedback: QgsFeedback,
) -> Reading:
    """Return the outlines of all features whose bounding box touches ``window``, metres in the site frame.

    All features where there is no window.

    Expressions and CRSs of every layer are checked before the first feature is read.

    :raises LayerReadingError: when a layer has no known place on the site or an expression is not one.
    """
    readers = [_LayerReader(source, site, window, default_height) for source in sources]
    total = max(sum(max(source.count, 0) for source in sources), 1)
    reading, done = Reading(), 0
    for reader in readers:
        for feature in reader.source.features.getFeatures():
            if feedback.isCanceled():
                reading.complete = False
                return reading
            reader.read(feature, reading)
            done += 1
            feedback.setProgress(90.0 * done / total)
        reader.finish(reading)
    return reading


def check_sources(sources: Sequence[ObstacleSource], site: SitePlacing) -> None:
    """Raise :class:`LayerReadingError` for what :func:`read_outlines` would refuse, without reading."""
    for source in sources:
        _LayerReader(source, site, (0.0, 0.0, 1.0, 1.0), 0.0)


class _LayerReader:
    """Reads the features of one layer into a :class:`Reading`."""

    def __init__(
        self, source: ObstacleSource, site: SitePlacing, window: Bounds | None, default_height: float
    ):
        self.source = source
        self._default_height = default_height
        self._filter = FeatureFilter(source.name, source.fields, source.expressions.filter, source.context)
        self._rules = LayerRules(source.name, source.fields, source.context)
        self._values = FeatureValues(
            source.name, source.role, source.expressions, default_height, self._rules
        )
        self._posts = Posts(self._rules, source.expressions)
        self._placing: LayerPlacing = site.of_layer(source.name, source.crs)
        self._window = window
        self._area = self._placing.area_of(window) if window else None
        self._around = self._placing.area_of(widened(window, REACH_M)) if window else None
        self._unknown: list[int] = []
        self._odd_for_role: list[int] = []

    def read(self, feature: QgsFeature, reading: Reading) -> None:
        """Add the outlines of ``feature`` if it counts, or a warning why there are none."""
        doubts: list[str] = []
        if not self._filter.keeps(feature, doubts):
            reading.warnings.extend(self._named(feature, doubt) for doubt in doubts)
            return
        geometry = feature.geometry()
        if geometry.isNull() or geometry.isEmpty():
            reading.warnings.append(self._named(feature, tr("has no geometry; it is left out")))
            return
        is_points = geometry.type() == QgsWkbTypes.GeometryType.PointGeometry
        if not _may_touch(geometry.boundingBox(), self._around if is_points else self._area):
            return
        try:
            metres = self._placing.to_metres(geometry)
            shapes, notes = (
                self._posts_in(feature, metres) if is_points else shapes_of(metres, self.source.role)
            )
        except PlacingError as error:
            shapes, notes = (
                [],
                [tr("cannot be transformed into the site's CRS ({error}); it is left out", error=error)],
            )
        if shapes:
            notes = [*notes, *self._add(feature, shapes, reading)]
        reading.warnings.extend(self._named(feature, note) for note in notes)

    def finish(self, reading: Reading) -> None:
        """Add the warnings that are about the layer as a whole."""
        name, role = self.source.name, self.source.role
        reading.warnings.extend(self._rules.warnings)
        if role and role not in OBSTACLE_ROLES:
            reading.warnings.append(
                tr("Layer {name}: its role is {role}, yet it is exported as obstacles", name=name, role=role)
            )
        if self._unknown:
            reading.warnings.append(
                tr_count(
                    len(self._unknown),
                    "Layer {name}: 1 height is not known and estimated as {height:g} m ({features})",
                    "Layer {name}: %n heights are not known and estimated as {height:g} m ({features})",
                    name=name,
                    height=self._default_height,
                    features=_features(self._unknown),
                )
            )
        if self._odd_for_role:
            wanted = tr("lines, one a riser") if role == STAIRS else tr("polygons")
            reading.warnings.append(
                tr(
                    "Layer {name}: its role {role} wants {wanted}; other features are exported as plain "
                    "obstacles ({features})",
                    name=name,
                    role=role,
                    wanted=wanted,
                    features=_features(self._odd_for_role),
                )
            )

    def _posts_in(self, feature: QgsFeature, points: QgsGeometry) -> Shapes:
        """Return the shapes of ``points``; nothing where none of them reaches into the window."""
        posts = self._posts.of(feature, points)
        reaching = any(self._reaches_in(self._placing.to_site(post.points)) for post in posts.shapes)
        return posts if reaching or not posts.shapes else Shapes([], [])

    def _reaches_in(self, points: np.ndarray) -> bool:
        if self._window is None:
            return True
        x_min, y_min, x_max, y_max = self._window
        return bool(
            (points.max(axis=0) >= (x_min, y_min)).all() and (points.min(axis=0) <= (x_max, y_max)).all()
        )

    def _add(self, feature: QgsFeature, shapes: Sequence[Shape], reading: Reading) -> list[str]:
        source = f"{self.source.name}:{feature.id()}"
        values = self._values.of(feature)
        if values.unknown:
            self._unknown.append(feature.id())
        if any(_odd(shape, self.source.role) for shape in shapes):
            self._odd_for_role.append(feature.id())
        notes, ext = list(values.notes), {}
        for shape in shapes:
            points = self._placing.to_site(shape.points)
            if not shape.courtyard:
                # A courtyard is in the surface of the ring around it and says the same.
                ext = _extras(shape, points, values.estimated, notes)
            reading.rows.append(
                OutlineRow(
                    points=points,
                    shape_type=shape.shape_type,
                    height=values.height,
                    semantics=values.semantics,
                    source=source,
                    courtyard=shape.courtyard,
                    outdoor=values.outdoor,
                    base=values.base,
                    ext=ext,
                )
            )
        return notes

    def _named(self, feature: QgsFeature, note: str) -> str:
        return tr("Layer {layer}, feature {id}: {note}", layer=self.source.name, id=feature.id(), note=note)


def _may_touch(box: QgsRectangle, area: QgsRectangle | None) -> bool:
    """Tell whether a feature with this bounding box must be looked at."""
    if area is None or box.isNull() or not box.isFinite():
        return True
    return area.intersects(box)


def _extras(shape: Shape, points: np.ndarray, estimated: bool, notes: list[str]) -> dict[str, str]:
    """Return what else ``shape`` has to say, whose ``points`` are (n, 2) in the site frame."""
    if shape.z is not None:
        return normal_extra(points, shape.z, notes)
    return dict(ESTIMATED) if estimated else {}


def _odd(shape: Shape, role: str) -> bool:
    """Tell whether a layer of ``role`` should not hold this shape."""
    return (role == STAIRS and shape.closed) or (role == RAMP and not shape.closed)


def _features(ids: Sequence[int]) -> str:
    shown = ", ".join(str(number) for number in ids[:NAMED])
    if len(ids) > NAMED:
        return tr("features {shown} and {more} more", shown=shown, more=len(ids) - NAMED)
    return tr("features {shown}", shown=shown) if len(ids) > 1 else tr("feature {shown}", shown=shown)
