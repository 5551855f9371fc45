"""Table ``[rosbridge]`` of a link's settings: the server, and the load on it."""

from __future__ import annotations

import base64
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal
from urllib.parse import urlsplit

from ...core.errors import AccessError
from ...core.reconnection import ClientCredentials
from ..base.errors import LinkError
from ..base.settings import LinkSettings
from ..ros.errors import FaultError
from ..ros.settings import RobotSettings, check_robots
from .decoding import check_cbor

Compression = Literal["none", "cbor"]


class RosbridgeSettings(RobotSettings, frozen=True, forbid_unknown_fields=True):
    """Table ``[rosbridge]``; files are beside the settings.

    ``token_file`` is sent as a bearer token, ``user`` with ``password_file`` as basic authentication, to the
    proxy before the server: rosbridge itself has no authentication. A topic is sent every ``throttle_ms`` at
    most, and ``queue_length`` messages wait for that.
    """

    url: str = "ws://127.0.0.1:9090"
    token_file: str | None = None
    user: str | None = None
    password_file: str | None = None
    ca: str | None = None
    compression: Compression = "cbor"
    throttle_ms: int = 100
    queue_length: int = 1


@dataclass(frozen=True)
class Server:
    """Address and credentials of the server; the files are read again for each connection."""

    url: str
    credentials: ClientCredentials
    user: str | None = None
    password_file: Path | None = None

    def options(self) -> dict[str, Any]:
        """Return the connection options for ``websockets``; raises AccessError."""
        if self.user is None or self.password_file is None:
            return self.credentials.options(self.url)
        # Credentials refuse to send a secret unencrypted.
        secret = ClientCredentials(self.password_file, self.credentials.ca)
        options = secret.options(self.url)
        password = options["additional_headers"]["Authorization"].removeprefix("Bearer ")
        shown = base64.b64encode(f"{self.user}:{password}".encode()).decode()
        return {**options, "additional_headers": {"Authorization": f"Basic {shown}"}}


def server_of(settings: LinkSettings, own: RosbridgeSettings) -> Server:
    """Return the server named in the settings."""

    def beside(name: str | None) -> Path | None:
        return None if name is None else settings.beside(name)

    credentials = ClientCredentials(beside(own.token_file), beside(own.ca))
    return Server(own.url, credentials, own.user, beside(own.password_file))


def check(settings: LinkSettings, own: RosbridgeSettings) -> None:
    """Raise LinkError, naming file and key, for errors that the types do not exclude."""
    file = settings.file
    check_robots(own, "rosbridge", settings)
    parts = urlsplit(own.url)
    if parts.scheme not in ("ws", "wss") or not parts.hostname or parts.username:
        raise LinkError(f"{file}: rosbridge.url = {own.url[:80]!r}: write it as ws://robots.example:9090")
    if (own.user is None) != (own.password_file is None):
        raise LinkError(f"{file}: rosbridge.user and rosbridge.password_file belong together")
    if own.user is not None and own.token_file is not None:
        raise LinkError(f"{file}: rosbridge.token_file and rosbridge.user: give one of them")
    if not 0 <= own.throttle_ms <= 10_000:
        raise LinkError(f"{file}: rosbridge.throttle_ms = {own.throttle_ms}: give milliseconds, 0 to 10000")
    if not 0 <= own.queue_length <= 100:
        raise LinkError(f"{file}: rosbridge.queue_length = {own.queue_length}: give 0 to 100")
    try:
        if own.compression == "cbor":
            check_cbor()
        server_of(settings, own).options()
    except (AccessError, FaultError) as error:
        raise LinkError(f"{file}: rosbridge: {error}") from None
