"""Feeds of data stored by other gateways: steps of commands, observations, placed cones, queues.

Each is read when it has changed: see :mod:`.followers`.
"""

from __future__ import annotations

import asyncio
import logging
from collections.abc import Iterable, Mapping
from itertools import islice
from typing import Generic, Protocol, TypeVar

import msgspec

from ...core.errors import StoreError
from ...core.logs import log_and_continue
from ...core.messages.base import to_json
from ...core.messages.commands import CommandReport
from ...core.messages.records import ObservationReport, ObservationState, PlacementReport
from ...core.messages.robots import MOTION_OPS
from ..model.events import (
    CommandChanged,
    CommandChangedElsewhere,
    EventBus,
    Listeners,
    ObservationChanged,
    PlacementChanged,
    QueueEditedElsewhere,
    QueueReported,
    RobotLeft,
)
from ..model.robots import Robots
from ..model.task_queue import REPORTED_ENDED, Queue, QueuedTask, queue_report
from ..monitoring import TICK_S, until_tick, wait_at_most
from ..storage.database import Database
from ..storage.repositories import commands, queues, records
from .bus import EVERYBODY, own_subject
from .followers import LOOK_S, ChangeNumbers, Follower, LookSchedule
from .messages import MOST_NAMED, Exchange, QueuesChanged

log = logging.getLogger(__name__)

PIECE = 50
"""steps sent to operators before other tasks have their turn: some milliseconds."""


# --- Steps of commands, sent to the operators of this gateway ---

LEFT_AT_ONCE = 1000
"""robots whose commands are read together: PostgreSQL takes 65535 values in a statement."""
MET_WITHIN_S, MOST_UNMET = 10.0, 2000
"""Seconds for which a command waits for its robot to be known here, which takes one or two, and how many
wait; a removed robot never is."""


class StepFeed:
    """Follows command steps of robots elsewhere, and wakes other gateways on steps of robots here."""

    goes_on = False

    def __init__(
        self,
        robots: Robots,
        listeners: Listeners,
        events: EventBus,
        exchange: Exchange,
        numbers: ChangeNumbers,
        database: Database,
    ) -> None:
        self._robots = robots
        self._listeners = listeners
        self._events = events
        self._database = database
        self._newest: int | None = None
        self._seen: set[int] = set()
        self._unmet: dict[str, float] = {}
        """commands of robots that are not known here yet, and since when on the loop's clock."""
        self._meeting: asyncio.TimerHandle | None = None
        self._left: set[str] = set()
        """robots that were here: their current commands may give no step for long."""
        self._follower = Follower("steps", self, exchange, numbers)
        events.subscribe(CommandChanged, self._record_change)
        events.subscribe(RobotLeft, self._record_left)

    async def run(self) -> None:
        """Follow until cancelled; raises StoreError."""
        await self._follower.run()

    async def follow(self) -> None:
        """Send operators the steps since the last check; raises StoreError."""
        if self._newest is None:
            await self._begin()
            return
        await self._learn_open()
        found = await self._database.read(commands.steps_after, self._margin())
        steps = (command for id, command in found if id not in self._seen)
        new = list(dict.fromkeys([*self._unmet, *steps]))
        reports = await self._database.read(commands.find_all, new) if new else {}
        for begin in range(0, len(new), PIECE):
            for command in new[begin : begin + PIECE]:
                if command in reports:
                    self._announce(reports[command].report)
            await asyncio.sleep(0)
        self._keep_unmet()
        self._newest = max([self._newest, *(id for id, _ in found)])
        self._seen = {id for id in self._seen | {id for id, _ in found} if id > self._margin()}
        if len(found) == commands.STEPS_AT_ONCE:
            # There may be more, for which no new change is announced.
            self._follower.wake()

    async def _begin(self) -> None:
        """Read the existing steps, and the robots' current commands; raises StoreError."""
        newest = await self._database.read(commands.newest_step)
        known = await self._database.read(commands.steps_after, newest - commands.STEP_MARGIN)
        self._left.update(self._robots.commanded_elsewhere())
        await self._learn_open()
        self._newest, self._seen = newest, {id for id, _ in known}

    async def _learn_open(self) -> None:
        """Announce the commands of robots that moved to another gateway; raises StoreError."""
        while some := set(islice(self._left, LEFT_AT_ONCE)):
            self._left -= some
            try:
                found = await self._database.read(commands.still_open, sorted(some))
            except StoreError:
                self._left |= some
                raise
            for one in found:
                self._record_doing(one.report)

    def _margin(self) -> int:
        return (self._newest or 0) - commands.STEP_MARGIN

    def _keep_unmet(self) -> None:
        """Check again soon the commands of robots that are not known here yet."""
        loop = asyncio.get_running_loop()
        since = loop.time() - MET_WITHIN_S
        self._unmet = {command: at for command, at in self._unmet.items() if at > since}
        if self._meeting is not None:
            self._meeting.cancel()
        self._meeting = loop.call_later(LOOK_S, self._follower.wake) if self._unmet else None

    def _announce(self, report: CommandReport) -> None:
        if report.robot not in self._robots:
            if len(self._unmet) < MOST_UNMET:
                self._unmet.setdefault(report.command, asyncio.get_running_loop().time())
            return
        self._unmet.pop(report.command, None)
        if self._robots.gateway_of(report.robot) is None:
            return
        self._record_doing(report)
        self._listeners.announce("command", report.command, to_json(report))

    def _record_doing(self, report: CommandReport) -> None:
        if self._robots.gateway_of(report.robot) is None or report.op not in MOTION_OPS:
            return
        if report.state.is_open:
            self._robots.assign(report.robot, report.command)
        elif self._robots.get(report.robot).command == report.command:
            self._robots.assign(report.robot, None)
        self._events.publish(CommandChangedElsewhere(report))

    def _record_change(self, changed: CommandChanged) -> None:
        if self._robots.gateway_of(changed.report.robot) is None:
            self._follower.note_change()

    def _record_left(self, left: RobotLeft) -> None:
        self._left.add(left.robot)
        self._follower.wake()


# --- Records: the newest are sent, unless they were sent here already ---

NEWEST = 200
"""records whose changes operators receive; of older observations only those on the maps."""
Told = TypeVar("Told", ObservationReport, PlacementReport)


class RecordAnnouncer(Generic[Told]):
    """Notifies operators of changed records by ``method``, unless they have received the change."""

    def __init__(self, method: str, listeners: Listeners) -> None:
        self._method = method
        self._listeners = listeners
        self._versions: Mapping[int, str] | None = None
        self._reported: dict[int, Told] = {}
        """the newest records as sent to the operators of this gateway."""

    def note(self, id: int, report: Told) -> None:
        """Record that operators have received a record."""
        self._reported[id] = report

    def changed(self, versions: Mapping[int, str]) -> list[int]:
        """Return the records changed since the last check; none at the first."""
        before = self._versions
        return [] if before is None else [id for id, is_now in versions.items() if before.get(id) != is_now]

    def announce(self, reports: Mapping[int, Told], versions: Mapping[int, str]) -> None:
        """Announce changes by id, and keep the ``versions`` of the newest."""
        for id, report in reports.items():
            if self._reported.get(id) != report:
                self._reported[id] = report
                self._listeners.announce(self._method, str(id), to_json(report))
        self._reported = {id: report for id, report in self._reported.items() if id in versions}
        self._versions = versions


# --- Placed cones, sent to the operators of this gateway ---


class PlacementRelay:
    """Follows cones placed and collected by robots of other gateways, and wakes others."""

    goes_on = False

    def __init__(
        self,
        listeners: Listeners,
        events: EventBus,
        exchange: Exchange,
        numbers: ChangeNumbers,
        database: Database,
    ) -> None:
        self._database = database
        self._announcer = RecordAnnouncer[PlacementReport]("placement", listeners)
        self._follower = Follower("placements", self, exchange, numbers)
        events.subscribe(PlacementChanged, self._record_change)

    async def run(self) -> None:
        """Follow until cancelled; raises StoreError."""
        await self._follower.run()

    async def follow(self) -> None:
        """Send operators the cones changed since the last check; raises StoreError."""
        versions = await self._database.read(records.placement_changes, NEWEST)
        changed = self._announcer.changed(versions)
        found = await self._database.read(records.find_placements, changed) if changed else []
        self._announcer.announce({report.placement: report for report in found}, versions)

    def _record_change(self, changed: PlacementChanged) -> None:
        self._announcer.note(changed.report.placement, changed.report)
        self._follower.note_change()


# --- Observations: drawn onto the maps of this gateway, and sent to its operators ---


class ObservedMaps(Protocol):
    """The maps that accepted objects are drawn on."""

    async def redraw(self) -> None:
        """Draw the objects accepted by now; raises StoreError."""


class ObservationRelay:
    """Follows observations of robots of other gateways and their acceptance, and wakes others."""

    goes_on = False

    def __init__(
        self,
        maps: ObservedMaps,
        listeners: Listeners,
        events: EventBus,
        exchange: Exchange,
        numbers: ChangeNumbers,
        database: Database,
    ) -> None:
        self._maps = maps
        self._database = database
        self._on_map: tuple[int, int] | None = None
        self._announcer = RecordAnnouncer[ObservationReport]("observation", listeners)
        self._reviewed_here = False
        """whether the maps may show reviews made here since the last check that are outdated by now."""
        self._follower = Follower("observations", self, exchange, numbers)
        events.subscribe(ObservationChanged, self._record_change)

    async def run(self) -> None:
        """Follow until cancelled; raises StoreError."""
        await self._follower.run()

    async def follow(self) -> None:
        """Draw and announce changes since the last check; raises StoreError."""
        found = await self._database.read(records.changes, NEWEST)
        if self._reviewed_here or found.on_map != self._on_map:
            self._reviewed_here = False
            try:
                await self._maps.redraw()
            except StoreError:
                self._reviewed_here = True
                raise
        self._on_map = found.on_map
        changed = self._announcer.changed(found.newest)
        reports = await self._database.read(records.find_each, changed) if changed else []
        self._announcer.announce({report.observation: report for report in reports}, found.newest)

    def _record_change(self, changed: ObservationChanged) -> None:
        self._announcer.note(changed.report.observation, changed.report)
        self._reviewed_here |= changed.report.state is not ObservationState.PENDING
        self._follower.note_change()


# --- Queues of robots elsewhere, sent to the operators of this gateway ---

TELL_S = 0.05
"""seconds for which changes are collected before others are notified, and before they are read."""


class OwnQueues(Protocol):
    """The queues that this gateway works on."""

    def get(self, robot: str) -> Queue:
        """Return a robot's queue as last stored."""

    def doubt(self, robot: str) -> None:
        """Have a robot's queue read from the database before its next use."""


class QueueFeed:
    """Notifies other gateways of queues changed here, and operators here of those changed there.

    The bus carries robots' names, and their queues are read: a queue may be larger than a message. Queues of
    this gateway that another one has edited are read before their next use.
    """

    def __init__(
        self,
        robots: Robots,
        own: OwnQueues,
        listeners: Listeners,
        events: EventBus,
        exchange: Exchange,
        numbers: ChangeNumbers,
        database: Database,
    ) -> None:
        self._robots = robots
        self._own = own
        self._listeners = listeners
        self._exchange = exchange
        self._numbers = numbers
        self._schedule = LookSchedule("queues", numbers)
        self._must_look = False
        """whether a check is due in any case: robots have left since the last check began, or it has
        failed."""
        self._database = database
        self._changed: set[str] = set()
        self._has_changed = asyncio.Event()
        self._named: set[str] = set()
        self._is_named = asyncio.Event()
        self._versions: dict[str, str] | None = None
        self._reported: dict[str, tuple[int, str]] = {}
        """a hash of each queue's report as sent to operators, and the robot's state in it."""
        events.subscribe(QueueReported, self._record_change)
        events.subscribe(QueueEditedElsewhere, self._call_owner)
        events.subscribe(RobotLeft, self._record_left)
        exchange.subscribe(QueuesChanged, self._receive)

    async def run(self) -> None:
        """Follow until cancelled; raises StoreError."""
        telling = asyncio.create_task(self._name_changes())
        loop, looked_at = asyncio.get_running_loop(), 0.0
        try:
            while True:
                if loop.time() - looked_at >= LOOK_S - TICK_S:
                    if self._must_look or self._schedule.is_due:
                        await self._find_changes()
                    self._name_changed_robots()
                    looked_at = loop.time()
                self._is_named.clear()
                await self._announce_named()
                await wait_at_most(self._is_named, until_tick(LOOK_S))
                await asyncio.sleep(TELL_S)
        finally:
            telling.cancel()

    async def _find_changes(self) -> None:
        """Find the queues changed since the last check, announced or not; raises StoreError."""
        self._must_look = False
        self._schedule.begin_look()
        try:
            await self._compare_versions()
        except StoreError:
            self._must_look = True
            raise

    async def _compare_versions(self) -> None:
        mine = await self._database.read(queues.revisions_of, self._exchange.gateway)
        for robot, revision in mine.items():
            if self._is_here(robot) and self._own.get(robot).revision != revision:
                self._own.doubt(robot)
        found = await self._database.read(queues.versions_elsewhere, self._exchange.gateway)
        before, self._versions = self._versions, found
        if before is not None:
            self._named.update(robot for robot, version in found.items() if before.get(robot) != version)

    def _name_changed_robots(self) -> None:
        """Report again the queues whose robots changed state, which is part of the report."""
        self._reported = {
            robot: reported for robot, reported in self._reported.items() if self._is_elsewhere(robot)
        }
        self._named.update(
            robot
            for robot, (_, state) in self._reported.items()
            if self._robots.get(robot).state.value != state
        )

    async def _announce_named(self) -> None:
        """Send operators the named queues; raises StoreError, and retries next time."""
        names = sorted(robot for robot in self._named if self._is_elsewhere(robot))
        # A robot not known yet will be in a moment; queues of robots here are reported on their changes.
        self._named = {robot for robot in self._named if robot not in self._robots}
        if not names:
            return
        try:
            found = await self._database.read(queues.load_with_ended, names, REPORTED_ENDED)
        except StoreError:
            self._named.update(names)
            raise
        for queue, ended in found:
            self._announce(queue, ended)

    def _announce(self, queue: Queue, ended: Iterable[QueuedTask]) -> None:
        if not self._is_elsewhere(queue.robot):
            return
        state = self._robots.get(queue.robot).state
        report = to_json(queue_report(queue, state, ended))
        reported = hash(msgspec.json.encode(report)), state.value
        if self._reported.get(queue.robot) != reported:
            self._reported[queue.robot] = reported
            self._listeners.announce("queue", queue.robot, report)

    def _is_here(self, robot: str) -> bool:
        return robot in self._robots and not self._is_elsewhere(robot)

    def _is_elsewhere(self, robot: str) -> bool:
        return self._robots.gateway_of(robot) is not None

    def _receive(self, changed: QueuesChanged) -> None:
        for robot in changed.robots:
            if self._is_here(robot):
                self._own.doubt(robot)
            else:
                self._named.add(robot)
        self._is_named.set()

    def _call_owner(self, edited: QueueEditedElsewhere) -> None:
        gateway = self._robots.gateway_of(edited.robot)
        if gateway is not None:
            self._numbers.add_change("queues")
            self._exchange.send(own_subject(gateway), QueuesChanged(self._exchange.gateway, [edited.robot]))
            # An Abort may have been requested with it.
            self._exchange.wake("requests", gateway)
        self._named.add(edited.robot)
        self._is_named.set()

    def _record_left(self, _left: RobotLeft) -> None:
        self._must_look = True

    def _record_change(self, reported: QueueReported) -> None:
        self._numbers.add_change("queues")
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
                # Nobody awaits this task: after an error queues would be named no more.
                with log_and_continue(log, "naming changed queues to other gateways"):
                    self._exchange.send(EVERYBODY, QueuesChanged(self._exchange.gateway, some))
