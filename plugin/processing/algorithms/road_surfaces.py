"""``fleet:buildroadsurfaces`` and ``fleet:surfaceatpoint``: road surfaces, made and queried."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np
from qgis.core import (
    QgsCoordinateReferenceSystem,
    QgsFeature,
    QgsFeatureSink,
    QgsFeedback,
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
    QgsProcessingParameterString,
    QgsProcessingUtils,
    QgsProject,
    QgsWkbTypes,
)

from ....robot_bridge.core.errors import RoadsCancelledError
from ....robot_bridge.core.roads.network import GENERATED, Surface
from ....robot_bridge.core.roads.surface_generation import PRECEDENCE as USUAL_ORDER
from ....robot_bridge.core.roads.surface_generation import generate_surfaces
from ....robot_bridge.core.roads.surface_index import areas_of, surface_edges
from ...layers.layer_source import each_feature, obstacle_sources
from ...layers.road_layers import GroundReading, read_surfaces
from ...layers.road_surfaces import SurfaceMap, read_surface_map, surface_sources
from ...layers.roles import ROAD_SURFACE, LayerExpressions, layers_with_role
from ...layers.site_transform import SiteGeoreference
from ...ui.language import tr, tr_count, tr_page
from ..common.algorithm import FleetAlgorithm, ParameterError, Parameters, fields_of, shown_by_processing
from ..common.outputs import fill_sink, line, polygon
from ..common.road_sources import DEFAULT_WIDTH, WARNING_COUNT, RoadReading, RoadSource, road_parameters

# --- ``fleet:buildroadsurfaces``: centrelines with widths in, surfaces dissolved by class out ---

DRAWN, PRECEDENCE, SURFACES, FINDINGS = "DRAWN", "PRECEDENCE", "SURFACES", "FINDINGS"
_OF_ROADS = ("ROADS", "WIDTH", "SURFACE", DEFAULT_WIDTH, "SITE_CRS")
"""Parameters of roads used here: those about driving are not needed."""
_FIELDS = {"surface": "string", "name": "string", "origin": "string", "area_m2": "double"}
_FINDING = {"feature": "int8", "text": "string"}
NUMBERS = {
    "SURFACE_COUNT": tr("Surfaces"),
    "GENERATED_COUNT": tr("Generated ones"),
    "AREA_M2": tr("Area [m²]"),
    "FINDING_COUNT": tr("Roads without a width"),
    WARNING_COUNT: tr("Warnings"),
}


class BuildRoadSurfaces(FleetAlgorithm):
    """Makes road surfaces from centrelines by their widths."""

    GROUP = ("roads", tr("Roads"))
    NAME = "buildroadsurfaces"
    TITLE = tr("Build road surfaces")
    SUMMARY = tr(
        "Widens centrelines to surfaces, one for each class; surfaces drawn by hand keep their ground."
    )
    ICON = "build_road_surfaces.svg"
    TAGS = ("road", "surface", "buffer", "width", "asphalt", "dissolve", "parking")
    STYLES = {SURFACES: "road_surfaces.qml"}  # noqa: RUF012
    HELP = tr_page("""
    <p>Widens road centrelines by half their width to each side: ends are cut square, corners are mitred,
    within a road and where roads end in one point. What is of one class, such as asphalt, becomes one
    surface; pieces that do not touch are features of their own.</p>
    <p>No ground is in two surfaces. Surfaces <b>drawn by hand</b> keep theirs and are copied to the result.
    Among generated ones the class that comes first in <b>precedence</b> keeps the ground; of classes that are
    not named there the one with less ground, and what has no class comes last.</p>
    <p>A road whose width is not known is as wide as <b>default width</b> says, and is in the layer of
    <b>findings</b>. Ends that stop just short of another road stay apart: mend them with
    <i>fleet:buildroadnetwork</i> and give its edges.</p>
    <p>Give the result the role road surface to publish it. docs/roads.md says more.</p>
    """)

    def initAlgorithm(self, configuration: dict[str, Any] | None = None):
        area, lines = QgsProcessing.SourceType.TypeVectorPolygon, QgsProcessing.SourceType.TypeVectorLine
        roads, *others = [one for one in road_parameters() if one.name() in _OF_ROADS]
        self.addParameter(roads)
        self.addParameter(
            QgsProcessingParameterMultipleLayers(
                DRAWN, tr("Surfaces drawn by hand, which keep their ground"), area, optional=True
            )
        )
        self.addParameter(
            QgsProcessingParameterString(
                PRECEDENCE,
                tr("Classes that keep their ground, the first before the second"),
                ", ".join(USUAL_ORDER),
                optional=True,
            )
        )
        for parameter in others:
            self.addParameter(parameter)
        self.addParameter(QgsProcessingParameterFeatureSink(SURFACES, tr("Road surfaces"), area))
        self.addParameter(
            QgsProcessingParameterFeatureSink(
                FINDINGS, tr("Roads without a width"), lines, optional=True, createByDefault=False
            )
        )
        for name, title in NUMBERS.items():
            self.addOutput(QgsProcessingOutputNumber(name, title))

    def prepareAlgorithm(
        self, parameters: Parameters, context: QgsProcessingContext, feedback: QgsProcessingFeedback
    ):
        self._fields = fields_of(_FIELDS), fields_of(_FINDING)
        with shown_by_processing():
            self._source = RoadSource(self, parameters, context)
            layers = self.parameterAsLayerList(parameters, DRAWN, context)
            scope = self.createExpressionContext(parameters, context)
            self._drawn = obstacle_sources(layers, LayerExpressions(), scope)
        return True

    def processAlgorithm(
        self, parameters: Parameters, context: QgsProcessingContext, feedback: QgsProcessingFeedback
    ):
        with shown_by_processing(feedback):
            reading = self._source.read(feedback)
            drawn = None if reading is None else self._read_drawn(reading, context, feedback)
            if drawn is None:
                return {}
            for warning in (*reading.warnings, *drawn.warnings):
                feedback.pushWarning(warning)
            try:
                made = self._generated(parameters, context, reading, drawn, feedback)
            except RoadsCancelledError:
                return {}
            surfaces = [*drawn.items, *made]
            results = self._written(parameters, context, reading, surfaces, feedback)
            if results is None:
                return {}
        areas = areas_of(surface_edges(surfaces), len(surfaces))
        for label in sorted({one.label for one in surfaces}):
            own = sum(area for area, one in zip(areas, surfaces, strict=True) if one.label == label)
            feedback.pushInfo(tr("{label}: {area:.1f} m²", label=label or tr("without a class"), area=own))
        figures = (
            len(surfaces),
            len(made),
            float(areas.sum()),
            len(reading.without_width),
            len(reading.warnings) + len(drawn.warnings),
        )
        return {**results, **dict(zip(NUMBERS, figures, strict=True))}

    def _read_drawn(
        self, reading: RoadReading, context: QgsProcessingContext, feedback: QgsProcessingFeedback
    ) -> GroundReading[Surface] | None:
        site = SiteGeoreference.in_crs(reading.crs, context.transformContext())
        drawn = read_surfaces(self._drawn, site, _Quiet(feedback))
        # Surfaces generated by an earlier run are generated again.
        old = [one for one in drawn.items if one.origin == GENERATED]
        drawn.items = [one for one in drawn.items if one.origin != GENERATED]
        if old:
            drawn.notes.add_text(
                tr_count(
                    len(old),
                    "1 of the surfaces that are given as drawn says that it was generated (field "
                    "origin); it is left out and made anew",
                    "%n of the surfaces that are given as drawn say that they were generated (field "
                    "origin); they are left out and made anew",
                )
            )
        return drawn if drawn.complete else None

    def _generated(
        self,
        parameters: Parameters,
        context: QgsProcessingContext,
        reading: RoadReading,
        drawn: GroundReading[Surface],
        feedback: QgsProcessingFeedback,
    ) -> list[Surface]:
        def progress(share: float) -> bool:
            feedback.setProgress(50.0 + 45.0 * share)
            return not feedback.isCanceled()

        order = [word.strip() for word in self.parameterAsString(parameters, PRECEDENCE, context).split(",")]
        return generate_surfaces(reading.roads, drawn.items, [word for word in order if word], progress)

    def _written(
        self,
        parameters: Parameters,
        context: QgsProcessingContext,
        reading: RoadReading,
        surfaces: Sequence[Surface],
        feedback: QgsProcessingFeedback,
    ) -> dict | None:
        """Return the outputs; None if cancelled."""
        areas = areas_of(surface_edges(surfaces), len(surfaces))
        pieces = [
            (polygon(one.rings), [one.label, one.name or None, one.origin, round(float(area), 3)])
            for one, area in zip(surfaces, areas, strict=True)
        ]
        width = self.parameterAsDouble(parameters, DEFAULT_WIDTH, context)
        text = tr("The width of this road is not known; {width:g} m is used.", width=width)
        findings = [(line(reading.roads.line(k)), [reading.features[k], text]) for k in reading.without_width]
        results = {}
        kinds = QgsWkbTypes.Type
        tables = ((SURFACES, kinds.Polygon, pieces), (FINDINGS, kinds.LineString, findings))
        for (name, kind, rows), fields in zip(tables, self._fields, strict=True):
            sink, made = self.parameterAsSink(parameters, name, context, fields, kind, reading.crs)
            if sink is None:
                continue
            if not fill_sink(sink, fields, rows, feedback):
                return None
            results[name] = made
        self.remember(results)
        return results


class _Quiet(QgsFeedback):
    """Forwards cancellation, and drops progress."""

    def __init__(self, other: QgsFeedback) -> None:
        super().__init__()
        other.canceled.connect(self.cancel)
        if other.isCanceled():
            self.cancel()


# --- ``fleet:surfaceatpoint``: points in, the same points with the surface at each of them out ---

POINTS, OUTPUT = "POINTS", "OUTPUT"
_AT_POINTS = {"surface": "string", "surface_name": "string", "surface_origin": "string"}
_AT_ONCE = 10_000
POINT_COUNTS = {
    "ON_COUNT": tr("Points on a surface"),
    "OFF_COUNT": tr("Points on none"),
    "WARNING_COUNT": tr("Warnings"),
}


class SurfaceAtPoint(FleetAlgorithm):
    """Finds the road surface at points."""

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
        for name, title in POINT_COUNTS.items():
            self.addOutput(QgsProcessingOutputNumber(name, title))

    def prepareAlgorithm(
        self, parameters: Parameters, context: QgsProcessingContext, feedback: QgsProcessingFeedback
    ):
        self._fields = fields_of(_AT_POINTS)
        with shown_by_processing():
            layers = self.parameterAsLayerList(parameters, SURFACES, context)
            # Without a project there is none, as in a script without a project file.
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
            # Refuses points without a known place: QGIS would take them for degrees.
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
        return {OUTPUT: made, **dict(zip(POINT_COUNTS, numbers, strict=True))}

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
    """Write the points with their surfaces; return the numbers on one, on none, and odd ones.

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
    """Return the surface of each feature, and notes on odd ones."""
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
