"""Cones and stores, read from the project's point layers into the site frame."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

from qgis.core import (
    NULL,
    QgsCoordinateReferenceSystem,
    QgsCoordinateTransform,
    QgsCsException,
    QgsFeatureRequest,
    QgsProject,
    QgsVectorLayer,
    QgsWkbTypes,
)

from ....robot_bridge.assignment.job import PLACE, Store, Target
from ....robot_bridge.sites.frame import SiteFrame
from ...errors import FleetError
from ...language import tr
from ...processing.cone_layer import theta_of
from .plan_settings import PlanSettings

_NAMES = ("id", "name")


class ConeLayerError(FleetError):
    """A layer of cones or stores that cannot be planned for: names the layer, the feature, and what to do."""


@dataclass(frozen=True)
class ConeFacts:
    """What is written down of a target: the operator's name of the cone and its layout.

    ``placement`` is the number of the placed cone that is collected, None for one to be placed.
    """

    cone: str
    layout: str = ""
    placement: int | None = None
    theta: float | None = None


def point_layers(project: QgsProject) -> list[QgsVectorLayer]:
    """Return the layers that may hold cones or stores, by name."""
    points = QgsWkbTypes.GeometryType.PointGeometry
    found = [
        layer
        for layer in project.mapLayers().values()
        if isinstance(layer, QgsVectorLayer) and layer.isValid() and layer.isSpatial()
        and layer.geometryType() == points and not layer.customProperty("fleet/live")
    ]  # fmt: skip
    return sorted(found, key=lambda layer: (layer.name().casefold(), layer.id()))


def read_cones(
    project: QgsProject, settings: PlanSettings, frame: SiteFrame
) -> tuple[tuple[Target, ...], dict[str, ConeFacts]]:
    """Return what is to be placed, in the site frame, and what is written down of each, by the target's id.

    Fields: ``id``, ``heading`` (degrees clockwise from north), ``layout``, ``stage``, ``demand`` and
    ``service_s``.

    :raises ConeLayerError: when the layer is not there, empty, or a feature cannot be placed.
    """
    layer = project.mapLayer(settings.cones)
    if layer is None:
        raise ConeLayerError(tr("No layer of cones is chosen. Choose one, or place a cone layout first."))
    targets, facts = [], {}
    for row in _rows(layer, project, frame, settings.selected_only):
        theta = frame.heading_to_site(theta_of(row.number("heading", 90.0)))
        targets.append(
            Target(
                row.name, row.x, row.y, theta, round(row.number("stage", 0)), PLACE,
                round(row.number("demand", 1)), row.number("service_s", settings.service_s),
            )
        )  # fmt: skip
        facts[row.name] = ConeFacts(row.name, str(row.values.get("layout") or layer.name()))
    if not targets:
        which = tr("no selected features") if settings.selected_only else tr("no features")
        raise ConeLayerError(
            tr(
                "The layer {layer} has {which}: there is nothing to be placed.",
                layer=layer.name(),
                which=which,
            )
        )
    return tuple(targets), facts


def read_stores(project: QgsProject, settings: PlanSettings, frame: SiteFrame) -> tuple[Store, ...]:
    """Return the stores in the site frame, nothing where no layer is chosen; raises as :func:`read_cones`."""
    if not settings.stores:
        return ()
    layer = project.mapLayer(settings.stores)
    if layer is None:
        raise ConeLayerError(
            tr("The layer of stores is not in the project any more. Choose another, or none.")
        )
    return tuple(
        Store(row.name, row.x, row.y, row.number("service_s", settings.store_s))
        for row in _rows(layer, project, frame, False)
    )


@dataclass(frozen=True)
class _Row:
    where: str
    name: str
    x: float
    y: float
    values: dict[str, Any]

    def number(self, field: str, otherwise: float) -> float:
        value = self.values.get(field)
        if value is None or value == "":
            return otherwise
        try:
            number = float(value)
        except (TypeError, ValueError):
            number = math.nan
        if not math.isfinite(number):
            raise ConeLayerError(
                tr(
                    "{where}: {field} is {value!r}, which is no number; correct it.",
                    where=self.where,
                    field=field,
                    value=value,
                )
            )
        return number


def _rows(layer: QgsVectorLayer, project: QgsProject, frame: SiteFrame, selected: bool) -> Iterator[_Row]:
    transform = QgsCoordinateTransform(layer.crs(), QgsCoordinateReferenceSystem(frame.crs), project)
    names = layer.fields().names()
    features = layer.getSelectedFeatures() if selected else layer.getFeatures(QgsFeatureRequest())
    for feature in features:
        where = tr("{layer}, feature {id}", layer=layer.name(), id=feature.id())
        geometry = feature.geometry()
        try:
            geometry.transform(transform)
            points = list(geometry.vertices())
        except QgsCsException:
            points = []
        if len(points) != 1 or not (math.isfinite(points[0].x()) and math.isfinite(points[0].y())):
            raise ConeLayerError(
                tr(
                    "{where} is not one point with a place on the site: correct or delete it.",
                    where=where,
                )
            )
        ((x, y),) = frame.to_site([(points[0].x(), points[0].y())]).tolist()
        values = {
            name: None if value == NULL else value
            for name, value in zip(names, feature.attributes(), strict=True)
        }
        name = next((str(values[one]) for one in _NAMES if values.get(one) not in (None, "")), "")
        yield _Row(where, name or str(feature.id()), x, y, values)
