"""Topics, services and actions on the robots' network, read by the services of rosapi."""

from __future__ import annotations

import asyncio
import contextlib
import logging
from collections.abc import Collection
from dataclasses import dataclass, field
from typing import Protocol, TypeVar

from ..ros.errors import FaultError
from .connection import Answer, RosbridgeConnection
from .decoding import ServiceResponse, convert
from .messages import ActionServersReply, PublishersReply, ServicesReply, SubscribersReply, TopicsReply

log = logging.getLogger(__name__)

EVERY = 1.0
"""seconds between reads of the network."""
ANSWER_WITHIN = 10.0
"""seconds for rosapi to answer."""
SUBSCRIBERS_EVERY = 5
"""reads of the network per read of the subscribers of written topics."""

Reply = TypeVar("Reply")


@dataclass
class Graph:
    """Topics with their types, services, actions; numbers of subscribers and publishers of a topic.

    ``session`` is the connection over which it was read. ``listeners`` and ``publishers`` contain only
    requested topics.
    """

    session: int = 0
    topics: dict[str, str] = field(default_factory=dict)
    services: frozenset[str] = frozenset()
    actions: frozenset[str] = frozenset()
    listeners: dict[str, int] = field(default_factory=dict)
    publishers: dict[str, int] = field(default_factory=dict)


class GraphInterest(Protocol):
    """Selects the topics to be counted; called at each read."""

    @property
    def written_topics(self) -> Collection[str]:
        """The topics whose subscribers are counted."""

    @property
    def watched_topics(self) -> Collection[str]:
        """The topics whose publishers are counted."""


class GraphWatch:
    """Polls rosapi. ``fault`` is why nothing is known."""

    def __init__(self, connection: RosbridgeConnection, interest: GraphInterest) -> None:
        self._connection = connection
        self._interest = interest
        self.graph = Graph()
        self.looks = 0
        """Number of reads of the network."""
        self.fault: str | None = None
        self._soon = asyncio.Event()

    def request_read(self) -> None:
        """Read again at once: the topics of interest have changed since the last read."""
        self._soon.set()

    async def run(self) -> None:
        """Poll until cancelled."""
        while True:
            if self._connection.away is None:
                try:
                    await self._poll()
                    self.fault = None
                except FaultError as error:
                    if self.fault is None:
                        log.warning("%s", error)
                    self.fault = str(error)
            with contextlib.suppress(TimeoutError):
                async with asyncio.timeout(EVERY):
                    await self._soon.wait()
            self._soon.clear()

    async def _poll(self) -> None:
        session = self._connection.session
        topics = await self._ask("topics", {}, TopicsReply)
        services = await self._ask("services", {}, ServicesReply)
        actions = await self._ask("action_servers", {}, ActionServersReply)
        known = self.graph
        graph = Graph(
            session,
            dict(zip(topics.topics, topics.types, strict=False)),
            frozenset(services.services),
            frozenset(actions.action_servers),
        )
        is_same = session == known.session and graph.topics == known.topics
        if is_same and self.looks % SUBSCRIBERS_EVERY:
            graph.listeners = dict(known.listeners)
        for topic in self._interest.written_topics:
            if topic in graph.topics and topic not in graph.listeners:
                subscribers = await self._ask("subscribers", {"topic": topic}, SubscribersReply)
                graph.listeners[topic] = len(subscribers.subscribers)
        for topic in self._interest.watched_topics:
            publishers = await self._ask("publishers", {"topic": topic}, PublishersReply)
            graph.publishers[topic] = len(publishers.publishers)
        self.looks += 1
        self.graph = graph

    async def _ask(self, service: str, args: dict[str, str], kind: type[Reply]) -> Reply:
        """Return the reply of a service of rosapi; raises FaultError."""
        reply: asyncio.Future[Answer] = asyncio.get_running_loop().create_future()

        def answered(came: Answer) -> None:
            if not reply.done():
                reply.set_result(came)

        self._connection.call(f"/rosapi/{service}", args, answered)
        try:
            async with asyncio.timeout(ANSWER_WITHIN):
                came = await reply
        except TimeoutError:
            raise FaultError(
                f"/rosapi/{service} does not answer; start the node rosapi beside the rosbridge server"
            ) from None
        if not isinstance(came, ServiceResponse) or not came.result:
            raise FaultError(f"/rosapi/{service} failed: {str(came.values)[:200]}")
        return convert(came.values, kind, f"/rosapi/{service}")
