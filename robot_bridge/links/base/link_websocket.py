"""A link's connection to the gateway: it reconnects, also to other gateways, and carries frames both ways."""

from __future__ import annotations

import asyncio
import itertools
import logging
from collections import deque
from collections.abc import Callable
from typing import Any, Protocol
from urllib.parse import quote

from websockets.asyncio.client import ClientConnection, connect
from websockets.exceptions import ConnectionClosed, InvalidHandshake, InvalidURI
from websockets.frames import CloseCode

from ...core.clock import ABORTS_WITHIN_S, LONGEST_PAUSE_S, StandstillWatch
from ...core.errors import AccessError, BridgeError
from ...core.logs import end_on_error, log_and_continue
from ...core.messages.base import MessageError
from ...core.messages.robots import Abort
from ...core.reconnection import ClientCredentials, GatewayAddresses, connection_failure
from ...protocol import jsonrpc
from .errors import LinkError
from .settings import LinkSettings

log = logging.getLogger(__name__)

TOGETHER = 0.05
"""seconds within which positions are sent in one frame."""
LARGEST_FRAME = 64 << 20


class CallHandler(Protocol):
    """The user of a connection."""

    @property
    def is_connected(self) -> bool:
        """Whether the gateway has admitted this link."""

    def handle(self, call: jsonrpc.Call) -> None:
        """Process a call of the gateway; raises LinkError and MessageError."""

    def news(self) -> list[str | bytes]:
        """Return the new frames; called when they can be sent."""

    def pass_over(self, seconds: float) -> None:
        """Drop commands not begun: this program stood still for so many ``seconds``."""

    def lose(self) -> None:
        """Handle a lost connection."""


class LinkWebSocket:
    """The connection of one link: it sends frames and calls, and receives calls of the gateway.

    Of messages received while this program stood still for ``longest_pause_s`` seconds only an Abort is
    executed: the rest may be obsolete. Messages still valid come again on the next connection.
    """

    def __init__(self, settings: LinkSettings, longest_pause_s: float = LONGEST_PAUSE_S) -> None:
        self._settings = settings
        folder, gateway = settings.folder, settings.gateway
        self._credentials = ClientCredentials(
            None if gateway.token_file is None else folder / gateway.token_file,
            None if gateway.ca is None else folder / gateway.ca,
        )
        self.addresses = GatewayAddresses(gateway.url, has_token=gateway.token_file is not None)
        self._ids = itertools.count(1)
        self._pending_calls: dict[int, Callable[[jsonrpc.Reply], None]] = {}
        self._urgent: deque[str] = deque()
        self._outgoing: deque[str] = deque()
        self._wake = asyncio.Event()
        self._waking: asyncio.TimerHandle | None = None
        self._longest_pause_s = longest_pause_s
        self._standstill = StandstillWatch(longest_pause_s)

    # --- outgoing messages ---

    def post(self, frame: str, *, urgent: bool = False) -> None:
        """Send a frame; outcomes of Aborts before all others."""
        (self._urgent if urgent else self._outgoing).append(frame)
        self._wake.set()

    def call(self, method: str, params: Any, answered: Callable[[jsonrpc.Reply], None]) -> int:
        """Call a method of the gateway; return the id by which ``answered`` is called with the reply."""
        id = next(self._ids)
        self._pending_calls[id] = answered
        self.post(jsonrpc.call(method, params, id))
        return id

    def write_soon(self) -> None:
        """Request the link's new frames in a moment."""
        if self._waking is None:
            self._waking = asyncio.get_running_loop().call_later(TOGETHER, self._woken)

    def _woken(self) -> None:
        self._waking = None
        self._wake.set()

    async def _write(self, connection: ClientConnection, link: CallHandler) -> None:
        with end_on_error(log, f"link {self._settings.name}: sending", connection, ConnectionClosed):
            while True:
                await self._wake.wait()
                self._wake.clear()
                while self._urgent or self._outgoing:
                    await connection.send((self._urgent or self._outgoing).popleft())
                # Built when they can be sent: on a slow line only the newest positions are sent.
                for frame in link.news():
                    await connection.send(frame)

    # --- the connection -------------------------------------------------------------------------------------

    async def run(self, link: CallHandler) -> None:
        """Carry messages until cancelled; raises LinkError for faults that a person must put right."""
        while True:
            url, ends = f"{self.addresses.current}?link={quote(self._settings.name)}", False
            try:
                options = {**self._credentials.options(url), **self.addresses.options()}
                async with connect(url, max_size=LARGEST_FRAME, **options) as connection:
                    await self._carry(connection, link)
                reason = "the gateway closed the connection"
            except (InvalidURI, AccessError) as error:
                if self.addresses.is_given:
                    raise self._to_put_right(error) from None
                reason = str(error)
            except ConnectionClosed as error:
                reason = str(error)
                ends = error.rcvd is not None and error.rcvd.code == CloseCode.SERVICE_RESTART
            except (OSError, InvalidHandshake) as error:
                reason = connection_failure(error)
            link.lose()
            wait = self.addresses.next_wait(ends=ends)
            log.warning("%s: %s; trying again in %.1f s at %s", url, reason, wait, self.addresses.current)
            await asyncio.sleep(wait)

    def _to_put_right(self, error: InvalidURI | AccessError) -> BridgeError:
        if isinstance(error, BridgeError):
            return error
        return LinkError(f"{self._settings.file}: gateway.url: {error}")

    async def _carry(self, connection: ClientConnection, link: CallHandler) -> None:
        self._urgent.clear()
        self._outgoing.clear()
        self._pending_calls.clear()
        self._standstill = StandstillWatch(self._longest_pause_s)
        works = (self._write(connection, link), self._end_when_old(connection, link))
        tasks = [asyncio.create_task(work) for work in works]
        try:
            async for frame in connection:
                self._receive(frame, link)
        finally:
            for task in tasks:
                task.cancel()
            await asyncio.gather(*tasks, return_exceptions=True)

    async def _end_when_old(self, connection: ClientConnection, link: CallHandler) -> None:
        """End a connection whose received messages are too old to execute."""
        await self._standstill.wait()
        seconds = self._standstill.seconds
        name = self._settings.name
        log.warning("link %s stood still for %.0f s: what came meanwhile is asked for again", name, seconds)
        link.pass_over(seconds)
        await asyncio.sleep(ABORTS_WITHIN_S)
        # A clean close would mean that its robots were switched off.
        connection.transport.abort()

    # --- incoming messages ---

    def _receive(self, frame: str | bytes, link: CallHandler) -> None:
        # Once admitted, an error in a message must not end a connection by which robots are stopped.
        known = (LinkError, MessageError) if link.is_connected else Exception
        try:
            message = jsonrpc.decode(frame)
            with log_and_continue(log, "what the gateway said", except_for=known):
                if isinstance(message, jsonrpc.Reply):
                    self._receive_reply(message)
                elif not self._standstill.check() or message.method == Abort.__name__:
                    link.handle(message)
        except (jsonrpc.FrameError, MessageError) as error:
            log.error("the gateway said what cannot be understood: %s", error)

    def _receive_reply(self, reply: jsonrpc.Reply) -> None:
        answered = self._pending_calls.pop(reply.id, None) if isinstance(reply.id, int) else None
        if answered is not None:
            answered(reply)
        elif reply.error is not None:
            log.warning("the gateway refuses: %s", reply.error)
