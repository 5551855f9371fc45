"""Areas that a route must not lead through, from polygon layers; by QGIS's own geometry alone."""

from __future__ import annotations

from qgis.core import (
    QgsCoordinateReferenceSystem,
    QgsFeedback,
    QgsGeometry,
    QgsPointXY,
    QgsProcessing,
    QgsProcessingAlgorithm,
    QgsProcessingContext,
    QgsProcessingParameterDefinition,
    QgsProcessingParameterMultipleLayers,
    QgsRectangle,
    QgsSpatialIndex,
)

from ...robot_bridge.roads.network import Network
from ...robot_bridge.sites.frame import SiteFrame
from ..language import tr
from ..sites.ground_reading import read_areas
from ..sites.obstacle_source import obstacle_sources
from ..sites.placing import SitePlacing
from ..sites.roles import KEEPOUT, LayerExpressions
from .fleet_algorithm import Parameters

KEEPOUTS = "KEEPOUTS"


def keepout_parameter() -> QgsProcessingParameterDefinition:
    """Return the parameter that names the layers."""
    return QgsProcessingParameterMultipleLayers(
        KEEPOUTS,
        tr("Areas that must not be driven through"),
        QgsProcessing.SourceType.TypeVectorPolygon,
        optional=True,
    )


class KeepoutAreas:
    """The layers of one run; to be made in the thread of the layers."""

    def __init__(
        self, algorithm: QgsProcessingAlgorithm, parameters: Parameters, context: QgsProcessingContext
    ) -> None:
        layers = algorithm.parameterAsLayerList(parameters, KEEPOUTS, context)
        expressions = algorithm.createExpressionContext(parameters, context)
        self._transforms = context.transformContext()
        self._sources = obstacle_sources(layers, LayerExpressions(), expressions) if layers else []

    def edges_through(
        self, network: Network, crs: QgsCoordinateReferenceSystem, feedback: QgsFeedback
    ) -> tuple[list[int], list[str]]:
        """Return the edges of ``network``, which is in ``crs``, that come into an area, and warnings.

        What runs along the rim of an area does not come into it.

        :raises LayerReadingError: when a layer has no known place in ``crs``.
        """
        if not self._sources:
            return [], []
        site = SitePlacing(crs, SiteFrame(crs.authid(), (0.0, 0.0)), self._transforms)
        reading = read_areas(self._sources, site, KEEPOUT, feedback)
        lines = [_line(network, edge) for edge in range(len(network))]
        index = QgsSpatialIndex()
        for edge, line in enumerate(lines):
            index.addFeature(edge, line.boundingBox())
        found: set[int] = set()
        for area in reading.items:
            polygon = _valid([[QgsPointXY(x, y) for x, y in ring.tolist()] for ring in area.rings])
            near = index.intersects(QgsRectangle(polygon.boundingBox()))
            found |= {edge for edge in near if lines[edge].crosses(polygon) or lines[edge].within(polygon)}
        return sorted(found), list(reading.warnings)


def _line(network: Network, edge: int) -> QgsGeometry:
    return QgsGeometry.fromPolylineXY([QgsPointXY(x, y) for x, y in network.edges.line(edge).tolist()])


def _valid(rings: list[list[QgsPointXY]]) -> QgsGeometry:
    polygon = QgsGeometry.fromPolygonXY(rings)
    return polygon if polygon.isGeosValid() else polygon.makeValid()
