"""Connection to a rosbridge server: reconnects, bounded frames, JSON of ROS messages."""

from __future__ import annotations

import asyncio
import itertools
import logging
import random
import time
from collections import deque
from collections.abc import Callable
from dataclasses import dataclass, field
from functools import partial
from typing import Any

import msgspec
import numpy as np
from websockets.asyncio.client import ClientConnection, connect
from websockets.exceptions import ConnectionClosed, InvalidHandshake, InvalidURI

from ...core.errors import AccessError
from ...core.logs import end_on_error
from ...core.reconnection import connection_failure
from ..base.errors import LinkError
from ..ros.errors import FaultError
from . import decoding
from .settings import Server

# --- ROS messages as JSON for a rosbridge server, which fills in omitted fields ---

LARGEST_SENT = 10_000_000
"""bytes of a message: the default limit of a rosbridge server."""
_WITH_GOALS = ("kilted", "lyrical")
"""Distributions whose NavigateThroughPoses uses nav_msgs/Goals."""


class JsonMessages:
    """Builds messages: dicts by field names."""

    def __init__(self, distribution: str) -> None:
        self._distribution = distribution

    def knows(self, type_name: str) -> bool:
        """Return whether the robots' distribution has a type."""
        return type_name != "nav_msgs/msg/Goals" or self._distribution in _WITH_GOALS

    def make(self, type_name: str, **fields: Any) -> Any:
        """Return a message; omitted fields are zero, empty, or built of such."""
        return fields


def encode(_type_name: str, message: Any) -> bytes:
    """Return a message as JSON; raises ValueError for one that no server accepts."""
    encoded = msgspec.json.encode(message, enc_hook=plain)
    if len(encoded) > LARGEST_SENT:
        raise ValueError(
            f"it has {len(encoded)} bytes as JSON, and {LARGEST_SENT} are the most; make "
            "rosbridge.map_resolution_m larger"
        )
    return encoded


def plain(value: Any) -> Any:
    """Return an array of numpy as a list."""
    if isinstance(value, np.ndarray):
        return value.tolist()
    raise TypeError(f"{type(value).__name__} cannot be written as JSON")


# --- The connection to a rosbridge server: reconnects, and renews all subscriptions and publications ---
# Messages without a connection are discarded: senders of important ones repeat them while due.

log = logging.getLogger(__name__)

FIRST_WAIT, LONGEST_WAIT = 0.5, 10.0
"""seconds between attempts to connect."""
STABLE_AFTER = 5.0
"""seconds after which a connection counts as stable."""
PING_EVERY = 5.0
"""seconds between pings; a server without an answer for as long again is gone."""
MAPS_PATIENCE_S = 120.0
"""seconds that a server has to answer a ping behind maps: a large one on a slow line."""
MOST_KEPT = 64
"""messages of one topic that wait to be read; beyond that the oldest are discarded."""
MOST_WAITING = 2_000
"""operations that wait to be sent; further ones are discarded, except commands to robots."""
MOST_ANSWERS_WAITING = 100
"""waiting operations beyond which no service call is answered."""
MOST_CALLS = 10_000
"""services and goals with pending answers."""
MOST_FAULTS = 100
LATELY = 10.0
"""seconds for which an unusable frame is reported."""
TOGETHER = 100
"""frames read before other tasks get a turn."""

MOST_UNREAD, MOST_COMMANDS_UNREAD = 20, 30
"""operations that a server may not have processed yet; the second limit is for commands to robots. A server
with 256 waiting operations of a client, or 64 answers to it, ends the connection (rosbridge-server-rs)."""
ASK_EVERY = 10
"""operations after which the server is probed for their completion."""
UNANSWERED_AFTER = 3.0
"""seconds without an answer to the probe after which sending continues: stops must go out."""

Frame = bytes | Callable[[], bytes]
Answer = decoding.ServiceResponse | decoding.ActionFeedback | decoding.ActionResult


@dataclass
class Inbox:
    """Received items for one reader, oldest first: messages of a topic, or answers."""

    waiting: deque[Any] = field(default_factory=lambda: deque(maxlen=MOST_KEPT))

    def drain(self) -> list[Any]:
        """Return and remove the received items."""
        came = list(self.waiting)
        self.waiting.clear()
        return came


@dataclass(frozen=True)
class Subscription:
    """Parameters of a subscription."""

    type_name: str
    throttle_ms: int = 0
    queue_length: int = 0
    compression: str = "none"


class RosbridgeConnection:
    """A client of one server. Not thread-safe.

    ``session`` counts the connections; ``away`` is why there is none, None while connected. A server has
    ``patience`` seconds to answer a ping.
    """

    def __init__(self, server: Server, patience: float = PING_EVERY) -> None:
        self._server = server
        self._patience = patience
        self.away: str | None = f"{server.url}: not connected yet"
        self.session = 0
        self._faults: dict[str, tuple[float, str]] = {}
        """Times and texts of faulty frames, by the beginning of the text."""
        self._subscribed: dict[str, tuple[Subscription, Inbox]] = {}
        self._advertised: dict[str, bytes] = {}
        self._latched: dict[str, Frame] = {}
        self._served: dict[str, tuple[str, Any]] = {}
        """Type and reply of the services served here."""
        self._pending_calls: dict[str, Callable[[Answer], None]] = {}
        self._ids = itertools.count(1)
        self._commands: deque[Frame] = deque()
        """Commands to robots, in order: a cancel never precedes the goal that it cancels."""
        self._others: deque[Frame] = deque()
        self._wake = asyncio.Event()
        self._sent = self._dealt_with = 0
        """Operations sent on this connection, and those known to be processed by the server."""
        self._is_answering = True

    @property
    def faults(self) -> list[str]:
        """Faults of the connection and of recent frames, as texts."""
        since = time.monotonic() - LATELY
        recent = [text for at, text in self._faults.values() if at > since]
        return [*([self.away] if self.away else []), *recent]

    # --- topics ---------------------------------------------------------------------------------------------

    def subscribe(self, topic: str, subscription: Subscription) -> Inbox:
        """Subscribe to a topic, now and after each reconnect."""
        known = self._subscribed.get(topic)
        if known is not None and known[0] == subscription:
            return known[1]
        if known is not None:
            self.unsubscribe(topic)
        inbox = Inbox()
        self._subscribed[topic] = (subscription, inbox)
        self._post(_encoded(_subscribe(topic, subscription)), kept=True)
        return inbox

    def renew(self, topic: str) -> None:
        """Renew a subscription: a server that knows the publishers requests their latched messages."""
        subscription = self._subscribed[topic][0]
        self._send(_unsubscribe(topic))
        self._send(_subscribe(topic, subscription))

    def unsubscribe(self, topic: str) -> None:
        """End a subscription."""
        if self._subscribed.pop(topic, None) is not None:
            self._send(_unsubscribe(topic))

    def advertise(self, topic: str, type_name: str, *, latched: bool = False) -> None:
        """Advertise a topic, now and after each reconnect."""
        advertisement = _encoded({"op": "advertise", "topic": topic, "type": type_name, "latch": latched})
        if self._advertised.get(topic) == advertisement:
            return
        if topic in self._advertised:
            self._send({"op": "unadvertise", "topic": topic})
        self._advertised[topic] = advertisement
        self._post(advertisement, kept=True)

    def publish(self, topic: str, message: Any, *, urgent: bool = False, latched: bool = False) -> None:
        """Publish a message; one that is ``latched`` again after each reconnect."""
        operation = {"op": "publish", "topic": topic, "msg": message}
        if latched:
            # Encoded when sent: the maps of many robots share one in memory.
            self._latched[topic] = partial(_encoded, operation)
            self._post(self._latched[topic])
        else:
            self._send(operation, urgent=urgent)

    # --- services and actions -------------------------------------------------------------------------------

    def call(
        self, service: str, args: Any, answered: Callable[[Answer], None], *, urgent: bool = False
    ) -> None:
        """Call a service; ``answered`` is called once, or never if the connection ends before."""
        id = f"call:{next(self._ids)}"
        self._expect(id, answered)
        self._send({"op": "call_service", "id": id, "service": service, "args": args}, urgent=urgent)

    def serve(self, service: str, type_name: str, reply: Any) -> None:
        """Serve a service with the fixed ``reply``, now and after each reconnect."""
        is_new = service not in self._served
        self._served[service] = (type_name, reply)
        if is_new:
            self._send(_serve(service, type_name))

    def send_goal(
        self, id: str, action: str, type_name: str, goal: Any, answered: Callable[[Answer], None]
    ) -> None:
        """Send a goal; ``answered`` is called with feedback and result while this connection lasts."""
        self._expect(id, answered)
        self._send(
            {
                "op": "send_action_goal",
                "id": id,
                "action": action,
                "action_type": type_name,
                "args": goal,
                "feedback": True,
            },
            urgent=True,
        )

    def cancel_goal(self, id: str, action: str) -> None:
        """Cancel a goal that was sent over this connection."""
        self._send({"op": "cancel_action_goal", "id": id, "action": action}, urgent=True)

    # --- the connection -------------------------------------------------------------------------------------

    async def run(self) -> None:
        """Carry operations until cancelled; raises LinkError for faults that a person must put right."""
        wait = FIRST_WAIT
        loop = asyncio.get_running_loop()
        while True:
            begun = loop.time()
            try:
                async with connect(
                    self._server.url,
                    max_size=decoding.LARGEST_FRAME,
                    close_timeout=1,
                    ping_interval=PING_EVERY,
                    ping_timeout=self._patience,
                    **self._server.options(),
                ) as connection:
                    await self._carry(connection)
                reason = "it closed the connection"
            except InvalidURI as error:
                raise LinkError(f"rosbridge.url: {error}") from None
            except (AccessError, InvalidHandshake, ConnectionClosed) as error:
                reason = str(error)
            except OSError as error:
                reason = connection_failure(error)
            if loop.time() - begun > STABLE_AFTER:
                wait = FIRST_WAIT
            self.away = f"rosbridge at {self._server.url}: {reason}"
            log.warning("%s; trying again in %.1f s", self.away, wait)
            await asyncio.sleep(wait * random.uniform(0.8, 1.2))  # nosec B311 # no secret
            wait = min(wait * 2, LONGEST_WAIT)

    async def _carry(self, connection: ClientConnection) -> None:
        self._commands.clear()
        self._others.clear()
        self._pending_calls.clear()
        self._sent, self._dealt_with, self._is_answering = 0, 0, True
        for _, inbox in self._subscribed.values():
            inbox.waiting.clear()
        self.away = None
        self.session += 1
        log.info("connected to rosbridge at %s", self._server.url)
        self._others.extend(_encoded(_subscribe(*one)) for one in self._subscriptions())
        self._others.extend(self._advertised.values())
        self._others.extend(self._latched.values())
        self._others.extend(_encoded(_serve(name, known[0])) for name, known in self._served.items())
        self._wake.set()
        writing = asyncio.create_task(self._write(connection))
        try:
            await self._read(connection)
        finally:
            self.away = f"rosbridge at {self._server.url}: the connection has ended"
            writing.cancel()
            await asyncio.gather(writing, return_exceptions=True)

    def _subscriptions(self) -> list[tuple[str, Subscription]]:
        return [(topic, subscription) for topic, (subscription, _) in self._subscribed.items()]

    async def _read(self, connection: ClientConnection) -> None:
        count = 0
        async for frame in connection:
            try:
                self._receive(decoding.decode_frame(frame))
            except FaultError as error:
                self._record_fault(str(error))
            count += 1
            if count % TOGETHER == 0:
                await asyncio.sleep(0)

    def _receive(self, came: decoding.Operation) -> None:
        if isinstance(came, decoding.Publication):
            known = self._subscribed.get(came.topic)
            if known is not None:
                known[1].waiting.append(came.msg)
        elif isinstance(came, decoding.ServiceCall):
            self._answer(came)
        elif isinstance(came, decoding.StatusText):
            if came.level == "error":
                self._record_fault(f"the server said {came.msg[:200]!r}")
        else:
            last = not isinstance(came, decoding.ActionFeedback)
            answered = self._pending_calls.pop(came.id, None) if last else self._pending_calls.get(came.id)
            if answered is not None:
                answered(came)

    def _answer(self, came: decoding.ServiceCall) -> None:
        """Answer a call, unless too many operations wait: the caller does not read then."""
        if came.service in self._served and len(self._others) < MOST_ANSWERS_WAITING:
            reply = self._served[came.service][1]
            answer = {"op": "service_response", "id": came.id, "service": came.service}
            self._post(partial(_encoded, {**answer, "values": reply, "result": True}))

    def _record_fault(self, text: str) -> None:
        """Record a fault, and log it once."""
        what = text.partition(":")[0]
        if what not in self._faults:
            log.warning("rosbridge at %s: %s", self._server.url, text)
            while len(self._faults) >= MOST_FAULTS:
                self._faults.pop(next(iter(self._faults)))
        self._faults[what] = (time.monotonic(), text)

    async def _write(self, connection: ClientConnection) -> None:
        with end_on_error(log, f"sending to rosbridge at {self._server.url}", connection, ConnectionClosed):
            while True:
                await self._wake.wait()
                self._wake.clear()
                while (frame := self._next()) is not None:
                    await connection.send(frame if isinstance(frame, bytes) else frame(), text=True)
                    self._sent += 1
                    if self._sent % ASK_EVERY == 0:
                        await connection.send(self._probe(self.session, self._sent), text=True)

    def _next(self) -> Frame | None:
        """Return the next frame to send; None without one, or while the server has too many unprocessed."""
        unread = self._sent - self._dealt_with if self._is_answering else 0
        if self._commands:
            return self._commands.popleft() if unread < MOST_COMMANDS_UNREAD else None
        return self._others.popleft() if self._others and unread < MOST_UNREAD else None

    def _probe(self, session: int, sent: int) -> bytes:
        """Return a call whose answer shows that the server has processed all ``sent`` before it."""

        def answered(_: Answer) -> None:
            self._dealt_with, self._is_answering = max(self._dealt_with, sent), True
            self._wake.set()

        def is_due() -> None:
            if session == self.session and self._dealt_with < sent:
                self._is_answering = False
                self._wake.set()

        id = f"call:{next(self._ids)}"
        self._expect(id, answered)
        asyncio.get_running_loop().call_later(UNANSWERED_AFTER, is_due)
        return _encoded({"op": "call_service", "id": id, "service": "/rosapi/get_time", "args": {}})

    def _expect(self, id: str, answered: Callable[[Answer], None]) -> None:
        if self.away is None:
            while len(self._pending_calls) >= MOST_CALLS:
                self._pending_calls.pop(next(iter(self._pending_calls)))
            self._pending_calls[id] = answered

    def _send(self, operation: dict[str, Any], *, urgent: bool = False) -> None:
        self._post(_encoded(operation), urgent=urgent)

    def _post(self, frame: Frame, *, urgent: bool = False, kept: bool = False) -> None:
        is_room = urgent or kept or len(self._others) < MOST_WAITING
        if self.away is not None or not is_room:
            return
        (self._commands if urgent else self._others).append(frame)
        self._wake.set()


def _subscribe(topic: str, subscription: Subscription) -> dict[str, Any]:
    return {
        "op": "subscribe",
        "id": f"read:{topic}",
        "topic": topic,
        "type": subscription.type_name,
        "throttle_rate": subscription.throttle_ms,
        "queue_length": subscription.queue_length,
        "compression": subscription.compression,
    }


def _serve(service: str, type_name: str) -> dict[str, Any]:
    return {"op": "advertise_service", "service": service, "type": type_name}


def _unsubscribe(topic: str) -> dict[str, Any]:
    return {"op": "unsubscribe", "id": f"read:{topic}", "topic": topic}


def _encoded(operation: dict[str, Any]) -> bytes:
    return msgspec.json.encode(operation, enc_hook=plain)
