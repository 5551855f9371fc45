"""Obstacle layers read into outlines; whatever could not be read as it is becomes a warning."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field

import numpy as np
from qgis.core import (
    QgsFeature,
    QgsFeatureRequest,
    QgsFeedback,
    QgsGeometry,
    QgsWkbTypes,
)

from ...robot_bridge.robotmap.outlines import OutlineRow, Outlines
from ..language import tr, tr_count
from .feature_filter import FeatureFilter
from .feature_values import FeatureValues
from .feature_warnings import FeatureWarnings
from .layer_rules import LayerRules
from .missing_geometry import without_geometry
from .obstacle_source import ObstacleSource
from .outline_batch import OutlineBatch, ReadFeature
from .placing import Bounds, LayerPlacing, PlacingError, SitePlacing, widened
from .posts import REACH_M, Posts
from .roles import OBSTACLE_ROLES, RAMP, STAIRS
from .shapes import Shape, Shapes
from .wkb import Rings, rings_of

TOGETHER = 2000
"""Features made into outlines at a time: few enough to keep, enough to be quick."""
NO_GEOMETRY = tr("has no geometry; it is left out")


@dataclass
class Reading:
    """What was read: outlines in the site frame, warnings naming layer and feature.

    Outlines whose height is the default say so in their ``ext``. ``complete`` is false after a cancel.
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
    reader = ObstacleReader(sources, site, window, default_height)
    parts = list(reader.parts(feedback))
    return Reading(parts, reader.warnings.texts(), reader.complete)


def check_sources(sources: Sequence[ObstacleSource], site: SitePlacing) -> None:
    """Raise :class:`LayerReadingError` for what :func:`read_outlines` would refuse, without reading."""
    ObstacleReader(sources, site, (0.0, 0.0, 1.0, 1.0), 0.0)


class ObstacleReader:
    """Reads as :func:`read_outlines`, and keeps nothing of what it has read but ``warnings``.

    ``complete`` is false after a cancel.
    """

    def __init__(
        self,
        sources: Sequence[ObstacleSource],
        site: SitePlacing,
        window: Bounds | None,
        default_height: float,
    ) -> None:
        self.warnings = FeatureWarnings()
        self.complete = True
        self._layers = [
            _LayerReader(source, site, window, default_height, self.warnings) for source in sources
        ]

    def parts(self, feedback: QgsFeedback) -> Iterator[Outlines]:
        """Yield the outlines, some features' at a time, in the order of layers and features."""
        total = max(sum(max(layer.source.count, 0) for layer in self._layers), 1)
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
    """Reads the features of one layer, and keeps them until their outlines are asked for."""

    def __init__(
        self,
        source: ObstacleSource,
        site: SitePlacing,
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
        self._posts = Posts(self._rules, source.expressions)
        self._placing: LayerPlacing = site.of_layer(source.name, source.crs)
        # Ramps need their corners' heights, stairs their risers in order.
        self._is_plain = source.role not in (RAMP, STAIRS)
        self._window = window
        self._area = self._placing.area_of(window) if window else None
        self._around = self._placing.area_of(widened(window, REACH_M)) if window else None
        self._batch = OutlineBatch(source.name, source.role, self._placing, warnings)
        self._read: list[ReadFeature] = []

    @property
    def waiting(self) -> int:
        """How many features are read whose outlines nobody has asked for."""
        return len(self._read)

    def features(self) -> Iterator[QgsFeature]:
        """Yield the features that may touch the window, and those that are nowhere.

        By the layer's own index: most of a city is nowhere near a window. All features where the window has
        no place in the layer.
        """
        request = QgsFeatureRequest()
        if self._around is not None:
            yield from without_geometry(self.source)
            request.setFilterRect(self._around)
        yield from self.source.features.getFeatures(request)

    def read(self, feature: QgsFeature) -> None:
        """Keep ``feature`` if it counts, or a warning why there is nothing of it."""
        doubts: list[str] = []
        if not self._filter.keeps(feature, doubts):
            self._warn(feature, doubts)
            return
        geometry = feature.geometry()
        if geometry.isNull() or geometry.isEmpty():
            self._warn(feature, [NO_GEOMETRY])
            return
        if self._area is not None and not self._may_touch(geometry):
            return
        try:
            metres = self._placing.to_metres(geometry)
        except PlacingError as error:
            note = tr("cannot be transformed into the site's CRS ({error}); it is left out", error=error)
            self._warn(feature, [note])
            return
        values = self._values.of(feature)
        rings, shapes = rings_of(metres.asWkb().data()) if self._is_plain else None, None
        if rings is None and _is_points(geometry):
            shapes, notes = self._posts_in(feature, metres)
            rings = _rings(shapes)
            values = values._replace(notes=[*notes, *(values.notes if shapes else [])])
        self._read.append(ReadFeature(feature.id(), metres, rings, shapes, values))

    def outlines(self) -> Iterator[Outlines]:
        """Yield the outlines of the features that wait."""
        read, self._read = self._read, []
        yield from self._batch.outlines(read)

    def finish(self) -> None:
        """Add the warnings that are about the layer as a whole."""
        name, role = self.source.name, self.source.role
        for warning in self._rules.warnings:
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
        """Tell whether a feature of ``geometry`` must be looked at, where there is a window."""
        area = self._around if _is_points(geometry) else self._area
        box = geometry.boundingBox()
        return area is None or box.isNull() or not box.isFinite() or area.intersects(box)

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

    def _warn(self, feature: QgsFeature, notes: Sequence[str]) -> None:
        for note in notes:
            self._warnings.add(self.source.name, feature.id(), note)


def _rings(posts: Sequence[Shape]) -> Rings:
    return Rings([post.points.tobytes() for post in posts], [False] * len(posts), True)


def _is_points(geometry: QgsGeometry) -> bool:
    return bool(geometry.type() == QgsWkbTypes.GeometryType.PointGeometry)
