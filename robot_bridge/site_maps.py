"""The site's facts and maps as the fleet sends them: binary, and the whole map made once."""

from __future__ import annotations

import threading
from collections.abc import Sequence
from typing import NamedTuple

from .errors import RefusedError
from .messages import ObservationReport, SiteReport
from .observed_objects import ObservedObjects
from .polyline import Track
from .roads.surfaces.index import NOWHERE
from .roads.surfaces.surface import Surface
from .robotmap.binary import encode
from .robotmap.errors import RobotMapError
from .sites.any_crs import AnyCrs
from .sites.earth import Earth, is_near
from .sites.errors import CrsError
from .sites.settings import SiteSettings
from .sites.site import Site


class Drawn(NamedTuple):
    """What maps are made of: read at once, so that no map is half of one publication and half of the next."""

    site: Site
    objects: ObservedObjects


class SiteMaps:
    """Serves a published site to the fleet."""

    def __init__(self, site: Site) -> None:
        self._site = site
        self._earth = Earth(site.frame)
        self._drawn = Drawn(site, ObservedObjects([], site.settings.observations.object_radius_m))
        self._whole_map: tuple[Drawn, bytes] | None = None
        self._making = threading.Lock()
        self._any_crs = AnyCrs(site.frame)
        self._indexing = threading.Lock()

    def take_over(self, site: Site) -> None:
        """Serve ``site`` from now on, another publication with the same frame."""
        self._site = site
        self._drawn = Drawn(site, self._drawn.objects)

    @property
    def site(self) -> Site:
        """The site as it was published last."""
        return self._site

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

    def contains(self, x: float, y: float) -> bool:
        """Tell whether (x, y), metres in the site frame, lies on the site."""
        return self._site.contains(x, y)

    @property
    def has_keepouts(self) -> bool:
        """Tell whether there is any place where nobody may drive."""
        return bool(self._site.keepouts)

    def keepouts_entered(self, tracks: Sequence[Track]) -> dict[int, str]:
        """Return the numbers of those of ``tracks`` that come into a keepout, each with that one's name."""
        site = self._site
        if not site.keepouts:
            return {}
        with self._indexing:
            index = site.keepout_index
        return {track: site.keepouts[area].label for track, area in index.entered(tracks).items()}

    def whole_map(self) -> bytes:
        """Return the map of the whole site in the binary format."""
        # Of a hundred robots that ask at once the first has it made, and the others wait.
        with self._making:
            drawn, made = self._drawn, self._whole_map
            if made is None or made[0] is not drawn:
                made = self._whole_map = (drawn, encode(drawn.objects.join(drawn.site.whole_map())))
            return made[1]

    def map_around(self, x: float, y: float, area: float) -> bytes:
        """Return the map of a square of ``area`` square metres centred on (x, y) in the binary format.

        :raises RefusedError: when that square is none, being smaller than a map is exact.
        """
        drawn = self._drawn
        try:
            return encode(drawn.objects.join(drawn.site.map_around(x, y, area)))
        except RobotMapError as error:
            raise RefusedError(f"GetMap: {error}") from error

    def show(self, objects: Sequence[ObservationReport]) -> None:
        """Draw accepted objects, and no others, on the maps from now on."""
        site = self._site
        self._drawn = Drawn(site, ObservedObjects(objects, site.settings.observations.object_radius_m))

    def surfaces_at(self, points: Sequence[tuple[float, float]], crs: str | None) -> list[Surface | None]:
        """Return the road surface at each of ``points``, None where there is none.

        They are metres in the site frame, or in ``crs``, x before y. Raises RefusedError for a CRS that leads
        nowhere.
        """
        site = self._site
        try:
            places = points if crs is None else self._any_crs.to_site(points, crs)
        except CrsError as error:
            raise RefusedError(str(error)) from error
        with self._indexing:
            index = site.surface_index
        return [None if k == NOWHERE else site.surfaces[k] for k in index.at_many(places).tolist()]

    def place_on_earth(
        self, lat: float, lon: float, heading: float | None
    ) -> tuple[tuple[float, float], float | None]:
        """Return (x, y) in metres and theta in radians, site frame, of a GPS position in degrees.

        ``heading`` is clockwise from true north. Raises RefusedError where the site's CRS has no such place,
        and where the two numbers look swapped.
        """
        try:
            place = self._earth.place(lat, lon)
            if not is_near(place, self._site.bounds):
                self._check_order(lat, lon)
            return place, None if heading is None else self._earth.theta(lat, lon, heading)
        except CrsError as error:
            self._check_order(lat, lon)
            raise RefusedError(f"SendGPS: {error}") from error

    def _check_order(self, lat: float, lon: float) -> None:
        if self._earth.looks_swapped(lat, lon, self._site.bounds):
            raise RefusedError(
                f"SendGPS: lat {lat:.6f}, lon {lon:.6f} is far from site {self._site.id}, and the other way "
                "round it lies there: latitude and longitude look swapped; correct it in the robot's program"
            )
