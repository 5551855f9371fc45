"""Feeds of what is stored at other gateways: steps of commands, observations, queues.

Each is looked up once a second, and at once when another gateway has changed it.
"""

from __future__ import annotations

import asyncio
from collections.abc import Iterable
from typing import Protocol

import msgspec

from ...core.errors import StoreError
from ...core.messages.commands import CommandReport
from ...core.messages.json_values import to_json
from ...core.messages.records import ObservationReport, ObservationState
from ..model.events import CommandChanged, EventBus, Listeners, ObservationChanged, QueueReported
from ..model.robots import Robots
from ..model.task_queue import REPORTED_ENDED, Queue, QueuedTask, queue_report
from ..monitoring import wait_at_most
from ..storage.database import Database
from ..storage.repositories import commands, queues, records
from ..storage.repositories.records import ObservationChanges
from .bus import EVERYBODY
from .messages import MOST_NAMED, Exchange, QueuesChanged, Wake, WakeTopic

LOOK_S = 1.0
"""seconds between two looks when nobody tells of a change."""
WAKE_S = 0.02
"""seconds for which changes here wait for one another before other gateways are woken."""


class Followed(Protocol):
    """What is stored in the database, and known at each gateway."""

    async def follow(self) -> None:
        """Take in what has changed since the last look; raises StoreError."""


class Follower:
    """Has ``followed`` look for ``topic``, and other gateways where this one has changed something of it."""

    def __init__(self, topic: WakeTopic, followed: Followed, exchange: Exchange) -> None:
        self._topic: WakeTopic = topic
        self._followed = followed
        self._exchange = exchange
        self._woken = asyncio.Event()
        self._changed = asyncio.Event()
        exchange.subscribe(Wake, self._wake)

    def note_change(self) -> None:
        """Have the others look soon: something is stored that they do not know of."""
        self._changed.set()

    async def run(self) -> None:
        """Follow until cancelled; raises StoreError."""
        waking = asyncio.create_task(self._wake_others())
        try:
            while True:
                self._woken.clear()
                await self._followed.follow()
                await wait_at_most(self._woken, LOOK_S)
        finally:
            waking.cancel()

    def _wake(self, wake: Wake) -> None:
        if wake.what == self._topic:
            self._woken.set()

    async def _wake_others(self) -> None:
        while True:
            await self._changed.wait()
            await asyncio.sleep(WAKE_S)
            self._changed.clear()
            self._exchange.wake(self._topic)


# --- Steps of commands, told to the operators of this gateway ---


class StepFeed:
    """Follows the steps of commands of others' robots, and wakes others when robots here take one."""

    def __init__(
        self, robots: Robots, listeners: Listeners, events: EventBus, exchange: Exchange, database: Database
    ) -> None:
        self._robots = robots
        self._listeners = listeners
        self._database = database
        self._newest: int | None = None
        self._seen: set[int] = set()
        self._follower = Follower("steps", self, exchange)
        events.subscribe(CommandChanged, self._note)

    async def run(self) -> None:
        """Follow until cancelled; raises StoreError."""
        await self._follower.run()

    async def follow(self) -> None:
        """Tell operators of the steps since the last look; raises StoreError."""
        if self._newest is None:
            self._newest = await self._database.read(commands.newest_step)
            self._seen = {id for id, _ in await self._database.read(commands.steps_after, self._margin())}
            return
        found = await self._database.read(commands.steps_after, self._margin())
        new = list(dict.fromkeys(command for id, command in found if id not in self._seen))
        reports = await self._database.read(commands.find_all, new) if new else {}
        for command in new:
            if command in reports:
                self._tell(reports[command].report)
        self._newest = max([self._newest, *(id for id, _ in found)])
        self._seen = {id for id in self._seen | {id for id, _ in found} if id > self._margin()}

    def _margin(self) -> int:
        return (self._newest or 0) - commands.STEP_MARGIN

    def _tell(self, report: CommandReport) -> None:
        if self._robots.gateway_of(report.robot) is None:
            return
        doing = self._robots.get(report.robot).command
        if report.state.is_open:
            self._robots.assign(report.robot, report.command)
        elif doing == report.command:
            self._robots.assign(report.robot, None)
        self._listeners.announce("command", report.command, to_json(report))

    def _note(self, changed: CommandChanged) -> None:
        if self._robots.gateway_of(changed.report.robot) is None:
            self._follower.note_change()


# --- Observations: drawn onto the maps of this gateway, and told to its operators ---

NEWEST = 200
"""observations whose changes operators are told: of older ones those alone that are on the maps."""


class ObservedMaps(Protocol):
    """The maps that accepted objects are drawn on."""

    async def redraw(self) -> None:
        """Draw what is accepted by now; raises StoreError."""


class ObservationRelay:
    """Follows what robots of other gateways saw and operators there accepted, and wakes others."""

    def __init__(
        self,
        maps: ObservedMaps,
        listeners: Listeners,
        events: EventBus,
        exchange: Exchange,
        database: Database,
    ) -> None:
        self._maps = maps
        self._listeners = listeners
        self._database = database
        self._known: ObservationChanges | None = None
        self._told: dict[int, ObservationReport] = {}
        """what the operators of this gateway heard of the newest."""
        self._reviewed_here = False
        """whether the maps may show what was reviewed here since the last look, and is otherwise by now."""
        self._follower = Follower("observations", self, exchange)
        events.subscribe(ObservationChanged, self._note)

    async def run(self) -> None:
        """Follow until cancelled; raises StoreError."""
        await self._follower.run()

    async def follow(self) -> None:
        """Draw and tell what has changed since the last look; raises StoreError."""
        found = await self._database.read(records.changes, NEWEST)
        before = self._known
        if before is None or self._reviewed_here or found.on_map != before.on_map:
            self._reviewed_here = False
            try:
                await self._maps.redraw()
            except StoreError:
                self._reviewed_here = True
                raise
        if before is not None:
            changed = [id for id, version in found.newest.items() if before.newest.get(id) != version]
            for report in await self._database.read(records.find_each, changed) if changed else []:
                self._tell(report)
        self._told = {id: report for id, report in self._told.items() if id in found.newest}
        self._known = found

    def _tell(self, report: ObservationReport) -> None:
        if self._told.get(report.observation) != report:
            self._told[report.observation] = report
            self._listeners.announce("observation", str(report.observation), to_json(report))

    def _note(self, changed: ObservationChanged) -> None:
        self._told[changed.report.observation] = changed.report
        self._reviewed_here |= changed.report.state is not ObservationState.PENDING
        self._follower.note_change()


# --- Queues of robots elsewhere, told to the operators of this gateway ---

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
