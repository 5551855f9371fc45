"""Centrelines for the network, read from the layer that an algorithm is given."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from qgis.core import (
    QgsCoordinateReferenceSystem,
    QgsProcessing,
    QgsProcessingAlgorithm,
    QgsProcessingContext,
    QgsProcessingFeatureSource,
    QgsProcessingFeedback,
    QgsProcessingParameterBoolean,
    QgsProcessingParameterCrs,
    QgsProcessingParameterDefinition,
    QgsProcessingParameterExpression,
    QgsProcessingParameterFeatureSource,
    QgsProcessingParameterNumber,
)

from ...robot_bridge.roads.asking import Ask
from ...robot_bridge.roads.centrelines import DEFAULT_SPEED, Centrelines, centrelines
from ...robot_bridge.roads.errors import CancelledError
from ...robot_bridge.roads.findings import Finding
from ...robot_bridge.roads.network import Network, build_network
from ...robot_bridge.roads.repairs import repaired_network
from ..language import tr, tr_count
from ..sites.ground_reading import DEFAULT_WIDTH_M, lines_of
from ..sites.layer_rules import LayerRules
from ..sites.placing import LayerPlacing, SitePlacing
from ..sites.road_attributes import RoadAttributes, RoadExpressions, RoadRules
from ..sites.roles import LayerExpressions, expressions_of
from .errors import ParameterError
from .fleet_algorithm import Parameters
from .given_layers import layer_in
from .map_profile import filter_in
from .site_crs_choice import SITE_CRS, chosen_crs

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
"""Expressions that a layer's role has for the attributes of a road."""


@dataclass
class RoadReading:
    """Roads in metres; road ``k`` is a part of feature ``features[k]``.

    ``without_width`` holds the roads whose width is not known and taken as the default one.
    """

    roads: Centrelines
    features: list[int]
    crs: QgsCoordinateReferenceSystem
    placing: LayerPlacing
    warnings: list[str] = field(default_factory=list)
    without_width: list[int] = field(default_factory=list)


def road_parameters() -> list[QgsProcessingParameterDefinition]:
    """Return the parameters that say what the roads are."""
    advanced: list[QgsProcessingParameterDefinition] = [
        QgsProcessingParameterExpression(name, title, parentLayerParameterName=ROADS, optional=True)
        for name, title in _EXPRESSIONS.items()
    ]
    advanced += [
        QgsProcessingParameterNumber(
            DEFAULT_WIDTH,
            tr("Width of roads of which it is not known [m]"),
            _REAL,
            DEFAULT_WIDTH_M,
            minValue=0.01,
        ),
        QgsProcessingParameterNumber(
            SPEED_DEFAULT,
            tr("Speed on roads of which it is not known [m/s]"),
            _REAL,
            DEFAULT_SPEED,
            minValue=0.01,
        ),
        QgsProcessingParameterCrs(
            SITE_CRS, tr("CRS in metres (default: the layer's, or the project's)"), optional=True
        ),
    ]
    for parameter in advanced:
        parameter.setFlags(parameter.flags() | QgsProcessingParameterDefinition.Flag.FlagAdvanced)
    lines = [QgsProcessing.SourceType.TypeVectorLine]
    return [
        QgsProcessingParameterFeatureSource(ROADS, tr("Road centrelines"), lines),
        QgsProcessingParameterNumber(
            TOLERANCE, tr("Ends this near to a road were meant to meet it [m]"), _REAL, 0.5, minValue=0.0
        ),
        *advanced,
    ]


def repair_parameter() -> QgsProcessingParameterDefinition:
    """Return the parameter that asks for repairs."""
    return QgsProcessingParameterBoolean(
        REPAIR, tr("Repair: close gaps, cut overshoots, leave out what is drawn twice"), defaultValue=False
    )


class RoadSource:
    """The layer of roads of one run; made in the main thread, read in any."""

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
        self._expressions = RoadExpressions(**given)

    def read(self, feedback: QgsProcessingFeedback) -> RoadReading | None:
        """Return the roads; None after a cancel.

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
        given = self._algorithm, self._parameters, self._context
        crs = chosen_crs(*given, [source.sourceCrs()], layer_first=True)
        site = SitePlacing.in_crs(crs, self._context.transformContext())
        placing = site.of_layer(source.sourceName(), source.sourceCrs())
        return self._read(source, crs, placing, feedback)

    def _read(
        self,
        source: QgsProcessingFeatureSource,
        crs: QgsCoordinateReferenceSystem,
        placing: LayerPlacing,
        feedback: QgsProcessingFeedback,
    ) -> RoadReading | None:
        name = source.sourceName()
        scope = self._algorithm.createExpressionContext(self._parameters, self._context, source)
        rules = LayerRules(name, source.fields(), scope)
        road_rules = RoadRules(rules, self._expressions)
        lines: list[np.ndarray] = []
        known: list[RoadAttributes] = []
        features: list[int] = []
        warnings: list[str] = []
        total = max(source.featureCount(), 1)
        for number, feature in enumerate(source.getFeatures()):
            if feedback.isCanceled():
                return None
            feedback.setProgress(50.0 * number / total)
            notes: list[str] = []
            counts = self._counted is None or self._counted.keeps(feature, notes)
            rules.at(feature)
            geometry = placing.of_feature(feature, notes) if counts else None
            found = [] if geometry is None else lines_of(geometry, notes)
            if found:
                known += [road_rules.of(notes)] * len(found)
            lines += found
            features += [feature.id()] * len(found)
            warnings += [
                tr("Layer {name}, feature {id}: {note}", name=name, id=feature.id(), note=note)
                for note in notes
            ]
        if not lines:
            raise ParameterError(_no_roads(name, source.featureCount(), warnings))
        reading = RoadReading(self._columns(lines, known, name, warnings), features, crs, placing, warnings)
        reading.warnings += rules.warnings
        reading.without_width += [k for k, one in enumerate(known) if one.width is None]
        return reading

    def _columns(
        self, lines: list[np.ndarray], known: list[RoadAttributes], name: str, warnings: list[str]
    ) -> Centrelines:
        width, speed = (
            self._algorithm.parameterAsDouble(self._parameters, key, self._context)
            for key in (DEFAULT_WIDTH, SPEED_DEFAULT)
        )
        # Not every algorithm asks how fast roads are driven.
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
    """Return the error for a layer that holds no road, with what it holds instead."""
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
) -> tuple[Network, list[Finding]] | None:
    """Return the network and what was repaired in it, nothing where REPAIR is not asked for.

    After a cancel return None.
    """
    for warning in reading.warnings:
        feedback.pushWarning(warning)
    if not algorithm.parameterAsBool(parameters, REPAIR, context):
        network = network_as_drawn(reading, feedback)
        return None if network is None else (network, [])
    tolerance = algorithm.parameterAsDouble(parameters, TOLERANCE, context)
    try:
        network, repairs = repaired_network(reading.roads, tolerance, _asking(feedback))
    except CancelledError:
        return None
    for repair in repairs:
        feature, text = reading.features[repair.road], repair.told(reading.features)
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
    """Return the network with nothing repaired; None after a cancel."""
    try:
        return build_network(reading.roads, _asking(feedback))
    except CancelledError:
        return None


def _asking(feedback: QgsProcessingFeedback) -> Ask:
    def ask() -> None:
        if feedback.isCanceled():
            raise CancelledError

    return ask
