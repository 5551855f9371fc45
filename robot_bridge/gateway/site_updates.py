"""New versions of the site: fetched from a database, and adopted while the gateway runs."""

from __future__ import annotations

import asyncio
import contextlib
import hashlib
import json
import logging
import os
import shutil
from collections.abc import AsyncIterator
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

from ..core.errors import BridgeError, RefusedError, SiteError, StoreError, in_one_line
from ..core.files import StagedFiles, write_state
from ..core.json_decoder import SHORT, DecodingError, decode_json
from ..core.messages.administration import ChooseSite, GetSites, SiteOffer, SiteReport, Sites
from ..core.sites.geopackage import GEOPACKAGE_FILE
from ..core.sites.settings import SETTINGS_FILE, read_settings
from ..core.sites.site import Site, frame_mismatch, publish_staged, read_site, sibling_sites
from ..core.sites.site_database import FORMAT, SCHEMA, SITE_FILES, SiteAddress, digest_text
from .fleet.service import Fleet
from .model.events import SiteChosen, handles
from .monitoring import until_tick, wait_at_most
from .site.site_maps import SiteMaps
from .storage.dialects import CONNECT_ARGUMENTS, PostgreSQL
from .storage.repositories import metadata
from .traffic.road_planning import check_roads

if TYPE_CHECKING:
    from psycopg import AsyncConnection, AsyncCursor

log = logging.getLogger(__name__)

# --- Site published in a database: its newest version is fetched into a folder, which is served
# The folder is as a publication makes it, and a new version replaces the earlier one in it as a publication
# does, so that :class:`SiteWatch` sees no difference.

FETCH_INTERVAL = 2.0
PATIENCE = 20.0
"""seconds for one answer of the database, of at most some megabytes."""
_NOTE = "fetched.json"
_STAGE = ".fetching-"


class SiteCopyError(StoreError):
    """A site that cannot be fetched from its database; the served version is kept."""


class _Version(NamedTuple):
    number: int
    digest: str


class SiteCopy:
    """The copy of the site at ``address`` on this computer, in :attr:`folder`, which lies in ``state``.

    No method waits for one answer of the database longer than PATIENCE, and a cancellation ends it at once.
    """

    def __init__(self, address: SiteAddress, state: Path | None) -> None:
        # One folder for each database: sites in the same parent folder are offered to operators.
        place = hashlib.sha256(address.shown.encode()).hexdigest()[:16]
        self.folder = (state or _state_folder()) / "sites" / place / address.site
        self._address = address
        self._refused: _Version | None = None
        self._connection: AsyncConnection[Any] | None = None

    def fetch_first(self) -> None:
        """Fetch a newer version, before a gateway runs; if this fails, an existing copy is served.

        :raises SiteCopyError: when it fails and there is no copy.
        """
        for left_by_a_crash in self.folder.glob(f"{_STAGE}*"):
            shutil.rmtree(left_by_a_crash, ignore_errors=True)
        try:
            asyncio.run(self._fetch_once())
        except SiteCopyError as error:
            kept = self._kept()
            if kept is None:
                raise
            log.warning("%s; its version %d, which was fetched before, is served", error, kept.number)

    async def _fetch_once(self) -> None:
        try:
            await self.refresh()
        finally:
            await self.close()

    async def refresh(self) -> None:
        """Fetch the newest version unless present; raises SiteCopyError with the reason where it cannot."""
        psycopg = _psycopg()
        try:
            await self._refresh()
        except SiteCopyError:
            await self.close()
            raise
        except (psycopg.Error, OSError) as error:
            await self.close()
            raise self._failed(error) from error

    async def close(self) -> None:
        """Give up the connection."""
        connection, self._connection = self._connection, None
        if connection is not None:
            await connection.close()

    async def _refresh(self) -> None:
        connection = self._connection = self._connection or await self._connect()
        async with _snapshot(connection):
            newest = await self._newest(connection)
            if newest in (self._kept(), self._refused):
                return
            try:
                await self._fetch(connection, newest)
            except SiteError as error:
                # Once: a faulty version stays faulty until it is published again.
                self._refused = newest
                raise SiteCopyError(
                    f"{error}. What was fetched before stays; publish the site again"
                ) from error
        log.info("%s: version %d is fetched", self._address.shown, newest.number)

    async def _connect(self) -> AsyncConnection[Any]:
        kind: type[AsyncConnection[Any]] = _psycopg().AsyncConnection
        async with asyncio.timeout(PATIENCE):
            return await kind.connect(self._address.conninfo, autocommit=True, **CONNECT_ARGUMENTS)

    async def _newest(self, connection: AsyncConnection[Any]) -> _Version:
        psycopg, site = _psycopg(), self._address.site
        try:
            query = f"select version, digest from {SCHEMA}.sites where site = %s"  # nosec B608 # our names
            found = await _rows(connection, query, site)
        except psycopg.errors.UndefinedTable as error:
            raise SiteCopyError(
                f"{self._address.shown}: no site is published in this database; publish it there with QGIS "
                "(Publish site, DATABASE), or correct the address"
            ) from error
        if not found:
            query = f"select site from {SCHEMA}.sites order by 1"  # nosec B608 # our names
            names = [name for (name,) in await _rows(connection, query)]
            raise SiteCopyError(
                f"{self._address.shown}: there is no site {site!r} in this database; it has: "
                f"{', '.join(names) or 'none'}"
            )
        await self._check_format(connection)
        return _Version(*found[0])

    async def _check_format(self, connection: AsyncConnection[Any]) -> None:
        query = "select obj_description(oid, 'pg_namespace') from pg_namespace where nspname = %s"
        ((said,),) = await _rows(connection, query, SCHEMA)
        if said != FORMAT:
            raise SiteCopyError(
                f"{self._address.shown}: its schema {SCHEMA} is of another version of this program (it says "
                f"{said!r}); use the gateway of that version, or publish the site into another database"
            )

    async def _fetch(self, connection: AsyncConnection[Any], newest: _Version) -> None:
        """Fetch ``newest`` whole and put it into the folder; raises SiteError for damaged files."""
        query = f"select name, digest, size from {SCHEMA}.files where site = %s and version = %s"  # nosec B608 # names of ours
        files = await _rows(connection, query, self._address.site, newest.number)
        digests = {name: digest for name, digest, _ in files}
        if hashlib.sha256(digest_text(digests)).hexdigest() != newest.digest or not digests.keys() <= {
            *SITE_FILES
        }:
            raise SiteError(
                f"{self._address.shown}: the files of version {newest.number} are not those published"
            )
        with contextlib.ExitStack() as stages:
            staged = await asyncio.to_thread(stages.enter_context, StagedFiles(self.folder, _STAGE))
            for name, digest, size in files:
                if await self._fetch_file(connection, newest, staged.folder / name, size) != digest:
                    raise SiteError(f"{self._address.shown}: {name} of version {newest.number} is damaged")
            await asyncio.to_thread(self._put_in_place, staged, newest)

    async def _fetch_file(
        self, connection: AsyncConnection[Any], newest: _Version, file: Path, size: int
    ) -> str:
        """Write one file, part by part, and not much beyond its ``size``; return its digest."""
        digest, number, written = hashlib.sha256(), 0, 0
        query = (
            f"select content from {SCHEMA}.parts "  # nosec B608 # our names
            "where site = %s and version = %s and name = %s and number = %s"
        )
        place = (self._address.site, newest.number, file.name)
        with file.open("wb") as stream:
            while written < size and (found := await _rows(connection, query, *place, number)):
                part = found[0][0]
                await asyncio.to_thread(stream.write, part)
                digest.update(part)
                number, written = number + 1, written + max(len(part), 1)
        return digest.hexdigest()

    def _put_in_place(self, staged: StagedFiles, newest: _Version) -> None:
        settings = read_settings(staged.folder / SETTINGS_FILE)
        if (settings.id, settings.version) != (self._address.site, newest.number):
            raise SiteError(f"{self._address.shown}: version {newest.number} holds that of {settings.stamp}")
        publish_staged(staged)
        write_state(self._version_file, json.dumps(newest._asdict()).encode())

    @property
    def _version_file(self) -> Path:
        return self.folder.parent / _NOTE

    def _kept(self) -> _Version | None:
        """Return the version that was fetched last, None where it is missing."""
        if not all((self.folder / name).is_file() for name in (SETTINGS_FILE, GEOPACKAGE_FILE)):
            return None
        try:
            found = decode_json(self._version_file.read_bytes(), SHORT)
            return _Version(int(found["number"]), str(found["digest"]))
        except (OSError, DecodingError, KeyError, TypeError, ValueError):
            return None

    def _failed(self, error: Exception) -> SiteCopyError:
        reason = in_one_line(error) or f"no answer within {PATIENCE:g} s"
        if getattr(error, "sqlstate", None) == "42501":
            return SiteCopyError(
                f"{self._address.shown}: this account may not read the sites ({reason}); whoever publishes "
                f"them runs: grant usage on schema {SCHEMA} to ACCOUNT; grant select on all tables in schema "
                f"{SCHEMA} to ACCOUNT"
            )
        if isinstance(error, OSError) and error.filename is not None:
            return SiteCopyError(f"{error.filename}: {error.strerror}; the site is fetched into that folder")
        return SiteCopyError(
            f"{self._address.shown} cannot be read: {reason}; check that the server runs, and the account, "
            "whose password is in PGPASSWORD or ~/.pgpass"
        )


def _psycopg() -> Any:
    """Return the driver; it is imported on use, because it may be missing."""
    try:
        import psycopg
    except ImportError as error:
        raise SiteCopyError(
            f"the site is in PostgreSQL, whose driver is missing ({error}); install it with: "
            "pip install 'fleet-supervisor-robot-bridge[postgresql]'"
        ) from error
    return psycopg


def _state_folder() -> Path:
    """Return the state folder for programs of this account."""
    given = os.environ.get("XDG_STATE_HOME")
    return (Path(given) if given else Path.home() / ".local" / "state") / "robot-bridge"


@contextlib.asynccontextmanager
async def _snapshot(connection: AsyncConnection[Any]) -> AsyncIterator[None]:
    """Read everything in the block from one snapshot, whatever is published meanwhile."""
    await _answered(connection, "begin isolation level repeatable read read only")
    yield
    await _answered(connection, "rollback")


async def _rows(connection: AsyncConnection[Any], query: str, *values: object) -> list[tuple[Any, ...]]:
    return await (await _answered(connection, query, *values)).fetchall()


async def _answered(connection: AsyncConnection[Any], query: str, *values: object) -> AsyncCursor[Any]:
    """Return the database's answer; raises TimeoutError where that takes longer than PATIENCE.

    The driver, when cancelled, requests the server to end the query and waits for that, 10 s for a frozen
    server: the shutdown of the gateway would wait, too. So its connection is cut instead.
    """
    asking = asyncio.ensure_future(connection.execute(query.encode(), values or None, binary=True))
    asking.add_done_callback(lambda done: done.cancelled() or done.exception())
    try:
        await asyncio.wait({asking}, timeout=PATIENCE)
    finally:
        if not asking.done():
            PostgreSQL().interrupt(connection)
    if not asking.done():
        raise TimeoutError(f"no answer within {PATIENCE:g} s")
    return asking.result()


# --- Watching the folder of the site: a new version, or changed settings, are adopted ---

LOOK_INTERVAL = 1.0

Stamp = tuple[tuple[int, int, int] | None, ...]


def stamp_of(folder: Path) -> Stamp:
    """Return a stamp that changes whenever one of the site's files is written or replaced."""
    return tuple(_stamp(folder / name) for name in (SETTINGS_FILE, GEOPACKAGE_FILE))


class SiteWatch:
    """Checks the folder of the site every second, and at once when ``reload`` is set.

    Supervisors may choose a sibling folder; the choice outlives the gateway, and without one the sibling
    named ``given`` is served.

    ``seen`` is the stamp of the folder from before the site was read. A publication is adopted whole or not
    at all: with a folder that is half written, or faulty, the gateway continues to serve its version.
    """

    def __init__(
        self, folder: Path, seen: Stamp, maps: SiteMaps, fleet: Fleet, reload: asyncio.Event, given: str
    ) -> None:
        self._folder = folder
        self._given = given
        self._refused: tuple[str, Stamp] | None = None
        """the choice at another gateway that cannot be served here."""
        self._seen = seen
        self._doubtful: Stamp | None = None
        self._maps = maps
        self._fleet = fleet
        self._reload = reload
        self._reading = asyncio.Lock()

    async def run(self) -> None:
        """Adopt publications, until cancelled."""
        while True:
            await wait_at_most(self._reload, until_tick(LOOK_INTERVAL))
            await self.refresh(requested=self._reload.is_set())

    async def refresh(self, *, requested: bool = False) -> None:
        """Check once; ``requested``: read the site even if its stamp is the same."""
        self._reload.clear()
        async with self._reading:
            await self._check_folder(requested)

    @handles(GetSites)
    async def offers(self) -> Sites:
        """Return the served site and its siblings."""
        return await asyncio.to_thread(self._offers)

    @handles(ChooseSite)
    async def choose(self, request: ChooseSite) -> SiteReport:
        """Serve the site in a sibling folder; raises RefusedError with the reason where it cannot."""
        async with self._reading:
            folder, stamp, site = await asyncio.to_thread(self._choice, request.site)
            await self._fleet.database.run(metadata.choose_site, request.site)
            self._fleet.events.publish(SiteChosen(request.site))
            await self._serve(folder, stamp, site)
            return self._maps.report

    @property
    def goes_on(self) -> bool:
        """Whether the chosen site cannot be served here: a corrected one may be published."""
        return self._maps.report.problem is not None

    async def follow(self) -> None:
        """Serve the site that was chosen at another gateway of the fleet; raises StoreError.

        One that cannot be served here is reported to all desks as long as this is so, and retried once it is
        published again.
        """
        # A publication here does not wait for an unavailable database.
        if await self._chosen() == self._folder.resolve().name and self._maps.report.problem is None:
            return
        async with self._reading:
            name = await self._chosen()
            if name == self._folder.resolve().name:
                self._report_problem(None)
                return
            seen = name, await asyncio.to_thread(stamp_of, self._beside(name))
            if seen == self._refused:
                return
            try:
                folder, stamp, site = await asyncio.to_thread(self._choice, name)
            except RefusedError as error:
                self._refused = seen
                self._report_problem(
                    f"site {name} was chosen for the fleet and cannot be served here: {error}"
                )
                return
            log.warning("site %s is served, which was chosen at another gateway", name)
            await self._serve(folder, stamp, site)

    async def _chosen(self) -> str:
        return await self._fleet.database.read(metadata.chosen_site) or self._given

    async def _serve(self, folder: Path, stamp: Stamp, site: Site) -> None:
        self._folder, self._seen, self._doubtful = folder, stamp, None
        self._report_problem(None)
        await self._adopt(site)

    def _report_problem(self, problem: str | None) -> None:
        """Report to operators why this gateway does not serve the chosen site, or (None) that it does."""
        if problem is None:
            self._refused = None
        if problem == self._maps.report.problem:
            return
        if problem is not None:
            log.error("%s", problem)
        self._maps.note_problem(problem)
        self._fleet.announce_site()

    async def _check_folder(self, requested: bool) -> None:
        stamp = await asyncio.to_thread(stamp_of, self._folder)
        if stamp == self._seen and not requested:
            return
        try:
            site = await asyncio.to_thread(read_site, self._folder)
            self._check(site)
            await asyncio.to_thread(check_roads, site)
        except (SiteError, BridgeError) as error:
            # Two files are replaced one after the other: a fault may be half of a correct publication.
            if stamp == self._doubtful or requested:
                self._seen = stamp
                log.error("version %d is served on: %s", self._maps.report.version, error)
            self._doubtful = stamp
            return
        self._seen = stamp
        await self._adopt(site)

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

    def _choice(self, name: str) -> tuple[Path, Stamp, Site]:
        """Return the sibling folder ``name``, its stamp and its site; raises RefusedError."""
        known = sibling_sites(self._folder)
        if name not in known:
            raise RefusedError(f"there is no site in a folder {name!r}; choose one of: {', '.join(known)}")
        folder = self._beside(name)
        stamp = stamp_of(folder)
        return folder, stamp, self._readable(folder)

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

    async def _adopt(self, site: Site) -> None:
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
