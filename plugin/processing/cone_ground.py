"""What cones are checked against: surfaces that are allowed, obstacles, distances."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence

import numpy as np
from qgis.core import (
    QgsCoordinateReferenceSystem,
    QgsGeometry,
    QgsProcessing,
    QgsProcessingAlgorithm,
    QgsProcessingContext,
    QgsProcessingFeedback,
    QgsProcessingParameterDefinition,
    QgsProcessingParameterMultipleLayers,
    QgsProcessingParameterNumber,
    QgsProcessingParameterString,
    QgsWkbTypes,
)

from ...robot_bridge.layouts.checks import Finding, Shape, find
from ...robot_bridge.layouts.cone import Cone
from ..language import tr
from ..sites.feature_filter import FeatureFilter
from ..sites.ground_reading import read_areas
from ..sites.obstacle_source import ObstacleSource, obstacle_sources
from ..sites.placing import SitePlacing
from ..sites.roles import FURNITURE, ROAD_SURFACE, LayerExpressions, LayerSetup, setup_of
from ..sites.shapes import polygons_of, shapes_of
from .fleet_algorithm import Parameters

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


class Ground:
    """The layers of the checks and what the parameters say; to be made in the thread of the layers."""

    def __init__(
        self, algorithm: QgsProcessingAlgorithm, parameters: Parameters, context: QgsProcessingContext
    ):
        expressions = algorithm.createExpressionContext(parameters, context)
        surfaces = algorithm.parameterAsLayerList(parameters, SURFACES, context)
        obstacles = algorithm.parameterAsLayerList(parameters, OBSTACLES, context)
        self._transforms = context.transformContext()
        self._surfaces = obstacle_sources(surfaces, LayerExpressions(), expressions) if surfaces else None
        # The role lets points pass: they are obstacles here, too.
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
    ) -> list[Finding] | None:
        """Return what is wrong with ``cones``, which are in ``crs``; None after a cancel.

        :raises LayerReadingError: when a layer has no known place in ``crs``.
        """
        site = SitePlacing.in_crs(crs, self._transforms)
        surfaces = self._read_surfaces(site, feedback)
        obstacles = read_obstacles(self._obstacles, site, feedback)
        if feedback.isCanceled():
            return None
        findings = find(cones, surfaces, obstacles, *self._distances)
        _say(findings, surfaces is None, feedback)
        return findings

    def _read_surfaces(self, site: SitePlacing, feedback: QgsProcessingFeedback) -> list[Shape] | None:
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
            Shape(area.rings, area.label)
            for area in reading.items
            if not self._allowed or area.label in self._allowed
        ]


def read_obstacles(
    sources: Sequence[ObstacleSource], site: SitePlacing, feedback: QgsProcessingFeedback
) -> list[Shape]:
    """Return every part of every feature that counts, named by layer and feature."""
    shapes: list[Shape] = []
    for source in sources:
        placing = site.of_layer(source.name, source.crs)
        counts = FeatureFilter(source.name, source.fields, source.expressions.filter, source.context)
        for feature in source.features.getFeatures():
            if feedback.isCanceled():
                return shapes
            name, notes = tr("{name}, feature {id}", name=source.name, id=feature.id()), []
            geometry = placing.of_feature(feature, notes) if counts.keeps(feature, notes) else None
            if geometry is not None:
                parts, found = _parts(geometry, name)
                shapes += parts
                notes += found
            for note in notes:
                feedback.pushWarning(tr("Layer {name}: {note}", name=name, note=note))
    return shapes


def _parts(geometry: QgsGeometry, name: str) -> tuple[list[Shape], list[str]]:
    if geometry.type() == QgsWkbTypes.GeometryType.PointGeometry:
        points = [np.array([[vertex.x(), vertex.y()]]) for vertex in geometry.vertices()]
        return [Shape((point,), name, area=False) for point in points], []
    shapes, notes = shapes_of(geometry)
    lines = [shape.points for shape in shapes if not shape.closed]
    return [
        *(Shape(tuple(rings), name) for rings in polygons_of(shapes)),
        *(Shape((line,), name, area=False) for line in lines),
    ], notes


def _say(findings: Sequence[Finding], unchecked: bool, feedback: QgsProcessingFeedback) -> None:
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
