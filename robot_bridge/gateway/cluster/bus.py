"""The bus between the gateways of a fleet, for messages that may be lost: none, PostgreSQL, or NATS.

Data that must not be lost is in the database; a bus only makes it known sooner. A message is handed over
while the bus is connected, or not at all: queued messages would arrive as if they were new.
"""

from __future__ import annotations

import asyncio
import contextlib
import logging
import os
import socket
from base64 import b64decode, b64encode
from binascii import Error as Base64Error
from collections import deque
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from typing import TYPE_CHECKING, Any, ClassVar, Protocol

from sqlalchemy import URL, create_engine

if TYPE_CHECKING:
    from psycopg import AsyncConnection, Connection

log = logging.getLogger(__name__)

Receive = Callable[[str, bytes], None]
"""Receives the subject and the content of a message. It must not block."""
STOP, EVERYBODY, POSITIONS = "stop", "all", "positions"
"""Subjects that every gateway listens to; one of its own is :func:`own_subject`."""
RIGHTS_PROBE = b"?"
"""A starting gateway sends this to see if it may publish on a subject; receivers ignore it."""
MOST_WAITING = 256
"""messages that wait for the bus; beyond that the oldest are dropped, stops last."""
RETRY_S = 1.0
"""seconds between attempts to connect."""


def own_subject(gateway: str) -> str:
    """Return the subject that only ``gateway`` listens to."""
    return f"wake.{gateway}"


class Bus(Protocol):
    """Carries messages from each gateway to the others while it is connected."""

    name: ClassVar[str]
    """Its name in the option ``--bus``."""

    @property
    def connected(self) -> bool:
        """Whether messages can be sent now, as far as is known."""

    def publish(self, subject: str, content: bytes) -> bool:
        """Send a message; return at once, false if it cannot be sent now. Raises nothing."""

    async def run(self, receive: Receive) -> None:
        """Connect, and pass received messages to ``receive``, until cancelled; reconnects by itself."""


class NoBus:
    """No bus: for a sole gateway, or a fleet whose gateways only poll the database each second."""

    name: ClassVar[str] = "none"
    connected = False

    def publish(self, subject: str, content: bytes) -> bool:
        """Send nothing."""
        return False

    async def run(self, receive: Receive) -> None:
        """Wait until cancelled."""
        await asyncio.Event().wait()


class OutgoingMessages:
    """Queue of messages to send, in order; a stop is before all others."""

    def __init__(self) -> None:
        self._stops: deque[tuple[str, bytes]] = deque(maxlen=MOST_WAITING)
        self._others: deque[tuple[str, bytes]] = deque(maxlen=MOST_WAITING)
        self._some = asyncio.Event()

    def add(self, subject: str, content: bytes) -> None:
        """Queue a message."""
        (self._stops if subject == STOP else self._others).append((subject, content))
        self._some.set()

    def clear(self) -> None:
        """Drop all: the connection is lost, and the messages are old by the next one."""
        self._stops.clear()
        self._others.clear()

    async def next(self) -> tuple[str, bytes]:
        """Wait for the next message and return it."""
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

    All are reopened when one of the first two fails. Stops have their own thread: an iteration of the loop
    follows those of thousands of robots, and a notification takes several.
    """

    name: ClassVar[str] = "postgresql"

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
        """Whether both connections are open."""
        return self._connected

    def publish(self, subject: str, content: bytes) -> bool:
        """Send a message; return false without a connection, and for one too long for a notification."""
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
            if self._said:
                log.warning("bus on PostgreSQL: connected again")
            self._connected, self._said = True, ""
            tasks = [
                asyncio.create_task(self._listen(listening, receive)),
                asyncio.create_task(self._send(sending)),
            ]
            try:
                # The first failure ends both.
                await asyncio.gather(*tasks)
            finally:
                for task in tasks:
                    task.cancel()
                await asyncio.gather(*tasks, return_exceptions=True)

    async def _connect(self) -> AsyncConnection[Any]:
        import psycopg

        from ..storage.dialects import ENDLESS

        arguments, options = self._arguments()
        connection = await psycopg.AsyncConnection.connect(*arguments, **options)
        await connection.execute(ENDLESS)
        return connection

    def _connect_for_stops(self) -> Connection[Any]:
        import psycopg

        from ..storage.dialects import ENDLESS

        arguments, options = self._arguments()
        connection = psycopg.connect(*arguments, **options)
        connection.execute(ENDLESS)
        return connection

    def _arguments(self) -> tuple[Any, dict[str, Any]]:
        from ..storage.dialects import CONNECT_ARGUMENTS

        engine = create_engine(self._url.set(drivername="postgresql+psycopg"))
        arguments, options = engine.dialect.create_connect_args(engine.url)
        return arguments, {**options, **CONNECT_ARGUMENTS, "autocommit": True}

    def _notify_of_stop(
        self, connection: Connection[Any], content: bytes, loop: asyncio.AbstractEventLoop
    ) -> None:
        """Notify in the thread of stops; if that connection alone fails, the loop sends it in its turn."""
        try:
            connection.execute(_NOTIFY, _notification(STOP, content))
        except Exception as error:
            log.debug("a stop is notified of in its turn: %s", error)
            with contextlib.suppress(RuntimeError):
                loop.call_soon_threadsafe(self._send_in_turn, connection, content)

    def _send_in_turn(self, connection: Connection[Any], content: bytes) -> None:
        """Queue a stop that ``connection`` did not take, unless that was lost with the others: it is old."""
        if connection is self._stopping:
            self._outgoing.add(STOP, content)

    def _end_stopping(self) -> None:
        connection, self._stopping = self._stopping, None
        if connection is None:
            return
        with contextlib.suppress(Exception), socket.socket(fileno=os.dup(connection.fileno())) as own:
            # The thread may wait for a server that hangs: end that wait.
            own.shutdown(socket.SHUT_RDWR)
        self._thread.submit(connection.close)

    async def _listen(self, connection: AsyncConnection[Any], receive: Receive) -> None:
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
