"""Cone layers: points read with their values, checks against the ground, output layers of cones."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from qgis.core import (
    NULL,
    QgsCoordinateReferenceSystem,
    QgsFeature,
    QgsGeometry,
    QgsPointXY,
    QgsProcessing,
    QgsProcessingAlgorithm,
    QgsProcessingContext,
    QgsProcessingFeatureSource,
    QgsProcessingFeedback,
    QgsProcessingOutputNumber,
    QgsProcessingParameterDefinition,
    QgsProcessingParameterFeatureSink,
    QgsProcessingParameterMultipleLayers,
    QgsProcessingParameterNumber,
    QgsProcessingParameterString,
    QgsWkbTypes,
)

from ....robot_bridge.core.geometry import heading_of
from ....robot_bridge.core.layouts.layout import Cone, ConeFinding, NamedGeometry, find_misplaced_cones
from ...layers.geometry import polygons_of, shapes_of
from ...layers.layer_expressions import FeatureFilter
from ...layers.layer_source import FeatureReader, ObstacleSource, obstacle_sources
from ...layers.road_layers import read_areas
from ...layers.roles import FURNITURE, ROAD_SURFACE, LayerExpressions, LayerSetup, setup_of
from ...layers.site_transform import LayerToSiteTransform, SiteGeoreference, SiteTransformError
from ...ui.errors import LayerReadingError
from ...ui.language import tr, tr_count
from .algorithm import FleetAlgorithm, ParameterError, Parameters, fields_of
from .outputs import fill_sink
from .parameters import chosen_crs, site_crs_parameter

# --- Points of a layer with the values of their fields, read as cones, robots and stores ---


@dataclass(frozen=True)
class PointRow:
    """One feature: its name in errors, its own name and id, its place (metres, site frame), its values."""

    where: str
    name: str
    feature: int
    x: float
    y: float
    values: dict[str, Any]

    def number(self, field: str, otherwise: float) -> float:
        """Return the number in ``field``; ``otherwise`` where the layer has no such field, or no value.

        :raises LayerReadingError: when the value is no number.
        """
        value = self.values.get(field)
        if value is None or value == "":
            return otherwise
        try:
            number = float(value)
        except (TypeError, ValueError):
            number = math.nan
        if not math.isfinite(number):
            raise LayerReadingError(
                tr(
                    "{layer}: {field} is {value!r}, which is no number; correct it.",
                    layer=self.where,
                    field=field,
                    value=value,
                )
            )
        return number

    def whole(self, field: str, otherwise: float) -> int:
        """Return the whole number in ``field``; raises as :meth:`number`."""
        number = self.number(field, otherwise)
        if number != int(number):
            raise LayerReadingError(
                tr(
                    "{layer}: {field} is {value:g}; give a whole number.",
                    layer=self.where,
                    field=field,
                    value=number,
                )
            )
        return int(number)


def point_rows(
    layer: str, features: Iterable[QgsFeature], placing: LayerToSiteTransform, names: Sequence[str]
) -> Iterator[PointRow]:
    """Yield the features of the layer called ``layer``; the first of the fields ``names`` names each.

    A feature without a name is named by its number in the layer.

    :raises LayerReadingError: at a feature that is not a single point with a place on the site.
    """
    for feature in features:
        where = tr("{layer}, feature {id}", layer=layer, id=feature.id())
        x, y = _place(feature, placing, where)
        values = {
            field: None if value == NULL else value
            for field, value in zip(feature.fields().names(), feature.attributes(), strict=True)
        }
        named = (str(values[field]) for field in names if values.get(field) not in (None, ""))
        yield PointRow(where, next(named, str(feature.id())), feature.id(), x, y, values)


def _place(feature: QgsFeature, placing: LayerToSiteTransform, where: str) -> tuple[float, float]:
    try:
        # Held in a variable, since its vertices do not keep it alive.
        geometry = placing.to_metres(feature.geometry())
        vertices = [(vertex.x(), vertex.y()) for vertex in geometry.vertices()]
    except SiteTransformError:
        vertices = []
    if len(vertices) != 1 or not np.isfinite(vertices).all():
        raise LayerReadingError(
            tr("{where} is not one point with a place on the site: correct or delete it.", where=where)
        )
    ((x, y),) = placing.to_site(np.array(vertices)).tolist()
    return x, y


# --- Checks of cones: allowed surfaces, obstacles, distances ---

SURFACES, ALLOWED, OBSTACLES = "SURFACES", "ALLOWED", "OBSTACLES"
OBSTACLE_DISTANCE, CONE_DISTANCE = "OBSTACLE_DISTANCE", "CONE_DISTANCE"
_REAL = QgsProcessingParameterNumber.Type.Double


def ground_parameters() -> list[QgsProcessingParameterDefinition]:
    """Return the parameters of the checks."""
    kinds = QgsProcessing.SourceType
    return [
        QgsProcessingParameterMultipleLayers(
            SURFACES,
            tr("Surfaces to stand on (default: not checked)"),
            kinds.TypeVectorPolygon,
            optional=True,
        ),
        QgsProcessingParameterString(
            ALLOWED, tr("Classes of surface that are allowed, such as asphalt (default: all)"), optional=True
        ),
        QgsProcessingParameterMultipleLayers(
            OBSTACLES, tr("Obstacles to keep away from"), kinds.TypeVectorAnyGeometry, optional=True
        ),
        QgsProcessingParameterNumber(
            OBSTACLE_DISTANCE, tr("Distance to obstacles [m]"), _REAL, 0.5, minValue=0.0
        ),
        QgsProcessingParameterNumber(
            CONE_DISTANCE, tr("Distance between cones [m]"), _REAL, 0.5, minValue=0.0
        ),
    ]


class ConeCheckSource:
    """The layers and parameters of the checks; must be created in the thread of the layers."""

    def __init__(
        self, algorithm: QgsProcessingAlgorithm, parameters: Parameters, context: QgsProcessingContext
    ):
        expressions = algorithm.createExpressionContext(parameters, context)
        surfaces = algorithm.parameterAsLayerList(parameters, SURFACES, context)
        obstacles = algorithm.parameterAsLayerList(parameters, OBSTACLES, context)
        self._transforms = context.transformContext()
        self._surfaces = obstacle_sources(surfaces, LayerExpressions(), expressions) if surfaces else None
        # The role's filter lets points pass: they are obstacles here, too.
        self._obstacles = obstacle_sources(
            obstacles,
            LayerExpressions(),
            expressions,
            lambda layer: LayerSetup(FURNITURE, setup_of(layer).expressions),
        )
        words = algorithm.parameterAsString(parameters, ALLOWED, context).split(",")
        self._allowed = {word.strip() for word in words if word.strip()}
        self._distances = [
            algorithm.parameterAsDouble(parameters, name, context)
            for name in (OBSTACLE_DISTANCE, CONE_DISTANCE)
        ]

    def check(
        self, cones: Sequence[Cone], crs: QgsCoordinateReferenceSystem, feedback: QgsProcessingFeedback
    ) -> list[ConeFinding] | None:
        """Return the findings on ``cones``, which are in ``crs``; None if cancelled.

        :raises LayerReadingError: when a layer has no known place in ``crs``.
        """
        site = SiteGeoreference.in_crs(crs, self._transforms)
        surfaces = self._read_surfaces(site, feedback)
        obstacles = read_obstacles(self._obstacles, site, feedback)
        if feedback.isCanceled():
            return None
        findings = find_misplaced_cones(cones, surfaces, obstacles, *self._distances)
        _report(findings, surfaces is None, feedback)
        return findings

    def _read_surfaces(
        self, site: SiteGeoreference, feedback: QgsProcessingFeedback
    ) -> list[NamedGeometry] | None:
        if self._surfaces is None:
            return None
        reading = read_areas(self._surfaces, site, ROAD_SURFACE, feedback)
        for warning in reading.warnings:
            feedback.pushWarning(warning)
        unknown = self._allowed - {area.label for area in reading.items}
        if unknown and reading.complete:
            none = tr("none")
            there = ", ".join(sorted({area.label or f"({none})" for area in reading.items})) or none
            feedback.pushWarning(
                tr(
                    "No surface is of class {classes}: the layers have {classes_there}.",
                    classes=", ".join(sorted(unknown)),
                    classes_there=there,
                )
            )
        return [
            NamedGeometry(area.rings, area.label)
            for area in reading.items
            if not self._allowed or area.label in self._allowed
        ]


def read_obstacles(
    sources: Sequence[ObstacleSource], site: SiteGeoreference, feedback: QgsProcessingFeedback
) -> list[NamedGeometry]:
    """Return every part of every feature that counts, named by layer and feature."""
    shapes: list[NamedGeometry] = []
    for source in sources:
        placing = site.of_layer(source.name, source.crs)
        counts = FeatureFilter(source.name, source.fields, source.expressions.filter, source.context)
        for feature, _, geometry, notes in FeatureReader(
            source.name, source.features, placing, counts, feedback
        ):
            name = tr("{name}, feature {id}", name=source.name, id=feature.id())
            if geometry is not None:
                parts, found = _parts(geometry, name)
                shapes += parts
                notes += found
            for note in notes:
                feedback.pushWarning(tr("Layer {name}: {note}", name=name, note=note))
    return shapes


def _parts(geometry: QgsGeometry, name: str) -> tuple[list[NamedGeometry], list[str]]:
    if geometry.type() == QgsWkbTypes.GeometryType.PointGeometry:
        points = [np.array([[vertex.x(), vertex.y()]]) for vertex in geometry.vertices()]
        return [NamedGeometry((point,), name, area=False) for point in points], []
    shapes, notes = shapes_of(geometry)
    lines = [shape.points for shape in shapes if not shape.closed]
    return [
        *(NamedGeometry(tuple(rings), name) for rings in polygons_of(shapes)),
        *(NamedGeometry((line,), name, area=False) for line in lines),
    ], notes


def _report(findings: Sequence[ConeFinding], unchecked: bool, feedback: QgsProcessingFeedback) -> None:
    if unchecked:
        feedback.pushInfo(
            tr("No layer of surfaces is given: whether the cones stand on the road is not checked.")
        )
    for kind, count in sorted(Counter(finding.kind.value for finding in findings).items()):
        feedback.pushInfo(f"{kind}: {count}")
    for finding in findings:
        feedback.pushWarning(finding.text)
    if not findings:
        feedback.pushInfo(tr("Nothing is wrong with the places of the cones."))


# --- The output layers of cones, and their CRS ---

CONES, FINDINGS = "CONES", "FINDINGS"
CONE_COUNT, FINDING_COUNT = "CONE_COUNT", "FINDING_COUNT"
STYLES = {CONES: "cones.qml", FINDINGS: "cone_findings.qml"}
CONE_FIELDS = {
    "id": "string",
    "order": "integer",
    "heading": "double",
    "colour": "string",
    "role": "string",
    "layout": "string",
}
_FINDINGS = {"kind": "string", "cone": "string", "text": "string"}


def cone_crs_parameter() -> QgsProcessingParameterDefinition:
    """Return the parameter of the cones' CRS."""
    return site_crs_parameter(
        tr("Site CRS, in metres (default: the project's, else the line's or the layer's)")
    )


def add_layers(algorithm: QgsProcessingAlgorithm) -> None:
    """Add the outputs to ``algorithm``."""
    points = QgsProcessing.SourceType.TypeVectorPoint
    algorithm.addParameter(QgsProcessingParameterFeatureSink(CONES, tr("Cones"), points))
    algorithm.addParameter(
        QgsProcessingParameterFeatureSink(
            FINDINGS, tr("Findings"), points, optional=True, createByDefault=True
        )
    )
    algorithm.addOutput(QgsProcessingOutputNumber(CONE_COUNT, tr("Cones")))
    algorithm.addOutput(QgsProcessingOutputNumber(FINDING_COUNT, tr("Findings")))


class ConeSetup:
    """Setup read from the parameters in the main thread: fields, checks, and the CRS."""

    def __init__(
        self,
        algorithm: QgsProcessingAlgorithm,
        parameters: Parameters,
        context: QgsProcessingContext,
        source: QgsProcessingFeatureSource | None,
    ):
        """:raises SiteCrsError: when the CRS cannot carry a site."""
        self._fields = {CONES: fields_of(CONE_FIELDS), FINDINGS: fields_of(_FINDINGS)}
        self._ground = ConeCheckSource(algorithm, parameters, context)
        own = [source.sourceCrs()] if source is not None else []
        self.crs = chosen_crs(algorithm, parameters, context, own)
        if not self.crs.isValid():
            raise ParameterError(tr("The CRS of the site is not known: give SITE_CRS, such as EPSG:32633."))

    def write(
        self,
        algorithm: FleetAlgorithm,
        parameters: Parameters,
        context: QgsProcessingContext,
        cones: Sequence[Cone],
        layout: str,
        feedback: QgsProcessingFeedback,
    ) -> dict:
        """Check and write ``cones``; return the outputs, empty if cancelled."""
        findings = self._ground.check(cones, self.crs, feedback)
        if findings is None:
            return {}
        rows = {
            CONES: [(_point(cone), cone_values(cone, layout)) for cone in cones],
            FINDINGS: [(_point(one), [one.kind.value, one.cone, one.text]) for one in findings],
        }
        made = {}
        kind = QgsWkbTypes.Type.Point
        for name, fields in self._fields.items():
            sink, source = algorithm.parameterAsSink(parameters, name, context, fields, kind, self.crs)
            if sink is not None:
                made[name] = source
                fill_sink(sink, fields, rows[name], feedback)
        if not findings and context.willLoadLayerOnCompletion(made.get(FINDINGS, "")):
            _do_not_load(made[FINDINGS], context)
            feedback.pushInfo(tr("There are no findings: their layer is empty, and is not loaded."))
        algorithm.remember(made)
        feedback.pushInfo(tr_count(len(cones), "1 cone", "%n cones"))
        return {**made, CONE_COUNT: len(cones), FINDING_COUNT: len(findings)}


def _do_not_load(made: str, context: QgsProcessingContext) -> None:
    """Stop QGIS from loading the layer ``made`` at the end: an empty one is of no use."""
    details = context.layersToLoadOnCompletion()
    context.setLayersToLoadOnCompletion({key: details[key] for key in details if key != made})


def _point(what: Cone | ConeFinding) -> QgsGeometry:
    return QgsGeometry.fromPointXY(QgsPointXY(what.x, what.y))


def cone_values(cone: Cone, layout: str) -> list:
    """Return the values of the fields ``CONE_FIELDS``."""
    heading = round(heading_of(cone.theta), 6) % 360.0
    return [cone.id, cone.order, heading, cone.colour, cone.role, layout]
