"""The fleet: entry point for messages of robots and requests of operators.

Links and the desk server call it; it imports neither. Everything that must outlive the process is committed
before the answer is sent.
"""

from __future__ import annotations

import logging
from collections import Counter
from collections.abc import Awaitable, Callable, Sequence
from dataclasses import replace
from typing import Any

from ...core.clock import SYSTEM_CLOCK, Clock, ClockStep
from ...core.errors import RefusedError
from ...core.logs import RepeatedLines
from ...core.messages.administration import Gateways
from ...core.messages.base import LONGEST_REFUSAL, MOST_GATEWAYS, one_line, to_json
from ...core.messages.commands import CommandState
from ...core.messages.positions import RobotReport
from ...core.messages.robots import (
    Answer,
    GetPath,
    Observed,
    OpAck,
    Question,
    Ready,
    Request,
    SendGPS,
    SendPos,
    Start,
    Stopped,
)
from ..auth.accounts import TokenKind
from ..auth.authorisation import PATHS
from ..cluster.cluster import Cluster
from ..commands.requests import CommandRequests
from ..commands.service import CommandService
from ..commands.validation import CommandRules, WaitingRobots
from ..model import events
from ..model.arrival import Planner, StraightPlanner
from ..model.position_checks import NO_FIX, GroundTracks, PlaceChecks
from ..model.robots import Robot, RobotPose, Robots
from ..monitoring import Counters, Steps
from ..queues.registry import QueueContext, QueueRegistry
from ..queues.requests import PauseService, QueueEditor
from ..queues.runner import QueueRunner
from ..site.places import ServedSite
from ..storage.database import Database
from ..storage.repositories import robots as stored_robots
from ..storage.repositories.robots import SOLE_FENCE, FencedError
from ..traffic.road_planning import RoadPlanner
from ..traffic.service import RoadTraffic
from ..trajectories.recording import TrajectoryRecorder, TrajectoryWriter
from .emergency_persistence import AbortJournal, StopJournal
from .emergency_stop import EmergencyStops
from .geofence import AuditNote, GeofenceWatch
from .link_supervision import AccountSuspensions, LinkWatch
from .nearness import NearnessWatch
from .operator_updates import Snapshots, reports_of
from .registration import Decommissioning, FleetAborts, Registration, Takeover
from .robot_outboxes import MapSender, RequestOutcome, RobotOutboxes
from .robot_requests import ObservationService, RobotAnswers
from .views import FleetViews

log = logging.getLogger(__name__)

Rest = tuple[str, Awaitable[None] | Exception]
"""A robot, and the storing due after its position to be awaited, or the error in that position."""


class Fleet:
    """The robots of one site and their commands, on one database."""

    def __init__(
        self,
        site: ServedSite,
        database: Database,
        clock: Clock = SYSTEM_CLOCK,
        planner: Planner | None = None,
        stops: StopJournal | None = None,
        aborts: AbortJournal | None = None,
        note: AuditNote | None = None,
        cluster: Cluster | None = None,
    ) -> None:
        fence = SOLE_FENCE if cluster is None else cluster.ownership
        self._fence = fence
        self.site = site
        self._database = database
        self._clock = clock
        self.cluster = cluster
        self._announced_gateways: Gateways | None = None
        self._announced_addresses: frozenset[str] = frozenset()
        self.listeners = events.Listeners()
        """the operators' sessions, to be notified."""
        self.events = events.EventBus()
        self.robots = Robots(site.report.stale_after, site.report.lost_after, self.events)
        self.links = LinkWatch(self.robots, self.listeners)
        self.snapshots = Snapshots(self.robots, clock)
        self.views = FleetViews(self.robots, site, clock)
        rules, waiting = CommandRules(site, self.robots), WaitingRobots()
        self.aborts = None if cluster is None else FleetAborts(aborts, cluster.exchange, cluster.membership)
        self._commands = CommandService(
            database,
            self.robots,
            site.report.reached_tolerance,
            clock,
            rules,
            waiting,
            self.events,
            fence,
            aborts if self.aborts is None else self.aborts,
        )
        if self.aborts is not None:
            self.aborts.serve(self._commands)
        self.orders = CommandRequests(site, self.robots, self._commands, database)
        # A stop that is cleared by one gateway ends motions at others that began before.
        stop_clock = clock if cluster is None else cluster.membership.shared_clock
        self.emergency = EmergencyStops(
            self._commands, database, stop_clock, self.robots, self.listeners, self.events, stops
        )
        self._queue_registry = QueueRegistry(database, self.robots, self.listeners, self.events, fence)
        planner = planner or StraightPlanner()
        self._build_queues(planner, rules, waiting)
        self._build_watches(note)
        self._build_reception(planner)
        self._tracks = GroundTracks()
        self._places = PlaceChecks(site)
        self._steps = Steps("save")
        self.suspensions = AccountSuspensions(database, self._commands, self.listeners, clock)
        self.counters = Counters()
        self.repeated = RepeatedLines()
        self._subscribe()

    def _build_queues(self, planner: Planner, rules: CommandRules, waiting: WaitingRobots) -> None:
        """Build the parts that send robots on: queues, roads, pauses."""
        self.queue_context = QueueContext(
            self.site,
            self.robots,
            self._commands,
            self._queue_registry,
            self._database,
            self._clock,
            waiting,
            planner,
            self._fence,
        )
        self.queues = QueueEditor(self.queue_context)
        self.driving = QueueRunner(self.queue_context)
        self.roads = RoadTraffic(
            self.site,
            self.robots,
            self._commands,
            self.orders,
            self.driving,
            waiting,
            self._database,
            self._clock,
            planner if isinstance(planner, RoadPlanner) else None,
            self.listeners,
            self.events,
        )
        rules.add(self.emergency)
        rules.add(self.roads.closures)
        self.pauses = PauseService(self.queue_context, self.orders)

    def _build_watches(self, note: AuditNote | None) -> None:
        """Build the parts that look where robots are."""
        self.geofence = GeofenceWatch(
            self.site,
            self.robots,
            self.orders,
            self.pauses,
            self.emergency,
            self._clock,
            self.listeners,
            self.events,
            note,
        )
        self.nearness = NearnessWatch(
            self.robots, self.links, self.roads.traffic, self.site, self._clock, self.listeners
        )

    def _build_reception(self, planner: Planner) -> None:
        """Build the parts that robots come to and go from, with what is recorded of them and sent to them."""
        site, database, clock = self.site, self._database, self._clock
        self.recorder = TrajectoryRecorder(site)
        self._saving = TrajectoryWriter(database, self.robots, self.recorder, clock, self._fence)
        self.outboxes = RobotOutboxes(database, self.robots, self._commands, self.emergency, self._saving)
        self.maps = MapSender(site, self.robots, self.outboxes, database)
        self.takeover = None if self.cluster is None else self._follow_owners(self.cluster)
        self.reception = Registration(
            site,
            self.robots,
            self._commands,
            self.emergency,
            self.outboxes,
            self.maps,
            self._saving,
            database,
            clock,
            self.takeover,
            None if self.cluster is None else self.cluster.exchange,
        )
        self.removals = Decommissioning(
            self.robots,
            self._saving,
            self._commands,
            self.emergency,
            self.roads.waiting,
            self.queues,
            database,
        )
        self.observations = ObservationService(site, database, clock, self.events)
        self._answering = RobotAnswers(site, database, self.robots, self._commands, planner, self.roads.ways)

    def _follow_owners(self, cluster: Cluster) -> Takeover:
        """Create the takeover of robots that this gateway gets or loses."""
        return Takeover(
            cluster.ownership,
            cluster.exchange,
            self.robots,
            self._commands,
            self._queue_registry,
            self.emergency,
            self._saving,
            self._database,
            self._clock,
            self.events,
        )

    def _subscribe(self) -> None:
        """Subscribe the parts to events; each receives them in this order, even if one before fails."""
        subscribe = self.events.subscribe
        subscribe(events.OutboxChanged, lambda event: self.outboxes.changed(event.robot))
        subscribe(events.CommandChanged, self._assign)
        subscribe(events.CommandChanged, lambda event: self.emergency.note_step(event.report))
        subscribe(events.CommandChanged, lambda event: self.driving.note_step(event.report))
        subscribe(events.CommandChanged, lambda event: self.roads.note_step(event.report))
        subscribe(events.CommandChanged, self._announce_command)
        subscribe(events.QueueChanged, lambda event: self.driving.schedule(event.robot))
        subscribe(events.CommandChangedElsewhere, lambda event: self.roads.ways.note_elsewhere(event.report))
        subscribe(events.RobotsTakenUp, lambda event: self.roads.waiting.doubt())
        subscribe(events.RobotReturned, lambda event: self.driving.note_return(event.robot, event.away_s))
        subscribe(events.ObservationChanged, self._announce_observation)
        subscribe(events.PlacementChanged, self._announce_placement)

    def _assign(self, event: events.CommandChanged) -> None:
        robot = event.report.robot
        self.robots.assign(robot, self._commands.busy_with(robot))

    def _announce_command(self, event: events.CommandChanged) -> None:
        self.counters.steps[event.report.state.value] += 1
        self.listeners.announce("command", event.report.command, to_json(event.report))

    def _announce_observation(self, event: events.ObservationChanged) -> None:
        self.listeners.announce("observation", str(event.report.observation), to_json(event.report))

    def _announce_placement(self, event: events.PlacementChanged) -> None:
        self.listeners.announce("placement", str(event.report.placement), to_json(event.report))

    @property
    def database(self) -> Database:
        """The database of all stored data."""
        return self._database

    async def start(self) -> None:
        """Continue where the last gateway on this database stopped, and send Start to its robots."""
        await self.reception.restore()
        known = await self._database.run(stored_robots.load)
        if self.takeover is not None:
            # Robots of dead gateways are taken over once all others are known.
            known = [robot for robot in known if self._fence.owns(robot.name)]
        for robot in known:
            self.robots.restore(robot, self._clock.time())
        await self._commands.restore()
        self.removals.begin([robot.name for robot in known])
        for robot in known:
            self.robots.assign(robot.name, self._commands.busy_with(robot.name))
        await self.emergency.restore()
        if self.takeover is None:
            await self.roads.restore()
        else:
            await self.roads.closures.restore()
        await self._queue_registry.restore()
        await self.observations.restore()
        await self.suspensions.restore()
        if self.takeover is not None:
            await self.takeover.claim_left()
            await self.takeover.follow()
            return
        start = self.reception.greeting()
        greetings = [RequestOutcome(robot.name, answer=start) for robot in known if robot.link == "sql"]
        await self.outboxes.finish(greetings, [], acks=False)

    # --- robots ---------------------------------------------------------------------------------------

    def greeting(self, endpoint: str) -> Start:
        """Return the greeting for connections to ``endpoint``, such as ``/robot``."""
        return replace(self.reception.greeting(), gateways=self.gateway_urls(endpoint))

    def gateway_urls(self, endpoint: str) -> list[str] | None:
        """Return the URLs of ``endpoint`` at the gateways of the fleet, None for a single gateway."""
        if self.cluster is None:
            return None
        addresses = self.cluster.membership.addresses()[:MOST_GATEWAYS]
        return [f"{address}{endpoint}" for address in addresses] or None

    def gateways_at(self, endpoint: str) -> Gateways | None:
        """Return the gateways of the fleet by their URLs of ``endpoint``, None for a single gateway."""
        if self.cluster is None:
            return None
        return Gateways(self.cluster.membership.name, self.gateway_urls(endpoint) or [])

    async def announce_gateways(self) -> None:
        """Announce the addresses of the fleet's gateways, if they have changed.

        Operators follow their order as well; robots and links draw one of their own.
        """
        gateways = self.gateways_at(PATHS[TokenKind.OPERATOR])
        if gateways is None or gateways == self._announced_gateways:
            return
        self._announced_gateways = gateways
        self.listeners.announce(Gateways.method, "", to_json(gateways))
        if (addresses := frozenset(gateways.gateways)) != self._announced_addresses:
            self._announced_addresses = addresses
            self.events.publish(events.GatewaysChanged(addresses))

    async def receive(
        self, robot: str, link: str, request: Request, id: int | None, *, waited: bool = False
    ) -> RequestOutcome:
        """Process request ``id`` of a robot; its link sends the outcome by :meth:`.RobotOutboxes.finish`.

        One that has ``waited`` until there was a gateway to read it describes the past, not the present.

        :raises NotReadyError: from a robot that never said Ready; RefusedError for a refused request, with
            the reason; MessageError for an invalid one.
        """
        now = self._clock.time()
        self.counters.requests[link, type(request).__name__] += 1
        if isinstance(request, Ready):
            return await self.reception.receive(robot, link, request, id)
        self.robots.check_run(robot, request.magic, link)
        if isinstance(request, SendGPS):
            request = self._pose_of(robot, link, request, now, waited=waited)
        elif isinstance(request, SendPos):
            self._check_place(robot, link, (request.x, request.y), now, waited=waited)
        if isinstance(request, SendPos):
            if (rest := self._apply_pose(robot, link, request, now, waited=waited)) is not None:
                await rest
            return RequestOutcome(robot)
        if isinstance(request, OpAck):
            await self._acknowledge(robot, link, request, now, waited=waited)
            return RequestOutcome(robot)
        known = self._receive(robot, link, request, now, waited=waited)
        answer, note = await self._deal_with(known, link, request, id)
        return RequestOutcome(
            robot, OpAck(id=id, reason=note or None) if request.acknowledged else None, answer
        )

    def acknowledge(self, robot: str, link: str, ack: OpAck) -> Awaitable[None]:
        """Process an OpAck as :meth:`receive` does, at once; return its storing, to be awaited.

        It is stored after earlier acknowledgements of the robot. Positions are processed meanwhile.
        """
        self.counters.requests[link, "OpAck"] += 1
        self.robots.check_run(robot, ack.magic, link)
        return self._acknowledge(robot, link, ack, self._clock.time())

    def accept_pose(self, robot: str, link: str, pose: SendPos) -> Awaitable[None] | None:
        """Process a position as :meth:`receive` does, at once; return the rest, to be awaited.

        The rest is the storing of a command that the robot has carried out, nearly always None.
        """
        now = self._clock.time()
        self.counters.requests[link, "SendPos"] += 1
        moved = self.robots.follow(robot, pose, link, now, self._places.near())
        if moved is None:
            return self._consider_pose(robot, link, pose, now)
        return self._moved(robot, pose, now) if moved else None

    def accept_poses(self, link: str, poses: Sequence[RobotPose]) -> list[Rest]:
        """Process positions of many robots, each named once, as :meth:`accept_pose` does for one.

        Return for some the rest to be awaited, or the error in the position.
        """
        now, near, follow = self._clock.time(), self._places.near(), self.robots.follow
        self.counters.requests[link, "SendPos"] += len(poses)
        moved, others = [], []
        for one in poses:
            has_moved = follow(*one, link, now, near)
            if has_moved:
                moved.append(one)
            elif has_moved is None:
                others.append(one)
        self._saving.observe(now, moved)
        self.maps.located(moved)
        rests = [
            *(
                (robot, _attempt(self._commands.observe, robot, pose))
                for robot, pose in self._commands.with_open_commands(moved)
            ),
            *((robot, _attempt(self._consider_pose, robot, link, pose, now)) for robot, pose in others),
        ]
        return [(robot, rest) for robot, rest in rests if rest is not None]

    def refuse_large(self, robot: str, link: str, fault: str) -> None:
        """Record that a robot sent a message too large to be read; operators are notified."""
        if robot in self.robots:
            self.robots.disbelieve(robot, link, self._clock.time(), fault)

    def check_owned(self, robot: str) -> None:
        """Raise FencedError where another gateway took over a robot during its registration here.

        A gateway that loses a robot closes its connection, but not one on which it is not registered yet.
        """
        if not self._fence.owns(robot):
            raise FencedError(f"robot {robot}: another gateway has got it meanwhile; say Ready again")

    def closed(self, robot: str) -> None:
        """Record that the robot closed its link in good order."""
        self.robots.closed(robot)
        self._saving.touch(robot)

    # --- operators ------------------------------------------------------------------------------------

    def reports(self, since: int = -1) -> list[RobotReport]:
        """Return the robots that changed after revision ``since`` of :attr:`robots`."""
        return reports_of(self.robots.changed(since), self._clock.time(), RobotReport)

    def open_commands(self) -> Counter[CommandState]:
        """Return the number of unfinished commands in each state."""
        return self._commands.count()

    async def site_changed(self) -> None:
        """Apply the site's newest data and settings, and notify operators of them."""
        report = self.site.report
        self.robots.limit(report.stale_after, report.lost_after)
        self._commands.set_tolerance(report.reached_tolerance)
        await self.observations.restore()
        await self.roads.closures.site_changed()
        self.announce_site()

    def announce_site(self) -> None:
        """Notify operators of the served site."""
        report = self.site.report
        self.listeners.announce("site", report.id, to_json(report))

    # --- time -----------------------------------------------------------------------------------------

    async def watch_roads(self) -> None:
        """Check closed roads, and conflicts between robots."""
        await self.roads.watch(listened_to=bool(self.listeners))

    def clock_was_set(self, step: ClockStep) -> None:
        """Keep the ages of robots' messages and of waiting when the clock was set."""
        self.robots.clock_was_set(step)
        self.roads.waiting.clock_was_set(step)

    def age(self) -> None:
        """Update the liveness of every robot, and check whether stopped robots stand."""
        self.robots.age(self._clock.time())
        self.emergency.watch()

    async def save(self) -> None:
        """Store what is not stored yet, an emergency stop first; drop removed robots and expired commands.

        Each is done even if others fail. Raises StoreError when one of them failed.
        """
        expire_after = self.site.settings.commands.expire_after_s
        await self._steps.run(
            {
                "emergency stops": self.emergency.store,
                "positions": self._saving.save,
                "removed robots": self.removals.carry_out,
                "observations": self.observations.catch_up,
                "progress": self._commands.save_progress,
                "expiry": lambda: self._commands.expire(expire_after),
            }
        )

    async def finish_trajectories(self) -> None:
        """Store the positions of robots up to the last one of each: the gateway ends."""
        self.recorder.finish()
        await self.save()

    # ---------------------------------------------------------------------------------------------------

    def _receive(self, robot: str, link: str, request: Request, now: float, *, waited: bool = False) -> Robot:
        """Record a message of a robot, and return the robot."""
        stopped = isinstance(request, Stopped)
        known = self.robots.note_received(robot, link, now, stopped=stopped, waited=waited)
        self._saving.touch(robot)
        return known

    def _acknowledge(
        self, robot: str, link: str, ack: OpAck, now: float, *, waited: bool = False
    ) -> Awaitable[None]:
        known = self._receive(robot, link, ack, now, waited=waited)
        if ack.reason is not None:
            ack = replace(ack, reason=one_line(ack.reason, LONGEST_REFUSAL))
        return self._measured(known, self._commands.acknowledge(robot, ack))

    async def _measured(self, robot: Robot, storing: Awaitable[float | None]) -> None:
        self._measure(robot, await storing)

    async def _deal_with(
        self, robot: Robot, link: str, request: Request, id: int | None
    ) -> tuple[Answer | None, str]:
        """Process a request that is neither Ready nor a position; return the answer, and a note about it."""
        if isinstance(request, Stopped):
            await self._commands.on_idle(robot.name, robot.pose if robot.located else None)
        elif isinstance(request, Observed):
            await self.observations.add(robot, link, request, id)
        elif isinstance(request, Question):
            if isinstance(request, GetPath):
                self.roads.waiting.check(robot.name)
            answer, note = await self._answering.answer(robot.name, request)
            self.emergency.check(answer)
            return answer, note
        return None, ""

    def _pose_of(self, robot: str, link: str, fix: SendGPS, now: float, *, waited: bool) -> SendPos:
        last = self.robots.get(robot).pose
        try:
            if not fix.has_fix:
                raise RefusedError(NO_FIX)
            place, theta = self.site.place_on_earth(fix.lat, fix.lon, fix.heading)
        except RefusedError as error:
            self.robots.disbelieve(robot, link, now, str(error), waited=waited)
            raise
        self._check_place(robot, link, place, now, waited=waited)
        return self._tracks.pose(robot, fix, place, theta, last, now)

    def _check_place(
        self, robot: str, link: str, place: tuple[float, float], now: float, *, waited: bool = False
    ) -> None:
        """Raise RefusedError for a place where the robot cannot be; it counts as received all the same."""
        fault = self._places.fault(self.robots.get(robot), place, now)
        if fault is not None:
            self.robots.disbelieve(robot, link, now, fault, waited=waited)
            raise RefusedError(f"robot {robot!r} cannot be where it says: {fault}")

    def _consider_pose(self, robot: str, link: str, pose: SendPos, now: float) -> Awaitable[None] | None:
        self.robots.check_run(robot, pose.magic, link)
        self._check_place(robot, link, (pose.x, pose.y), now)
        return self._apply_pose(robot, link, pose, now)

    def _apply_pose(
        self, robot: str, link: str, pose: SendPos, now: float, *, waited: bool = False
    ) -> Awaitable[None] | None:
        unseen = self.robots.is_unseen(robot, now)
        if not self.robots.observe(robot, pose, link, now, waited=waited):
            return None
        if unseen:
            self._commands.lose_sight(robot)
        return self._moved(robot, pose, now)

    def _moved(self, robot: str, pose: SendPos, now: float) -> Awaitable[None] | None:
        self._saving.observe(now, [(robot, pose)])
        self.maps.located([(robot, pose)])
        # A position of a while ago shows neither that the robot stands nor that it has arrived.
        return None if self.robots.is_doubted(robot) else self._commands.observe(robot, pose)

    def _measure(self, robot: Robot, written_at: float | None) -> None:
        """Measure the latency of a link without pings, from the writing of a message to its OpAck."""
        if robot.link == "sql" and written_at is not None:
            took = self._clock.time() - written_at
            # For a robot that was away in between this is not the latency of its link.
            if 0 <= took < self.site.report.lost_after:
                self.robots.measured(robot.name, took)


def _attempt(
    take: Callable[..., Awaitable[None] | None], *arguments: Any
) -> Awaitable[None] | Exception | None:
    """Return the rest to be awaited, or the error: it concerns one robot and no other."""
    try:
        return take(*arguments)
    except Exception as error:
        return error
