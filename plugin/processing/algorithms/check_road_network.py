"""``fleet:checkroadnetwork``: road centrelines in, a layer of what is odd in their network out."""

from __future__ import annotations

from typing import Any

from qgis.core import (
    QgsGeometry,
    QgsPointXY,
    QgsProcessing,
    QgsProcessingContext,
    QgsProcessingFeedback,
    QgsProcessingOutputNumber,
    QgsProcessingParameterFeatureSink,
    QgsWkbTypes,
)

from ....robot_bridge.core.roads.network_checks import (
    REPAIRED,
    RoadFinding,
    RoadFindingKind,
    count_by_kind,
    find_road_defects,
)
from ...ui.language import tr, tr_page
from ..common.algorithm import FleetAlgorithm, Parameters, fields_of, shown_by_processing
from ..common.outputs import fill_sink
from ..common.road_sources import TOLERANCE, WARNING_COUNT, RoadSource, network_as_drawn, road_parameters

FINDINGS = "FINDINGS"
_FIELDS = {"kind": "string", "repairable": "int8", "feature": "int8", "text": "string"}
_COUNTS = {
    kind: f"{kind.value.upper().replace(' ', '_').replace('-', '_')}_COUNT" for kind in RoadFindingKind
}
_TITLES = {
    RoadFindingKind.GAP: tr("Gaps"),
    RoadFindingKind.OVERSHOOT: tr("Overshoots"),
    RoadFindingKind.DUPLICATE: tr("Roads drawn twice"),
    RoadFindingKind.DEAD_END: tr("Dead ends"),
    RoadFindingKind.PART: tr("Parts of their own"),
    RoadFindingKind.ONE_WAY: tr("Edges without a way back"),
}


class CheckRoadNetwork(FleetAlgorithm):
    """Shows gaps, overshoots, duplicates, dead ends, parts and one-way traps of a road network."""

    GROUP = ("roads", tr("Roads"))
    NAME = "checkroadnetwork"
    TITLE = tr("Check road network")
    SUMMARY = tr(
        "Finds gaps, overshoots, duplicates, dead ends, separate parts and one-way traps in road centrelines."
    )
    ICON = "check_road_network.svg"
    TAGS = ("road", "network", "topology", "check", "gap", "dangle", "one-way")
    HELP = tr_page("""
    <p>Checks the network that road centrelines make, and makes a layer of points that show what is odd, each
    with the feature to look at. Nothing is changed.</p>
    <p>What <i>fleet:buildroadnetwork</i> repairs: <b>gap</b>, an end that stops within the tolerance of
    another road; <b>overshoot</b>, an end that reaches beyond a road by less than that; <b>duplicate</b>, a
    stretch that is drawn twice.</p>
    <p>What only people can judge: <b>dead end</b>; <b>disconnected part</b>, roads that are connected with
    one another but not with the longest part; <b>one-way</b>, roads from which no way leads back because of
    the directions.</p>
    """)

    def initAlgorithm(self, configuration: dict[str, Any] | None = None):
        for parameter in road_parameters():
            self.addParameter(parameter)
        points = QgsProcessing.SourceType.TypeVectorPoint
        self.addParameter(QgsProcessingParameterFeatureSink(FINDINGS, tr("Findings"), points))
        self.addOutput(QgsProcessingOutputNumber("FINDING_COUNT", tr("Findings")))
        for kind, name in _COUNTS.items():
            self.addOutput(QgsProcessingOutputNumber(name, _TITLES[kind]))
        self.addOutput(QgsProcessingOutputNumber(WARNING_COUNT, tr("Warnings")))

    def prepareAlgorithm(
        self, parameters: Parameters, context: QgsProcessingContext, feedback: QgsProcessingFeedback
    ):
        self._fields = fields_of(_FIELDS)
        with shown_by_processing():
            self._source = RoadSource(self, parameters, context)
        return True

    def processAlgorithm(
        self, parameters: Parameters, context: QgsProcessingContext, feedback: QgsProcessingFeedback
    ):
        with shown_by_processing(feedback):
            reading = self._source.read(feedback)
            if reading is None:
                return {}
            for warning in reading.warnings:
                feedback.pushWarning(warning)
            tolerance = self.parameterAsDouble(parameters, TOLERANCE, context)
            network = network_as_drawn(reading, feedback)
            if network is None:
                return {}
            findings = find_road_defects(network, tolerance)
            feedback.setProgress(90)
            kind = QgsWkbTypes.Type.Point
            sink, source = self.parameterAsSink(
                parameters, FINDINGS, context, self._fields, kind, reading.crs
            )
            rows = [_row(finding, reading.features) for finding in findings]
            if not fill_sink(sink, self._fields, rows, feedback):
                return {}
        counts = count_by_kind(findings)
        for name, count in counts.items():
            if count:
                feedback.pushInfo(f"{name}: {count}")
        if not findings:
            feedback.pushInfo(tr("Nothing is odd in this network."))
        numbers = {_COUNTS[kind]: counts[kind.value] for kind in RoadFindingKind}
        return {
            FINDINGS: source,
            "FINDING_COUNT": len(findings),
            **numbers,
            WARNING_COUNT: len(reading.warnings),
        }


def _row(finding: RoadFinding, features: list[int]):
    values = [
        finding.kind.value,
        int(finding.kind in REPAIRED),
        features[finding.road],
        # People know features, not the numbers of roads.
        finding.in_words(features),
    ]
    return QgsGeometry.fromPointXY(QgsPointXY(finding.x, finding.y)), values
