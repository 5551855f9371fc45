"""Status of the link to the gateway: URL, operator's credentials, role, and failures as text."""

from __future__ import annotations

import errno
import os
import socket
import ssl
from dataclasses import dataclass, field
from enum import Enum
from types import ModuleType
from typing import Any
from urllib.parse import urlsplit

from ...robot_bridge.core.messages.base import Role, is_loopback
from ..ui.errors import AddressError, GatewayLinkError
from ..ui.language import tr

DEFAULT_URL = "ws://127.0.0.1:8765/desk"
DESK_PATH, ROBOTS_PATHS = "/desk", ("/robot", "/link")
"""Paths of the gateway; a proxy may have put others in front of them."""


@dataclass(frozen=True)
class OperatorCredentials:
    """The operator's token, and the CA file (PEM) for the gateway's certificate.

    Both are empty where not needed; without a file the authorities of the system are trusted.
    """

    token: str = field(default="", repr=False)
    ca_file: str = ""

    def options(self, url: str) -> dict[str, Any]:
        """Return the options for ``websockets`` to connect to ``url``, without TLS; raises AddressError."""
        self.check(url)
        options: dict[str, Any] = {}
        if self.token:
            options["additional_headers"] = {"Authorization": f"Bearer {self.token}"}
        return options

    def check(self, url: str) -> None:
        """Raise AddressError when the token cannot be used with ``url``; the CA file is not read."""
        parts = urlsplit(url)
        if self.token and (not self.token.isascii() or len(self.token.split()) != 1):
            raise AddressError(
                tr("The token cannot be right: it is one word. Paste it again, whole and alone.")
            )
        if parts.scheme == "ws" and self.token and not is_loopback(parts.hostname or ""):
            raise AddressError(
                tr(
                    "Over {url} everybody on the way could read the token. Write wss:// instead of ws://; a "
                    "gateway that other computers can reach has TLS.",
                    url=url,
                )
            )

    def tls_context(self) -> ssl.SSLContext:
        """Return a TLS context; reads the CA file, which may be on a share that does not answer.

        :raises AddressError: when the CA file cannot be used.
        """
        try:
            context = ssl.create_default_context(cafile=self.ca_file or None)
        except (OSError, ssl.SSLError) as error:
            raise AddressError(
                tr(
                    "The CA file {file} cannot be used: {reason}. Choose the ca.pem that whoever runs the "
                    "site gave you.",
                    file=self.ca_file,
                    reason=error.strerror or error,
                )
            ) from error
        context.minimum_version = ssl.TLSVersion.TLSv1_2
        return context


def uses_tls(url: str) -> bool:
    """Return whether the gateway at ``url`` is reached over TLS."""
    return urlsplit(url).scheme == "wss"


def check_address(url: str) -> str:
    """Return ``url`` stripped if it is valid for a gateway, else raise AddressError."""
    url = url.strip()
    example = tr("Write it like {default_url}.", default_url=DEFAULT_URL)
    if not url:
        raise AddressError(tr("The gateway's URL is empty. {example}", example=example))
    try:
        parts = urlsplit(url)
        host, port = parts.hostname, parts.port
    except ValueError as error:
        raise AddressError(
            tr(
                "The gateway's URL {url} cannot be read: {error}. {example}",
                url=url,
                error=error,
                example=example,
            )
        ) from error
    if parts.scheme not in ("ws", "wss"):
        raise AddressError(
            tr(
                "The gateway's URL {url} begins with {scheme}; a gateway is reached over ws:// (or wss:// "
                "with TLS). {example}",
                url=url,
                scheme=parts.scheme or tr("no scheme"),
                example=example,
            )
        )
    if not host or any(c.isspace() for c in url):
        raise AddressError(tr("The gateway's URL {url} names no host. {example}", url=url, example=example))
    if port == 0:
        raise AddressError(
            tr(
                "The gateway's URL {url} has port 0, where nothing can listen. {example}",
                url=url,
                example=example,
            )
        )
    path = parts.path.rstrip("/")
    if path.endswith(ROBOTS_PATHS):
        desk = url.replace(parts.path, path.rpartition("/")[0] + DESK_PATH)
        raise AddressError(
            tr(
                "{url} is where robots connect; operators connect to {desk}. Write that instead.",
                url=url,
                desk=desk,
            )
        )
    return url


ROLES = {
    Role.VIEWER: tr("viewer"),
    Role.OPERATOR: tr("operator"),
    Role.SUPERVISOR: tr("supervisor"),
}


def role_in_words(role: str) -> str:
    """Return the display name of a role given by its name on the wire; an unknown one unchanged."""
    return next((words for known, words in ROLES.items() if known.value == role), role)


class ConnectionPhase(str, Enum):
    """The stages of the link."""

    CLOSED = "closed"
    CONNECTING = "connecting"
    CONNECTED = "connected"
    RETRYING = "retrying"
    FAILED = "failed"


@dataclass(frozen=True)
class ConnectionStatus:
    """The stage of the link, why it is down, and when the next attempt is due (monotonic clock).

    While connected, ``operator`` and ``role`` are the desk's account at the gateway; a role that is changed
    meanwhile is not reported. ``wants_token`` is true when connecting takes another token or CA file.
    ``instead`` names the gateway that answers where it is not the one that the operator gave.
    """

    phase: ConnectionPhase
    reason: str = ""
    next_try: float | None = None
    wants_token: bool = False
    operator: str = ""
    role: str = ""
    instead: str = ""

    @property
    def who(self) -> str:
        """The desk's account at the gateway, for display: ``Ada, supervisor``."""
        return ", ".join(filter(None, (self.operator, role_in_words(self.role))))

    def wait(self, now: float) -> float:
        """Return the seconds until the next attempt, 0 when it is due."""
        return max(0.0, self.next_try - now) if self.next_try is not None else 0.0


RESTARTS = 1012
REVOKED = 4003
ENDED = 4004
"""Close codes of the gateway: shutting down; token no longer valid; session ended by a supervisor."""
TOO_LARGE = 1009
"""The WebSocket close code for a message larger than the other side accepts."""
_UNKNOWN_AUTHORITY = {18, 19, 20, 21}
_OTHER_NAME = {62, 64}
_NOT_YET_VALID, _EXPIRED = 9, 10
"""OpenSSL's error numbers for a certificate (X509_V_ERR_...)."""


def explain(error: Exception, url: str, exceptions: ModuleType) -> GatewayLinkError | None:
    """Return a failed or ended link explained to the operator; None when the cause is not known.

    ``exceptions`` is the module of the websockets package in use.
    """
    place = place_of(url)
    if isinstance(error, exceptions.InvalidStatus):
        return _bad_status(error.response, url)
    if isinstance(error, (exceptions.InvalidHandshake, exceptions.ProtocolError, EOFError)):
        return GatewayLinkError(
            tr(
                "What answers at {place} does not speak WebSocket. Check host and port, and ws:// or "
                "wss://: a gateway prints its URL when it starts.",
                place=place,
            )
        )
    if isinstance(error, exceptions.ConnectionClosed):
        return _closed(error, place)
    if isinstance(error, exceptions.InvalidURI):
        return GatewayLinkError(
            tr(
                "The gateway's URL {url} cannot be used. Write it like {default_url}.",
                url=url,
                default_url=DEFAULT_URL,
            ),
            final=True,
        )
    return _network_failure(error, place, secure=uses_tls(url))


MISREAD = (ValueError, KeyError, TypeError, AttributeError)
"""Exceptions raised by reading a message that a gateway would not send."""


def misunderstood(url: str, frame: str | bytes, error: Exception) -> GatewayLinkError:
    """Return an error for the operator: a ``frame`` could not be read."""
    shown = f"{len(frame)} bytes" if isinstance(frame, bytes) else frame
    return GatewayLinkError(
        tr(
            "What answers at {url} sent something that is not the desk's protocol: {text} "
            "({kind}: {error}). Check that the URL leads to a Fleet Supervisor gateway of this "
            "version.",
            url=url,
            text=repr(shown if len(shown) <= 60 else f"{shown[:60]}…"),
            kind=type(error).__name__,
            error=error,
        )
    )


def place_of(url: str) -> str:
    """Return host and port of a gateway's URL."""
    parts = urlsplit(url)
    return f"{parts.hostname}:{parts.port or (443 if parts.scheme == 'wss' else 80)}"


def _bad_status(response: Any, url: str) -> GatewayLinkError:
    status, said = response.status_code, _reason_in(response)
    if status == 404:
        return GatewayLinkError(
            tr(
                "There is no desk at {url} (HTTP 404). A gateway's desk has the path /desk, as in "
                "{default_url}; or another program answers there.",
                url=url,
                default_url=DEFAULT_URL,
            )
        )
    if status == 401:
        return GatewayLinkError(
            tr(
                "{url} refuses this desk: {said} Enter the operator's token under Access.",
                url=url,
                said=said or tr("it wants a token."),
            ),
            final=True,
            wants_token=True,
        )
    if status == 403:
        return GatewayLinkError(
            tr("{url} refuses this desk: {said}", url=url, said=said or tr("no reason given.")),
            final=True,
        )
    if status in (429, 503) and said:
        return GatewayLinkError(
            tr("{url} takes no desk now: {said} It is tried again by itself.", url=url, said=said)
        )
    return GatewayLinkError(
        tr(
            "{url} answered HTTP {status} instead of opening a WebSocket. Check that a gateway runs there "
            "and what its log says.",
            url=url,
            status=status,
        )
    )


def _closed(error: Exception, place: str) -> GatewayLinkError:
    received = getattr(error, "rcvd", None)
    if received is None:
        return GatewayLinkError(
            tr(
                "The link to the gateway at {place} broke off. It is tried again by itself; if it does not "
                "come back, check the gateway and the network.",
                place=place,
            )
        )
    why = f": {received.reason}" if received.reason else ""
    if received.code == REVOKED:
        return GatewayLinkError(
            tr(
                "The gateway at {place} ended the link{why}. Ask whoever runs the site for a new token and "
                "enter it under Access.",
                place=place,
                why=why,
            ),
            final=True,
            wants_token=True,
            everywhere=True,
        )
    if received.code == ENDED:
        return GatewayLinkError(
            tr(
                "The gateway at {place} ended your session{why}. Connect brings it back.",
                place=place,
                why=why,
            ),
            final=True,
            everywhere=True,
        )
    return GatewayLinkError(
        tr(
            "The gateway at {place} closed the link (code {code}{why}). It is tried again by itself.",
            place=place,
            code=received.code,
            why=why,
        ),
        ends=received.code == RESTARTS,
    )


def _bad_certificate(error: ssl.SSLCertVerificationError, place: str) -> GatewayLinkError:
    code = error.verify_code
    if code in _UNKNOWN_AUTHORITY:
        return GatewayLinkError(
            tr(
                "The certificate of {place} is from an authority that this desk does not trust. Choose the "
                "site's ca.pem as CA file under Access; whoever runs the site has it.",
                place=place,
            ),
            final=True,
            wants_token=True,
        )
    if code in _OTHER_NAME:
        return GatewayLinkError(
            tr(
                "The certificate of {place} is for another name: {reason} Use the name that the "
                "gateway's certificate was made for, or have one made for this name.",
                place=place,
                reason=error.verify_message,
            ),
            final=True,
        )
    if code == _EXPIRED:
        return GatewayLinkError(
            tr(
                "The certificate of {place} has expired. Whoever runs the site renews it with 'robot-bridge "
                "tls renew'; if it was renewed, check this computer's clock.",
                place=place,
            )
        )
    if code == _NOT_YET_VALID:
        return GatewayLinkError(
            tr("The certificate of {place} holds only later: check this computer's clock.", place=place)
        )
    return GatewayLinkError(
        tr(
            "The certificate of {place} cannot be trusted: {reason}.",
            place=place,
            reason=error.verify_message,
        ),
        final=True,
    )


def _reason_in(response: Any) -> str:
    """Return the gateway's own reason, a line of plain text."""
    if not str(response.headers.get("Content-Type", "")).startswith("text/plain"):
        return ""
    text = bytes(response.body or b"").decode("utf-8", "replace").strip()
    return text[:300] if text.isprintable() else ""


def _network_failure(error: Exception, place: str, *, secure: bool) -> GatewayLinkError | None:
    if isinstance(error, ssl.SSLCertVerificationError):
        return _bad_certificate(error, place)
    if isinstance(error, ssl.SSLError):
        return GatewayLinkError(
            tr(
                "No secure link to {place}: {reason}. If the gateway has no TLS, write ws:// instead of "
                "wss://.",
                place=place,
                reason=error.reason or error,
            )
        )
    if isinstance(error, ConnectionRefusedError) or f"[Errno {errno.ECONNREFUSED}]" in str(error):
        # For a host with several addresses asyncio reports each failure only as text.
        return GatewayLinkError(
            tr(
                "Nothing listens at {place}. Start the gateway (robot-bridge serve --site ...) or correct "
                "the URL.",
                place=place,
            )
        )
    if isinstance(error, socket.gaierror):
        return GatewayLinkError(
            tr("The host of {place} is not known to this network. Correct the URL.", place=place)
        )
    if secure and isinstance(error, ConnectionResetError):
        return GatewayLinkError(
            tr(
                "{place} broke off while the secure link was made. If the gateway has no TLS, write ws:// "
                "instead of wss://.",
                place=place,
            )
        )
    if isinstance(error, TimeoutError):
        return GatewayLinkError(
            tr(
                "{place} did not answer in time. Check that the gateway runs, and the network and firewall.",
                place=place,
            )
        )
    if isinstance(error, OSError):
        return GatewayLinkError(
            tr(
                "{place} cannot be reached: {reason}. Check network and URL.",
                place=place,
                # Otherwise asyncio's text names the call and not the cause.
                reason=os.strerror(error.errno) if error.errno else error,
            )
        )
    return None
