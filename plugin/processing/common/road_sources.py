"""Roads and keepouts read from layers, the driving options, and QGIS's own path search."""

from __future__ import annotations

import importlib.util
import math
from dataclasses import dataclass, field

import numpy as np
from qgis.analysis import QgsGraph, QgsGraphAnalyzer
from qgis.core import (
    QgsCoordinateReferenceSystem,
    QgsPointXY,
    QgsProcessing,
    QgsProcessingAlgorithm,
    QgsProcessingContext,
    QgsProcessingFeatureSource,
    QgsProcessingFeedback,
    QgsProcessingParameterBoolean,
    QgsProcessingParameterDefinition,
    QgsProcessingParameterExpression,
    QgsProcessingParameterFeatureSource,
    QgsProcessingParameterMultipleLayers,
    QgsProcessingParameterNumber,
    QgsProcessingParameterString,
)

from ....robot_bridge.core.errors import RoadsCancelledError
from ....robot_bridge.core.roads.engines import AUTOMATIC, Ends, RouteGraph
from ....robot_bridge.core.roads.network import (
    DEFAULT_SPEED,
    CancelCheck,
    Centrelines,
    Network,
    build_network,
    centrelines,
)
from ....robot_bridge.core.roads.network_checks import RoadFinding, repaired_network
from ....robot_bridge.core.roads.path_smoothing import Driving
from ....robot_bridge.core.roads.routes import REACH, Restrictions, Router
from ...layers import road_layers
from ...layers.layer_expressions import LayerRules
from ...layers.layer_source import FeatureReader, obstacle_sources
from ...layers.roles import KEEPOUT, LayerExpressions, expressions_of
from ...layers.site_transform import LayerToSiteTransform, SiteGeoreference
from ...ui.language import tr, tr_count
from .algorithm import ParameterError, Parameters, advanced
from .parameters import chosen_crs, filter_in, layer_in, site_crs_parameter

# --- Driving options and roads that may be used: parameters of routes and assignments ---

SURFACES, LEAST_WIDTH, DISTANCE = "SURFACES", "LEAST_WIDTH", "DISTANCE"
SPACING, TURNING_RADIUS, ROBOT_WIDTH = "SPACING", "TURNING_RADIUS", "ROBOT_WIDTH"
_USUAL = Driving()
_LENGTHS = {
    LEAST_WIDTH: (tr("Roads at least this wide, and as wide as the robot [m]"), 0.0, 0.0),
    DISTANCE: (tr("Farthest place from a road [m]"), REACH, 0.0),
    SPACING: (tr("Points of the path at most this far apart [m]"), _USUAL.spacing, 0.01),
    TURNING_RADIUS: (tr("Turning radius of the robot [m]"), _USUAL.turning_radius, 0.0),
    ROBOT_WIDTH: (tr("Width of the robot [m]"), _USUAL.robot_width, 0.0),
}


@dataclass(frozen=True)
class DrivingOptions:
    """How paths are driven, which roads may be used, and the greatest distance of a place from one, m."""

    driving: Driving
    restrictions: Restrictions
    reach: float

    def doubts(self, roads: Centrelines) -> list[str]:
        """Return a warning: surfaces that none of ``roads`` has."""
        there = {str(surface) for surface in roads.surface}
        unknown = (self.restrictions.surfaces or frozenset()) - there
        if not unknown:
            return []
        none = tr("none")
        return [
            tr(
                "No road has the surface {surfaces}: the roads have {there}.",
                surfaces=", ".join(sorted(unknown)),
                there=", ".join(sorted(surface or f"({none})" for surface in there)) or none,
            )
        ]


def surfaces_parameter() -> QgsProcessingParameterDefinition:
    """Return the parameter of the surfaces that may be used."""
    return QgsProcessingParameterString(
        SURFACES, tr("Surfaces that may be used (default: all)"), optional=True
    )


def length_parameters() -> list[QgsProcessingParameterDefinition]:
    """Return the parameters in metres."""
    real = QgsProcessingParameterNumber.Type.Double
    return [
        QgsProcessingParameterNumber(name, title, real, value, minValue=least)
        for name, (title, value, least) in _LENGTHS.items()
    ]


def driving_options(
    algorithm: QgsProcessingAlgorithm, parameters: Parameters, context: QgsProcessingContext
) -> DrivingOptions:
    """Return the options in the parameters; as in the gateway no way leads where the robot is too wide.

    :raises RoadInputError: when a number is invalid for driving.
    """
    metres = {name: algorithm.parameterAsDouble(parameters, name, context) for name in _LENGTHS}
    names = algorithm.parameterAsString(parameters, SURFACES, context).split(",")
    surfaces = frozenset(name.strip() for name in names if name.strip())
    return DrivingOptions(
        Driving(metres[SPACING], metres[TURNING_RADIUS], metres[ROBOT_WIDTH]),
        Restrictions(surfaces=surfaces or None, least_width=max(metres[LEAST_WIDTH], metres[ROBOT_WIDTH])),
        metres[DISTANCE],
    )


# --- Areas that a route must avoid, from polygon layers ---

KEEPOUTS = "KEEPOUTS"


def keepout_parameter() -> QgsProcessingParameterDefinition:
    """Return the parameter of the layers."""
    return QgsProcessingParameterMultipleLayers(
        KEEPOUTS,
        tr("Areas that must not be driven through"),
        QgsProcessing.SourceType.TypeVectorPolygon,
        optional=True,
    )


class KeepoutAreas:
    """The layers of one run; must be created in the thread of the layers."""

    def __init__(
        self, algorithm: QgsProcessingAlgorithm, parameters: Parameters, context: QgsProcessingContext
    ) -> None:
        layers = algorithm.parameterAsLayerList(parameters, KEEPOUTS, context)
        expressions = algorithm.createExpressionContext(parameters, context)
        self._transforms = context.transformContext()
        self._sources = obstacle_sources(layers, LayerExpressions(), expressions) if layers else []

    def close(
        self, router: Router, crs: QgsCoordinateReferenceSystem, feedback: QgsProcessingFeedback
    ) -> list[str]:
        """Close the edges of ``router``, whose network is in ``crs``, that enter an area.

        Return the warnings.

        :raises LayerReadingError: when a layer has no known place in ``crs``.
        """
        closed, warnings = self.edges_inside(router.network, crs, feedback)
        if closed:
            router.close(closed)
        return warnings

    def edges_inside(
        self, network: Network, crs: QgsCoordinateReferenceSystem, feedback: QgsProcessingFeedback
    ) -> tuple[list[int], list[str]]:
        """Return the edges of ``network``, which is in ``crs``, that enter an area, and the warnings.

        An edge along the boundary of an area does not enter it.

        :raises LayerReadingError: when a layer has no known place in ``crs``.
        """
        if not self._sources:
            return [], []
        site = SiteGeoreference.in_crs(crs, self._transforms)
        reading = road_layers.read_areas(self._sources, site, KEEPOUT, feedback)
        for warning in reading.warnings:
            feedback.pushWarning(warning)
        closed = road_layers.edges_through(network, [area.rings for area in reading.items])
        if closed:
            feedback.pushInfo(
                tr_count(
                    len(closed),
                    "1 edge leads through areas to be avoided, and is closed",
                    "%n edges lead through areas to be avoided, and are closed",
                )
            )
        return closed, reading.warnings


# --- Centrelines for the network, read from the input layer of an algorithm ---

ROADS, DEFAULT_WIDTH, SPEED_DEFAULT = "ROADS", "DEFAULT_WIDTH", "DEFAULT_SPEED"
TOLERANCE, REPAIR = "TOLERANCE", "REPAIR"
WARNING_COUNT = "WARNING_COUNT"

_REAL = QgsProcessingParameterNumber.Type.Double
_EXPRESSIONS = {
    "WIDTH": tr("Width of each road [m] (default: the layer's role, else a field width_m or width)"),
    "SURFACE": tr("Surface of each road (default: the layer's role, else a field surface)"),
    "DIRECTION": tr("Direction: yes along the line, -1 against it, no both (default: a field oneway, ...)"),
    "SPEED": tr("Speed on each road [m/s] (default: a field speed_ms, or maxspeed in km/h)"),
    "CLOSED": tr("Whether each road is closed (default: a field closed)"),
    "LEVEL": tr("Level of each road, 0 on the ground (default: fields level, layer, bridge, tunnel)"),
}
_ROLE = {"width": "width", "surface": "semantics"}
"""Expressions of a layer's role that give attributes of a road."""


@dataclass
class RoadReading:
    """Roads in metres; road ``k`` is a part of feature ``features[k]``.

    ``without_width`` are the roads of unknown width, which have the default one.
    """

    roads: Centrelines
    features: list[int]
    crs: QgsCoordinateReferenceSystem
    placing: LayerToSiteTransform
    warnings: list[str] = field(default_factory=list)
    without_width: list[int] = field(default_factory=list)


def road_parameters() -> list[QgsProcessingParameterDefinition]:
    """Return the parameters of the roads' attributes."""
    others: list[QgsProcessingParameterDefinition] = [
        QgsProcessingParameterExpression(name, title, parentLayerParameterName=ROADS, optional=True)
        for name, title in _EXPRESSIONS.items()
    ]
    others += [
        QgsProcessingParameterNumber(
            DEFAULT_WIDTH,
            tr("Width of roads of which it is not known [m]"),
            _REAL,
            road_layers.DEFAULT_WIDTH_M,
            minValue=0.01,
        ),
        QgsProcessingParameterNumber(
            SPEED_DEFAULT,
            tr("Speed on roads of which it is not known [m/s]"),
            _REAL,
            DEFAULT_SPEED,
            minValue=0.01,
        ),
        site_crs_parameter(tr("CRS in metres (default: the layer's, or the project's)")),
    ]
    lines = [QgsProcessing.SourceType.TypeVectorLine]
    return [
        QgsProcessingParameterFeatureSource(ROADS, tr("Road centrelines"), lines),
        QgsProcessingParameterNumber(
            TOLERANCE, tr("Ends this near to a road were meant to meet it [m]"), _REAL, 0.5, minValue=0.0
        ),
        *map(advanced, others),
    ]


def repair_parameter() -> QgsProcessingParameterDefinition:
    """Return the parameter that enables repairs."""
    return QgsProcessingParameterBoolean(
        REPAIR, tr("Repair: close gaps, cut overshoots, leave out what is drawn twice"), defaultValue=False
    )


class RoadSource:
    """The layer of roads of one run; created in the main thread, read in any."""

    def __init__(
        self, algorithm: QgsProcessingAlgorithm, parameters: Parameters, context: QgsProcessingContext
    ) -> None:
        layer = layer_in(algorithm, parameters, ROADS, context)
        role = expressions_of(layer) if layer is not None else LayerExpressions()
        self._counted = filter_in(algorithm, parameters, ROADS, context)
        self._algorithm, self._parameters, self._context = algorithm, parameters, context
        given = {
            name.lower(): algorithm.parameterAsString(parameters, name, context) for name in _EXPRESSIONS
        }
        for name, of_role in _ROLE.items():
            given[name] = given[name] or getattr(role, of_role)
        self._expressions = road_layers.RoadExpressions(**given)

    def read(self, feedback: QgsProcessingFeedback) -> RoadReading | None:
        """Return the roads; None if cancelled.

        :raises FleetError: when the layer, its CRS or an expression cannot be used.
        """
        source = self._algorithm.parameterAsSource(self._parameters, ROADS, self._context)
        if source is None:
            raise ParameterError(
                tr(
                    "ROADS {roads} cannot be opened: check the file and the layer's name.",
                    roads=self._parameters.get(ROADS),
                )
            )
        if source.featureCount() == 0:
            # Reported before the CRS is checked: an empty layer often has none.
            raise ParameterError(_no_roads(source.sourceName(), 0, []))
        given = self._algorithm, self._parameters, self._context
        crs = chosen_crs(*given, [source.sourceCrs()], layer_first=True)
        site = SiteGeoreference.in_crs(crs, self._context.transformContext())
        placing = site.of_layer(source.sourceName(), source.sourceCrs())
        return self._read(source, crs, placing, feedback)

    def _read(
        self,
        source: QgsProcessingFeatureSource,
        crs: QgsCoordinateReferenceSystem,
        placing: LayerToSiteTransform,
        feedback: QgsProcessingFeedback,
    ) -> RoadReading | None:
        name = source.sourceName()
        scope = self._algorithm.createExpressionContext(self._parameters, self._context, source)
        rules = LayerRules(name, source.fields(), scope)
        road_rules = road_layers.RoadRules(rules, self._expressions)
        lines: list[np.ndarray] = []
        known: list[road_layers.RoadAttributes] = []
        features: list[int] = []
        warnings: list[str] = []
        reader = FeatureReader(name, source, placing, self._counted, feedback, 50.0)
        for feature, _, geometry, notes in reader:
            rules.at(feature)
            found = [] if geometry is None else road_layers.lines_of(geometry, notes)
            if found:
                known += [road_rules.of(notes)] * len(found)
            lines += found
            features += [feature.id()] * len(found)
            warnings += [
                tr("Layer {name}, feature {id}: {note}", name=name, id=feature.id(), note=note)
                for note in notes
            ]
        if not reader.complete:
            return None
        if not lines:
            raise ParameterError(_no_roads(name, source.featureCount(), warnings))
        reading = RoadReading(self._columns(lines, known, name, warnings), features, crs, placing, warnings)
        reading.warnings += rules.warnings
        reading.without_width += [k for k, one in enumerate(known) if one.width is None]
        return reading

    def _columns(
        self, lines: list[np.ndarray], known: list[road_layers.RoadAttributes], name: str, warnings: list[str]
    ) -> Centrelines:
        width, speed = (
            self._algorithm.parameterAsDouble(self._parameters, key, self._context)
            for key in (DEFAULT_WIDTH, SPEED_DEFAULT)
        )
        # Not every algorithm has a parameter for the speed of roads.
        speed = speed or DEFAULT_SPEED
        unknown = sum(one.width is None for one in known)
        if unknown:
            warnings.append(
                tr_count(
                    unknown,
                    "Layer {name}: the width of 1 road is not known; {width:g} m is used",
                    "Layer {name}: the width of %n roads is not known; {width:g} m is used",
                    name=name,
                    width=width,
                )
            )
        return centrelines(
            lines,
            width=[one.width or width for one in known],
            surface=[one.surface for one in known],
            direction=[one.traffic.direction for one in known],
            speed=[one.traffic.speed or speed for one in known],
            closed=[one.traffic.closed for one in known],
            level=[one.traffic.level for one in known],
        )


def _no_roads(name: str, count: int, warnings: list[str]) -> str:
    """Return the error for a layer without roads, with its actual content."""
    if count == 0:
        return tr(
            "ROADS: the layer {name} has no features: choose the layer of the road centrelines.", name=name
        )
    return tr(
        "ROADS: no feature of the layer {name} is a road: each has to be a line with a "
        "length that the layer's filter keeps. {first}",
        name=name,
        first=warnings[0] if warnings else tr("The filter of its role keeps none of them."),
    )


def network_of_roads(
    algorithm: QgsProcessingAlgorithm,
    parameters: Parameters,
    context: QgsProcessingContext,
    reading: RoadReading,
    feedback: QgsProcessingFeedback,
) -> tuple[Network, list[RoadFinding]] | None:
    """Return the network and its repairs, empty unless REPAIR is set.

    None if cancelled.
    """
    for warning in reading.warnings:
        feedback.pushWarning(warning)
    if not algorithm.parameterAsBool(parameters, REPAIR, context):
        network = network_as_drawn(reading, feedback)
        return None if network is None else (network, [])
    tolerance = algorithm.parameterAsDouble(parameters, TOLERANCE, context)
    try:
        network, repairs = repaired_network(reading.roads, tolerance, _asking(feedback))
    except RoadsCancelledError:
        return None
    for repair in repairs:
        feature, text = reading.features[repair.road], repair.in_words(reading.features)
        where = f"({repair.x:.3f}, {repair.y:.3f})"
        feedback.pushInfo(
            tr(
                "Repaired: {kind} of feature {feature} at {where}: {text}",
                kind=repair.kind.value,
                feature=feature,
                where=where,
                text=text,
            )
        )
    return network, repairs


def network_as_drawn(reading: RoadReading, feedback: QgsProcessingFeedback) -> Network | None:
    """Return the network without repairs; None if cancelled."""
    try:
        return build_network(reading.roads, _asking(feedback))
    except RoadsCancelledError:
        return None


def _asking(feedback: QgsProcessingFeedback) -> CancelCheck:
    def ask() -> None:
        if feedback.isCanceled():
            raise RoadsCancelledError

    return ask


# --- QGIS's own graph search: the fallback where neither RoutingKit nor SciPy is installed ---

QGIS = "qgis"
"""The engine's name in choices."""


class GraphEngine:
    """Finds ways by QgsGraphAnalyzer on a cached graph; it is built again when costs have changed."""

    name = "QGIS (QgsGraphAnalyzer)"

    def __init__(self, graph: RouteGraph, costs: np.ndarray) -> None:
        self._graph = graph
        self._costs = costs.copy()
        self._made: QgsGraph | None = None
        self._arcs: list[int] = []

    def set_costs(self, arcs: np.ndarray, costs: np.ndarray) -> None:
        """Set the costs of ``arcs``."""
        self._costs[arcs] = costs
        self._made = None

    def way(self, starts: Ends, goals: Ends) -> list[int] | None:
        """Return the arcs of the cheapest way, None for none."""
        made = self._made or self._make()
        least, tree, last = math.inf, [], -1
        for node, before in starts:
            came_by, away = QgsGraphAnalyzer.dijkstra(made, node, 0)
            for goal, beyond in goals:
                # Unreachable nodes have the greatest number as their cost.
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


def router_on(network: Network, engine: str) -> Router:
    """Return the router on ``network`` by an engine: QGIS, or one of those of the bridge."""
    stock = not any(importlib.util.find_spec(name) for name in ("routingkit_cch", "scipy"))
    if engine == QGIS or (engine == AUTOMATIC and stock):
        return Router(network, _of_qgis)
    return Router(network, engine)


def _of_qgis(graph: RouteGraph):
    return lambda costs: GraphEngine(graph, costs)
