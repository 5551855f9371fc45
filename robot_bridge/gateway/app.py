"""The gateway: its parts wired together, started and stopped."""

from __future__ import annotations

import asyncio
import contextlib
import http
import logging
import socket
import time
from collections.abc import Callable, Coroutine, Iterable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field
from pathlib import Path
from urllib.parse import parse_qs, urlsplit

from sqlalchemy import URL
from websockets.asyncio.server import Server, ServerConnection
from websockets.frames import CloseCode
from websockets.http11 import Request, Response

from ..core.clock import ClockWatch, check_clock_at_start
from ..core.errors import AccessError, BridgeError, SiteError, StoreError
from ..core.messages.administration import Stopping
from ..core.messages.base import MessageError, check_robot_name, to_json
from ..core.sites.site import Site, check_site, frame_mismatch, frame_text, read_site
from ..protocol.asyncapi import served
from .api.metrics_and_queries import HEALTH, METRICS, SiteQueries, StatusPages
from .api.operator_server import OWN, OperatorSession
from .api.robot_sql import SqlInterface
from .api.robot_websockets import WebSocketInterface
from .auth.accounts import TokenKind, check_link_name
from .auth.administration import AccountAdministration
from .auth.audit import AuditJournal
from .auth.authorisation import PATHS, AuthGate
from .auth.client_connection import ClientConnection
from .auth.port import (
    ServerFiles,
    ServerTls,
    address_here,
    check_reach,
    host_fault,
    http_response,
    is_loopback,
    listen,
)
from .cluster.cluster import Cluster, ClusterSettings, fleet_id, join_cluster, lease_database
from .cluster_relays import ClusterRelays
from .field.page import SITE, FieldPage
from .fleet.emergency_persistence import AbortJournal, StopJournal, journal_files
from .fleet.link_supervision import SUSPEND_INTERVAL, LinkProcesses
from .fleet.service import Fleet
from .model.events import Answering, RequestHandlers, StopBegun
from .monitoring import GarbageCollection, Metrics, Work, every, keep_all_going
from .plans.service import PlanService
from .retention import Retention
from .site.site_maps import SiteMaps
from .site_updates import FETCH_INTERVAL, SiteCopy, SiteWatch, Stamp, stamp_of
from .storage.database import Database
from .storage.dialects import sqlite_file_of
from .storage.repositories import metadata
from .storage.repositories.metadata import newest_time
from .storage.roles.choice import has_accounts
from .storage.singleton_lock import MessageNote, SingletonLock
from .traffic.road_planning import RoadPlanner
from .trajectories.recording import TrajectoryPages

# --- Shutdown in good order: every client is notified, and none of them delays it ---

REASON = "the gateway ends; connect again after a while"
FIRST_WORDS = 0.1
"""seconds for operators' sessions to send their last notifications."""
CLOSED_WITHIN = 0.8
"""seconds for the closing handshakes, all at once; connections still open then are aborted."""


async def notify_clients(server: Server, fleet: Fleet) -> None:
    """Accept no more connections, send operators ``stopping``, and close every connection with code 1012."""
    server.close(close_connections=False)
    fleet.listeners.announce("stopping", "", to_json(Stopping(REASON)))
    await asyncio.sleep(FIRST_WORDS)
    connections: Iterable[ServerConnection] = list(server.connections)
    closing = [asyncio.create_task(_close(connection)) for connection in connections]
    if closing:
        await asyncio.wait(closing, timeout=CLOSED_WITHIN)
    for connection in list(server.handlers):
        connection.transport.abort()
    try:
        async with asyncio.timeout(CLOSED_WITHIN):
            await server.wait_closed()
    except TimeoutError:
        pass  # a handler that does not end, for whatever reason, ends with the process


async def _close(connection: ServerConnection) -> None:
    if isinstance(connection, ClientConnection):
        await connection.expel(CloseCode.SERVICE_RESTART, REASON)
    else:
        await connection.close(CloseCode.SERVICE_RESTART, REASON)


# --- The gateway: assembles the parts, starts and stops them ---

log = logging.getLogger(__name__)

AGE_INTERVAL = 0.25
LATENCY_INTERVAL = 1.0
SAVE_INTERVAL = 1.0
GARBAGE_INTERVAL = 1.0
STUCK_INTERVAL = 5.0
PRUNE_INTERVAL = 60.0
ROADS_INTERVAL = 1.0
GEOFENCE_INTERVAL = 0.25
NEARNESS_INTERVAL = 0.5
PLANS_INTERVAL = 0.5
MOST_THREADS = 32
ENDPOINTS = {path: kind for kind, path in PATHS.items()}
SAVE_WITHIN, CLOSE_WITHIN = 2.2, 0.5
"""seconds for the last writes to the database, so that a gateway ends within five in all."""


@dataclass(frozen=True)
class GatewaySettings:
    """Start settings of a gateway; port 0 takes any free one.

    ``state`` is the folder for its state files on this computer, None for the parent of the site's folder.
    A site that a supervisor chose precedes ``site``, unless it must be served ``site_as_given``. Where
    ``site`` is the folder of a ``site_copy``, that is kept as new as its database. With ``cluster`` it is one
    of several gateways that serve the fleet.
    """

    site: Path
    database: URL
    host: str = "127.0.0.1"
    port: int = 8765
    tls: ServerFiles | None = None
    state: Path | None = None
    site_as_given: bool = False
    site_copy: SiteCopy | None = None
    cluster: ClusterSettings | None = None


@dataclass
class Signals:
    """External signals to a running gateway: to end, and to read its settings again."""

    stop: asyncio.Event = field(default_factory=asyncio.Event)
    reload: asyncio.Event = field(default_factory=asyncio.Event)


class Gateway:
    """One site, one database, one port with ``/robot``, ``/desk`` and pages about the gateway itself."""

    def __init__(
        self,
        fleet: Fleet,
        gate: AuthGate,
        links: LinkProcesses,
        handlers: Answering,
        field_page: FieldPage,
        queries: SiteQueries,
        tls: ServerTls | None = None,
    ) -> None:
        self._fleet = fleet
        self._field, self._queries = field_page, queries
        self._handlers = handlers
        self._links = links
        self._gate = gate
        self._tls = tls
        self.robots = WebSocketInterface(fleet)
        metrics = Metrics(fleet.counters)
        fleet.database.add_observer(metrics.database.observe)
        self._status = StatusPages(fleet, metrics)
        self._clock_watch = ClockWatch()
        self._leavings = GarbageCollection()
        fleet.events.subscribe(StopBegun, lambda _: self._leavings.postpone())
        self.retention = Retention(fleet.database, fleet.site)

    async def serve(self, host: str, port: int) -> Server:
        """Listen for robots and operators; raises BridgeError when it cannot listen there."""
        context = self._tls.context if self._tls else None
        return await listen(self._gate, host, port, context, self._admit, self._connected)

    def works(self, address: str) -> dict[str, Work]:
        """Return the works of a gateway at ``address``: liveness, trajectories, links, accounts etc."""
        fleet, counters = self._fleet, self._fleet.counters
        works: dict[str, Work] = {
            "sql link": SqlInterface(fleet, fleet.database).run,
            "latencies": lambda: every(LATENCY_INTERVAL, self._measure, "latencies", counters),
            "liveness": lambda: every(AGE_INTERVAL, self._age, "liveness", counters),
            "queues": fleet.driving.run,
            "maps": fleet.maps.run,
            "save": lambda: every(SAVE_INTERVAL, fleet.save, "save", counters),
            "prune": lambda: every(PRUNE_INTERVAL, self.retention.prune, "prune", counters),
            "roads": lambda: every(ROADS_INTERVAL, fleet.watch_roads, "roads", counters),
            "geofence": lambda: every(GEOFENCE_INTERVAL, fleet.geofence.watch, "geofence", counters),
            "nearness": lambda: every(NEARNESS_INTERVAL, fleet.nearness.watch, "nearness", counters),
            "links": lambda: self._links.run(_for_links(address)),
            "accounts": self._gate.watch,
            "audit log": self._gate.journal.run,
            "garbage": lambda: every(GARBAGE_INTERVAL, self._clear_away, "garbage", counters),
        }
        if fleet.database.dialect.partitions_days:
            works["days of positions"] = lambda: every(
                PRUNE_INTERVAL, self.retention.make_days, "days of positions", counters
            )
        if has_accounts(fleet.database.dialect.name):
            works["stuck robots"] = lambda: every(
                STUCK_INTERVAL, fleet.database.end_stuck, "stuck robots", counters
            )
            works["suspensions"] = lambda: every(
                SUSPEND_INTERVAL, fleet.suspensions.update, "suspensions", counters
            )
        if self._tls is not None:
            works["certificates"] = self._tls.watch
        return works

    async def _clear_away(self) -> None:
        self._leavings.clear_away(self._gate.gone)
        self._fleet.repeated.summarise()

    async def _measure(self) -> None:
        self.robots.measure()

    async def _age(self) -> None:
        if (step := self._clock_watch.measure_step()) is not None:
            way = "forward" if step.by > 0 else "back"
            log.warning("the clock of this computer was set %s by %.0f s", way, abs(step.by))
            self._fleet.clock_was_set(step)
        fleet = self._fleet
        fleet.age()
        self.robots.update()
        fleet.links.update(self.robots.links(), self._links.states)

    async def _admit(self, connection: ClientConnection, request: Request) -> Response | None:
        path = urlsplit(request.path).path
        own = self._own_origin(request, path)
        if (refusal := self._gate.refuse_page(connection, request, own)) is not None:
            return refusal
        if path not in ENDPOINTS and (fault := self._host_fault(request)) is not None:
            return connection.respond(http.HTTPStatus.MISDIRECTED_REQUEST, f"{fault}.\n")
        if path in (HEALTH, METRICS):
            return await self._status_page(connection, request, path)
        if self._field.serves(path):
            return await self._field_page(connection, request, path)
        if self._queries.serves(path):
            refusal = await self._gate.may_read(connection, request)
            return refusal if refusal is not None else await self._queries.answer(request)
        if (document := served(path)) is not None:
            header = ("Content-Type", "application/json")
            return http_response(http.HTTPStatus.OK, document.encode(), [header])
        if path not in ENDPOINTS:
            text = f"{path} is not served here; robots connect to /robot, operators to /desk, links to /link"
            return connection.respond(http.HTTPStatus.NOT_FOUND, f"{text}\n")
        try:
            name = _name_in(request.path, ENDPOINTS[path])
        except (MessageError, AccessError) as error:
            return connection.respond(http.HTTPStatus.BAD_REQUEST, f"{error}\n")
        kind = ENDPOINTS[path]
        return await self._gate.admit(connection, request, kind, name, self._largest_message(kind))

    def _own_origin(self, request: Request, path: str) -> str | None:
        """Return the origin of the field page for a request that it may make."""
        host = request.headers.get("Host") if len(request.headers.get_all("Host")) == 1 else None
        may = path == PATHS[TokenKind.OPERATOR] or self._field.serves(path)
        if host is None or not may or self._host_fault(request) is not None:
            return None
        return f"{'http' if self._tls is None else 'https'}://{host}"

    async def _field_page(self, connection: ClientConnection, request: Request, path: str) -> Response:
        if path != SITE:
            return await self._field.file(request)
        if refusal := await self._gate.may_read(connection, request):
            return refusal
        return await self._field.site(request)

    def _host_fault(self, request: Request) -> str | None:
        """Return the fault where a page is not requested by a name of this gateway, else None."""
        names = (*self._gate.limits.hosts, *(self._tls.names if self._tls is not None else ()))
        return host_fault(request.headers.get_all("Host"), names)

    async def _status_page(self, connection: ClientConnection, request: Request, path: str) -> Response:
        if path == HEALTH:
            return await self._status.health()
        if not is_loopback(connection.address) and (
            refusal := await self._gate.may_read(connection, request)
        ):
            return refusal
        return await self._status.metrics()

    def _largest_message(self, kind: TokenKind) -> int:
        largest = self._gate.limits.largest_message_bytes
        if kind is TokenKind.OPERATOR:
            return largest
        # An image is sent as base64, four bytes for three, with its parameters.
        image = self._fleet.site.settings.observations.largest_image_bytes
        return max(largest, image * 4 // 3 + 65_536)

    async def _connected(self, connection: ClientConnection) -> None:
        assert connection.identity is not None
        kind = connection.identity.kind
        if kind is TokenKind.OPERATOR:
            await OperatorSession(self._fleet, connection, self._gate, self._handlers).run()
        elif kind is TokenKind.LINK:
            await self.robots.serve_link(connection, self._gate)
        else:
            await self.robots.serve(connection, connection.identity.name)


def request_handlers(
    fleet: Fleet, plans: PlanService, database: Database, sites: SiteWatch, journal: AuditJournal
) -> RequestHandlers:
    """Return the handlers of operators' requests; those on a connection alone are handled by it."""
    handlers = RequestHandlers(
        fleet.orders,
        fleet.emergency,
        fleet.queues,
        fleet.pauses,
        plans,
        fleet.roads,
        fleet.roads.closures,
        fleet.roads.traffic,
        fleet.views,
        fleet.observations,
        fleet.maps,
        fleet.removals,
        fleet.links,
        TrajectoryPages(database),
        AccountAdministration(database, journal),
        sites,
    )
    handlers.check_complete(except_for=OWN)
    return handlers


async def run(settings: GatewaySettings, signals: Signals, started: Callable[[str], None]) -> None:
    """Run a gateway until its stop signal; ``started`` is called with its address, ``ws://host:port``.

    :raises BridgeError: when it may not listen there, another gateway runs on its database, or it cannot
        continue; SiteError and StoreError for its site and database.
    """
    # Threads that wait for one another in route planning must not block other work.
    asyncio.get_running_loop().set_default_executor(ThreadPoolExecutor(MOST_THREADS, "gateway"))
    if settings.cluster is not None:
        settings.cluster.check(settings.database)
    tls = ServerTls(settings.tls) if settings.tls else None
    stamp = await asyncio.to_thread(stamp_of, settings.site)
    await asyncio.to_thread(check_site, settings.site)
    async with contextlib.AsyncExitStack() as stack:
        database = Database(settings.database)
        stack.push_async_callback(database.close, CLOSE_WITHIN)
        await database.open()
        cluster, holding = await _hold_database(settings, database, stack)
        # Before anything is stored by this clock.
        doubt = check_clock_at_start(time.time(), await database.run(newest_time))
        folder, stamp, site = await _read_served_site(settings, database, cluster, stamp)
        stops, aborts = await asyncio.to_thread(_journals, settings, await database.run(metadata.database_id))
        gate = AuthGate(database, site.settings.limits, may_be_open=is_loopback(settings.host))
        await gate.open()
        accounts = gate.accounts.has_operator(time.time())
        check_reach(settings.host, tls=tls is not None, accounts=accounts)
        maps = SiteMaps(site)
        planner = await asyncio.to_thread(RoadPlanner, maps)
        stack.callback(planner.close)
        note = gate.journal.note
        fleet = Fleet(maps, database, planner=planner, stops=stops, aborts=aborts, note=note, cluster=cluster)
        await fleet.start()
        plans = PlanService(
            fleet.queue_context,
            fleet.queues,
            fleet.roads.closures,
            fleet.emergency,
            fleet.listeners,
            fleet.events,
            None if cluster is None else cluster.membership,
        )
        await plans.restore()
        stack.push_async_callback(_save_last, fleet, plans, gate)
        links = LinkProcesses(site.settings.links, folder)
        watch = SiteWatch(folder, stamp, maps, fleet, signals.reload, settings.site.resolve().name)
        handlers = request_handlers(fleet, plans, database, watch, gate.journal)
        relays = None if cluster is None else _relays(settings, cluster, fleet, handlers, watch, plans)
        answering = handlers if relays is None else relays.requests
        queries = SiteQueries(maps, handlers)
        gateway = Gateway(fleet, gate, links, answering, FieldPage(maps), queries, tls)
        if relays is not None:
            relays.reach(gateway.robots.abort)
        if doubt is not None:
            log.warning("%s", doubt.text)
            if doubt.may_be_ahead:
                gateway.retention.doubt_clock()
        # Without them positions are stored all the same; the error is logged at the next attempt.
        with contextlib.suppress(StoreError):
            await gateway.retention.make_days()
        server = await gateway.serve(settings.host, settings.port)
        gate.warn()
        stack.push_async_callback(notify_clients, server, fleet)
        address = _address(server, tls is not None)
        if cluster is not None:
            cluster.listens(address, everywhere=address_here(settings.host) != settings.host)
        started(address)
        works = {**gateway.works(address), "site": watch.run, **holding}
        if relays is None:
            works["plans"] = lambda: every(PLANS_INTERVAL, plans.follow, "plans", fleet.counters)
        else:
            works = relays.works(works, fleet.counters)
        if (copy := settings.site_copy) is not None:
            stack.push_async_callback(copy.close)
            works["site copy"] = lambda: every(FETCH_INTERVAL, copy.refresh, "site copy", fleet.counters)
        await _until_stopped(keep_all_going(works, fleet.counters), signals.stop)


async def _read_served_site(
    settings: GatewaySettings, database: Database, cluster: Cluster | None, stamp: Stamp
) -> tuple[Path, Stamp, Site]:
    """Return the site to serve with its folder and the stamp of that; ``stamp`` is that of the given one.

    To be called once the database is held: a city takes a while to read, and a wrong address is reported at
    once. Raises BridgeError, SiteError and StoreError.
    """
    site = await asyncio.to_thread(read_site, settings.site)
    folder = await _site_folder(settings, database)
    if folder != settings.site:
        stamp = await asyncio.to_thread(stamp_of, folder)
        site = await asyncio.to_thread(_chosen, folder, site)
    await _check_frame(site, settings, database, cluster)
    return folder, stamp, site


async def _hold_database(
    settings: GatewaySettings, database: Database, stack: contextlib.AsyncExitStack
) -> tuple[Cluster | None, dict[str, Work]]:
    """Lock the database, or join the cluster on it; return the cluster, and the works that keep the hold.

    :raises BridgeError: when other gateways use it in an incompatible way; StoreError.
    """
    if settings.cluster is None:
        sole = SingletonLock(settings.database)
        await sole.acquire()
        stack.push_async_callback(sole.release)
        note = await _checked_note(settings, database, stack)
        return None, {"sole gateway": sole.hold, "newest message": note.hold}
    lease = lease_database(settings.database)
    stack.push_async_callback(lease.close, CLOSE_WITHIN)
    fleet = await database.run(fleet_id)
    note = await _checked_note(settings, database, stack)
    cluster = await join_cluster(settings.cluster, database, lease, fleet)
    stack.push_async_callback(cluster.membership.leave)
    # At once: reading a city takes longer than a lease lasts.
    holding = asyncio.create_task(cluster.membership.hold())
    stack.callback(holding.cancel)
    return cluster, {"lease": lambda: asyncio.shield(holding), "newest message": note.hold}


async def _checked_note(
    settings: GatewaySettings, database: Database, stack: contextlib.AsyncExitStack
) -> MessageNote:
    """Return the note of the newest message, after a comparison with the database; raises StoreError."""
    name = None if settings.cluster is None else settings.cluster.name
    note = MessageNote(database, _state_folder(settings), name)
    await note.check()
    stack.push_async_callback(note.close, CLOSE_WITHIN)
    return note


def _state_folder(settings: GatewaySettings) -> Path | None:
    """Return the folder for the gateway's state files on this computer; None for a database in memory."""
    if settings.database.get_backend_name() == "sqlite":
        file = sqlite_file_of(settings.database)
        return None if file is None else file.parent
    return settings.state or settings.site.resolve().parent


def _relays(
    settings: GatewaySettings,
    cluster: Cluster,
    fleet: Fleet,
    handlers: RequestHandlers,
    sites: SiteWatch,
    plans: PlanService,
) -> ClusterRelays:
    assert settings.cluster is not None
    stops_when_cut_off = settings.cluster.stops_when_cut_off
    return ClusterRelays(
        cluster, fleet, handlers, cluster.lease, sites, plans, stops_when_cut_off=stops_when_cut_off
    )


async def _site_folder(settings: GatewaySettings, database: Database) -> Path:
    """Return the folder of the site to serve: the one that a supervisor chose, else the given one."""
    given = settings.site.resolve()
    if settings.site_as_given:
        await database.run(metadata.forget_site)
    chosen = await database.run(metadata.chosen_site)
    if chosen is None or chosen == given.name:
        return settings.site
    log.warning("site %s is served, which a supervisor chose, and not %s", chosen, given.name)
    return given.parent / chosen


def _chosen(folder: Path, given: Site) -> Site:
    """Return the site in ``folder``, chosen at a desk; raises BridgeError when it cannot be served."""
    try:
        site = read_site(folder)
        why = frame_mismatch(given.settings, site.settings)
    except SiteError as error:
        why = str(error)
    if why is not None:
        raise BridgeError(
            f"the site that a supervisor chose cannot be served: {why}. Publish it again, or serve "
            f"{given.id} with --site-as-given"
        )
    return site


async def _check_frame(
    site: Site, settings: GatewaySettings, database: Database, cluster: Cluster | None
) -> None:
    """Raise BridgeError for a site with a frame that differs from that of the database; StoreError.

    Robots would be sent to stored coordinates that are other places in the frame of this site.
    """
    frame = frame_text(site.settings)
    is_alone = cluster is None or not cluster.membership.others()
    kept = await database.run(lambda its: metadata.frame_of_places(its, frame, is_alone=is_alone))
    if kept != frame:
        raise BridgeError(
            f"{settings.site}: site {site.settings.id} is in the frame {frame}, and the places in database "
            f"{database.where} are in {kept}: the same metres are other places. Publish the site in that "
            "frame, or start the gateway with a database of its own"
        )


def _journals(settings: GatewaySettings, database: str) -> tuple[StopJournal | None, AbortJournal | None]:
    """Return the journals of a gateway on the database with the id ``database``."""
    folder = _state_folder(settings)
    name = None if settings.cluster is None else settings.cluster.name
    files = None if folder is None else journal_files(settings.database, folder, name)
    if files is None:
        return None, None
    stops, aborts = StopJournal(files[0]), AbortJournal(files[1], database)
    stops.check()
    aborts.check()
    return stops, aborts


async def _until_stopped(watch: Coroutine[None, None, None], stop: asyncio.Event) -> None:
    """Run ``watch`` until ``stop`` is set; an exception of it ends the gateway."""
    watching, stopping = asyncio.create_task(watch), asyncio.create_task(stop.wait())
    await asyncio.wait({watching, stopping}, return_when=asyncio.FIRST_COMPLETED)
    if watching.done():
        stopping.cancel()
        await watching
    watching.cancel()
    await asyncio.gather(watching, return_exceptions=True)


async def _save_last(fleet: Fleet, plans: PlanService, gate: AuthGate) -> None:
    """Store all that is pending; a database that does not answer must not prevent the gateway's end."""
    try:
        async with asyncio.timeout(SAVE_WITHIN):
            await fleet.finish_trajectories()
            await gate.close()
            await plans.finish()
    except (StoreError, TimeoutError) as error:
        reason = str(error) or "the database does not answer"
        log.error("%s; the last positions are not stored", reason)


def _name_in(path: str, kind: TokenKind) -> str | None:
    """Return the name in a request: ``?robot=NAME``, or ``?link=NAME``."""
    if kind is TokenKind.LINK:
        links = parse_qs(urlsplit(path).query).get("link")
        return check_link_name(links[0]) if links else None
    names = parse_qs(urlsplit(path).query).get("robot")
    return check_robot_name(names[0]) if names else None


def _for_links(address: str) -> str:
    """Return the URL of the gateway for links on this computer, from its address ``ws://host:port``."""
    parts = urlsplit(address)
    host = address_here(parts.hostname or "")
    return f"{parts.scheme}://{f'[{host}]' if ':' in host else host}:{parts.port}{PATHS[TokenKind.LINK]}"


def _address(server: Server, tls: bool) -> str:
    sock = next(iter(server.sockets))
    host, port = sock.getsockname()[:2]
    scheme = "wss" if tls else "ws"
    return f"{scheme}://[{host}]:{port}" if sock.family == socket.AF_INET6 else f"{scheme}://{host}:{port}"
