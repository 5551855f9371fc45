"""The rows of the role table: one for each layer of the project that can have a role."""

from __future__ import annotations

from dataclasses import dataclass, replace

from qgis.core import QgsMapLayer, QgsProject, QgsRasterLayer, QgsVectorLayer, QgsWkbTypes

from ..desk.live_layers import MARK
from ..sites.roles import (
    FURNITURE,
    KEEPOUT,
    OBSTACLE,
    ORTHOPHOTO,
    RAMP,
    ROAD_CENTRELINE,
    ROAD_SURFACE,
    STAIRS,
    LayerSetup,
    setup_of,
)

_LINES = (OBSTACLE, STAIRS, FURNITURE, ROAD_CENTRELINE)
_POLYGONS = (OBSTACLE, RAMP, FURNITURE, ROAD_SURFACE, KEEPOUT)
_CHOICES = {
    QgsWkbTypes.GeometryType.PointGeometry: (FURNITURE,),
    QgsWkbTypes.GeometryType.LineGeometry: _LINES,
    QgsWkbTypes.GeometryType.PolygonGeometry: _POLYGONS,
    QgsWkbTypes.GeometryType.UnknownGeometry: tuple(dict.fromkeys((*_LINES, *_POLYGONS))),
}


@dataclass
class RoleRow:
    """A layer and what the dialog says it is; id and name can be asked for when the layer is gone."""

    layer: QgsRasterLayer | QgsVectorLayer
    layer_id: str
    name: str
    setup: LayerSetup

    @property
    def roles(self) -> tuple[str, ...]:
        """The roles that the layer can have, and the one it has however odd; ``""`` is none."""
        if isinstance(self.layer, QgsRasterLayer):
            choices: tuple[str, ...] = (ORTHOPHOTO,)
        else:
            choices = _CHOICES.get(self.layer.geometryType(), ())
        return tuple(dict.fromkeys(("", *choices, self.setup.role)))

    def change(self, what: str, text: str) -> None:
        """Set ``role`` or one of the expressions."""
        text = text.strip()
        if what == "role":
            self.setup = replace(self.setup, role=text)
        else:
            self.setup = replace(self.setup, expressions=replace(self.setup.expressions, **{what: text}))


def rows_of(project: QgsProject) -> list[RoleRow]:
    """Return a row for each layer that can have a role, by name; the desk's live robots have none."""
    layers = [layer for layer in project.mapLayers().values() if _can_have_a_role(layer)]
    return [
        RoleRow(layer, layer.id(), layer.name(), setup_of(layer))
        for layer in sorted(layers, key=lambda layer: (layer.name().lower(), layer.id()))
    ]


def _can_have_a_role(layer: QgsMapLayer) -> bool:
    if layer.customProperty(MARK):
        return False
    if isinstance(layer, QgsVectorLayer):
        return layer.isValid() and layer.isSpatial() and layer.geometryType() in _CHOICES
    return isinstance(layer, QgsRasterLayer)
