"""Whether a draft can be driven: inside the site, off keepouts and obstacles, on a road surface."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import accumulate

import numpy as np
from qgis.core import (
    QgsCoordinateTransform,
    QgsFeature,
    QgsGeometry,
    QgsPointXY,
    QgsProject,
    QgsVectorLayer,
    QgsWkbTypes,
)

from ...robot_bridge.messages import SiteReport
from ..language import tr
from ..sites.roles import KEEPOUT, ROAD_SURFACE, layers_with_role
from .drafting.layer_features import LayerFeatures
from .drafting.obstacle_check import ObstacleCheck
from .drafts import ROUTE, START, TARGETS, Draft, Findings, Point
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
            tr(
                "{where} m is outside the site {name}, which reaches from ({x_min:g}, {y_min:g}) to "
                "({x_max:g}, {y_max:g}) m. Click inside it.",
                where=where,
                name=site.name,
                x_min=x_min,
                y_min=y_min,
                x_max=x_max,
                y_max=y_max,
            ),
        )
    )


class LayerCheck:
    """Checks drafts against the project's layers that carry the roles of obstacles, keepouts and surfaces."""

    def __init__(self, project: QgsProject):
        self._project = project
        self._obstacles = ObstacleCheck(project, _name)

    def __call__(self, draft: Draft, placement: Placement) -> Findings:
        """Find what touches a keepout or an obstacle, warn of what leaves the road.

        Of a route only the ends of its legs are held against surfaces. Where a robot says that it stands is
        not looked at: it may have been put there.

        :raises PlacementError: when a point has no place in a layer's CRS.
        :raises ExpressionError: when the filter of a layer is no expression.
        """
        if draft.kind == START:
            return Findings()
        points = draft.points
        tracks = [(point,) for point in points] if draft.kind == TARGETS else [points]
        ends = [points[end - 1] for end in accumulate(draft.legs)] if draft.kind == ROUTE else points
        return (
            self._keepouts(tracks, placement)
            + self._obstacles(draft, placement)
            + self._surfaces(ends, placement)
        )

    def _keepouts(self, tracks: Sequence[Sequence[Point]], placement: Placement) -> Findings:
        found = []
        for layer in self._layers(KEEPOUT):
            lines = [self._track(points, placement, layer) for points in tracks]
            boxes = [line.boundingBox() for line in lines]
            for number, feature in LayerFeatures(layer).near(boxes):
                if feature.geometry().intersects(lines[number]):
                    found.append(
                        tr(
                            "{spot} enters the keepout {name}. Choose a place or way outside it.",
                            spot=_spot(tracks[number]),
                            name=_name(feature, layer),
                        )
                    )
        return Findings(overridable=tuple(found))

    def _surfaces(self, points: Sequence[Point], placement: Placement) -> Findings:
        layers = list(self._layers(ROAD_SURFACE))
        if not layers:
            return Findings()
        on: set[int] = set()
        for layer in layers:
            corners = self._corners(points, placement, layer)
            spots = [QgsGeometry.fromPointXY(QgsPointXY(x, y)) for x, y in corners.tolist()]
            for number, feature in LayerFeatures(layer).near([spot.boundingBox() for spot in spots]):
                if number not in on and feature.geometry().contains(spots[number]):
                    on.add(number)
        off = [number for number in range(len(points)) if number not in on]
        if not off:
            return Findings()
        x, y = points[off[0]]
        where = (
            tr("({x:.2f}, {y:.2f}) m is", x=x, y=y)
            if len(off) == 1
            else tr(
                "{off} of {points} points are",
                off=len(off),
                points=len(points),
            )
        )
        return Findings(warnings=(tr("{where} not on a road surface.", where=where),))

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


def _name(feature: QgsFeature, layer: QgsVectorLayer) -> str:
    index = layer.fields().lookupField("name")
    name = feature.attribute(index) if index >= 0 else None
    return (
        str(name)
        if isinstance(name, str) and name
        else tr(
            "{layer} (feature {id})",
            layer=layer.name(),
            id=feature.id(),
        )
    )


def _spot(points: Sequence[Point]) -> str:
    return (
        tr(
            "({points:.2f}, {points2:.2f}) m",
            points=points[0][0],
            points2=points[0][1],
        )
        if len(points) == 1
        else tr("The route")
    )
