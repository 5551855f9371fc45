"""The four layers of ``site.gpkg`` and the fields each one has."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from ..roads.centrelines import DEFAULT_SPEED
from ..roads.surfaces.surface import DRAWN


@dataclass(frozen=True)
class LayerSpec:
    """A layer's name, its OGR geometry type and its fields with the numpy type of each.

    ``defaults`` are the fields that a site of an older version may lack, with what they are then.
    """

    name: str
    geometry: str
    fields: dict[str, type]
    defaults: Mapping[str, float | str] = field(default_factory=dict)

    def declared_geometry(self, empty: bool) -> str:
        """Return the geometry type that the layer's table declares.

        A layer of any geometry with nothing in it is to QGIS 3.22 a table without geometry and CRS: an empty
        one declares polygons.
        """
        return "Polygon" if empty and self.geometry == "Unknown" else self.geometry


OBSTACLES = LayerSpec(
    "obstacles",
    "Unknown",
    {
        "source": str,
        "semantics": str,
        "height_m": float,
        "outdoor": bool,
        "shape_type": int,
        "base_m": float,
        "ext": str,
    },
    defaults={"base_m": 0.0, "ext": ""},
)
CENTRELINES = LayerSpec(
    "road_centrelines",
    "LineString",
    {"width_m": float, "surface": str, "direction": int, "speed_ms": float, "closed": bool, "level": int},
    defaults={"direction": 0, "speed_ms": DEFAULT_SPEED, "closed": False, "level": 0},
)
SURFACES = LayerSpec(
    "road_surfaces",
    "Polygon",
    {"surface": str, "name": str, "origin": str},
    defaults={"name": "", "origin": DRAWN},
)
KEEPOUTS = LayerSpec("keepouts", "Polygon", {"name": str})
