"""Keeps a link to the gateway up: connects, converses, and tries again when it breaks."""

from __future__ import annotations

import asyncio
from types import ModuleType
from typing import Any

from ...robot_bridge.steady_time import steady_time
from ..errors import AddressError, LinkError
from ..language import tr
from .addresses import Credentials
from .backoff import Backoff
from .failures import explain
from .mailbox import Mailbox
from .outbox import Order
from .protocol import DeskProtocol
from .status import LinkStatus, Phase

ANSWER_WITHIN = 5.0
PING_EVERY = 2.0
PONG_WITHIN = 2.5
"""Together under 5 s: a cable that is pulled out shows before the operator wonders."""
CLOSE_WITHIN = 0.2
LARGEST_MESSAGE = 64 * 2**20
MOST_WAITING = 1
"""Messages that wait to be read: more would be old news by then, where a gateway that waits has newer."""
AWAKE_EVERY = 1.0
ASLEEP_AFTER = 8.0
"""Seconds: what waited in this computer for longer would be taken for new."""


class DeskClient:
    """The link to one gateway, for as long as :meth:`run` runs. All methods belong to its event loop."""

    def __init__(
        self,
        url: str,
        operator: str,
        mailbox: Mailbox,
        library: ModuleType,
        rate: float = 10.0,
        credentials: Credentials | None = None,
    ):
        self._url = url
        self._credentials = credentials or Credentials()
        self._mailbox = mailbox
        self._library = library
        self._protocol = DeskProtocol(operator, rate, url, mailbox, steady_time)
        self._backoff = Backoff()
        self._awake_at = steady_time()
        self._outgoing: asyncio.Queue[str] = asyncio.Queue()

    async def run(self) -> None:
        """Connect and stay connected until cancelled, or until trying again cannot help."""
        reason = ""
        try:
            while True:
                self._mailbox.put_link(LinkStatus(Phase.CONNECTING, reason))
                failure = await self._attempt()
                reason = str(failure)
                if failure.final:
                    self._mailbox.put_link(LinkStatus(Phase.FAILED, reason, wants_token=failure.wants_token))
                    return
                wait = self._backoff.next_wait()
                due = steady_time() + wait
                self._mailbox.put_link(LinkStatus(Phase.RETRYING, reason, next_try=due))
                await asyncio.sleep(wait)
        finally:
            self._protocol.end()

    def submit(self, order: Order) -> None:
        """Send ``order`` now, or as soon as there is a link again."""
        self._send_all(self._protocol.submit(order))

    async def _attempt(self) -> LinkError:
        """Hold one link and return why it ended."""
        try:
            await self._hold()
        except LinkError as error:
            return error
        except AddressError as error:
            return LinkError(str(error), final=True, wants_token=True)
        except Exception as error:
            explained = explain(error, self._url, self._library.exceptions)
            if explained is None:
                raise
            return explained
        finally:
            self._protocol.ready = False
        return LinkError(tr("The gateway at {url} closed the link. It is tried again.", url=self._url))

    async def _hold(self) -> None:
        socket = None
        try:
            async with self._connect() as socket:
                await self._converse(socket)
        finally:
            if socket is not None:
                # Where closing takes too long while we are cancelled, asyncio of some Pythons (3.11.2)
                # has the library take the one for the other and leave the socket open.
                socket.transport.abort()

    def _connect(self) -> Any:
        options: dict[str, Any] = {
            "open_timeout": ANSWER_WITHIN,
            "ping_interval": PING_EVERY,
            "ping_timeout": PONG_WITHIN,
            "close_timeout": CLOSE_WITHIN,
            "max_size": LARGEST_MESSAGE,
            "max_queue": MOST_WAITING,
            "compression": None,
            **self._credentials.options(self._url),
        }
        version = self._library.version.version
        if int(version.split(".")[0]) >= 15:
            # A gateway stands in the site's own network, where a proxy for the web does not lead.
            options["proxy"] = None
        return self._library.connect(self._url, **options)

    async def _converse(self, socket: Any) -> None:
        self._outgoing = asyncio.Queue()
        self._send_all(self._protocol.begin())
        self._awake_at = steady_time()
        work = (self._read(socket), self._write(socket), self._stay_awake())
        tasks = [asyncio.ensure_future(one) for one in work]
        try:
            done, _ = await asyncio.wait(tasks, return_when=asyncio.FIRST_COMPLETED)
            for task in done:
                task.result()
        finally:
            for task in tasks:
                task.cancel()
            await asyncio.gather(*tasks, return_exceptions=True)

    async def _read(self, socket: Any) -> None:
        try:
            while not self._protocol.ready:
                text = await asyncio.wait_for(socket.recv(), ANSWER_WITHIN)
                self._send_all(self._protocol.receive(text))
        except asyncio.TimeoutError as error:
            raise LinkError(
                tr(
                    "What answers at {url} opens a WebSocket but did not answer the desk's greeting within "
                    "{answer_within:g} s. Check that the URL leads to a Fleet Supervisor gateway.",
                    url=self._url,
                    answer_within=ANSWER_WITHIN,
                )
            ) from error
        self._backoff.reset()
        who = {"operator": self._protocol.operator, "role": self._protocol.role}
        self._mailbox.put_link(LinkStatus(Phase.CONNECTED, **who))
        async for text in socket:
            self._check_awake()
            self._send_all(self._protocol.receive(text))

    async def _stay_awake(self) -> None:
        while True:
            await asyncio.sleep(AWAKE_EVERY)
            self._check_awake()
            self._awake_at = steady_time()

    def _check_awake(self) -> None:
        """Raise LinkError when this computer has slept: what comes in now was sent before or meanwhile."""
        asleep = steady_time() - self._awake_at
        if asleep > ASLEEP_AFTER:
            raise LinkError(
                tr(
                    "This computer slept, or did nothing, for {seconds:.0f} s: what waits for it is old. "
                    "The link is opened anew.",
                    seconds=asleep,
                )
            )

    async def _write(self, socket: Any) -> None:
        while True:
            await socket.send(await self._outgoing.get())

    def _send_all(self, texts: list[str]) -> None:
        for text in texts:
            self._outgoing.put_nowait(text)
