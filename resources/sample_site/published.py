"""The sample site as the gateway reads it: obstacles, roads and keepouts in the site frame."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import numpy as np
import shapely
from plan import CRS, HEIGHT, ORIGIN, SITE_ID, SITE_NAME, WIDTH, Item, Plan

from robot_bridge.core.roads.network import Surface
from robot_bridge.core.robotmap.model import ShapeType
from robot_bridge.core.robotmap.outlines import OutlineRow, Outlines
from robot_bridge.core.robotmap.parametric_shapes import ramp_normal
from robot_bridge.core.sites.frame import SiteBounds
from robot_bridge.core.sites.geopackage import Area, Centreline
from robot_bridge.core.sites.settings import SiteSettings
from robot_bridge.core.sites.site import write_site

SETTINGS = SiteSettings(
    id=SITE_ID,
    name=SITE_NAME,
    version=1,
    crs=CRS,
    origin=ORIGIN,
    bounds=SiteBounds(0.0, 0.0, WIDTH, HEIGHT),
)


def publish(folder: Path, plan: Plan) -> None:
    """Write ``site.toml`` and ``site.gpkg`` into ``folder``."""
    write_site(
        folder,
        SETTINGS,
        Outlines.from_rows(list(obstacle_rows(plan))),
        [Centreline(road.points, road.width, road.surface) for road in plan.roads],
        [
            Surface(_rings(part), surface)
            for surface, whole in plan.surfaces.items()
            for part in shapely.get_parts(whole)
        ],
        [Area(_rings(item.geometry), item.name) for item in plan.keepouts],
    )


def obstacle_rows(plan: Plan) -> Iterator[OutlineRow]:
    """Yield every outline that a robot can run into, named after its layer and its place in it."""
    normals = {
        ramp.item.name: {"n": ramp_normal(shapely.get_coordinates(ramp.slope, include_z=True))}
        for ramp in plan.ramps
    }
    kinds = {
        "buildings": ("building", ShapeType.CLOSED_POLYGON, plan.buildings),
        "walls": ("wall", ShapeType.OPEN_POLYGON, plan.walls),
        "columns": ("column", ShapeType.CLOSED_CURVE, plan.columns),
        "litter_bins": ("litter bin", ShapeType.CLOSED_POLYGON, plan.litter_bins),
        "benches": ("bench", ShapeType.CLOSED_POLYGON, plan.benches),
        "stairs": ("stairs", ShapeType.STAIRS, plan.stairs),
        "ramp": ("ramp", ShapeType.RAMP, [ramp.item for ramp in plan.ramps]),
    }
    for layer, (word, shape_type, items) in kinds.items():
        for number, item in enumerate(items, start=1):
            for k, points in enumerate(_outlines(item)):
                yield OutlineRow(
                    points=points,
                    shape_type=shape_type,
                    height=item.height,
                    semantics=f"{word},{item.name}",
                    source=f"{layer}:{number}",
                    courtyard=k > 0,
                    ext=normals.get(item.name, {}),
                )


def _outlines(item: Item) -> tuple[np.ndarray, ...]:
    if item.geometry.geom_type == "Polygon":
        return _rings(item.geometry)
    return (shapely.get_coordinates(item.geometry),)


def _rings(polygon: shapely.Polygon) -> tuple[np.ndarray, ...]:
    return tuple(shapely.get_coordinates(ring) for ring in (polygon.exterior, *polygon.interiors))
