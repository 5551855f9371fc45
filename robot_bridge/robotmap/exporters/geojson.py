"""A robot map as GeoJSON (RFC 7946)."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .errors import PlaceError
from .lines import Points, signed_area
from .shapes import Shape

ToLonLat = Callable[[Points], NDArray[Any]]
"""From (n, 2) metres in the site frame to (n, 2) longitudes and latitudes, WGS 84 degrees."""

_DIGITS = 8
"""A millimetre: the map's centimetres survive the way there and back."""


def geojson_of(shapes: Sequence[Shape], to_lonlat: ToLonLat, meta: Mapping[str, str] | None = None) -> bytes:
    """Return a FeatureCollection of ``shapes``; outer rings run counter-clockwise, holes clockwise.

    ``meta`` becomes the member ``robot_map``, which readers that do not know it pass over. Raises PlaceError
    when a position is none on the earth, or the map lies across the antimeridian.
    """
    placed = _placed(shapes, to_lonlat)
    content: dict[str, Any] = {"type": "FeatureCollection"}
    if meta:
        content["robot_map"] = dict(meta)
    if placed:
        every = np.concatenate([part for parts in placed for part in parts])
        content["bbox"] = [*every.min(axis=0).tolist(), *every.max(axis=0).tolist()]
    content["features"] = [
        {"type": "Feature", "geometry": _geometry(shape, parts), "properties": shape.attributes}
        for shape, parts in zip(shapes, placed, strict=True)
    ]
    text = json.dumps(content, ensure_ascii=False, allow_nan=False, separators=(",", ":"))
    # A feature a line: programs do not care, and people and their diffs do.
    return (text.replace(',{"type":"Feature"', ',\n{"type":"Feature"') + "\n").encode()


def _placed(shapes: Sequence[Shape], to_lonlat: ToLonLat) -> list[list[NDArray[Any]]]:
    """Return longitudes and latitudes of each part of each shape, transformed at once."""
    parts = [part for shape in shapes for part in shape.parts]
    if not parts:
        return []
    positions = np.round(np.asarray(to_lonlat(np.concatenate(parts)), dtype=np.float64), _DIGITS)
    _check(positions)
    pieces = iter(np.split(positions, np.cumsum([len(part) for part in parts])[:-1]))
    return [[next(pieces) for _ in shape.parts] for shape in shapes]


def _check(positions: NDArray[Any]) -> None:
    if not np.isfinite(positions).all() or (np.abs(positions) > (180.0, 90.0)).any():
        raise PlaceError(
            "GeoJSON: a position of the map is none on the earth; check the CRS, the origin and the rotation "
            "of the site frame"
        )
    if np.ptp(positions[:, 0]) > 180.0:
        raise PlaceError(
            "GeoJSON: the map lies across the antimeridian, where GeoJSON wants it cut in two; export each "
            "side as a window of its own"
        )


def _geometry(shape: Shape, parts: list[NDArray[Any]]) -> dict[str, Any]:
    if shape.kind == "Polygon":
        rings = [_turned(ring, outer=number == 0).tolist() for number, ring in enumerate(parts)]
        return {"type": "Polygon", "coordinates": rings}
    if shape.kind == "LineString":
        return {"type": "LineString", "coordinates": parts[0].tolist()}
    if len(parts) == 1:
        return {"type": "LineString", "coordinates": parts[0].tolist()}
    return {"type": "MultiLineString", "coordinates": [part.tolist() for part in parts]}


def _turned(ring: NDArray[Any], outer: bool) -> NDArray[Any]:
    return ring if (signed_area(ring) > 0) == outer else ring[::-1]
