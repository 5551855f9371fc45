"""Site frame: the robots' metric frame within a projected CRS; transforms into it; access to pyproj."""

from __future__ import annotations

import functools
import math
import threading
import warnings
from collections import OrderedDict
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from ..errors import CrsError

# --- Access to pyproj, which is imported only when a CRS must be resolved ---


def projections() -> Any:
    """Return the module ``pyproj``.

    A distribution's pyproj seen from a virtual environment looks for its database under the environment's
    prefix and warns; PROJ itself then finds it where the distribution put it, so the warning is suppressed.

    :raises CrsError: when pyproj is not installed.
    """
    with warnings.catch_warnings():
        warnings.filterwarnings("ignore", message="Valid PROJ data directory not found")
        try:
            import pyproj
        except ImportError as error:
            raise CrsError(
                "The Python package pyproj is missing, which is needed to read a CRS: install it with "
                "'python3 -m pip install pyproj' or the distribution's package python3-pyproj."
            ) from error
    return pyproj


@functools.lru_cache(maxsize=32)
def crs_of(crs: str) -> Any:
    """Return the ``pyproj.CRS`` that ``crs`` names; PROJ takes milliseconds for each.

    :raises CrsError: when PROJ does not know it.
    """
    pyproj = projections()
    try:
        return pyproj.CRS.from_user_input(crs)
    except pyproj.exceptions.CRSError as error:
        raise CrsError(
            f"The CRS {crs!r} is not known to PROJ ({error}). Write an authority code such as 'EPSG:32633'."
        ) from error


def utm_zone_of(longitude: float, latitude: float) -> str:
    """Return the WGS 84 UTM zone, such as ``EPSG:32633``, of a position in degrees."""
    zone = math.floor((longitude + 180.0) / 6.0) % 60 + 1
    return f"EPSG:{(32600 if latitude >= 0 else 32700) + zone}"


# --- The site frame: the robots' metric frame within a projected CRS ---

Points = npt.NDArray[np.float64]


class SiteBounds(NamedTuple):
    """The rectangle of the site in the site frame, metres; its edges belong to it."""

    x_min: float
    y_min: float
    x_max: float
    y_max: float

    def contains(self, x: float, y: float) -> bool:
        """Return whether (x, y), metres in the site frame, lies in the rectangle."""
        return self.x_min <= x <= self.x_max and self.y_min <= y <= self.y_max


@dataclass(frozen=True)
class SiteFrame:
    """A projected CRS, an origin in it and a rotation.

    ``origin`` is the site's (0, 0) in CRS metres; ``rotation`` is in radians, counter-clockwise from the
    CRS's x axis to the site's x axis. The axes are scaled 1:1, so a length is the same in both.
    """

    crs: str
    origin: tuple[float, float]
    rotation: float = 0.0

    def to_site(self, xy: Any) -> Points:
        """Return ``xy``, an (n, 2) array of CRS metres, as (n, 2) float64 metres in the site frame."""
        points = _points(xy).copy()
        # Column by column: numpy takes five times as long to add a pair to each row.
        points[:, 0] -= self.origin[0]
        points[:, 1] -= self.origin[1]
        # Most sites are not rotated.
        return points @ self.axes().T if self.rotation else points

    def to_crs(self, xy: Any) -> Points:
        """Return ``xy``, an (n, 2) array of metres in the site frame, as (n, 2) float64 CRS metres."""
        points = _points(xy)
        points = points @ self.axes() if self.rotation else points.copy()
        points[:, 0] += self.origin[0]
        points[:, 1] += self.origin[1]
        return points

    def theta_to_site(self, theta: float) -> float:
        """Return an angle counter-clockwise from the CRS's x axis, in radians, as a site theta in (-π, π]."""
        return math.remainder(theta - self.rotation, math.tau)

    def theta_to_crs(self, theta: float) -> float:
        """Return a site theta, in radians, as an angle from the CRS's x axis in (-π, π]."""
        return math.remainder(theta + self.rotation, math.tau)

    def axes(self) -> Points:
        """Return the site's x and y unit vectors in the CRS as the rows of a (2, 2) array."""
        c, s = math.cos(self.rotation), math.sin(self.rotation)
        return np.array([[c, s], [-s, c]])


def check_site_crs(crs: str) -> None:
    """Raise :class:`CrsError` unless ``crs`` is a projected CRS in true metres, x east and y north.

    EPSG:3857 is refused: its metres are stretched by 1/cos(latitude).
    """
    known = crs_of(crs)
    if known.is_geographic or not known.is_projected:
        raise CrsError(
            f"The CRS {crs} ({known.name}) cannot carry a site: its coordinates are not metres on a plane. "
            f"Choose a projected CRS such as the local UTM zone{_suggestion(known)}."
        )
    if _is_web_mercator(known):
        raise CrsError(
            f"The CRS {crs} ({known.name}) cannot carry a site: its metres are not metres; 1 m on the ground "
            "is 1.56 m there at latitude 50°. Choose the local UTM zone, such as EPSG:32633 for 12°E to 18°E."
        )
    units = {axis.unit_name for axis in known.axis_info}
    if units != {"metre"}:
        raise CrsError(
            f"The CRS {crs} ({known.name}) cannot carry a site: its unit is {', '.join(sorted(units))}, and "
            f"robots speak metres. Choose a CRS in metres such as the local UTM zone{_suggestion(known)}."
        )


def _is_web_mercator(known: Any) -> bool:
    method = known.coordinate_operation.method_name if known.coordinate_operation else ""
    return known.to_epsg() == 3857 or "Pseudo Mercator" in method or method.startswith("Mercator")


def _suggestion(known: Any) -> str:
    """Return ``", EPSG:..."`` for the UTM zone in the middle of the CRS's area when that area is small."""
    area = known.area_of_use
    if area is None or abs(area.east - area.west) > 30.0:
        return " (EPSG:326xx north, EPSG:327xx south of the equator)"
    return f", {utm_zone_of((area.west + area.east) / 2, (area.south + area.north) / 2)}"


def _points(xy: Any) -> Points:
    return np.asarray(xy, dtype=np.float64).reshape(-1, 2)


# --- From coordinates in any CRS to the site frame, many at once ---

_KEPT = 16
"""Cached transforms from a CRS to the site: each takes a few hundredths of a second to create."""


class CrsTransform:
    """Transform of coordinates in any CRS to a site frame; thread-safe."""

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


# --- From the earth to the site: latitude, longitude and compass heading as a robot's GPS gives them ---

_STEP = 10.0
"""metres ahead used to transform a heading; short against the curvature of any projection."""


NEAR = 10_000.0
"""metres beside a site within which its robots may come from; swapped coordinates lie much farther off."""


def is_near(place: tuple[float, float], bounds: SiteBounds) -> bool:
    """Return whether (x, y), metres in the site frame, is on the site or beside it."""
    x, y = place
    beside = bounds.x_min - x, x - bounds.x_max, bounds.y_min - y, y - bounds.y_max
    return max(beside) <= NEAR


class GpsTransform:
    """Transform of WGS 84 positions to a site frame."""

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

    def looks_swapped(self, lat: float, lon: float, bounds: SiteBounds) -> bool:
        """Return whether a position lies near a site's ``bounds`` with latitude and longitude swapped."""
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


# --- Georeference of a robot map, from its leading lines ---

_UNPLACED = "write the map with its leading lines (not strict), or choose a format in the site's own metres"


def frame_of_map(meta: Mapping[str, str]) -> SiteFrame | None:
    """Return the frame that the lines crs, origin and rotation of a map give; None when it names no CRS.

    :raises CrsError: naming an invalid line.
    """
    crs = meta.get("crs", "").strip()
    if not crs:
        return None
    origin = _numbers(meta, "origin", "0,0", 2)
    (rotation,) = _numbers(meta, "rotation", "0", 1)
    return SiteFrame(crs, (origin[0], origin[1]), rotation)


def lonlat_of(frame: SiteFrame | None) -> Callable[[Points], Points]:
    """Return the function from (n, 2) metres in the site frame to (n, 2) longitudes and latitudes (WGS 84).

    :raises CrsError: when there is no frame, or PROJ does not know its CRS or its place on the earth.
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
        expected = "'x,y' in metres" if count == 2 else "an angle in radians"
        raise CrsError(
            f"The map's line {key} is {text!r}: it must be {expected}; correct it, or remove the line crs."
        )
    return numbers
