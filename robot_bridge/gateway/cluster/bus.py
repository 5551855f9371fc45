"""The bus between the gateways of a fleet: what may be lost travels over it. Its makes are none and two.

What may not be lost is in the database; a bus only makes it known sooner. A message is handed over while the
bus is connected, or not at all: what waited for a connection would arrive as if it were new.
"""

from __future__ import annotations

import asyncio
import contextlib
import logging
import os
import random
import socket
from base64 import b64decode, b64encode
from binascii import Error as Base64Error
from collections import deque
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from typing import TYPE_CHECKING, Any, Protocol
from urllib.parse import urlsplit

from sqlalchemy import URL, create_engine

from ...core.errors import BridgeError
from ...core.logs import log_unforeseen
from ..monitoring import wait_at_most

if TYPE_CHECKING:
    from psycopg import AsyncConnection, Connection

log = logging.getLogger(__name__)

Receive = Callable[[str, bytes], None]
"""Takes in a message: its subject and its content. It must not block."""
STOP, EVERYBODY, POSITIONS = "stop", "all", "positions"
"""Subjects that every gateway listens to; one of its own is :func:`own_subject`."""
MOST_WAITING = 256
"""messages that wait to be handed to the bus; of what is beyond that the oldest are dropped, stops last."""
RETRY_S, NATS_RETRY_S = 1.0, 0.1
"""seconds from one attempt to connect to the next."""
CONNECTED_LOOK_S = 0.2
"""seconds after which a connection is looked at that did not say that it was lost."""


def own_subject(gateway: str) -> str:
    """Return the subject that only ``gateway`` listens to."""
    return f"wake.{gateway}"


class Bus(Protocol):
    """Carries messages from each gateway to the others, as long as it is connected."""

    @property
    def connected(self) -> bool:
        """Whether messages get out at the moment, as far as is known."""

    def publish(self, subject: str, content: bytes) -> bool:
        """Send a message; return at once, false where it cannot be sent now. Raises nothing."""

    async def run(self, receive: Receive) -> None:
        """Connect, and hand what comes in to ``receive``, until cancelled; connects again by itself."""


class NoBus:
    """The bus of a gateway that serves its fleet alone, or whose fleet is content to look once a second."""

    connected = False

    def publish(self, subject: str, content: bytes) -> bool:
        """Send nothing."""
        return False

    async def run(self, receive: Receive) -> None:
        """Wait until cancelled."""
        await asyncio.Event().wait()


class OutgoingMessages:
    """Messages that wait to be sent, in their order; a stop is before all others."""

    def __init__(self) -> None:
        self._stops: deque[tuple[str, bytes]] = deque(maxlen=MOST_WAITING)
        self._others: deque[tuple[str, bytes]] = deque(maxlen=MOST_WAITING)
        self._some = asyncio.Event()

    def add(self, subject: str, content: bytes) -> None:
        """Have a message sent."""
        (self._stops if subject == STOP else self._others).append((subject, content))
        self._some.set()

    def clear(self) -> None:
        """Forget all: the connection is gone, and what was said is old by the next one."""
        self._stops.clear()
        self._others.clear()

    async def next(self) -> tuple[str, bytes]:
        """Return the next message once there is one."""
        while not (self._stops or self._others):
            self._some.clear()
            await self._some.wait()
        return (self._stops or self._others).popleft()


# --- PostgreSQL: LISTEN and NOTIFY, for two or three gateways, without a further server ---

CHANNEL = "fleet"
LARGEST_NOTIFICATION = 5900
"""bytes of a message: PostgreSQL takes 8000 characters, and base64 makes four of three bytes."""
SENT_WITHIN_S = 2.0
_NOTIFY = "select pg_notify(%s, %s)"


class NotifyBus:
    """One connection that listens, one that notifies, and one that notifies of stops alone.

    All are opened anew when one of the first two fails. Stops have a thread of their own: a turn of the
    loop comes after those of thousands of robots, and a notification takes several.
    """

    def __init__(self, url: URL, gateway: str) -> None:
        self._url = url
        self._stopping: Connection[Any] | None = None
        self._thread = ThreadPoolExecutor(1, "notifications of stops")
        self._subjects = (STOP, EVERYBODY, POSITIONS, own_subject(gateway))
        self._outgoing = OutgoingMessages()
        self._connected = False
        self._said = ""

    @property
    def connected(self) -> bool:
        """Whether both connections stand."""
        return self._connected

    def publish(self, subject: str, content: bytes) -> bool:
        """Send a message; false while there is no connection, and for one that is too long to be notified."""
        if not self._connected or len(content) > LARGEST_NOTIFICATION:
            return False
        if subject == STOP and self._stopping is not None:
            loop = asyncio.get_running_loop()
            self._thread.submit(self._notify_of_stop, self._stopping, content, loop)
        else:
            self._outgoing.add(subject, content)
        return True

    async def run(self, receive: Receive) -> None:
        """Listen and notify until cancelled."""
        import psycopg

        while True:
            try:
                await self._serve(receive)
            except (psycopg.Error, OSError, TimeoutError) as error:
                reason = " ".join(str(error).split()) or "PostgreSQL does not answer"
                if reason != self._said:
                    log.warning("bus on PostgreSQL: %s; connecting again until it works", reason)
                self._said = reason
            finally:
                self._connected = False
                self._outgoing.clear()
            await asyncio.sleep(RETRY_S)

    async def _serve(self, receive: Receive) -> None:
        async with contextlib.AsyncExitStack() as stack:
            listening = await stack.enter_async_context(await self._connect())
            sending = await stack.enter_async_context(await self._connect())
            self._stopping = await asyncio.to_thread(self._connect_for_stops)
            stack.callback(self._end_stopping)
            for subject in self._subjects:
                await listening.execute(f'listen "{CHANNEL}.{subject}"'.encode())
            self._connected, self._said = True, ""
            tasks = [
                asyncio.create_task(self._hear(listening, receive)),
                asyncio.create_task(self._send(sending)),
            ]
            try:
                # The first that fails ends both.
                await asyncio.gather(*tasks)
            finally:
                for task in tasks:
                    task.cancel()
                await asyncio.gather(*tasks, return_exceptions=True)

    async def _connect(self) -> AsyncConnection[Any]:
        import psycopg

        arguments, options = self._arguments()
        return await psycopg.AsyncConnection.connect(*arguments, **options)

    def _connect_for_stops(self) -> Connection[Any]:
        import psycopg

        arguments, options = self._arguments()
        return psycopg.connect(*arguments, **options)

    def _arguments(self) -> tuple[Any, dict[str, Any]]:
        from ..storage.dialects import CONNECT_ARGUMENTS

        engine = create_engine(self._url.set(drivername="postgresql+psycopg"))
        arguments, options = engine.dialect.create_connect_args(engine.url)
        return arguments, {**options, **CONNECT_ARGUMENTS, "autocommit": True}

    def _notify_of_stop(
        self, connection: Connection[Any], content: bytes, loop: asyncio.AbstractEventLoop
    ) -> None:
        """Notify in the thread of stops; where that fails the loop does it in its turn."""
        try:
            connection.execute(_NOTIFY, _notification(STOP, content))
        except Exception as error:
            log.debug("a stop is notified of in its turn: %s", error)
            with contextlib.suppress(RuntimeError):
                loop.call_soon_threadsafe(self._outgoing.add, STOP, content)

    def _end_stopping(self) -> None:
        connection, self._stopping = self._stopping, None
        if connection is None:
            return
        with contextlib.suppress(Exception), socket.socket(fileno=os.dup(connection.fileno())) as own:
            # The thread may wait for a server that hangs: it is to wait no more.
            own.shutdown(socket.SHUT_RDWR)
        self._thread.submit(connection.close)

    async def _hear(self, connection: AsyncConnection[Any], receive: Receive) -> None:
        async for notification in connection.notifies():
            try:
                content = b64decode(notification.payload, validate=True)
            except (Base64Error, ValueError):
                content = b""
            receive(notification.channel.removeprefix(f"{CHANNEL}."), content)

    async def _send(self, connection: AsyncConnection[Any]) -> None:
        while True:
            subject, content = await self._outgoing.next()
            async with asyncio.timeout(SENT_WITHIN_S):
                await connection.execute(_NOTIFY, _notification(subject, content))


def _notification(subject: str, content: bytes) -> tuple[str, str]:
    return f"{CHANNEL}.{subject}", b64encode(content).decode("ascii")


# --- NATS: for any number of gateways ---

OLDEST_NATS = (2, 10, 26)
CONNECT_S, FLUSH_S = 2.0, 2.0
QUIET_LOOKS, PONG_S = 10, 1.0
"""Looks at a connection by which nothing came, after which it is asked whether it stands, and seconds for the
answer: a stop of the network is known after three seconds. One by which messages come is not asked: with many
robots on a busy computer the answer waits behind positions for longer than that."""
PING_S = 30
"""seconds between pings of the client itself, two of which may be without an answer."""
PENDING_BYTES = 4 << 20
"""bytes that wait for a slow server."""


class NatsBus:
    """One connection to a NATS server or cluster; ``servers`` are its URLs.

    :raises BridgeError: when nats-py is not installed.
    """

    def __init__(self, servers: list[str], gateway: str, prefix: str, password: str | None = None) -> None:
        try:
            import nats
        except ImportError:
            raise BridgeError(
                "the bus nats:// needs nats-py; install it with: "
                "pip install 'fleet-supervisor-robot-bridge[cluster]'"
            ) from None
        self._nats = nats
        self._servers = servers
        self._prefix = prefix
        self._subjects = (STOP, EVERYBODY, POSITIONS, own_subject(gateway))
        self._password = password
        self._client: Any = None
        self._outgoing = OutgoingMessages()
        self._said = set[str]()
        """why there is no connection, since there was one."""

    @property
    def connected(self) -> bool:
        """Whether the connection stands, and the server knows what this gateway listens to."""
        return self._client is not None and bool(self._client.is_connected)

    def publish(self, subject: str, content: bytes) -> bool:
        """Send a message; false while there is no connection."""
        if not self.connected:
            return False
        if subject != STOP or not write_at_once(self._client, f"{self._prefix}.{subject}", content):
            self._outgoing.add(subject, content)
        return True

    async def check(self) -> None:
        """Connect for a moment.

        :raises BridgeError: when there is no server, it is too old, or it does not let this gateway speak.
        """
        faults: list[str] = []
        heard = asyncio.Event()

        async def add_fault(error: Exception) -> None:
            faults.append(str(error))
            heard.set()

        async def hear(_message: Any) -> None:
            heard.set()

        try:
            async with asyncio.timeout(self._patience):
                client = await self._connect(add_fault, allow_reconnect=False)
        except (self._nats.errors.Error, OSError, TimeoutError) as error:
            raise BridgeError(
                f"bus {self._where}: {str(error) or 'no server answers'}{_all(faults)}; check that NATS "
                "runs there, and the account of this gateway"
            ) from None
        try:
            check_version(self._where, client.connected_server_version)
            subject = self._subjects[-1]
            await client.subscribe(f"{self._prefix}.{subject}", cb=hear)
            await client.publish(f"{self._prefix}.{subject}", b"")
            async with asyncio.timeout(FLUSH_S):
                await heard.wait()
        except TimeoutError:
            faults.append("what this gateway publishes does not come back to it")
        finally:
            await client.close()
        if faults:
            raise BridgeError(
                f"bus {self._where}: {_all(faults).lstrip(': ')}; the account of this gateway has to be "
                f"allowed to publish and to subscribe to {self._prefix}.>"
            )

    async def run(self, receive: Receive) -> None:
        """Connect and send until cancelled; the client connects again by itself."""
        while True:
            try:
                await self._serve(receive)
            except (self._nats.errors.Error, OSError, TimeoutError, BridgeError) as error:
                self._say(str(error) or "no server answers")
            except Exception:
                # Whatever the library stumbles over: the bus is there again a moment later.
                log_unforeseen(log, f"bus {self._where}")
            finally:
                self._outgoing.clear()
            await asyncio.sleep(NATS_RETRY_S)

    async def _serve(self, receive: Receive) -> None:
        lost = asyncio.Event()

        async def ended() -> None:
            lost.set()

        async def log_fault(error: Exception) -> None:
            self._say(str(error))

        async with asyncio.timeout(self._patience):
            # A connection that is lost is made anew here, not by the client: it would keep what is published
            # meanwhile, and send that as if it were new.
            client = await self._connect(
                log_fault, allow_reconnect=False, disconnected_cb=ended, closed_cb=ended
            )
        try:
            check_version(self._where, client.connected_server_version)
            await self._subscribe(client, receive)
            self._client = client
            self._said.clear()
            await self._send_until_lost(client, lost)
        finally:
            self._client = None
            with contextlib.suppress(Exception):
                async with asyncio.timeout(FLUSH_S):
                    await client.close()
        raise OSError("the connection is lost")

    async def _subscribe(self, client: Any, receive: Receive) -> None:
        """Return when the server knows what this gateway listens to: what is said before is not heard."""
        cut = len(self._prefix) + 1

        async def hear(message: Any) -> None:
            receive(message.subject[cut:], message.data)
            # The client hands over all that waits without a pause, and answers no pings meanwhile.
            await asyncio.sleep(0)

        for subject in self._subjects:
            # Each has a queue of its own: no stop waits behind positions.
            await client.subscribe(f"{self._prefix}.{subject}", cb=hear)
        await client.flush(FLUSH_S)

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

    async def _connect(self, on_error: Any, **options: Any) -> Any:
        """Connect to one of the servers; raises what the last one brought about."""
        servers = random.sample(self._servers, len(self._servers))  # nosec B311 # nothing secret: spreads load
        for server in servers:
            try:
                return await self._connect_to(server, on_error, **options)
            except (self._nats.errors.Error, OSError, TimeoutError):
                if server is servers[-1]:
                    raise
        raise AssertionError("there is a server")

    async def _connect_to(self, server: str, on_error: Any, **options: Any) -> Any:
        if self._password is not None:
            options |= {"user": urlsplit(server).username, "password": self._password}
        return await self._nats.connect(
            server,
            error_cb=on_error,
            connect_timeout=CONNECT_S,
            reconnect_time_wait=0.1,
            max_reconnect_attempts=1,
            ping_interval=PING_S,
            max_outstanding_pings=2,
            pending_size=PENDING_BYTES,
            no_echo=False,
            name="robot-bridge",
            **options,
        )

    @property
    def _patience(self) -> float:
        return 2 * CONNECT_S * len(self._servers)

    @property
    def _where(self) -> str:
        return ",".join(server.rpartition("@")[2].removeprefix("nats://") for server in self._servers)

    def _say(self, reason: str) -> None:
        if reason not in self._said:
            log.warning("bus %s: %s; connecting again until it works", self._where, reason)
        self._said.add(reason)


def write_at_once(client: Any, subject: str, content: bytes) -> bool:
    """Publish on a connection of nats-py without a turn of the loop; false where that cannot be.

    The client writes what was published in a task of its own, whose turn comes after those of thousands of
    robots. It does nothing where nothing is left to be written. A message of which this says false may have
    been published all the same.
    """
    with contextlib.suppress(Exception):
        publishing = client.publish(subject, content)
        try:
            publishing.send(None)
        except StopIteration:
            with contextlib.suppress(Exception):
                client._transport.writelines(client._pending[:])
                client._pending, client._pending_data_size = [], 0
            # If not now, it is written by the client's task.
            return True
        finally:
            publishing.close()
    return False


async def disconnection(client: Any, lost: asyncio.Event) -> None:
    """Wait until ``client`` has lost its server, which it says by ``lost``, or the server does not answer.

    It may not say so: a task of its own that fails as it closes the connection ends without a word.
    """
    heard, quiet = -1, 0
    while client.is_connected and not lost.is_set():
        # Looks are counted, not seconds: what came while this computer was busy is read before the next one.
        await wait_at_most(lost, CONNECTED_LOOK_S)
        before, heard = heard, client.stats["in_msgs"]
        quiet = quiet + 1 if heard == before else 0
        if quiet >= QUIET_LOOKS:
            quiet = 0
            try:
                await client.flush(PONG_S)
            except Exception:
                # Whatever it is: it is not certain that others are heard.
                if client.stats["in_msgs"] == heard:
                    return


def check_version(where: str, version: Any) -> None:
    """Raise BridgeError for a server that is too old; ``version`` is what nats-py knows of it."""
    found = (version.major, version.minor, version.patch)
    if found < OLDEST_NATS:
        wanted = ".".join(map(str, OLDEST_NATS))
        raise BridgeError(
            f"bus {where}: NATS {'.'.join(map(str, found))} lets one reader that stands still delay all "
            f"others for seconds; install {wanted} or newer (Debian 13's package nats-server runs on Debian "
            "12)"
        )


def _all(faults: list[str]) -> str:
    return f": {'; '.join(dict.fromkeys(faults))}" if faults else ""
