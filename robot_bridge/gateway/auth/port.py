"""The gateway's port: address and names, TLS, and the limits before authorisation."""

from __future__ import annotations

import asyncio
import datetime
import http
import ipaddress
import logging
import resource
import ssl
import stat
import sys
import time
from collections.abc import Awaitable, Callable, Collection, Iterable
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any, cast
from urllib.parse import urlsplit

from websockets.asyncio.server import Server, ServerConnection, serve
from websockets.datastructures import Headers
from websockets.frames import CloseCode
from websockets.http11 import Request, Response

from ...core.errors import AccessError, BridgeError, counted
from ...core.logs import log_unforeseen
from ...core.sites.settings_tables import LimitSettings
from .accounts import chosen_protocol
from .authorisation import AuthGate
from .client_connection import ClientConnection

log = logging.getLogger(__name__)

# --- Reach of a gateway: loopback only, unless it has TLS and accounts ---


def is_loopback(host: str) -> bool:
    """Return whether an address to listen on is this computer's own; raises AccessError if invalid."""
    try:
        return ipaddress.ip_address("127.0.0.1" if host == "localhost" else host).is_loopback
    except ValueError:
        raise AccessError(
            f"host {host!r} is not an IP address; use 127.0.0.1, or 0.0.0.0 for every IPv4 address of this "
            "computer"
        ) from None


def address_here(host: str) -> str:
    """Return the address by which this computer reaches a listener on ``host``."""
    return {"0.0.0.0": "127.0.0.1", "::": "::1"}.get(host, host)  # nosec B104 # read, not listened on


def check_reach(host: str, *, tls: bool, accounts: bool) -> None:
    """Refuse to listen beyond this computer without TLS and an operator's account; raises AccessError."""
    if is_loopback(host):
        return
    if not tls:
        raise AccessError(
            f"host {host} can be reached from other computers, and without TLS everybody on the way reads "
            "along; make certificates with 'robot-bridge tls create DIR --name HOST' and give --certificate "
            "and --key, or use 127.0.0.1"
        )
    if not accounts:
        raise AccessError(
            f"host {host} can be reached from other computers, and no operator has an account; make one with "
            "'robot-bridge operators add NAME --role supervisor', or use 127.0.0.1"
        )


# --- Host names in requests for the gateway's pages ---
# A web page somewhere can have its own name resolved to this computer's address (DNS rebinding), and its
# script may then read the pages served here as if they were its own. Such a request names the page's host in
# ``Host``.

LOCAL = ("localhost", "localhost.localdomain", "ip6-localhost")
_SHOWN = 80
"""characters of a host shown in the answer."""


def host_fault(headers: Iterable[str], names: Collection[str]) -> str | None:
    """Return why a request with these ``Host`` headers is refused, None for one addressed to this gateway.

    Accepted are an address, this computer, or one of ``names``, where ``*.example.org`` stands for one label
    in front. An address is not a name that somebody else could have resolved to ours.
    """
    hosts = list(headers)
    if not hosts:
        # No browser omits it.
        return None
    if len(hosts) > 1:
        return "the request has several Host headers; send one"
    host = _name_in(hosts[0])
    if host is not None and (_is_address(host) or host in LOCAL or any(_fits(host, name) for name in names)):
        return None
    return (
        f"Host {hosts[0][:_SHOWN]!r} is no name of this gateway; ask by its address, or have whoever runs "
        "the site name it under 'hosts' in [limits] of site.toml"
    )


def _name_in(host: str) -> str | None:
    try:
        return (urlsplit(f"//{host}").hostname or "").rstrip(".").lower() or None
    except ValueError:
        return None


def _is_address(host: str) -> bool:
    try:
        ipaddress.ip_address(host)
    except ValueError:
        return False
    return True


def _fits(host: str, name: str) -> bool:
    name = name.lower().rstrip(".")
    return host == name or (name.startswith("*.") and host.partition(".")[2] == name[2:])


# --- TLS for the port: its certificate, reloaded when the files change ---

CIPHERS = "ECDHE+AESGCM:ECDHE+CHACHA20"
"""TLS 1.2 only with forward secrecy and authenticated encryption; TLS 1.3 has nothing else."""
WATCH_INTERVAL = 2.0
WARN_DAYS = 30
WARN_INTERVAL = 86400.0
"""seconds between checks of the certificate's expiry: a gateway runs for longer than one is valid."""


@dataclass(frozen=True)
class ServerFiles:
    """The gateway's certificate (with its chain) and its key, in PEM."""

    certificate: Path
    key: Path


def server_files(certificate: Path | None, key: Path | None) -> ServerFiles | None:
    """Return both files, None if neither is given; raises AccessError for one alone."""
    if certificate is None and key is None:
        return None
    if certificate is None or key is None:
        raise AccessError("a certificate goes with its key; give both --certificate and --key, or neither")
    return ServerFiles(certificate, key)


class ServerTls:
    """The gateway's TLS: its context, with a new certificate whenever the files change."""

    def __init__(self, files: ServerFiles) -> None:
        """Read the files; raises AccessError when they cannot be used."""
        self._files = files
        self._seen = _stamps(files)
        self.context = _server_context(files)
        self.until, self.names = _validity(files.certificate)
        """End of the certificate's validity, and the names that it is valid for."""
        self._warn_of_expiry()

    def reload(self) -> bool:
        """Load the present certificate for new connections; return whether it can be used.

        One that cannot be used changes nothing.
        """
        try:
            _server_context(self._files)
            self.context.load_cert_chain(self._files.certificate, self._files.key)
            self.until, self.names = _validity(self._files.certificate)
        except (AccessError, OSError) as error:
            log.error("%s; the certificate in use stays", error)
            return False
        self._warn_of_expiry()
        log.info("took the new certificate %s", self._files.certificate)
        return True

    async def watch(self) -> None:
        """Reload whenever the files change, and warn once a day of a near expiry, until cancelled."""
        warned_at = time.monotonic()
        while True:
            await asyncio.sleep(WATCH_INTERVAL)
            if time.monotonic() - warned_at >= WARN_INTERVAL:
                warned_at = time.monotonic()
                self._warn_of_expiry()
            stamps = _stamps(self._files)
            if stamps != self._seen:
                # The files are written one after the other: wait until they no longer change.
                await asyncio.sleep(WATCH_INTERVAL / 4)
                if stamps == _stamps(self._files):
                    self._seen = stamps
                    self.reload()

    def _warn_of_expiry(self) -> None:
        left = self.until - datetime.datetime.now(datetime.timezone.utc)
        if left < datetime.timedelta(days=WARN_DAYS):
            log.warning(
                "certificate %s %s; 'robot-bridge tls renew' makes a new one",
                self._files.certificate,
                f"holds for {counted(left.days, 'day')} more" if left.days >= 0 else "has expired",
            )


def _server_context(files: ServerFiles) -> ssl.SSLContext:
    context = ssl.SSLContext(ssl.PROTOCOL_TLS_SERVER)
    context.minimum_version = ssl.TLSVersion.TLSv1_2
    context.options |= ssl.OP_NO_COMPRESSION | ssl.OP_NO_RENEGOTIATION | ssl.OP_CIPHER_SERVER_PREFERENCE
    context.set_ciphers(CIPHERS)
    context.set_alpn_protocols(["http/1.1"])
    try:
        # An encrypted key would prompt for its password on a terminal, which a service lacks.
        context.load_cert_chain(files.certificate, files.key, password=_no_password)
    except ssl.SSLError as error:
        raise AccessError(
            f"certificate {files.certificate} and key {files.key} cannot be used: {error.reason or error}; "
            "both must be PEM, and belong to each other"
        ) from error
    except OSError as error:
        missing = next((f for f in (files.certificate, files.key) if not f.is_file()), files.key)
        raise AccessError(f"{missing} cannot be read: {error.strerror or error}") from error
    if sys.platform != "win32" and files.key.stat().st_mode & (stat.S_IRWXO | stat.S_IRGRP):
        log.warning("key %s can be read by others; chmod 600 keeps it to the gateway", files.key)
    return context


def _no_password() -> str:
    raise AccessError("the key is encrypted; give one that is not, readable to the gateway's account alone")


def _validity(certificate: Path) -> tuple[datetime.datetime, tuple[str, ...]]:
    """Return the end of a certificate's validity, and its names."""
    # A gateway without TLS starts without cryptography, which takes a tenth of the start to import.
    from .certificates import names_of, valid_until

    return valid_until(certificate), names_of(certificate)


def _stamps(files: ServerFiles) -> tuple[object, ...]:
    stamps: list[object] = []
    for file in (files.certificate, files.key):
        try:
            status = file.stat()
        except OSError:
            stamps.append(None)
        else:
            # Includes the time of the last change of owner or rights: it may be readable since then.
            stamps.append((status.st_mtime_ns, status.st_ctime_ns, status.st_ino, status.st_size))
    return tuple(stamps)


# --- The gateway's port: listening, with the limits before admission ---

PING_INTERVAL = 5.0
WRITE_LIMIT = 32_768
"""bytes buffered in this process for a client before its senders must wait: a stop is sent behind them."""

SPARE_FILES = 512
"""Number of files and database connections kept free."""
ONE_ADDRESS = 65_536
"""Connections that one address can have open with this port: silent ones must not use up all files."""

BACKLOG = 1024
"""Connections that wait to be accepted: a whole fleet reconnects in one moment after an outage."""

Handler = Callable[[ClientConnection], Awaitable[None]]
Doorman = Callable[[ClientConnection, Request], Awaitable[Response | None]]


async def listen(
    gate: AuthGate, host: str, port: int, context: ssl.SSLContext | None, doorman: Doorman, handler: Handler
) -> Server:
    """Listen; ``doorman`` decides on admission, and ``handler`` serves the admitted.

    :raises BridgeError: when listening on the address fails.
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
            create_connection=cast("type[ServerConnection]", partial(ClientConnection, gate)),
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


def files_needed(limits: LimitSettings) -> int:
    """Return the number of open files with all connections that a site allows."""
    return limits.robots + limits.desks + limits.pending_per_address + SPARE_FILES


def _allow_connections(limits: LimitSettings) -> None:
    """Raise this process's limit of open files for so many connections, as far as the system allows."""
    soft, hard = resource.getrlimit(resource.RLIMIT_NOFILE)
    needed = files_needed(limits)
    limit = needed + ONE_ADDRESS
    if hard != resource.RLIM_INFINITY:
        limit = min(limit, hard)
    if soft < limit:
        resource.setrlimit(resource.RLIMIT_NOFILE, (limit, hard))
        soft = limit
    if soft < needed:
        log.warning("the system allows %d open files, fewer than the limits of the site take", soft)


def http_response(status: http.HTTPStatus, body: bytes, headers: Iterable[tuple[str, str]]) -> Response:
    """Return the response of a page, after which its connection ends."""
    every = [*headers, ("X-Content-Type-Options", "nosniff"), ("Connection", "close")]
    if status != http.HTTPStatus.NOT_MODIFIED:
        every.append(("Content-Length", str(len(body))))
    return Response(status.value, status.phrase, Headers(every), body)


async def _ask(doorman: Doorman, connection: ClientConnection, request: Request) -> Response | None:
    """Ask whether a client is admitted; on an internal fault it is not."""
    if not _is_path(request.path):
        return connection.respond(http.HTTPStatus.BAD_REQUEST, "The path of the request cannot be read.\n")
    try:
        return await doorman(connection, request)
    except Exception:
        text = log_unforeseen(log, f"somebody from {connection.address}")
        return connection.respond(http.HTTPStatus.INTERNAL_SERVER_ERROR, f"{text}\n")


def _is_path(path: str) -> bool:
    try:
        urlsplit(path)
    except ValueError:
        return False
    return path.isascii() and path.isprintable()


async def _serve(handler: Handler, connection: ClientConnection) -> None:
    """Serve one connection; an error ends only that connection, and is only logged."""
    try:
        await handler(connection)
    except Exception:
        text = log_unforeseen(log, f"{connection.who} from {connection.address}")
        await connection.expel(CloseCode.INTERNAL_ERROR, text)
