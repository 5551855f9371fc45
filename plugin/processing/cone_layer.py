"""The layers that cones become, and the CRS they are in."""

from __future__ import annotations

from collections.abc import Sequence

from qgis.core import (
    QgsGeometry,
    QgsPointXY,
    QgsProcessing,
    QgsProcessingAlgorithm,
    QgsProcessingContext,
    QgsProcessingFeatureSource,
    QgsProcessingFeedback,
    QgsProcessingOutputNumber,
    QgsProcessingParameterCrs,
    QgsProcessingParameterDefinition,
    QgsProcessingParameterFeatureSink,
    QgsWkbTypes,
)

from ...robot_bridge.compass import heading_of
from ...robot_bridge.layouts.checks import Finding
from ...robot_bridge.layouts.cone import Cone
from ..language import tr, tr_count
from .cone_ground import Ground
from .errors import ParameterError
from .fleet_algorithm import FleetAlgorithm, Parameters, fields_of
from .sinks import fill
from .site_crs_choice import SITE_CRS, chosen_crs

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


def site_crs_parameter() -> QgsProcessingParameterDefinition:
    """Return the parameter of the CRS that the cones get."""
    title = tr("Site CRS, in metres (default: the project's, else the line's or the layer's)")
    return QgsProcessingParameterCrs(SITE_CRS, title, optional=True)


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
    """What is taken from the parameters in the main thread: fields, checks, and the CRS."""

    def __init__(
        self,
        algorithm: QgsProcessingAlgorithm,
        parameters: Parameters,
        context: QgsProcessingContext,
        source: QgsProcessingFeatureSource | None,
    ):
        """:raises SiteCrsError: when the CRS cannot carry a site."""
        self._fields = {CONES: fields_of(CONE_FIELDS), FINDINGS: fields_of(_FINDINGS)}
        self._ground = Ground(algorithm, parameters, context)
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
        """Check and write ``cones``; return the outputs, none after a cancel."""
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
                fill(sink, fields, rows[name], feedback)
        if not findings and context.willLoadLayerOnCompletion(made.get(FINDINGS, "")):
            _do_not_load(made[FINDINGS], context)
            feedback.pushInfo(tr("There are no findings: their layer is empty, and is not loaded."))
        algorithm.remember(made)
        feedback.pushInfo(tr_count(len(cones), "1 cone", "%n cones"))
        return {**made, CONE_COUNT: len(cones), FINDING_COUNT: len(findings)}


def _do_not_load(made: str, context: QgsProcessingContext) -> None:
    """Let QGIS not load the layer ``made`` when the algorithm has ended: an empty one says nothing."""
    wanted = context.layersToLoadOnCompletion()
    context.setLayersToLoadOnCompletion({key: wanted[key] for key in wanted if key != made})


def _point(what: Cone | Finding) -> QgsGeometry:
    return QgsGeometry.fromPointXY(QgsPointXY(what.x, what.y))


def cone_values(cone: Cone, layout: str) -> list:
    """Return the values of the fields ``CONE_FIELDS``."""
    heading = round(heading_of(cone.theta), 6) % 360.0
    return [cone.id, cone.order, heading, cone.colour, cone.role, layout]
