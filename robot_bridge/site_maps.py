"""The site's facts and maps as the fleet sends them: binary, and the whole map made once."""

from __future__ import annotations

from functools import cached_property

from .messages import SiteReport
from .robotmap.binary import encode
from .sites.settings import SiteSettings
from .sites.site import Site


class SiteMaps:
    """Serves a published site to the fleet."""

    def __init__(self, site: Site) -> None:
        self._site = site

    @property
    def settings(self) -> SiteSettings:
        """The settings of the site."""
        return self._site.settings

    @property
    def report(self) -> SiteReport:
        """The facts of the site that operators are told."""
        site, settings = self._site, self._site.settings
        return SiteReport(
            id=site.id,
            name=site.name,
            version=site.version,
            crs=site.frame.crs,
            origin=site.frame.origin,
            rotation=site.frame.rotation,
            bounds=(site.bounds.x_min, site.bounds.y_min, site.bounds.x_max, site.bounds.y_max),
            reached_tolerance=settings.reached_tolerance_m,
            stale_after=settings.liveness.stale_after_s,
            lost_after=settings.liveness.lost_after_s,
        )

    @cached_property
    def _whole_map(self) -> bytes:
        return encode(self._site.whole_map())

    def contains(self, x: float, y: float) -> bool:
        """Tell whether (x, y), metres in the site frame, lies on the site."""
        return self._site.contains(x, y)

    def whole_map(self) -> bytes:
        """Return the map of the whole site in the binary format."""
        return self._whole_map

    def map_around(self, x: float, y: float, area: float) -> bytes:
        """Return the map of a square of ``area`` square metres centred on (x, y) in the binary format."""
        return encode(self._site.map_around(x, y, area))
