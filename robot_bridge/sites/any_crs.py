"""From coordinates in any CRS to the site frame, many at once."""

from __future__ import annotations

import threading
from collections import OrderedDict
from typing import Any

import numpy as np

from .errors import CrsError
from .frame import Points, SiteFrame
from .projections import crs_of, projections

_KEPT = 16
"""Ways from a CRS to the site that are kept: each costs a few hundredths of a second to find."""


class AnyCrs:
    """Where coordinates lie in a site frame, from whatever CRS; any thread may ask."""

    def __init__(self, frame: SiteFrame) -> None:
        self._frame = frame
        self._ways: OrderedDict[str, Any] = OrderedDict()
        self._lock = threading.Lock()

    def to_site(self, xy: Any, crs: str) -> Points:
        """Return ``xy``, (n, 2) coordinates in ``crs`` with x before y, as (n, 2) metres in the site frame.

        :raises CrsError: when PROJ does not know ``crs``, or a point of it has no place in the site's CRS.
        """
        points = np.asarray(xy, dtype=np.float64).reshape(-1, 2)
        easting, northing = self._way(crs).transform(points[:, 0], points[:, 1])
        moved = np.column_stack([easting, northing])
        finite = np.isfinite(moved).all(axis=1)
        if not finite.all():
            k = int(np.argmin(finite))
            x, y = points[k].tolist()
            raise CrsError(
                f"points[{k}], ({x:.10g}, {y:.10g}) in {crs}, has no place in the site's CRS "
                f"{self._frame.crs}: check the order, x (longitude, easting) before y, and the CRS."
            )
        return self._frame.to_site(moved)

    def _way(self, crs: str) -> Any:
        with self._lock:
            way = self._ways.pop(crs, None) or self._found(crs)
            self._ways[crs] = way
            if len(self._ways) > _KEPT:
                self._ways.popitem(last=False)
            return way

    def _found(self, crs: str) -> Any:
        pyproj = projections()
        try:
            return pyproj.Transformer.from_crs(crs_of(crs), crs_of(self._frame.crs), always_xy=True)
        except pyproj.exceptions.ProjError as error:
            raise CrsError(
                f"There is no known way from {crs} to the site's CRS {self._frame.crs} ({error})."
            ) from error
