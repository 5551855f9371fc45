"""``fleet:buildroadsurfaces``: centrelines with widths in, road surfaces dissolved by class out."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from qgis.core import (
    QgsFeedback,
    QgsProcessing,
    QgsProcessingContext,
    QgsProcessingFeedback,
    QgsProcessingOutputNumber,
    QgsProcessingParameterFeatureSink,
    QgsProcessingParameterMultipleLayers,
    QgsProcessingParameterString,
    QgsWkbTypes,
)

from ....robot_bridge.core.errors import RoadsCancelledError
from ....robot_bridge.core.roads.centrelines import GENERATED, Surface
from ....robot_bridge.core.roads.surface_generation import PRECEDENCE as USUAL_ORDER
from ....robot_bridge.core.roads.surface_generation import generate_surfaces
from ....robot_bridge.core.roads.surface_index import areas_of, surface_edges
from ...layers.layer_source import obstacle_sources
from ...layers.road_layers import GroundReading, read_surfaces
from ...layers.roles import LayerExpressions
from ...layers.site_transform import SiteGeoreference
from ...ui.language import tr, tr_count, tr_page
from ..common.algorithm import FleetAlgorithm, Parameters, fields_of, shown_by_processing
from ..common.outputs import fill_sink, line, polygon
from ..common.road_sources import DEFAULT_WIDTH, WARNING_COUNT, RoadReading, RoadSource, road_parameters

DRAWN, PRECEDENCE, SURFACES, FINDINGS = "DRAWN", "PRECEDENCE", "SURFACES", "FINDINGS"
_OF_ROADS = ("ROADS", "WIDTH", "SURFACE", DEFAULT_WIDTH, "SITE_CRS")
"""What is asked about roads: of how they are driven nothing is needed here."""
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
    """Makes road surfaces of centrelines by their widths."""

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
        # What an earlier run generated is made again.
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
        """Return the outputs; None after a cancel."""
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
    """Passes a cancel on, and keeps progress to itself."""

    def __init__(self, other: QgsFeedback) -> None:
        super().__init__()
        other.canceled.connect(self.cancel)
        if other.isCanceled():
            self.cancel()
