"""``fleet:route``: the shortest or fastest way along roads, and the path that a robot drives."""

from __future__ import annotations

import importlib.util
import math
from dataclasses import replace
from typing import Any

import numpy as np
from qgis.analysis import QgsGraph, QgsGraphAnalyzer
from qgis.core import (
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

from ....robot_bridge.core.roads.engines import AUTOMATIC, Ends, RouteGraph
from ....robot_bridge.core.roads.network import Network
from ....robot_bridge.core.roads.path_smoothing import DensePath, dense_path
from ....robot_bridge.core.roads.routes import Route, Router
from ...ui.language import tr, tr_count, tr_page
from ..common import algorithm, road_sources
from ..common.algorithm import FleetAlgorithm, Parameters
from ..common.outputs import fill_sink, line
from ..common.parameters import point_in

# --- QGIS's own graph search: what is left where neither RoutingKit nor SciPy is installed ---


class GraphEngine:
    """Finds ways by QgsGraphAnalyzer on a graph that is kept; it is made again when costs have changed."""

    name = "QGIS (QgsGraphAnalyzer)"

    def __init__(self, graph: RouteGraph, costs: np.ndarray) -> None:
        self._graph = graph
        self._costs = costs.copy()
        self._made: QgsGraph | None = None
        self._arcs: list[int] = []

    def set_costs(self, arcs: np.ndarray, costs: np.ndarray) -> None:
        """Give ``arcs`` other costs."""
        self._costs[arcs] = costs
        self._made = None

    def way(self, starts: Ends, goals: Ends) -> list[int] | None:
        """Return the arcs of the cheapest way, None for none."""
        made = self._made or self._make()
        least, tree, last = math.inf, [], -1
        for node, before in starts:
            came_by, away = QgsGraphAnalyzer.dijkstra(made, node, 0)
            for goal, beyond in goals:
                # Nodes that cannot be reached cost the greatest number there is.
                cost = before + away[goal] + beyond if goal == node or came_by[goal] >= 0 else math.inf
                if cost < least:
                    least, tree, last = cost, came_by, goal
        return None if last < 0 else self._back(tree, last)

    def _back(self, tree: list[int], node: int) -> list[int]:
        arcs = []
        while tree[node] >= 0:
            arc = self._arcs[tree[node]]
            arcs.append(arc)
            node = int(self._graph.tail[arc])
        return arcs[::-1]

    def _make(self) -> QgsGraph:
        made = QgsGraph()
        for x, y in self._graph.nodes.tolist():
            made.addVertex(QgsPointXY(x, y))
        self._arcs = np.flatnonzero(np.isfinite(self._costs)).tolist()
        for arc in self._arcs:
            ends = int(self._graph.tail[arc]), int(self._graph.head[arc])
            made.addEdge(*ends, [float(self._costs[arc])])
        self._made = made
        return made


# --- ``fleet:route``: the shortest or fastest way along roads, and the path that a robot drives ---

START, GOAL, BY = "START", "GOAL", "BY"
ENGINE, ROUTE, PATH = "ENGINE", "ROUTE", "PATH"
SHORTEST, FASTEST = "shortest", "fastest"
QGIS = "qgis"
WAYS = {SHORTEST: tr("shortest"), FASTEST: tr("fastest")}
ENGINE_NAMES = {
    AUTOMATIC: tr("the fastest that is installed"),
    "contraction": "RoutingKit",
    "scipy": "SciPy",
    QGIS: "QGIS",
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
NUMBERS = {
    "METRES": tr("Length of the route [m]"),
    "SECONDS": tr("Time on the route [s]"),
    "POINT_COUNT": tr("Points of the path"),
    "TIGHT_COUNT": tr("Corners tighter than the robot turns"),
    road_sources.WARNING_COUNT: tr("Warnings"),
}
ENGINE_USED = "ENGINE_USED"


class FindRoute(FleetAlgorithm):
    """Finds a way along roads between two places near them."""

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
        for name, title in NUMBERS.items():
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
            router = _router(network, self.parameterAsEnumString(parameters, ENGINE, context))
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
        return {**made, **dict(zip(NUMBERS, figures, strict=True)), ENGINE_USED: route.engine}

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


def _router(network: Network, engine: str) -> Router:
    stock = not any(importlib.util.find_spec(name) for name in ("routingkit_cch", "scipy"))
    if engine == QGIS or (engine == AUTOMATIC and stock):
        return Router(network, _of_qgis)
    return Router(network, engine)


def _of_qgis(graph: RouteGraph):
    return lambda costs: GraphEngine(graph, costs)


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
