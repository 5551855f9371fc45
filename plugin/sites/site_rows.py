"""The content of a site as rows of the layers of ``site.gpkg``: well-known binary and values."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np
from qgis.core import QgsFeedback

from ...robot_bridge.robotmap.model import ShapeType
from ...robot_bridge.robotmap.outlines import Outlines
from ...robot_bridge.sites.extras import extras_text
from ...robot_bridge.sites.frame import SiteFrame
from ...robot_bridge.sites.layers import CENTRELINES, KEEPOUTS, OBSTACLES, SURFACES, LayerSpec
from ...robot_bridge.sites.mapped.writing import CacheWriter
from ...robot_bridge.sites.obstacle_layer import outline_groups
from .site_content import SiteContent
from .wkb import line_wkb, multi_line_wkb, polygon_wkb

_RINGS = tuple(int(one) for one in (ShapeType.CLOSED_POLYGON, ShapeType.CLOSED_CURVE, ShapeType.RAMP))
_STAIRS = int(ShapeType.STAIRS)
_POINT_BYTES = 16


class SiteRow(NamedTuple):
    """One feature: its geometry in the site CRS, the box around that, and the values of its fields.

    ``values`` are in the order of the layer's fields.
    """

    wkb: bytes
    box: Sequence[float]
    values: tuple[Any, ...]


def site_rows(
    content: SiteContent, frame: SiteFrame, cache: CacheWriter, feedback: QgsFeedback
) -> list[tuple[LayerSpec, Iterator[SiteRow]]]:
    """Return the four layers of a site with the rows of each, which are read as they are asked for.

    ``cache`` gets the obstacles as they are read, for they are read once.
    """
    return [
        (OBSTACLES, _obstacle_rows(content, frame, cache, feedback)),
        (CENTRELINES, _centreline_rows(content, frame, feedback)),
        (SURFACES, _surface_rows(content, frame, feedback)),
        (KEEPOUTS, _keepout_rows(content, frame, feedback)),
    ]


def _obstacle_rows(
    content: SiteContent, frame: SiteFrame, cache: CacheWriter, feedback: QgsFeedback
) -> Iterator[SiteRow]:
    for some in content.obstacles(feedback):
        cache.add(some)
        yield from _rows_of(some, frame)


def _rows_of(some: Outlines, frame: SiteFrame) -> Iterator[SiteRow]:
    """Yield ``some`` as features; a courtyard is a hole of the ring before it."""
    xy = frame.to_crs(some.coordinates)
    starts, ends = some.offsets[:-1], some.offsets[1:]
    shut = np.isin(some.shape_type, _RINGS)
    # Rotating there and back may leave the two ends a rounding error apart.
    xy[ends[shut] - 1] = xy[starts[shut]]
    boxes = np.hstack([np.minimum.reduceat(xy, starts), np.maximum.reduceat(xy, starts)]).tolist()
    data, edges, kinds = xy.tobytes(), (some.offsets * _POINT_BYTES).tolist(), some.shape_type.tolist()
    height, outdoor, base = some.height.tolist(), some.outdoor.tolist(), some.bases.tolist()
    extras = [extras_text(one) if one else "" for one in some.extras]
    for first, last in outline_groups(some):
        rings = [data[edges[k] : edges[k + 1]] for k in range(first, last)]
        kind = kinds[first]
        if kind in _RINGS:
            wkb = polygon_wkb(rings)
        else:
            wkb = multi_line_wkb(_risers(rings[0])) if kind == _STAIRS else line_wkb(rings[0])
        values = {
            "source": some.source[first],
            "semantics": some.semantics[first],
            "height_m": height[first],
            "outdoor": int(outdoor[first]),
            "shape_type": kind,
            "base_m": base[first],
            "ext": extras[first],
        }
        yield SiteRow(wkb, boxes[first], _in_order(OBSTACLES, values))


def _risers(points: bytes) -> list[bytes]:
    return [points[at : at + 2 * _POINT_BYTES] for at in range(0, len(points), 2 * _POINT_BYTES)]


def _centreline_rows(content: SiteContent, frame: SiteFrame, feedback: QgsFeedback) -> Iterator[SiteRow]:
    for line in content.centrelines(feedback):
        points = frame.to_crs(line.points)
        values = {name: getattr(line, name) for name in CENTRELINES.fields}
        values["closed"] = int(line.closed)
        yield SiteRow(line_wkb(points.tobytes()), _box(points), _in_order(CENTRELINES, values))


def _surface_rows(content: SiteContent, frame: SiteFrame, feedback: QgsFeedback) -> Iterator[SiteRow]:
    for one in content.surfaces(feedback):
        values = {"surface": one.label, "name": one.name, "origin": one.origin}
        yield _area_row(SURFACES, one.rings, values, frame)


def _keepout_rows(content: SiteContent, frame: SiteFrame, feedback: QgsFeedback) -> Iterator[SiteRow]:
    for one in content.keepouts(feedback):
        yield _area_row(KEEPOUTS, one.rings, {"name": one.label}, frame)


def _area_row(
    spec: LayerSpec, rings: tuple[np.ndarray, ...], values: Mapping[str, Any], frame: SiteFrame
) -> SiteRow:
    placed = [frame.to_crs(ring) for ring in rings]
    for ring in placed:
        ring[-1] = ring[0]
    return SiteRow(polygon_wkb([ring.tobytes() for ring in placed]), _box(placed[0]), _in_order(spec, values))


def _box(points: np.ndarray) -> list[float]:
    return [*points.min(axis=0).tolist(), *points.max(axis=0).tolist()]


def _in_order(spec: LayerSpec, values: Mapping[str, Any]) -> tuple[Any, ...]:
    return tuple([values[name] for name in spec.fields])
