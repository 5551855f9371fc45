"""Centrelines, road surfaces and keepouts as features of their layers, and back."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from ..roads.surfaces.surface import DRAWN, GENERATED, Surface
from .errors import LayerError
from .features import Area, Centreline
from .frame import SiteFrame
from .geopackage import Layer, layer_of
from .layers import CENTRELINES, SURFACES, LayerSpec


def centreline_layer(centrelines: Sequence[Centreline], frame: SiteFrame) -> Layer:
    """Return ``centrelines`` as line strings in the site CRS.

    :raises LayerError: naming the first centreline with fewer than two points.
    """
    import shapely

    for k, line in enumerate(centrelines, start=1):
        if len(line.points) < 2:
            raise LayerError(f"Centreline {k} has {len(line.points)} point(s): a road needs two or more.")
    return layer_of(
        CENTRELINES,
        [shapely.LineString(frame.to_crs(line.points)) for line in centrelines],
        {
            "width_m": [line.width_m for line in centrelines],
            "surface": [line.surface for line in centrelines],
            "direction": [line.direction for line in centrelines],
            "speed_ms": [line.speed_ms for line in centrelines],
            "closed": [line.closed for line in centrelines],
            "level": [line.level for line in centrelines],
        },
    )


def centrelines_of(layer: Layer, frame: SiteFrame, place: str) -> tuple[Centreline, ...]:
    """Return the centrelines in ``layer``; ``place`` is its file, for messages.

    :raises LayerError: naming a road whose width is not above 0 or that is not a line.
    """
    _require(layer, "LineString", place)
    for name, wanted in (("width_m", "a road is wider than 0 m"), ("speed_ms", "a speed is above 0 m/s")):
        numbers = np.asarray(layer.values[name], dtype=np.float64)
        if (numbers <= 0).any():
            k = int(np.argmax(numbers <= 0))
            raise LayerError(
                f"{place}, layer {layer.spec.name}, feature {layer.ids[k]}: {name} is {numbers[k]:g}; "
                f"{wanted}. Correct it in the source layer and publish the site again."
            )
    columns = [layer.values[name] for name in layer.spec.fields]
    return tuple(
        Centreline(
            frame.to_site(np.asarray(geometry.coords)[:, :2]),
            width_m=float(width),
            surface=surface or "",
            direction=int(np.sign(direction)),
            speed_ms=float(speed),
            closed=bool(closed),
            level=int(level),
        )
        for geometry, width, surface, direction, speed, closed, level in zip(
            layer.geometries, *columns, strict=True
        )
    )


def area_layer(spec: LayerSpec, areas: Sequence[Area], frame: SiteFrame) -> Layer:
    """Return ``areas`` as polygons in the site CRS, each label in the one field of ``spec``."""
    (label,) = spec.fields
    polygons = [_polygon(area.rings, frame) for area in areas]
    return layer_of(spec, polygons, {label: [area.label for area in areas]})


def areas_of(layer: Layer, frame: SiteFrame, place: str) -> tuple[Area, ...]:
    """Return the polygons in ``layer``; ``place`` is its file, for messages.

    :raises LayerError: naming a feature that is not a polygon.
    """
    _require(layer, "Polygon", place)
    (label,) = layer.spec.fields
    return tuple(
        Area(tuple(frame.to_site(ring) for ring in _rings(geometry)), text or "")
        for geometry, text in zip(layer.geometries, layer.values[label], strict=True)
    )


def surface_layer(surfaces: Sequence[Surface], frame: SiteFrame) -> Layer:
    """Return ``surfaces`` as polygons in the site CRS."""
    return layer_of(
        SURFACES,
        [_polygon(one.rings, frame) for one in surfaces],
        {
            "surface": [one.label for one in surfaces],
            "name": [one.name for one in surfaces],
            "origin": [one.origin for one in surfaces],
        },
    )


def surfaces_of(layer: Layer, frame: SiteFrame, place: str) -> tuple[Surface, ...]:
    """Return the road surfaces in ``layer``; ``place`` is its file, for messages.

    :raises LayerError: naming a feature that is not a polygon.
    """
    _require(layer, "Polygon", place)
    columns = [layer.values[name] for name in layer.spec.fields]
    return tuple(
        Surface(
            tuple(frame.to_site(ring) for ring in _rings(geometry)),
            label or "",
            name or "",
            GENERATED if origin == GENERATED else DRAWN,
        )
        for geometry, label, name, origin in zip(layer.geometries, *columns, strict=True)
    )


def _polygon(rings: Sequence[Any], frame: SiteFrame) -> Any:
    import shapely

    outer, *holes = [frame.to_crs(ring) for ring in rings]
    return shapely.Polygon(outer, holes)


def _rings(polygon: Any) -> list[Any]:
    return [np.asarray(ring.coords)[:, :2] for ring in (polygon.exterior, *polygon.interiors)]


def _require(layer: Layer, kind: str, place: str) -> None:
    for feature, geometry in zip(layer.ids, layer.geometries, strict=True):
        if geometry.geom_type != kind:
            raise LayerError(
                f"{place}, layer {layer.spec.name}, feature {feature}: it is a {geometry.geom_type}, "
                f"not a {kind}. Split or redraw it in the source layer and publish the site again."
            )
