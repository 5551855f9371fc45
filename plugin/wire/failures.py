"""What a failure to reach the gateway means, in the operator's words."""

from __future__ import annotations

import socket
import ssl
from types import ModuleType
from typing import Any
from urllib.parse import urlsplit

from ..errors import LinkError
from .addresses import DEFAULT_URL

REVOKED = 4003
ENDED = 4004
"""Close codes of the gateway: the token does not hold any more; a supervisor ended the session."""
_UNKNOWN_AUTHORITY = {18, 19, 20, 21}
_OTHER_NAME = {62, 64}
_NOT_YET_VALID, _EXPIRED = 9, 10
"""OpenSSL's numbers of what is wrong with a certificate (X509_V_ERR_...)."""


def explain(error: Exception, url: str, exceptions: ModuleType) -> LinkError | None:
    """Return what a failed or ended link means, in the operator's words; None when it is not known.

    ``exceptions`` is the module of the websockets package in use.
    """
    place = _place(url)
    if isinstance(error, exceptions.InvalidStatus):
        return _bad_status(error.response, url)
    if isinstance(error, (exceptions.InvalidHandshake, exceptions.ProtocolError, EOFError)):
        return LinkError(
            f"What answers at {place} does not speak WebSocket. Check host and port, and ws:// or wss://: a "
            "gateway prints its URL when it starts."
        )
    if isinstance(error, exceptions.ConnectionClosed):
        return _closed(error, place)
    if isinstance(error, exceptions.InvalidURI):
        return LinkError(f"The gateway's URL {url} cannot be used. Write it like {DEFAULT_URL}.", final=True)
    return _network_failure(error, place, secure=urlsplit(url).scheme == "wss")


def _place(url: str) -> str:
    parts = urlsplit(url)
    return f"{parts.hostname}:{parts.port or (443 if parts.scheme == 'wss' else 80)}"


def _bad_status(response: Any, url: str) -> LinkError:
    status, said = response.status_code, _said(response)
    if status == 404:
        return LinkError(
            f"There is no desk at {url} (HTTP 404). A gateway's desk has the path /desk, "
            f"as in {DEFAULT_URL}; or another program answers there."
        )
    if status == 401:
        return LinkError(
            f"{url} refuses this desk: {said or 'it wants a token'} Enter the operator's token under Access.",
            final=True,
            wants_token=True,
        )
    if status == 403:
        return LinkError(f"{url} refuses this desk: {said or 'no reason given.'}", final=True)
    if status in (429, 503) and said:
        return LinkError(f"{url} takes no desk now: {said} It is tried again by itself.")
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
    if received.code == REVOKED:
        return LinkError(
            f"The gateway at {place} ended the link{why}. Ask whoever runs the site for a new token and "
            "enter it under Access.",
            final=True,
            wants_token=True,
        )
    if received.code == ENDED:
        return LinkError(
            f"The gateway at {place} ended your session{why}. Connect brings it back.", final=True
        )
    return LinkError(
        f"The gateway at {place} closed the link (code {received.code}{why}). It is tried again by itself."
    )


def _bad_certificate(error: ssl.SSLCertVerificationError, place: str) -> LinkError:
    code = error.verify_code
    if code in _UNKNOWN_AUTHORITY:
        return LinkError(
            f"The certificate of {place} is from an authority that this desk does not trust. Choose the "
            "site's ca.pem as CA file under Access; whoever runs the site has it.",
            final=True,
            wants_token=True,
        )
    if code in _OTHER_NAME:
        return LinkError(
            f"The certificate of {place} is for another name: {error.verify_message} Use the name that the "
            "gateway's certificate was made for, or have one made for this name.",
            final=True,
        )
    if code == _EXPIRED:
        return LinkError(
            f"The certificate of {place} has expired. Whoever runs the site renews it with 'robot-bridge tls "
            "renew'; if it was renewed, check this computer's clock."
        )
    if code == _NOT_YET_VALID:
        return LinkError(f"The certificate of {place} holds only later: check this computer's clock.")
    return LinkError(f"The certificate of {place} cannot be trusted: {error.verify_message}.", final=True)


def _said(response: Any) -> str:
    """Return the gateway's own words, which are one line of plain text."""
    if not str(response.headers.get("Content-Type", "")).startswith("text/plain"):
        return ""
    text = bytes(response.body or b"").decode("utf-8", "replace").strip()
    return text[:300] if text.isprintable() else ""


def _network_failure(error: Exception, place: str, *, secure: bool) -> LinkError | None:
    if isinstance(error, ssl.SSLCertVerificationError):
        return _bad_certificate(error, place)
    if isinstance(error, ssl.SSLError):
        return LinkError(
            f"No secure link to {place}: {error.reason or error}. If the gateway has no TLS, write ws:// "
            "instead of wss://."
        )
    if isinstance(error, ConnectionRefusedError) or "Connect call failed" in str(error):
        return LinkError(
            f"Nothing listens at {place}. Start the gateway (robot-bridge serve --site ...) or correct the "
            "URL."
        )
    if isinstance(error, socket.gaierror):
        return LinkError(f"The host of {place} is not known to this network. Correct the URL.")
    if secure and isinstance(error, ConnectionResetError):
        return LinkError(
            f"{place} broke off while the secure link was made. If the gateway has no TLS, write ws:// "
            "instead of wss://."
        )
    if isinstance(error, TimeoutError):
        return LinkError(
            f"{place} did not answer in time. Check that the gateway runs, and the network and firewall."
        )
    if isinstance(error, OSError):
        return LinkError(f"{place} cannot be reached: {error.strerror or error}. Check network and URL.")
    return None
