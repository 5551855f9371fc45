"""GeoJSON (RFC 7946) and GeoPackage of a robot map."""

from __future__ import annotations

import json
import struct
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...errors import ExportError, GeoreferenceError, MissingExportPackageError, installation
from ...files import write_geopackage_layer
from ..model import RobotMap
from .geometries import MapShape, Points, obstacle_shapes, segment_shapes, signed_area

# --- A robot map as GeoJSON (RFC 7946) ---

ToLonLat = Callable[[Points], NDArray[Any]]
"""From (n, 2) metres in the site frame to (n, 2) longitudes and latitudes, WGS 84 degrees."""

_DIGITS = 8
"""A millimetre: the map's centimetres survive a round trip."""


def geojson_of(
    shapes: Sequence[MapShape], to_lonlat: ToLonLat, meta: Mapping[str, str] | None = None
) -> bytes:
    """Return a FeatureCollection of ``shapes``; outer rings run counter-clockwise, holes clockwise.

    ``meta`` becomes the member ``robot_map``, which other readers ignore. Raises GeoreferenceError when a
    position is not on the earth, or the map lies across the antimeridian.
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
    # One feature per line, for readable diffs.
    return (text.replace(',{"type":"Feature"', ',\n{"type":"Feature"') + "\n").encode()


def _placed(shapes: Sequence[MapShape], to_lonlat: ToLonLat) -> list[list[NDArray[Any]]]:
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
        raise GeoreferenceError(
            "GeoJSON: a position of the map is none on the earth; check the CRS, the origin and the rotation "
            "of the site frame"
        )
    if np.ptp(positions[:, 0]) > 180.0:
        raise GeoreferenceError(
            "GeoJSON: the map lies across the antimeridian, where GeoJSON wants it cut in two; export each "
            "side as a window of its own"
        )


def _geometry(shape: MapShape, parts: list[NDArray[Any]]) -> dict[str, Any]:
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


# --- A robot map as a GeoPackage ---

ToCrs = Callable[[Points], Points]
"""From (n, 2) metres in the site frame to (n, 2) metres in its CRS."""

_WKB_KIND = {"LineString": 2, "Polygon": 3, "MultiLineString": 5}


def geopackage_layers(robot_map: RobotMap) -> dict[str, list[MapShape]]:
    """Return the shapes of each non-empty layer; within a layer all have one kind and the same attributes."""
    shapes = obstacle_shapes(robot_map)
    layers = {
        "obstacle_areas": [shape for shape in shapes if shape.kind == "Polygon"],
        "obstacle_lines": [shape for shape in shapes if shape.kind == "MultiLineString"],
        "segments": segment_shapes(robot_map),
        "border": [_border(robot_map)],
    }
    return {name: content for name, content in layers.items() if content}


def column_value(value: Any) -> Any:
    """Return an attribute as a column holds it: mappings and lists become JSON."""
    return json.dumps(value, ensure_ascii=False) if isinstance(value, (dict, list)) else value


def write_geopackage(
    robot_map: RobotMap, target: Path, crs: str | None = None, to_crs: ToCrs | None = None
) -> None:
    """Write the layers obstacle_areas, obstacle_lines, segments and border to the new file ``target``.

    The attributes are those of :mod:`.geometries`; ``ext`` and ``courtyards`` are JSON. Without ``crs`` the
    layers hold metres in the site frame, and their CRS is not defined. Version 1.3 of the format, which GDAL
    3.6 and older read. Raises MissingExportPackageError without pyogrio and ExportError when the file cannot
    be written; nothing is left behind.
    """
    _check_pyogrio()
    if target.exists():
        raise ExportError(f"{target} is there already: remove it, or choose another name")
    try:
        for name, shapes in geopackage_layers(robot_map).items():
            geometry = np.empty(len(shapes), dtype=object)
            geometry[:] = [wkb_of(shape, to_crs) for shape in shapes]
            names = shapes[0].attributes
            columns = {one: _column([shape.attributes[one] for shape in shapes]) for one in names}
            write_geopackage_layer(target, name, shapes[0].kind, geometry, columns, crs)
    except OSError as error:
        with suppress(OSError):
            target.unlink()
        raise ExportError(
            f"{target} cannot be written: {error}. Check the folder's rights and free space."
        ) from error


def _border(robot_map: RobotMap) -> MapShape:
    x_min, y_min, x_max, y_max = robot_map.border
    ring = np.array([(x_min, y_min), (x_max, y_min), (x_max, y_max), (x_min, y_max), (x_min, y_min)])
    attributes = {
        "area_m2": robot_map.border.area,
        "obstacles": len(robot_map.obstacles),
        "segments": robot_map.segment_count,
        "meta": dict(robot_map.meta),
    }
    return MapShape("Polygon", (ring,), attributes)


def _column(values: list[Any]) -> np.ndarray[Any, Any]:
    plain = [column_value(value) for value in values]
    return np.array(plain, dtype=object if isinstance(plain[0], str) else type(plain[0]))


def wkb_of(shape: MapShape, to_crs: ToCrs | None) -> bytes:
    """Return the geometry of a shape as well-known binary, in the site frame's metres or in its CRS."""
    parts = [part if to_crs is None else to_crs(part) for part in shape.parts]
    kind = _WKB_KIND[shape.kind]
    if shape.kind == "LineString":
        return struct.pack("<BI", 1, kind) + _points(parts[0])
    head = struct.pack("<BII", 1, kind, len(parts))
    if shape.kind == "Polygon":
        return head + b"".join(_points(part) for part in parts)
    line = struct.pack("<BI", 1, _WKB_KIND["LineString"])
    return head + b"".join(line + _points(part) for part in parts)


def _points(points: Points) -> bytes:
    return struct.pack("<I", len(points)) + np.asarray(points, dtype="<f8").tobytes()


def _check_pyogrio() -> None:
    try:
        import pyogrio  # noqa: F401 - only checks whether it is installed
    except ImportError:
        raise MissingExportPackageError(
            "GeoPackage needs the Python package pyogrio, which is not installed here; install it "
            f"{installation('pyogrio')}, or choose GeoJSON"
        ) from None
