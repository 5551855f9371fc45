"""Registration of robots that say Ready, their takeover with Aborts left for them, and decommissioning."""

from __future__ import annotations

import asyncio
import logging
from collections.abc import Collection, Iterable, Sequence
from concurrent.futures import Future
from functools import partial
from typing import NamedTuple

from sqlalchemy import Connection

from ...core.clock import Clock
from ...core.errors import DataRefusedError, RefusedError, StoreError, listed_names
from ...core.logs import log_and_continue
from ...core.messages.administration import KeptRobot, RemoveRobots, RobotsRemoved
from ...core.messages.positions import link_elsewhere
from ...core.messages.robots import Abort, Answer, OpAck, Ready, SetMap, Start
from ..cluster.membership import Membership
from ..cluster.messages import Exchange, NotedAbort
from ..cluster.ownership import NameClaims, Ownership
from ..cluster.stop_relay import AbortRelay
from ..commands.active_command import CommandOrder, KeptAbort
from ..commands.service import CommandService
from ..model.events import EventBus, RobotClaimed, RobotLeft, RobotsTakenUp, handles
from ..model.robots import AWAY, Robot, Robots
from ..model.task_queue import REPORTED_ENDED, Queue, QueuedTask
from ..queues.registry import QueueRegistry
from ..queues.requests import QueueEditor
from ..site.places import ServedSite
from ..storage.database import Database
from ..storage.repositories import commands as stored_commands
from ..storage.repositories import emergency_stops, metadata
from ..storage.repositories import queues as stored_queues
from ..storage.repositories import robots as stored_robots
from ..storage.repositories.commands import StoredCommand
from ..storage.repositories.emergency_stops import StopRow
from ..traffic.yielding import YieldManager
from ..trajectories.recording import TrajectoryWriter
from .emergency_persistence import AbortJournal
from .emergency_stop import EmergencyStops
from .link_supervision import ConnectionClaims, claim_refusal
from .robot_outboxes import MapSender, RequestOutcome, RobotOutboxes

log = logging.getLogger(__name__)

# --- Takeover: stored data of robots that this gateway gets are loaded, those of lost ones dropped ---

AT_ONCE = 500
"""number of robots with their stored data read in one piece."""


STOPPED_LATELY_S = 30.0
"""seconds after an Abort or a pause in which a motion may still come that was asked before it, at another
gateway: older requests are refused after 20 s, and clocks of gateways differ."""


class StoredState(NamedTuple):
    """Stored data of some robots, queues with their newest ended tasks, and the newest stop.

    ``stopped`` are those of the robots that were aborted or paused lately.
    """

    robots: list[Robot]
    commands: list[StoredCommand]
    queues: list[tuple[Queue, list[QueuedTask]]]
    stop: StopRow | None
    stopped: set[str]


def _load(connection: Connection, robots: Sequence[str], stopped_since: float) -> StoredState:
    """Return the stored data of some robots: one piece of work, since each waits for its turn.

    The stop is read last, so that a stop which ended motions that were read before is included.
    """
    queues = stored_queues.load_with_ended(connection, robots, REPORTED_ENDED)
    paused = {
        queue.robot
        for queue, _ in queues
        if not queue.running and queue.at is not None and queue.at >= stopped_since
    }
    return StoredState(
        stored_robots.load(connection, robots),
        stored_commands.still_open(connection, robots),
        queues,
        emergency_stops.newest(connection),
        stored_commands.aborted_since(connection, robots, stopped_since) | paused,
    )


class Takeover:
    """Follows the ownership of robots. Those of other gateways are known by reports, and not commanded."""

    def __init__(
        self,
        ownership: Ownership,
        exchange: Exchange,
        robots: Robots,
        commands: CommandService,
        queues: QueueRegistry,
        emergency: EmergencyStops,
        saving: TrajectoryWriter,
        database: Database,
        clock: Clock,
        events: EventBus,
    ) -> None:
        self._ownership = ownership
        self._exchange = exchange
        self._robots = robots
        self._commands = commands
        self._queues = queues
        self._emergency = emergency
        self._saving = saving
        self._database = database
        self._clock = clock
        self._events = events
        self._waiting: dict[str, asyncio.Future[None]] = {}
        self._left: set[str] = set()
        """the gateways that had the waiting robots."""
        self._adopting: asyncio.Task[None] | None = None
        self._unsynced: set[str] = set()
        """gateways with newly learned robots, until their positions are requested."""

    async def claim(self, robot: str) -> None:
        """Claim a robot that says Ready here, from whichever gateway had it, and load its stored data.

        :raises StoreError: when this fails; the robot is then not registered.
        """
        before = self._robots.gateway_of(robot)
        if before is not None:
            self._events.publish(RobotClaimed(robot))
        if await self._ownership.claim(robot) or before is not None:
            if before is not None:
                self._left.add(before)
            await self._adopt_together(robot)

    async def claim_left(self) -> None:
        """Claim the robots that no living gateway has, if this gateway leads; raises StoreError."""
        await self._adopt(await self._ownership.claim_left())

    async def follow(self) -> None:
        """Drop the robots that another gateway has by now, and add new ones of others; raises StoreError."""
        changes = await self._ownership.refresh()
        for robot in sorted(changes.lost):
            self._drop(robot, changes.gateways.get(robot))
        if changes.new:
            await self._adopt(sorted(changes.new))
        for robot in changes.gone:
            if self._robots.gateway_of(robot) is not None and self._robots.get(robot).state in AWAY:
                self._robots.remove(robot)
        strange = [r for r in changes.gateways if r not in self._robots and r not in changes.gone]
        if strange:
            await self._meet(strange, changes.gateways)
        for robot, gateway in changes.gateways.items():
            known = self._robots.gateway_of(robot)
            if known is not None and known != gateway:
                self._robots.let_go(robot, gateway)
                self._unsynced.add(gateway)
        # Lost during their registration, which made them this gateway's again.
        for robot, gateway in self._ownership.had_elsewhere(self._robots.own_names()).items():
            self._drop(robot, gateway)
        # Reports on these robots from before this gateway knew their owner were ignored.
        for gateway in sorted(self._unsynced):
            self._exchange.wake("positions", gateway)
        self._unsynced.clear()
        self._ownership.note_followed()

    async def _meet(self, names: Collection[str], gateways: dict[str, str]) -> None:
        """Load robots that other gateways have."""
        for robot in await self._database.read(stored_robots.load, sorted(names)):
            if robot.name not in self._robots and not self._ownership.owns(robot.name):
                robot.gateway = gateways[robot.name]
                robot.link = link_elsewhere(robot.gateway)
                self._robots.restore(robot, self._clock.time())

    async def _adopt_together(self, robot: str) -> None:
        """Load a robot together with those that come meanwhile, such as all of a gateway that died."""
        waiting = self._waiting.get(robot)
        if waiting is None:
            waiting = self._waiting[robot] = asyncio.get_running_loop().create_future()
            if self._adopting is None or self._adopting.done():
                self._adopting = asyncio.create_task(self._adopt_waiting())
        await asyncio.shield(waiting)

    async def _adopt_waiting(self) -> None:
        while self._waiting:
            some, self._waiting = self._waiting, {}
            left, self._left = self._left, set()
            await self._adopt_for(some)
            for gateway in sorted(left):
                self._exchange.wake("owners", gateway)

    async def _adopt_for(self, some: dict[str, asyncio.Future[None]]) -> None:
        """Load robots and resolve their futures; an error with one robot concerns only that one."""
        try:
            await self._adopt(list(some))
        except asyncio.CancelledError:
            raise
        except BaseException as error:
            is_away = isinstance(error, StoreError) and not isinstance(error, DataRefusedError)
            if len(some) > 1 and not is_away:
                for robot, waiting in some.items():
                    await self._adopt_for({robot: waiting})
                return
            for waiting in some.values():
                waiting.set_exception(error)
                # The waiting caller may be gone.
                waiting.exception()
        else:
            for waiting in some.values():
                waiting.set_result(None)

    async def _adopt(self, names: Sequence[str]) -> None:
        for begin in range(0, len(names), AT_ONCE):
            some = names[begin : begin + AT_ONCE]
            try:
                await self._read(some)
            except StoreError:
                # Loaded by a later :meth:`follow`, as robots found to be this gateway's.
                self._ownership.forget(names[begin:])
                raise

    async def _read(self, some: Sequence[str]) -> None:
        self._commands.drop(some)
        self._queues.drop(some)
        stored = await self._database.run(_load, some, self._clock.time() - STOPPED_LATELY_S)
        known = stored.robots
        self._commands.adopt(stored.commands)
        for robot in known:
            self._robots.restore(robot, self._clock.time())
            self._robots.assign(robot.name, self._commands.busy_with(robot.name))
        self._commands.keep_left_for([robot.name for robot in known])
        # Another gateway may have been asked for a motion before, and hand it on by now.
        self._commands.note_stop(stored.stopped)
        # One that is not stored yet is known to this gateway only by its Ready.
        new = set(some) - {robot.name for robot in known}
        for name in new:
            self._robots.remove(name)
        # An Abort of one that was removed must not meet whoever comes by its name.
        self._commands.end_left_for(new - {command.report.robot for command in stored.commands})
        self._saving.begin([robot.name for robot in known])
        self._queues.adopt(stored.queues)
        self._emergency.take_over([robot.name for robot in known if robot.abilities != ""], stored.stop)
        self._events.publish(RobotsTakenUp(tuple(some)))

    def _drop(self, robot: str, gateway: str | None) -> None:
        log.warning("robot %s has connected to gateway %s", robot, gateway or "none")
        self._commands.drop([robot])
        self._queues.drop([robot])
        self._saving.drop([robot])
        with log_and_continue(log, f"counting robot {robot!r} no more"):
            self._emergency.forget(robot)
        if gateway is None:
            self._robots.remove(robot)
        else:
            self._robots.let_go(robot, gateway)
            self._unsynced.add(gateway)
        self._events.publish(RobotLeft(robot, gateway or "none"))


# --- Aborts that could not be stored, for the gateway that has or gets their robots


class FleetAborts:
    """The Aborts that gateways of one fleet could not store, noted on this computer and at all of them.

    ``journal``, with times of the database, is None for a gateway without a folder of its own.
    """

    def __init__(self, journal: AbortJournal | None, exchange: Exchange, membership: Membership) -> None:
        self._journal = journal
        self._membership = membership
        self._relay = AbortRelay(exchange, membership, self)
        self._commands: list[CommandService] = []

    def serve(self, commands: CommandService) -> None:
        """Have ``commands`` store the Aborts of its robots that other gateways noted."""
        self._commands.append(commands)

    async def run(self) -> None:
        """Have the other gateways know what is noted here, until cancelled."""
        await self._relay.run()

    # --- as AbortNotes of the commands

    def write(self, kept: Sequence[KeptAbort], settled: Sequence[str] = ()) -> Future[bool] | None:
        """Note what this gateway keeps, here and at the others; the result is whether it is on the disk."""
        offset, knows = self._membership.clock_offset, self._relay.knows
        self._relay.note_aborts(
            _noted(one.order, one.at + offset) for one in kept if not knows(one.order.command)
        )
        self._relay.settle(settled)
        return self._write_journal()

    def read(self) -> list[KeptAbort]:
        """Note what the file of an earlier gateway has, for whoever has the robots; return none."""
        if self._journal is not None:
            left = self._journal.read(self._membership.database_time())
            self._relay.note_aborts(_noted(kept.order, kept.at) for kept in left)
        return []

    def left_for(self, robots: Iterable[str]) -> list[KeptAbort]:
        """Return the noted Aborts of ``robots``."""
        return [self._left(abort) for abort in self._relay.left_for(robots)]

    # --- as AbortNoter of requests about robots elsewhere

    def note_aborts(self, aborts: Sequence[NotedAbort]) -> None:
        """Note Aborts, here and at the others, for the gateway that has their robots."""
        if aborts:
            self._relay.note_aborts(aborts)
            self.keep(aborts)

    def withdraw_pauses(self, robots: Iterable[str]) -> None:
        """Have what failed pauses of ``robots`` have left stored no more, neither here nor elsewhere."""
        if ids := [abort.command for abort in self._relay.left_for(robots) if abort.of_pause]:
            self._relay.settle(ids)
            self.discard(ids)

    # --- as AbortKeeper of the relay

    def keep(self, aborts: Sequence[NotedAbort]) -> None:
        """Note Aborts on this computer, and store those of robots of this gateway."""
        for commands in self._commands:
            commands.keep_left(map(self._left, aborts))
        self._write_journal()

    def discard(self, ids: Collection[str]) -> None:
        """Keep Aborts no longer: another gateway has stored them, or found them void."""
        for commands in self._commands:
            commands.discard_aborts(ids)
        self._write_journal()

    def _write_journal(self) -> Future[bool] | None:
        # A message about some of a fleet's Aborts must not wait until all are written.
        return None if self._journal is None else self._journal.write_newest(self._present)

    def _present(self) -> list[KeptAbort]:
        return [_kept(abort, abort.at) for abort in self._relay.noted]

    def _left(self, noted: NotedAbort) -> KeptAbort:
        return _kept(noted, noted.at - self._membership.clock_offset)


def _noted(order: CommandOrder, at: float) -> NotedAbort:
    more = order.aborts, order.expires_in, order.is_emergency, order.of_pause
    return NotedAbort(order.command, order.robot, order.operator, at, order.reason, *more)


def _kept(noted: NotedAbort, at: float) -> KeptAbort:
    order = CommandOrder(
        noted.command,
        noted.robot,
        Abort(emergency=noted.emergency),
        noted.by,
        noted.reason,
        expires_in=noted.expires_in,
        aborts=noted.aborts,
        of_pause=noted.of_pause,
    )
    return KeptAbort(order, at, is_left=True)


# --- Registration of robots that say Ready: admitted with map and messages, or refused as a second one


class Registration:
    """Registers robots. ``holds`` are their connections, as claimed by their links."""

    def __init__(
        self,
        site: ServedSite,
        robots: Robots,
        commands: CommandService,
        emergency: EmergencyStops,
        outboxes: RobotOutboxes,
        maps: MapSender,
        saving: TrajectoryWriter,
        database: Database,
        clock: Clock,
        takeover: Takeover | None = None,
        exchange: Exchange | None = None,
    ) -> None:
        self._takeover = takeover
        self._claims = None if exchange is None else NameClaims(exchange, self)
        self.holds = ConnectionClaims()
        self._site = site
        self._robots = robots
        self._commands = commands
        self._emergency = emergency
        self._outboxes = outboxes
        self._maps = maps
        self._saving = saving
        self._database = database
        self._clock = clock
        self._database_id = ""
        self._greeting: dict[str, asyncio.Lock] = {}

    async def restore(self) -> None:
        """Load the id of the database, which is sent to robots in greetings; raises StoreError."""
        self._database_id = await self._database.run(metadata.database_id)

    @property
    def database_id(self) -> str:
        """The unique id of the database."""
        return self._database_id

    def greeting(self) -> Start:
        """Return the message to robots when the gateway begins to listen to them."""
        return Start(self._database_id)

    async def receive(self, robot: str, link: str, request: Ready, id: int | None) -> RequestOutcome:
        """Register a robot that said Ready as request ``id``, or refuse it, one of a name at a time.

        :raises StoreError: when this cannot be stored; the robot is then not registered.
        """
        async with self._greeting.setdefault(robot, asyncio.Lock()):
            reason = await self._refusal_anywhere(robot, request.magic)
            if reason is not None:
                log.warning("link %s: a second robot said Ready: %s", link, reason)
                return RequestOutcome(robot, OpAck(id=id, ok=False, reason=reason, magic=request.magic))
            if self._takeover is not None:
                await self._takeover.claim(robot)
            content: SetMap | None = None
            part = False
            if request.abilities is None or "map" in request.abilities:
                content, part = await self._maps.first(robot, reads_itself=link == "sql")
            ack = OpAck(id=id, magic=request.magic, robot=robot, database=self._database_id)
            welcome: list[Answer | None] = [ack if link == "sql" else None, content]
            if await self._admit(robot, link, request, [one for one in welcome if one is not None]):
                return RequestOutcome(robot, ack, content, written=True, part=part)
            return RequestOutcome(robot, ack, content, void=("Start", "OpAck"), part=part)

    async def _admit(self, robot: str, link: str, ready: Ready, welcome: list[Answer]) -> bool:
        """Register a robot; return whether it restarted: ``welcome`` is then already written, as first."""
        if starts_anew := self._robots.starts_anew(robot, ready.magic):
            # Before its new magic number is recorded: after a failure the restart must be detected again.
            await self._outboxes.delivered_by_deletion(self._robots.get(robot).link)
            reason = f"robot {robot} started anew; sent once more"
            expire_after = self._site.settings.commands.expire_after_s
            # In one transaction: the gateway after a crash must not take this for another restart,
            # and send again what the robot is doing by then.
            note_run = partial(stored_robots.note_run, robot=self._robots.get(robot), magic=ready.magic)
            await self._commands.deliver_again(robot, reason, expire_after, welcome, note_run)
        self._robots.ready(robot, ready.magic, link, self._clock.time(), ready.paths, ready.can)
        self._saving.touch(robot)
        if starts_anew:
            await self._saving.save(robot)
        if not self._robots.is_only_seen(robot):
            await self._emergency.ready(robot)
        return starts_anew

    async def refusal(self, robot: str, magic: int) -> str | None:
        """Return why a Ready with ``magic`` is refused: another robot of that name is here; else None."""
        if robot not in self._robots or self._robots.gateway_of(robot) is not None:
            return None
        known, limit = self._robots.get(robot), self._site.report.stale_after
        return await claim_refusal(known, magic, self._silence(known), limit, self.holds)

    async def _refusal_anywhere(self, robot: str, magic: int) -> str | None:
        """Return as :meth:`refusal`, also if the other robot is at another gateway of the fleet."""
        gateway = self._robots.gateway_of(robot)
        if gateway is None or self._claims is None:
            return await self.refusal(robot, magic)
        known, limit = self._robots.get(robot), self._site.report.stale_after
        # One that continues here, as all robots of a dead gateway do at once, needs no query there.
        if known.magic == magic or self._silence(known) >= limit:
            return None
        # A robot that said Ready there a moment ago is stored, but its magic number not reported yet.
        if any(one.magic == magic for one in await self._database.read(stored_robots.load, [robot])):
            return None
        return await self._claims.refusal(robot, magic, gateway)

    def _silence(self, known: Robot) -> float:
        return self._clock.time() - known.received_at


# --- Decommissioning of robots that are removed while the gateway runs, by a program or at a desk

REASON = "the robot was removed"
MOST_NAMED = 10
"""Most robots named in a text."""


class Decommissioning:
    """Removes robots from the fleet that are no longer stored in the database.

    One that says Ready again, as it can where no tokens are required, is a new robot.
    """

    def __init__(
        self,
        robots: Robots,
        saving: TrajectoryWriter,
        commands: CommandService,
        emergency: EmergencyStops,
        waiting: YieldManager,
        queues: QueueEditor,
        database: Database,
    ) -> None:
        self._robots = robots
        self._saving = saving
        self._commands = commands
        self._emergency = emergency
        self._waiting = waiting
        self._queues = queues
        self._database = database
        self._leaving: set[str] = set()
        """robots that are removed, while the end of their commands may not be stored yet."""

    def begin(self, known: Iterable[str]) -> None:
        """Record the robots that are stored: others were removed while no gateway ran."""
        self._saving.begin(known)
        self._leaving = self._commands.robots().difference(known)

    @handles(RemoveRobots)
    async def remove(self, request: RemoveRobots, operator: str) -> RobotsRemoved:
        """Remove those of the robots that are lost or offline, with their queues and commands.

        Their next message is answered with an Abort: one that comes back may still be driving.

        :raises RefusedError: when none of them can be removed, or an emergency stop is in force; StoreError.
        """
        if self._emergency.in_force:
            raise RefusedError(
                "remove_robots: an emergency stop is in force, and who has not answered it has to be seen; "
                "clear it first"
            )
        for robot in self._gone(request.robots):
            await self._queues.end(robot, operator, REASON)
        # Storing took time, in which robots may have come back.
        removed = self._gone(request.robots)
        kept = [KeptRobot(robot, why) for robot in request.robots if (why := self._why_kept(robot))]
        if not removed:
            raise RefusedError(f"remove_robots: {'; '.join(one.reason for one in kept[:MOST_NAMED])}")
        await self._database.run(stored_robots.forget_all, removed)
        log.warning("%s removes %d robots: %s", operator, len(removed), listed_names(removed))
        try:
            await self._saving.save()
            await self.carry_out()
        except StoreError as error:
            # They are removed, and the rest is done with the next :meth:`carry_out`.
            log.error("%s", error)
        return RobotsRemoved(removed, kept)

    def _gone(self, robots: Iterable[str]) -> list[str]:
        return sorted({robot for robot in robots if self._why_kept(robot) is None})

    def _why_kept(self, robot: str) -> str | None:
        """Return the reason why a robot is kept; None for one that is lost or offline."""
        if robot not in self._robots:
            return f"robot {robot!r} is not known to this gateway"
        state = self._robots.get(robot).state
        if state in AWAY:
            return None
        return f"robot {robot!r} is {state.value}; only robots that are lost or offline are removed"

    async def carry_out(self) -> None:
        """Remove the robots deleted since the last call; raises StoreError, and continues at the next."""
        for robot in sorted(self._saving.collect_removed()):
            log.warning("robot %s was removed", robot)
            self._robots.remove(robot)
            self._leaving.add(robot)
        failed: list[StoreError] = []
        for robot in sorted(self._leaving):
            try:
                await self._remove(robot)
            except StoreError as error:
                failed.append(error)
        if failed:
            raise failed[0]

    async def _remove(self, robot: str) -> None:
        if robot not in self._robots:
            await self._commands.give_up(robot, REASON)
            await self._waiting.forget(robot)
            # After the end of its Abort, which would count as its answer.
            self._emergency.forget(robot)
        self._leaving.discard(robot)
