"""What else finds ways on a network: RoutingKit alone, networkx and QGIS, on the same graph."""

from __future__ import annotations

import os
import sys
from collections.abc import Callable

import networkx
import numpy as np
from qgis.analysis import QgsNativeAlgorithms
from qgis.core import (
    QgsApplication,
    QgsFeature,
    QgsGeometry,
    QgsPointXY,
    QgsProcessingContext,
    QgsProcessingFeedback,
    QgsProject,
    QgsVectorLayer,
)

from robot_bridge.core.roads.engines import ContractionEngines, RouteGraph
from robot_bridge.core.roads.network import Network

NO_WAY = "There is no route"
"""What QGIS says where there is none."""
Query = Callable[[int, int], object]


def directed(network: Network) -> networkx.DiGraph:
    """Return the network for networkx; of parallel arcs the shortest."""
    graph = networkx.DiGraph()
    lengths = network.lengths.tolist()
    for edge, tail, head in zip(*(column.tolist() for column in network.arcs()), strict=True):
        if not graph.has_edge(tail, head) or graph[tail][head]["weight"] > lengths[edge]:
            graph.add_edge(tail, head, weight=lengths[edge])
    return graph


def by_networkx(network: Network, graph: networkx.DiGraph) -> Query:
    """Return A* with the straight line as the estimate."""
    nodes = network.nodes.tolist()

    def straight(a: int, b: int) -> float:
        (x, y), (u, v) = nodes[a], nodes[b]
        return ((x - u) ** 2 + (y - v) ** 2) ** 0.5

    def query(a: int, b: int) -> object:
        try:
            return networkx.astar_path(graph, a, b, heuristic=straight)
        except networkx.NetworkXNoPath:
            return None

    return query


def by_routingkit(network: Network) -> tuple[Query, Query]:
    """Return RoutingKit with nothing around it: with one query kept for all, and one made for each.

    A query that is kept belongs to one thread, and until it is gone no cost can be changed.
    """
    edge, tail, head = network.arcs()
    made = ContractionEngines(RouteGraph(network.nodes, tail, head))
    tenths_of_mm = np.maximum(np.rint(network.lengths[edge] * 1e4), 1).astype(np.int64)
    metric = made.kit.CCHMetric(made.hierarchy, tenths_of_mm.tolist())
    kept = made.kit.CCHQuery(metric)
    return (
        lambda a, b: kept.run(a, b).arc_path,
        lambda a, b: made.kit.CCHQuery(metric).run(a, b).arc_path,
    )


def by_graph_analyzer(network: Network, engine: type) -> Query:
    """Return QgsGraphAnalyzer on a graph that is kept; ``engine`` is the plugin's."""
    edge, tail, head = network.arcs()
    made = engine(RouteGraph(network.nodes, tail, head), network.lengths[edge])
    return lambda a, b: made.way([(a, 0.0)], [(b, 0.0)])


def by_native(network: Network) -> Query:
    """Return native:shortestpathpointtopoint on a layer of the edges."""
    layer = QgsVectorLayer("LineString?crs=EPSG:32633", "edges", "memory")
    features = []
    for k in range(len(network)):
        feature = QgsFeature()
        points = [QgsPointXY(x, y) for x, y in network.edges.line(k).tolist()]
        feature.setGeometry(QgsGeometry.fromPolylineXY(points))
        features.append(feature)
    layer.dataProvider().addFeatures(features)
    algorithm = QgsApplication.processingRegistry().algorithmById("native:shortestpathpointtopoint")
    nodes = network.nodes.tolist()

    def query(a: int, b: int) -> object:
        places = {"START_POINT": "{},{}".format(*nodes[a]), "END_POINT": "{},{}".format(*nodes[b])}
        given = {"INPUT": layer, "STRATEGY": 0, "OUTPUT": "memory:", **places}
        # Each is named: QGIS does not keep alive what it is given.
        one, context, feedback = algorithm.create(), QgsProcessingContext(), QgsProcessingFeedback()
        context.setProject(QgsProject.instance())
        results, done = one.run(given, context, feedback)
        if not done and NO_WAY in feedback.textLog():
            return None
        assert done, feedback.textLog()
        return results["TRAVEL_COST"]

    return query


def start_qgis() -> QgsApplication:
    """Return a QGIS without windows; to be kept as long as it is used."""
    os.environ.setdefault("QT_QPA_PLATFORM", "offscreen")
    application = QgsApplication.instance() or QgsApplication([arg.encode() for arg in sys.argv[:1]], False)
    application.initQgis()
    application.processingRegistry().addProvider(QgsNativeAlgorithms(application.processingRegistry()))
    return application
