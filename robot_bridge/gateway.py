"""The gateway: puts the parts together, starts and stops them."""

from __future__ import annotations

import asyncio
import contextlib
import http
import ipaddress
import logging
import socket
from collections.abc import Callable, Coroutine
from dataclasses import dataclass
from pathlib import Path
from urllib.parse import parse_qs, urlsplit

from websockets.asyncio.server import Server, ServerConnection, serve
from websockets.http11 import Request, Response

from .desk_server import DeskSession
from .errors import BridgeError, StoreError
from .fleet import Fleet
from .links.sql import SqlLink
from .links.websocket import WebSocketLink
from .messages import MessageError, check_robot_name
from .site_maps import SiteMaps
from .sites.publication import read_site
from .store.database import Database

log = logging.getLogger(__name__)

LARGEST_FRAME = 1 << 20
AGE_INTERVAL = 0.25
SAVE_INTERVAL = 1.0


@dataclass(frozen=True)
class GatewaySettings:
    """What a gateway is started with; port 0 takes any free one."""

    site: Path
    database: str
    host: str = "127.0.0.1"
    port: int = 8765


class Gateway:
    """One site, one database, one port with ``/robot`` and ``/desk``."""

    def __init__(self, fleet: Fleet, database: Database) -> None:
        self._fleet = fleet
        self._database = database
        self._robots = WebSocketLink(fleet)

    async def serve(self, host: str, port: int) -> Server:
        """Listen; browsers are refused, since any page they show could reach a local port."""
        try:
            return await serve(
                self._connected,
                host,
                port,
                process_request=self._check_path,
                origins=[None],
                max_size=LARGEST_FRAME,
                compression=None,
                ping_interval=5,
                ping_timeout=5,
            )
        except OSError as error:
            raise BridgeError(
                f"cannot listen on {host}:{port}: {error.strerror or error}; "
                "choose another --port, or 0 for any"
            ) from error

    async def watch(self) -> None:
        """Keep liveness, trajectories, expiry and the SQL link going until cancelled."""
        async with asyncio.TaskGroup() as tasks:
            tasks.create_task(SqlLink(self._fleet, self._database).run())
            tasks.create_task(self._age())
            tasks.create_task(self._save())

    async def _age(self) -> None:
        while True:
            self._fleet.age()
            await asyncio.sleep(AGE_INTERVAL)

    async def _save(self) -> None:
        while True:
            await asyncio.sleep(SAVE_INTERVAL)
            try:
                await self._fleet.save()
            except StoreError as error:
                log.error("%s; positions are kept and stored later", error)

    def _check_path(self, connection: ServerConnection, request: Request) -> Response | None:
        path = urlsplit(request.path).path
        if path not in ("/robot", "/desk"):
            text = f"{path} is not served here; robots connect to /robot, operators to /desk\n"
            return connection.respond(http.HTTPStatus.NOT_FOUND, text)
        try:
            _robot_name(request.path)
        except MessageError as error:
            return connection.respond(http.HTTPStatus.BAD_REQUEST, f"{error}\n")
        return None

    async def _connected(self, connection: ServerConnection) -> None:
        assert connection.request is not None
        if urlsplit(connection.request.path).path == "/desk":
            await DeskSession(self._fleet, connection).run()
        else:
            await self._robots.serve(connection, _robot_name(connection.request.path))


async def run(settings: GatewaySettings, stop: asyncio.Event, started: Callable[[str], None]) -> None:
    """Run a gateway until ``stop`` is set; ``started`` is called with its address, ``ws://host:port``.

    :raises BridgeError: when it may not listen there; SiteError and StoreError for its site and database.
    """
    check_loopback(settings.host)
    site = await asyncio.to_thread(read_site, settings.site)
    async with contextlib.AsyncExitStack() as stack:
        database = Database(settings.database)
        stack.push_async_callback(database.close)
        await database.open()
        fleet = Fleet(SiteMaps(site), database)
        await fleet.start()
        stack.push_async_callback(fleet.finish_trajectories)
        gateway = Gateway(fleet, database)
        server = await gateway.serve(settings.host, settings.port)
        stack.push_async_callback(_close, server)
        started(_address(server))
        await _until_stopped(gateway.watch(), stop)


async def _until_stopped(watch: Coroutine[None, None, None], stop: asyncio.Event) -> None:
    """Run ``watch`` until ``stop`` is set; what it raises ends the gateway."""
    watching, stopping = asyncio.create_task(watch), asyncio.create_task(stop.wait())
    await asyncio.wait({watching, stopping}, return_when=asyncio.FIRST_COMPLETED)
    if watching.done():
        stopping.cancel()
        await watching
    watching.cancel()
    await asyncio.gather(watching, return_exceptions=True)


async def _close(server: Server) -> None:
    server.close()
    with contextlib.suppress(TimeoutError):
        await asyncio.wait_for(server.wait_closed(), 3)


def check_loopback(host: str) -> None:
    """Refuse to listen beyond this computer: there is no TLS yet. Raises BridgeError."""
    try:
        address = ipaddress.ip_address("127.0.0.1" if host == "localhost" else host)
    except ValueError:
        raise BridgeError(f"host {host!r} is not an IP address; use 127.0.0.1 or ::1") from None
    if not address.is_loopback:
        raise BridgeError(
            f"host {host} can be reached from other computers, and the gateway speaks without TLS; "
            "use 127.0.0.1, and let robots in through a tunnel such as SSH"
        )


def _robot_name(path: str) -> str | None:
    names = parse_qs(urlsplit(path).query).get("robot")
    return check_robot_name(names[0]) if names else None


def _address(server: Server) -> str:
    sock = next(iter(server.sockets))
    host, port = sock.getsockname()[:2]
    return f"ws://[{host}]:{port}" if sock.family == socket.AF_INET6 else f"ws://{host}:{port}"
