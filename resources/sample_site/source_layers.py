"""The operator's layers of the sample site: one GeoPackage layer for each kind of object."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
import shapely
from plan import CRS, Item, Plan

from robot_bridge.core.sites.frame import SiteFrame
from robot_bridge.core.sites.geopackage import Layer, LayerSpec, layer_of, write_layers

OBJECT_FIELDS = {"name": str, "height_m": float, "kind": str}


def write_source_layers(file: Path, plan: Plan, frame: SiteFrame) -> None:
    """Write ``plan`` to the GeoPackage ``file``, replacing it."""
    file.unlink(missing_ok=True)
    objects = {
        "buildings": ("Polygon", plan.buildings),
        "walls": ("LineString", plan.walls),
        "columns": ("Polygon", plan.columns),
        "litter_bins": ("Polygon", plan.litter_bins),
        "benches": ("Polygon", plan.benches),
        "stairs": ("MultiLineString", plan.stairs),
    }
    layers = [_objects(name, kind, items, frame) for name, (kind, items) in objects.items()]
    layers += [_ramps(plan, frame), _centrelines(plan, frame), _surfaces(plan, frame), _keepouts(plan, frame)]
    write_layers(file, layers, CRS, "source layers")


def _objects(name: str, kind: str, items: Sequence[Item], frame: SiteFrame) -> Layer:
    values = {
        "name": [item.name for item in items],
        "height_m": [item.height for item in items],
        "kind": [item.kind for item in items],
    }
    return layer_of(LayerSpec(name, kind, OBJECT_FIELDS), _placed(items, frame), values)


def _ramps(plan: Plan, frame: SiteFrame) -> Layer:
    """Return the ramps; ``up_deg`` is the direction of ascent, counter-clockwise from the CRS's x axis."""
    spec = LayerSpec("ramp", "Polygon Z", {"name": str, "rise_m": float, "slope_pct": float, "up_deg": float})
    values = {
        "name": [ramp.item.name for ramp in plan.ramps],
        "rise_m": [ramp.rise for ramp in plan.ramps],
        "slope_pct": [round(100 * ramp.rise / ramp.run, 1) for ramp in plan.ramps],
        "up_deg": [ramp.up_deg for ramp in plan.ramps],
    }
    return layer_of(spec, [_placed_in_3d(ramp.slope, frame) for ramp in plan.ramps], values)


def _centrelines(plan: Plan, frame: SiteFrame) -> Layer:
    spec = LayerSpec("road_centrelines", "LineString", {"name": str, "width_m": float, "surface": str})
    values = {
        "name": [road.name for road in plan.roads],
        "width_m": [road.width for road in plan.roads],
        "surface": [road.surface for road in plan.roads],
    }
    return layer_of(spec, [shapely.LineString(frame.to_crs(road.points)) for road in plan.roads], values)


def _surfaces(plan: Plan, frame: SiteFrame) -> Layer:
    parts = [(part, surface) for surface, whole in plan.surfaces.items() for part in shapely.get_parts(whole)]
    geometries = [shapely.transform(part, frame.to_crs) for part, _ in parts]
    spec = LayerSpec("road_surfaces", "Polygon", {"surface": str})
    return layer_of(spec, geometries, {"surface": [surface for _, surface in parts]})


def _keepouts(plan: Plan, frame: SiteFrame) -> Layer:
    spec = LayerSpec("keepouts", "Polygon", {"name": str})
    return layer_of(spec, _placed(plan.keepouts, frame), {"name": [item.name for item in plan.keepouts]})


def _placed(items: Sequence[Item], frame: SiteFrame) -> list[Any]:
    return [shapely.transform(item.geometry, frame.to_crs) for item in items]


def _placed_in_3d(slope: shapely.Polygon, frame: SiteFrame) -> shapely.Polygon:
    corners = shapely.get_coordinates(slope, include_z=True)
    return shapely.Polygon(np.column_stack([frame.to_crs(corners[:, :2]), corners[:, 2]]))
