"""The gateway's URL, and what an operator brings to it."""

from __future__ import annotations

import ipaddress
import ssl
from dataclasses import dataclass, field
from typing import Any
from urllib.parse import urlsplit

from ..errors import AddressError
from ..language import tr

DEFAULT_URL = "ws://127.0.0.1:8765/desk"
DESK_PATH, ROBOTS_PATHS = "/desk", ("/robot", "/link")
"""The gateway's paths; a proxy may have put others in front of them."""


@dataclass(frozen=True)
class Credentials:
    """The operator's token, and the file (PEM) of the authority that the gateway's certificate is from.

    Both are empty where none is needed; without a file the authorities of the system are trusted.
    """

    token: str = field(default="", repr=False)
    ca_file: str = ""

    def options(self, url: str) -> dict[str, Any]:
        """Return what ``websockets`` is to connect to ``url`` with; raises AddressError."""
        options: dict[str, Any] = {}
        if self.token:
            options["additional_headers"] = {"Authorization": f"Bearer {self.token}"}
        if urlsplit(url).scheme == "wss":
            options["ssl"] = self._context()
        return options

    def check(self, url: str) -> None:
        """Raise AddressError when ``url`` cannot be connected to with this."""
        parts = urlsplit(url)
        if self.token and (not self.token.isascii() or len(self.token.split()) != 1):
            raise AddressError(
                tr("The token cannot be right: it is one word. Paste it again, whole and alone.")
            )
        if parts.scheme == "ws" and self.token and not _is_own(parts.hostname or ""):
            raise AddressError(
                tr(
                    "Over {url} everybody on the way could read the token. Write wss:// instead of ws://; a "
                    "gateway that other computers can reach has TLS.",
                    url=url,
                )
            )
        if parts.scheme == "wss":
            self._context()

    def _context(self) -> ssl.SSLContext:
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


def check_address(url: str) -> str:
    """Return ``url`` without blanks around it if it can be a gateway's, else raise AddressError."""
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


def _is_own(host: str) -> bool:
    try:
        return ipaddress.ip_address("127.0.0.1" if host == "localhost" else host).is_loopback
    except ValueError:
        return False
