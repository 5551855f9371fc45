"""The site as the field page draws it: areas and lines on the earth, and where robots are there."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator, Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...core.sites.frame import Points, SiteFrame
from ...core.sites.settings import SiteBounds
from ...core.sites.site import Site
from ...core.sites.transforms import lonlat_of

MOST_POINTS = 60_000
"""points of all that is drawn: some 300 kB on their way to a phone."""
DIGITS = 7
"""decimals of a degree: a centimetre."""
BESIDE = 0.25
"""of the site's size on each side, within which robots are placed as well as on it."""
METRES_PER_DEGREE = 111_320.0
_GRID = 13
_POWERS = [(i, j) for i in range(4) for j in range(4 - i)]
"""Exponents of x and y in the terms of a cubic polynomial."""


class EarthPolynomial(NamedTuple):
    """Longitude and latitude (WGS 84, degrees) as cubic polynomials of a place in the site frame.

    With u = (x - centre[0]) / scale and v likewise, ``lon`` and ``lat`` are the coefficients of u**i * v**j
    for (i, j) = (0, 0), (0, 1), (0, 2), (0, 3), (1, 0) … (3, 0). ``within_m`` is the largest error in metres
    at places between those that the polynomials were fitted to.
    """

    centre: tuple[float, float]
    scale: float
    lon: list[float]
    lat: list[float]
    within_m: float


def earth_polynomial(frame: SiteFrame, bounds: SiteBounds) -> EarthPolynomial:
    """Return the way of places on and beside the site to the earth, as a browser computes it.

    :raises CrsError: when the site's CRS has no known place on the earth.
    """
    to_lonlat = lonlat_of(frame)
    centre = ((bounds.x_min + bounds.x_max) / 2, (bounds.y_min + bounds.y_max) / 2)
    half = np.array([bounds.x_max - bounds.x_min, bounds.y_max - bounds.y_min]) / 2 * (1 + 2 * BESIDE)
    scale = float(half.max())
    fitted = _grid(np.linspace(-1, 1, _GRID)) * half / scale
    degrees = to_lonlat(fitted * scale + centre)
    coefficients = np.linalg.lstsq(_terms(fitted), degrees, rcond=None)[0]
    between = _grid(np.linspace(-1, 1, 2 * _GRID)) * half / scale
    error = _metres(
        _terms(between) @ coefficients - to_lonlat(between * scale + centre), degrees[:, 1].mean()
    )
    return EarthPolynomial(
        centre, scale, coefficients[:, 0].tolist(), coefficients[:, 1].tolist(), float(error.max())
    )


def site_outline(site: Site) -> dict[str, Any]:
    """Return what the field page is told of ``site`` as values of JSON; all places as [lon, lat] in degrees.

    Keepouts come first, then roads, surfaces and the obstacles' outlines; what goes beyond MOST_POINTS is
    left out, and named in ``left_out``.

    :raises CrsError: when the site's CRS has no known place on the earth.
    """
    to_lonlat = lonlat_of(site.frame)
    budget = _Budget(MOST_POINTS)

    def degrees(points: Points) -> list[list[float]]:
        rounded: list[list[float]] = np.round(to_lonlat(points), DIGITS).tolist()
        return rounded

    return {
        "id": site.id,
        "name": site.name,
        "version": site.version,
        "bounds": degrees(_rim(site.bounds)),
        "to_earth": earth_polynomial(site.frame, site.bounds)._asdict(),
        "keepouts": [
            {"name": area.label, "rings": [degrees(ring) for ring in area.rings]}
            for area in site.keepouts
            if budget.holds("keepouts", area.rings)
        ],
        "roads": [degrees(line.points) for line in site.centrelines if budget.holds("roads", [line.points])],
        "surfaces": [
            {"class": area.label, "rings": [degrees(ring) for ring in area.rings]}
            for area in site.surfaces
            if budget.holds("surfaces", area.rings)
        ],
        "obstacles": [degrees(points) for points in _obstacles(site) if budget.holds("obstacles", [points])],
        "left_out": budget.left_out,
    }


class _Budget:
    """Points that may still be drawn."""

    def __init__(self, points: int) -> None:
        self._left = points
        self.left_out: list[str] = []
        """The kinds of which something was left out."""

    def holds(self, kind: str, lines: Sequence[Points]) -> bool:
        """Count ``lines`` and return whether they and all before are few enough."""
        self._left -= sum(map(len, lines))
        if self._left < 0 and kind not in self.left_out:
            self.left_out.append(kind)
        return self._left >= 0


def _obstacles(site: Site) -> Iterator[Points]:
    offsets = site.outlines.offsets
    if offsets[-1] > MOST_POINTS:
        # A city: robots are placed by its roads, and reading all of its outlines would take seconds.
        yield np.empty((MOST_POINTS + 1, 2))
        return
    for begin, end in itertools.pairwise(offsets):
        yield site.outlines.coordinates[begin:end]


def _rim(bounds: SiteBounds) -> Points:
    x_min, y_min, x_max, y_max = bounds
    return np.array([[x_min, y_min], [x_max, y_min], [x_max, y_max], [x_min, y_max], [x_min, y_min]])


def _grid(steps: NDArray[np.float64]) -> Points:
    across, along = np.meshgrid(steps, steps)
    return np.column_stack([across.ravel(), along.ravel()])


def _terms(places: Points) -> NDArray[np.float64]:
    return np.column_stack([places[:, 0] ** i * places[:, 1] ** j for i, j in _POWERS])


def _metres(degrees: Points, latitude: float) -> NDArray[np.float64]:
    east = degrees[:, 0] * math.cos(math.radians(latitude))
    return np.asarray(np.hypot(east, degrees[:, 1]) * METRES_PER_DEGREE, dtype=np.float64)
