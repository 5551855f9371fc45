"""The published site while the gateway runs: a new version, or changed settings, are taken over."""

from __future__ import annotations

import asyncio
import logging
from pathlib import Path

from ..core.errors import BridgeError, RefusedError, SiteError
from ..core.messages.administration import ChooseSite, GetSites, SiteOffer, SiteReport, Sites
from ..core.sites.geopackage import GEOPACKAGE_FILE
from ..core.sites.settings import SETTINGS_FILE, read_settings
from ..core.sites.site import Site, frame_mismatch, read_site, sibling_sites
from .fleet.service import Fleet
from .model.request_handlers import handles
from .monitoring import wait_at_most
from .site.site_maps import SiteMaps
from .storage.repositories import metadata
from .traffic.road_planning import check_roads

log = logging.getLogger(__name__)

LOOK_INTERVAL = 1.0

Stamp = tuple[tuple[int, int, int] | None, ...]


def stamp_of(folder: Path) -> Stamp:
    """Return what changes whenever one of the site's files is written or replaced."""
    return tuple(_stamp(folder / name) for name in (SETTINGS_FILE, GEOPACKAGE_FILE))


class SiteWatch:
    """Looks at the folder of the site every second, and at once when ``reload`` is set.

    Supervisors may choose another folder beside it; the choice outlives the gateway.

    ``seen`` is the stamp of the folder from before the site was read. A publication is taken over whole or
    not at all: a folder that is half written, or wrong, leaves the gateway with what it serves.
    """

    def __init__(
        self, folder: Path, seen: Stamp, maps: SiteMaps, fleet: Fleet, reload: asyncio.Event
    ) -> None:
        self._folder = folder
        self._seen = seen
        self._doubtful: Stamp | None = None
        self._maps = maps
        self._fleet = fleet
        self._reload = reload
        self._reading = asyncio.Lock()

    async def run(self) -> None:
        """Take over what is published, until cancelled."""
        while True:
            await wait_at_most(self._reload, LOOK_INTERVAL)
            await self.refresh(requested=self._reload.is_set())

    async def refresh(self, *, requested: bool = False) -> None:
        """Look once; ``requested``: read the site even if it looks the same."""
        self._reload.clear()
        async with self._reading:
            await self._look(requested)

    @handles(GetSites)
    async def offers(self) -> Sites:
        """Return the sites that lie beside the one that is served, and that one."""
        return await asyncio.to_thread(self._offers)

    @handles(ChooseSite)
    async def choose(self, request: ChooseSite) -> SiteReport:
        """Serve the site in a folder beside this one; raises RefusedError saying why not."""
        name = request.site
        async with self._reading:
            known = await asyncio.to_thread(sibling_sites, self._folder)
            if name not in known:
                raise RefusedError(
                    f"there is no site in a folder {name!r}; choose one of: {', '.join(known)}"
                )
            folder = self._beside(name)
            stamp = await asyncio.to_thread(stamp_of, folder)
            site = await asyncio.to_thread(self._readable, folder)
            await self._fleet.database.run(metadata.choose_site, name)
            self._folder, self._seen, self._doubtful = folder, stamp, None
            await self._take_over(site)
            return self._maps.report

    async def _look(self, requested: bool) -> None:
        stamp = await asyncio.to_thread(stamp_of, self._folder)
        if stamp == self._seen and not requested:
            return
        try:
            site = await asyncio.to_thread(read_site, self._folder)
            self._check(site)
            await asyncio.to_thread(check_roads, site)
        except (SiteError, BridgeError) as error:
            # Two files are replaced one after the other: what is wrong may be half of something right.
            if stamp == self._doubtful or requested:
                self._seen = stamp
                log.error("version %d is served on: %s", self._maps.report.version, error)
            self._doubtful = stamp
            return
        self._seen = stamp
        await self._take_over(site)

    def _beside(self, name: str) -> Path:
        return self._folder.resolve().parent / name

    def _offers(self) -> Sites:
        return Sites([self._offer(name) for name in sibling_sites(self._folder)])

    def _offer(self, name: str) -> SiteOffer:
        served = name == self._folder.resolve().name
        try:
            found = read_settings(self._beside(name) / SETTINGS_FILE)
        except SiteError as error:
            return SiteOffer(name, served, refusal=str(error))
        refusal = None if served else frame_mismatch(self._maps.settings, found)
        return SiteOffer(name, served, found.id, found.name, found.version, refusal)

    def _readable(self, folder: Path) -> Site:
        """Return the site in ``folder``; raises RefusedError when it cannot be served after this one."""
        try:
            site = read_site(folder)
            check_roads(site)
        except (SiteError, BridgeError) as error:
            raise RefusedError(f"{self._maps.report.id} is served on: {error}") from error
        if (why := frame_mismatch(self._maps.settings, site.settings)) is not None:
            raise RefusedError(why)
        return site

    def _check(self, site: Site) -> None:
        old, new = self._maps.settings, site.settings
        kept = (old.id, old.crs, old.origin, old.rotation_deg)
        if (new.id, new.crs, new.origin, new.rotation_deg) != kept:
            raise BridgeError(
                f"{self._folder} now holds another site, or one with another frame: {new.id} in {new.crs}; "
                "positions of the one are wrong in the other, so end the gateway and start it anew"
            )

    async def _take_over(self, site: Site) -> None:
        old = self._maps.settings
        if site.settings == old and site.version == old.version:
            return
        self._maps.take_over(site)
        await self._fleet.site_changed()
        log.info("site %s version %d is served now", site.id, site.version)
        for table in ("gateway", "limits"):
            if getattr(site.settings, table) != getattr(old, table):
                log.warning("%s: [%s] takes effect when the gateway is started anew", SETTINGS_FILE, table)
        if (site.id, site.version) != (old.id, old.version):
            await self._fleet.maps.send_all()


def _stamp(file: Path) -> tuple[int, int, int] | None:
    try:
        found = file.stat()
    except OSError:
        return None
    return found.st_mtime_ns, found.st_size, found.st_ino
