"""From the earth to the site: latitude, longitude and compass heading as a robot's GPS gives them."""

from __future__ import annotations

import math
from functools import cached_property
from typing import Any

from .errors import CrsError
from .frame import SiteFrame
from .projections import crs_of, projections
from .settings import Bounds

_STEP = 10.0
"""metres ahead at which it is looked where a heading leads; short against the curvature of any projection."""


NEAR = 10_000.0
"""metres beside a site within which its robots may come from; swapped coordinates lie much farther off."""


def is_near(place: tuple[float, float], bounds: Bounds) -> bool:
    """Tell whether (x, y), metres in the site frame, is on the site or beside it."""
    x, y = place
    beside = bounds.x_min - x, x - bounds.x_max, bounds.y_min - y, y - bounds.y_max
    return max(beside) <= NEAR


class Earth:
    """Where WGS 84 positions lie in a site frame."""

    def __init__(self, frame: SiteFrame) -> None:
        self._frame = frame

    def place(self, lat: float, lon: float) -> tuple[float, float]:
        """Return (x, y), metres in the site frame, of a position in degrees.

        :raises CrsError: when the site's CRS has no place for it, or none on the earth.
        """
        easting, northing = self._to_crs.transform(lon, lat)
        if not (math.isfinite(easting) and math.isfinite(northing)):
            raise CrsError(
                f"latitude {lat:.6f}, longitude {lon:.6f} has no place in the site's CRS {self._frame.crs}; "
                "check the order of the two, and that the robot is near the site."
            )
        ((x, y),) = self._frame.to_site([(easting, northing)]).tolist()
        return x, y

    def looks_swapped(self, lat: float, lon: float, bounds: Bounds) -> bool:
        """Tell whether a position lies near a site's ``bounds`` with latitude and longitude swapped."""
        try:
            return abs(lon) <= 90 and is_near(self.place(lon, lat), bounds)
        except CrsError:
            return False

    def theta(self, lat: float, lon: float, heading: float) -> float:
        """Return a heading, degrees clockwise from true north at that place, as a site theta in (-π, π].

        North of the map is not true north: the difference, the convergence, is a degree or more at the edge
        of a UTM zone.

        :raises CrsError: as :meth:`place`.
        """
        ahead_lon, ahead_lat, _ = self._ellipsoid.fwd(lon, lat, heading, _STEP)
        x, y = self.place(lat, lon)
        ahead_x, ahead_y = self.place(ahead_lat, ahead_lon)
        return math.atan2(ahead_y - y, ahead_x - x)

    @cached_property
    def _to_crs(self) -> Any:
        pyproj = projections()
        try:
            return pyproj.Transformer.from_crs(4326, crs_of(self._frame.crs), always_xy=True)
        except pyproj.exceptions.ProjError as error:
            raise CrsError(
                f"The site's CRS {self._frame.crs} has no known place on the earth ({error}); robots there "
                "cannot be placed by GPS."
            ) from error

    @cached_property
    def _ellipsoid(self) -> Any:
        return projections().Geod(ellps="WGS84")
