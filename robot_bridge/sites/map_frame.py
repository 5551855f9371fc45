"""Where a robot map lies on the earth, from its leading lines."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping

import numpy as np

from .errors import CrsError
from .frame import Points, SiteFrame
from .projections import crs_of, projections

_UNPLACED = "write the map with its leading lines (not strict), or choose a format in the site's own metres"


def frame_of_map(meta: Mapping[str, str]) -> SiteFrame | None:
    """Return the frame that the lines crs, origin and rotation of a map give; None when it names no CRS.

    :raises CrsError: naming a line that is not what it must be.
    """
    crs = meta.get("crs", "").strip()
    if not crs:
        return None
    origin = _numbers(meta, "origin", "0,0", 2)
    (rotation,) = _numbers(meta, "rotation", "0", 1)
    return SiteFrame(crs, (origin[0], origin[1]), rotation)


def lonlat_of(frame: SiteFrame | None) -> Callable[[Points], Points]:
    """Return the way from (n, 2) metres in the site frame to (n, 2) longitudes and latitudes (WGS 84).

    :raises CrsError: when there is no frame, or PROJ does not know its CRS or where on the earth it is.
    """
    if frame is None:
        raise CrsError(f"The map does not say where on the earth it is: it has no line crs; {_UNPLACED}.")
    pyproj = projections()
    try:
        transformer = pyproj.Transformer.from_crs(crs_of(frame.crs), 4326, always_xy=True)
    except pyproj.exceptions.ProjError as error:
        raise CrsError(
            f"The map's CRS {frame.crs} has no known place on the earth ({error}); {_UNPLACED}."
        ) from error

    def to_lonlat(xy: Points) -> Points:
        return np.column_stack(transformer.transform(*frame.to_crs(xy).T))

    return to_lonlat


def _numbers(meta: Mapping[str, str], key: str, default: str, count: int) -> list[float]:
    text = meta.get(key, default)
    try:
        numbers = [float(part) for part in text.split(",")]
    except ValueError:
        numbers = []
    if len(numbers) != count or not all(math.isfinite(number) for number in numbers):
        wanted = "'x,y' in metres" if count == 2 else "an angle in radians"
        raise CrsError(
            f"The map's line {key} is {text!r}: it must be {wanted}; correct it, or remove the line crs."
        )
    return numbers
