"""Whether a draft can be driven: inside the site, off the keepouts, on a road surface."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np
from qgis.core import (
    QgsCoordinateTransform,
    QgsFeature,
    QgsFeatureRequest,
    QgsGeometry,
    QgsPointXY,
    QgsProject,
    QgsVectorLayer,
    QgsWkbTypes,
)

from ...robot_bridge.messages import SiteReport
from ..sites.feature_filter import FeatureFilter
from ..sites.roles import KEEPOUT, ROAD_SURFACE, layers_with_role
from .drafts import Findings, Point
from .placement import Placement, transformed


def check_bounds(points: Sequence[Point], site: SiteReport) -> Findings:
    """Refuse what lies outside the site's bounds; ``points`` are metres in the site frame."""
    x_min, y_min, x_max, y_max = site.bounds
    outside = [(x, y) for x, y in points if not (x_min <= x <= x_max and y_min <= y <= y_max)]
    if not outside:
        return Findings()
    where = "; ".join(f"({x:.2f}, {y:.2f})" for x, y in outside[:3])
    return Findings(
        refused=(
            f"{where} m is outside the site {site.name}, which reaches from ({x_min:g}, {y_min:g}) to "
            f"({x_max:g}, {y_max:g}) m. Click inside it.",
        )
    )


class LayerCheck:
    """Checks drafts against the project's layers that carry the roles keepout and road_surface."""

    def __init__(self, project: QgsProject):
        self._project = project

    def __call__(self, points: Sequence[Point], placement: Placement) -> Findings:
        """Refuse what touches a keepout, warn of what leaves the road; metres in the site frame.

        :raises PlacementError: when a point has no place in a layer's CRS.
        :raises ExpressionError: when the filter of a layer is no expression.
        """
        return self._keepouts(points, placement) + self._surfaces(points, placement)

    def _keepouts(self, points: Sequence[Point], placement: Placement) -> Findings:
        found = []
        for layer in self._layers(KEEPOUT):
            track = self._track(points, placement, layer)
            for feature in _near(layer, track):
                if feature.geometry().intersects(track):
                    found.append(
                        f"{_spot(points)} enters the keepout {_name(feature, layer)}. Choose a place or way "
                        "outside it."
                    )
        return Findings(refused=tuple(found))

    def _surfaces(self, points: Sequence[Point], placement: Placement) -> Findings:
        layers = list(self._layers(ROAD_SURFACE))
        if not layers:
            return Findings()
        off = list(range(len(points)))
        for layer in layers:
            corners = self._corners(points, placement, layer)
            spots = {i: QgsGeometry.fromPointXY(QgsPointXY(*corners[i])) for i in off}
            off = [i for i in off if not any(f.geometry().contains(spots[i]) for f in _near(layer, spots[i]))]
        if not off:
            return Findings()
        x, y = points[off[0]]
        where = f"({x:.2f}, {y:.2f}) m is" if len(off) == 1 else f"{len(off)} of {len(points)} points are"
        return Findings(warnings=(f"{where} not on a road surface.",))

    def _layers(self, role: str) -> Iterator[QgsVectorLayer]:
        for layer in layers_with_role(self._project, role):
            if (
                isinstance(layer, QgsVectorLayer)
                and layer.isValid()
                and layer.geometryType() == QgsWkbTypes.GeometryType.PolygonGeometry
            ):
                yield layer

    def _corners(self, points: Sequence[Point], placement: Placement, layer: QgsVectorLayer) -> np.ndarray:
        in_site_crs = placement.frame.to_crs(np.array(points, dtype=np.float64))
        if not layer.crs().isValid():
            return in_site_crs
        to_layer = QgsCoordinateTransform(placement.site_crs, layer.crs(), self._project)
        return transformed(in_site_crs, to_layer)

    def _track(self, points: Sequence[Point], placement: Placement, layer: QgsVectorLayer) -> QgsGeometry:
        corners = [QgsPointXY(x, y) for x, y in self._corners(points, placement, layer)]
        if len(corners) == 1:
            return QgsGeometry.fromPointXY(corners[0])
        return QgsGeometry.fromPolylineXY(corners)


def _near(layer: QgsVectorLayer, geometry: QgsGeometry) -> Iterator[QgsFeature]:
    counted = FeatureFilter.of_layer(layer, layer.createExpressionContext())
    for feature in layer.getFeatures(QgsFeatureRequest().setFilterRect(geometry.boundingBox())):
        doubts: list[str] = []
        # What the filter cannot tell of may be a keepout.
        if counted.keeps(feature, doubts) or doubts:
            yield feature


def _name(feature: QgsFeature, layer: QgsVectorLayer) -> str:
    index = layer.fields().lookupField("name")
    name = feature.attribute(index) if index >= 0 else None
    return str(name) if isinstance(name, str) and name else f"{layer.name()} (feature {feature.id()})"


def _spot(points: Sequence[Point]) -> str:
    return f"({points[0][0]:.2f}, {points[0][1]:.2f}) m" if len(points) == 1 else "The route"
