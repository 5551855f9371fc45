"""The road surfaces of layers, ready to be asked from any CRS."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from qgis.core import (
    QgsCoordinateReferenceSystem,
    QgsCoordinateTransform,
    QgsCoordinateTransformContext,
    QgsCsException,
    QgsExpressionContext,
    QgsFeedback,
    QgsPointXY,
    QgsRectangle,
    QgsVectorLayer,
)

from ...robot_bridge.roads.surfaces.index import NOWHERE, SurfaceIndex
from ...robot_bridge.roads.surfaces.surface import Surface
from ...robot_bridge.sites.projections import utm_zone_of
from .errors import SiteCrsError
from .ground_reading import read_surfaces
from .many_points import moved
from .obstacle_source import ObstacleSource, obstacle_sources
from .placing import SitePlacing
from .roles import LayerExpressions
from .site_crs import check_site_crs

WGS84 = "EPSG:4326"


@dataclass(frozen=True)
class SurfaceSources:
    """Layers of surfaces as they are read, from any thread, and the CRS in metres that they are put into."""

    sources: Sequence[ObstacleSource]
    crs: QgsCoordinateReferenceSystem
    transforms: QgsCoordinateTransformContext


@dataclass
class SurfaceMap:
    """Surfaces in ``crs``; ``warnings`` name layer and feature of what could not be read as it is."""

    index: SurfaceIndex
    crs: QgsCoordinateReferenceSystem
    transforms: QgsCoordinateTransformContext
    warnings: list[str] = field(default_factory=list)

    def way_from(self, crs: QgsCoordinateReferenceSystem) -> QgsCoordinateTransform:
        """Return the way from ``crs`` to that of the surfaces; without a valid CRS there is nothing to do."""
        return QgsCoordinateTransform(crs, self.crs, self.transforms)

    def at(self, x: float, y: float, way: QgsCoordinateTransform) -> Surface | None:
        """Return the surface at (x, y), which ``way`` leads from; None where there is none."""
        if not way.isShortCircuited():
            try:
                point = way.transform(QgsPointXY(x, y))
            except QgsCsException:
                return None
            x, y = point.x(), point.y()
        return self.index.surface_at(x, y)

    def at_many(self, xy: np.ndarray, way: QgsCoordinateTransform) -> list[Surface | None]:
        """Return the surface at each of (n, 2) coordinates, None where there is none."""
        numbers = self.index.at_many(moved(xy, way)).tolist()
        return [None if k == NOWHERE else self.index.surfaces[k] for k in numbers]


def surface_sources(
    layers: Sequence[QgsVectorLayer],
    project_crs: QgsCoordinateReferenceSystem,
    transforms: QgsCoordinateTransformContext,
    scope: QgsExpressionContext,
) -> SurfaceSources:
    """Return what is read of ``layers``, each with its own filter and label; in the thread of the layers.

    ``scope`` is what their expressions see besides the layer.

    :raises FleetError: naming a layer that holds no areas or cannot be opened.
    """
    sources = obstacle_sources(layers, LayerExpressions(), scope)
    areas = [(layer.crs(), layer.extent()) for layer in layers]
    return SurfaceSources(sources, _crs_in_metres(areas, project_crs, transforms), transforms)


def read_surface_map(sources: SurfaceSources, feedback: QgsFeedback) -> SurfaceMap | None:
    """Return the surfaces of ``sources``; None after a cancel.

    :raises FleetError: when a layer has no known place or an expression is not one.
    """
    site = SitePlacing.in_crs(sources.crs, sources.transforms)
    reading = read_surfaces(sources.sources, site, feedback)
    if not reading.complete or feedback.isCanceled():
        return None
    return SurfaceMap(SurfaceIndex(reading.items), sources.crs, sources.transforms, reading.warnings)


def _crs_in_metres(
    areas: Sequence[tuple[QgsCoordinateReferenceSystem, QgsRectangle]],
    project_crs: QgsCoordinateReferenceSystem,
    transforms: QgsCoordinateTransformContext,
) -> QgsCoordinateReferenceSystem:
    """Return the first CRS of layers and project that is a plane in metres, else the UTM zone of a layer.

    Edges are straight in it, and repairs and curves are told in metres.
    """
    for crs in (*(crs for crs, _ in areas), project_crs):
        if crs.isValid() and _carries(crs):
            return crs
    for crs, extent in areas:
        if crs.isValid() and not extent.isNull():
            way = QgsCoordinateTransform(crs, QgsCoordinateReferenceSystem(WGS84), transforms)
            try:
                centre = way.transform(extent.center())
            except QgsCsException:
                continue
            return QgsCoordinateReferenceSystem(utm_zone_of(centre.x(), centre.y()))
    return QgsCoordinateReferenceSystem()


def _carries(crs: QgsCoordinateReferenceSystem) -> bool:
    try:
        check_site_crs(crs)
    except SiteCrsError:
        return False
    return True
