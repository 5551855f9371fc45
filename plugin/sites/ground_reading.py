"""Road centrelines, road surfaces and keepouts read from their layers into plain arrays."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from typing import Generic, TypeVar

import numpy as np
from qgis.core import QgsAbstractGeometry, QgsFeature, QgsFeedback, QgsGeometry

from ...robot_bridge.roads.centrelines import DEFAULT_SPEED
from ...robot_bridge.roads.surfaces.surface import DRAWN, GENERATED, Surface
from ...robot_bridge.sites.features import Area, Centreline
from ..language import tr
from .feature_filter import FeatureFilter
from .feature_warnings import FeatureWarnings, SomeFeatures
from .layer_rules import LayerRules
from .obstacle_source import ObstacleSource
from .parts import Parts, parts_of
from .placing import LayerPlacing, SitePlacing
from .road_attributes import WIDTH_FIELDS, RoadExpressions, RoadRules
from .roles import KEEPOUT, ROAD_CENTRELINE, ROAD_SURFACE
from .shapes import NO_PLACE, SAGITTA_M, polygons_of, shapes_of
from .soundness import lines_with_length
from .wkb import rings_of

DEFAULT_WIDTH_M = 3.5
"""The width of a road where none is known: one lane."""

LABEL_FIELDS = {ROAD_CENTRELINE: "surface", ROAD_SURFACE: "surface", KEEPOUT: "name"}
"""The field that labels a feature of each role where no expression does."""

# Named, not given: typing remembers variables, and would keep the classes of a plugin that was unloaded.
Item = TypeVar("Item", bound="Centreline | Area | Surface")


@dataclass
class GroundReading(Generic[Item]):
    """What was read, in the site frame, and what is to be warned of, by layer and feature.

    ``complete`` is false after a cancel.
    """

    items: list[Item] = field(default_factory=list)
    notes: FeatureWarnings = field(default_factory=FeatureWarnings)
    complete: bool = True

    @property
    def warnings(self) -> list[str]:
        """The warnings, naming layer and feature."""
        return self.notes.texts()

    def note_layer(self, warnings: Sequence[str]) -> None:
        """Add warnings about a layer as a whole."""
        for warning in warnings:
            self.notes.add_text(warning)


def read_centrelines(
    sources: Sequence[ObstacleSource], site: SitePlacing, default_width: float, feedback: QgsFeedback
) -> GroundReading[Centreline]:
    """Return the roads of layers of lines; what is no line is left out with a warning.

    :raises LayerReadingError: when a layer has no known place on the site or an expression is not one.
    """
    reading: GroundReading[Centreline] = GroundReading()
    reading.items += each_centreline(sources, site, default_width, reading, feedback)
    return reading


def each_centreline(
    sources: Sequence[ObstacleSource],
    site: SitePlacing,
    default_width: float,
    reading: GroundReading[Centreline],
    feedback: QgsFeedback,
) -> Iterator[Centreline]:
    """Yield what :func:`read_centrelines` returns; ``reading`` gets the warnings and no items."""
    for source in sources:
        unknown = SomeFeatures()
        layer = _GroundLayer(source, site, ROAD_CENTRELINE)
        yield from _roads(layer, default_width, unknown, reading, feedback)
        if unknown.count:
            reading.notes.add_text(
                tr(
                    "Layer {layer}: the width of {count} of its roads is not known and taken as "
                    "{width:g} m (feature {first} is the first)",
                    layer=source.name,
                    count=unknown.count,
                    width=default_width,
                    first=unknown.first[0],
                )
            )


def _roads(
    layer: _GroundLayer,
    default_width: float,
    unknown: SomeFeatures,
    reading: GroundReading[Centreline],
    feedback: QgsFeedback,
) -> Iterator[Centreline]:
    """Yield the roads of one layer; ``unknown`` gets the features whose width is not known."""
    given = layer.source.expressions.width or layer.rules.column(*WIDTH_FIELDS)
    width = layer.rules.rule("width", given)
    roads = RoadRules(layer.rules, RoadExpressions())
    for feature, geometry in layer.features(reading, feedback):
        notes: list[str] = []
        metres = layer.rules.metres("width", width, notes)
        if metres is None:
            unknown.add(feature.id())
        lines = lines_of(geometry, notes)
        label = layer.label(feature, notes)
        traffic = roads.traffic(notes)
        layer.note(feature, notes, reading)
        for line in lines:
            yield Centreline(
                layer.placing.to_site(line),
                metres or default_width,
                label,
                direction=traffic.direction,
                speed_ms=traffic.speed or DEFAULT_SPEED,
                closed=traffic.closed,
                level=traffic.level,
            )
    reading.note_layer(layer.rules.warnings)


def read_areas(
    sources: Sequence[ObstacleSource], site: SitePlacing, role: str, feedback: QgsFeedback
) -> GroundReading[Area]:
    """Return the polygons of layers of ``role``; what is no polygon is left out with a warning.

    :raises LayerReadingError: as :func:`read_centrelines`.
    """
    reading: GroundReading[Area] = GroundReading()
    reading.items += each_area(sources, site, role, reading, feedback)
    return reading


def each_area(
    sources: Sequence[ObstacleSource],
    site: SitePlacing,
    role: str,
    reading: GroundReading[Area],
    feedback: QgsFeedback,
) -> Iterator[Area]:
    """Yield what :func:`read_areas` returns; ``reading`` gets the warnings and no items."""
    for source in sources:
        layer = _GroundLayer(source, site, role)
        for rings, label in _polygons(layer, reading, feedback):
            yield Area(rings, label)
        reading.note_layer(layer.rules.warnings)


def read_surfaces(
    sources: Sequence[ObstacleSource], site: SitePlacing, feedback: QgsFeedback
) -> GroundReading[Surface]:
    """Return the road surfaces of layers of polygons, with their fields ``name`` and ``origin``.

    What does not say that it was generated was drawn.

    :raises LayerReadingError: as :func:`read_centrelines`.
    """
    reading: GroundReading[Surface] = GroundReading()
    reading.items += each_surface(sources, site, reading, feedback)
    return reading


def each_surface(
    sources: Sequence[ObstacleSource],
    site: SitePlacing,
    reading: GroundReading[Surface],
    feedback: QgsFeedback,
) -> Iterator[Surface]:
    """Yield what :func:`read_surfaces` returns; ``reading`` gets the warnings and no items."""
    for source in sources:
        layer = _GroundLayer(source, site, ROAD_SURFACE)
        name, origin = (layer.rules.rule(field, layer.rules.column(field)) for field in ("name", "origin"))
        for rings, label in _polygons(layer, reading, feedback):
            notes: list[str] = []
            made = layer.rules.value("origin", origin, notes) == GENERATED
            called = str(layer.rules.value("name", name, notes) or "")
            yield Surface(rings, label, called, GENERATED if made else DRAWN)
        reading.note_layer(layer.rules.warnings)


def _polygons(
    layer: _GroundLayer, reading: GroundReading, feedback: QgsFeedback
) -> Iterator[tuple[tuple[np.ndarray, ...], str]]:
    """Yield the rings of each polygon, in the site frame, with its label."""
    for feature, geometry in layer.features(reading, feedback):
        shapes, notes = shapes_of(geometry)
        if any(not shape.closed for shape in shapes):
            notes.append(tr("has a line, which is no area; it is left out"))
        label = layer.label(feature, notes)
        layer.note(feature, notes, reading)
        for rings in polygons_of(shapes):
            yield tuple(layer.placing.to_site(ring) for ring in rings), label


def check_ground_sources(sources: Sequence[ObstacleSource], site: SitePlacing, role: str) -> None:
    """Raise :class:`LayerReadingError` for what reading ``sources`` would refuse, without reading."""
    for source in sources:
        rules = _GroundLayer(source, site, role).rules
        rules.rule("width", source.expressions.width)


class _GroundLayer:
    """One layer of roads or areas: where it lies, what its expressions say, which features it has."""

    def __init__(self, source: ObstacleSource, site: SitePlacing, role: str):
        self.source = source
        self.placing: LayerPlacing = site.of_layer(source.name, source.crs)
        self.rules = LayerRules(source.name, source.fields, source.context)
        self._filter = FeatureFilter(source.name, source.fields, source.expressions.filter, source.context)
        column = self.rules.column(LABEL_FIELDS[role])
        self._label = self.rules.rule("semantics", source.expressions.semantics or column)
        self._otherwise = source.name if role == KEEPOUT else ""

    def features(
        self, reading: GroundReading, feedback: QgsFeedback
    ) -> Iterator[tuple[QgsFeature, QgsGeometry]]:
        """Yield each feature that counts with its geometry in metres; warn of those that have none."""
        for feature in self.source.features.getFeatures():
            if feedback.isCanceled():
                reading.complete = False
                return
            doubts: list[str] = []
            counts = self._filter.keeps(feature, doubts)
            geometry = self.placing.of_feature(feature, doubts) if counts else None
            self.note(feature, doubts, reading)
            if geometry is not None:
                self.rules.at(feature)
                yield feature, geometry

    def label(self, feature: QgsFeature, notes: list[str]) -> str:
        """Return the label of the feature that was yielded last."""
        value = self.rules.value("semantics", self._label, notes)
        return self._otherwise if value is None else str(value)

    def note(self, feature: QgsFeature, notes: Sequence[str], reading: GroundReading) -> None:
        """Warn of ``feature``."""
        for note in notes:
            reading.notes.add(self.source.name, feature.id(), note)


def lines_of(geometry: QgsGeometry, notes: list[str]) -> list[np.ndarray]:
    """Return the lines of ``geometry`` that have a length, (n, 2) each; curves as chords."""
    rings = rings_of(geometry.asWkb().data())
    if rings is not None and not rings.closed:
        plain = Parts([], [np.frombuffer(points, "<f8").reshape(-1, 2) for points in rings.points], [])
        return _lines_in(plain, notes)
    if geometry.constGet().hasCurvedSegments():
        maximum = QgsAbstractGeometry.SegmentationToleranceType.MaximumDifference
        geometry = QgsGeometry(geometry.constGet().segmentize(SAGITTA_M, maximum))
    return _lines_in(parts_of(geometry), notes)


def _lines_in(parts: Parts, notes: list[str]) -> list[np.ndarray]:
    notes += parts.notes
    if not parts.on_earth:
        notes.append(NO_PLACE)
        return []
    if parts.polygons:
        notes.append(tr("has a polygon, which is no centreline; it is left out"))
    lines, line_notes = lines_with_length(parts.lines)
    notes += line_notes
    return lines
