"""The content of a site as rows of the layers of ``site.gpkg``: well-known binary and values."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any, NamedTuple

import numpy as np

from ...robot_bridge.roads.surfaces.surface import Surface
from ...robot_bridge.robotmap.model import ShapeType
from ...robot_bridge.robotmap.outlines import OutlineRow
from ...robot_bridge.sites.features import Area
from ...robot_bridge.sites.frame import SiteFrame
from ...robot_bridge.sites.layers import CENTRELINES, KEEPOUTS, OBSTACLES, SURFACES, LayerSpec
from ...robot_bridge.sites.obstacle_layer import obstacle_values
from .site_content import SiteContent
from .wkb import line_wkb, multi_line_wkb, polygon_wkb

_RINGS = (ShapeType.CLOSED_POLYGON, ShapeType.CLOSED_CURVE, ShapeType.RAMP)


class SiteRow(NamedTuple):
    """One feature: its geometry in the site CRS and the values of its layer's fields by name."""

    wkb: bytes
    values: dict[str, Any]


def site_rows(content: SiteContent, frame: SiteFrame) -> list[tuple[LayerSpec, Iterator[SiteRow]]]:
    """Return the four layers of a site with the rows of each."""
    return [
        (OBSTACLES, _obstacle_rows(content.obstacles, frame)),
        (CENTRELINES, _centreline_rows(content, frame)),
        (SURFACES, _surface_rows(content.surfaces, frame)),
        (KEEPOUTS, _area_rows(KEEPOUTS, content.keepouts, frame)),
    ]


def _obstacle_rows(rows: Sequence[OutlineRow], frame: SiteFrame) -> Iterator[SiteRow]:
    first = 0
    for k in range(1, len(rows) + 1):
        # A courtyard is a hole of the ring before it.
        if k == len(rows) or not (rows[k].courtyard and rows[k].source == rows[first].source):
            yield _obstacle_row(rows[first:k], frame)
            first = k


def _obstacle_row(rows: Sequence[OutlineRow], frame: SiteFrame) -> SiteRow:
    row = rows[0]
    points = [frame.to_crs(one.points) for one in rows]
    if row.shape_type is ShapeType.STAIRS:
        wkb = multi_line_wkb(points[0].reshape(-1, 2, 2))
    elif row.shape_type in _RINGS:
        wkb = polygon_wkb([_shut(ring) for ring in points])
    else:
        wkb = line_wkb(points[0])
    return SiteRow(wkb, obstacle_values(row))


def _centreline_rows(content: SiteContent, frame: SiteFrame) -> Iterator[SiteRow]:
    for line in content.centrelines:
        values = {name: getattr(line, name) for name in CENTRELINES.fields}
        yield SiteRow(line_wkb(frame.to_crs(line.points)), values)


def _area_rows(spec: LayerSpec, areas: Sequence[Area], frame: SiteFrame) -> Iterator[SiteRow]:
    (label,) = spec.fields
    for area in areas:
        rings = [_shut(frame.to_crs(ring)) for ring in area.rings]
        yield SiteRow(polygon_wkb(rings), {label: area.label})


def _surface_rows(surfaces: Sequence[Surface], frame: SiteFrame) -> Iterator[SiteRow]:
    for one in surfaces:
        rings = [_shut(frame.to_crs(ring)) for ring in one.rings]
        values = {"surface": one.label, "name": one.name, "origin": one.origin}
        yield SiteRow(polygon_wkb(rings), values)


def _shut(ring: np.ndarray) -> np.ndarray:
    # Rotating there and back may leave the two ends a rounding error apart.
    ring[-1] = ring[0]
    return ring
