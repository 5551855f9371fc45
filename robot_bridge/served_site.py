"""What the fleet needs of a site, and of the choice between several."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Protocol

from .messages import ObservationReport, SiteOffer, SiteReport
from .polyline import Track
from .roads.surfaces.surface import Surface
from .robotmap.model import EncodedMap
from .sites.fences import Fences
from .sites.settings import SiteSettings
from .sites.site import Site


class ServedSite(Protocol):
    """A site: its facts, its maps in the binary format, and what is drawn on them."""

    @property
    def report(self) -> SiteReport:
        """The facts of the site."""

    @property
    def site(self) -> Site:
        """The site as it was published last."""

    @property
    def settings(self) -> SiteSettings:
        """The settings of the site."""

    def contains(self, x: float, y: float) -> bool:
        """Tell whether (x, y), metres in the site frame, lies on the site."""

    @property
    def has_keepouts(self) -> bool:
        """Tell whether there is any place where nobody may drive."""

    def keepouts_entered(self, tracks: Sequence[Track]) -> dict[int, str]:
        """Return the numbers of those of ``tracks`` that come into a keepout, each with that one's name."""

    def keepouts_crossed(self, ways: Sequence[Track]) -> dict[int, str]:
        """Return the numbers of those of ``ways`` that lead through a keepout in which neither end lies."""

    def fences(self) -> Fences:
        """Return the areas that robots must not be in, with accepted objects; may take long.

        The same as before where nothing has changed, and the same keepouts where only the objects have.
        """

    def whole_map(self) -> bytes | None:
        """Return the map of the whole site, None where it is larger than the site allows; may take long."""

    def map_at_once(self, place: tuple[float, float] | None) -> EncodedMap:
        """Return the map of the whole site if small and at hand, else one of what is around ``place``."""

    def is_quick(self, x: float, y: float, area: float) -> bool:
        """Tell whether the map of such a square is made in a few milliseconds."""

    def map_around(self, x: float, y: float, area: float) -> bytes:
        """Return the map of a square of ``area`` square metres centred on (x, y)."""

    def surfaces_at(self, points: Sequence[tuple[float, float]], crs: str | None) -> list[Surface | None]:
        """Return the road surface at each of ``points``; raises RefusedError for a CRS that leads nowhere."""

    def to_site(self, points: Sequence[tuple[float, float]], crs: str) -> list[tuple[float, float]]:
        """Return ``points`` of ``crs``, x before y, in metres in the site frame.

        Raises RefusedError for a CRS that leads nowhere, and for a point that has no place in the site's.
        """

    def place_on_earth(
        self, lat: float, lon: float, heading: float | None
    ) -> tuple[tuple[float, float], float | None]:
        """Return (x, y) and theta of a GPS position; raises RefusedError where the site has none."""

    def show(self, objects: Sequence[ObservationReport]) -> None:
        """Draw accepted objects, and no others, on the maps from now on."""


class SiteChoice(Protocol):
    """The sites that may be served."""

    async def offers(self) -> list[SiteOffer]:
        """Return the sites by the names of their folders."""

    async def choose(self, name: str) -> SiteReport:
        """Serve the site in the folder ``name`` from now on; raises RefusedError saying why not."""
