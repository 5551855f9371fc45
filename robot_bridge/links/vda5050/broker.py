"""The connection to the MQTT broker: it reconnects, and carries no outdated messages."""

from __future__ import annotations

import asyncio
import logging
import random
from collections import deque
from collections.abc import Sequence
from typing import Any, Protocol

import aiomqtt

from ...core.reconnection import connection_failure
from .messages import Vda5050Error
from .settings import BrokerAddress

log = logging.getLogger(__name__)

FIRST_WAIT, LONGEST_WAIT = 0.5, 10.0
"""seconds between attempts to connect."""
STABLE_AFTER = 5.0
"""seconds after which a connection counts as stable."""
CONNECT_WITHIN = 5.0
KEEPALIVE = 10
"""seconds after which the broker is pinged; one that does not answer is gone after half as much again."""
MOST_WAITING = 20_000
"""messages of vehicles that wait to be read; beyond that the newest are discarded."""
LARGEST = 1 << 20
"""bytes of a received message."""
REFUSED = 0x80
"""and above: a broker's answer to a refused subscription."""
TOGETHER = 200
"""messages read before other tasks get a turn."""


class BrokerListener(Protocol):
    """Receives messages of the broker, and the state of the connection."""

    def receive(self, topic: str, payload: bytes, *, retained: bool) -> None:
        """Process a message; ``retained``: the broker had kept it from earlier."""

    def broker_changed(self, reason: str | None) -> None:
        """Record that the broker is connected (None), or why it is not."""


class Broker:
    """Publishes and receives at QoS 0, as VDA 5050 requires; connection messages use QoS 1.

    Messages without a connection are discarded: the publisher repeats them while due.
    """

    def __init__(
        self, address: BrokerAddress, subscriptions: Sequence[str], listener: BrokerListener
    ) -> None:
        self._address = address
        self._subscriptions = subscriptions
        self._listener = listener
        self._urgent: deque[tuple[str, bytes]] = deque()
        self._outgoing: deque[tuple[str, bytes]] = deque()
        self._wake = asyncio.Event()
        self._is_connected = False

    @property
    def is_connected(self) -> bool:
        """Whether the broker accepts messages."""
        return self._is_connected

    def publish(self, topic: str, payload: bytes, *, urgent: bool) -> None:
        """Publish a message, one that is ``urgent`` before the others; nothing waits for a connection."""
        if self._is_connected:
            (self._urgent if urgent else self._outgoing).append((topic, payload))
            self._wake.set()

    def withdraw(self, topic: str) -> None:
        """Drop the waiting messages of a topic: a stop has overtaken an order."""
        self._outgoing = deque(waiting for waiting in self._outgoing if waiting[0] != topic)

    async def run(self) -> None:
        """Carry messages until cancelled."""
        wait = FIRST_WAIT
        loop = asyncio.get_running_loop()
        while True:
            begun = loop.time()
            try:
                async with self._client() as client:
                    await self._carry(client)
                reason = "it closed the connection"
            except aiomqtt.MqttError as error:
                reason = _reason(error)
            except Vda5050Error as error:
                reason = str(error)
            except OSError as error:
                reason = connection_failure(error)
            finally:
                self._lose()
            if loop.time() - begun > STABLE_AFTER:
                wait = FIRST_WAIT
            self._listener.broker_changed(f"broker {self._address}: {reason}")
            log.warning("broker %s: %s; trying again in %.1f s", self._address, reason, wait)
            await asyncio.sleep(wait * random.uniform(0.8, 1.2))  # nosec B311 # no secret
            wait = min(wait * 2, LONGEST_WAIT)

    def _client(self) -> aiomqtt.Client:
        address = self._address
        return aiomqtt.Client(
            address.host,
            address.port,
            username=address.user,
            password=address.password(),
            identifier=address.client_id,
            clean_session=True,
            keepalive=KEEPALIVE,
            timeout=CONNECT_WITHIN,
            tls_context=address.tls,
            max_queued_incoming_messages=MOST_WAITING,
        )

    async def _carry(self, client: aiomqtt.Client) -> None:
        writing = asyncio.create_task(self._write(client))
        reading = asyncio.create_task(self._read(client))
        try:
            for topic in self._subscriptions:
                granted = await client.subscribe(topic, qos=1 if topic.endswith("/connection") else 0)
                check_granted(topic, granted)
            self._is_connected = True
            self._listener.broker_changed(None)
            done, _ = await asyncio.wait({writing, reading}, return_when=asyncio.FIRST_COMPLETED)
            for task in done:
                task.result()
        finally:
            for task in (writing, reading):
                task.cancel()
            await asyncio.gather(writing, reading, return_exceptions=True)

    async def _read(self, client: aiomqtt.Client) -> None:
        read = 0
        async for message in client.messages:
            payload = message.payload
            if isinstance(payload, bytes | bytearray):
                content = bytes(payload[: LARGEST + 1])
                self._listener.receive(message.topic.value, content, retained=bool(message.retain))
            read += 1
            if read % TOGETHER == 0:
                await asyncio.sleep(0)

    async def _write(self, client: aiomqtt.Client) -> None:
        while True:
            await self._wake.wait()
            self._wake.clear()
            while self._urgent or self._outgoing:
                topic, payload = (self._urgent or self._outgoing).popleft()
                await client.publish(topic, payload, qos=0)

    def _lose(self) -> None:
        self._is_connected = False
        self._urgent.clear()
        self._outgoing.clear()


def check_granted(topic: str, granted: Sequence[Any]) -> None:
    """Raise MqttError for a subscription that the broker does not allow: nothing would ever be received."""
    if any(getattr(code, "value", code) >= REFUSED for code in granted):
        raise aiomqtt.MqttError(f"it does not allow to subscribe to {topic}; allow that to this client")


def _reason(error: aiomqtt.MqttError) -> str:
    """Return why there is no connection, in the broker's words if it gave any."""
    code = getattr(error, "rc", None)
    if error.args and isinstance(code, int):
        return str(error.args[0])
    return connection_failure(error)
