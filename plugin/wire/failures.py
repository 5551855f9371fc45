"""What a failure to reach the gateway means, in the operator's words."""

from __future__ import annotations

import socket
import ssl
from types import ModuleType
from typing import Any
from urllib.parse import urlsplit

from ..errors import LinkError
from ..language import tr
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
            tr(
                "What answers at {place} does not speak WebSocket. Check host and port, and ws:// or "
                "wss://: a gateway prints its URL when it starts.",
                place=place,
            )
        )
    if isinstance(error, exceptions.ConnectionClosed):
        return _closed(error, place)
    if isinstance(error, exceptions.InvalidURI):
        return LinkError(
            tr(
                "The gateway's URL {url} cannot be used. Write it like {default_url}.",
                url=url,
                default_url=DEFAULT_URL,
            ),
            final=True,
        )
    return _network_failure(error, place, secure=urlsplit(url).scheme == "wss")


def _place(url: str) -> str:
    parts = urlsplit(url)
    return f"{parts.hostname}:{parts.port or (443 if parts.scheme == 'wss' else 80)}"


def _bad_status(response: Any, url: str) -> LinkError:
    status, said = response.status_code, _said(response)
    if status == 404:
        return LinkError(
            tr(
                "There is no desk at {url} (HTTP 404). A gateway's desk has the path /desk, as in "
                "{default_url}; or another program answers there.",
                url=url,
                default_url=DEFAULT_URL,
            )
        )
    if status == 401:
        return LinkError(
            tr(
                "{url} refuses this desk: {said} Enter the operator's token under Access.",
                url=url,
                said=said or tr("it wants a token."),
            ),
            final=True,
            wants_token=True,
        )
    if status == 403:
        return LinkError(
            tr("{url} refuses this desk: {said}", url=url, said=said or tr("no reason given.")),
            final=True,
        )
    if status in (429, 503) and said:
        return LinkError(
            tr("{url} takes no desk now: {said} It is tried again by itself.", url=url, said=said)
        )
    return LinkError(
        tr(
            "{url} answered HTTP {status} instead of opening a WebSocket. Check that a gateway runs there "
            "and what its log says.",
            url=url,
            status=status,
        )
    )


def _closed(error: Exception, place: str) -> LinkError:
    received = getattr(error, "rcvd", None)
    if received is None:
        return LinkError(
            tr(
                "The link to the gateway at {place} broke off. It is tried again by itself; if it does not "
                "come back, check the gateway and the network.",
                place=place,
            )
        )
    why = f": {received.reason}" if received.reason else ""
    if received.code == REVOKED:
        return LinkError(
            tr(
                "The gateway at {place} ended the link{why}. Ask whoever runs the site for a new token and "
                "enter it under Access.",
                place=place,
                why=why,
            ),
            final=True,
            wants_token=True,
        )
    if received.code == ENDED:
        return LinkError(
            tr(
                "The gateway at {place} ended your session{why}. Connect brings it back.",
                place=place,
                why=why,
            ),
            final=True,
        )
    return LinkError(
        tr(
            "The gateway at {place} closed the link (code {code}{why}). It is tried again by itself.",
            place=place,
            code=received.code,
            why=why,
        )
    )


def _bad_certificate(error: ssl.SSLCertVerificationError, place: str) -> LinkError:
    code = error.verify_code
    if code in _UNKNOWN_AUTHORITY:
        return LinkError(
            tr(
                "The certificate of {place} is from an authority that this desk does not trust. Choose the "
                "site's ca.pem as CA file under Access; whoever runs the site has it.",
                place=place,
            ),
            final=True,
            wants_token=True,
        )
    if code in _OTHER_NAME:
        return LinkError(
            tr(
                "The certificate of {place} is for another name: {reason} Use the name that the "
                "gateway's certificate was made for, or have one made for this name.",
                place=place,
                reason=error.verify_message,
            ),
            final=True,
        )
    if code == _EXPIRED:
        return LinkError(
            tr(
                "The certificate of {place} has expired. Whoever runs the site renews it with 'robot-bridge "
                "tls renew'; if it was renewed, check this computer's clock.",
                place=place,
            )
        )
    if code == _NOT_YET_VALID:
        return LinkError(
            tr("The certificate of {place} holds only later: check this computer's clock.", place=place)
        )
    return LinkError(
        tr(
            "The certificate of {place} cannot be trusted: {reason}.",
            place=place,
            reason=error.verify_message,
        ),
        final=True,
    )


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
            tr(
                "No secure link to {place}: {reason}. If the gateway has no TLS, write ws:// instead of "
                "wss://.",
                place=place,
                reason=error.reason or error,
            )
        )
    if isinstance(error, ConnectionRefusedError) or "Connect call failed" in str(error):
        return LinkError(
            tr(
                "Nothing listens at {place}. Start the gateway (robot-bridge serve --site ...) or correct "
                "the URL.",
                place=place,
            )
        )
    if isinstance(error, socket.gaierror):
        return LinkError(
            tr("The host of {place} is not known to this network. Correct the URL.", place=place)
        )
    if secure and isinstance(error, ConnectionResetError):
        return LinkError(
            tr(
                "{place} broke off while the secure link was made. If the gateway has no TLS, write ws:// "
                "instead of wss://.",
                place=place,
            )
        )
    if isinstance(error, TimeoutError):
        return LinkError(
            tr(
                "{place} did not answer in time. Check that the gateway runs, and the network and firewall.",
                place=place,
            )
        )
    if isinstance(error, OSError):
        return LinkError(
            tr(
                "{place} cannot be reached: {reason}. Check network and URL.",
                place=place,
                reason=error.strerror or error,
            )
        )
    return None
