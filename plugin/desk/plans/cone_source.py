"""Cones and stores, read from the project's point layers into the site frame."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from qgis.core import (
    QgsCoordinateReferenceSystem,
    QgsProject,
    QgsVectorLayer,
    QgsWkbTypes,
)

from ....robot_bridge.assignment.job import PLACE, Store, Target
from ....robot_bridge.compass import theta_of
from ....robot_bridge.sites.frame import SiteFrame
from ...errors import FleetError
from ...language import tr
from ...sites.placing import SitePlacing
from ...sites.point_rows import PointRow, point_rows
from ...sites.site_crs import stated_crs
from .plan_settings import PlanSettings

_NAMES = ("id", "name")


class ConeLayerError(FleetError):
    """There is no layer of cones or stores to plan for, or nothing in it."""


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

    :raises ConeLayerError: when the layer is not there, or empty; LayerReadingError naming the layer, the
        feature and the field that cannot be used.
    """
    layer = project.mapLayer(settings.cones)
    if layer is None:
        raise ConeLayerError(tr("No layer of cones is chosen. Choose one, or place a cone layout first."))
    targets, facts = [], {}
    for row in _rows(layer, project, frame, selected=settings.selected_only):
        theta = frame.theta_to_site(theta_of(row.number("heading", 90.0)))
        stage, demand = row.whole("stage", 0), row.whole("demand", 1)
        service_s = row.number("service_s", settings.service_s)
        targets.append(Target(row.name, row.x, row.y, theta, stage, PLACE, demand, service_s))
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
        for row in _rows(layer, project, frame, selected=False)
    )


def _rows(
    layer: QgsVectorLayer, project: QgsProject, frame: SiteFrame, *, selected: bool
) -> Iterator[PointRow]:
    crs = stated_crs(QgsCoordinateReferenceSystem(frame.crs))
    placing = SitePlacing(crs, frame, project.transformContext()).of_layer(layer.name(), layer.crs())
    features = layer.getSelectedFeatures() if selected else layer.getFeatures()
    return point_rows(layer.name(), features, placing, _NAMES)
