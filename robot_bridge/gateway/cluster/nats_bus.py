"""The bus on NATS, for any number of gateways: a connection for all messages, and one for stops alone."""

from __future__ import annotations

import asyncio
import contextlib
import logging
import threading
from collections import deque
from collections.abc import AsyncIterator, Callable, Iterator
from typing import Any, ClassVar

from ...core.errors import BridgeError
from ...core.logs import log_and_continue, log_unforeseen
from ..monitoring import until_tick, wait_at_most
from .bus import (
    EVERYBODY,
    MOST_WAITING,
    POSITIONS,
    RETRY_S,
    STOP,
    OutgoingMessages,
    Receive,
    own_subject,
)
from .nats_servers import ANSWER_S, NatsServers, advice_on, check_server, ping, wait_until_processed

log = logging.getLogger(__name__)

NATS_RETRY_S = 0.1
"""seconds between attempts to connect."""
CONNECTED_LOOK_S = 0.25
"""seconds between checks of a connection that did not report a loss."""
QUIET_LOOKS, PONG_S = 8, 1.0
"""Checks of a silent connection after which it is pinged, and seconds for the answer: an outage of the
network is known after three seconds. A connection that receives messages is not pinged: with many robots on a
busy computer the answer waits behind positions for longer than that."""
LARGEST_STOP = 16 << 10
"""bytes of a message that the stop thread hands over: no message of a stop is as long. With MOST_WAITING of
them 4 MB wait at most; longer ones are left to the connection for all messages."""
END_S = 2.0
"""seconds for which the end of the bus waits for that thread."""


# --- A connection that is replaced when lost ---


class NatsConnection:
    """A connection subscribed to ``subjects``, reopened when lost; used by one event loop only.

    ``trouble`` is logged behind the reason while there is no connection.
    """

    def __init__(
        self, servers: NatsServers, name: str, prefix: str, subjects: tuple[str, ...], trouble: str
    ) -> None:
        self.client: Any = None
        self._servers = servers
        self._name = name
        self._prefix = prefix
        self._subjects = subjects
        self._trouble = trouble
        self._said = set[str]()
        """reasons logged since the last connection."""

    @property
    def connected(self) -> bool:
        """Whether the connection is open, and the server knows the subscriptions."""
        client = self.client
        return client is not None and bool(client.is_connected)

    @contextlib.asynccontextmanager
    async def open(self, receive: Receive) -> AsyncIterator[asyncio.Event]:
        """Connect, and pass messages to ``receive``; yield an event that is set when the connection is lost.

        :raises OSError: when the block ends: the connection is lost by then. Other errors pass through.
        """
        lost = asyncio.Event()

        async def ended() -> None:
            lost.set()

        async def log_fault(error: Exception) -> None:
            self._log(str(error))

        was_lost = bool(self._said)
        async with asyncio.timeout(self._servers.patience):
            client = await self._servers.connect(
                self._name, log_fault, disconnected_cb=ended, closed_cb=ended
            )
        try:
            check_server(client)
            await self._subscribe(client, receive)
            raise_if_cancelled()
            self.client = client
            if was_lost:
                log.warning("bus %s: %s is connected again", self._servers.where, self._name)
            self._said.clear()
            yield lost
        finally:
            self.client = None
            with contextlib.suppress(Exception):
                async with asyncio.timeout(ANSWER_S):
                    await client.close()
        raise OSError("the connection is lost")

    @contextlib.contextmanager
    def faults_logged(self) -> Iterator[None]:
        """Log errors in the block, each reason once until there is a connection, and continue."""
        foreseen: tuple[type[Exception], ...] = (*self._servers.errors, BridgeError)
        try:
            yield
        except foreseen as error:
            self._log(str(error) or "no server answers")
        except Exception as error:
            # Any error of the library: a new connection follows a moment later.
            reason = f"{type(error).__name__}: {error}"
            if reason not in self._said:
                log_unforeseen(log, f"bus {self._servers.where}")
            self._said.add(reason)
        except asyncio.CancelledError:
            # The library cancels tasks and futures of its own, which must not end this one.
            raise_if_cancelled()
            self._log("the client was cancelled")
        raise_if_cancelled()

    async def _subscribe(self, client: Any, receive: Receive) -> None:
        """Return when the server knows the subscriptions: earlier messages are not received."""
        cut = len(self._prefix) + 1

        async def hear(message: Any) -> None:
            receive(message.subject[cut:], message.data)
            # The client delivers all waiting messages without a pause, and answers no pings meanwhile.
            await asyncio.sleep(0)

        for subject in self._subjects:
            # Each has a queue of its own: no stop waits behind positions.
            await client.subscribe(f"{self._prefix}.{subject}", cb=hear)
        await wait_until_processed(client)

    def _log(self, reason: str) -> None:
        if reason not in self._said:
            advice = advice_on(reason, self._prefix)
            log.warning(
                "bus %s: %s; %s%s", self._servers.where, reason, advice and f"{advice}; ", self._trouble
            )
        self._said.add(reason)


# --- Stops: received by a thread as well ---


class StopListener:
    """Receives stops in a thread with its own loop and connection, and passes each to the gateway's loop.

    That needs one iteration of the gateway's loop; with thousands of robots one takes up to 25 ms. Over the
    connection for all messages it needs three: bytes are read, parsed, and passed to the subscription. That
    connection receives stops as well, whatever happens to the thread: :class:`~.messages.Exchange` accepts
    copies once.
    """

    def __init__(self, servers: NatsServers, prefix: str, main: NatsConnection) -> None:
        self._main = main
        self._connection = NatsConnection(
            servers,
            "robot-bridge stops",
            prefix,
            (STOP,),
            "stops of other gateways come some milliseconds later until it works",
        )
        self._waiting: deque[bytes] = deque(maxlen=MOST_WAITING)
        """Received messages, not processed yet. A flood on the subject must not fill the gateway's loop: it
        would have time for nothing else, and memory would grow without limit. The oldest are dropped; a stop
        among them arrives over the connection for all messages."""
        self._is_due = False
        """whether the gateway's loop was asked to process the waiting messages, and has not begun."""
        self._receive: Receive | None = None

    @contextlib.asynccontextmanager
    async def listening(self, receive: Receive) -> AsyncIterator[None]:
        """Have a thread receive stops within the block, and pass them to ``receive`` on the running loop."""
        ended = asyncio.Event()
        self._waiting.clear()
        self._receive, self._is_due = receive, False
        end = self._start(asyncio.get_running_loop(), ended)
        try:
            yield
        finally:
            self._receive = None
            if end is not None:
                end()
                # Not by joining it: that would block a thread of the gateway's, or its loop.
                await wait_at_most(ended, END_S)

    def _start(self, gateway: asyncio.AbstractEventLoop, ended: asyncio.Event) -> Callable[[], None] | None:
        """Start the thread; return a function that ends it, None if it cannot start.

        ``ended`` is set on the loop ``gateway`` then.
        """
        ending = asyncio.Event()
        try:
            loop = asyncio.new_event_loop()
        except OSError as error:
            log.warning("bus: no thread hears stops: %s", error)
            return None

        def run() -> None:
            try:
                loop.run_until_complete(self._listen_until(ending, gateway))
            except Exception:
                # Stops arrive over the connection for all messages from then on.
                log_unforeseen(log, "the thread that hears stops")
            finally:
                # Not asyncio.run, which would wait for a pending name resolution.
                loop.close()
                with contextlib.suppress(RuntimeError):
                    gateway.call_soon_threadsafe(ended.set)

        def end() -> None:
            # The loop may be closed already.
            with contextlib.suppress(RuntimeError):
                loop.call_soon_threadsafe(ending.set)

        try:
            threading.Thread(target=run, name="stops from NATS", daemon=True).start()
        except RuntimeError as error:
            log.warning("bus: no thread hears stops: %s", error)
            loop.close()
            return None
        return end

    async def _listen_until(self, ending: asyncio.Event, gateway: asyncio.AbstractEventLoop) -> None:
        """Listen until ``ending`` is set; also end the client's own tasks, as far as possible."""
        listening = asyncio.create_task(self._listen(ending, gateway))
        await ending.wait()
        listening.cancel()
        await asyncio.wait({listening}, timeout=END_S / 2)
        if rest := asyncio.all_tasks() - {asyncio.current_task()}:
            for task in rest:
                task.cancel()
            await asyncio.wait(rest, timeout=END_S / 4)

    async def _listen(self, ending: asyncio.Event, gateway: asyncio.AbstractEventLoop) -> None:
        def hand_over(_subject: str, content: bytes) -> None:
            if len(content) > LARGEST_STOP:
                return
            self._waiting.append(content)
            if self._is_due:
                return
            self._is_due = True
            try:
                gateway.call_soon_threadsafe(self._process_waiting)
            except RuntimeError:
                # That loop has ended without notice.
                ending.set()

        while True:
            while not self._main.connected:
                # The main connection goes first: a server may accept only that one.
                await asyncio.sleep(NATS_RETRY_S)
            with self._connection.faults_logged():
                async with self._connection.open(hand_over) as lost:
                    await disconnection(self._connection.client, lost)
            await asyncio.sleep(RETRY_S)

    def _process_waiting(self) -> None:
        # Cleared first: what the thread adds from here on is either processed below, or scheduled again.
        self._is_due = False
        for _ in range(len(self._waiting)):
            content = self._waiting.popleft()
            if self._receive is not None:
                with log_and_continue(log, "a stop that a thread heard"):
                    self._receive(STOP, content)


# --- The bus ---


class NatsBus:
    """One connection to a NATS server or cluster for all messages, and one for stops; ``urls`` are its URLs.

    :raises BridgeError: when nats-py is not installed.
    """

    name: ClassVar[str] = "nats"

    def __init__(self, urls: list[str], gateway: str, prefix: str, password: str | None = None) -> None:
        self._servers = NatsServers(urls, password)
        self._prefix = prefix
        self._own = own_subject(gateway)
        self._subjects = (STOP, EVERYBODY, POSITIONS, self._own)
        self._connection = NatsConnection(
            self._servers,
            "robot-bridge",
            prefix,
            self._subjects,
            "connecting again until it works",
        )
        self._stops = StopListener(self._servers, prefix, self._connection)
        self._outgoing = OutgoingMessages()

    @property
    def connected(self) -> bool:
        """Whether the connection is open, and the server knows this gateway's subscriptions."""
        return self._connection.connected

    def publish(self, subject: str, content: bytes) -> bool:
        """Send a message; return false without a connection."""
        if not self.connected:
            return False
        if subject != STOP or not write_at_once(
            self._connection.client, f"{self._prefix}.{subject}", content
        ):
            self._outgoing.add(subject, content)
        return True

    async def check(self) -> None:
        """Connect briefly, subscribe to every subject and publish on it; see :meth:`.NatsServers.check`."""
        await self._servers.check(self._prefix, self._subjects)

    async def run(self, receive: Receive) -> None:
        """Connect and send until cancelled; reconnects by itself."""
        async with self._stops.listening(receive):
            while True:
                with self._connection.faults_logged():
                    try:
                        async with self._connection.open(receive) as lost:
                            await self._send_until_lost(self._connection.client, lost)
                    finally:
                        self._outgoing.clear()
                await asyncio.sleep(NATS_RETRY_S)

    async def _send_until_lost(self, client: Any, lost: asyncio.Event) -> None:
        sending = asyncio.create_task(self._send(client))
        losing = asyncio.create_task(disconnection(client, lost))
        try:
            await asyncio.wait({sending, losing}, return_when=asyncio.FIRST_COMPLETED)
            if sending.done():
                sending.result()
        finally:
            for task in (sending, losing):
                task.cancel()
            await asyncio.gather(sending, losing, return_exceptions=True)

    async def _send(self, client: Any) -> None:
        while True:
            subject, content = await self._outgoing.next()
            await client.publish(f"{self._prefix}.{subject}", content)


def raise_if_cancelled() -> None:
    """Raise CancelledError if the running task was cancelled and the awaited call swallowed that.

    The client waits by ``asyncio.wait_for``, which in Python 3.11 returns normally when the server answers in
    the same iteration of the loop. Such a task would never end.
    """
    if (task := asyncio.current_task()) is None or task.cancelling():
        raise asyncio.CancelledError


def write_at_once(client: Any, subject: str, content: bytes) -> bool:
    """Publish on a connection of nats-py without an iteration of the loop; return false if impossible.

    The client writes published messages in its own task, whose turn comes after those of thousands of robots.
    That task does nothing if nothing is left to write. After false the message may still have been published.
    """
    with contextlib.suppress(Exception):
        publishing = client.publish(subject, content)
        try:
            publishing.send(None)
        except StopIteration:
            with contextlib.suppress(Exception):
                client._transport.writelines(client._pending[:])
                client._pending, client._pending_data_size = [], 0
            # Otherwise the client's task writes it.
            return True
        finally:
            publishing.close()
    return False


async def disconnection(client: Any, lost: asyncio.Event) -> None:
    """Wait until ``client`` has lost its server, which sets ``lost``, or the server does not answer.

    It may not be set: a client task that fails while closing the connection ends silently.
    """
    received, quiet = -1, 0
    while client.is_connected and not lost.is_set():
        # Checks are counted, not seconds: messages that came while this computer was busy are read first.
        await wait_at_most(lost, until_tick(CONNECTED_LOOK_S))
        before, received = received, client.stats["in_msgs"]
        quiet = quiet + 1 if received == before else 0
        if quiet >= QUIET_LOOKS:
            quiet = 0
            try:
                await ping(client, PONG_S)
            except Exception:
                # Whatever the error: reception is not certain.
                if client.stats["in_msgs"] == received:
                    return
