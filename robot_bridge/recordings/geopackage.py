"""Positions out of a GeoPackage that ``robot-bridge trajectories export`` wrote, in its own CRS."""

from __future__ import annotations

import math
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

from ..sites.errors import CrsError
from ..sites.projections import crs_of, projections
from .errors import RecordingError
from .samples import LATEST, SPEED_BOUNDS, Remarks, Sample, Source, ValueRefusedError, place_bounds

LAYER = "positions"
FIELDS = ("robot", "time", "heading", "v")
PAGE = 20_000
"""positions read at once."""
_POINT = np.dtype([("order", "u1"), ("kind", "<u4"), ("x", "<f8"), ("y", "<f8")])


def read_geopackage(file: Path, remarks: Remarks) -> Source:
    """Return the positions in layer ``positions``; those that cannot be used are noted in ``remarks``.

    :raises RecordingError: for a file that is not such a GeoPackage.
    """
    projections()  # before pyogrio imports pyproj aloud
    import pyogrio

    try:
        found = pyogrio.read_info(str(file), layer=LAYER)
    except (pyogrio.errors.DataSourceError, pyogrio.errors.DataLayerError) as error:
        raise RecordingError(
            f"{file} holds no layer {LAYER}, as 'robot-bridge trajectories export' writes it: {error}"
        ) from None
    missing = [name for name in FIELDS if name not in found["fields"]]
    if missing:
        raise RecordingError(f"{file}: layer {LAYER} has no column {missing[0]}")
    return Source(_crs(file, found["crs"]), _samples(file, remarks))


def _crs(file: Path, crs: str | None) -> str:
    try:
        if crs is not None and not crs_of(crs).is_geographic:
            return crs
    except CrsError as error:
        raise RecordingError(f"{file}: layer {LAYER}: {error}") from None
    raise RecordingError(f"{file}: layer {LAYER} has the CRS {crs}; one in metres is needed")


def _samples(file: Path, remarks: Remarks) -> Iterator[Sample]:
    import pyogrio

    first = 0
    while True:
        try:
            _, fids, points, columns = pyogrio.raw.read(
                str(file),
                layer=LAYER,
                columns=list(FIELDS),
                skip_features=first,
                max_features=PAGE,
                return_fids=True,
            )
        except (pyogrio.errors.DataSourceError, pyogrio.errors.DataLayerError, ValueError) as error:
            remarks.add(f"{file}: behind row {first}", f"nothing can be read any more: {error}")
            return
        for row in zip(fids.tolist(), points, *columns, strict=True):
            try:
                yield _sample(*row)
            except ValueRefusedError as error:
                remarks.add(f"{file}: row {row[0]}", str(error))
        if len(fids) < PAGE:
            return
        first += PAGE


def _sample(fid: int, point: bytes | None, robot: Any, time: Any, heading: Any, v: Any) -> Sample:
    if point is None or len(point) < _POINT.itemsize or point[0] != 1:
        raise ValueRefusedError("geom", "there is no point")
    place = np.frombuffer(point, dtype=_POINT, count=1)[0]
    if not isinstance(robot, str) or not robot:
        raise ValueRefusedError("robot", "there is no name")
    bounds, _ = place_bounds(is_earth=False)
    return Sample(
        fid,
        robot,
        _seconds(time),
        _finite(place["x"], "geom x", bounds),
        _finite(place["y"], "geom y", bounds),
        math.remainder(math.radians(90.0 - _finite(heading, "heading", (-360.0, 360.0))), math.tau),
        _finite(v, "v", SPEED_BOUNDS),
    )


def _seconds(time: Any) -> float:
    at = np.datetime64(time, "ms").astype(np.int64).item() / 1000.0
    if not -LATEST <= at <= LATEST:
        raise ValueRefusedError("time", f"{time} is no time")
    return at


def _finite(value: Any, column: str, bounds: tuple[float, float]) -> float:
    number = float(value)
    if not bounds[0] <= number <= bounds[1]:
        raise ValueRefusedError(column, f"{number} is not a number from {bounds[0]:g} to {bounds[1]:g}")
    return number
