"""Site frame: the metres that robots use, as a place in a projected CRS; access to pyproj."""

from __future__ import annotations

import functools
import math
import warnings
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from ..errors import CrsError

# --- The way to pyproj, which is imported only when a CRS has to be understood ---


def projections() -> Any:
    """Return the module ``pyproj``.

    A distribution's pyproj seen from a virtual environment looks for its database under the environment's
    prefix and warns; PROJ itself then finds it where the distribution put it, so the warning is kept quiet.

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


# --- The site frame: the metres that robots speak, as a place in a projected CRS ---

Points = npt.NDArray[np.float64]


@dataclass(frozen=True)
class SiteFrame:
    """A projected CRS, an origin in it and a rotation (design, section 4).

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
        # Most sites are not turned at all.
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

    EPSG:3857 is refused: its metres are stretched by 1/cos(latitude) (design, section 4).
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
