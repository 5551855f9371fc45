"""The layer that the operator's cone layouts go into, and what they are checked against."""

from __future__ import annotations

from collections.abc import Collection, Sequence

import numpy as np
from qgis.core import (
    QgsCoordinateReferenceSystem,
    QgsExpressionContext,
    QgsExpressionContextUtils,
    QgsFeature,
    QgsGeometry,
    QgsPointXY,
    QgsProcessingFeedback,
    QgsProject,
    QgsVectorLayer,
)

from ...robot_bridge.layouts.checks import Finding, Shape, find
from ...robot_bridge.layouts.cone import Cone
from ..errors import PlacementError
from ..language import tr
from ..processing.cone_ground import read_obstacles
from ..processing.cone_layer import CONE_FIELDS, cone_values
from ..processing.fleet_algorithm import RESOURCES
from ..sites.ground_reading import read_areas
from ..sites.obstacle_source import obstacle_sources
from ..sites.placing import SitePlacing
from ..sites.roles import OBSTACLE_ROLES, ROAD_SURFACE, LayerExpressions, layers_with_role
from ..sites.site_crs import check_site_crs

MARK = "fleet/cones"
"""The custom property of the layer."""

OBSTACLE_DISTANCE_M = CONE_DISTANCE_M = 0.5


class ConeStore:
    """Finds or makes the layer of cones in a project."""

    def __init__(self, project: QgsProject):
        self._project = project

    def layer(self) -> QgsVectorLayer | None:
        """Return the layer of cones, None before there is one."""
        marked = (one for one in self._project.mapLayers().values() if one.customProperty(MARK))
        return next((one for one in marked if one.isValid()), None)

    def crs(self, canvas: QgsCoordinateReferenceSystem) -> QgsCoordinateReferenceSystem:
        """Return the CRS of the cones: their layer's, else the canvas's.

        :raises SiteCrsError: when the canvas's CRS has no true metres.
        :raises PlacementError: when there is none.
        """
        layer = self.layer()
        if layer is not None:
            return layer.crs()
        if not canvas.isValid():
            raise PlacementError(
                tr("The project has no CRS: choose one in metres, at the bottom right in QGIS.")
            )
        check_site_crs(canvas)
        return canvas

    def prefix(self, name: str) -> str:
        """Return what the ids of one more layout ``name`` begin with: no other's do."""
        layer = self.layer()
        ids = {str(f["id"]).rpartition("-")[0] for f in layer.getFeatures()} if layer is not None else set()
        taken = (f"{name}-{number}" for number in range(2, len(ids) + 3))
        return name if name not in ids else next(prefix for prefix in taken if prefix not in ids)

    def add(self, cones: Sequence[Cone], name: str, crs: QgsCoordinateReferenceSystem) -> QgsVectorLayer:
        """Add ``cones``, which are in ``crs``, to the layer; make it where there is none."""
        layer = self.layer() or self._made(crs)
        features = []
        for cone in cones:
            feature = QgsFeature(layer.fields())
            feature.setGeometry(QgsGeometry.fromPointXY(QgsPointXY(cone.x, cone.y)))
            values = dict(zip(CONE_FIELDS, cone_values(cone, name), strict=True))
            for field, value in values.items():
                feature.setAttribute(field, value)
            features.append(feature)
        added, _ = layer.dataProvider().addFeatures(features)
        if not added:
            raise PlacementError(
                tr(
                    "The layer {layer} takes no cones: make it writable, or remove it.",
                    layer=layer.name(),
                )
            )
        layer.updateExtents()
        layer.triggerRepaint()
        return layer

    def take_out(self, layer_id: str, ids: Collection[str]) -> bool:
        """Remove the cones ``ids`` from the layer ``layer_id``; false where none is there any more."""
        layer = self.layer()
        if layer is None or layer.id() != layer_id:
            return False
        found = [feature.id() for feature in layer.getFeatures() if feature["id"] in ids]
        if not found or not layer.dataProvider().deleteFeatures(found):
            return False
        layer.updateExtents()
        layer.triggerRepaint()
        return True

    def places(self) -> np.ndarray:
        """Return where cones stand already, (n, 2) in the CRS of their layer."""
        return np.array([(cone.x, cone.y) for cone in self._standing()], dtype=np.float64).reshape(-1, 2)

    def check(self, cones: Sequence[Cone], crs: QgsCoordinateReferenceSystem) -> list[Finding]:
        """Return what is wrong with ``cones`` by the project's layers and the cones that stand already.

        :raises FleetError: when a layer has no known place in ``crs``.
        """
        site = SitePlacing.in_crs(crs, self._project.transformContext())
        context = QgsExpressionContext(QgsExpressionContextUtils.globalProjectLayerScopes(None))
        feedback = QgsProcessingFeedback(False)

        def sources(*roles):
            return obstacle_sources(layers_with_role(self._project, *roles), LayerExpressions(), context)

        roads = sources(ROAD_SURFACE)
        areas = read_areas(roads, site, ROAD_SURFACE, feedback).items
        surfaces = [Shape(area.rings, area.label) for area in areas] if roads else None
        obstacles = read_obstacles(sources(*OBSTACLE_ROLES), site, feedback)
        found = find([*self._standing(), *cones], surfaces, obstacles, OBSTACLE_DISTANCE_M, CONE_DISTANCE_M)
        new = {cone.id for cone in cones}
        return [finding for finding in found if finding.cone in new]

    def _standing(self) -> list[Cone]:
        layer = self.layer()
        return [
            Cone(str(f["id"]), 0, f.geometry().asPoint().x(), f.geometry().asPoint().y(), 0.0, "", "")
            for f in (layer.getFeatures() if layer is not None else ())
        ]

    def _made(self, crs: QgsCoordinateReferenceSystem) -> QgsVectorLayer:
        fields = "".join(f"&field={name}:{kind}" for name, kind in CONE_FIELDS.items())
        layer = QgsVectorLayer(f"Point?crs={crs.authid() or crs.toWkt()}{fields}", tr("Cones"), "memory")
        layer.loadNamedStyle(str(RESOURCES / "styles" / "cones.qml"))
        layer.setCustomProperty(MARK, "1")
        self._project.addMapLayer(layer)
        return layer
