"""``fleet:buildroadnetwork``, ``fleet:checkroadnetwork`` and ``fleet:route``: road networks and routes."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
from qgis.core import (
    QgsGeometry,
    QgsPointXY,
    QgsProcessing,
    QgsProcessingContext,
    QgsProcessingFeedback,
    QgsProcessingOutputNumber,
    QgsProcessingOutputString,
    QgsProcessingParameterFeatureSink,
    QgsProcessingParameterPoint,
    QgsWkbTypes,
)

from ....robot_bridge.core.roads import network_checks
from ....robot_bridge.core.roads.engines import AUTOMATIC
from ....robot_bridge.core.roads.network import Network
from ....robot_bridge.core.roads.network_checks import RoadFinding, RoadFindingKind
from ....robot_bridge.core.roads.path_smoothing import DensePath, dense_path
from ....robot_bridge.core.roads.routes import Route
from ...ui.language import tr, tr_count, tr_page
from ..common import algorithm, road_sources
from ..common.algorithm import FleetAlgorithm, Parameters, fields_of, shown_by_processing
from ..common.outputs import fill_sink, line
from ..common.parameters import point_in

# --- ``fleet:buildroadnetwork``: road centrelines in, edges and nodes out ---

EDGES, NODES = "EDGES", "NODES"
_EDGE = {
    "edge": "int8",
    "feature": "int8",
    "tail": "int8",
    "head": "int8",
    "length_m": "double",
    "width_m": "double",
    "surface": "string",
    "direction": "int8",
    "speed_ms": "double",
    "closed": "int8",
    "level": "int8",
    "part": "int8",
}
_NODE = {"node": "int8", "ends": "int8", "part": "int8"}
NUMBERS = {
    "EDGE_COUNT": tr("Edges"),
    "NODE_COUNT": tr("Nodes"),
    "PART_COUNT": tr("Parts that are not connected"),
    "REPAIR_COUNT": tr("Repairs"),
    road_sources.WARNING_COUNT: tr("Warnings"),
}


class BuildRoadNetwork(FleetAlgorithm):
    """Makes edges and nodes from road centrelines."""

    GROUP = ("roads", tr("Roads"))
    NAME = "buildroadnetwork"
    TITLE = tr("Build road network")
    SUMMARY = tr(
        "Splits road centrelines where they meet, passes over and under at bridges, and repairs on request."
    )
    ICON = "build_road_network.svg"
    TAGS = ("road", "network", "graph", "topology", "noding", "snap", "repair")
    HELP = tr_page("""
    <p>Splits road centrelines where they cross or touch, and makes a layer of edges and one of nodes.</p>
    <p>Roads of different <b>levels</b> meet only where one of them ends in a point of the other: a bridge is
    reached at its ends and passes over what is between them. <b>Direction</b>, speed, width, surface and
    whether a road is closed go over to its edges.</p>
    <p><b>Repair</b> moves ends that stop within the tolerance of a road onto it, cuts off ends that reach
    beyond a road by less, and leaves out what is drawn twice; the log names each repair.
    <i>fleet:checkroadnetwork</i> shows what is broken without changing anything.</p>
    <p>The fields of the edges are those that this algorithm and <i>fleet:route</i> read by themselves.
    docs/roads.md says more.</p>
    """)

    def initAlgorithm(self, configuration: dict[str, Any] | None = None):
        roads, tolerance, *others = road_sources.road_parameters()
        for parameter in (roads, road_sources.repair_parameter(), tolerance, *others):
            self.addParameter(parameter)
        for name, title, kind in (
            (EDGES, tr("Edges"), QgsProcessing.SourceType.TypeVectorLine),
            (NODES, tr("Nodes"), QgsProcessing.SourceType.TypeVectorPoint),
        ):
            self.addParameter(QgsProcessingParameterFeatureSink(name, title, kind))
        for name, title in NUMBERS.items():
            self.addOutput(QgsProcessingOutputNumber(name, title))

    def prepareAlgorithm(
        self, parameters: Parameters, context: QgsProcessingContext, feedback: QgsProcessingFeedback
    ):
        self._fields = fields_of(_EDGE), fields_of(_NODE)
        with shown_by_processing():
            self._source = road_sources.RoadSource(self, parameters, context)
        return True

    def processAlgorithm(
        self, parameters: Parameters, context: QgsProcessingContext, feedback: QgsProcessingFeedback
    ):
        with shown_by_processing(feedback):
            reading = self._source.read(feedback)
            if reading is None:
                return {}
            built = road_sources.network_of_roads(self, parameters, context, reading, feedback)
            if built is None:
                return {}
            network, repairs = built
            feedback.setProgress(80)
            made = {}
            tables = (
                (EDGES, QgsWkbTypes.Type.LineString, _edge_rows(network, reading)),
                (NODES, QgsWkbTypes.Type.Point, _node_rows(network)),
            )
            for (name, kind, rows), fields in zip(tables, self._fields, strict=True):
                sink, made[name] = self.parameterAsSink(parameters, name, context, fields, kind, reading.crs)
                if not fill_sink(sink, fields, rows, feedback):
                    return {}
        parts = len(set(network.parts.tolist()))
        figures = (len(network), len(network.nodes), parts, len(repairs), len(reading.warnings))
        feedback.pushInfo(
            ", ".join(
                (
                    tr_count(len(network), "1 edge", "%n edges"),
                    tr_count(len(network.nodes), "1 node", "%n nodes"),
                    tr_count(parts, "1 part", "%n parts"),
                    tr_count(len(repairs), "1 repair", "%n repairs"),
                )
            )
        )
        return {**made, **dict(zip(NUMBERS, figures, strict=True))}


def _edge_rows(network: Network, reading: road_sources.RoadReading):
    edges = network.edges
    return [
        (
            line(edges.line(k)),
            [
                k,
                reading.features[edges.source[k]],
                int(network.tail[k]),
                int(network.head[k]),
                float(network.lengths[k]),
                float(edges.width[k]),
                str(edges.surface[k]),
                int(edges.direction[k]),
                float(edges.speed[k]),
                int(edges.closed[k]),
                int(edges.level[k]),
                int(network.parts[network.tail[k]]),
            ],
        )
        for k in range(len(network))
    ]


def _node_rows(network: Network):
    return [
        (QgsGeometry.fromPointXY(QgsPointXY(x, y)), [k, int(network.degrees[k]), int(network.parts[k])])
        for k, (x, y) in enumerate(network.nodes.tolist())
    ]


# --- ``fleet:checkroadnetwork``: road centrelines in, a layer of faults of their network out ---

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
        for parameter in road_sources.road_parameters():
            self.addParameter(parameter)
        points = QgsProcessing.SourceType.TypeVectorPoint
        self.addParameter(QgsProcessingParameterFeatureSink(FINDINGS, tr("Findings"), points))
        self.addOutput(QgsProcessingOutputNumber("FINDING_COUNT", tr("Findings")))
        for kind, name in _COUNTS.items():
            self.addOutput(QgsProcessingOutputNumber(name, _TITLES[kind]))
        self.addOutput(QgsProcessingOutputNumber(road_sources.WARNING_COUNT, tr("Warnings")))

    def prepareAlgorithm(
        self, parameters: Parameters, context: QgsProcessingContext, feedback: QgsProcessingFeedback
    ):
        self._fields = fields_of(_FIELDS)
        with shown_by_processing():
            self._source = road_sources.RoadSource(self, parameters, context)
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
            tolerance = self.parameterAsDouble(parameters, road_sources.TOLERANCE, context)
            network = road_sources.network_as_drawn(reading, feedback)
            if network is None:
                return {}
            findings = network_checks.find_road_defects(network, tolerance)
            feedback.setProgress(90)
            kind = QgsWkbTypes.Type.Point
            sink, source = self.parameterAsSink(
                parameters, FINDINGS, context, self._fields, kind, reading.crs
            )
            rows = [_row(finding, reading.features) for finding in findings]
            if not fill_sink(sink, self._fields, rows, feedback):
                return {}
        counts = network_checks.count_by_kind(findings)
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
            road_sources.WARNING_COUNT: len(reading.warnings),
        }


def _row(finding: RoadFinding, features: list[int]):
    values = [
        finding.kind.value,
        int(finding.kind in network_checks.REPAIRED),
        features[finding.road],
        # Users know features, not the numbers of roads.
        finding.in_words(features),
    ]
    return QgsGeometry.fromPointXY(QgsPointXY(finding.x, finding.y)), values


# --- ``fleet:route``: the shortest or fastest route along roads, and the path that a robot drives ---

START, GOAL, BY = "START", "GOAL", "BY"
ENGINE, ROUTE, PATH = "ENGINE", "ROUTE", "PATH"
SHORTEST, FASTEST = "shortest", "fastest"
WAYS = {SHORTEST: tr("shortest"), FASTEST: tr("fastest")}
ENGINE_NAMES = {
    AUTOMATIC: tr("the fastest that is installed"),
    "contraction": "RoutingKit",
    "scipy": "SciPy",
    road_sources.QGIS: "QGIS",
    "plain": tr("none: plain Python"),
}
_ROUTE = {
    "order": "int8",
    "feature": "int8",
    "edge": "int8",
    "length_m": "double",
    "width_m": "double",
    "surface": "string",
}
_PATH = {"metres": "double", "seconds": "double", "points": "int8", "tight": "int8", "engine": "string"}
ROUTE_NUMBERS = {
    "METRES": tr("Length of the route [m]"),
    "SECONDS": tr("Time on the route [s]"),
    "POINT_COUNT": tr("Points of the path"),
    "TIGHT_COUNT": tr("Corners tighter than the robot turns"),
    road_sources.WARNING_COUNT: tr("Warnings"),
}
ENGINE_USED = "ENGINE_USED"


class FindRoute(FleetAlgorithm):
    """Finds a route along roads between two places near them."""

    GROUP = ("roads", tr("Roads"))
    NAME = "route"
    TITLE = tr("Route on roads")
    SUMMARY = tr(
        "Finds the shortest or fastest way along road centrelines, and the path that a robot drives."
    )
    ICON = "route_on_roads.svg"
    STYLES = {ROUTE: "route.qml", PATH: "path.qml"}  # noqa: RUF012
    TAGS = ("road", "route", "shortest path", "fastest", "navigation", "path")
    HELP = tr_page("""
    <p>Finds the way between two places near roads: each is taken to the nearest point of a road that may be
    used. Closed roads are not used, one-way roads in their direction only; <b>surfaces</b> (names with commas
    between) and a <b>least width</b> restrict the way further.</p>
    <p>Edges that lead through a polygon of the <b>areas that must not be driven through</b> are closed; what
    runs along a rim is not.</p>
    <p><b>Route</b> has a line for each stretch of road, in order. <b>Path</b> is what a robot drives: points
    at most so far apart, corners rounded to the turning radius as far as robot and road are wide.
    Corners that stay tighter are counted and named in the log.</p>
    <p>The <b>engine</b> is RoutingKit or SciPy where Python has them, else QGIS's own; the log and
    <i>ENGINE_USED</i> say which was used. All find the same ways.</p>
    <pre>qgis_process run fleet:route -- ROADS=roads.gpkg START="640430,5193530 [EPSG:32633]"
    GOAL="640600,5193570 [EPSG:32633]" SURFACES=asphalt ROUTE=route.gpkg PATH=path.gpkg</pre>
    """)

    def initAlgorithm(self, configuration: dict[str, Any] | None = None):
        roads, tolerance, *others = road_sources.road_parameters()
        ways = algorithm.enum_parameter(BY, tr("Way"), WAYS, SHORTEST)
        engine = algorithm.advanced(algorithm.enum_parameter(ENGINE, tr("Engine"), ENGINE_NAMES, AUTOMATIC))
        for parameter in (
            roads,
            QgsProcessingParameterPoint(START, tr("Start")),
            QgsProcessingParameterPoint(GOAL, tr("Goal")),
            ways,
            road_sources.surfaces_parameter(),
            *road_sources.length_parameters(),
            road_sources.keepout_parameter(),
            road_sources.repair_parameter(),
            tolerance,
            *others,
            engine,
        ):
            self.addParameter(parameter)
        lines = QgsProcessing.SourceType.TypeVectorLine
        self.addParameter(QgsProcessingParameterFeatureSink(ROUTE, tr("Route"), lines))
        self.addParameter(QgsProcessingParameterFeatureSink(PATH, tr("Path"), lines))
        for name, title in ROUTE_NUMBERS.items():
            self.addOutput(QgsProcessingOutputNumber(name, title))
        self.addOutput(QgsProcessingOutputString(ENGINE_USED, tr("Engine that was used")))

    def prepareAlgorithm(
        self, parameters: Parameters, context: QgsProcessingContext, feedback: QgsProcessingFeedback
    ):
        self._fields = algorithm.fields_of(_ROUTE), algorithm.fields_of(_PATH)
        with algorithm.shown_by_processing():
            self._source = road_sources.RoadSource(self, parameters, context)
            self._keepouts = road_sources.KeepoutAreas(self, parameters, context)
        return True

    def processAlgorithm(
        self, parameters: Parameters, context: QgsProcessingContext, feedback: QgsProcessingFeedback
    ):
        with algorithm.shown_by_processing(feedback):
            wishes = road_sources.driving_options(self, parameters, context)
            reading = self._source.read(feedback)
            if reading is None:
                return {}
            reading.warnings += wishes.doubts(reading.roads)
            built = road_sources.network_of_roads(self, parameters, context, reading, feedback)
            if built is None:
                return {}
            network, _ = built
            router = road_sources.router_on(network, self.parameterAsEnumString(parameters, ENGINE, context))
            reading.warnings += self._keepouts.close(router, reading.crs, feedback)
            feedback.setProgress(80)
            fastest = self.parameterAsEnumString(parameters, BY, context) == FASTEST
            route = router.route(
                *(point_in(self, parameters, name, context, reading.crs) for name in (START, GOAL)),
                replace(wishes.restrictions, fastest=fastest),
                wishes.reach,
            )
            path = dense_path(route.points, route.widths, wishes.driving)
            made = self._written(route, path, reading, parameters, context, feedback)
        self.remember(made)
        _report(route, path, feedback)
        figures = (route.metres, route.seconds, len(path.points), len(path.tight), len(reading.warnings))
        return {**made, **dict(zip(ROUTE_NUMBERS, figures, strict=True)), ENGINE_USED: route.engine}

    def _written(
        self,
        route: Route,
        path: DensePath,
        reading: road_sources.RoadReading,
        parameters: Parameters,
        context: QgsProcessingContext,
        feedback: QgsProcessingFeedback,
    ):
        one = [round(route.metres, 3), round(route.seconds, 3), len(path.points), len(path.tight)]
        tables = (
            (ROUTE, _stretches(route, reading)),
            (PATH, [(line(path.points), [*one, route.engine])]),
        )
        made = {}
        for (name, rows), fields in zip(tables, self._fields, strict=True):
            kind = QgsWkbTypes.Type.LineString
            sink, made[name] = self.parameterAsSink(parameters, name, context, fields, kind, reading.crs)
            fill_sink(sink, fields, rows, feedback)
        return made


def _stretches(route: Route, reading: road_sources.RoadReading):
    edges = route.network.edges
    return [
        (
            line(points),
            [
                order,
                reading.features[edges.source[edge]],
                edge,
                float(np.round(route.lengths[order], 3)),
                float(edges.width[edge]),
                str(edges.surface[edge]),
            ],
        )
        for order, (edge, points) in enumerate(zip(route.edges.tolist(), route.lines, strict=True))
    ]


def _report(route: Route, path: DensePath, feedback: QgsProcessingFeedback) -> None:
    feedback.pushInfo(
        tr(
            "{metres:.1f} m, {seconds:.1f} s, {points}, found by {engine}; start {off_start:.2f} m "
            "and goal {off_goal:.2f} m from the road",
            metres=route.metres,
            seconds=route.seconds,
            points=tr_count(len(path.points), "1 point", "%n points"),
            engine=route.engine,
            off_start=route.off_start,
            off_goal=route.off_goal,
        )
    )
    for x, y in path.tight.tolist():
        feedback.pushWarning(
            tr("The corner at ({x:.2f}, {y:.2f}) is tighter than the robot turns.", x=x, y=y)
        )
