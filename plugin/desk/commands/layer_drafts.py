"""Drafts made of what is selected in a layer: a point, a line, or many points."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from qgis.core import (
    QgsAbstractGeometry,
    QgsCoordinateTransform,
    QgsCsException,
    QgsFeature,
    QgsGeometry,
    QgsVectorLayer,
    QgsWkbTypes,
)

from ....robot_bridge.messages import LONGEST_PATH, LONGEST_QUEUE
from ...errors import FleetError
from ...language import tr
from ...sites.crs_way import check_way
from ...sites.shapes import SAGITTA_M
from ..desk import Desk
from ..drafts import CONE, ROUTE, TARGETS, Draft, Point

NAME_FIELDS = ("id", "name", "label")


class LayerDraftError(FleetError):
    """A layer holds nothing that a draft could be made of."""


def draft_of_layer(layer: QgsVectorLayer | None, desk: Desk) -> Draft:
    """Return an unchecked draft for the selected robot of what is selected in ``layer``, or of all of it.

    One point is a cone target, several points are several of them, one line is a route.

    :raises FleetError: naming what is wrong with the layer, the selection or the robot.
    """
    if desk.selected is None:
        raise LayerDraftError(
            tr("No robot is selected. Select the one that the draft is for, then try again.")
        )
    if not isinstance(layer, QgsVectorLayer) or not layer.isValid() or not layer.isSpatial():
        raise LayerDraftError(
            tr("No layer of points or lines is active. Click one in the Layers panel, then try again.")
        )
    features = _features(layer)
    kind = layer.geometryType()
    if kind == QgsWkbTypes.GeometryType.PointGeometry:
        return _targets(layer, features, desk)
    if kind == QgsWkbTypes.GeometryType.LineGeometry:
        return _route(layer, features, desk)
    raise LayerDraftError(
        tr(
            "The layer {layer} holds polygons: take a layer of points (targets) or lines (a route).",
            layer=layer.name(),
        )
    )


def _features(layer: QgsVectorLayer) -> list[QgsFeature]:
    chosen = layer.selectedFeatureCount()
    if not chosen and layer.featureCount() > LONGEST_QUEUE:
        raise LayerDraftError(
            tr(
                "The layer {layer} has {count} features and a queue takes {longest_queue}: select "
                "those that are meant.",
                layer=layer.name(),
                count=layer.featureCount(),
                longest_queue=LONGEST_QUEUE,
            )
        )
    features = sorted(layer.selectedFeatures(), key=_age) if chosen else list(layer.getFeatures())
    found = [one for one in features if not one.geometry().isNull() and not one.geometry().isEmpty()]
    if not found:
        raise LayerDraftError(
            tr("The layer {layer} has no feature with a place to go to.", layer=layer.name())
        )
    return found


def _age(feature: QgsFeature) -> tuple[bool, int]:
    """Return what tells older features from newer ones: QGIS hands over selected ones in any order.

    Those that are not saved yet have numbers below zero, counted downwards.
    """
    return feature.id() < 0, abs(feature.id())


def _targets(layer: QgsVectorLayer, features: Sequence[QgsFeature], desk: Desk) -> Draft:
    places, names = [], []
    for feature in features:
        # Named, since its vertices do not keep it alive.
        geometry = _moved(feature, layer, desk)
        for vertex in geometry.vertices():
            places.append((vertex.x(), vertex.y()))
            names.append(_name(feature))
    if len(places) > LONGEST_QUEUE:
        raise LayerDraftError(
            tr(
                "The layer {layer} has {places} points selected and a queue takes {longest_queue}: select "
                "fewer.",
                layer=layer.name(),
                places=len(places),
                longest_queue=LONGEST_QUEUE,
            )
        )
    points = _in_site(places, desk)
    if len(points) == 1:
        return Draft(desk.selected, CONE, points)
    return Draft(desk.selected, TARGETS, points, names=tuple(names))


def _route(layer: QgsVectorLayer, features: Sequence[QgsFeature], desk: Desk) -> Draft:
    if len(features) != 1:
        raise LayerDraftError(
            tr(
                "A route is one line, and {features} of the layer {layer} are meant: select one.",
                features=len(features),
                layer=layer.name(),
            )
        )
    maximum = QgsAbstractGeometry.SegmentationToleranceType.MaximumDifference
    geometry = _moved(features[0], layer, desk)
    line = geometry.constGet().segmentize(SAGITTA_M, maximum)
    if line.partCount() != 1:
        raise LayerDraftError(
            tr(
                "The line that is selected in {layer} has {parts} parts, and a robot cannot leap from "
                "one to the next: make it one line.",
                layer=layer.name(),
                parts=line.partCount(),
            )
        )
    places = [(vertex.x(), vertex.y()) for vertex in line.vertices()]
    if not 2 <= len(places) <= LONGEST_PATH:
        raise LayerDraftError(
            tr(
                "The line has {places} vertices; a route takes 2 to {longest_path}: simplify it first.",
                places=len(places),
                longest_path=LONGEST_PATH,
            )
        )
    return Draft(desk.selected, ROUTE, _in_site(places, desk), legs=(1,) * len(places))


def _moved(feature: QgsFeature, layer: QgsVectorLayer, desk: Desk) -> QgsGeometry:
    """Return a feature's geometry in the site's CRS."""
    if not layer.crs().isValid():
        raise LayerDraftError(
            tr(
                "The layer {layer} has no CRS, so nobody knows where its points are. Set it in the layer's "
                "properties.",
                layer=layer.name(),
            )
        )
    geometry = QgsGeometry(feature.geometry())
    way = QgsCoordinateTransform(layer.crs(), desk.placement().site_crs, desk.project.transformContext())
    try:
        check_way(way)
        geometry.transform(way)
    except QgsCsException as error:
        raise LayerDraftError(
            tr(
                "Feature {id} of {layer} has no place in the site's CRS ({error}). Leave it out, or correct "
                "the layer's CRS.",
                id=feature.id(),
                layer=layer.name(),
                error=error,
            )
        ) from error
    return geometry


def _in_site(places: Sequence[Point], desk: Desk) -> tuple[Point, ...]:
    in_site = desk.placement().frame.to_site(np.array(places, dtype=np.float64))
    if not np.isfinite(in_site).all():
        raise LayerDraftError(
            tr("A coordinate of what is selected is no number. Correct it, or leave it out.")
        )
    return tuple((float(x), float(y)) for x, y in in_site)


def _name(feature: QgsFeature) -> str:
    for field in NAME_FIELDS:
        index = feature.fields().lookupField(field)
        value = feature.attribute(index) if index >= 0 else None
        if isinstance(value, (str, int)) and str(value).strip():
            return str(value).strip()[:128]
    return str(feature.id())
