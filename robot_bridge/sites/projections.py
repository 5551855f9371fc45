"""The way to pyproj, which is imported only when a CRS has to be understood."""

from __future__ import annotations

import math
import warnings
from typing import Any

from .errors import CrsError


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


def crs_of(crs: str) -> Any:
    """Return the ``pyproj.CRS`` that ``crs`` names.

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
