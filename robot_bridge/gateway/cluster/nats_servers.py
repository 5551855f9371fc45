"""NATS servers: connections to one of several, and checks before their use as a bus."""

from __future__ import annotations

import asyncio
import contextlib
import random
from collections.abc import Iterable, Sequence
from typing import Any
from urllib.parse import urlsplit

from ...core.errors import BridgeError
from .bus import RIGHTS_PROBE
from .messages import LARGEST

OLDEST_NATS = (2, 10, 26)
CONNECT_S, ANSWER_S = 2.0, 2.0
NO_TLS = "the server does not ask for TLS, and was sent nothing"
MOST_FAULTS = 3
"""refusals of the server shown in a message."""
PING_S = 30
"""seconds between the client's own pings, two of which may go unanswered."""
PENDING_BYTES = 4 << 20
"""bytes buffered for a slow server."""


def nats_urls(bus: str) -> list[str]:
    """Return the URLs of NATS servers in ``bus``, none for another bus or an invalid URL."""
    urls = [url.strip() for url in bus.split(",")]
    return urls if all(url.startswith(("nats://", "tls://")) for url in urls) else []


class NatsServers:
    """The URLs of some NATS servers, and the password of the account in them.

    :raises BridgeError: when nats-py is not installed.
    """

    def __init__(self, urls: list[str], password: str | None = None) -> None:
        try:
            import nats
            from nats.aio.client import Client
        except ImportError:
            raise BridgeError(
                "the bus nats:// needs nats-py; install it with: "
                "pip install 'fleet-supervisor-robot-bridge[cluster]'"
            ) from None
        self._nats, self._client = nats, Client
        self._urls = urls
        self._password = password
        self.errors: tuple[type[Exception], ...] = (nats.errors.Error, OSError, TimeoutError)
        """errors of servers and the network."""

    @property
    def patience(self) -> float:
        """Seconds within which one of them must answer."""
        return 2 * CONNECT_S * len(self._urls)

    @property
    def where(self) -> str:
        """Their addresses, without accounts."""
        return ",".join(url.rpartition("@")[2].removeprefix("nats://") for url in self._urls)

    async def connect(self, name: str, on_error: Any, **options: Any) -> Any:
        """Connect to one of the servers as ``name``; raises the last one's error."""
        urls = random.sample(self._urls, len(self._urls))  # nosec B311 # nothing secret: spreads load
        for url in urls:
            try:
                return await self._connect_to(url, name, on_error, **options)
            except self.errors:
                if url is urls[-1]:
                    raise
        raise AssertionError("there is a server")

    async def _connect_to(self, url: str, name: str, on_error: Any, **options: Any) -> Any:
        if self._password is not None:
            options |= {"user": urlsplit(url).username, "password": self._password}
        client: Any = self._client()
        if url.startswith("tls://"):
            self._insist_on_tls(client)
        try:
            await client.connect(
                url,
                error_cb=on_error,
                connect_timeout=CONNECT_S,
                # A lost connection is reopened here, not by the client, which would keep messages published
                # meanwhile and send them as if new.
                allow_reconnect=False,
                reconnect_time_wait=0.1,
                max_reconnect_attempts=1,
                ping_interval=PING_S,
                max_outstanding_pings=2,
                pending_size=PENDING_BYTES,
                no_echo=False,
                name=name,
                **options,
            )
        except BaseException:
            # The client leaves its socket open when it gives up.
            with contextlib.suppress(Exception):
                await client.close()
            raise
        return client

    def _insist_on_tls(self, client: Any) -> None:
        """Have ``client`` send nothing to a server that does not require TLS.

        nats-py uses TLS if the server requires it, whatever the URL says. Without this, an impostor server
        would receive the password in plain text.
        """
        greeting = client._connect_command

        def greeting_over_tls() -> Any:
            if not client._server_info.get("tls_required"):
                raise self._nats.errors.Error(NO_TLS)
            return greeting()

        client._connect_command = greeting_over_tls

    async def check(self, prefix: str, subjects: Sequence[str]) -> None:
        """Connect briefly, subscribe to every subject behind ``prefix`` and publish on it.

        :raises BridgeError: when there is no server, it is too old, or it denies this gateway a right.
        """
        where = f"bus {self.where}"
        faults: dict[str, None] = {}
        returned = asyncio.Event()

        async def add_fault(error: Exception) -> None:
            faults[str(error)] = None

        async def hear(message: Any) -> None:
            if message.data == RIGHTS_PROBE:
                returned.set()

        try:
            async with asyncio.timeout(self.patience):
                client = await self.connect("robot-bridge", add_fault)
        except self.errors as error:
            faults[str(error) or "no server answers"] = None
            raise BridgeError(f"{where}: {_advised(faults, prefix)}") from None
        try:
            check_server(client)
            await _probe_rights(client, [f"{prefix}.{subject}" for subject in subjects], hear)
            if not faults:
                async with asyncio.timeout(ANSWER_S):
                    await returned.wait()
        except BridgeError as error:
            raise BridgeError(f"{where}: {error}") from None
        except TimeoutError:
            faults["what this gateway publishes does not come back to it"] = None
        except self.errors as error:
            faults[str(error)] = None
        finally:
            await client.close()
        if faults:
            raise BridgeError(f"{where}: {_advised(faults, prefix)}")


async def ping(client: Any, seconds: float) -> None:
    """Return when the server of ``client`` answers.

    Replaces nats-py's ``flush``: an answer to an abandoned flush ends the client's reading task, and without
    that task it receives no answer.

    :raises TimeoutError: when it does not within ``seconds``.
    """
    answered = asyncio.get_running_loop().create_future()
    await client._send_ping(answered)
    # A cancelled wait leaves the future as it is.
    await asyncio.wait({answered}, timeout=seconds)
    if not answered.done():
        raise TimeoutError


async def wait_until_processed(client: Any) -> None:
    """Return when the server has processed everything sent by ``client`` before.

    nats-py writes a ping ahead of data that waits for its writing task. By the answer that task has run, and
    the second ping comes last.

    :raises TimeoutError: when the server does not answer.
    """
    for _ in range(2):
        await ping(client, ANSWER_S)


async def _probe_rights(client: Any, subjects: Iterable[str], hear: Any) -> None:
    """Subscribe to every subject and publish on it; return when all refusals have arrived."""
    for subject in subjects:
        await client.subscribe(subject, cb=hear)
        await client.publish(subject, RIGHTS_PROBE)
    await wait_until_processed(client)


def _advised(faults: Iterable[str], prefix: str) -> str:
    """Return the first of ``faults``, with advice."""
    named = list(faults)
    text = "; ".join(named[:MOST_FAULTS])
    if (more := len(named) - MOST_FAULTS) > 0:
        text += f"; and {more} more such"
    return f"{text}; {advice_on(text, prefix) or 'check that NATS runs there'}"


def check_server(client: Any) -> None:
    """Raise BridgeError if the server of ``client`` is too old, or its message limit is too small."""
    version, url = client.connected_server_version, client.connected_url
    if client.max_payload < LARGEST:
        raise BridgeError(
            f"at {url.hostname}:{url.port} NATS takes messages of {client.max_payload} bytes, and gateways "
            f"send {LARGEST}; set max_payload to that at least, or leave it out, in its configuration"
        )
    found = (version.major, version.minor, version.patch)
    if found < OLDEST_NATS:
        wanted = ".".join(map(str, OLDEST_NATS))
        raise BridgeError(
            f"at {url.hostname}:{url.port} NATS {'.'.join(map(str, found))} lets one reader that stands "
            f"still delay all others for seconds; install {wanted} or newer (Debian 13's package nats-server "
            "runs on Debian 12)"
        )


def advice_on(reason: str, prefix: str) -> str:
    """Return advice on ``reason``, for which a server or the network failed; "" if unknown."""
    words = reason.lower()
    if "permissions violation" in words or "come back" in words:
        return f"the account of this gateway has to be allowed to publish and to subscribe to {prefix}.>"
    if "authorization" in words or "authentication" in words:
        return (
            "check the account in the URL, as in nats://ACCOUNT@HOST:PORT, and its password in "
            "--bus-password-file"
        )
    if "certificate" in words:
        return (
            "connect by a name of the certificate; where its authority is your own, name that one's file in "
            "the variable SSL_CERT_FILE"
        )
    if NO_TLS in reason:
        return "give it a certificate (tls in its configuration, without allow_non_tls), or write nats://"
    return ""
