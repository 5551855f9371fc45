"""Frames of robots: from their coordinates to metres in the site frame, and back."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import msgspec
import numpy as np
import numpy.typing as npt

from ...core.errors import CrsError, SiteError
from ...core.sites.frame import SiteFrame, crs_of, projections, utm_zone_of
from .errors import LinkError

Points = npt.NDArray[np.float64]

SITE, UTM, WGS84 = "site", "utm", "wgs84"
_STEP = 10.0
"""metres ahead to the point by which a heading is transformed."""


class FrameSettings(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """Table ``[frame]``: the coordinates of the link's robots.

    ``crs`` is ``site`` (metres in the site frame), ``utm`` (the zone of the site), ``wgs84`` (longitude
    before latitude, degrees) or a code such as ``EPSG:32633``. The robots' (0, 0) is at ``origin`` in that
    CRS, and their x axis ``rotation_deg`` counter-clockwise from its x axis. With ``pairs``, each ``[x, y,
    crs_x, crs_y]``, both are found by least squares, and with ``scale`` the scale too; a pair may then be off
    by ``largest_residual_m``.
    """

    crs: str = SITE
    origin: tuple[float, float] = (0.0, 0.0)
    rotation_deg: float = 0.0
    pairs: list[tuple[float, float, float, float]] | None = None
    scale: bool = False
    largest_residual_m: float = 1.0

    def check_metres(self, where: str) -> None:
        """Raise LinkError for coordinates in degrees, which robots with targets do not use.

        ``where`` is file and key.
        """
        try:
            in_degrees = self.crs == WGS84 or (self.crs not in (SITE, UTM) and crs_of(self.crs).is_geographic)
        except CrsError as error:
            raise LinkError(f"{where}.crs: {error}") from None
        if in_degrees:
            raise LinkError(
                f"{where}.crs = {self.crs!r}: these robots are sent metres, and it is in degrees; write "
                "'site', 'utm', or a projected CRS such as 'EPSG:32633'"
            )


@dataclass(frozen=True)
class Similarity:
    """A shift, a rotation (radians, counter-clockwise) and a scale: from robots' metres to those of a CRS."""

    shift: tuple[float, float] = (0.0, 0.0)
    rotation: float = 0.0
    scale: float = 1.0

    def forward(self, x: float, y: float) -> tuple[float, float]:
        """Return (x, y) of a robot in the CRS."""
        c, s = self.scale * math.cos(self.rotation), self.scale * math.sin(self.rotation)
        return self.shift[0] + c * x - s * y, self.shift[1] + s * x + c * y

    def back(self, x: float, y: float) -> tuple[float, float]:
        """Return (x, y) of the CRS as a robot's."""
        dx, dy = x - self.shift[0], y - self.shift[1]
        c, s = math.cos(self.rotation) / self.scale, math.sin(self.rotation) / self.scale
        return c * dx + s * dy, c * dy - s * dx


@dataclass(frozen=True)
class Fit:
    """A similarity found by least squares, with the residual of each pair in metres."""

    similarity: Similarity
    residuals: tuple[float, ...]

    @property
    def rms(self) -> float:
        """The root mean square of the residuals."""
        return math.sqrt(sum(r * r for r in self.residuals) / len(self.residuals))

    @property
    def text(self) -> str:
        """The result as text for people."""
        worst = max(range(len(self.residuals)), key=self.residuals.__getitem__)
        turned = math.degrees(self.similarity.rotation)
        return (
            f"frame fitted to {len(self.residuals)} pairs: rotation {turned:.3f}°, scale "
            f"{self.similarity.scale:.5f}; residual {self.rms:.3f} m rms, "
            f"{self.residuals[worst]:.3f} m at pairs[{worst}]"
        )


def fit(own: Points, there: Points, *, scale: bool = False) -> Fit:
    """Return the similarity that maps ``own`` closest to ``there``, both (n, 2) metres.

    S. Umeyama, Least-squares estimation of transformation parameters between two point patterns, IEEE PAMI 13
    (1991), in the plane.

    :raises ValueError: for fewer than two points, or points that all coincide.
    """
    if len(own) < 2:
        raise ValueError("give two pairs or more")
    middle, its = own.mean(axis=0), there.mean(axis=0)
    a, b = own - middle, there - its
    size = float((a * a).sum())
    if size < 1e-6 or float((b * b).sum()) < 1e-6:
        raise ValueError("all points are in one place; take pairs that are far apart")
    dot, cross = float((a * b).sum()), float((a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]).sum())
    rotation = math.atan2(cross, dot)
    factor = math.hypot(dot, cross) / size if scale else 1.0
    turned = Similarity((0.0, 0.0), rotation, factor).forward(*middle.tolist())
    found = Similarity((float(its[0]) - turned[0], float(its[1]) - turned[1]), rotation, factor)
    residuals = tuple(
        math.dist(found.forward(*p), q) for p, q in zip(own.tolist(), there.tolist(), strict=True)
    )
    return Fit(found, residuals)


class LinkFrame:
    """The frame of a link's robots on one site. Headings are radians counter-clockwise from the x axis.

    In ``wgs84`` a position is (longitude, latitude) and a heading is counter-clockwise from east.

    :raises LinkError: for invalid settings, naming the key; ``where`` is their file.
    """

    def __init__(self, settings: FrameSettings, site: SiteFrame, where: str = "[frame]") -> None:
        self._settings = settings
        self._site = site
        self._where = where
        self.fit: Fit | None = None
        self._is_site = settings.crs == SITE
        self._is_earth = settings.crs == WGS84
        try:
            self._crs = site.crs if self._is_site else self._code(settings)
            if crs_of(self._crs).is_geographic and not self._is_earth:
                raise CrsError(f"{self._crs} is in degrees; write 'wgs84', or a projected CRS")
            self._own = self._similarity()
        except (SiteError, ValueError) as error:
            raise LinkError(f"{where}: frame.{self._key(error)}: {error}") from None
        if self._is_earth and (settings.origin != (0.0, 0.0) or settings.rotation_deg):
            raise LinkError(f"{where}: frame.origin and frame.rotation_deg mean nothing with crs = 'wgs84'")

    def to_site(self, x: float, y: float) -> tuple[float, float]:
        """Return the site's (x, y) of a robot's; raises ValueError if it has none."""
        there = self._own.forward(x, y)
        if self._is_site:
            return there
        east, north = self._ways[0].transform(*there)
        if not (math.isfinite(east) and math.isfinite(north)):
            raise ValueError(f"({x:.10g}, {y:.10g}) has no place in the site's CRS {self._site.crs}")
        ((site_x, site_y),) = self._site.to_site([(east, north)]).tolist()
        return site_x, site_y

    def from_site(self, x: float, y: float) -> tuple[float, float]:
        """Return a robot's (x, y) of the site's; raises ValueError if it has none."""
        if self._is_site:
            return self._own.back(x, y)
        ((east, north),) = self._site.to_crs([(x, y)]).tolist()
        there = self._ways[1].transform(east, north)
        if not all(map(math.isfinite, there)):
            raise ValueError(f"({x:.10g}, {y:.10g}) of the site has no place in {self._crs}")
        return self._own.back(*there)

    def pose_to_site(self, x: float, y: float, theta: float) -> tuple[float, float, float]:
        """Return the site's (x, y, theta) of a robot's pose, theta in [-π, π]."""
        site_x, site_y = self.to_site(x, y)
        if self._is_site:
            return site_x, site_y, math.remainder(theta + self._own.rotation, math.tau)
        ahead_x, ahead_y = self.to_site(*self._ahead(x, y, theta))
        return site_x, site_y, math.atan2(ahead_y - site_y, ahead_x - site_x)

    def pose_from_site(self, x: float, y: float, theta: float) -> tuple[float, float, float]:
        """Return a robot's (x, y, theta) of a pose in the site frame, theta in [-π, π]."""
        own_x, own_y = self.from_site(x, y)
        if self._is_site:
            return own_x, own_y, math.remainder(theta - self._own.rotation, math.tau)
        ahead = x + _STEP * math.cos(theta), y + _STEP * math.sin(theta)
        ahead_x, ahead_y = self.from_site(*ahead)
        if self._is_earth:
            bearing, _, _ = self._ellipsoid.inv(own_x, own_y, ahead_x, ahead_y)
            return own_x, own_y, math.remainder(math.pi / 2 - math.radians(bearing), math.tau)
        return own_x, own_y, math.atan2(ahead_y - own_y, ahead_x - own_x)

    def _ahead(self, x: float, y: float, theta: float) -> tuple[float, float]:
        if self._is_earth:
            lon, lat, _ = self._ellipsoid.fwd(x, y, 90.0 - math.degrees(theta), _STEP)
            return lon, lat
        return x + _STEP * math.cos(theta), y + _STEP * math.sin(theta)

    def _code(self, settings: FrameSettings) -> str:
        if self._is_earth:
            return "EPSG:4326"
        if settings.crs == UTM:
            to_earth = projections().Transformer.from_crs(crs_of(self._site.crs), 4326, always_xy=True)
            return utm_zone_of(*to_earth.transform(*self._site.origin))
        return settings.crs

    def _similarity(self) -> Similarity:
        settings = self._settings
        if not all(map(math.isfinite, (*settings.origin, settings.rotation_deg))):
            raise ValueError("origin and rotation_deg are finite numbers")
        if settings.pairs is None:
            return Similarity(settings.origin, math.radians(settings.rotation_deg))
        if self._is_earth:
            raise ValueError("pairs are fitted on a plane; give the second half of each in crs = 'utm'")
        pairs = np.asarray(settings.pairs, dtype=np.float64).reshape(-1, 4)
        if not np.isfinite(pairs).all():
            raise ValueError("pairs holds what is no finite number")
        self.fit = fit(pairs[:, :2], pairs[:, 2:], scale=settings.scale)
        if max(self.fit.residuals) > settings.largest_residual_m:
            raise ValueError(
                f"pairs: {self.fit.text}, more than largest_residual_m = {settings.largest_residual_m:g}; "
                "correct that pair"
            )
        return self.fit.similarity

    def _key(self, error: Exception) -> str:
        return "pairs" if self._settings.pairs is not None and isinstance(error, ValueError) else "crs"

    @cached_property
    def _ways(self) -> tuple[Any, Any]:
        make = projections().Transformer.from_crs
        own, site = crs_of(self._crs), crs_of(self._site.crs)
        return make(own, site, always_xy=True), make(site, own, always_xy=True)

    @cached_property
    def _ellipsoid(self) -> Any:
        return projections().Geod(ellps="WGS84")
