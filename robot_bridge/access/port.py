"""The gateway's port: how it is listened on, with the limits that hold before anybody is let in."""

from __future__ import annotations

import http
import logging
import resource
import ssl
from collections.abc import Awaitable, Callable
from functools import partial
from typing import Any, cast
from urllib.parse import urlsplit

from websockets.asyncio.server import Server, ServerConnection, serve
from websockets.frames import CloseCode
from websockets.http11 import Request, Response

from ..errors import BridgeError
from ..monitoring.unforeseen import note_unforeseen
from ..sites.limit_settings import LimitSettings
from .gate import Gate
from .tokens import chosen_protocol
from .visitor import Visitor

log = logging.getLogger(__name__)

PING_INTERVAL = 5.0
WRITE_LIMIT = 65_536
"""bytes that wait in this process for a client before whoever sends to it has to wait too."""

SPARE_FILES = 512
"""Files and connections to the database."""
ONE_ADDRESS = 65_536
"""Connections that one address can have open with this port: silent ones are not to take the last file."""

BACKLOG = 1024
"""Connections that wait to be taken: a whole fleet comes back in one moment when the gateway was away."""

Handler = Callable[[Visitor], Awaitable[None]]
Doorman = Callable[[Visitor, Request], Awaitable[Response | None]]


async def listen(
    gate: Gate, host: str, port: int, context: ssl.SSLContext | None, doorman: Doorman, handler: Handler
) -> Server:
    """Listen; ``doorman`` tells who is let in, and ``handler`` serves them.

    :raises BridgeError: when the address cannot be listened on.
    """
    _allow_connections(gate.limits)
    try:
        return await serve(
            cast("Callable[[ServerConnection], Awaitable[None]]", partial(_serve, handler)),
            host,
            port,
            ssl=context,
            select_subprotocol=cast("Any", lambda _visitor, offered: chosen_protocol(offered)),
            process_request=cast("Any", partial(_ask, doorman)),
            create_connection=cast("type[ServerConnection]", partial(Visitor, gate)),
            backlog=BACKLOG,
            open_timeout=gate.limits.handshake_s,
            max_size=gate.limits.largest_message_bytes,
            write_limit=WRITE_LIMIT,
            compression=None,
            server_header=None,
            ping_interval=PING_INTERVAL,
            ping_timeout=gate.limits.stuck_s,
        )
    except OSError as error:
        raise BridgeError(
            f"cannot listen on {host}:{port}: {error.strerror or error}; choose another --port, or 0 for any"
        ) from error


def _allow_connections(limits: LimitSettings) -> None:
    """Let this process hold so many connections beside its files, as far as the system allows."""
    soft, hard = resource.getrlimit(resource.RLIMIT_NOFILE)
    needed = limits.robots + limits.desks + limits.pending_per_address + SPARE_FILES
    wanted = needed + ONE_ADDRESS
    if hard != resource.RLIM_INFINITY:
        wanted = min(wanted, hard)
    if soft < wanted:
        resource.setrlimit(resource.RLIMIT_NOFILE, (wanted, hard))
        soft = wanted
    if soft < needed:
        log.warning("the system allows %d open files, fewer than the limits of the site take", soft)


async def _ask(doorman: Doorman, visitor: Visitor, request: Request) -> Response | None:
    """Ask whether a visitor is let in; who meets a fault of the gateway's stays outside."""
    if not _is_path(request.path):
        return visitor.respond(http.HTTPStatus.BAD_REQUEST, "The path of the request cannot be read.\n")
    try:
        return await doorman(visitor, request)
    except Exception:
        text = note_unforeseen(log, f"somebody from {visitor.address}")
        return visitor.respond(http.HTTPStatus.INTERNAL_SERVER_ERROR, f"{text}\n")


def _is_path(path: str) -> bool:
    try:
        urlsplit(path)
    except ValueError:
        return False
    return path.isascii() and path.isprintable()


async def _serve(handler: Handler, visitor: Visitor) -> None:
    """Serve one connection; what goes wrong in that ends it alone, and is told to the log alone."""
    try:
        await handler(visitor)
    except Exception:
        text = note_unforeseen(log, f"{visitor.who} from {visitor.address}")
        await visitor.expel(CloseCode.INTERNAL_ERROR, text)
