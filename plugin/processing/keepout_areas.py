"""Areas that a route must not lead through, from polygon layers."""

from __future__ import annotations

from qgis.core import (
    QgsCoordinateReferenceSystem,
    QgsProcessing,
    QgsProcessingAlgorithm,
    QgsProcessingContext,
    QgsProcessingFeedback,
    QgsProcessingParameterDefinition,
    QgsProcessingParameterMultipleLayers,
)

from ...robot_bridge.roads.network import Network
from ...robot_bridge.roads.routes import Router
from ..language import tr, tr_count
from ..sites.ground_reading import read_areas
from ..sites.keepout_edges import edges_through
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

    def close(
        self, router: Router, crs: QgsCoordinateReferenceSystem, feedback: QgsProcessingFeedback
    ) -> list[str]:
        """Close the edges of ``router``, whose network is in ``crs``, that come into an area.

        Return what was warned of.

        :raises LayerReadingError: when a layer has no known place in ``crs``.
        """
        closed, warnings = self.edges_inside(router.network, crs, feedback)
        if closed:
            router.close(closed)
        return warnings

    def edges_inside(
        self, network: Network, crs: QgsCoordinateReferenceSystem, feedback: QgsProcessingFeedback
    ) -> tuple[list[int], list[str]]:
        """Return the edges of ``network``, which is in ``crs``, that come into an area, and the warnings.

        What runs along the rim of an area does not come into it.

        :raises LayerReadingError: when a layer has no known place in ``crs``.
        """
        if not self._sources:
            return [], []
        site = SitePlacing.in_crs(crs, self._transforms)
        reading = read_areas(self._sources, site, KEEPOUT, feedback)
        for warning in reading.warnings:
            feedback.pushWarning(warning)
        closed = edges_through(network, [area.rings for area in reading.items])
        if closed:
            feedback.pushInfo(
                tr_count(
                    len(closed),
                    "1 edge leads through areas to be avoided, and is closed",
                    "%n edges lead through areas to be avoided, and are closed",
                )
            )
        return closed, reading.warnings
