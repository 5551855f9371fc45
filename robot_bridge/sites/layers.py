"""The four layers of ``site.gpkg`` and the fields each one has."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class LayerSpec:
    """A layer's name, its OGR geometry type and its fields with the numpy type of each."""

    name: str
    geometry: str
    fields: dict[str, type]


OBSTACLES = LayerSpec(
    "obstacles",
    "Unknown",
    {"source": str, "semantics": str, "height_m": float, "outdoor": bool, "shape_type": int},
)
CENTRELINES = LayerSpec("road_centrelines", "LineString", {"width_m": float, "surface": str})
SURFACES = LayerSpec("road_surfaces", "Polygon", {"surface": str})
KEEPOUTS = LayerSpec("keepouts", "Polygon", {"name": str})
