"""Whether a draft leads onto an obstacle of the project's layers."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from itertools import accumulate

import numpy as np
from qgis.core import (
    QgsCoordinateTransform,
    QgsCsException,
    QgsFeature,
    QgsGeometry,
    QgsPointXY,
    QgsProject,
    QgsRectangle,
    QgsVectorLayer,
)

from ...errors import PlacementError
from ...language import tr
from ...sites.roles import FURNITURE, OBSTACLE, STAIRS, layers_with_role
from ..drafts import ROUTE, Draft, Findings, Point
from ..placement import Placement, transformed
from .layer_features import LayerFeatures

CLEARANCE_M = 0.25
"""Metres within which a place is taken to be on an obstacle: half the width of a small robot."""

Named = Callable[[QgsFeature, QgsVectorLayer], str]


class ObstacleCheck:
    """Holds drafts against the layers with the roles obstacle, stairs and furniture; ramps can be driven.

    ``name`` tells how a feature of a layer is called.
    """

    def __init__(self, project: QgsProject, name: Named):
        self._project = project
        self._name = name

    def __call__(self, draft: Draft, placement: Placement) -> Findings:
        """Find obstacles at the targets, or in the way of what was drawn by hand.

        Legs along the roads are the gateway's, which knows obstacles as the site was published.

        :raises PlacementError: when a point has no place in a layer's CRS.
        :raises ExpressionError: when the filter of a layer is no expression.
        """
        tracks = list(_tracks(draft, placement))
        found: dict[tuple[int, str], str] = {}
        for layer in layers_with_role(self._project, OBSTACLE, STAIRS, FURNITURE):
            if tracks and isinstance(layer, QgsVectorLayer) and layer.isValid() and layer.isSpatial():
                for number, name, away in self._near([line for line, _ in tracks], layer, placement):
                    found.setdefault((number, name), _told(tracks[number][1], name, away))
        return Findings(overridable=tuple(found[key] for key in sorted(found)))

    def _near(
        self, tracks: Sequence[QgsGeometry], layer: QgsVectorLayer, placement: Placement
    ) -> Iterator[tuple[int, str, float]]:
        way = QgsCoordinateTransform(layer.crs(), placement.site_crs, self._project)
        moved: dict[int, QgsGeometry] = {}
        try:
            for number, feature in LayerFeatures(layer).near(_boxes(tracks, way)):
                if feature.id() not in moved:
                    moved[feature.id()] = QgsGeometry(feature.geometry())
                    if way.isValid():
                        moved[feature.id()].transform(way)
                away = moved[feature.id()].distance(tracks[number])
                if 0 <= away <= CLEARANCE_M:
                    yield number, self._name(feature, layer), away
        except QgsCsException as error:
            raise PlacementError(
                tr(
                    "The layer {layer} cannot be placed on the site ({error}), so obstacles in it are not "
                    "seen. Correct its CRS, or take its role away.",
                    layer=layer.name(),
                    error=error,
                )
            ) from error


def _tracks(draft: Draft, placement: Placement) -> Iterator[tuple[QgsGeometry, str]]:
    """Yield what is looked at in the site's CRS, and what it is called."""
    corners = [QgsPointXY(x, y) for x, y in placement.frame.to_crs(np.array(draft.points)).tolist()]
    if draft.kind != ROUTE or len(corners) == 1:
        for corner, point in zip(corners, draft.points, strict=True):
            yield QgsGeometry.fromPointXY(corner), _place(point)
        return
    for leg, end in zip(draft.legs, accumulate(draft.legs), strict=True):
        if leg == 1 and end > 1:
            to = _place(draft.points[end - 1])
            yield QgsGeometry.fromPolylineXY(corners[end - 2 : end]), tr("The way to {to}", to=to)


def _boxes(tracks: Sequence[QgsGeometry], way: QgsCoordinateTransform) -> list[QgsRectangle]:
    """Return what is to be looked at in the layer's CRS, where ``way`` leads from."""
    boxes = [track.boundingBox().buffered(CLEARANCE_M) for track in tracks]
    if not way.isValid() or way.isShortCircuited():
        return boxes
    back = QgsCoordinateTransform(way.destinationCrs(), way.sourceCrs(), way.context())
    limits = [(box.xMinimum(), box.yMinimum(), box.xMaximum(), box.yMaximum()) for box in boxes]
    corners = [(limit[x], limit[y]) for limit in limits for x, y in ((0, 1), (2, 1), (2, 3), (0, 3))]
    # At the scale of a site the corners hold what lies between them, but for a hair.
    there = transformed(np.array(corners), back).reshape(-1, 4, 2)
    least, most = there.min(axis=1), there.max(axis=1)
    slack = (most - least) * 0.01
    sides = np.hstack([least - slack, most + slack])
    return [QgsRectangle(*side) for side in sides.tolist()]


def _told(spot: str, name: str, away: float) -> str:
    where = tr("is on") if away <= 0.0 else tr("is {away:.2f} m from", away=away)
    return tr("{spot} {where} {name}. Choose a place or way beside it.", spot=spot, where=where, name=name)


def _place(point: Point) -> str:
    return tr("({point:.2f}, {point2:.2f}) m", point=point[0], point2=point[1])
