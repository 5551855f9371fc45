"""Connection to the gateway: its thread, and the client that keeps it up at one of the fleet's gateways."""

from __future__ import annotations

import asyncio
import contextlib
import socket as system_sockets
import ssl
import threading
from types import ModuleType
from typing import Any

from qgis.PyQt.QtCore import QObject, QThread

from ...robot_bridge.core.clock import Clock, steady_time
from ...robot_bridge.core.reconnection import DESK_PACE, FleetGateways, GatewayAddresses
from ..ui.errors import AddressError, GatewayLinkError, NotSentError
from ..ui.language import tr
from ..ui.vendored import websocket_library
from . import connection_status
from .connection_status import ConnectionPhase, ConnectionStatus, OperatorCredentials
from .fleet_state import OperatorRequest, StateUpdate, UpdateBuffer
from .protocol import GatewayProtocol
from .request_outbox import stops_robots
from .robot_states import table_from_frame

CLOSE_WITHIN = 0.2
LARGEST_MESSAGE = 64 * 2**20
MOST_WAITING = 1
"""Messages that may wait to be read: more would be outdated, where the gateway would send newer ones."""
AWAKE_EVERY = 1.0
ASLEEP_AFTER = 8.0
"""Seconds: messages that waited in this computer for longer would be taken for new."""
CA_PATIENCE = 3.0
"""Seconds without an answer of the CA file's drive after which the operator is warned."""
STOP_TRIES_EVERY = 0.5
"""Seconds between two attempts to connect at most, while a stop waits to be sent."""
PIECE = 16_384
"""Characters of a message that are sent at a time, and about as many bytes wait unsent in this computer: on a
slow line the pings between the pieces, and a stop behind the message, come soon."""
STOP_PATIENCE = 0.5
"""Seconds that a stop waits for the rest of a large message on a slow line."""


class GatewayClient:
    """The link to a fleet, while :meth:`run` runs. All methods must be called in its event loop.

    It is opened to the gateway at ``url``; when that does not answer, to another one that a gateway has
    reported, now or in an earlier session (``known``). One that refuses does not stop the others being tried.
    """

    def __init__(
        self,
        url: str,
        operator: str,
        buffer: UpdateBuffer,
        library: ModuleType,
        rate: float = 10.0,
        credentials: OperatorCredentials | None = None,
        known: FleetGateways | None = None,
    ):
        self._credentials = credentials or OperatorCredentials()
        self._addresses = GatewayAddresses(url, DESK_PACE, has_token=bool(self._credentials.token))
        self._buffer = buffer
        self._library = library
        known = known or FleetGateways("")
        self._addresses.learn(list(known.gateways))
        self._protocol = GatewayProtocol(operator, rate, self._addresses, buffer, Clock(), known.database)
        self._refusals: dict[str, GatewayLinkError] = {}
        self._awake_at = steady_time()
        self._outgoing: asyncio.Queue[str] = asyncio.Queue()
        self._submitted = self._written = 0
        """The numbers of messages to send on this link, and of those that were written."""
        self._large = self._large_before_stop = 0
        """Up to which of them large ones have to be written: of all, and before the last stop."""
        self._stop_asked = asyncio.Event()
        self._tls_context: ssl.SSLContext | None = None

    @property
    def _url(self) -> str:
        return self._addresses.current

    async def run(self) -> None:
        """Connect and stay connected until cancelled, or until another attempt cannot help."""
        reason = ""
        try:
            while True:
                self._buffer.add(link=ConnectionStatus(ConnectionPhase.CONNECTING, reason))
                failure = await self._attempt()
                if failure.final and self._has_refused(failure):
                    return
                reason = self._because(failure)
                if failure.at_once:
                    continue
                await self._wait_to_try(reason, self._addresses.next_wait(ends=failure.ends))
        finally:
            self._protocol.end()

    async def _wait_to_try(self, reason: str, wait: float) -> None:
        """Wait until the next attempt is due, which is soon if a stop must be sent."""
        # Of an event, some Pythons (3.9) find the loop when it is made.
        self._stop_asked = asyncio.Event()
        if self._protocol.has_stop:
            wait = min(wait, STOP_TRIES_EVERY)
        due = steady_time() + wait
        self._buffer.add(link=ConnectionStatus(ConnectionPhase.RETRYING, reason, next_try=due))
        # Not wait_for: before Python 3.12 that may lose a cancellation.
        asked = asyncio.ensure_future(self._stop_asked.wait())
        try:
            await asyncio.wait({asked}, timeout=wait)
        finally:
            asked.cancel()

    def _has_refused(self, failure: GatewayLinkError) -> bool:
        """Record and report that a gateway refuses for good; return true where there is no other to try."""
        self._addresses.refused()
        self._refusals[self._url] = failure
        if not (failure.everywhere or self._addresses.all_refuse):
            return False
        wants_token = any(one.wants_token for one in self._refusals.values())
        reason = self._because(failure)
        self._buffer.add(link=ConnectionStatus(ConnectionPhase.FAILED, reason, wants_token=wants_token))
        return True

    def _because(self, failure: GatewayLinkError) -> str:
        """Return why there is no link: the newest failure, and which gateway refuses for good besides."""
        if failure.everywhere:
            return str(failure)
        return " ".join(dict.fromkeys([str(failure), *map(str, self._refusals.values())]))

    def submit(self, order: OperatorRequest) -> None:
        """Send ``order`` now, or as soon as there is a link again; what stops robots, has that tried now."""
        if stops_robots(order):
            self._large_before_stop = self._large
            self._stop_asked.set()
        self._send_all(self._protocol.submit(order))

    async def _attempt(self) -> GatewayLinkError:
        """Hold one link and return why it ended."""
        try:
            await self._hold()
        except GatewayLinkError as error:
            return error
        except AddressError as error:
            return GatewayLinkError(str(error), final=True, wants_token=True)
        except Exception as error:
            if getattr(getattr(error, "rcvd", None), "code", None) == connection_status.TOO_LARGE:
                self._protocol.refuse_largest()
            explained = connection_status.explain(error, self._url, self._library.exceptions)
            if explained is None:
                raise
            return explained
        finally:
            self._protocol.end_link()
        return GatewayLinkError(tr("The gateway at {url} closed the link. It is tried again.", url=self._url))

    async def _hold(self) -> None:
        socket = None
        try:
            async with self._connect(await self._tls()) as socket:
                await self._converse(socket)
        finally:
            if socket is not None:
                # Where closing takes too long while we are cancelled, asyncio of some Pythons (3.11.2)
                # makes the library confuse the two and leave the socket open.
                socket.transport.abort()

    async def _tls(self) -> dict[str, Any]:
        """Return the option for TLS, if it is used."""
        if not connection_status.uses_tls(self._url):
            return {}
        if self._tls_context is None:
            # In a thread: a CA file that does not answer must not keep the link from being given up. Once: it
            # may be on a share that goes with the network, and a stop waits for the next link.
            loop = asyncio.get_running_loop()
            reading = loop.run_in_executor(None, self._credentials.tls_context)
            await asyncio.wait({reading}, timeout=CA_PATIENCE)
            if not reading.done() and self._credentials.ca_file:
                self._buffer.add(link=ConnectionStatus(ConnectionPhase.RETRYING, self._why_no_tls()))
            self._tls_context = await reading
            self._buffer.add(link=ConnectionStatus(ConnectionPhase.CONNECTING))
        return {"ssl": self._tls_context}

    def _why_no_tls(self) -> str:
        """Return what is wrong while the CA file is not read."""
        return tr(
            "The CA file {file} has not answered for {seconds:g} s, so there is no link to {url} yet: the "
            "drive that it is on may be away. The desk waits for it. If it stays away, press Disconnect and "
            "choose a copy of the file on this computer.",
            file=self._credentials.ca_file,
            seconds=CA_PATIENCE,
            url=self._url,
        )

    def _connect(self, tls: dict[str, Any]) -> Any:
        options: dict[str, Any] = {
            **self._addresses.options(),
            "close_timeout": CLOSE_WITHIN,
            "max_size": LARGEST_MESSAGE,
            "max_queue": MOST_WAITING,
            "write_limit": PIECE,
            "compression": None,
            **self._credentials.options(self._url),
            **tls,
        }
        version = self._library.version.version
        if int(version.split(".")[0]) >= 15:
            # A gateway is in the site's own network, which a web proxy does not reach.
            options["proxy"] = None
        return self._library.connect(self._url, **options)

    async def _converse(self, socket: Any) -> None:
        self._outgoing = asyncio.Queue()
        self._submitted = self._written = self._large = self._large_before_stop = 0
        self._stop_asked = asyncio.Event()
        _hold_little(socket)
        self._send_all(self._protocol.begin())
        self._awake_at = steady_time()
        work = (self._cut_for_stops(socket), self._read(socket), self._write(socket), self._stay_awake())
        tasks = [asyncio.ensure_future(one) for one in work]
        try:
            await asyncio.wait(tasks, return_when=asyncio.FIRST_COMPLETED)
            # In this order: where the link was cut, reading it fails as well.
            for task in filter(asyncio.Future.done, tasks):
                task.result()
        finally:
            for task in tasks:
                task.cancel()
            await asyncio.gather(*tasks, return_exceptions=True)

    async def _read(self, socket: Any) -> None:
        patience = self._addresses.patience
        try:
            while not self._protocol.ready:
                self._receive(await asyncio.wait_for(socket.recv(), patience))
        except asyncio.TimeoutError as error:
            raise GatewayLinkError(
                tr(
                    "What answers at {url} opens a WebSocket but did not answer the desk's greeting within "
                    "{answer_within:g} s. Check that the URL leads to a Fleet Supervisor gateway.",
                    url=self._url,
                    answer_within=patience,
                )
            ) from error
        instead = self._instead()
        self._addresses.answered()
        self._refusals.clear()
        who = {"operator": self._protocol.operator, "role": self._protocol.role}
        self._buffer.add(link=ConnectionStatus(ConnectionPhase.CONNECTED, **who, instead=instead))
        async for frame in socket:
            self._check_awake()
            self._receive(frame)

    def _receive(self, frame: str | bytes) -> None:
        """Receive robot positions, which are binary, or a text of the conversation.

        :raises GatewayLinkError: when a gateway would not send it, or there can be no link.
        """
        if isinstance(frame, str):
            self._send_all(self._protocol.receive(frame))
            return
        try:
            self._buffer.add(robots=table_from_frame(frame, steady_time()))
        except connection_status.MISREAD as error:
            raise connection_status.misunderstood(self._url, frame, error) from error

    def _instead(self) -> str:
        """Return which gateway answers in place of the one that the operator gave; empty if that one does."""
        if self._addresses.is_given:
            return ""
        given, name = self._addresses.given, self._protocol.names.get
        here, there = connection_status.place_of(self._url), name(given) or connection_status.place_of(given)
        here = f"{own} ({here})" if (own := name(self._url)) else here
        if given in self._refusals:
            return tr("at {gateway}; {given} refuses this desk", gateway=here, given=there)
        return tr("at {gateway}; {given} did not answer", gateway=here, given=there)

    async def _stay_awake(self) -> None:
        while True:
            await asyncio.sleep(AWAKE_EVERY)
            self._check_awake()
            self._awake_at = steady_time()

    def _check_awake(self) -> None:
        """Raise GatewayLinkError when this computer has slept: messages received now are old."""
        asleep = steady_time() - self._awake_at
        if asleep > ASLEEP_AFTER:
            raise GatewayLinkError(
                tr(
                    "This computer slept, or did nothing, for {seconds:.0f} s: what waits for it is old. "
                    "The link is opened anew.",
                    seconds=asleep,
                )
            )

    async def _write(self, socket: Any) -> None:
        while True:
            text = await self._outgoing.get()
            if len(text) > PIECE:
                await socket.send(text[at : at + PIECE] for at in range(0, len(text), PIECE))
            else:
                await socket.send(text)
            self._written += 1

    async def _cut_for_stops(self, socket: Any) -> None:
        """Cut the link when a stop waits for the rest of a large message: on the next one it is sent first.

        Nothing but pings can be sent between the pieces of a message. The gateway does nothing of a part.
        """
        while True:
            await self._stop_asked.wait()
            self._stop_asked.clear()
            while self._written < self._large_before_stop:
                await asyncio.sleep(STOP_PATIENCE)
                # Where all is on its way, the line is fast, and this process slow.
                if self._written < self._large_before_stop and socket.transport.get_write_buffer_size():
                    socket.transport.abort()
                    raise GatewayLinkError(
                        tr(
                            "A stop would wait for the rest of a large request on the slow line to {url}: "
                            "the link is opened again, and the stop sent first.",
                            url=self._url,
                        ),
                        at_once=True,
                    )

    def _send_all(self, texts: list[str]) -> None:
        for text in texts:
            self._outgoing.put_nowait(text)
            self._submitted += 1
            if len(text) > PIECE:
                self._large = self._submitted


def _hold_little(socket: Any) -> None:
    """Have the system hold little that is not on its way yet: a stop is sent behind it."""
    own = socket.transport.get_extra_info("socket")
    with contextlib.suppress(OSError):
        if hasattr(system_sockets, "TCP_NOTSENT_LOWAT"):
            own.setsockopt(system_sockets.IPPROTO_TCP, system_sockets.TCP_NOTSENT_LOWAT, PIECE)
        else:
            own.setsockopt(system_sockets.SOL_SOCKET, system_sockets.SO_SNDBUF, 4 * PIECE)


STOP_WITHIN_MS = 3000
CANCEL_WITHIN = 0.3


class ConnectionThread(QObject):
    """The link to a gateway as seen by the window. No method waits for the network.

    There are no signals per message: a timer of the window calls :meth:`collect_updates`.
    """

    def __init__(self, parent: QObject | None = None):
        super().__init__(parent)
        self._worker: _Worker | None = None
        self._ending: list[_Worker] = []
        self._buffer = UpdateBuffer()
        self.rate = 10.0
        """Greatest rate at which positions are requested, per second."""

    def set_rate(self, rate: float) -> None:
        """Set the greatest rate of positions per second for links opened from now on."""
        self.rate = rate

    @property
    def is_open(self) -> bool:
        """Whether a link is wanted, whether or not it is up."""
        return self._worker is not None

    @property
    def is_ending(self) -> bool:
        """Whether the thread of a link that was given up is still running."""
        return bool(self._ending)

    def open(
        self,
        url: str,
        operator: str,
        credentials: OperatorCredentials | None = None,
        known: FleetGateways | None = None,
    ) -> None:
        """Connect to the gateway at ``url`` and stay connected until :meth:`close`.

        Where it does not answer, to another gateway of the fleet: those ``known``, and those it reports.

        An unusable CA file ends the link.

        :raises AddressError: when the URL is invalid for a gateway, or the token is unusable.
        :raises LibraryMissingError: when there is no WebSocket library.
        """
        url = connection_status.check_address(url)
        credentials = credentials or OperatorCredentials()
        credentials.check(url)
        library = websocket_library()
        self.close()
        self._buffer = UpdateBuffer()
        self._buffer.add(link=ConnectionStatus(ConnectionPhase.CONNECTING))
        client = GatewayClient(url, operator, self._buffer, library, self.rate, credentials, known)
        self._worker = _Worker(client, self._buffer)
        self._worker.start()

    def close(self) -> None:
        """Give up the link; its thread ends by itself shortly afterwards."""
        if self._worker is None:
            return
        self._worker.ask_to_stop()
        self._ending.append(self._worker)
        self._worker = None
        self._forget_ended()

    def submit(self, order: OperatorRequest) -> None:
        """Hand a request to the worker thread.

        :raises NotSentError: when no link is wanted.
        """
        if self._worker is None or not self._worker.submit(order):
            raise NotSentError(tr("The desk is not connected to a gateway. Press Connect first."))

    def collect_updates(self) -> StateUpdate:
        """Return the updates received since the last call."""
        self._forget_ended()
        update = self._buffer.collect()
        if self._worker is None:
            # The worker that is ending may still have announced another attempt.
            update.link = ConnectionStatus(ConnectionPhase.CLOSED)
        return update

    def shut_down(self) -> None:
        """Close the link and wait until every thread has ended."""
        self.close()
        for worker in self._ending:
            worker.wait(STOP_WITHIN_MS)
        self._forget_ended()

    def _forget_ended(self) -> None:
        """Keep the outcomes of requests on ended links: another link may be open by now."""
        for worker in [worker for worker in self._ending if worker.isFinished()]:
            self._ending.remove(worker)
            if worker.buffer is not self._buffer:
                for answer in worker.buffer.collect().answers:
                    self._buffer.add_answer(answer)


class _Worker(QThread):
    """Runs one client's event loop."""

    def __init__(self, client: GatewayClient, buffer: UpdateBuffer):
        super().__init__()
        self.setObjectName("fleet_connection")
        self._client = client
        self.buffer = buffer
        self._lock = threading.Lock()
        self._early: list[OperatorRequest] = []
        self._loop: asyncio.AbstractEventLoop | None = None
        self._task: asyncio.Task | None = None
        self._stopping = False

    def submit(self, order: OperatorRequest) -> bool:
        """Hand ``order`` to the client; false when the worker has ended or is about to end."""
        with self._lock:
            if self._stopping:
                return False
            if self._loop is None:
                self._early.append(order)
            else:
                self._loop.call_soon_threadsafe(self._client.submit, order)
            return True

    def ask_to_stop(self) -> None:
        """Make the event loop end, from any thread."""
        with self._lock:
            self._stopping = True
            if self._loop is not None and self._task is not None:
                self._loop.call_soon_threadsafe(self._task.cancel)

    def run(self) -> None:
        # An exception that leaves QThread.run ends the process outside QGIS and is lost inside QGIS.
        try:
            self._run_loop()
        except Exception as error:
            self.buffer.add(
                link=ConnectionStatus(
                    ConnectionPhase.FAILED,
                    tr(
                        "The connection stopped on an internal fault ({name}: {error}). Press Connect to "
                        "try again and report this text.",
                        name=type(error).__name__,
                        error=error,
                    ),
                )
            )

    def _run_loop(self) -> None:
        loop = asyncio.new_event_loop()
        try:
            with self._lock:
                if self._stopping:
                    return
                self._loop, self._task = loop, loop.create_task(self._client.run())
                for order in self._early:
                    self._client.submit(order)
            loop.run_until_complete(self._task)
        except asyncio.CancelledError:
            return
        finally:
            with self._lock:
                self._stopping, self._loop, self._task = True, None, None
            _end_tasks(loop)
            loop.close()


def _end_tasks(loop: asyncio.AbstractEventLoop) -> None:
    """Cancel tasks that a library left running, such as the pings of a link that would not close."""
    left = asyncio.all_tasks(loop)
    for task in left:
        task.cancel()
    if left:
        loop.run_until_complete(asyncio.wait(left, timeout=CANCEL_WITHIN))
    # A link that was cut off closes its socket in the next round of the loop, which would never come.
    loop.run_until_complete(asyncio.sleep(0))
