"""Exchange: messages out onto the buses of this gateway, and those that come in to whoever subscribed."""

from __future__ import annotations

import asyncio
import logging
import secrets
import time
from collections.abc import Callable, Sequence
from typing import TypeVar

from sqlalchemy import Connection

from ...core.logs import RepeatedLines
from ..model.events import EventBus
from ..storage.repositories import metadata
from .bus import EVERYBODY, STOP, Bus, own_subject
from .messages import (
    Beat,
    BusMessage,
    BusMessageError,
    Codec,
    NameAnswer,
    NameQuery,
    StopCall,
    Wake,
    WakeTopic,
)

log = logging.getLogger(__name__)

KEY = "bus_key"
"""The fact of the database that is the secret by which messages are signed."""
HEARD_S = 5.0
"""seconds after which a gateway that says nothing is not heard any more."""

Kind = TypeVar("Kind", bound=BusMessage)


def fleet_key(connection: Connection) -> bytes:
    """Return the secret of the fleet on this database; one that has none yet is given it."""
    return bytes.fromhex(metadata.fact(connection, KEY, secrets.token_hex(32)))


class Exchange:
    """Sends over the first bus; stops, what wakes others, and questions over all of them.

    A subscriber that fails keeps a message from no other one.
    """

    def __init__(self, gateway: str, key: bytes, buses: Sequence[Bus]) -> None:
        self.gateway = gateway
        self._codec = Codec(key)
        self._buses = buses
        self._events = EventBus()
        self._heard: dict[str, float] = {}
        self._repeated = RepeatedLines()

    def subscribe(self, kind: type[Kind], handler: Callable[[Kind], None]) -> None:
        """Call ``handler``, which must not block, with each message of ``kind`` from another gateway."""
        self._events.subscribe(kind, handler)

    def send(self, subject: str, message: BusMessage) -> bool:
        """Send a message; return at once, true where some bus took it."""
        content = self._codec.encode(message)
        urgent = subject == STOP or isinstance(message, (Wake, NameQuery, NameAnswer))
        taken = [bus.publish(subject, content) for bus in (self._buses if urgent else self._buses[:1])]
        return any(taken)

    def wake(self, what: WakeTopic, gateway: str | None = None) -> None:
        """Have a gateway, or all others, look at once for ``what`` has been committed."""
        subject = EVERYBODY if gateway is None else own_subject(gateway)
        self.send(subject, Wake(self.gateway, what))

    def beat(self) -> None:
        """Tell the others that this gateway is there."""
        self.send(EVERYBODY, Beat(self.gateway))

    @property
    def connected(self) -> bool:
        """Whether some bus is connected, as far as is known."""
        return any(bus.connected for bus in self._buses)

    def heard(self) -> list[str]:
        """Return the other gateways that said something of late."""
        now = time.monotonic()
        return sorted(name for name, at in self._heard.items() if now - at < HEARD_S)

    async def run(self) -> None:
        """Keep all buses connected until cancelled."""
        async with asyncio.TaskGroup() as group:
            for bus in self._buses:
                group.create_task(bus.run(self.receive))

    def receive(self, subject: str, content: bytes) -> None:
        """Take in a message as it came from a bus."""
        try:
            message = self._codec.decode(content)
        except BusMessageError as error:
            self._repeated.warn(
                log, ("bus", "of the fleet:", subject.partition(".")[0]), f"bus, subject {subject}: {error}"
            )
            return
        if message.gw == self.gateway:
            return
        self._heard[message.gw] = time.monotonic()
        if isinstance(message, StopCall) and subject != STOP:
            return
        self._events.publish(message)
