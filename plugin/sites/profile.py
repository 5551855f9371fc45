"""Map profiles: what layers of a known kind of data are, so that a site of it is prepared in one go."""

from __future__ import annotations

from dataclasses import dataclass
from fnmatch import fnmatchcase

from qgis.core import QgsMapLayer, QgsVectorLayer, QgsWkbTypes

from .obstacle_source import plain_name
from .roles import LayerSetup, setup_of

GEOMETRIES = {
    "point": QgsWkbTypes.GeometryType.PointGeometry,
    "line": QgsWkbTypes.GeometryType.LineGeometry,
    "polygon": QgsWkbTypes.GeometryType.PolygonGeometry,
}


@dataclass(frozen=True)
class ProfileRule:
    """Layers that one of the ``names`` fits, with all of the ``fields``, are set up as ``setup`` says.

    ``names`` are patterns with ``*`` and ``?``, whatever the case; none fit every layer. ``geometry`` is
    ``""`` or a key of :data:`GEOMETRIES`.
    """

    names: tuple[str, ...]
    fields: tuple[str, ...]
    geometry: str
    setup: LayerSetup

    def fits(self, layer: QgsMapLayer) -> bool:
        """Tell whether the rule is about ``layer``."""
        if not isinstance(layer, QgsVectorLayer):
            return False
        name = plain_name(layer).lower()
        if self.names and not any(fnmatchcase(name, pattern.lower()) for pattern in self.names):
            return False
        if self.geometry and layer.geometryType() != GEOMETRIES[self.geometry]:
            return False
        return all(layer.fields().lookupField(field) >= 0 for field in self.fields)


@dataclass(frozen=True)
class Profile:
    """Rules in the order of the file: the first that fits a layer counts."""

    name: str
    about: str
    rules: tuple[ProfileRule, ...]

    def setup_for(self, layer: QgsMapLayer) -> LayerSetup | None:
        """Return how ``layer`` is set up, None where the profile has no rule for it."""
        return next((rule.setup for rule in self.rules if rule.fits(layer)), None)

    def setup_over(self, layer: QgsMapLayer) -> LayerSetup:
        """Return how ``layer`` is set up: by the profile, else as the layer keeps it itself."""
        return self.setup_for(layer) or setup_of(layer)
