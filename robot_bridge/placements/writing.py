"""Placed cones into a file: CSV, or a GeoPackage for GIS.

Layers of the GeoPackage, in the site's CRS: ``placed`` and ``planned`` (points), ``deviations`` (lines from
the plan to the cone).
"""

from __future__ import annotations

import csv
import struct
import tempfile
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from ..errors import BridgeError
from ..sites.frame import SiteFrame
from ..sites.projections import projections
from .table import NAMES, TEXTS, TIMES, Row

_UTC = 100
"""GDAL's code for UTC in a field of date and time."""
_LAYERS: dict[str, tuple[str, Callable[[Row], bytes]]] = {
    "placed": ("Point", lambda row: _point(row["easting"], row["northing"])),
    "planned": ("Point", lambda row: _point(row["planned_easting"], row["planned_northing"])),
    "deviations": ("LineString", lambda row: _line(row)),
}


def write(found: Sequence[Row], frame: SiteFrame, file: Path) -> None:
    """Write ``file``, whole or not at all; its suffix, ``.csv`` or ``.gpkg``, says as what.

    :raises BridgeError: when it cannot be written.
    """
    as_file = {".csv": _write_csv, ".gpkg": _write_geopackage}[file.suffix.lower()]
    try:
        # A folder beside the file, so that the finished one is put into its place at once.
        with tempfile.TemporaryDirectory(prefix=".exporting-", dir=file.parent) as folder:
            partial = Path(folder) / file.name
            as_file(found, frame, partial)
            partial.replace(file)
    except OSError as error:
        raise BridgeError(f"{file} cannot be written: {error.strerror or error}; check its folder") from error


def _write_csv(found: Sequence[Row], _frame: SiteFrame, file: Path) -> None:
    with file.open("w", newline="", encoding="utf-8") as text:
        writer = csv.DictWriter(text, NAMES)
        writer.writeheader()
        writer.writerows({name: _text(row[name]) for name in NAMES} for row in found)


def _text(value: Any) -> Any:
    if value is None:
        return ""
    if isinstance(value, float):
        return f"{value:.3f}"
    return value if isinstance(value, (int, str)) else value.isoformat(timespec="milliseconds")


def _write_geopackage(found: Sequence[Row], frame: SiteFrame, file: Path) -> None:
    projections()  # before pyogrio imports pyproj aloud
    import pyogrio

    columns = {name: _column(found, name) for name in NAMES}
    times = [name for name, values in columns.items() if values.dtype.kind == "M"]
    for layer, (kind, blob) in _LAYERS.items():
        geometry = np.empty(len(found), dtype=object)
        geometry[:] = [blob(row) for row in found]
        try:
            pyogrio.raw.write(
                str(file),
                geometry=geometry,
                field_data=list(columns.values()),
                fields=list(columns),
                layer=layer,
                driver="GPKG",
                geometry_type=kind,
                crs=frame.crs,
                append=file.exists(),
                dataset_options={"VERSION": "1.3"},
                gdal_tz_offsets={name: np.full(len(found), _UTC) for name in times},
            )
        except (pyogrio.errors.DataSourceError, pyogrio.errors.DataLayerError) as error:
            raise BridgeError(
                f"{file} cannot be written: {error}; check the folder and free space"
            ) from error


def _column(found: Sequence[Row], name: str) -> Any:
    values = [row[name] for row in found]
    if name in TIMES:
        at = [
            np.datetime64("NaT") if v is None else np.datetime64(v.replace(tzinfo=None), "ms") for v in values
        ]
        return np.array(at, dtype="datetime64[ms]")
    if name in TEXTS:
        return np.array(values, dtype=object)
    return np.array(values, dtype=np.int64 if name == "placement" else np.float64)


def _point(x: float, y: float) -> bytes:
    return struct.pack("<BI2d", 1, 1, x, y)


def _line(row: Row) -> bytes:
    ends = (row["planned_easting"], row["planned_northing"], row["easting"], row["northing"])
    return struct.pack("<BII4d", 1, 2, 2, *ends)
