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
from ..base.errors import LinkError
from ..ros.errors import FaultError
from . import decoding
from .settings import Server

# --- ROS messages as JSON, as they are sent to a rosbridge server: it fills in what is left out ---

LARGEST_SENT = 10_000_000
"""bytes of a message: what a rosbridge server takes in unless it is set otherwise."""
_WITH_GOALS = ("kilted", "lyrical")
"""Distributions whose NavigateThroughPoses takes nav_msgs/Goals."""


class JsonMessages:
    """Makes messages: objects by the names of their fields."""

    def __init__(self, distribution: str) -> None:
        self._distribution = distribution

    def knows(self, type_name: str) -> bool:
        """Tell whether the robots' distribution has a type."""
        return type_name != "nav_msgs/msg/Goals" or self._distribution in _WITH_GOALS

    def make(self, type_name: str, **fields: Any) -> Any:
        """Return a message; fields that are left out are zero, empty, or made of such."""
        return fields


def encode(_type_name: str, message: Any) -> bytes:
    """Return a message as JSON; raises ValueError for one that no server takes."""
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


# --- The connection to a rosbridge server: it comes back, with every topic that was read or written ---
# What is said while there is no connection is thrown away: who has to be heard says it again while it is
# due.

log = logging.getLogger(__name__)

FIRST_WAIT, LONGEST_WAIT = 0.5, 10.0
"""seconds between two attempts to connect."""
STABLE_AFTER = 5.0
"""seconds after which a connection counts as one that holds."""
PING_EVERY = 5.0
"""seconds; a server that does not answer for as long again is gone."""
MOST_KEPT = 64
"""messages of one topic that wait to be read; older ones are thrown away beyond them."""
MOST_WAITING = 2_000
"""operations that wait to be sent; further ones are thrown away, but for what robots are told."""
MOST_ANSWERS_WAITING = 100
"""operations that wait beyond which no service is answered."""
MOST_CALLS = 10_000
"""services and goals whose answers are waited for."""
MOST_FAULTS = 100
LATELY = 10.0
"""seconds that a frame which cannot be used is told of."""
TOGETHER = 100
"""frames that are read before others get a turn."""

MOST_UNREAD, MOST_COMMANDS_UNREAD = 20, 30
"""operations that a server may not have dealt with yet; the second is for what robots are told. One that has
256 operations of a client waiting, or 64 answers to it, ends the connection (rosbridge-server-rs)."""
ASK_EVERY = 10
"""operations after which it is asked whether the server has dealt with them."""
UNANSWERED_AFTER = 3.0
"""seconds without an answer to that after which nothing waits until one comes: stops have to go out."""

Frame = bytes | Callable[[], bytes]
Answer = decoding.ServiceResponse | decoding.ActionFeedback | decoding.ActionResult


@dataclass
class Inbox:
    """What has come for one reader, oldest first: messages of a topic, or answers."""

    waiting: deque[Any] = field(default_factory=lambda: deque(maxlen=MOST_KEPT))

    def drain(self) -> list[Any]:
        """Return what has come, and keep nothing of it."""
        came = list(self.waiting)
        self.waiting.clear()
        return came


@dataclass(frozen=True)
class Subscription:
    """How a topic is asked for."""

    type_name: str
    throttle_ms: int = 0
    queue_length: int = 0
    compression: str = "none"


class RosbridgeConnection:
    """A client of one server. Not for several threads.

    ``session`` counts the connections; ``away`` says why there is none, and is None while there is one.
    """

    def __init__(self, server: Server) -> None:
        self._server = server
        self.away: str | None = f"{server.url}: not connected yet"
        self.session = 0
        self._faults: dict[str, tuple[float, str]] = {}
        """When something was wrong with a frame, and in words what, by its beginning."""
        self._subscribed: dict[str, tuple[Subscription, Inbox]] = {}
        self._advertised: dict[str, bytes] = {}
        self._latched: dict[str, Frame] = {}
        self._served: dict[str, tuple[str, Any]] = {}
        """Type and reply of the services that are served here."""
        self._pending_calls: dict[str, Callable[[Answer], None]] = {}
        self._ids = itertools.count(1)
        self._commands: deque[Frame] = deque()
        """What robots are told, in order: a cancel never comes before the goal that it cancels."""
        self._others: deque[Frame] = deque()
        self._wake = asyncio.Event()
        self._sent = self._dealt_with = 0
        """Operations of this connection, and those that the server has dealt with, for all that is known."""
        self._is_answering = True

    @property
    def faults(self) -> list[str]:
        """What is wrong with the connection and what came over it lately, in words."""
        since = time.monotonic() - LATELY
        recent = [text for at, text in self._faults.values() if at > since]
        return [*([self.away] if self.away else []), *recent]

    # --- topics ---------------------------------------------------------------------------------------------

    def subscribe(self, topic: str, subscription: Subscription) -> Inbox:
        """Read a topic, now and after each reconnect."""
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
        """Read a topic anew: a server that knows who publishes it asks for what is latched."""
        subscription = self._subscribed[topic][0]
        self._send(_unsubscribe(topic))
        self._send(_subscribe(topic, subscription))

    def unsubscribe(self, topic: str) -> None:
        """Read a topic no more."""
        if self._subscribed.pop(topic, None) is not None:
            self._send(_unsubscribe(topic))

    def advertise(self, topic: str, type_name: str, *, latched: bool = False) -> None:
        """Say that a topic will be written, now and after each reconnect."""
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
            # Encoded when it is its turn: the maps of many robots are one in memory.
            self._latched[topic] = partial(_encoded, operation)
            self._post(self._latched[topic])
        else:
            self._send(operation, urgent=urgent)

    # --- services and actions -------------------------------------------------------------------------------

    def call(
        self, service: str, args: Any, answered: Callable[[Answer], None], *, urgent: bool = False
    ) -> None:
        """Call a service; ``answered`` is called once, or never where the connection ends before."""
        id = f"call:{next(self._ids)}"
        self._expect(id, answered)
        self._send({"op": "call_service", "id": id, "service": service, "args": args}, urgent=urgent)

    def serve(self, service: str, type_name: str, reply: Any) -> None:
        """Answer a service with ``reply``, whoever calls it, now and after each reconnect."""
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
        """Carry operations until cancelled; raises LinkError for what a person has to put right."""
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
                    ping_timeout=PING_EVERY,
                    **self._server.options(),
                ) as connection:
                    await self._carry(connection)
                reason = "it closed the connection"
            except InvalidURI as error:
                raise LinkError(f"rosbridge.url: {error}") from None
            except (AccessError, InvalidHandshake, ConnectionClosed) as error:
                reason = str(error)
            except OSError as error:
                reason = error.strerror or str(error)
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
                self._note(str(error))
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
                self._note(f"the server said {came.msg[:200]!r}")
        else:
            last = not isinstance(came, decoding.ActionFeedback)
            answered = self._pending_calls.pop(came.id, None) if last else self._pending_calls.get(came.id)
            if answered is not None:
                answered(came)

    def _answer(self, came: decoding.ServiceCall) -> None:
        """Answer a call, unless so much waits already that whoever calls does not read."""
        if came.service in self._served and len(self._others) < MOST_ANSWERS_WAITING:
            reply = self._served[came.service][1]
            answer = {"op": "service_response", "id": came.id, "service": came.service}
            self._post(partial(_encoded, {**answer, "values": reply, "result": True}))

    def _note(self, text: str) -> None:
        """Keep what was wrong, and log it once."""
        what = text.partition(":")[0]
        if what not in self._faults:
            log.warning("rosbridge at %s: %s", self._server.url, text)
            while len(self._faults) >= MOST_FAULTS:
                self._faults.pop(next(iter(self._faults)))
        self._faults[what] = (time.monotonic(), text)

    async def _write(self, connection: ClientConnection) -> None:
        try:
            while True:
                await self._wake.wait()
                self._wake.clear()
                while (frame := self._next()) is not None:
                    await connection.send(frame if isinstance(frame, bytes) else frame(), text=True)
                    self._sent += 1
                    if self._sent % ASK_EVERY == 0:
                        await connection.send(self._question(self.session, self._sent), text=True)
        except ConnectionClosed:
            return

    def _next(self) -> Frame | None:
        """Return what is to be sent now; None for nothing, or while the server has too much of ours."""
        unread = self._sent - self._dealt_with if self._is_answering else 0
        if self._commands:
            return self._commands.popleft() if unread < MOST_COMMANDS_UNREAD else None
        return self._others.popleft() if self._others and unread < MOST_UNREAD else None

    def _question(self, session: int, sent: int) -> bytes:
        """Return a call whose answer says that the server has dealt with all that was ``sent`` before it."""

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
