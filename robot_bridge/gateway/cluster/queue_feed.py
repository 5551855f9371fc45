"""Queues of robots at other gateways, told to the operators of this one."""

from __future__ import annotations

import asyncio
from collections.abc import Iterable

import msgspec

from ...core.errors import StoreError
from ...core.messages.json_values import to_json
from ..model.events import EventBus, Listeners, QueueReported
from ..model.robots import Robots
from ..model.task_queue import REPORTED_ENDED, Queue, QueuedTask, queue_report
from ..monitoring import wait_at_most
from ..storage.database import Database
from ..storage.repositories import queues
from .bus import EVERYBODY
from .exchange import Exchange
from .messages import MOST_NAMED, QueuesChanged

LOOK_S = 1.0
"""seconds between two looks for changes that nobody told of."""
TELL_S = 0.05
"""seconds for which changes wait for one another before others are told of them, and before they are read."""


class QueueFeed:
    """Tells other gateways which queues have changed here, and operators here of those that changed there.

    The robots are named over the bus, and their queues read: a queue may be larger than a message.
    """

    def __init__(
        self, robots: Robots, listeners: Listeners, events: EventBus, exchange: Exchange, database: Database
    ) -> None:
        self._robots = robots
        self._listeners = listeners
        self._exchange = exchange
        self._database = database
        self._changed: set[str] = set()
        self._has_changed = asyncio.Event()
        self._named: set[str] = set()
        self._is_named = asyncio.Event()
        self._versions: dict[str, str] | None = None
        self._told: dict[str, tuple[int, str]] = {}
        """a hash of what operators were told of each queue, and the state of its robot in that."""
        events.subscribe(QueueReported, self._note)
        exchange.subscribe(QueuesChanged, self._hear)

    async def run(self) -> None:
        """Follow until cancelled; raises StoreError."""
        telling = asyncio.create_task(self._name_changes())
        loop, looked_at = asyncio.get_running_loop(), 0.0
        try:
            while True:
                if loop.time() - looked_at >= LOOK_S:
                    await self.find_changes()
                    looked_at = loop.time()
                self._is_named.clear()
                await self._tell_named()
                await wait_at_most(self._is_named, LOOK_S)
                await asyncio.sleep(TELL_S)
        finally:
            telling.cancel()

    async def find_changes(self) -> None:
        """Find the queues that have changed since the last look, whoever told of that; raises StoreError."""
        found = await self._database.read(queues.versions_elsewhere, self._exchange.gateway)
        before, self._versions = self._versions, found
        if before is not None:
            self._named.update(robot for robot, version in found.items() if before.get(robot) != version)
        # How a robot is stands in the report of its queue.
        self._told = {robot: told for robot, told in self._told.items() if self._is_elsewhere(robot)}
        self._named.update(
            robot for robot, (_, state) in self._told.items() if self._robots.get(robot).state.value != state
        )

    async def _tell_named(self) -> None:
        """Tell operators of the queues that were named; raises StoreError, and tries again next time."""
        names = sorted(robot for robot in self._named if self._is_elsewhere(robot))
        # One that is not known yet will be in a moment; those that are here are told of by this gateway.
        self._named = {robot for robot in self._named if robot not in self._robots}
        if not names:
            return
        try:
            found = await self._database.read(queues.load_with_ended, names, REPORTED_ENDED)
        except StoreError:
            self._named.update(names)
            raise
        for queue, ended in found:
            self._tell(queue, ended)

    def _tell(self, queue: Queue, ended: Iterable[QueuedTask]) -> None:
        if not self._is_elsewhere(queue.robot):
            return
        state = self._robots.get(queue.robot).state
        report = to_json(queue_report(queue, state, ended))
        told = hash(msgspec.json.encode(report)), state.value
        if self._told.get(queue.robot) != told:
            self._told[queue.robot] = told
            self._listeners.announce("queue", queue.robot, report)

    def _is_elsewhere(self, robot: str) -> bool:
        return self._robots.gateway_of(robot) is not None

    def _hear(self, changed: QueuesChanged) -> None:
        self._named.update(changed.robots)
        self._is_named.set()

    def _note(self, reported: QueueReported) -> None:
        self._changed.add(reported.robot)
        self._has_changed.set()

    async def _name_changes(self) -> None:
        while True:
            await self._has_changed.wait()
            await asyncio.sleep(TELL_S)
            self._has_changed.clear()
            names, self._changed = sorted(self._changed), set()
            for begin in range(0, len(names), MOST_NAMED):
                some = names[begin : begin + MOST_NAMED]
                self._exchange.send(EVERYBODY, QueuesChanged(self._exchange.gateway, some))
