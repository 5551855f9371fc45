"""``fleet:surfaceatpoint``: points in, the same points with the road surface at each of them out."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
from qgis.core import (
    QgsCoordinateReferenceSystem,
    QgsFeature,
    QgsFeatureSink,
    QgsFields,
    QgsGeometry,
    QgsProcessing,
    QgsProcessingContext,
    QgsProcessingException,
    QgsProcessingFeatureSource,
    QgsProcessingFeedback,
    QgsProcessingOutputNumber,
    QgsProcessingParameterFeatureSink,
    QgsProcessingParameterFeatureSource,
    QgsProcessingParameterMultipleLayers,
    QgsProcessingUtils,
    QgsProject,
    QgsWkbTypes,
)

from ....robot_bridge.core.roads.centrelines import Surface
from ...layers.layer_source import each_feature
from ...layers.road_surfaces import SurfaceMap, read_surface_map, surface_sources
from ...layers.roles import ROAD_SURFACE, layers_with_role
from ...layers.site_transform import SiteGeoreference
from ...ui.language import tr, tr_count, tr_page
from ..common.algorithm import FleetAlgorithm, ParameterError, Parameters, fields_of, shown_by_processing
from ..common.outputs import fill_sink

POINTS, SURFACES, OUTPUT = "POINTS", "SURFACES", "OUTPUT"
_FIELDS = {"surface": "string", "surface_name": "string", "surface_origin": "string"}
_AT_ONCE = 10_000
NUMBERS = {
    "ON_COUNT": tr("Points on a surface"),
    "OFF_COUNT": tr("Points on none"),
    "WARNING_COUNT": tr("Warnings"),
}


class SurfaceAtPoint(FleetAlgorithm):
    """Tells the road surface at points."""

    GROUP = ("roads", tr("Roads"))
    NAME = "surfaceatpoint"
    TITLE = tr("Surface at point")
    SUMMARY = tr("Adds to points, in any CRS, the class of the road surface that they are on.")
    ICON = "surface_at_point.svg"
    TAGS = ("road", "surface", "asphalt", "point", "where")
    HELP = tr_page("""
    <p>Copies points and adds <b>surface</b>, the class of the road surface that each is on, its
    <b>surface_name</b>, and <b>surface_origin</b>: whether the surface was drawn or generated from
    centrelines. They are empty where there is no surface.</p>
    <p>The surfaces are layers of areas with a field <i>surface</i>, or the class that their role says;
    without any, the project's layers with the role road surface. Points and layers may be in any CRS.</p>
    <p>A point on an edge is on the surface. Where surfaces lie on one another a drawn one counts before a
    generated one, then the smaller before the larger. The expression <i>road_surface(x, y)</i> tells the
    same. docs/roads.md says more.</p>
    """)

    def initAlgorithm(self, configuration: dict[str, Any] | None = None):
        kinds = QgsProcessing.SourceType
        self.addParameter(QgsProcessingParameterFeatureSource(POINTS, tr("Points"), [kinds.TypeVectorPoint]))
        self.addParameter(
            QgsProcessingParameterMultipleLayers(
                SURFACES,
                tr("Road surfaces (default: the project's layers with that role)"),
                kinds.TypeVectorPolygon,
                optional=True,
            )
        )
        self.addParameter(
            QgsProcessingParameterFeatureSink(OUTPUT, tr("Points with surface"), kinds.TypeVectorPoint)
        )
        for name, title in NUMBERS.items():
            self.addOutput(QgsProcessingOutputNumber(name, title))

    def prepareAlgorithm(
        self, parameters: Parameters, context: QgsProcessingContext, feedback: QgsProcessingFeedback
    ):
        self._fields = fields_of(_FIELDS)
        with shown_by_processing():
            layers = self.parameterAsLayerList(parameters, SURFACES, context)
            # Without a project there is none, as in a script that names no project file.
            project = context.project() or QgsProject()
            layers = layers or layers_with_role(project, ROAD_SURFACE)
            scope = self.createExpressionContext(parameters, context)
            transforms = context.transformContext()
            self._sources = surface_sources(layers, project.crs(), transforms, scope) if layers else None
        return True

    def processAlgorithm(
        self, parameters: Parameters, context: QgsProcessingContext, feedback: QgsProcessingFeedback
    ):
        with shown_by_processing(feedback):
            points = self._points(parameters, context)
            if self._sources is None:
                raise ParameterError(
                    tr(
                        "No road surfaces are given, and no layer of the project has the role road surface: "
                        "give SURFACES, or set the role in Plugins > Fleet Supervisor > Layer roles."
                    )
                )
            surfaces = read_surface_map(self._sources, feedback)
            if surfaces is None:
                return {}
            # Refuses points whose place is not known: QGIS would take them for degrees.
            site = SiteGeoreference.in_crs(surfaces.crs, surfaces.transforms)
            site.of_layer(points.sourceName(), points.sourceCrs())
            for warning in surfaces.warnings:
                feedback.pushWarning(warning)
            fields = QgsProcessingUtils.combineFields(points.fields(), self._fields)
            sink, made = self.parameterAsSink(
                parameters, OUTPUT, context, fields, points.wkbType(), points.sourceCrs()
            )
            on, off, odd = _written(points, surfaces, sink, fields, feedback)
        if feedback.isCanceled():
            return {}
        feedback.pushInfo(
            tr_count(
                on,
                "1 point is on a surface, {off} on none.",
                "%n points are on a surface, {off} on none.",
                off=off,
            )
        )
        numbers = on, off, len(surfaces.warnings) + odd
        return {OUTPUT: made, **dict(zip(NUMBERS, numbers, strict=True))}

    def _points(self, parameters: Parameters, context: QgsProcessingContext) -> QgsProcessingFeatureSource:
        points = self.parameterAsSource(parameters, POINTS, context)
        if points is None:
            raise QgsProcessingException(self.invalidSourceError(parameters, POINTS))
        if points.wkbType() == QgsWkbTypes.Type.NoGeometry:
            raise ParameterError(
                tr(
                    "POINTS {name} is a table without places: make points of its columns first, by "
                    "native:createpointslayerfromtable.",
                    name=points.sourceName(),
                )
            )
        return points


def _written(
    points: QgsProcessingFeatureSource,
    surfaces: SurfaceMap,
    sink: QgsFeatureSink,
    fields: QgsFields,
    feedback: QgsProcessingFeedback,
) -> tuple[int, int, int]:
    """Write the points with their surfaces; return how many are on one, on none, and odd.

    Stops early when cancelled; raises OutputError.
    """
    counts, odd = {True: 0, False: 0}, 0
    for features in _batches(points, feedback):
        found, notes = _surfaces_of_points(features, surfaces, points.sourceCrs())
        for note in notes:
            feedback.pushWarning(note)
        odd += len(notes)
        for surface in found:
            counts[surface is not None] += 1
        rows = [_row(feature, one) for feature, one in zip(features, found, strict=True)]
        if not fill_sink(sink, fields, rows, feedback):
            break
    return counts[True], counts[False], odd


def _batches(
    points: QgsProcessingFeatureSource, feedback: QgsProcessingFeedback
) -> Iterator[list[QgsFeature]]:
    total, done, batch = max(points.featureCount(), 1), 0, []
    for feature in each_feature(points, feedback):
        batch.append(feature)
        if len(batch) == _AT_ONCE:
            done += len(batch)
            feedback.setProgress(100.0 * done / total)
            yield batch
            batch = []
    if batch and not feedback.isCanceled():
        yield batch


def _surfaces_of_points(
    features: list[QgsFeature], surfaces: SurfaceMap, crs: QgsCoordinateReferenceSystem
) -> tuple[list[Surface | None], list[str]]:
    """Return the surface of each feature, and what is odd about some."""
    notes: list[str] = []
    places, counts = [], []
    for feature in features:
        own = _places(feature.geometry())
        places += own
        counts.append(len(own))
    surfaces_found = surfaces.at_many(np.array(places).reshape(-1, 2), surfaces.way_from(crs))
    found: list[Surface | None] = []
    begin = 0
    for feature, count in zip(features, counts, strict=True):
        own_surfaces = surfaces_found[begin : begin + count]
        begin += count
        if len({one and one.label for one in own_surfaces}) > 1:
            notes.append(
                tr("Feature {id} has points on several surfaces; none is given for it", id=feature.id())
            )
            own_surfaces = []
        found.append(own_surfaces[0] if own_surfaces else None)
    return found, notes


def _places(geometry: QgsGeometry) -> list[tuple[float, float]]:
    if geometry.isNull():
        return []
    return [(vertex.x(), vertex.y()) for vertex in geometry.vertices()]


def _row(feature: QgsFeature, surface: Surface | None):
    values = [None] * 3 if surface is None else [surface.label, surface.name or None, surface.origin]
    return feature.geometry(), [*feature.attributes(), *values]
