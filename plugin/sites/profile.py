"""Map profiles: what layers of a known kind of data are, so that a site of it is prepared in one go."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from fnmatch import fnmatchcase

from qgis.core import QgsMapLayer, QgsVectorLayer, QgsWkbTypes

from ..language import tr
from .obstacle_source import names_of
from .roles import LayerSetup, setup_of

GEOMETRIES = {
    "point": QgsWkbTypes.GeometryType.PointGeometry,
    "line": QgsWkbTypes.GeometryType.LineGeometry,
    "polygon": QgsWkbTypes.GeometryType.PolygonGeometry,
}


@dataclass(frozen=True)
class ProfileRule:
    """Layers that one of the ``names`` fits, with all of the ``fields``, are set up as ``setup`` says.

    A layer's name is the one that is shown or the one in its source. ``names`` are patterns with ``*`` and
    ``?``, whatever the case; none fit every layer. ``geometry`` is ``""`` or a key of :data:`GEOMETRIES`.
    """

    names: tuple[str, ...]
    fields: tuple[str, ...]
    geometry: str
    setup: LayerSetup

    def fits(self, layer: QgsMapLayer) -> bool:
        """Tell whether the rule is about ``layer``."""
        if not isinstance(layer, QgsVectorLayer):
            return False
        if not self._fits_name([name.lower() for name in names_of(layer)]):
            return False
        if self.geometry and layer.geometryType() != GEOMETRIES[self.geometry]:
            return False
        return all(layer.fields().lookupField(field) >= 0 for field in self.fields)

    def _fits_name(self, names: Sequence[str]) -> bool:
        patterns = [pattern.lower() for pattern in self.names]
        return not patterns or any(fnmatchcase(name, pattern) for name in names for pattern in patterns)

    def in_words(self) -> str:
        """Return what the rule looks for, such as ``walls, wall* with z_min, z_max``."""
        names, fields = ", ".join(self.names), ", ".join(self.fields)
        return tr("{names} with {fields}", names=names or "*", fields=fields) if fields else names


@dataclass(frozen=True)
class Profile:
    """Rules in the order of the file: the first that fits a layer counts."""

    name: str
    about: str
    rules: tuple[ProfileRule, ...]

    def sought(self) -> str:
        """Return which names and fields of layers the rules look for."""
        return "; ".join(rule.in_words() for rule in self.rules)

    def setup_for(self, layer: QgsMapLayer) -> LayerSetup | None:
        """Return how ``layer`` is set up, None where the profile has no rule for it."""
        return next((rule.setup for rule in self.rules if rule.fits(layer)), None)

    def setup_over(self, layer: QgsMapLayer) -> LayerSetup:
        """Return how ``layer`` is set up: by the profile, else as the layer keeps it itself."""
        return self.setup_for(layer) or setup_of(layer)
