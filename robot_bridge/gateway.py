"""The gateway: puts the parts together, starts and stops them."""

from __future__ import annotations

import asyncio
import contextlib
import http
import logging
import socket
import time
from collections.abc import Callable, Coroutine
from dataclasses import dataclass
from pathlib import Path
from urllib.parse import parse_qs, urlsplit

from sqlalchemy import URL
from websockets.asyncio.server import Server
from websockets.http11 import Request, Response

from .access.gate import Gate
from .access.port import listen
from .access.reach import check_reach, is_loopback
from .access.tls import ServerFiles, ServerTls
from .access.tokens import TokenKind
from .access.visitor import Visitor
from .desk_server import DeskSession
from .errors import StoreError
from .fleet import Fleet
from .links.sql import SqlLink
from .links.websocket import WebSocketLink
from .messages import MessageError, check_robot_name
from .schemas.documents import served
from .site_maps import SiteMaps
from .sites.publication import read_site
from .store.database import Database

log = logging.getLogger(__name__)

AGE_INTERVAL = 0.25
SAVE_INTERVAL = 1.0


@dataclass(frozen=True)
class GatewaySettings:
    """What a gateway is started with; port 0 takes any free one."""

    site: Path
    database: str | URL
    host: str = "127.0.0.1"
    port: int = 8765
    tls: ServerFiles | None = None


class Gateway:
    """One site, one database, one port with ``/robot`` and ``/desk``."""

    def __init__(self, fleet: Fleet, database: Database, gate: Gate, tls: ServerTls | None = None) -> None:
        self._fleet = fleet
        self._database = database
        self._gate = gate
        self._tls = tls
        self._robots = WebSocketLink(fleet)

    async def serve(self, host: str, port: int) -> Server:
        """Listen for robots and operators; raises BridgeError when that cannot be done there."""
        context = self._tls.context if self._tls else None
        return await listen(self._gate, host, port, context, self._admit, self._connected)

    async def watch(self) -> None:
        """Keep liveness, trajectories, expiry and the SQL link going until cancelled."""
        async with asyncio.TaskGroup() as tasks:
            tasks.create_task(SqlLink(self._fleet, self._database).run())
            tasks.create_task(self._age())
            tasks.create_task(self._save())
            tasks.create_task(self._gate.watch())
            tasks.create_task(self._gate.journal.run())
            if self._tls is not None:
                tasks.create_task(self._tls.watch())

    async def _age(self) -> None:
        while True:
            self._fleet.age()
            self._robots.measure()
            await asyncio.sleep(AGE_INTERVAL)

    async def _save(self) -> None:
        while True:
            await asyncio.sleep(SAVE_INTERVAL)
            try:
                await self._fleet.save()
            except StoreError as error:
                log.error("%s; positions are kept and stored later", error)

    async def _admit(self, visitor: Visitor, request: Request) -> Response | None:
        if (refusal := self._gate.refuse_page(visitor, request)) is not None:
            return refusal
        path = urlsplit(request.path).path
        if (document := served(path)) is not None:
            response = visitor.respond(http.HTTPStatus.OK, document)
            del response.headers["Content-Type"]
            response.headers["Content-Type"] = "application/json"
            return response
        if path not in ("/robot", "/desk"):
            text = f"{path} is not served here; robots connect to /robot, operators to /desk\n"
            return visitor.respond(http.HTTPStatus.NOT_FOUND, text)
        try:
            name = _robot_name(request.path)
        except MessageError as error:
            return visitor.respond(http.HTTPStatus.BAD_REQUEST, f"{error}\n")
        kind = TokenKind.OPERATOR if path == "/desk" else TokenKind.ROBOT
        return await self._gate.admit(visitor, request, kind, name, self._largest_message(kind))

    def _largest_message(self, kind: TokenKind) -> int:
        largest = self._gate.limits.largest_message_bytes
        if kind is TokenKind.OPERATOR:
            return largest
        # An image travels as base64, four bytes for three, with its parameters beside it.
        image = self._fleet.site.settings.observations.largest_image_bytes
        return max(largest, image * 4 // 3 + 65_536)

    async def _connected(self, visitor: Visitor) -> None:
        assert visitor.identity is not None
        if visitor.identity.kind is TokenKind.OPERATOR:
            await DeskSession(self._fleet, visitor, self._gate).run()
        else:
            await self._robots.serve(visitor, visitor.identity.name)


async def run(settings: GatewaySettings, stop: asyncio.Event, started: Callable[[str], None]) -> None:
    """Run a gateway until ``stop`` is set; ``started`` is called with its address, ``ws://host:port``.

    :raises BridgeError: when it may not listen there; SiteError and StoreError for its site and database.
    """
    tls = ServerTls(settings.tls) if settings.tls else None
    site = await asyncio.to_thread(read_site, settings.site)
    async with contextlib.AsyncExitStack() as stack:
        database = Database(settings.database)
        stack.push_async_callback(database.close)
        await database.open()
        gate = Gate(database, site.settings.limits, may_be_open=is_loopback(settings.host))
        await gate.open()
        accounts = gate.book.has_operator(time.time())
        check_reach(settings.host, tls=tls is not None, accounts=accounts)
        fleet = Fleet(SiteMaps(site), database)
        await fleet.start()
        stack.push_async_callback(fleet.finish_trajectories)
        stack.push_async_callback(gate.close)
        gateway = Gateway(fleet, database, gate, tls)
        server = await gateway.serve(settings.host, settings.port)
        stack.push_async_callback(_close, server)
        started(_address(server, tls is not None))
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


def _robot_name(path: str) -> str | None:
    names = parse_qs(urlsplit(path).query).get("robot")
    return check_robot_name(names[0]) if names else None


def _address(server: Server, tls: bool) -> str:
    sock = next(iter(server.sockets))
    host, port = sock.getsockname()[:2]
    scheme = "wss" if tls else "ws"
    return f"{scheme}://[{host}]:{port}" if sock.family == socket.AF_INET6 else f"{scheme}://{host}:{port}"
