"""The gateway's URL, and what a failure to reach it means."""

from __future__ import annotations

import socket
import ssl
from types import ModuleType
from urllib.parse import urlsplit

from ..errors import AddressError, LinkError

DEFAULT_URL = "ws://127.0.0.1:8765/desk"


def check_address(url: str) -> str:
    """Return ``url`` without blanks around it if it can be a gateway's, else raise AddressError."""
    url = url.strip()
    example = f"Write it like {DEFAULT_URL}."
    if not url:
        raise AddressError(f"The gateway's URL is empty. {example}")
    try:
        parts = urlsplit(url)
        host, port = parts.hostname, parts.port
    except ValueError as error:
        raise AddressError(f"The gateway's URL {url} cannot be read: {error}. {example}") from error
    if parts.scheme not in ("ws", "wss"):
        raise AddressError(
            f"The gateway's URL {url} begins with {parts.scheme or 'no scheme'}; a gateway is reached over "
            f"ws:// (or wss:// with TLS). {example}"
        )
    if not host or any(c.isspace() for c in url):
        raise AddressError(f"The gateway's URL {url} names no host. {example}")
    if port == 0:
        raise AddressError(f"The gateway's URL {url} has port 0, where nothing can listen. {example}")
    return url


def explain(error: Exception, url: str, exceptions: ModuleType) -> LinkError | None:
    """Return what a failed or ended link means, in the operator's words; None when it is not known.

    ``exceptions`` is the module of the websockets package in use.
    """
    place = _place(url)
    if isinstance(error, exceptions.InvalidStatus):
        return _bad_status(error.response.status_code, url)
    if isinstance(error, (exceptions.InvalidHandshake, exceptions.ProtocolError, EOFError)):
        return LinkError(
            f"What answers at {place} does not speak WebSocket. Check host and port: a gateway prints its "
            "URL when it starts."
        )
    if isinstance(error, exceptions.ConnectionClosed):
        return _closed(error, place)
    if isinstance(error, exceptions.InvalidURI):
        return LinkError(f"The gateway's URL {url} cannot be used. Write it like {DEFAULT_URL}.", final=True)
    return _network_failure(error, place)


def _place(url: str) -> str:
    parts = urlsplit(url)
    return f"{parts.hostname}:{parts.port or (443 if parts.scheme == 'wss' else 80)}"


def _bad_status(status: int, url: str) -> LinkError:
    if status == 404:
        return LinkError(
            f"There is no desk at {url} (HTTP 404). A gateway's desk has the path /desk, "
            f"as in {DEFAULT_URL}; or another program answers there."
        )
    if status in (401, 403):
        return LinkError(
            f"{url} refuses this desk (HTTP {status}). Ask whoever runs the site for access.", final=True
        )
    return LinkError(
        f"{url} answered HTTP {status} instead of opening a WebSocket. Check that a gateway runs there and "
        "what its log says."
    )


def _closed(error: Exception, place: str) -> LinkError:
    received = getattr(error, "rcvd", None)
    if received is None:
        return LinkError(
            f"The link to the gateway at {place} broke off. It is tried again by itself; if it does not come "
            "back, check the gateway and the network."
        )
    why = f": {received.reason}" if received.reason else ""
    return LinkError(
        f"The gateway at {place} closed the link (code {received.code}{why}). It is tried again by itself."
    )


def _network_failure(error: Exception, place: str) -> LinkError | None:
    if isinstance(error, ssl.SSLError):
        return LinkError(
            f"No secure link to {place}: {error.reason or error}. Check the certificate, or use ws:// if the "
            "gateway has no TLS."
        )
    if isinstance(error, ConnectionRefusedError) or "Connect call failed" in str(error):
        return LinkError(
            f"Nothing listens at {place}. Start the gateway (robot-bridge serve --site ...) or correct the "
            "URL."
        )
    if isinstance(error, socket.gaierror):
        return LinkError(f"The host of {place} is not known to this network. Correct the URL.")
    if isinstance(error, TimeoutError):
        return LinkError(
            f"{place} did not answer in time. Check that the gateway runs, and the network and firewall."
        )
    if isinstance(error, OSError):
        return LinkError(f"{place} cannot be reached: {error.strerror or error}. Check network and URL.")
    return None
