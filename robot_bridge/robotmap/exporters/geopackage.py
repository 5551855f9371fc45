"""A robot map as a GeoPackage."""

from __future__ import annotations

import json
import struct
import warnings
from collections.abc import Callable, Sequence
from contextlib import suppress
from pathlib import Path
from typing import Any

import numpy as np

from ...missing_packages import installation
from ..model import RobotMap
from .errors import ExportError, MissingPackageError
from .lines import Points
from .shapes import Shape, obstacle_shapes, segment_shapes

ToCrs = Callable[[Points], Points]
"""From (n, 2) metres in the site frame to (n, 2) metres in its CRS."""

_WKB_KIND = {"LineString": 2, "Polygon": 3, "MultiLineString": 5}


def geopackage_layers(robot_map: RobotMap) -> dict[str, list[Shape]]:
    """Return the shapes of each layer that has any; in a layer all have one kind and the same attributes."""
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

    The attributes are those of :mod:`.shapes`; ``ext`` and ``courtyards`` are JSON. Without ``crs`` the
    layers hold metres in the site frame, and their CRS is not defined. Version 1.3 of the format, which GDAL
    3.6 and older read. Raises MissingPackageError without pyogrio and ExportError when the file cannot be
    written; nothing is left behind.
    """
    pyogrio = _pyogrio()
    if target.exists():
        raise ExportError(f"{target} is there already: remove it, or choose another name")
    try:
        for name, shapes in geopackage_layers(robot_map).items():
            _write_layer(pyogrio, target, name, shapes, crs, to_crs)
    except (pyogrio.errors.DataSourceError, pyogrio.errors.DataLayerError, OSError) as error:
        with suppress(OSError):
            target.unlink()
        raise ExportError(
            f"{target} cannot be written: {error}. Check the folder's rights and free space."
        ) from error


def _write_layer(
    pyogrio: Any,
    target: Path,
    name: str,
    shapes: Sequence[Shape],
    crs: str | None,
    to_crs: ToCrs | None,
) -> None:
    columns = list(shapes[0].attributes)
    geometry = np.empty(len(shapes), dtype=object)
    geometry[:] = [wkb_of(shape, to_crs) for shape in shapes]
    with warnings.catch_warnings():
        # A map without a CRS is what it is.
        warnings.filterwarnings("ignore", message="'crs' was not provided")
        pyogrio.raw.write(
            str(target),
            geometry=geometry,
            field_data=[_column([shape.attributes[column] for shape in shapes]) for column in columns],
            fields=columns,
            layer=name,
            driver="GPKG",
            geometry_type=shapes[0].kind,
            crs=crs,
            append=target.exists(),
            dataset_options={"VERSION": "1.3"},
        )


def _border(robot_map: RobotMap) -> Shape:
    x_min, y_min, x_max, y_max = robot_map.border
    ring = np.array([(x_min, y_min), (x_max, y_min), (x_max, y_max), (x_min, y_max), (x_min, y_min)])
    attributes = {
        "area_m2": robot_map.border.area,
        "obstacles": len(robot_map.obstacles),
        "segments": robot_map.segment_count,
        "meta": dict(robot_map.meta),
    }
    return Shape("Polygon", (ring,), attributes)


def _column(values: list[Any]) -> np.ndarray[Any, Any]:
    plain = [column_value(value) for value in values]
    return np.array(plain, dtype=object if isinstance(plain[0], str) else type(plain[0]))


def wkb_of(shape: Shape, to_crs: ToCrs | None) -> bytes:
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


def _pyogrio() -> Any:
    try:
        import pyogrio
    except ImportError:
        raise MissingPackageError(
            "GeoPackage needs the Python package pyogrio, which is not installed here; install it "
            f"{installation('pyogrio')}, or choose GeoJSON"
        ) from None
    return pyogrio
